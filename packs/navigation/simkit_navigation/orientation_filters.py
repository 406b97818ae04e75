"""Filters that estimate an orientation from angular velocity, acceleration and magnetic field.

Orientations are quaternions (w, x, y, z) that rotate vectors of the sensor into a world with the axes east, north, up.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Final, Protocol

import numpy as np

from simkit.extend import Vector
from simkit.linear_algebra import matmul, norm
from simkit.pose import quat_multiply

Quaternion = tuple[float, float, float, float]

WORLD_FRAMES: Final[dict[str, Quaternion]] = {
    "enu": (1.0, 0.0, 0.0, 0.0),
    "nwu": (math.sqrt(0.5), 0.0, 0.0, -math.sqrt(0.5)),
    "ned": (0.0, math.sqrt(0.5), math.sqrt(0.5), 0.0),
}
"""Rotation from east, north, up to the axes of each world frame."""

_STEADY_RATE, _STEADY_FORCE = 0.2, 0.1  # [rad/s, m/s²]: below them, the sensor counts as at rest
_GRAVITY: Final = 9.81


class OrientationFilter(Protocol):
    """Filter that estimates an orientation."""

    def update(self, rates: Vector, force: Vector, field: Vector | None, time_step: float) -> Quaternion:
        """Return the orientation after a measurement.

        Args:
            rates: angular velocity in the axes of the sensor [rad/s].
            force: acceleration in the axes of the sensor; +9.8 upwards at rest [m/s²].
            field: magnetic field in the axes of the sensor [T]; None without one.
            time_step: time since the last measurement [s].
        """
        ...


def initial_orientation(force: Vector, field: Vector | None) -> Quaternion:
    """Return the orientation at rest; the x axis points to the east without a magnetic field."""
    up = force / norm(force)
    hint = np.array([1.0, 0.0, 0.0]) if abs(up[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
    east = hint - up * float(matmul(hint, up)) if field is None else np.cross(field, up)
    east = east / norm(east)
    matrix = np.array([east, np.cross(up, east), up])  # rows: axes of the world in the axes of the sensor
    return _quaternion_of(matrix)


def _quaternion_of(m: Vector) -> Quaternion:
    """Return the quaternion of a rotation matrix, with w ≥ 0."""
    squares = [1 + m[0, 0] + m[1, 1] + m[2, 2], 1 + m[0, 0] - m[1, 1] - m[2, 2]]
    squares += [1 - m[0, 0] + m[1, 1] - m[2, 2], 1 - m[0, 0] - m[1, 1] + m[2, 2]]
    w, x, y, z = (math.sqrt(max(float(square), 0.0)) / 2 for square in squares)
    if max(w, x, y, z) > w:  # the largest of them has the smallest error
        largest = (x, y, z).index(max(x, y, z))
        sums = [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]]
        main = (x, y, z)[largest]
        others = [main if k == largest else float(m[k, largest] + m[largest, k]) / (4 * main) for k in range(3)]
        return _normalised((float(sums[largest]) / (4 * main), *others))
    return _normalised(
        (w, *(float(value) / (4 * w) for value in (m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1])))
    )


def _normalised(q: Iterable[float]) -> Quaternion:
    values = [float(value) for value in q]
    length = float(norm(np.array(values)))
    w, x, y, z = (value / length for value in values)
    return w, x, y, z


def _rotated(q: Quaternion, rates: Vector, time_step: float) -> Quaternion:
    """Return an orientation after a rotation with constant angular velocity."""
    angle = float(norm(rates)) * time_step
    if angle == 0.0:
        return q
    sine = math.sin(angle / 2) / float(norm(rates))
    return _normalised(quat_multiply(q, (math.cos(angle / 2), *(float(rate) * sine for rate in rates))))


def _to_world(q: Quaternion, vector: Vector) -> Vector:
    w, x, y, z = q
    turned = quat_multiply(quat_multiply(q, (0.0, *(float(v) for v in vector))), (w, -x, -y, -z))
    return np.array(turned[1:])


class MadgwickFilter:
    """Filter of Madgwick: a step of gradient descent towards the measured directions at each measurement.

    Args:
        gain: speed of the descent β [rad/s].
        drift: speed at which the bias of the gyroscope is learned ζ [rad/s²].
    """

    def __init__(self, gain: float, drift: float = 0.0) -> None:
        self._gain, self._drift = gain, drift
        self._q: Quaternion | None = None
        self._bias = np.zeros(3)

    def update(self, rates: Vector, force: Vector, field: Vector | None, time_step: float) -> Quaternion:
        """Return the orientation after a measurement; see `OrientationFilter`."""
        if self._q is None:
            self._q = initial_orientation(force, field)
            return self._q
        length = float(norm(force))
        gradient = _gradient(self._q, np.array([0.0, 0.0, 1.0]), force / length) if length > 0 else np.zeros(4)
        if field is not None and float(norm(field)) > 0:
            measured = field / norm(field)
            world = _to_world(self._q, measured)
            reference = np.array([0.0, math.hypot(world[0], world[1]), world[2]])
            gradient = gradient + _gradient(self._q, reference, measured)
        size = float(norm(gradient))
        if size > 0:
            gradient = gradient / size
            w, x, y, z = self._q
            error = quat_multiply((w, -x, -y, -z), tuple(float(value) for value in gradient))
            self._bias = self._bias + 2 * self._drift * time_step * np.array(error[1:])
        turned = _rotated(self._q, rates - self._bias, time_step)
        self._q = _normalised([a - self._gain * time_step * float(b) for a, b in zip(turned, gradient, strict=True)])
        return self._q


def _gradient(q: Quaternion, reference: Vector, measured: Vector) -> Vector:
    """Return the gradient of half the squared error of a direction with respect to the quaternion.

    Args:
        q: orientation.
        reference: direction in the world.
        measured: direction in the axes of the sensor.
    """
    w, x, y, z = q
    a, b, c = (float(value) for value in reference)
    predicted = _to_world((w, -x, -y, -z), reference)
    # columns: derivatives of the predicted direction with respect to w, x, y, z, for quaternions of length 1
    columns = [
        [b * z - c * y, c * x - a * z, a * y - b * x],
        [b * y + c * z, a * y - 2 * b * x + c * w, a * z - b * w - 2 * c * x],
        [b * x - 2 * a * y - c * w, a * x + c * z, a * w + b * z - 2 * c * y],
        [b * w - 2 * a * z + c * x, c * y - a * w - 2 * b * z, a * x + b * y],
    ]
    return np.asarray(2 * matmul(np.array(columns), predicted - measured))


class ComplementaryFilter:
    """Complementary filter: the gyroscope gives fast changes, acceleration and magnetic field the slow ones.

    Args:
        force_gain: part of the error of the vertical that is corrected at each measurement.
        field_gain: part of the error of north that is corrected at each measurement.
        bias_gain: part of the gyroscope's reading at rest that becomes its bias; 0 for no bias.
    """

    def __init__(self, force_gain: float, field_gain: float, bias_gain: float) -> None:
        self._force_gain, self._field_gain, self._bias_gain = force_gain, field_gain, bias_gain
        self._q: Quaternion | None = None
        self._bias = np.zeros(3)

    def update(self, rates: Vector, force: Vector, field: Vector | None, time_step: float) -> Quaternion:
        """Return the orientation after a measurement; see `OrientationFilter`."""
        if self._q is None:
            self._q = initial_orientation(force, field)
            return self._q
        at_rest = abs(float(norm(force)) - _GRAVITY) < _STEADY_FORCE and bool(np.abs(rates).max() < _STEADY_RATE)
        if at_rest:
            self._bias = self._bias + self._bias_gain * (rates - self._bias)
        q = _rotated(self._q, rates - self._bias, time_step)
        if float(norm(force)) > 0:
            x, y, z = (float(v) for v in _to_world(q, force / norm(force)))
            axis = np.array([y, -x, 0.0])  # about which the measured vertical turns to the true one
            q = _corrected(q, axis, math.atan2(math.hypot(x, y), z) * self._force_gain)
        if field is not None:
            east, north, _ = (float(v) for v in _to_world(q, field))
            q = _corrected(q, np.array([0.0, 0.0, 1.0]), math.atan2(east, north) * self._field_gain)
        self._q = q
        return q


def _corrected(q: Quaternion, axis: Vector, angle: float) -> Quaternion:
    """Return an orientation after a rotation about an axis of the world."""
    length = float(norm(axis))
    if length < 1e-12 or angle == 0.0:
        return q
    sine = math.sin(angle / 2) / length
    return _normalised(quat_multiply((math.cos(angle / 2), *(float(value) * sine for value in axis)), q))
