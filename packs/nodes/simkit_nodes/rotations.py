"""Vectors, quaternions (x, y, z, w) and Euler angles [rad], with the functions of ROS's `tf.transformations`.

An axis sequence is a text such as `sxyz`: `s` for fixed (static) axes or `r` for axes that rotate along, then the axes
in the order of the rotations. A tuple (first axis, parity, repetition, frame) names a sequence, too.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import dot, norm

Array = npt.NDArray[np.float64]
Axes = str | tuple[int, int, int, int]

EPSILON: Final = float(np.finfo(float).eps) * 4.0
"""Length below which a vector counts as zero."""


def to_array(values: Any) -> Array:
    """Return numbers as an array of floats."""
    return np.asarray(values, np.float64)


def affine(linear: Any, translation: Any = (0.0, 0.0, 0.0)) -> Array:
    """Return the 4 × 4 matrix with a linear part and a translation."""
    matrix = np.identity(4)
    matrix[:3, :3] = linear
    matrix[:3, 3] = translation
    return matrix


# ---------------------------------------------------------------------- vectors


def vector_norm(data: Any, axis: int | None = None, out: Array | None = None) -> Any:
    """Return the Euclidean length of vectors along an axis."""
    values = to_array(data)
    if out is None:
        if values.ndim == 1:
            return norm(values)
        return np.atleast_1d(np.sqrt(np.sum(values * values, axis=axis)))
    np.sqrt(np.sum(values * values, axis=axis), out=out)
    return None


def unit_vector(data: Any, axis: int | None = None, out: Array | None = None) -> Any:
    """Return vectors divided by their length along an axis."""
    values = np.array(data, np.float64)
    if values.size:
        values = values / np.sqrt(np.sum(values * values, axis=axis, keepdims=True))
    if out is None:
        return values
    out[:] = values
    return None


def random_vector(size: int) -> Array:
    """Return random numbers from 0 to 1."""
    return np.random.random(size)


# ---------------------------------------------------------------------- Euler angles


def _sequence(axes: Axes) -> tuple[tuple[int, int, int], bool]:
    """Return the axes of a sequence about fixed axes, and whether the order of its angles is reversed.

    Rotations about axes that rotate along are those about fixed axes in reversed order.
    """
    if isinstance(axes, str):
        text = axes.lower()
        if len(text) != 4 or text[0] not in "sr" or not set(text[1:]) <= set("xyz") or text[2] in (text[1], text[3]):
            raise KeyError(axes)
        order = tuple("xyz".index(letter) for letter in text[1:])
        is_reversed = text[0] == "r"
        return (order[::-1] if is_reversed else order), is_reversed  # type: ignore[return-value]
    first, parity, repetition, frame = axes
    second = (first + (2 if parity else 1)) % 3
    return (first, second, first if repetition else 3 - first - second), bool(frame)


def euler_matrix(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Array:
    """Return the rotation by three angles about the axes of a sequence."""
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def euler_from_matrix(matrix: Any, axes: Axes = "sxyz") -> tuple[float, float, float]:
    """Return the three angles about the axes of a sequence that give a rotation."""
    (i, j, last), is_reversed = _sequence(axes)
    k = 3 - i - j
    m = to_array(matrix)[:3, :3].tolist()
    if last == i:
        sine = math.hypot(m[i][j], m[i][k])
        angles = math.atan2(m[i][j], m[i][k]), math.atan2(sine, m[i][i]), math.atan2(m[j][i], -m[k][i])
    else:
        sine = math.hypot(m[i][i], m[j][i])  # the cosine of the second angle
        angles = math.atan2(m[k][j], m[k][k]), math.atan2(-m[k][i], sine), math.atan2(m[j][i], m[i][i])
    if sine <= EPSILON:  # the first and third axes are parallel: all of the angle is in the first one
        angles = math.atan2(-m[j][k], m[j][j]), angles[1], 0.0
    sign = 1.0 if j == (i + 1) % 3 else -1.0
    first, second, third = (sign * angle for angle in angles)
    return (third, second, first) if is_reversed else (first, second, third)


def euler_from_quaternion(quaternion: Any, axes: Axes = "sxyz") -> tuple[float, float, float]:
    """Return the three angles about the axes of a sequence that give a quaternion."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Array:
    """Return the quaternion of three angles about the axes of a sequence."""
    order, is_reversed = _sequence(axes)
    angles = (ak, aj, ai) if is_reversed else (ai, aj, ak)
    result = (0.0, 0.0, 0.0, 1.0)
    for axis, angle in zip(order, angles, strict=True):
        turn = [0.0, 0.0, 0.0, math.cos(angle / 2.0)]
        turn[axis] = math.sin(angle / 2.0)
        result = _product(turn, result)
    return np.array(result)


# ---------------------------------------------------------------------- quaternions


def quaternion_about_axis(angle: float, axis: Any) -> Array:
    """Return the quaternion of a rotation about an axis."""
    direction = to_array(axis)[:3]
    length = vector_norm(direction)
    if length > EPSILON:
        direction = direction * (math.sin(angle / 2.0) / length)
    return np.array((*direction, math.cos(angle / 2.0)))


def quaternion_matrix(quaternion: Any) -> Array:
    """Return the rotation of a quaternion, which need not have length 1."""
    x, y, z, w = (float(number) for number in quaternion[:4])
    square = x * x + y * y + z * z + w * w
    if square < EPSILON:
        return np.identity(4)
    s = 2.0 / square
    xs, ys, zs = x * s, y * s, z * s
    return affine(
        (
            (1.0 - (y * ys + z * zs), x * ys - w * zs, x * zs + w * ys),
            (x * ys + w * zs, 1.0 - (x * xs + z * zs), y * zs - w * xs),
            (x * zs - w * ys, y * zs + w * xs, 1.0 - (x * xs + y * ys)),
        )
    )


def quaternion_from_matrix(matrix: Any) -> Array:
    """Return the quaternion of a rotation; w, or else the largest other number, is positive."""
    values = to_array(matrix)
    m = values[:3, :3] if values.shape == (3, 3) or values[3, 3] == 1.0 else values[:3, :3] / values[3, 3]
    trace = m[0, 0] + m[1, 1] + m[2, 2]
    if trace > 0.0:
        q = np.array((m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], trace + 1.0))
    else:
        i = int(np.argmax(np.diag(m)))
        j, k = (i + 1) % 3, (i + 2) % 3
        q = np.empty(4)
        q[i], q[j] = m[i, i] - m[j, j] - m[k, k] + 1.0, m[i, j] + m[j, i]
        q[k], q[3] = m[k, i] + m[i, k], m[k, j] - m[j, k]
    return q / vector_norm(q)  # type: ignore[no-any-return]


def quaternion_multiply(quaternion1: Any, quaternion0: Any) -> Array:
    """Return the product of two quaternions: the rotation by the second, then by the first."""
    return np.array(_product(quaternion1, quaternion0), np.float64)


def _product(first: Sequence[float], second: Sequence[float]) -> tuple[float, float, float, float]:
    ax, ay, az, aw = first
    bx, by, bz, bw = second
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def quaternion_conjugate(quaternion: Any) -> Array:
    """Return the conjugate of a quaternion."""
    x, y, z, w = quaternion
    return np.array((-x, -y, -z, w), np.float64)


def quaternion_inverse(quaternion: Any) -> Array:
    """Return the inverse of a quaternion."""
    return quaternion_conjugate(quaternion) / dot(quaternion, quaternion)


def quaternion_slerp(quat0: Any, quat1: Any, fraction: float, spin: int = 0, shortestpath: bool = True) -> Array:
    """Return the rotation between two others.

    Args:
        quat0: rotation for the fraction 0.
        quat1: rotation for the fraction 1.
        fraction: part of the way.
        spin: number of additional half turns.
        shortestpath: take the shorter of the two ways.
    """
    first: Array = unit_vector(to_array(quat0)[:4])
    second: Array = unit_vector(to_array(quat1)[:4])
    if fraction == 0.0:
        return first
    if fraction == 1.0:
        return second
    cosine = float(dot(first, second))
    if abs(abs(cosine) - 1.0) < EPSILON:
        return first
    if shortestpath and cosine < 0.0:
        cosine, second = -cosine, -second
    angle = math.acos(cosine) + spin * math.pi
    if abs(angle) < EPSILON:
        return first
    return (math.sin((1.0 - fraction) * angle) * first + math.sin(fraction * angle) * second) / math.sin(angle)


def random_quaternion(rand: Sequence[float] | None = None) -> Array:
    """Return a uniformly distributed rotation, from three random numbers from 0 to 1."""
    numbers = random_vector(3) if rand is None else rand
    if len(numbers) != 3:
        raise AssertionError
    outer, inner = math.sqrt(1.0 - numbers[0]), math.sqrt(numbers[0])
    first, second = math.tau * numbers[1], math.tau * numbers[2]
    return np.array(
        (math.sin(first) * outer, math.cos(first) * outer, math.sin(second) * inner, math.cos(second) * inner)
    )


def random_rotation_matrix(rand: Sequence[float] | None = None) -> Array:
    """Return a uniformly distributed rotation as a matrix; see `random_quaternion`."""
    return quaternion_matrix(random_quaternion(rand))


# ---------------------------------------------------------------------- trackball


class Arcball:
    """Rotation that a pointer drags on the picture of a ball.

    Args:
        initial: quaternion or matrix at the begin.
    """

    def __init__(self, initial: Any = None) -> None:
        start = np.array((0.0, 0.0, 0.0, 1.0)) if initial is None else np.array(initial, np.float64)
        if start.shape == (4, 4):
            start = quaternion_from_matrix(start)
        elif start.shape != (4,):
            raise ValueError("initial not a quaternion or matrix.")
        self._at_press = self._before = self._now = unit_vector(start)
        self._axis: Array | None = None
        self._axes: list[Array] | None = None
        self._radius, self._center = 1.0, (0.0, 0.0)
        self._pressed: Array = np.array((0.0, 0.0, 1.0))
        self._is_constrained = False

    def place(self, center: Sequence[float], radius: float) -> None:
        """Set center and radius of the ball [pixels]."""
        self._center, self._radius = (center[0], center[1]), float(radius)

    def setaxes(self, *axes: Any) -> None:
        """Set the axes to which the rotation may be constrained."""
        self._axes = [unit_vector(axis) for axis in axes]

    def setconstrain(self, constrain: bool) -> None:
        """Set whether the rotation is constrained to an axis."""
        self._is_constrained = constrain is True

    def getconstrain(self) -> bool:
        """Return whether the rotation is constrained to an axis."""
        return self._is_constrained

    def down(self, point: Sequence[float]) -> None:
        """Begin to drag at a point [pixels]."""
        self._pressed = arcball_map_to_sphere(point, self._center, self._radius)
        self._at_press = self._before = self._now
        self._axis = None
        if self._is_constrained and self._axes is not None:
            self._axis = arcball_nearest_axis(self._pressed, self._axes)
            self._pressed = arcball_constrain_to_axis(self._pressed, self._axis)

    def drag(self, point: Sequence[float]) -> None:
        """Drag to a point [pixels]."""
        goal = arcball_map_to_sphere(point, self._center, self._radius)
        if self._axis is not None:
            goal = arcball_constrain_to_axis(goal, self._axis)
        self._before = self._now
        turn = np.cross(self._pressed, goal)
        self._now = self._at_press
        if dot(turn, turn) >= EPSILON:
            self._now = quaternion_multiply((*turn, dot(self._pressed, goal)), self._at_press)

    def next(self, acceleration: float = 0.0) -> None:
        """Continue the rotation of the last drag."""
        self._before, self._now = self._now, quaternion_slerp(self._before, self._now, 2.0 + acceleration, 0)

    def matrix(self) -> Array:
        """Return the rotation."""
        return quaternion_matrix(self._now)


def arcball_map_to_sphere(point: Sequence[float], center: Sequence[float], radius: float) -> Array:
    """Return the point of the unit sphere at a point of the picture [pixels]."""
    x, y = (point[0] - center[0]) / radius, (center[1] - point[1]) / radius
    square = x * x + y * y
    if square > 1.0:
        return np.array((x, y, 0.0)) / math.sqrt(square)
    return np.array((x, y, math.sqrt(1.0 - square)))


def arcball_constrain_to_axis(point: Any, axis: Any) -> Array:
    """Return the point of the unit sphere that is perpendicular to an axis and nearest to another point."""
    direction = to_array(axis)
    rest = to_array(point) - direction * dot(direction, point)
    length = vector_norm(rest)
    if length > EPSILON:
        return rest / (-length if rest[2] < 0.0 else length)  # type: ignore[no-any-return]
    if direction[2] == 1.0:
        return np.array((1.0, 0.0, 0.0))
    return unit_vector((-direction[1], direction[0], 0.0))  # type: ignore[no-any-return]


def arcball_nearest_axis(point: Any, axes: Sequence[Any]) -> Any:
    """Return the axis whose circle on the sphere is nearest to a point."""
    return max(axes, key=lambda axis: float(dot(arcball_constrain_to_axis(point, axis), point)))
