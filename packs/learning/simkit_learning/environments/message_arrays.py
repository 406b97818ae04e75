"""Messages as arrays of numbers for observations, with the bounds that the messages state."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.msgs import Message

Array = npt.NDArray[np.generic]
Conversion = Callable[[Message], Array]
Bounds = tuple[npt.ArrayLike, npt.ArrayLike]
"""Lowest and highest value, for all values or for each."""

_INF: Final = np.inf
_UNIT: Final = np.array([1.0, 1.0, 1.0, 1.0])
_SKIPPED: Final = frozenset({"header", "stamp", "covariance"})


def conversion_of(message: Message) -> tuple[Conversion, Bounds]:
    """Return the function that converts messages like this one, and the bounds of its values.

    - a scan or a range: distances [m], from the shortest to the longest range. A ray without a hit has the longest.
    - an image: colours from 0 to 255, or depths [m]; rows from the top.
    - an IMU: orientation (w, x, y, z), angular velocity, linear acceleration.
    - an odometry: x, y, yaw, forward speed, speed to the left, yaw rate.
    - joint states: positions, then velocities.
    - other messages: all numbers in the order of the fields, without time stamps and covariances.
    """
    kind = msgs.type_name(message).rpartition("/")[2]
    if kind == "LaserScan":
        limits = float(message.range_min), float(message.range_max)
        return lambda m: np.minimum(np.maximum(m.ranges, limits[0]), limits[1]), limits  # `clip` takes twice as long
    if kind == "Range":
        limits = float(message.min_range), float(message.max_range)
        return lambda m: np.clip(np.array([m.range], np.float32), *limits), limits
    if kind == "Image":
        is_colour = msgs.image(message).dtype == np.uint8
        return msgs.image, (0, 255) if is_colour else (0.0, _INF)
    if kind == "Imu":
        rest = np.full(6, _INF)
        return _imu, (np.concatenate((-_UNIT, -rest)), np.concatenate((_UNIT, rest)))
    if kind == "Odometry":
        high = np.array([_INF, _INF, np.pi, _INF, _INF, _INF])
        return odometry_numbers, (-high, high)
    if kind == "JointState":
        return lambda m: np.concatenate((m.position, m.velocity)), (-_INF, _INF)
    return lambda m: np.fromiter(_numbers(m), float), (-_INF, _INF)


def _imu(message: Message) -> Array:
    q, w, a = message.orientation, message.angular_velocity, message.linear_acceleration
    return np.array([q.w, q.x, q.y, q.z, w.x, w.y, w.z, a.x, a.y, a.z])


def odometry_numbers(message: Message) -> Array:
    """Return x, y, yaw, forward speed, speed to the left and yaw rate of an odometry."""
    pose, twist = message.pose.pose, message.twist.twist
    yaw = msgs.yaw(pose.orientation)
    return np.array([pose.position.x, pose.position.y, yaw, twist.linear.x, twist.linear.y, twist.angular.z])


def _numbers(value: object) -> Iterator[float]:
    if is_dataclass(value):
        for field in fields(value):
            if field.name not in _SKIPPED and not field.name.startswith("_"):
                yield from _numbers(getattr(value, field.name))
    elif isinstance(value, (bool, int, float, np.number)):
        yield float(value)
    elif isinstance(value, (list, tuple, np.ndarray)):
        for item in value:
            yield from _numbers(item)
