"""A motion: joints, the positions they go through and the times, and the check against the joints' limits."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs
from simkit.diagnostics import NOWHERE, Where
from simkit.plugins.shared_by_copies import SharedByCopies
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.msgs import Motion as MotionMessage
    from simkit.runtime import Joint


@dataclass(frozen=True, slots=True)
class Motion(SharedByCopies):
    """A motion that a robot knows by name.

    Attributes:
        key: what it is called by (`unfold_arm`).
        joints: plain names.
        times: when each point is reached, from the start of the motion [s], rising; shape (points,).
        positions: of each point, in the order of the joints [rad or m], shape (points, joints).
        velocities: of each point [rad/s or m/s], shape (points, joints); empty where the file says nothing.
        name, usage, description: for people.
    """

    key: str
    joints: tuple[str, ...]
    times: tuple[float, ...]
    positions: tuple[tuple[float, ...], ...]
    velocities: tuple[tuple[float, ...], ...] = ()
    name: str = ""
    usage: str = ""
    description: str = ""
    where: Where = NOWHERE

    @property
    def duration(self) -> float:
        """Time of its last point as the file has it, without the approach [s]."""
        return self.times[-1]

    def as_message(self) -> dict[str, object]:
        """The fields of a `play_motion2_msgs/msg/Motion`."""
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
        """The fields of a `play_motion_msgs/msg/MotionInfo`."""
        duration = msgs.duration(round(self.duration * 1e9))
        return {"name": self.key, "joints": list(self.joints), "duration": duration}


def motion_of_message(message: MotionMessage) -> Motion:
    """The motion that a `play_motion2_msgs/msg/Motion` holds.

    Raises:
        ValueError: it is none; says why.
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
    """Positions of all points one after another, as a row for each point."""
    return tuple(tuple(flat[k : k + width]) for k in range(0, len(flat), width))


def motion_fault(
    joints: Sequence[str], flat: Sequence[float], times: Sequence[float], velocities: Sequence[float] = ()
) -> str:
    """Describe why these are no motion; empty where they are one."""
    if not joints:
        return "it names no joint"
    twice = next((joint for k, joint in enumerate(joints) if joint in joints[:k]), None)
    if twice is not None:
        return f"it names joint {twice!r} twice"
    if not times:
        return "it has no point"
    if len(flat) != len(joints) * len(times):
        counts = f"{len(joints)} joints at {len(times)} times"
        return f"it has {len(flat)} positions, {counts} need {len(joints) * len(times)}"
    bad = next((v for v in (*flat, *times, *velocities) if not math.isfinite(v)), None)
    if bad is not None:
        return f"it has a number that is not finite ({bad})"
    if times[0] < 0:
        return f"its first time is {times[0]:g} s, before the start"
    back = next((k for k in range(1, len(times)) if times[k] <= times[k - 1]), None)
    if back is not None:
        return f"its times do not rise: {times[back]:g} s comes after {times[back - 1]:g} s"
    return ""


_ROUNDING: Final = 1e-6  # [rad or m]


def limit_violations(motion: Motion, joints: Mapping[str, Joint]) -> list[str]:
    """Describe where a motion leaves the limits of its joints; a joint is named once, where it goes furthest."""
    found = []
    for column, name in enumerate(motion.joints):
        axis = joints[name].scene.axes[0]
        values = [row[column] for row in motion.positions]
        over = [max(axis.lower - v, v - axis.upper) for v in values]
        k = int(np.argmax(over))
        if over[k] > _ROUNDING:
            unit = "m" if joints[name].type == "prismatic" else "rad"
            allowed = f"allowed is {axis.lower:g} to {axis.upper:g}"
            found.append(f"{name} is to be at {values[k]:g} {unit} at {motion.times[k]:g} s, {allowed}")
    return found


def speed_limits(motion: Motion, joints: Mapping[str, Joint]) -> Vector:
    """The largest speed of each joint of a motion [rad/s or m/s]; infinite where there is none."""
    return np.array([joints[name].scene.axes[0].velocity or np.inf for name in motion.joints], dtype=float)
