"""Functions of vectors, rotations, frames, twists and wrenches of KDL."""

from __future__ import annotations

import math
from typing import Any

from simkit_nodes.ros_modules.PyKDL.frames import Frame, Rotation, Twist

__all__ = ["SetToZero", "addDelta", "diff", "dot"]


def dot(first: Any, second: Any) -> float:
    """Return the scalar product of two vectors, or the power of a twist and a wrench [W]."""
    return math.fsum(a * b for a, b in zip(first._values(), second._values(), strict=True))


def SetToZero(value: Any) -> None:
    """Set all numbers of a vector, a twist, a wrench, an array of joints or a Jacobian to zero."""
    value -= value  # changes the object itself


def diff(first: Any, second: Any, dt: float = 1.0) -> Any:
    """Return the velocity that leads from the first to the second value in `dt` seconds.

    It is a vector for vectors and rotations, and a twist for frames, in the axes of the base.
    """
    if isinstance(first, Rotation):
        return first * (first.Inverse() * second).GetRot() / dt
    if isinstance(first, Frame):
        return Twist(diff(first.p, second.p, dt), diff(first.M, second.M, dt))
    return (second - first) / dt


def addDelta(value: Any, delta: Any, dt: float = 1.0) -> Any:
    """Return a value after `dt` seconds of a velocity; see `diff`."""
    if isinstance(value, Rotation):
        return value * Rotation.Rot(value.Inverse(delta), delta.Norm() * dt)
    if isinstance(value, Frame):
        return Frame(addDelta(value.M, delta.rot, dt), addDelta(value.p, delta.vel, dt))
    return value + delta * dt
