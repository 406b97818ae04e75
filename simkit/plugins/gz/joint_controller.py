"""gz's velocity control of joints: `gz::sim::systems::JointController`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.endpoints import listens
from simkit.plugins.joints.joint_commands import GAINS, JointCommander, JointCommandOptions
from simkit.plugins.joints.pid import Pid, declare_pid
from simkit.plugins.options import OptionsOf, boolean, number

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel


class JointControllerOptions(JointCommandOptions):
    """Options of `JointController`."""

    initial_velocity: float = number(0.0, "rad/s or m/s")
    use_force_commands: bool = boolean()
    disable_braking: bool = boolean()


class JointController(JointCommander):
    """Turns one or more joints, about their first axis, at a commanded velocity [rad/s or m/s].

    By velocity: the efforts, within their limits, that bring the joints to it within one step. With
    `<use_force_commands>`: a PID on the velocity of the first joint gives the effort of all; `<disable_braking>` leaves
    out what would slow them down. Commands come on `/model/<model>/joint/<joint>/cmd_vel`, on `<sub_topic>` below the
    model or on `<topic>`, or as one of many actuators (`<use_actuator_msg>`, `<actuator_number>`). The numbers of the
    PID are live parameters.
    """

    endpoints = (
        listens("/model/{model}/joint/{joint_name}/cmd_vel", "std_msgs/msg/Float64", named_by=("topic", "sub_topic")),
        listens("/actuators", "actuator_msgs/msg/Actuators", named_by=("topic", "sub_topic")),
    )
    options = OptionsOf(JointControllerOptions)
    filenames = ("gz-sim-joint-controller-system",)
    names = ("gz::sim::systems::JointController",)
    actuator_field = "velocity"
    target_element = "initial_velocity"

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        super().prepare(scene, params, builder)
        self.own_topic = f"joint/{self._first}/cmd_vel"

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        self._by_velocity = not self.options.use_force_commands
        self._coasts = self.options.disable_braking
        if self._by_velocity:
            self.say_gains_are_unused(params, (*GAINS, "disable_braking"), "without <use_force_commands>")
        else:
            self._pid = declare_pid(self, Pid(1.0, 0.0, 0.0, 1.0, -1.0, 1000.0, -1000.0), self._present_pid)

    def _present_pid(self) -> Pid:
        assert self._pid is not None
        return self._pid

    def command(self) -> None:
        if self._by_velocity:
            self.turn(self._target)
            return
        error = self.axes[0].velocity - self._target
        if self._coasts and (self._target == 0.0 or math.copysign(1.0, self._target) * error > 0.0):
            return
        self.push(error)
