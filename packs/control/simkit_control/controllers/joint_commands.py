"""Controllers that forward commands from a topic to command interfaces, or follow the commands with PID loops.

The controllers for one joint are controllers of ROS 1, such as `effort_controllers/JointPositionController`. The
controllers for several joints exist in ROS 1 and ROS 2 (`JointGroupPositionController`, `forward_command_controller`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from simkit import Params, msgs
from simkit.extend import Vector, counted
from simkit.plugins.one_time_warnings import are_usable
from simkit.plugins.ros_parameter_block import read_names
from simkit_control.plugins.ros2_control.controller import Controller
from simkit_control.plugins.ros2_control.hardware_interfaces import EFFORT, POSITION, VELOCITY
from simkit_control.plugins.ros2_control.joint_pids import JointPids
from simkit_control.plugins.ros2_control.stiff_loops import StiffLoops

if TYPE_CHECKING:
    from simkit import Publisher
    from simkit.msgs import JointControllerState

COMMANDS: Final = "std_msgs/msg/Float64MultiArray"
COMMAND: Final = "std_msgs/msg/Float64"
STATE: Final = "control_msgs/msg/JointControllerState"


class ForwardCommandController(Controller):
    """Forwards commands to the command interfaces of joints; a parameter names the interface.

    Commands arrive on `~/commands` (ROS 1: `~/command`). Before the first command, and after deactivation, positions
    are held and velocities and efforts are 0.

    Attributes:
        interface: command interface; None if `interface_name` sets it.
    """

    types: ClassVar[tuple[str, ...]] = ("forward_command_controller/ForwardCommandController",)
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
        """Set the command; a command of wrong length or with NaN or infinite values is reported and ignored."""
        values = np.array(data, dtype=float)
        problem = ""
        if len(values) != len(self._names):
            problem = f"command size ({len(values)}) does not match number of interfaces ({len(self._names)})"
        elif not are_usable(*values.tolist()):
            problem = f"a command has NaN, infinite or too large values: {values.tolist()}"
        if problem:
            message = f"controller {self.name!r}: {problem}; the command is ignored"
            self.sim.engine.reports.warning("SK-CONTROL-016", message, self.params.where)
            return
        self._command = values

    def update(self, now_ns: int, period: float) -> None:
        if self._command is not None:
            self.commands.values = self._command


class MultiInterfaceForwardCommandController(ForwardCommandController):
    """Forwards commands to several interfaces of one joint."""

    types = ("forward_command_controller/MultiInterfaceForwardCommandController",)

    def configure(self) -> None:
        params = self.params
        joint = params.text("joint", required=True)
        interfaces = read_names(params, "interface_names", required=True)
        self._names = [f"{joint}/{interface}" for interface in interfaces]
        self._open_topics()


class PositionController(ForwardCommandController):
    """Forwards positions [rad or m] of several joints."""

    types = ("position_controllers/JointGroupPositionController",)
    interface = POSITION


class VelocityController(ForwardCommandController):
    """Forwards velocities [rad/s or m/s] of several joints; 0 after deactivation."""

    types = ("velocity_controllers/JointGroupVelocityController",)
    interface = VELOCITY


class EffortController(ForwardCommandController):
    """Forwards efforts [N·m or N] of several joints; 0 after deactivation."""

    types = ("effort_controllers/JointGroupEffortController",)
    interface = EFFORT


class _OneJointController(ForwardCommandController):
    """Forwards commands to one joint, named by `joint`, as the ROS 1 controllers do."""

    def configure(self) -> None:
        self._names = [f"{self.params.text('joint', required=True)}/{self.interface}"]
        self._command = None
        self.listen("~/command", COMMAND, lambda message: self.set_command([message.data]))


class OnePositionController(_OneJointController):
    """Forwards the position [rad or m] of one joint (ROS 1)."""

    types = ("position_controllers/JointPositionController",)
    interface = POSITION


class OneVelocityController(_OneJointController):
    """Forwards the velocity [rad/s or m/s] of one joint (ROS 1)."""

    types = ("velocity_controllers/JointVelocityController",)
    interface = VELOCITY


class OneEffortController(_OneJointController):
    """Forwards the effort [N·m or N] of one joint (ROS 1)."""

    types = ("effort_controllers/JointEffortController", "robot_mechanism_controllers/JointEffortController")
    interface = EFFORT


class _LoopController(Controller):
    """Runs a PID loop for each joint on the error target − measured.

    Attributes:
        measured: measured quantity, position or velocity.
        output: command interface, effort or velocity.
    """

    measured: ClassVar[str] = POSITION
    output: ClassVar[str] = EFFORT
    _publisher: Publisher | None

    def configure(self) -> None:
        params = self.params
        joint = params.text("joint", required=True)
        gains = Params(
            "gains",
            children=[_renamed_block(params.block("pid"), joint)],
            where=params.where,
            diagnostics=params.diagnostics,
        )
        self._set_joints((joint,), gains)
        self.listen("~/command", COMMAND, lambda message: self.set_command([message.data]))
        self._publisher = self.advertise("~/state", STATE)

    def _set_joints(self, joints: tuple[str, ...], gains: Params) -> None:
        self._joints = joints
        for joint in joints:
            if not gains.block(joint).has("p"):
                message = f"No p gain specified for joint {joint!r}, so it would not move"
                self.params.error("SK-PARAM-001", message, "pid: {p: 100.0, i: 0.0, d: 10.0}")
        self._pids = JointPids(gains, joints)
        self._stiff_loops: StiffLoops | None = None
        if self.output == EFFORT and self.measured == POSITION:
            self._stiff_loops = StiffLoops(self, joints, self._pids)
        self._target = np.full(len(joints), np.nan)
        self._last: Vector | None = None
        self._publisher = None
        hardware = self.hardware.joints
        hardware_joints = [hardware[joint] for joint in joints if joint in hardware]
        self._position_limits = np.array([(j.lower, j.upper) for j in hardware_joints]).reshape(-1, 2).T
        self._continuous = np.array([j.is_continuous for j in hardware_joints], bool)

    def command_interfaces(self) -> Sequence[str]:
        return [f"{joint}/{self.output}" for joint in self._joints]

    def state_interfaces(self) -> Sequence[str]:
        return [f"{joint}/{part}" for part in (POSITION, VELOCITY) for joint in self._joints]

    def activate(self) -> None:
        """Set the targets to the current positions, or to zero velocity for velocity loops."""
        position = self.states.values[: len(self._joints)]
        self._target = position if self.measured == POSITION else np.zeros(len(self._joints))
        self._last = None
        self._pids.restart()

    def set_command(self, data: Sequence[float]) -> None:
        """Set the targets; a command of wrong length or with NaN or infinite values is reported and ignored."""
        values = np.array(data, dtype=float)
        if len(values) == len(self._joints) and are_usable(*values.tolist()):
            self._target = values
            return
        description = (
            f"a command of {counted(len(values), 'number')}"
            if len(values) != len(self._joints)
            else f"{values.tolist()}"
        )
        message = (
            f"controller {self.name!r}: found {description}; expected {counted(len(self._joints), 'finite number')}"
        )
        self.sim.engine.reports.warning("SK-CONTROL-016", f"{message}; the command is ignored", self.params.where)

    def update(self, now_ns: int, period: float) -> None:
        position, velocity = self.states.values.reshape(2, -1)
        if self.measured == POSITION:
            target = np.clip(self._target, *self._position_limits)
            error = target - position
            error = np.where(self._continuous, np.mod(error + np.pi, 2.0 * np.pi) - np.pi, error)
        else:
            target = self._target
            error = target - velocity
        rate = (error - self._last) / period if self._last is not None and period > 0.0 else np.zeros_like(error)
        self._last = error
        if self._stiff_loops:  # the damping that the engine computes has no difference quotient
            rate = np.where(self._stiff_loops.kd > 0.0, -velocity, rate)
        command = self._pids.update(error, rate, period)
        self.commands.values = self._stiff_loops.effort(command, position, velocity) if self._stiff_loops else command
        if self._publisher is not None and self._publisher.wanted:
            process = position if self.measured == POSITION else velocity
            self._publisher.publish(self._state_message(now_ns, period, target, process, velocity, error, command))

    def _state_message(self, now_ns: int, period: float, *values: Vector) -> JointControllerState:
        target, process, velocity, error, command = (float(v[0]) for v in values)
        pids = self._pids
        state: JointControllerState = msgs.make(
            STATE,
            header=msgs.header(now_ns, ""),
            set_point=target,
            process_value=process,
            process_value_dot=velocity,
            error=error,
            time_step=period,
            command=command,
            p=float(pids.p[0]),
            i=float(pids.i[0]),
            d=float(pids.d[0]),
            i_clamp=float(pids.i_high[0]),
        )
        return state


class EffortPositionController(_LoopController):
    """Moves one joint to a position [rad or m] by effort, with gains in `pid` (ROS 1)."""

    types = ("effort_controllers/JointPositionController", "robot_mechanism_controllers/JointPositionController")


class EffortVelocityController(_LoopController):
    """Moves one joint at a velocity [rad/s or m/s] by effort, with gains in `pid` (ROS 1)."""

    types = ("effort_controllers/JointVelocityController", "robot_mechanism_controllers/JointVelocityController")
    measured = VELOCITY


class VelocityPositionController(_LoopController):
    """Moves one joint to a position [rad or m] by velocity, with gains in `pid` (ROS 1)."""

    types = ("velocity_controllers/JointPositionController",)
    output = VELOCITY


class EffortGroupPositionController(_LoopController):
    """Moves several joints to positions [rad or m] by effort, with gains in `<joint>.pid` or `gains.<joint>`."""

    types = ("effort_controllers/JointGroupPositionController",)

    def configure(self) -> None:
        params = self.params
        joints = tuple(read_names(params, "joints", required=True))
        gains = params.block("gains")
        if not params.has("gains"):
            blocks = [_renamed_block(params.block(joint).block("pid"), joint) for joint in joints]
            gains = Params("gains", children=blocks, where=params.where, diagnostics=params.diagnostics)
        self._set_joints(joints, gains)
        ros_1 = getattr(self.plugin, "is_ros_1", False)
        self.listen("~/command" if ros_1 else "~/commands", COMMANDS, lambda message: self.set_command(message.data))


def _renamed_block(block: Params, name: str) -> Params:
    """Return a block under another name; parameters read from it count as read."""
    block.child("antiwindup")
    return Params(name, block.value, block.attributes, block.children, block.where, block.diagnostics)
