"""The joints of one trajectory controller, with the interfaces by which it commands and measures them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from simkit.control.hardware import Hardware
from simkit.control.interfaces import EFFORT, POSITION, VELOCITY, span
from simkit.control.lists import names
from simkit.control.pids import Pids
from simkit.control.trajectory import Setpoint
from simkit.params import Params
from simkit.pose import Vector

ACCELERATION: Final = "acceleration"
_ORDER: Final = (POSITION, VELOCITY, ACCELERATION, EFFORT)
_COMMANDS: Final = (
    {POSITION},
    {POSITION, VELOCITY},
    {POSITION, VELOCITY, ACCELERATION},
    {VELOCITY},
    {EFFORT},
    {POSITION, EFFORT},
)
_STATES: Final = ({POSITION}, {POSITION, VELOCITY}, {POSITION, VELOCITY, ACCELERATION})
_BAD: Final = "SK-CONTROL-024"


@dataclass(slots=True, eq=False)
class JointGroup:
    """Joints whose positions, velocities and accelerations are arrays (3, n).

    Attributes:
        joints: their names, in the order of the arrays.
        commanded_joints: those it commands, by the names that their command interfaces have.
        commands, states: interfaces by which it commands and measures.
        places: of the commanded joints among `joints`.
        span: the same, as the quickest index.
        turning: which turn without end.
        is_closed_loop: whether commands depend on what is measured, by PIDs: velocity alone or effort alone.
        compared: shape (3, 1): 1 for what is both commanded and measured.
    """

    joints: tuple[str, ...]
    commanded_joints: tuple[str, ...]
    commands: tuple[str, ...]
    states: tuple[str, ...]
    places: Any
    turning: Vector
    is_closed_loop: bool
    compared: Vector
    span: Any

    @classmethod
    def read(
        cls, params: Params, hardware: Hardware, commands: Sequence[str] = (), states: Sequence[str] = ()
    ) -> JointGroup:
        """Of a controller's parameters; what is wrong with them is recorded there.

        Args:
            params: `joints`, `command_joints`, `command_interfaces`, `state_interfaces`, `gains`.
            hardware: what there is.
            commands, states: interfaces where the file names none.
        """
        joints = tuple(names(params, "joints", code=_BAD))
        if not joints:
            params.error(_BAD, "'joints' parameter is empty.", "joints: [arm_1_joint, arm_2_joint]")
        commanded, places = _commanded(params, joints)
        by = _interfaces(params, "command_interfaces", commands, _COMMANDS)
        measured = _interfaces(params, "state_interfaces", states, _STATES)
        is_closed = by in ((VELOCITY,), (EFFORT,))
        if is_closed and VELOCITY not in measured:
            message = (
                f"'{by[0]}' command interface can only be used alone if 'velocity' and 'position' state interfaces"
            )
            params.error(_BAD, f"{message} are present", "state_interfaces: [position, velocity]")
        found = [hardware.joints.get(name) for name in commanded]
        ends_not = [f is not None and f.is_continuous for f in found]
        turning = np.zeros(len(joints), dtype=bool)
        turning[places] = ends_not
        gains = params.block("gains")  # where Humble has it
        for j, joint in enumerate(joints):
            block, was = gains.block(joint), bool(turning[j])
            was = block.boolean("normalize_error", was) if block.has("normalize_error") else was
            turning[j] = block.boolean("angle_wraparound", was)
        velocities = VELOCITY in measured and (VELOCITY in by or EFFORT in by)
        accelerations = ACCELERATION in measured and ACCELERATION in by
        compared = np.array([[1.0], [float(velocities)], [float(accelerations)]])
        return cls(joints, commanded, by, measured, places, turning, is_closed, compared, span(places.tolist()))

    def __deepcopy__(self, memo: dict[int, Any]) -> JointGroup:
        return self

    @property
    def command_names(self) -> tuple[str, ...]:
        """Command interfaces: all joints' first kind, then all joints' second."""
        return tuple(f"{joint}/{kind}" for kind in self.commands for joint in self.commanded_joints)

    @property
    def state_names(self) -> tuple[str, ...]:
        """State interfaces, likewise."""
        return tuple(f"{joint}/{kind}" for kind in self.states for joint in self.joints)

    @property
    def has_velocity_state(self) -> bool:
        """Whether velocities are measured."""
        return VELOCITY in self.states

    @property
    def has_effort(self) -> bool:
        """Whether it commands efforts."""
        return EFFORT in self.commands

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

    def command(self, setpoint: Setpoint, errors: Vector, period: float, pids: Pids | None = None) -> Vector:
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


def _commanded(params: Params, joints: tuple[str, ...]) -> tuple[tuple[str, ...], Any]:
    """The commanded joints, and their places: all, under the same or other names, or some of them."""
    commanded = tuple(names(params, "command_joints", code=_BAD)) or joints
    if len(commanded) == len(joints):
        return commanded, np.arange(len(joints))
    if set(commanded) <= set(joints):
        return commanded, np.array([joints.index(name) for name in commanded], dtype=np.intp)
    message = "'command_joints' parameter must have the same size as 'joints' parameter or be a subset of it."
    params.error(_BAD, message, "joints are " + ", ".join(joints))
    return joints, np.arange(len(joints))


def _interfaces(params: Params, name: str, default: Sequence[str], allowed: Sequence[set[str]]) -> tuple[str, ...]:
    wanted = [one.value for one in params.all(name)] or list(default)
    listed = "; ".join(", ".join(kind for kind in _ORDER if kind in one) for one in allowed)
    if not wanted:
        params.error(_BAD, f"'{name}' parameter is empty.", f"allowed is one of: {listed}")
    elif set(wanted) not in allowed or len(set(wanted)) != len(wanted):
        params.error(_BAD, f"'{name}' are {', '.join(wanted)}", f"allowed is one of: {listed}")
        wanted = [POSITION]
    return tuple(kind for kind in _ORDER if kind in wanted) or (POSITION,)
