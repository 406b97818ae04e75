"""The joints of one trajectory controller: their command and state interfaces, and the messages about their state."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs
from simkit.params import Params
from simkit.plugins.ros2_control.hardware import Hardware
from simkit.plugins.ros2_control.hardware_interfaces import EFFORT, POSITION, VELOCITY, array_index
from simkit.plugins.ros2_control.joint_pids import JointPids
from simkit.plugins.ros2_control.trajectory import Setpoint
from simkit.plugins.ros_parameter_block import read_names
from simkit.plugins.shared_by_copies import SharedByCopies
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.msgs import (
        FollowJointTrajectory_Feedback,
        JointTrajectoryControllerState,
        JointTrajectoryPoint,
        MultiDOFJointTrajectoryPoint,
    )
    from simkit.plugins.ros2_control.hardware_interfaces import Indices

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
    """Joints whose positions, velocities and accelerations are arrays (3, n).

    Attributes:
        joints: their names, in the order of the arrays.
        commanded_joints: those it commands, by the names that their command interfaces have.
        commands, states: interfaces by which it commands and measures.
        command_names, state_names: all of them: all joints' first kind, then all joints' second.
        has_velocity_state, has_effort: whether velocities are measured, and efforts commanded.
        places: of the commanded joints among `joints`.
        span: the same, as the quickest index.
        turning: which turn without end.
        is_closed_loop: whether commands depend on what is measured, by PIDs: velocity alone or effort alone.
        compared: shape (3, 1): 1 for what is both commanded and measured.
    """

    def __init__(
        self, params: Params, hardware: Hardware, commands: Sequence[str] = (), states: Sequence[str] = ()
    ) -> None:
        """Reads a controller's parameters; problems are recorded there.

        Args:
            params: `joints`, `command_joints`, `command_interfaces`, `state_interfaces`, `gains`.
            hardware: what there is.
            commands, states: interfaces where the file names none.
        """
        self.joints = tuple(read_names(params, "joints", code=_BAD_INTERFACES))
        if not self.joints:
            params.error(_BAD_INTERFACES, "'joints' parameter is empty.", "joints: [arm_1_joint, arm_2_joint]")
        self.commanded_joints, self.places = _commanded_joints(params, self.joints)
        self.span = array_index(self.places.tolist())
        self.commands = by = _read_interfaces(params, "command_interfaces", commands, _ALLOWED_COMMANDS)
        self.states = measured = _read_interfaces(params, "state_interfaces", states, _ALLOWED_STATES)
        self.command_names = tuple(f"{joint}/{kind}" for kind in by for joint in self.commanded_joints)
        self.state_names = tuple(f"{joint}/{kind}" for kind in measured for joint in self.joints)
        self.has_velocity_state, self.has_effort = VELOCITY in measured, EFFORT in by
        self.is_closed_loop = by in ((VELOCITY,), (EFFORT,))
        if self.is_closed_loop and VELOCITY not in measured:
            message = (
                f"'{by[0]}' command interface can only be used alone if 'velocity' and 'position' state interfaces"
            )
            params.error(_BAD_INTERFACES, f"{message} are present", "state_interfaces: [position, velocity]")
        found = [hardware.joints.get(name) for name in self.commanded_joints]
        self.turning: Vector = np.zeros(len(self.joints), dtype=bool)
        self.turning[self.places] = [f is not None and f.is_continuous for f in found]
        gains = params.block("gains")  # where Humble has it
        for j, joint in enumerate(self.joints):
            block, was = gains.block(joint), bool(self.turning[j])
            was = block.boolean("normalize_error", was) if block.has("normalize_error") else was
            self.turning[j] = block.boolean("angle_wraparound", was)
        velocities = VELOCITY in measured and (VELOCITY in by or EFFORT in by)
        accelerations = ACCELERATION in measured and ACCELERATION in by
        self.compared: Vector = np.array([[1.0], [float(velocities)], [float(accelerations)]])

    def command_of(self, joint: str) -> str:
        """The name that a joint's command interface has; the joint's own where it has none."""
        place = self.joints.index(joint)
        here = np.flatnonzero(self.places == place)
        return self.commanded_joints[int(here[0])] if len(here) else joint

    def state(self, values: Vector) -> Vector:
        """Shape (3, n) of the values of the state interfaces; 0 for what is not measured."""
        kinds, count = len(self.states), len(self.joints)
        motion = np.zeros((3, count))
        motion[:kinds] = values[: kinds * count].reshape(kinds, count)
        return motion

    def commanded(self, values: Vector) -> Vector | None:
        """Positions (n,) that the command interfaces hold; None where they do not for every joint."""
        count = len(self.joints)
        if POSITION not in self.commands or len(self.commanded_joints) != count:
            return None
        positions = values[:count]
        return positions if np.isfinite(positions).all() else None

    def command(self, setpoint: Setpoint, errors: Vector, period: float, pids: JointPids | None = None) -> Vector:
        """Values of the command interfaces.

        Args:
            setpoint: what is wanted.
            errors: shape (3, n), wanted − measured.
            period: since the last time [s].
            pids: of the commanded joints, in a closed loop.
        """
        motion, places = setpoint.motion, self.places
        if self.commands == (POSITION,):
            only: Vector = motion[0][places]
            return only
        efforts = np.zeros(len(self.joints)) if setpoint.efforts is None else setpoint.efforts
        if pids is not None:
            feed = motion[1][places] * pids.feedforward + (efforts[places] if self.has_effort else 0.0)
            driven: Vector = feed + pids.update(errors[0][places], errors[1][places], period)
            return driven
        rows = {POSITION: motion[0], VELOCITY: motion[1], ACCELERATION: motion[2], EFFORT: efforts}
        return np.concatenate([rows[kind][places] for kind in self.commands])

    def at_rest(self, values: Vector) -> Vector:
        """Values of the command interfaces on release: positions as they are, the rest 0."""
        count = len(self.commanded_joints)
        rest = values.copy()
        for k, kind in enumerate(self.commands):
            if kind != POSITION:
                rest[k * count : (k + 1) * count] = 0.0
        return rest


def _commanded_joints(params: Params, joints: tuple[str, ...]) -> tuple[tuple[str, ...], Indices]:
    """The commanded joints, and their places: all, under the same or other names, or some of them."""
    commanded = tuple(read_names(params, "command_joints", code=_BAD_INTERFACES)) or joints
    if len(commanded) == len(joints):
        return commanded, np.arange(len(joints))
    if set(commanded) <= set(joints):
        return commanded, np.array([joints.index(name) for name in commanded], dtype=np.intp)
    message = "'command_joints' parameter must have the same size as 'joints' parameter or be a subset of it."
    params.error(_BAD_INTERFACES, message, "joints are " + ", ".join(joints))
    return joints, np.arange(len(joints))


def _read_interfaces(params: Params, name: str, default: Sequence[str], allowed: Sequence[set[str]]) -> tuple[str, ...]:
    wanted = [one.value for one in params.all(name)] or list(default)
    listed = "; ".join(", ".join(kind for kind in _INTERFACE_ORDER if kind in one) for one in allowed)
    if not wanted:
        params.error(_BAD_INTERFACES, f"'{name}' parameter is empty.", f"allowed is one of: {listed}")
    elif set(wanted) not in allowed or len(set(wanted)) != len(wanted):
        params.error(_BAD_INTERFACES, f"'{name}' are {', '.join(wanted)}", f"allowed is one of: {listed}")
        wanted = [POSITION]
    return tuple(kind for kind in _INTERFACE_ORDER if kind in wanted) or (POSITION,)


TRAJECTORY: Final = "trajectory_msgs/msg/JointTrajectory"
_POINT: Final = "trajectory_msgs/msg/JointTrajectoryPoint"
_MULTI_DOF_POINT: Final = "trajectory_msgs/msg/MultiDOFJointTrajectoryPoint"
_FEEDBACK: Final = "control_msgs/action/FollowJointTrajectory_Feedback"


class TrajectoryMessages(SharedByCopies):
    """Makes them for one group of joints."""

    STATE: Final = "control_msgs/msg/JointTrajectoryControllerState"

    def __init__(self, group: JointGroup) -> None:
        self._group, self._names = group, list(group.joints)
        self._empty = np.zeros(0)
        self._point_type: type[JointTrajectoryPoint] = msgs.type_of(_POINT)
        self._multi_dof_point_type: type[MultiDOFJointTrajectoryPoint] = msgs.type_of(_MULTI_DOF_POINT)
        self._feedback_type: type[FollowJointTrajectory_Feedback] = msgs.type_of(_FEEDBACK)
        self._state_type: type[JointTrajectoryControllerState] = msgs.type_of(self.STATE)

    def feedback(self, now: int, desired: Vector, state: Vector, errors: Vector) -> FollowJointTrajectory_Feedback:
        """Make the feedback of a goal from arrays (3, n)."""
        measured = len(self._group.states)
        points = self._point(desired, 3), self._point(state, measured), self._point(errors, measured)
        none = (self._empty_multi_dof_point() for _ in range(3))
        return self._feedback_type(msgs.header(now, ""), list(self._names), *points, [], *none)

    def state(
        self, now: int, desired: Vector, state: Vector, errors: Vector, commands: Vector
    ) -> JointTrajectoryControllerState:
        """Make the controller's state from arrays (3, n) and the values of its command interfaces."""
        measured = len(self._group.states)
        wanted, actual = self._point(desired, 3), self._point(state, measured)
        points = wanted, actual, self._point(errors, measured), self._command_point(commands), wanted, actual
        none = (self._empty_multi_dof_point() for _ in range(6))
        return self._state_type(msgs.header(now, ""), list(self._names), *points, [], *none)

    def _empty_multi_dof_point(self) -> MultiDOFJointTrajectoryPoint:
        return self._multi_dof_point_type([], [], [], msgs.duration(0))

    def _point(self, motion: Vector, rows: int) -> JointTrajectoryPoint:
        position, velocity, acceleration = (motion[k] if k < rows else self._empty for k in range(3))
        return self._point_type(position, velocity, acceleration, self._empty, msgs.duration(0))

    def _command_point(self, values: Vector) -> JointTrajectoryPoint:
        count = len(self._group.commanded_joints)
        found = {kind: values[k * count : (k + 1) * count] for k, kind in enumerate(self._group.commands)}
        position, velocity, acceleration, effort = (found.get(kind, self._empty) for kind in _INTERFACE_ORDER)
        return self._point_type(position, velocity, acceleration, effort, msgs.duration(0))
