"""Differences of angles [rad], as the package `angles`."""

from __future__ import annotations

import math

__all__ = [
    "normalize_angle",
    "normalize_angle_positive",
    "shortest_angular_distance",
    "shortest_angular_distance_with_large_limits",
    "shortest_angular_distance_with_limits",
    "two_pi_complement",
]


def normalize_angle_positive(angle: float) -> float:
    """Return the equal angle from 0 to 2π."""
    return angle % math.tau


def normalize_angle(angle: float) -> float:
    """Return the equal angle from -π to π."""
    positive = normalize_angle_positive(angle)
    return positive - math.tau if positive > math.pi else positive


def shortest_angular_distance(from_angle: float, to_angle: float) -> float:
    """Return the shorter rotation from one angle to another, from -π to π."""
    return normalize_angle(to_angle - from_angle)


def two_pi_complement(angle: float) -> float:
    """Return the equal rotation in the other direction, from -2π to 2π."""
    if not -math.tau <= angle <= math.tau:
        angle = math.fmod(angle, math.tau)
    return angle - math.tau if angle > 0 else angle + math.tau


def _rotations_to_limits(angle: float, left: float, right: float) -> tuple[bool, float, float]:
    """Return whether an angle is between limits, and its rotations to the left and to the right one."""
    to_left, to_right = shortest_angular_distance(angle, left), shortest_angular_distance(angle, right)
    if to_left == 0:
        return True, to_left, max(to_right, two_pi_complement(to_right))
    if to_right == 0:
        return True, min(to_left, two_pi_complement(to_left)), to_right
    low, low_other = sorted((to_left, two_pi_complement(to_left)))
    high_other, high = sorted((to_right, two_pi_complement(to_right)))
    if low <= high_other or high >= low_other:
        return left == -math.pi and right == math.pi, high_other, low_other
    return True, low, high


def shortest_angular_distance_with_limits(
    from_angle: float, to_angle: float, left_limit: float, right_limit: float
) -> tuple[bool, float]:
    """Return whether both angles are between limits, and the shortest rotation that stays between them.

    Args:
        from_angle: angle at the begin, from -π to π.
        to_angle: angle at the end.
        left_limit: begin of the allowed angles, from -π to π.
        right_limit: end of the allowed angles, from -π to π; it may be less than the left one.
    """
    delta = shortest_angular_distance(from_angle, to_angle)
    other = two_pi_complement(delta)
    is_inside, low, high = _rotations_to_limits(from_angle, left_limit, right_limit)
    if is_inside:
        for rotation in (delta, other):
            if low <= rotation <= high:
                return True, rotation
        _, low, high = _rotations_to_limits(to_angle, left_limit, right_limit)
        low, high = high, low  # the nearer limit decides, as for an angle at the begin that is outside
    if abs(low) == abs(high):
        return False, min(delta, other, key=abs)
    return False, (min if abs(low) < abs(high) else max)(delta, other)


def shortest_angular_distance_with_large_limits(
    from_angle: float, to_angle: float, left_limit: float, right_limit: float
) -> tuple[bool, float]:
    """Return whether a rotation stays between limits that may be outside -π to π, and the shortest such rotation.

    Args:
        from_angle: angle at the begin.
        to_angle: angle at the end; multiples of 2π do not count.
        left_limit: least allowed angle.
        right_limit: largest allowed angle.
    """
    delta = shortest_angular_distance(from_angle, to_angle)
    shorter, longer = sorted((delta, two_pi_complement(delta)), key=abs)
    if left_limit <= right_limit:
        for rotation in (shorter, longer):
            if left_limit <= from_angle + rotation <= right_limit:
                return left_limit <= from_angle <= right_limit, rotation
    return False, shorter
