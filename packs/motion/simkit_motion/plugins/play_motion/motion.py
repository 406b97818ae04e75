"""Motion of a robot: joints, positions and times, and the check of a motion against the joint limits."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs
from simkit.extend import SharedByCopies, Vector, Where, counted

LARGEST_NUMBER: Final = 1e15
"""Largest time [s], position and velocity of a motion; the sums and quotients of larger ones would be infinite."""

if TYPE_CHECKING:
    from simkit import Joint
    from simkit.msgs import Motion as MotionMessage


@dataclass(frozen=True, slots=True)
class Motion(SharedByCopies):
    """Named motion of a robot.

    Attributes:
        key: Key of the motion in files, goals and services, such as `unfold_arm`.
        joints: Plain joint names.
        times: Time of each point from the start of the motion [s], increasing; shape (points,).
        positions: Position of each joint at each point [rad or m], shape (points, joints).
        velocities: Velocity of each joint at each point [rad/s or m/s], shape (points, joints); may be empty.
        name, usage, description: Texts for the user.
        where: File and line of the motion.
    """

    key: str
    joints: tuple[str, ...]
    times: tuple[float, ...]
    positions: tuple[tuple[float, ...], ...]
    velocities: tuple[tuple[float, ...], ...] = ()
    name: str = ""
    usage: str = ""
    description: str = ""
    where: Where = field(default_factory=Where)

    @property
    def duration(self) -> float:
        """Time of the last point [s], without the approach to the first point."""
        return self.times[-1]

    def as_message(self) -> dict[str, object]:
        """Return the motion as the fields of a `play_motion2_msgs/msg/Motion`."""
        return {
            "key": self.key,
            "name": self.name,
            "usage": self.usage,
            "description": self.description,
            "joints": list(self.joints),
            "positions": [value for row in self.positions for value in row],
            "times_from_start": list(self.times),
        }

    def as_info(self) -> dict[str, object]:
        """Return the motion as the fields of a `play_motion_msgs/msg/MotionInfo`."""
        duration = msgs.duration(round(self.duration * 1e9))
        return {"name": self.key, "joints": list(self.joints), "duration": duration}


def motion_of_message(message: MotionMessage) -> Motion:
    """Convert a `play_motion2_msgs/msg/Motion` to a motion.

    Raises:
        ValueError: The message is not a valid motion; the error text states the reason.
    """
    joints, flat, times = list(message.joints), [float(v) for v in message.positions], list(message.times_from_start)
    fault = motion_fault(joints, flat, [float(t) for t in times])
    if fault:
        raise ValueError(fault)
    return Motion(
        message.key,
        tuple(joints),
        tuple(float(t) for t in times),
        point_rows(flat, len(joints)),
        name=message.name,
        usage=message.usage,
        description=message.description,
    )


def point_rows(flat: Sequence[float], width: int) -> tuple[tuple[float, ...], ...]:
    """Split the concatenated positions of all points into one row of `width` numbers for each point."""
    return tuple(tuple(flat[k : k + width]) for k in range(0, len(flat), width))


def motion_fault(
    joints: Sequence[str], flat: Sequence[float], times: Sequence[float], velocities: Sequence[float] = ()
) -> str:
    """Check the numbers of a motion.

    Args:
        joints: Joint names.
        flat: Positions of all points, concatenated.
        times: Time of each point [s].
        velocities: Velocities of all points, concatenated.

    Returns:
        A description of the first fault, or an empty text.
    """
    if not joints:
        return "it has no joints"
    twice = next((joint for k, joint in enumerate(joints) if joint in joints[:k]), None)
    if twice is not None:
        return f"joint {twice!r} is listed twice"
    if not times:
        return "it has no points"
    if len(flat) != len(joints) * len(times):
        counts = f"{counted(len(joints), 'joint')} at {len(times)} times"
        return f"it has {counted(len(flat), 'position')}, but {counts} need {len(joints) * len(times)}"
    bad = next((v for v in (*flat, *times, *velocities) if not math.isfinite(v)), None)
    if bad is not None:
        return f"it has a NaN or infinite number ({bad})"
    if (large := next((v for v in (*flat, *times, *velocities) if abs(v) > LARGEST_NUMBER), None)) is not None:
        return f"it has the number {large:g}; the largest is {LARGEST_NUMBER:g}"
    if times[0] < 0:
        return f"its first time is {times[0]:g} s, before the start"
    back = next((k for k in range(1, len(times)) if times[k] <= times[k - 1]), None)
    if back is not None:
        return f"its times must increase, but {times[back]:g} s comes after {times[back - 1]:g} s"
    return ""


_ROUNDING: Final = 1e-6  # [rad or m]


def limit_violations(motion: Motion, joints: Mapping[str, Joint]) -> list[str]:
    """Describe each joint limit that a motion exceeds, at the point where it exceeds the limit most."""
    violations = []
    for column, name in enumerate(motion.joints):
        axis = joints[name].scene.axes[0]
        values = [row[column] for row in motion.positions]
        over = [max(axis.lower - v, v - axis.upper) for v in values]
        k = int(np.argmax(over))
        if over[k] > _ROUNDING:
            unit = "m" if joints[name].type == "prismatic" else "rad"
            allowed = f"expected {axis.lower:g} to {axis.upper:g}"
            violations.append(f"{name} would be at {values[k]:g} {unit} at {motion.times[k]:g} s; {allowed}")
    return violations


def speed_limits(motion: Motion, joints: Mapping[str, Joint]) -> Vector:
    """Return the speed limit of each joint of a motion [rad/s or m/s]; infinite for a joint without a limit."""
    return np.array([joints[name].scene.axes[0].velocity or np.inf for name in motion.joints], dtype=float)
