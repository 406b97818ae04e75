"""Controllers that hand on what a topic says: positions, velocities or efforts, one for each joint."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Final

import numpy as np

from simkit.plugins.ros2_control.controller import Controller
from simkit.plugins.ros2_control.hardware_interfaces import EFFORT, POSITION, VELOCITY
from simkit.plugins.ros_parameter_block import read_names
from simkit.pose import Vector

COMMANDS: Final = "std_msgs/msg/Float64MultiArray"
COMMAND: Final = "std_msgs/msg/Float64"


class ForwardCommandController(Controller):
    """`forward_command_controller`: the interface is a parameter.

    Commands come on `~/commands` (ROS 1: `~/command`). Until the first one, and after it was let go, positions are held
    and velocities and efforts are 0.

    Attributes:
        interface: which; None where `interface_name` says it.
    """

    types = ("forward_command_controller/ForwardCommandController",)
    interface: ClassVar[str | None] = None

    def configure(self) -> None:
        params = self.params
        joints = read_names(params, "joints", required=True)
        if self.interface is None:
            interface = params.text("interface_name", required=True)
        else:
            interface, _ = self.interface, params.child("interface_name")
        self._names = [f"{joint}/{interface}" for joint in joints]
        self._open_topics()

    def _open_topics(self) -> None:
        self._command: Vector | None = None
        ros_1 = getattr(self.plugin, "is_ros_1", False)
        self.listen("~/command" if ros_1 else "~/commands", COMMANDS, lambda message: self.set_command(message.data))

    def command_interfaces(self) -> Sequence[str]:
        return self._names

    def activate(self) -> None:
        self._command = None

    def set_command(self, data: Sequence[float]) -> None:
        """Takes a command; one of another length, or with a number that is none, is told and left out."""
        values = np.array(data, dtype=float)
        problem = ""
        if len(values) != len(self._names):
            problem = f"command size ({len(values)}) does not match number of interfaces ({len(self._names)})"
        elif not np.isfinite(values).all():
            problem = f"a command is not finite: {values.tolist()}"
        if problem:
            message = f"controller {self.name!r}: {problem}; it is left out"
            self.sim.engine.reports.warning("SK-CONTROL-016", message, self.params.where)
            return
        self._command = values

    def update(self, now_ns: int, period: float) -> None:
        if self._command is not None:
            self.commands.values = self._command


class MultiInterfaceForwardCommandController(ForwardCommandController):
    """`forward_command_controller`: several interfaces of one joint, commanded together."""

    types = ("forward_command_controller/MultiInterfaceForwardCommandController",)

    def configure(self) -> None:
        params = self.params
        joint = params.text("joint", required=True)
        interfaces = read_names(params, "interface_names", required=True)
        self._names = [f"{joint}/{interface}" for interface in interfaces]
        self._open_topics()


class PositionController(ForwardCommandController):
    """Positions [rad or m] of several joints."""

    types = ("position_controllers/JointGroupPositionController",)
    interface = POSITION


class VelocityController(ForwardCommandController):
    """Velocities [rad/s or m/s] of several joints; 0 when it is let go."""

    types = ("velocity_controllers/JointGroupVelocityController",)
    interface = VELOCITY


class EffortController(ForwardCommandController):
    """Efforts [N·m or N] of several joints; 0 when it is let go."""

    types = ("effort_controllers/JointGroupEffortController",)
    interface = EFFORT


class _OneJointController(ForwardCommandController):
    """ROS 1's controllers of one joint, which `joint` names."""

    def configure(self) -> None:
        self._names = [f"{self.params.text('joint', required=True)}/{self.interface}"]
        self._command = None
        self.listen("~/command", COMMAND, lambda message: self.set_command([message.data]))


class OnePositionController(_OneJointController):
    """ROS 1: the position [rad or m] of one joint."""

    types = ("position_controllers/JointPositionController",)
    interface = POSITION


class OneVelocityController(_OneJointController):
    """ROS 1: the velocity [rad/s or m/s] of one joint."""

    types = ("velocity_controllers/JointVelocityController",)
    interface = VELOCITY


class OneEffortController(_OneJointController):
    """ROS 1: the effort [N·m or N] of one joint."""

    types = ("effort_controllers/JointEffortController",)
    interface = EFFORT
