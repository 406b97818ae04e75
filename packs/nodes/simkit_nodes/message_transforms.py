"""Messages in other frames, in the flavour of ROS of the message.

A transform is a `geometry_msgs/msg/TransformStamped` of either flavour, as `tf2_ros` returns it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from simkit.linear_algebra import matmul
from simkit_nodes.frame_buffer import Quaternion, Vector, multiply, rotate
from simkit_nodes.interfaces import ProgramMessage

Transforms = dict[Any, Callable[[Any, Any], object]]
"""Functions of an object and a `TransformStamped` that return an object, by name of the message type, or by class."""


def _vector(message: ProgramMessage) -> Vector:
    return float(message.x), float(message.y), float(message.z)


def _set(message: ProgramMessage, numbers: Vector) -> None:
    message.x, message.y, message.z = numbers


def unit_quaternion(message: ProgramMessage) -> Quaternion:
    """Return the quaternion of a message with length 1; no rotation if it is zero."""
    x, y, z, w = float(message.x), float(message.y), float(message.z), float(message.w)
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    return (x / norm, y / norm, z / norm, w / norm) if norm > 1e-8 else (0.0, 0.0, 0.0, 1.0)


def _moved(vector: Any, transform: ProgramMessage) -> Vector:
    x, y, z = rotate(unit_quaternion(transform.rotation), _vector(vector))
    base = _vector(transform.translation)
    return x + base[0], y + base[1], z + base[2]


def transformed_point(point: Any, transform: ProgramMessage) -> Any:
    """Return a `PointStamped` in another frame."""
    result = type(point)()
    _set(result.point, _moved(point.point, transform.transform))
    result.header = transform.header
    return result


def transformed_vector(vector3: Any, transform: ProgramMessage) -> Any:
    """Return a `Vector3Stamped` in another frame; it turns and does not move."""
    result = type(vector3)()
    _set(result.vector, rotate(unit_quaternion(transform.transform.rotation), _vector(vector3.vector)))
    result.header = transform.header
    return result


def transformed_pose(pose: ProgramMessage, transform: ProgramMessage) -> Any:
    """Return a `Pose` in another frame; w of its quaternion is not negative."""
    result = type(pose)()
    _set(result.position, _moved(pose.position, transform.transform))
    x, y, z, w = multiply(unit_quaternion(transform.transform.rotation), unit_quaternion(pose.orientation))
    sign = -1.0 if w < 0.0 else 1.0
    _set(result.orientation, (sign * x, sign * y, sign * z))
    result.orientation.w = sign * w
    return result


def transformed_pose_stamped(pose: ProgramMessage, transform: ProgramMessage) -> Any:
    """Return a `PoseStamped` in another frame."""
    result = type(pose)()
    result.pose = transformed_pose(pose.pose, transform)
    result.header = transform.header
    return result


def transformed_covariance(covariance: Any, transform: ProgramMessage) -> Any:
    """Return the 36 numbers of a pose's covariance in another frame."""
    turn = np.zeros((6, 6))
    turn[:3, :3] = turn[3:, 3:] = rotation_matrix(transform.transform)
    return matmul(turn, np.array(covariance, np.float64).reshape(6, 6), turn.T).reshape(36)


def rotation_matrix(transform: ProgramMessage) -> Any:
    """Return the 3 × 3 rotation of a `Transform`."""
    rotation = unit_quaternion(transform.rotation)
    axes: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    return np.array([rotate(rotation, axis) for axis in axes]).T


def transformed_pose_with_covariance_stamped(pose: ProgramMessage, transform: ProgramMessage) -> Any:
    """Return a `PoseWithCovarianceStamped` in another frame."""
    result = type(pose)()
    result.pose.pose = transformed_pose(pose.pose.pose, transform)
    numbers = transformed_covariance(pose.pose.covariance, transform)
    result.pose.covariance = numbers if isinstance(pose.pose.covariance, np.ndarray) else numbers.tolist()
    result.header = transform.header
    return result


def transformed_polygon_stamped(polygon: Any, transform: ProgramMessage) -> Any:
    """Return a `PolygonStamped` in another frame."""
    result = type(polygon)()
    for point in polygon.polygon.points:
        moved = type(point)()
        _set(moved, _moved(point, transform.transform))
        result.polygon.points.append(moved)
    result.header = transform.header
    return result


def transformed_wrench_stamped(wrench: Any, transform: ProgramMessage) -> Any:
    """Return a `WrenchStamped` in another frame; both vectors turn and do not move."""
    result = type(wrench)()
    turn = unit_quaternion(transform.transform.rotation)
    for name in ("force", "torque"):
        _set(getattr(result.wrench, name), rotate(turn, _vector(getattr(wrench.wrench, name))))
    result.header = transform.header
    return result


def same_message(msg: ProgramMessage) -> Any:
    """Return a message as it is."""
    return msg
