"""Rotors of PX4's models for Gazebo Classic: `libgazebo_motor_model.so`, the rotor of RotorS."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simkit import ModelPlugin, Params
from simkit.extend import Options, OptionsOf, boolean, listens, text, without_effect
from simkit.plugins.joints.joint_commands import ACTUATORS
from simkit_water_and_air.plugins.gz.multicopter_motor_model import MotorModelOptions, MulticopterMotorModel

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder

_NO_THRUST: Final = 25.0  # [m/s] along the axis, from `gazebo_motor_model.cpp`


class ClassicMotorModelOptions(MotorModelOptions):
    """Options of `GazeboMotorModel`."""

    topic: str = text("/gazebo/command/motor_speed", element="commandSubTopic")
    is_reversible: bool = boolean(element="reversible")
    pid: bool = without_effect(element="joint_control_pid")


class GazeboMotorModel(MulticopterMotorModel):
    """Turns one rotor of PX4's models at a commanded speed, like `MulticopterMotorModel`.

    The thrust falls linearly with the speed along the axis and is zero at 25 m/s. Without `<reversible>`, a rotor that
    turns backwards stops instead. Commands come from `libgazebo_mavlink_interface.so` in the same model, or as
    `Actuators` messages on `/<model>/gazebo/command/motor_speed`.
    """

    endpoints = (listens("/{model}/gazebo/command/motor_speed", ACTUATORS, named_by=("commandSubTopic",)),)
    options = OptionsOf(ClassicMotorModelOptions)
    filenames = ("libgazebo_motor_model.so",)
    names = ()

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        super().prepare(scene, params, builder)
        self._is_reversible = self.options.is_reversible

    def command(self, speed: float) -> None:
        """Set the speed of the rotor [rad/s] from the next step on; negative speeds only for a reversible rotor."""
        super().command(speed if self._is_reversible else max(0.0, speed))

    def inflow_factor(self, speed: float) -> float:
        """Return the share of the thrust that is left while the rotor moves along its axis [m/s]."""
        return max(0.0, 1.0 - abs(speed) / _NO_THRUST)


class MultirotorBaseOptions(Options):
    """Options of `MultirotorBase`."""

    namespace: bool = without_effect(element="robotNamespace")
    link: bool = without_effect(element="linkName")
    slowdown: bool = without_effect(element="rotorVelocitySlowdownSim")
    topic: bool = without_effect(element="motorPubTopic")


class MultirotorBase(ModelPlugin):
    """Has no effect: in Gazebo it publishes the speeds of rotors, which a joint state publisher shows."""

    options = OptionsOf(MultirotorBaseOptions)
    filenames = ("libgazebo_multirotor_base_plugin.so",)

    def load(self, parent: Model, params: Params) -> None:
        self.options.read_all()
