"""Axis-aligned boxes of gz-math."""

from __future__ import annotations

import math
import sys
from typing import Final

from simkit_gz_python.math.value_base import CppArgument
from simkit_gz_python.math.vectors import Vector3d, VectorLike

_LARGEST: Final = sys.float_info.max


class AxisAlignedBox:
    """Axis-aligned box [m]. `AxisAlignedBox()` is empty; otherwise the arguments are two corners or six numbers."""

    __hash__ = None  # type: ignore[assignment]

    def __init__(self, *values: CppArgument) -> None:
        self._min, self._max = Vector3d(*[_LARGEST] * 3), Vector3d(*[-_LARGEST] * 3)
        if len(values) == 1:
            values = (values[0].min(), values[0].max())
        elif len(values) == 6:
            values = (Vector3d(*values[:3]), Vector3d(*values[3:]))
        if values:
            first, second = Vector3d(values[0]), Vector3d(values[1])
            self._min, self._max = Vector3d(first), Vector3d(first)
            self._min.min(second)
            self._max.max(second)

    def min(self) -> Vector3d:
        return self._min

    def max(self) -> Vector3d:
        return self._max

    def _empty(self) -> bool:
        return any(a > b for a, b in zip(self._min, self._max, strict=True))

    def size(self) -> Vector3d:
        return Vector3d() if self._empty() else self._max - self._min

    def x_length(self) -> float:
        return float(self.size().x())

    def y_length(self) -> float:
        return float(self.size().y())

    def z_length(self) -> float:
        return float(self.size().z())

    def center(self) -> Vector3d:
        return (self._min + self._max) * 0.5

    def volume(self) -> float:
        return math.prod(self.size())

    def contains(self, point: VectorLike) -> bool:
        return all(a <= p <= b for a, p, b in zip(self._min, Vector3d(point), self._max, strict=True))

    def intersects(self, other: AxisAlignedBox) -> bool:
        return all(a <= d and c <= b for a, b, c, d in zip(self._min, self._max, other._min, other._max, strict=True))

    def merge(self, other: AxisAlignedBox) -> None:
        """Extend this box so that it contains another box."""
        self._min.min(other._min)
        self._max.max(other._max)

    def __add__(self, other: AxisAlignedBox) -> AxisAlignedBox:
        merged = AxisAlignedBox()
        merged.merge(self)
        merged.merge(other)
        return merged

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, AxisAlignedBox):
            return NotImplemented
        return self._min == other._min and self._max == other._max

    def __repr__(self) -> str:
        return f"Min[{self._min}] Max[{self._max}]"
