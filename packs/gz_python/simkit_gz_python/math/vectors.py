"""Vectors of gz-math. Arithmetic applies to each component; as in gz-math, `==` allows a difference of 1e-3."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterator, Sequence
from typing import ClassVar, Final, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

from simkit.float_sum import float_sum
from simkit_gz_python.math.scalars import DEFAULT_TOLERANCE, round_half_away
from simkit_gz_python.math.value_base import ClassConstant, Components, CppArgument, HasComponents, Operand

V = TypeVar("V", bound="Vector")
EQUALITY_TOLERANCE: Final = 1e-3
"""Largest difference of a component for which `==` of vectors, quaternions and angles is true."""


VectorLike: TypeAlias = "Vector | HasComponents | Sequence[float] | npt.NDArray[np.float64]"
"""Types that functions of gz-math accept as a vector."""


def components_of(value: VectorLike, size: int) -> tuple[float, ...]:
    """Return the components of a vector of this module, of an object with `x()`, `y()`, …, or of a sequence.

    Raises:
        TypeError: the value has a different type, or does not have `size` components.
    """
    if isinstance(value, Vector):
        components = tuple(value._v)
    elif callable(getattr(value, "x", None)):
        components = tuple(float(getattr(value, axis)()) for axis in "xyzw"[:size])
    else:
        components = tuple(float(v) for v in value)  # type: ignore[union-attr]
    if len(components) != size:
        raise TypeError(f"expected a vector of {size} numbers, got {value!r}")
    return components


class Vector(Components):
    """Base class of the vectors with two, three and four numbers.

    Attributes:
        SIZE: number of components.
        NUMBER: type of a component, `float` or `int`.
    """

    SIZE: ClassVar[int]
    NUMBER: ClassVar[type[float] | type[int]] = float

    def __init__(self, *values: CppArgument) -> None:
        if len(values) == 1:
            values = components_of(values[0], self.SIZE)
        if values and len(values) != self.SIZE:
            raise TypeError(f"expected {self.SIZE} numbers for {type(self).__name__}, got {len(values)}")
        number = type(self).NUMBER
        self._v: list[float] = [number(v) for v in values] if values else [number(0)] * self.SIZE

    # ------------------------------------------------------------------ components

    def _component(self, index: int, value: tuple[float, ...]) -> float:
        if value:
            self._v[index] = type(self).NUMBER(value[0])
            return None  # type: ignore[return-value]  # a setter call has no result
        return self._v[index]

    def x(self, *value: float) -> float:
        """Return the first component; with an argument, set it."""
        return self._component(0, value)

    def y(self, *value: float) -> float:
        """Return the second component; with an argument, set it."""
        return self._component(1, value)

    def set_x(self, value: float) -> None:
        self._component(0, (value,))

    def set_y(self, value: float) -> None:
        self._component(1, (value,))

    def set(self, *values: float) -> None:
        """Set all components; a missing component becomes 0."""
        padded = [*values, *[0] * (self.SIZE - len(values))]
        self._v[:] = [type(self).NUMBER(v) for v in padded]

    def __getitem__(self, index: int) -> float:
        if not 0 <= index < self.SIZE:
            raise IndexError(f"{type(self).__name__} has components 0 to {self.SIZE - 1}, not {index}")
        return self._v[index]

    def __setitem__(self, index: int, value: float) -> None:
        if not 0 <= index < self.SIZE:
            raise IndexError(f"{type(self).__name__} has components 0 to {self.SIZE - 1}, not {index}")
        self._v[index] = type(self).NUMBER(value)

    def __iter__(self) -> Iterator[float]:
        return iter(tuple(self._v))

    def __len__(self) -> int:
        return self.SIZE

    # ------------------------------------------------------------------ arithmetic by component

    def _numbers_of(self, other: Operand) -> Sequence[float] | None:
        if isinstance(other, (int, float)):
            return [other] * self.SIZE
        is_vector = isinstance(other, Vector) or callable(getattr(other, "x", None))
        return components_of(other, self.SIZE) if is_vector else None  # type: ignore[arg-type]

    def __mul__(self: V, other: Operand) -> V:
        return self._with(other, operator.mul)

    def __truediv__(self: V, other: Operand) -> V:
        return self._with(other, _divide)

    def __iadd__(self: V, other: Operand) -> V:
        return self._assign(self + other)

    def __isub__(self: V, other: Operand) -> V:
        return self._assign(self - other)

    def __imul__(self: V, other: Operand) -> V:
        return self._assign(self * other)

    def __itruediv__(self: V, other: Operand) -> V:
        return self._assign(self / other)

    __rmul__ = __mul__
    __radd__ = Components.__add__

    def __neg__(self: V) -> V:
        return type(self)(*(-a for a in self._v))

    def _assign(self: V, other: V) -> V:
        """Assign the components in place: as in C++, `a += b` changes the vector itself and creates no new vector."""
        self._v[:] = other._v
        return self

    # ------------------------------------------------------------------ measures

    def sum(self) -> float:
        return float_sum(self._v)

    def dot(self, other: VectorLike) -> float:
        return float_sum(a * b for a, b in zip(self._v, components_of(other, self.SIZE), strict=True))

    def abs_dot(self, other: VectorLike) -> float:
        """Return the sum of the absolute values of the products of the components."""
        return float_sum(abs(a * b) for a, b in zip(self._v, components_of(other, self.SIZE), strict=True))

    def squared_length(self) -> float:
        return float_sum(a * a for a in self._v)

    def length(self) -> float:
        return math.sqrt(self.squared_length())

    def distance(self, *other: VectorLike | float) -> float:
        """Return the distance to another point; the argument is a vector, or its components as several arguments."""
        return (self - type(self)(*other)).length()

    def normalize(self: V) -> V:
        """Scale this vector to length 1, and return a copy; a vector with a length up to 1e-6 stays the same."""
        length = self.length()
        if length > DEFAULT_TOLERANCE:
            self._assign(self / length)
        return type(self)(*self._v)

    def normalized(self: V) -> V:
        return type(self)(*self._v).normalize()

    def abs(self: V) -> V:
        return type(self)(*(abs(a) for a in self._v))

    def round(self: V, digits: int | None = None) -> V | None:
        """Round to integers, or to a number of decimal places."""
        power = 10.0 ** (digits or 0)
        self._v[:] = [type(self).NUMBER(round_half_away(a * power) / power) for a in self._v]
        return type(self)(*self._v) if digits is None else None

    def rounded(self: V) -> V:
        copy = type(self)(*self._v)
        copy.round()
        return copy

    def max(self, *other: VectorLike) -> float | None:
        """Return the largest component; with an argument, set each component to the larger one of both vectors."""
        if not other:
            return max(self._v)
        self._v[:] = [max(a, b) for a, b in zip(self._v, components_of(other[0], self.SIZE), strict=True)]
        return None

    def min(self, *other: VectorLike) -> float | None:
        """Return the smallest component; with an argument, set each component to the smaller one of both vectors."""
        if not other:
            return min(self._v)
        self._v[:] = [min(a, b) for a, b in zip(self._v, components_of(other[0], self.SIZE), strict=True)]
        return None

    def is_finite(self) -> bool:
        return all(map(math.isfinite, self._v))

    def correct(self) -> None:
        """Replace NaN and infinite components by 0."""
        self._v[:] = [a if math.isfinite(a) else type(self).NUMBER(0) for a in self._v]

    # ------------------------------------------------------------------ equality and text

    def equal(self, other: VectorLike, tolerance: float = EQUALITY_TOLERANCE) -> bool:
        """Check whether every component is within a tolerance."""
        return self._is_near(components_of(other, self.SIZE), tolerance)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Vector):
            return len(other) == self.SIZE and self.equal(other)
        return NotImplemented


def _divide(a: float, b: float) -> float:
    if b:
        return a / b
    return math.copysign(math.inf, a) * math.copysign(1.0, b) if a else math.nan


class Vector2d(Vector):
    """Vector of two numbers."""

    SIZE = 2
    ZERO = ClassConstant(0, 0)
    ONE = ClassConstant(1, 1)
    NAN = ClassConstant(math.nan, math.nan)


class Vector3d(Vector):
    """Vector of three numbers."""

    SIZE = 3
    ZERO = ClassConstant(0, 0, 0)
    ONE = ClassConstant(1, 1, 1)
    UNIT_X = ClassConstant(1, 0, 0)
    UNIT_Y = ClassConstant(0, 1, 0)
    UNIT_Z = ClassConstant(0, 0, 1)
    NAN = ClassConstant(math.nan, math.nan, math.nan)

    def z(self, *value: float) -> float:
        """Return the third component; with an argument, set it."""
        return self._component(2, value)

    def set_z(self, value: float) -> None:
        self._component(2, (value,))

    def cross(self: V, other: VectorLike) -> V:
        ax, ay, az = self._v
        bx, by, bz = components_of(other, 3)
        return type(self)(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)

    def perpendicular(self: V) -> V:
        """Return a perpendicular vector: the cross product with the x axis, or with the y axis if that is near zero.

        The length of the result is not 1.
        """
        product = Vector3d.cross(self, (1.0, 0.0, 0.0))
        return product if product.squared_length() >= DEFAULT_TOLERANCE**2 else Vector3d.cross(self, (0.0, 1.0, 0.0))

    @classmethod
    def normal(cls, a: VectorLike, b: VectorLike, c: VectorLike) -> Vector3d:
        """Return the unit normal of a triangle, by the right-hand rule."""
        first, second, third = cls(a), cls(b), cls(c)
        return (second - first).cross(third - first).normalize()

    def dist_to_line(self, a: VectorLike, b: VectorLike) -> float:
        """Return the distance to the infinite line through two points."""
        first, second = Vector3d(a), Vector3d(b)
        point = Vector3d(*self._v)
        return (point - first).cross(point - second).length() / (second - first).length()


class Vector4d(Vector):
    """Vector of four numbers."""

    SIZE = 4
    ZERO = ClassConstant(0, 0, 0, 0)
    ONE = ClassConstant(1, 1, 1, 1)
    NAN = ClassConstant(math.nan, math.nan, math.nan, math.nan)

    def z(self, *value: float) -> float:
        """Return the third component; with an argument, set it."""
        return self._component(2, value)

    def w(self, *value: float) -> float:
        """Return the fourth component; with an argument, set it."""
        return self._component(3, value)


class Vector2f(Vector2d):
    """Vector of two numbers, also in double precision."""


class Vector3f(Vector3d):
    """Vector of three numbers, also in double precision."""


class Vector4f(Vector4d):
    """Vector of four numbers, also in double precision."""


class Vector2i(Vector2d):
    """Vector of two integers."""

    NUMBER = int
    NAN = Vector2d.NAN  # type: ignore[assignment]  # integers have no NaN


class Vector3i(Vector3d):
    """Vector of three integers."""

    NUMBER = int
    NAN = Vector3d.NAN  # type: ignore[assignment]  # integers have no NaN


class Vector4i(Vector4d):
    """Vector of four integers."""

    NUMBER = int
    NAN = Vector4d.NAN  # type: ignore[assignment]  # integers have no NaN
