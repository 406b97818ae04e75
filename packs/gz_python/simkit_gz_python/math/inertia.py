"""Masses and moments of inertia of gz-math."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from simkit.float_sum import float_sum
from simkit.linear_algebra import det, matmul
from simkit.matrix_decompositions import eigh, eigvalsh
from simkit_gz_python.math.matrices import Matrix3d
from simkit_gz_python.math.pose import Pose3d
from simkit_gz_python.math.quaternion import Quaterniond
from simkit_gz_python.math.scalars import DEFAULT_TOLERANCE
from simkit_gz_python.math.value_base import CppArgument, Value, component_getter
from simkit_gz_python.math.vectors import Vector3d, VectorLike, components_of

TOLERANCE: Final = 10.0
"""Default tolerance of gz-math, as a multiple of the rounding error."""


def _moment_setter(attribute: str, index: int) -> Callable[[MassMatrix3d, float], bool]:
    def write(self: MassMatrix3d, value: float) -> bool:
        getattr(self, attribute)[index] = value
        return self.is_valid()

    return write


class MassMatrix3d(Value):
    """Mass [kg] and moments of inertia about the centre of mass [kg·m²].

    The arguments are the mass, (ixx, iyy, izz) and (ixy, ixz, iyz).
    """

    def __init__(self, *values: CppArgument) -> None:
        self._mass, self._diagonal, self._off_diagonal = 0.0, Vector3d(), Vector3d()
        if len(values) == 1:
            values = (values[0].mass(), values[0].diagonal_moments(), values[0].off_diagonal_moments())
        if values:
            self._mass = float(values[0])
            self._diagonal, self._off_diagonal = Vector3d(values[1]), Vector3d(values[2])

    def mass(self) -> float:
        return self._mass

    def set_mass(self, mass: float) -> bool:
        self._mass = float(mass)
        return self.is_valid()

    def diagonal_moments(self) -> Vector3d:
        return Vector3d(self._diagonal)

    def set_diagonal_moments(self, moments: VectorLike) -> bool:
        self._diagonal = Vector3d(moments)
        return self.is_valid()

    def off_diagonal_moments(self) -> Vector3d:
        return Vector3d(self._off_diagonal)

    def set_off_diagonal_moments(self, moments: VectorLike) -> bool:
        self._off_diagonal = Vector3d(moments)
        return self.is_valid()

    ixx, set_ixx = component_getter("_diagonal", 0), _moment_setter("_diagonal", 0)
    iyy, set_iyy = component_getter("_diagonal", 1), _moment_setter("_diagonal", 1)
    izz, set_izz = component_getter("_diagonal", 2), _moment_setter("_diagonal", 2)
    ixy, set_ixy = component_getter("_off_diagonal", 0), _moment_setter("_off_diagonal", 0)
    ixz, set_ixz = component_getter("_off_diagonal", 1), _moment_setter("_off_diagonal", 1)
    iyz, set_iyz = component_getter("_off_diagonal", 2), _moment_setter("_off_diagonal", 2)

    def moi(self) -> Matrix3d:
        """Return the moments as a 3 × 3 matrix [kg·m²]."""
        (xx, yy, zz), (xy, xz, yz) = self._diagonal, self._off_diagonal
        return Matrix3d(xx, xy, xz, xy, yy, yz, xz, yz, zz)

    def set_moi(self, moi: Matrix3d) -> bool:
        """Set the moments from a 3 × 3 matrix; ixy is the mean of its elements (0, 1) and (1, 0), and so on."""
        self._diagonal = Vector3d(moi(0, 0), moi(1, 1), moi(2, 2))
        self._off_diagonal = Vector3d(*(0.5 * (moi(i, j) + moi(j, i)) for i, j in ((0, 1), (0, 2), (1, 2))))
        return self.is_valid()

    def set_inertia_matrix(self, ixx: float, iyy: float, izz: float, ixy: float, ixz: float, iyz: float) -> bool:
        self._diagonal, self._off_diagonal = Vector3d(ixx, iyy, izz), Vector3d(ixy, ixz, iyz)
        return self.is_valid()

    # ------------------------------------------------------------------ uniform shapes

    def set_from_box(self, *values: CppArgument) -> bool:
        """Set the moments of a uniform box.

        Args:
            values: optional mass [kg] (the current mass by default), size [m], optional rotation.
        """
        mass, (size, *rest) = self._leading_mass(values)
        x, y, z = (v * v for v in components_of(size, 3))
        return self._set_rotated(mass, (mass / 12 * (y + z), mass / 12 * (z + x), mass / 12 * (x + y)), rest)

    def set_from_cylinder_z(self, *values: CppArgument) -> bool:
        """Set the moments of a uniform cylinder along z.

        Args:
            values: optional mass [kg] (the current mass by default), length [m], radius [m], optional rotation.
        """
        *numbers, last = values
        rest = [last] if callable(getattr(last, "w", None)) else []
        numbers = numbers if rest else [*numbers, last]
        mass = float(numbers[0]) if len(numbers) == 3 else self._mass
        length, radius = numbers[-2:]
        across = mass / 12 * (3 * radius**2 + length**2)
        return self._set_rotated(mass, (across, across, mass / 2 * radius**2), rest)

    def set_from_sphere(self, *values: float) -> bool:
        """Set the moments of a uniform sphere.

        Args:
            values: optional mass [kg] (the current mass by default), radius [m].
        """
        mass = float(values[0]) if len(values) == 2 else self._mass
        moment = 0.4 * mass * float(values[-1]) ** 2
        return self._set_rotated(mass, (moment, moment, moment), [])

    def _leading_mass(self, values: tuple[CppArgument, ...]) -> tuple[float, tuple[CppArgument, ...]]:
        if isinstance(values[0], (int, float)):
            return float(values[0]), values[1:]
        return self._mass, values

    def _set_rotated(self, mass: float, moments: tuple[float, float, float], rotation: list[CppArgument]) -> bool:
        self._mass = mass
        turn = Matrix3d(rotation[0]).array() if rotation else np.eye(3)
        return self.set_moi(Matrix3d.of(matmul(turn, np.diag(moments), turn.T)))

    # ------------------------------------------------------------------ principal axes

    def principal_moments(self, tolerance: float = DEFAULT_TOLERANCE) -> Vector3d:
        """Return the principal moments in increasing order; for a diagonal matrix, the diagonal in its own order."""
        if max(abs(v) for v in self._off_diagonal) <= abs(tolerance):
            return Vector3d(self._diagonal)
        return Vector3d(*eigvalsh(self.moi().array()).tolist())

    def principal_axes_offset(self, tolerance: float = DEFAULT_TOLERANCE) -> Quaterniond:
        """Return the rotation R of the principal axes: R · diag(principal moments) · Rᵀ is the moment matrix."""
        if max(abs(v) for v in self._off_diagonal) <= abs(tolerance):
            return Quaterniond()
        _, axes = eigh(self.moi().array())
        if det(axes) < 0.0:
            axes[:, 2] *= -1.0
        return Quaterniond(Matrix3d.of(axes))

    def equivalent_box(
        self, size: Vector3d | None = None, rotation: Quaterniond | None = None, tolerance: float = DEFAULT_TOLERANCE
    ) -> bool:
        """Compute the uniform box that has these moments, and write its data into the arguments.

        Args:
            size: receives the size of the box [m].
            rotation: receives the rotation of the box.
            tolerance: largest off-diagonal moment [kg·m²] of a matrix that counts as diagonal.

        Returns:
            False if no box has these moments.
        """
        if not self.is_positive(0):
            return False
        x, y, z = self.principal_moments(tolerance)
        squares = [6.0 * v / self._mass for v in (y + z - x, z + x - y, x + y - z)]
        if any(v < 0.0 for v in squares):
            return False
        if size is not None:
            size.set(*map(math.sqrt, squares))
        if rotation is not None:
            rotation.set(*self.principal_axes_offset(tolerance)._v)
        return True

    # ------------------------------------------------------------------ validity

    @staticmethod
    def epsilon(moments: VectorLike, tolerance: float = TOLERANCE) -> float:
        """Return the allowed rounding error [kg·m²]: `tolerance` · machine epsilon · half the sum of the moments."""
        largest = 0.5 * float_sum(components_of(moments, 3))
        return abs(tolerance) * float(np.finfo(float).eps) * largest

    def is_positive(self, tolerance: float = TOLERANCE) -> bool:
        """Check whether the mass is positive and the matrix is positive definite."""
        return self._is_definite(tolerance, strict=True)

    def is_near_positive(self, tolerance: float = TOLERANCE) -> bool:
        """Check whether the mass is not negative and the matrix is positive semidefinite."""
        return self._is_definite(tolerance, strict=False)

    def _is_definite(self, tolerance: float, strict: bool) -> bool:
        slack = self.epsilon(self._diagonal, tolerance)
        (xx, yy, _), (xy, _, _) = self._diagonal, self._off_diagonal
        minors = (self._mass, xx, xx * yy - xy * xy, self.moi().determinant())
        least = slack if strict else -slack
        return all(m > least if strict else m >= least for m in minors)

    def is_valid(self, tolerance: float = TOLERANCE) -> bool:
        """Check whether a physical body can have these moments.

        The matrix must be positive semidefinite, and each principal moment at most the sum of the two others.
        """
        return self.is_near_positive(tolerance) and self.valid_moments(self.principal_moments(), tolerance)

    @classmethod
    def valid_moments(cls, moments: VectorLike, tolerance: float = 0.1) -> bool:
        x, y, z = components_of(moments, 3)
        slack = cls.epsilon(moments, tolerance)
        return min(x, y, z) + slack >= 0 and min(x + y - z, y + z - x, z + x - y) + slack >= 0

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, MassMatrix3d):
            return NotImplemented
        is_same = abs(self._mass - other._mass) <= DEFAULT_TOLERANCE
        return is_same and self._diagonal == other._diagonal and self._off_diagonal == other._off_diagonal


class Inertiald(Value):
    """Mass matrix and pose: the pose is at the centre of mass, and the moments refer to the axes of the pose."""

    def __init__(self, *values: CppArgument) -> None:
        self._matrix, self._pose = MassMatrix3d(), Pose3d()
        if len(values) == 1:
            values = (values[0].mass_matrix(), values[0].pose())
        if values:
            self._matrix, self._pose = MassMatrix3d(values[0]), Pose3d(values[1])

    def mass_matrix(self) -> MassMatrix3d:
        return MassMatrix3d(self._matrix)

    def set_mass_matrix(self, matrix: MassMatrix3d, tolerance: float = TOLERANCE) -> bool:
        self._matrix = MassMatrix3d(matrix)
        return self._matrix.is_valid(tolerance)

    def pose(self) -> Pose3d:
        return Pose3d(self._pose)

    def set_pose(self, pose: Pose3d) -> bool:
        self._pose = Pose3d(pose)
        return self._matrix.is_valid()

    def moi(self) -> Matrix3d:
        """Return the moments about the centre of mass, in the axes of the frame that contains the pose."""
        turn = Matrix3d(self._pose.rot()).array()
        return Matrix3d.of(matmul(turn, self._matrix.moi().array(), turn.T))

    def set_inertial_rotation(self, rotation: Quaterniond) -> bool:
        """Set the rotation of the pose and adapt the mass matrix, so that `moi` stays the same."""
        moi = self.moi().array()
        self._pose = Pose3d(self._pose.pos(), rotation)
        turn = Matrix3d(rotation).array()
        return self._matrix.set_moi(Matrix3d.of(matmul(turn.T, moi, turn)))

    def set_mass_matrix_rotation(self, rotation: Quaterniond, tolerance: float = DEFAULT_TOLERANCE) -> bool:
        """Set the rotation of the principal axes in the pose's axes and adapt the pose; `moi` stays the same."""
        moments, offset = self._matrix.principal_moments(tolerance), self._matrix.principal_axes_offset(tolerance)
        self._pose = Pose3d(self._pose.pos(), self._pose.rot() * offset * rotation.inverse())
        turn = Matrix3d(rotation).array()
        return self._matrix.set_moi(Matrix3d.of(matmul(turn, np.diag(list(moments)), turn.T)))

    def __add__(self, other: Inertiald) -> Inertiald:
        """Return the inertia of both bodies together; the axes of the result are those of the common frame."""
        mass = self._matrix.mass() + other._matrix.mass()
        if not mass > 0.0:
            return Inertiald(self)
        centres = [np.array(list(body._pose.pos())) for body in (self, other)]
        masses = [body._matrix.mass() for body in (self, other)]
        centre = (masses[0] * centres[0] + masses[1] * centres[1]) / mass
        moi = np.zeros((3, 3))
        for body, body_mass, position in zip((self, other), masses, centres, strict=True):
            arm = position - centre
            moi += body.moi().array() + body_mass * (matmul(arm, arm) * np.eye(3) - np.outer(arm, arm))
        matrix = MassMatrix3d(mass, Vector3d(), Vector3d())
        matrix.set_moi(Matrix3d.of(moi))
        return Inertiald(matrix, Pose3d(Vector3d(*centre.tolist()), Quaterniond()))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Inertiald):
            return NotImplemented
        return self._pose == other._pose and self._matrix == other._matrix
