"""Joints of one trajectory controller: their command and state interfaces, and the messages about their state."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params, msgs
from simkit.extend import SharedByCopies, Vector
from simkit.plugins.ros_parameter_block import read_names
from simkit_control.plugins.ros2_control.hardware import Hardware
from simkit_control.plugins.ros2_control.hardware_interfaces import EFFORT, POSITION, VELOCITY, array_index
from simkit_control.plugins.ros2_control.joint_pids import JointPids
from simkit_control.plugins.ros2_control.trajectory import Setpoint

if TYPE_CHECKING:
    from simkit.msgs import (
        FollowJointTrajectory_Feedback,
        JointTrajectoryControllerState,
        JointTrajectoryPoint,
        MultiDOFJointTrajectoryPoint,
    )
    from simkit_control.plugins.ros2_control.hardware_interfaces import Indices

ACCELERATION: Final = "acceleration"
_INTERFACE_ORDER: Final = (POSITION, VELOCITY, ACCELERATION, EFFORT)
_ALLOWED_COMMANDS: Final = (
    {POSITION},
    {POSITION, VELOCITY},
    {POSITION, VELOCITY, ACCELERATION},
    {VELOCITY},
    {EFFORT},
    {POSITION, EFFORT},
)
_ALLOWED_STATES: Final = ({POSITION}, {POSITION, VELOCITY}, {POSITION, VELOCITY, ACCELERATION})
_BAD_INTERFACES: Final = "SK-CONTROL-024"


class JointGroup(SharedByCopies):
    """Joints of a trajectory controller; positions, velocities and accelerations of all joints are one array (3, n).

    Attributes:
        joints: names of the joints, in the order of the arrays.
        commanded_joints: names of the commanded joints in the command interfaces.
        commands, states: kinds of command and state interfaces, such as position and velocity.
        command_names, state_names: names of all interfaces: the first kind of all joints, then the second kind.
        has_velocity_state: true if velocities are measured.
        has_effort: true if efforts are commanded.
        commanded_indices: indices of the commanded joints in `joints`.
        span: the same indices as a slice, which is faster, if they are consecutive.
        turning: mask of the joints that rotate without limits.
        is_closed_loop: true if PIDs compute the commands from measurements: velocity alone or effort alone.
        compared: shape (3, 1): 1 for quantities that are both commanded and measured, else 0.
    """

    def __init__(
        self, params: Params, hardware: Hardware, commands: Sequence[str] = (), states: Sequence[str] = ()
    ) -> None:
        """Read the parameters of a controller; problems are recorded in `params`.

        Args:
            params: parameters `joints`, `command_joints`, `command_interfaces`, `state_interfaces`, `gains`.
            hardware: joints that the controller may use.
            commands: default of `command_interfaces`.
            states: default of `state_interfaces`.
        """
        self.joints = tuple(read_names(params, "joints", code=_BAD_INTERFACES))
        if not self.joints:
            params.error(_BAD_INTERFACES, "'joints' parameter is empty.", "joints: [arm_1_joint, arm_2_joint]")
        self.commanded_joints, self.commanded_indices = _commanded_joints(params, self.joints)
        self.span = array_index(self.commanded_indices.tolist())
        self.commands = commanded = _read_interfaces(params, "command_interfaces", commands, _ALLOWED_COMMANDS)
        self.states = measured = _read_interfaces(params, "state_interfaces", states, _ALLOWED_STATES)
        self.command_names = tuple(f"{joint}/{kind}" for kind in commanded for joint in self.commanded_joints)
        self.state_names = tuple(f"{joint}/{kind}" for kind in measured for joint in self.joints)
        self.has_velocity_state, self.has_effort = VELOCITY in measured, EFFORT in commanded
        self.is_closed_loop = commanded in ((VELOCITY,), (EFFORT,))
        if self.is_closed_loop and VELOCITY not in measured:
            kind = commanded[0]
            message = f"'{kind}' command interface can only be used alone if 'velocity' and 'position' state interfaces"
            params.error(_BAD_INTERFACES, f"{message} are present", "state_interfaces: [position, velocity]")
        joints = [hardware.joints.get(name) for name in self.commanded_joints]
        self.turning: Vector = np.zeros(len(self.joints), dtype=bool)
        self.turning[self.commanded_indices] = [f is not None and f.is_continuous for f in joints]
        gains = params.block("gains")  # ROS 2 Humble has the parameters of continuous joints in this block
        for j, joint in enumerate(self.joints):
            block, wraps = gains.block(joint), bool(self.turning[j])
            wraps = block.boolean("normalize_error", wraps) if block.has("normalize_error") else wraps
            self.turning[j] = block.boolean("angle_wraparound", wraps)
        velocities = VELOCITY in measured and (VELOCITY in commanded or EFFORT in commanded)
        accelerations = ACCELERATION in measured and ACCELERATION in commanded
        self.compared: Vector = np.array([[1.0], [float(velocities)], [float(accelerations)]])

    def command_of(self, joint: str) -> str:
        """Return the name that a joint has in its command interface, or its own name if it is not commanded."""
        index = self.joints.index(joint)
        matches = np.flatnonzero(self.commanded_indices == index)
        return self.commanded_joints[int(matches[0])] if len(matches) else joint

    def state(self, values: Vector) -> Vector:
        """Arrange the values of the state interfaces in shape (3, n), with 0 for unmeasured quantities."""
        kinds, count = len(self.states), len(self.joints)
        motion = np.zeros((3, count))
        motion[:kinds] = values[: kinds * count].reshape(kinds, count)
        return motion

    def commanded(self, values: Vector) -> Vector | None:
        """Return the commanded positions (n,); None if the position of a joint is not commanded or not finite."""
        count = len(self.joints)
        if POSITION not in self.commands or len(self.commanded_joints) != count:
            return None
        positions = values[:count]
        return positions if np.isfinite(positions).all() else None

    def command(self, setpoint: Setpoint, errors: Vector, period: float, pids: JointPids | None = None) -> Vector:
        """Compute the values of the command interfaces.

        Args:
            setpoint: desired motion and efforts.
            errors: desired − measured, shape (3, n).
            period: time since the last call [s].
            pids: PIDs of the commanded joints; only for a closed loop.
        """
        motion, indices = setpoint.motion, self.commanded_indices
        if self.commands == (POSITION,):
            only: Vector = motion[0][indices]
            return only
        efforts = np.zeros(len(self.joints)) if setpoint.efforts is None else setpoint.efforts
        if pids is not None:
            feed = motion[1][indices] * pids.feedforward + (efforts[indices] if self.has_effort else 0.0)
            driven: Vector = feed + pids.update(errors[0][indices], errors[1][indices], period)
            return driven
        rows = {POSITION: motion[0], VELOCITY: motion[1], ACCELERATION: motion[2], EFFORT: efforts}
        return np.concatenate([rows[kind][indices] for kind in self.commands])

    def at_rest(self, values: Vector) -> Vector:
        """Return the last commands to write before the interfaces are released: unchanged positions, otherwise 0."""
        count = len(self.commanded_joints)
        rest = values.copy()
        for k, kind in enumerate(self.commands):
            if kind != POSITION:
                rest[k * count : (k + 1) * count] = 0.0
        return rest


def _commanded_joints(params: Params, joints: tuple[str, ...]) -> tuple[tuple[str, ...], Indices]:
    """Return the names of the commanded joints and their indices; the names may differ if all joints are commanded."""
    commanded = tuple(read_names(params, "command_joints", code=_BAD_INTERFACES)) or joints
    if len(commanded) == len(joints):
        return commanded, np.arange(len(joints))
    if set(commanded) <= set(joints):
        return commanded, np.array([joints.index(name) for name in commanded], dtype=np.intp)
    message = "'command_joints' parameter must have the same size as 'joints' parameter or be a subset of it."
    params.error(_BAD_INTERFACES, message, "command_joints: [" + ", ".join(joints) + "]")
    return joints, np.arange(len(joints))


def _read_interfaces(params: Params, name: str, default: Sequence[str], allowed: Sequence[set[str]]) -> tuple[str, ...]:
    requested = [element.value for element in params.all(name)] or list(default)
    listed = "; ".join(", ".join(kind for kind in _INTERFACE_ORDER if kind in kinds) for kinds in allowed)
    if not requested:
        params.error(_BAD_INTERFACES, f"'{name}' parameter is empty.", f"use one of: {listed}")
    elif set(requested) not in allowed or len(set(requested)) != len(requested):
        params.error(_BAD_INTERFACES, f"'{name}' are {', '.join(requested)}", f"use one of: {listed}")
        requested = [POSITION]
    return tuple(kind for kind in _INTERFACE_ORDER if kind in requested) or (POSITION,)


TRAJECTORY: Final = "trajectory_msgs/msg/JointTrajectory"
_POINT: Final = "trajectory_msgs/msg/JointTrajectoryPoint"
_MULTI_DOF_POINT: Final = "trajectory_msgs/msg/MultiDOFJointTrajectoryPoint"
_FEEDBACK: Final = "control_msgs/action/FollowJointTrajectory_Feedback"


class TrajectoryMessages(SharedByCopies):
    """Creates feedback and state messages for one group of joints."""

    STATE: Final = "control_msgs/msg/JointTrajectoryControllerState"

    def __init__(self, group: JointGroup) -> None:
        self._group, self._names = group, list(group.joints)
        self._empty = np.zeros(0)
        self._point_type: type[JointTrajectoryPoint] = msgs.type_of(_POINT)
        self._multi_dof_point_type: type[MultiDOFJointTrajectoryPoint] = msgs.type_of(_MULTI_DOF_POINT)
        self._feedback_type: type[FollowJointTrajectory_Feedback] = msgs.type_of(_FEEDBACK)
        self._state_type: type[JointTrajectoryControllerState] = msgs.type_of(self.STATE)

    def feedback(self, now: int, desired: Vector, state: Vector, errors: Vector) -> FollowJointTrajectory_Feedback:
        """Create the feedback of a goal from arrays (3, n)."""
        measured = len(self._group.states)
        points = self._point(desired, 3), self._point(state, measured), self._point(errors, measured)
        none = (self._empty_multi_dof_point() for _ in range(3))
        return self._feedback_type(msgs.header(now, ""), list(self._names), *points, [], *none)

    def state(
        self, now: int, desired: Vector, state: Vector, errors: Vector, commands: Vector, scaling: float
    ) -> JointTrajectoryControllerState:
        """Create the controller's state message from arrays (3, n), the command interfaces' values and the scaling."""
        measured = len(self._group.states)
        reference, actual = self._point(desired, 3), self._point(state, measured)
        points = reference, actual, self._point(errors, measured), self._command_point(commands)
        header, none = msgs.header(now, ""), self._empty_multi_dof_point
        return self._state_type(header, list(self._names), *points, [], none(), none(), none(), none(), scaling)

    def _empty_multi_dof_point(self) -> MultiDOFJointTrajectoryPoint:
        return self._multi_dof_point_type([], [], [], msgs.duration(0))

    def _point(self, motion: Vector, rows: int) -> JointTrajectoryPoint:
        position, velocity, acceleration = (motion[k] if k < rows else self._empty for k in range(3))
        return self._point_type(position, velocity, acceleration, self._empty, msgs.duration(0))

    def _command_point(self, values: Vector) -> JointTrajectoryPoint:
        count = len(self._group.commanded_joints)
        by_kind = {kind: values[k * count : (k + 1) * count] for k, kind in enumerate(self._group.commands)}
        position, velocity, acceleration, effort = (by_kind.get(kind, self._empty) for kind in _INTERFACE_ORDER)
        return self._point_type(position, velocity, acceleration, effort, msgs.duration(0))
