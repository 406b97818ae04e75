"""Lengths and parts of paths, and comparison of values of the blackboard."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from simkit import msgs
from simkit.float_sum import float_sum


def is_same(first: Any, second: Any) -> bool:
    """Check whether two values are equal; messages are compared by their fields."""
    if first is second:
        return True
    if isinstance(first, (tuple, list)) and isinstance(second, (tuple, list)):
        return len(first) == len(second) and all(map(is_same, first, second))
    return type(first) is type(second) and bool(first == second)


def distance(first: msgs.PoseStamped, second: msgs.PoseStamped) -> float:
    """Return the distance between two poses in the plane [m]."""
    a, b = first.pose.position, second.pose.position
    return math.hypot(a.x - b.x, a.y - b.y)


def path_length(poses: Sequence[msgs.PoseStamped], begin: int = 0) -> float:
    """Return the length of a path from a pose on [m]."""
    return float_sum([distance(poses[index - 1], poses[index]) for index in range(begin + 1, len(poses))])


def nearest_index(poses: Sequence[msgs.PoseStamped], x: float, y: float, begin: int = 0, end: int | None = None) -> int:
    """Return the index of the pose that is nearest to a point."""
    indices = range(begin, len(poses) if end is None else max(end, begin + 1))
    return min(
        indices, key=lambda index: math.hypot(poses[index].pose.position.x - x, poses[index].pose.position.y - y)
    )


def index_after(poses: Sequence[msgs.PoseStamped], begin: int, length: float, step: int = 1) -> int:
    """Return the first index beyond a length from a pose on, or the end.

    Args:
        poses: poses of a path.
        begin: index of the pose.
        length: length along the path [m].
        step: 1 for forwards, -1 for backwards.
    """
    index, travelled = begin, 0.0
    while 0 <= index + step < len(poses):
        travelled += distance(poses[index], poses[index + step])
        index += step
        if travelled > length:
            return index
    return index + step
