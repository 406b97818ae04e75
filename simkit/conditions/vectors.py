"""Vectors and poses of whatever means one: a list of numbers, a message, a model's name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from simkit.conditions.kinds import NUMBER, POSE, SCAN, is_vector_like
from simkit.conditions.parts import Part
from simkit.pose import Pose, Vector


def as_vector(part: Part) -> Callable[[], Any]:
    """What gives a part as an array of 64 bit numbers, shape (n,); a number as it is."""
    get = part.get
    if part.kind is NUMBER:
        return get
    if part.kind.message:
        return lambda: of_message(get())
    return lambda: np.asarray(get(), dtype=np.float64)


def of_message(message: Any) -> Vector:
    """A vector or a point, shape (3,)."""
    return np.array((message.x, message.y, message.z), dtype=np.float64)


def as_pose(part: Part) -> Callable[[], Pose]:
    """What gives a pose, or a message that is one, as a pose."""
    get = part.get
    if part.kind is POSE:
        return get

    def value() -> Pose:
        message = get()
        q = message.orientation
        quaternion = (q.w, q.x, q.y, q.z)
        return Pose(of_message(message.position), quaternion if any(quaternion) else (1.0, 0.0, 0.0, 0.0))

    return value


def as_numbers(part: Part) -> Callable[[], Any] | None:
    """What gives the numbers of a list, a vector, or a scan; of a scan those of the rays that met something.

    Rays that met nothing (+inf, nan) are left out; -inf, too near to be measured, is not. None where it has no numbers.
    """
    get = part.get
    if part.kind.message == SCAN:

        def met() -> Any:
            ranges = np.asarray(get().ranges, dtype=np.float64)
            return ranges[ranges < np.inf]

        return met
    return as_vector(part) if is_vector_like(part.kind) else None
