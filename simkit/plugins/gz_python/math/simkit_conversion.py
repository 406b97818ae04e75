"""Conversion between simkit's poses and vectors and those of gz-math."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from simkit.plugins.gz_python.math.pose import Pose3d
from simkit.plugins.gz_python.math.vectors import Vector3d, VectorLike, components_of
from simkit.pose import Pose, Vector


class QuaternionLike(Protocol):
    """A quaternion of gz-math's kind."""

    def w(self) -> float: ...

    def x(self) -> float: ...

    def y(self) -> float: ...

    def z(self) -> float: ...


class PoseLike(Protocol):
    """A pose of gz-math's kind, of simkit's or of another library."""

    def pos(self) -> VectorLike: ...

    def rot(self) -> QuaternionLike: ...


def simkit_pose(value: PoseLike) -> Pose:
    """simkit's pose of one of gz-math's kind."""
    rotation = value.rot()
    return Pose(three_numbers(value.pos()), (rotation.w(), rotation.x(), rotation.y(), rotation.z()))


def gz_pose(pose: Pose) -> Pose3d:
    return Pose3d(*pose.position.tolist(), *pose.quaternion.tolist())


def three_numbers(value: VectorLike) -> tuple[float, float, float]:
    """Three numbers of a vector of gz-math's kind or a sequence."""
    x, y, z = components_of(value, 3)
    return x, y, z


def gz_vector(values: Sequence[float] | Vector) -> Vector3d:
    return Vector3d(*(float(v) for v in values))


def cross_product(a: Sequence[float], b: Sequence[float]) -> tuple[float, float, float]:
    """The vector product, in plain numbers: several times faster than NumPy's for one pair."""
    ax, ay, az = a
    bx, by, bz = b
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
