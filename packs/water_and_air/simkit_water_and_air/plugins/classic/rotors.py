"""Rotors of RotorS for Gazebo Classic: `librotors_gazebo_motor_model.so` and the plugins that pass its commands on.

Parameters, defaults and topics are those of `gazebo_motor_model.h` and `gazebo_controller_interface.h` of RotorS.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simkit import Params, Plugin
from simkit.extend import Options, OptionsOf, boolean, listens, text, without_effect
from simkit.plugins.joints.joint_commands import ACTUATORS
from simkit_water_and_air.plugins.gz.multicopter_motor_model import MotorModelOptions, MulticopterMotorModel

if TYPE_CHECKING:
    from simkit import Model
    from simkit.msgs import Message

_MAV: Final = "mav_msgs/msg/Actuators"
_COMMAND: Final = "command/motor_speed"


class RotorsMotorOptions(MotorModelOptions):
    """Options of `RotorsMotorModel`."""

    topic: str = text("gazebo/command/motor_speed", element="commandSubTopic")
    is_reversible: bool = boolean(element="reversible")
    pid: bool = without_effect(element="joint_control_pid")


class RotorsMotorModel(MulticopterMotorModel):
    """Turns one rotor of a vehicle of RotorS at a commanded speed, like `MulticopterMotorModel`.

    Commands are `Actuators` of `mav_msgs` (`angular_velocities`) or of `actuator_msgs` (`velocity`) [rad/s] on
    `/<robotNamespace>/command/motor_speed`, or on `<commandSubTopic>` below `<robotNamespace>`.
    """

    endpoints = (
        listens("/{model}/command/motor_speed", ACTUATORS, _MAV),
        listens("/{model}/gazebo/command/motor_speed", ACTUATORS, named_by=("commandSubTopic",)),
    )
    options = OptionsOf(RotorsMotorOptions)
    filenames = ("librotors_gazebo_motor_model.so",)
    names = ()

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        namespace = (self.options.namespace or parent.name).strip("/")
        if self.options.topic.strip("/") != _COMMAND:
            self.listen(f"/{namespace}/{_COMMAND}", (_MAV, ACTUATORS), self._on_actuators)

    def _on_actuators(self, message: Message) -> None:
        if message.__msgtype__ != _MAV:
            self._on_command(message)
            return
        speeds = message.angular_velocities
        if self.motor_number < len(speeds):
            self.command(float(speeds[self.motor_number]))
        else:
            what = f"a message has {len(speeds)} angular velocities and none for motor {self.motor_number}"
            self._once.left_out("short", f"{what}; the message is ignored")


class RotorsInterfaceOptions(Options):
    """Options of `RotorsInterface`."""

    namespace: bool = without_effect(element="robotNamespace")
    link: bool = without_effect(element="linkName")
    slowdown: bool = without_effect(element="rotorVelocitySlowdownSim")
    topic: bool = without_effect(element="motorPubTopic")
    states: bool = without_effect(element="jointStatePubTopic")
    actuators: bool = without_effect(element="actuatorsPubTopic")
    command: bool = without_effect(element="commandMotorSpeedSubTopic")
    motors: bool = without_effect(element="motorSpeedCommandPubTopic")


class RotorsInterface(Plugin):
    """Has no effect: the rotors listen to ROS without the plugins that pass commands between ROS and Gazebo."""

    parent_kind = ("world", "model")
    options = OptionsOf(RotorsInterfaceOptions)
    filenames = (
        "librotors_gazebo_ros_interface_plugin.so",
        "librotors_gazebo_controller_interface.so",
        "librotors_gazebo_multirotor_base_plugin.so",
    )

    def load(self, parent: Model, params: Params) -> None:
        self.options.read_all()
