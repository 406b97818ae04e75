"""Failure of a motor of a multicopter: PX4's `MotorFailurePlugin`.

Topic and numbers are those of `MotorFailureSystem.cpp` of PX4-Autopilot: motors are numbered from 1, in the order of
the joints `rotor_0_joint`, `rotor_1_joint`, …
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from simkit import ModelPlugin, Params
from simkit.extend import Options, OptionsOf, listens, text
from simkit.msgs import valid_topic
from simkit_water_and_air.plugins.gz.multicopter_motor_model import MulticopterMotorModel

if TYPE_CHECKING:
    from simkit import Model
    from simkit.msgs import Int32

INTEGER: Final = "std_msgs/msg/Int32"
_ROTOR: Final = re.compile(r"rotor_(\d+)_joint")


class MotorFailureBase(ModelPlugin):
    """Base class of plugins that stop one motor of the model, by a number on a topic; 0 repairs it."""

    def start(self, topic: str) -> None:
        """Subscribe to the number of the motor that fails."""
        self._failed = 0
        self.listen(topic, INTEGER, self._on_number)

    def _on_number(self, message: Int32) -> None:
        self._failed = int(message.data)
        for number, motor in self._motors().items():
            motor.share = 0.0 if number == self._failed - 1 else 1.0
        if self._failed and self._failed - 1 not in self._motors():
            self._once.left_out("number", f"there is no motor {self._failed}; motors are numbered from 1")

    def number_of(self, motor: MulticopterMotorModel) -> int:
        """Return the number of a motor, from 0."""
        return motor.motor_number

    def _motors(self) -> dict[int, MulticopterMotorModel]:
        plugins = self.sim.engine.structure.all_plugins()
        scope = f"{self.scoped}::"
        motors = [p for p in plugins if isinstance(p, MulticopterMotorModel) and f"{p.scoped}::".startswith(scope)]
        return {self.number_of(motor): motor for motor in motors}


class MotorFailureOptions(Options):
    """Options of `MotorFailure`."""

    topic: str = text(element="MotorFailureTopic")


class MotorFailure(MotorFailureBase):
    """Stops one motor of a multicopter: its number, from 1, is an `Int32` message; 0 repairs it."""

    endpoints = (listens("/model/{model}/motor_failure/motor_number", INTEGER, named_by=("MotorFailureTopic",)),)
    options = OptionsOf(MotorFailureOptions)
    filenames = ("MotorFailurePlugin",)
    names = ("gz::sim::systems::MotorFailureSystem",)

    def load(self, parent: Model, params: Params) -> None:
        self.start(valid_topic(self.options.topic or f"/model/{parent.name}/motor_failure/motor_number"))

    def number_of(self, motor: MulticopterMotorModel) -> int:
        """Return the number in the name of the rotor's joint; without one, the number of the motor in a message."""
        named = _ROTOR.fullmatch(motor.joint_name.rsplit("::", 1)[-1])
        return motor.motor_number if named is None else int(named[1])
