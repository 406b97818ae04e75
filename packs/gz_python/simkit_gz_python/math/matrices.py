"""Matrices of gz-math; `==` allows a difference of 1e-6 in each element."""

from __future__ import annotations

from typing import Any, ClassVar, TypeVar

import numpy as np
import numpy.typing as npt

from simkit import linear_algebra
from simkit_gz_python.math.pose import Pose3d
from simkit_gz_python.math.quaternion import Quaterniond
from simkit_gz_python.math.scalars import DEFAULT_TOLERANCE, format_number
from simkit_gz_python.math.value_base import ClassConstant, CppArgument, Value
from simkit_gz_python.math.vectors import Vector3d, VectorLike, components_of

Rows = npt.NDArray[np.float64]
M = TypeVar("M", bound="_SquareMatrix")


class _SquareMatrix(Value):
    """Base class of the matrices; `m(row, column)` returns an element.

    Attributes:
        SIZE: number of rows and columns.
    """

    SIZE: ClassVar[int]
    _m: Rows

    @classmethod
    def of(cls: type[M], rows: npt.ArrayLike) -> M:
        """Create a matrix from an array of rows."""
        return cls(*np.asarray(rows, dtype=float).reshape(-1).tolist())

    def _index(self, row: int, column: int) -> tuple[int, int]:
        return min(int(row), self.SIZE - 1), min(int(column), self.SIZE - 1)

    def __call__(self, row: int, column: int) -> float:
        return float(self._m[self._index(row, column)])

    def determinant(self) -> float:
        return float(linear_algebra.det(self._m))

    def inverse(self: M) -> M:
        return self.of(linear_algebra.inverse(self._m))

    def transposed(self: M) -> M:
        return self.of(self._m.T)

    def _is_near(self, other: _SquareMatrix, tolerance: float) -> bool:
        return bool((np.abs(self._m - other._m) <= tolerance).all())

    def __eq__(self, other: object) -> bool:
        if isinstance(other, _SquareMatrix) and other.SIZE == self.SIZE:
            return self._is_near(other, DEFAULT_TOLERANCE)
        return NotImplemented

    def __repr__(self) -> str:
        return " ".join(format_number(v) for v in self._m.reshape(-1).tolist())


class Matrix3d(_SquareMatrix):
    """3 × 3 matrix from no argument (zeros), nine numbers row by row, or a rotation; `m(row, column)` is an element."""

    SIZE = 3
    IDENTITY = ClassConstant(1, 0, 0, 0, 1, 0, 0, 0, 1)
    ZERO = ClassConstant()

    def __init__(self, *values: CppArgument) -> None:
        self._m = np.zeros((3, 3))
        if len(values) == 9:
            self.set(*values)
        elif len(values) == 1 and callable(getattr(values[0], "w", None)):
            self._m[:] = np.array([list(values[0].rotate_vector(row)) for row in np.eye(3).tolist()]).T
        elif len(values) == 1 and callable(values[0]):
            self._m[:] = [[values[0](i, j) for j in range(3)] for i in range(3)]
        elif values:
            raise TypeError(f"expected 0 or 9 numbers, a rotation or a 3 x 3 matrix, got {values!r}")

    def array(self) -> Rows:
        """Return a copy as a NumPy array, shape (3, 3)."""
        return self._m.copy()

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> Rows:
        return np.array(self._m, dtype=dtype)

    def set(self, *values: float) -> None:
        """Set nine numbers row by row, or (row, column, number)."""
        if len(values) == 9:
            self._m[:] = np.reshape([float(v) for v in values], (3, 3))
        else:
            self._m[self._index(int(values[0]), int(values[1]))] = values[2]

    def set_axes(self, x: VectorLike, y: VectorLike, z: VectorLike) -> None:
        """Set the three columns of the matrix."""
        for column, axis in enumerate((x, y, z)):
            self.set_col(column, axis)

    def set_col(self, column: int, values: VectorLike) -> None:
        self._m[:, column] = components_of(values, 3)

    def set_from_axis_angle(self, axis: VectorLike, angle: float) -> None:
        self._m[:] = Matrix3d(Quaterniond(axis, angle))._m

    def set_from_2_axes(self, first: VectorLike, second: VectorLike) -> None:
        rotation = Quaterniond()
        rotation.set_from_2_axes(first, second)
        self._m[:] = Matrix3d(rotation)._m

    def transpose(self) -> None:
        self._m = self._m.T.copy()

    def __add__(self, other: Matrix3d) -> Matrix3d:
        return Matrix3d.of(self._m + other._m)

    def __sub__(self, other: Matrix3d) -> Matrix3d:
        return Matrix3d.of(self._m - other._m)

    def __mul__(self, other: CppArgument) -> Any:
        if isinstance(other, Matrix3d):
            return Matrix3d.of(linear_algebra.matmul(self._m, other._m))
        if isinstance(other, (int, float)):
            return Matrix3d.of(self._m * other)
        return Vector3d(*linear_algebra.matmul(self._m, np.array(components_of(other, 3))).tolist())

    def __rmul__(self, other: float) -> Matrix3d:
        return Matrix3d.of(self._m * other)

    def equal(self, other: Matrix3d, tolerance: float) -> bool:
        return self._is_near(other, tolerance)


class Matrix4d(_SquareMatrix):
    """4 × 4 matrix, usually a homogeneous transform; from no argument (zeros), 16 numbers, a rotation or a pose."""

    SIZE = 4
    IDENTITY = ClassConstant(*np.eye(4).reshape(16).tolist())
    ZERO = ClassConstant()

    def __init__(self, *values: CppArgument) -> None:
        self._m = np.zeros((4, 4))
        if len(values) == 16:
            self._m[:] = np.reshape([float(v) for v in values], (4, 4))
        elif len(values) == 1 and isinstance(values[0], Matrix4d):
            self._m[:] = values[0]._m
        elif len(values) == 1:
            value = values[0]
            rotation = value.rot() if callable(getattr(value, "rot", None)) else value
            self._m[:3, :3], self._m[3, 3] = Matrix3d(rotation)._m, 1.0
            if rotation is not value:
                self._m[:3, 3] = components_of(value.pos(), 3)

    def translation(self) -> Vector3d:
        return Vector3d(*self._m[:3, 3].tolist())

    def set_translation(self, value: VectorLike) -> None:
        self._m[:3, 3] = components_of(value, 3)

    def rotation(self) -> Quaterniond:
        return Quaterniond(Matrix3d.of(self._m[:3, :3]))

    def pose(self) -> Pose3d:
        """Return the transform as a pose."""
        return Pose3d(self.translation(), self.rotation())

    def __mul__(self, other: CppArgument) -> Any:
        if isinstance(other, Matrix4d):
            return Matrix4d.of(linear_algebra.matmul(self._m, other._m))
        return Vector3d(*linear_algebra.matmul(self._m, np.array([*components_of(other, 3), 1.0]))[:3].tolist())
