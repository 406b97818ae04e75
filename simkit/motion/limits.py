"""Whether a motion stays within the limits of its joints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.motion.motions import Motion
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.runtime import Joint

_ROUNDING: Final = 1e-6  # [rad or m]


def beyond_limits(motion: Motion, joints: Mapping[str, Joint]) -> list[str]:
    """What of a motion leaves the limits of its joints, in words; a joint is named once, where it goes furthest."""
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
