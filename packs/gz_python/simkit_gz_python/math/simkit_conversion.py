"""Conversion between simkit's poses and vectors and those of gz-math."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from simkit import Pose
from simkit.extend import Vector
from simkit_gz_python.math.pose import Pose3d
from simkit_gz_python.math.vectors import Vector3d, VectorLike, components_of


class QuaternionLike(Protocol):
    """Quaternion with the methods of gz-math's quaternions, from simkit or from another library."""

    def w(self) -> float: ...

    def x(self) -> float: ...

    def y(self) -> float: ...

    def z(self) -> float: ...


class PoseLike(Protocol):
    """Pose with the methods of gz-math's poses, from simkit or from another library."""

    def pos(self) -> VectorLike: ...

    def rot(self) -> QuaternionLike: ...


def simkit_pose(value: PoseLike) -> Pose:
    """Convert a pose with gz-math's methods to simkit's pose."""
    rotation = value.rot()
    return Pose(three_numbers(value.pos()), (rotation.w(), rotation.x(), rotation.y(), rotation.z()))


def gz_pose(pose: Pose) -> Pose3d:
    """Convert simkit's pose to gz-math's pose."""
    return Pose3d(*pose.position.tolist(), *pose.quaternion.tolist())


def three_numbers(value: VectorLike) -> tuple[float, float, float]:
    """Return the three components of a vector that has gz-math's methods or is a sequence."""
    x, y, z = components_of(value, 3)
    return x, y, z


def gz_vector(values: Sequence[float] | Vector) -> Vector3d:
    """Convert three numbers to gz-math's vector."""
    return Vector3d(*(float(v) for v in values))


def cross_product(a: Sequence[float], b: Sequence[float]) -> tuple[float, float, float]:
    """Return the cross product of two vectors, without NumPy: several times faster for a single pair."""
    ax, ay, az = a
    bx, by, bz = b
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
