"""Rotors of RotorS for Gazebo Classic: `librotors_gazebo_motor_model.so` and the plugins that pass its commands on.

Parameters, defaults and topics are those of `gazebo_motor_model.h` and `gazebo_controller_interface.h` of RotorS.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params, Plugin, msgs
from simkit.extend import (
    Options,
    OptionsOf,
    boolean,
    counted,
    find_named_link,
    listens,
    number,
    publishes,
    text,
    without_effect,
)
from simkit.plugins.joint_states import JOINT_STATE, joint_readings, joint_state_message
from simkit.plugins.joints.joint_commands import ACTUATORS
from simkit_water_and_air.plugins.gz.multicopter_motor_model import MotorModelOptions, MulticopterMotorModel

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Message

_MAV: Final = "mav_msgs/msg/Actuators"
_COMMAND: Final = "command/motor_speed"
_ROTOR: Final = re.compile(r"rotor_(\d{1,6})")


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
            velocities = counted(len(speeds), "angular velocity", "angular velocities")
            what = f"a message has {velocities} and none for motor {self.motor_number}"
            self._once.left_out("short", f"{what}; the message is ignored")


class RotorsInterfaceOptions(Options):
    """Options of `RotorsInterface`."""

    namespace: bool = without_effect(element="robotNamespace")
    attitude: bool = without_effect(element="commandAttitudeThrustSubTopic")
    rate: bool = without_effect(element="commandRateThrustSubTopic")
    imu: bool = without_effect(element="imuSubTopic")
    command: bool = without_effect(element="commandMotorSpeedSubTopic")
    motors: bool = without_effect(element="motorSpeedCommandPubTopic")


class RotorsInterface(Plugin):
    """Has no effect: the rotors listen to ROS without the plugins that pass commands between ROS and Gazebo."""

    parent_kind = ("world", "model")
    options = OptionsOf(RotorsInterfaceOptions)
    filenames = (
        "librotors_gazebo_ros_interface_plugin.so",
        "librotors_gazebo_controller_interface.so",
    )

    def load(self, parent: Model, params: Params) -> None:
        self.options.read_all()


class RotorsBaseOptions(Options):
    """Options of `RotorsBase`."""

    link: str = text(None, element="linkName", required=True)
    topic: str = text("motor_speed", element="motorPubTopic")
    slowdown: float = number(10.0, element="rotorVelocitySlowdownSim", minimum=1e-9, maximum=1e9)


class RotorsBase(ModelPlugin):
    """Publishes the speeds [rad/s] and the joints of all rotors, whose links have names with `rotor_<number>`."""

    endpoints = (
        publishes("/{robotNamespace}/motor_speed", _MAV, named_by=("motorPubTopic",)),
        publishes("/{robotNamespace}/joint_states", JOINT_STATE),
    )
    options = OptionsOf(RotorsBaseOptions)
    filenames = ("librotors_gazebo_multirotor_base_plugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._frame = find_named_link(scene, "linkName", params).rsplit("::", 1)[-1]
        numbered = ((_ROTOR.search(joint.child_link), joint) for joint in scene.all_joints() if len(joint.axes) == 1)
        rotors = sorted((int(found.group(1)), joint.scoped) for found, joint in numbered if found)
        self._joint_names = [name for _, name in rotors]

    def load(self, parent: Model, params: Params) -> None:
        self._joints = [self.sim.joint(name) for name in self._joint_names]
        self._speeds = self.advertise(self.options.topic, _MAV)
        self._states = self.advertise("joint_states", JOINT_STATE)

    def after_step(self) -> None:
        """Publish the speeds and the states of the joints."""
        if self._speeds.wanted:
            speeds = [float(joint.velocity) * self.options.slowdown for joint in self._joints]
            header = msgs.header(self.sim.time_ns, self._frame)
            self._speeds.publish(msgs.make(_MAV, header=header, angular_velocities=np.array(speeds)))
        if self._states.wanted:
            self._states.publish(joint_state_message(self.sim.time_ns, joint_readings(self._joints)))
