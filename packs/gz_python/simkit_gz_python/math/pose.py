"""Poses of gz-math; `a * b` composes two poses, as `a @ b` does with simkit's own poses."""

from __future__ import annotations

from simkit_gz_python.math.quaternion import Quaterniond
from simkit_gz_python.math.value_base import (
    ClassConstant,
    CppArgument,
    Value,
    component_getter,
    component_setter,
)
from simkit_gz_python.math.vectors import Vector3d


class Pose3d(Value):
    """Position [m] and rotation.

    The arguments are `()`, `(x, y, z, roll, pitch, yaw)`, `(x, y, z, qw, qx, qy, qz)`, `(position, rotation)` or
    `(pose)`. `pos()` and `rot()` return no copies: a change of the returned vector or rotation changes the pose.
    """

    ZERO = ClassConstant()

    def __init__(self, *values: CppArgument) -> None:
        self._p, self._q = Vector3d(), Quaterniond()
        if len(values) == 7:
            self._p.set(*values[:3])
            self._q.set(*values[3:])
        elif len(values) == 1:
            self.set(values[0].pos(), values[0].rot())
        elif values:
            self.set(*values)

    def set(self, *values: CppArgument) -> None:
        """Set the pose from x, y, z, roll, pitch, yaw, or from a position and a rotation."""
        if len(values) == 6:
            self._p.set(*values[:3])
            self._q.set_from_euler(*values[3:])
        elif len(values) == 2:
            self._p = Vector3d(values[0])
            self._q = Quaterniond(values[1])
        else:
            raise TypeError(f"expected 0, 1, 2, 6 or 7 values for a pose, got {len(values)}")

    # ------------------------------------------------------------------ components

    def pos(self) -> Vector3d:
        return self._p

    def rot(self) -> Quaterniond:
        return self._q

    x, set_x = component_getter("_p", 0), component_setter("_p", 0)
    y, set_y = component_getter("_p", 1), component_setter("_p", 1)
    z, set_z = component_getter("_p", 2), component_setter("_p", 2)

    def roll(self) -> float:
        return self._q.roll()

    def pitch(self) -> float:
        return self._q.pitch()

    def yaw(self) -> float:
        return self._q.yaw()

    # ------------------------------------------------------------------ algebra

    def inverse(self) -> Pose3d:
        inverse = self._q.inverse()
        return Pose3d(inverse.rotate_vector(-self._p), inverse)

    def __mul__(self, other: Pose3d) -> Pose3d:
        return Pose3d(self._p + self._q.rotate_vector(other.pos()), self._q * other.rot())

    def __imul__(self, other: Pose3d) -> Pose3d:
        return self._assign(self * other)

    def __add__(self, other: Pose3d) -> Pose3d:
        """Return `other * self`, as gz-math up to version 7 does; gz-math 8 has no `+` for poses."""
        return Pose3d(self.coord_position_add(other), self.coord_rotation_add(other.rot()))

    def __iadd__(self, other: Pose3d) -> Pose3d:
        return self._assign(self + other)

    def __sub__(self, other: Pose3d) -> Pose3d:
        """Return `other⁻¹ * self`: this pose relative to the other pose."""
        return Pose3d(self.coord_position_sub(other), self.coord_rotation_sub(other.rot()))

    def __isub__(self, other: Pose3d) -> Pose3d:
        return self._assign(self - other)

    def __neg__(self) -> Pose3d:
        return self.inverse()

    def _assign(self, other: Pose3d) -> Pose3d:
        self._p, self._q = other._p, other._q
        return self

    def coord_position_add(self, other: CppArgument) -> Vector3d:
        """Transform a point from this pose's frame to its parent frame; for a pose, return `(other * self).pos()`."""
        if callable(getattr(other, "pos", None)):
            moved: Vector3d = other.rot().rotate_vector(self._p) + other.pos()
            return moved
        return self._q.rotate_vector(other) + self._p

    def coord_position_sub(self, other: Pose3d) -> Vector3d:
        return other.rot().rotate_vector_reverse(self._p - other.pos())

    def coord_rotation_add(self, rotation: Quaterniond) -> Quaterniond:
        rotated: Quaterniond = rotation * self._q
        return rotated

    def coord_rotation_sub(self, rotation: Quaterniond) -> Quaterniond:
        difference: Quaterniond = rotation.inverse() * self._q
        return difference.normalized()

    def coord_pose_solve(self, other: Pose3d) -> Pose3d:
        """Return gz-math's solution a of `other = self + a`, which is exact if both rotations have the same axis."""
        rotation: Quaterniond = self._q.inverse() * other.rot()
        return Pose3d(other.pos() - rotation.rotate_vector(self._p), rotation)

    def rotate_position_about_origin(self, rotation: Quaterniond) -> Pose3d:
        return Pose3d(rotation.rotate_vector(self._p), self._q)

    # ------------------------------------------------------------------ checks and rounding

    def reset(self) -> None:
        self._p, self._q = Vector3d(), Quaterniond()

    def is_finite(self) -> bool:
        return self._p.is_finite() and self._q.is_finite()

    def correct(self) -> None:
        self._p.correct()
        self._q.correct()

    def round(self, digits: int) -> None:
        self._p.round(digits)
        self._q.round(digits)

    def equal(self, other: Pose3d, tolerance: float) -> bool:
        return self._p.equal(other.pos(), tolerance) and self._q.equal(other.rot(), tolerance)

    def __eq__(self, other: object) -> bool:
        return self._p == other._p and self._q == other._q if isinstance(other, Pose3d) else NotImplemented

    def __reduce__(self) -> tuple[type[Pose3d], tuple[float, ...]]:
        return (Pose3d, (*self._p, *self._q._v))

    def __repr__(self) -> str:
        return f"{self._p} {self._q}"
