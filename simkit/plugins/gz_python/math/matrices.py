"""Matrices of gz-math; `==` means within 1e-6 for each element."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from simkit.plugins.gz_python.math.class_constant import ClassConstant, CppArgument
from simkit.plugins.gz_python.math.pose import Pose3d
from simkit.plugins.gz_python.math.quaternion import Quaterniond
from simkit.plugins.gz_python.math.scalars import DEFAULT_TOLERANCE, format_number
from simkit.plugins.gz_python.math.vectors import Vector3d, VectorLike, components_of

Rows = npt.NDArray[np.float64]


class Matrix3d:
    """Three by three numbers: `Matrix3d()`, nine numbers row by row, or of a rotation; `m(row, column)` reads one."""

    IDENTITY = ClassConstant(1, 0, 0, 0, 1, 0, 0, 0, 1)
    ZERO = ClassConstant()
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, *values: CppArgument) -> None:
        self._m: Rows = np.zeros((3, 3))
        if len(values) == 9:
            self.set(*values)
        elif len(values) == 1 and callable(getattr(values[0], "w", None)):
            self._m[:] = np.array([list(values[0].rotate_vector(row)) for row in np.eye(3).tolist()]).T
        elif len(values) == 1 and callable(values[0]):
            self._m[:] = [[values[0](i, j) for j in range(3)] for i in range(3)]
        elif values:
            raise TypeError(f"a 3 x 3 matrix takes nothing, nine numbers, a rotation or a matrix, got {values!r}")

    @classmethod
    def of(cls, rows: npt.ArrayLike) -> Matrix3d:
        """From an array of rows."""
        return cls(*np.asarray(rows, dtype=float).reshape(9).tolist())

    def array(self) -> Rows:
        """A copy as NumPy's array, shape (3, 3)."""
        return self._m.copy()

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> Rows:
        return np.array(self._m, dtype=dtype)

    def __call__(self, row: int, column: int) -> float:
        return float(self._m[min(row, 2), min(column, 2)])

    def set(self, *values: float) -> None:
        """Nine numbers row by row, or (row, column, number)."""
        if len(values) == 9:
            self._m[:] = np.reshape([float(v) for v in values], (3, 3))
        else:
            self._m[min(int(values[0]), 2), min(int(values[1]), 2)] = values[2]

    def set_axes(self, x: VectorLike, y: VectorLike, z: VectorLike) -> None:
        """One axis for each column."""
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

    def determinant(self) -> float:
        return float(np.linalg.det(self._m))

    def inverse(self) -> Matrix3d:
        return Matrix3d.of(np.linalg.inv(self._m))

    def transpose(self) -> None:
        self._m = self._m.T.copy()

    def transposed(self) -> Matrix3d:
        return Matrix3d.of(self._m.T)

    def __add__(self, other: Matrix3d) -> Matrix3d:
        return Matrix3d.of(self._m + other._m)

    def __sub__(self, other: Matrix3d) -> Matrix3d:
        return Matrix3d.of(self._m - other._m)

    def __mul__(self, other: CppArgument) -> Any:
        if isinstance(other, Matrix3d):
            return Matrix3d.of(self._m @ other._m)
        if isinstance(other, (int, float)):
            return Matrix3d.of(self._m * other)
        return Vector3d(*(self._m @ np.array(components_of(other, 3))).tolist())

    def __rmul__(self, other: float) -> Matrix3d:
        return Matrix3d.of(self._m * other)

    def equal(self, other: Matrix3d, tolerance: float) -> bool:
        return bool((np.abs(self._m - other._m) <= tolerance).all())

    def __eq__(self, other: object) -> bool:
        return self.equal(other, DEFAULT_TOLERANCE) if isinstance(other, Matrix3d) else NotImplemented

    def __copy__(self) -> Matrix3d:
        return Matrix3d.of(self._m)

    def __deepcopy__(self, memo: dict[int, object]) -> Matrix3d:
        return Matrix3d.of(self._m)

    def __repr__(self) -> str:
        return " ".join(format_number(v) for v in self._m.reshape(9).tolist())


class Matrix4d:
    """Four by four numbers, mostly a homogeneous transform: nothing, 16 numbers, a rotation or a pose."""

    IDENTITY = ClassConstant(*np.eye(4).reshape(16).tolist())
    ZERO = ClassConstant()
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, *values: CppArgument) -> None:
        self._m: Rows = np.zeros((4, 4))
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

    def __call__(self, row: int, column: int) -> float:
        return float(self._m[min(row, 3), min(column, 3)])

    def translation(self) -> Vector3d:
        return Vector3d(*self._m[:3, 3].tolist())

    def set_translation(self, value: VectorLike) -> None:
        self._m[:3, 3] = components_of(value, 3)

    def rotation(self) -> Quaterniond:
        return Quaterniond(Matrix3d.of(self._m[:3, :3]))

    def pose(self) -> Pose3d:
        """The transform as a pose."""
        return Pose3d(self.translation(), self.rotation())

    def determinant(self) -> float:
        return float(np.linalg.det(self._m))

    def _of(self, rows: npt.NDArray[np.floating]) -> Matrix4d:
        return Matrix4d(*rows.reshape(16).tolist())

    def inverse(self) -> Matrix4d:
        return self._of(np.linalg.inv(self._m))

    def transposed(self) -> Matrix4d:
        return self._of(self._m.T.copy())

    def __mul__(self, other: CppArgument) -> Any:
        if isinstance(other, Matrix4d):
            return self._of(self._m @ other._m)
        return Vector3d(*(self._m @ np.array([*components_of(other, 3), 1.0]))[:3].tolist())

    def __eq__(self, other: object) -> bool:
        return (
            bool((np.abs(self._m - other._m) <= DEFAULT_TOLERANCE).all())
            if isinstance(other, Matrix4d)
            else NotImplemented
        )

    def __repr__(self) -> str:
        return " ".join(format_number(v) for v in self._m.reshape(16).tolist())
