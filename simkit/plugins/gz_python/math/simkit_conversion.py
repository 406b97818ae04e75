"""Between simkit's poses and vectors and those of gz-math, whoever made them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from simkit.plugins.gz_python.math.pose import Pose3d
from simkit.plugins.gz_python.math.vectors import Vector3d, components_of
from simkit.pose import Pose


def simkit_pose(value: Any) -> Pose:
    """simkit's pose of one of gz-math's kind."""
    rotation = value.rot()
    return Pose(three_numbers(value.pos()), (rotation.w(), rotation.x(), rotation.y(), rotation.z()))


def gz_pose(pose: Pose) -> Pose3d:
    return Pose3d(*pose.position.tolist(), *pose.quaternion.tolist())


def three_numbers(value: Any) -> tuple[float, float, float]:
    """Three numbers of a vector of gz-math's kind or a sequence."""
    x, y, z = components_of(value, 3)
    return x, y, z


def gz_vector(values: Any) -> Vector3d:
    return Vector3d(*(float(v) for v in values))


def cross_product(a: Sequence[float], b: Sequence[float]) -> tuple[float, float, float]:
    """The vector product, in plain numbers: several times faster than NumPy's for one pair."""
    ax, ay, az = a
    bx, by, bz = b
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
