"""Vectors of gz-math. Arithmetic is by components; `==` means within 1e-3, as in gz-math."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterator, Sequence
from typing import ClassVar, Final, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

from simkit.plugins.gz_python.math.scalars import DEFAULT_TOLERANCE, round_half_away
from simkit.plugins.gz_python.math.value_base import ClassConstant, Components, CppArgument, HasComponents, Operand

V = TypeVar("V", bound="Vector")
EQUALITY_TOLERANCE: Final = 1e-3
"""How far components may be apart of vectors, quaternions and angles that `==` calls equal."""


VectorLike: TypeAlias = "Vector | HasComponents | Sequence[float] | npt.NDArray[np.float64]"
"""What functions of gz-math take for a vector."""


def components_of(value: VectorLike, size: int) -> tuple[float, ...]:
    """The components of a vector of ours, of another library's `x()`, `y()`, … kind, or of a sequence.

    Raises:
        TypeError: it is none of these.
    """
    if isinstance(value, Vector):
        found = tuple(value._v)
    elif callable(getattr(value, "x", None)):
        found = tuple(float(getattr(value, axis)()) for axis in "xyzw"[:size])
    else:
        found = tuple(float(v) for v in value)  # type: ignore[union-attr]
    if len(found) != size:
        raise TypeError(f"a vector of {size} numbers is needed, got {value!r}")
    return found


class Vector(Components):
    """Base of vectors of two, three and four numbers.

    Attributes:
        SIZE: how many numbers.
        NUMBER: what a component is made with, `float` or `int`.
    """

    SIZE: ClassVar[int]
    NUMBER: ClassVar[type[float] | type[int]] = float

    def __init__(self, *values: CppArgument) -> None:
        if len(values) == 1:
            values = components_of(values[0], self.SIZE)
        if values and len(values) != self.SIZE:
            raise TypeError(f"{type(self).__name__} takes {self.SIZE} numbers, got {len(values)}")
        number = type(self).NUMBER
        self._v: list[float] = [number(v) for v in values] if values else [number(0)] * self.SIZE

    # ------------------------------------------------------------------ components

    def _component(self, index: int, value: tuple[float, ...]) -> float:
        if value:
            self._v[index] = type(self).NUMBER(value[0])
            return None  # type: ignore[return-value]  # who sets a component takes nothing
        return self._v[index]

    def x(self, *value: float) -> float:
        """The first component; with an argument, sets it."""
        return self._component(0, value)

    def y(self, *value: float) -> float:
        """The second component; with an argument, sets it."""
        return self._component(1, value)

    def set_x(self, value: float) -> None:
        self._component(0, (value,))

    def set_y(self, value: float) -> None:
        self._component(1, (value,))

    def set(self, *values: float) -> None:
        """Sets every component; those left out become 0."""
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

    # ------------------------------------------------------------------ arithmetic, by components

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
        return self._take(self + other)

    def __isub__(self: V, other: Operand) -> V:
        return self._take(self - other)

    def __imul__(self: V, other: Operand) -> V:
        return self._take(self * other)

    def __itruediv__(self: V, other: Operand) -> V:
        return self._take(self / other)

    __rmul__ = __mul__
    __radd__ = Components.__add__

    def __neg__(self: V) -> V:
        return type(self)(*(-a for a in self._v))

    def _take(self: V, other: V) -> V:
        """These components in this very object: `+=` changes what others hold too, as in C++."""
        self._v[:] = other._v
        return self

    # ------------------------------------------------------------------ measures

    def sum(self) -> float:
        return sum(self._v)

    def dot(self, other: VectorLike) -> float:
        return sum(a * b for a, b in zip(self._v, components_of(other, self.SIZE), strict=True))

    def abs_dot(self, other: VectorLike) -> float:
        """The sum of the products' magnitudes."""
        return sum(abs(a * b) for a, b in zip(self._v, components_of(other, self.SIZE), strict=True))

    def squared_length(self) -> float:
        return sum(a * a for a in self._v)

    def length(self) -> float:
        return math.sqrt(self.squared_length())

    def distance(self, *other: VectorLike | float) -> float:
        """To another point, given as a vector or by its components."""
        return (self - type(self)(*other)).length()

    def normalize(self: V) -> V:
        """Makes the length 1, unless it is below 1e-6; gives a copy of the outcome."""
        length = self.length()
        if length > DEFAULT_TOLERANCE:
            self._take(self / length)
        return type(self)(*self._v)

    def normalized(self: V) -> V:
        return type(self)(*self._v).normalize()

    def abs(self: V) -> V:
        return type(self)(*(abs(a) for a in self._v))

    def round(self: V, digits: int | None = None) -> V | None:
        """To whole numbers, or to decimal places."""
        power = 10.0 ** (digits or 0)
        self._v[:] = [type(self).NUMBER(round_half_away(a * power) / power) for a in self._v]
        return type(self)(*self._v) if digits is None else None

    def rounded(self: V) -> V:
        copy = type(self)(*self._v)
        copy.round()
        return copy

    def max(self, *other: VectorLike) -> float | None:
        """The largest component; with a vector, takes the larger of each pair."""
        if not other:
            return max(self._v)
        self._v[:] = [max(a, b) for a, b in zip(self._v, components_of(other[0], self.SIZE), strict=True)]
        return None

    def min(self, *other: VectorLike) -> float | None:
        """The smallest component; with a vector, takes the smaller of each pair."""
        if not other:
            return min(self._v)
        self._v[:] = [min(a, b) for a, b in zip(self._v, components_of(other[0], self.SIZE), strict=True)]
        return None

    def is_finite(self) -> bool:
        return all(map(math.isfinite, self._v))

    def correct(self) -> None:
        """Makes what is not finite 0."""
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
    """Two numbers."""

    SIZE = 2
    ZERO = ClassConstant(0, 0)
    ONE = ClassConstant(1, 1)
    NAN = ClassConstant(math.nan, math.nan)


class Vector3d(Vector):
    """Three numbers."""

    SIZE = 3
    ZERO = ClassConstant(0, 0, 0)
    ONE = ClassConstant(1, 1, 1)
    UNIT_X = ClassConstant(1, 0, 0)
    UNIT_Y = ClassConstant(0, 1, 0)
    UNIT_Z = ClassConstant(0, 0, 1)
    NAN = ClassConstant(math.nan, math.nan, math.nan)

    def z(self, *value: float) -> float:
        """The third component; with an argument, sets it."""
        return self._component(2, value)

    def set_z(self, value: float) -> None:
        self._component(2, (value,))

    def cross(self: V, other: VectorLike) -> V:
        ax, ay, az = self._v
        bx, by, bz = components_of(other, 3)
        return type(self)(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)

    def perpendicular(self: V) -> V:
        """Some vector at right angles to this one, not normalised: across the x axis, or else the y axis."""
        found = Vector3d.cross(self, (1.0, 0.0, 0.0))
        return found if found.squared_length() >= DEFAULT_TOLERANCE**2 else Vector3d.cross(self, (0.0, 1.0, 0.0))

    @classmethod
    def normal(cls, a: VectorLike, b: VectorLike, c: VectorLike) -> Vector3d:
        """The unit normal of a triangle, by the right hand."""
        first, second, third = cls(a), cls(b), cls(c)
        return (second - first).cross(third - first).normalize()

    def dist_to_line(self, a: VectorLike, b: VectorLike) -> float:
        """To the endless line through two points."""
        first, second = Vector3d(a), Vector3d(b)
        here = Vector3d(*self._v)
        return (here - first).cross(here - second).length() / (second - first).length()


class Vector4d(Vector):
    """Four numbers."""

    SIZE = 4
    ZERO = ClassConstant(0, 0, 0, 0)
    ONE = ClassConstant(1, 1, 1, 1)
    NAN = ClassConstant(math.nan, math.nan, math.nan, math.nan)

    def z(self, *value: float) -> float:
        """The third component; with an argument, sets it."""
        return self._component(2, value)

    def w(self, *value: float) -> float:
        """The fourth component; with an argument, sets it."""
        return self._component(3, value)


class Vector2f(Vector2d):
    """The same; numbers have double precision here."""


class Vector3f(Vector3d):
    """The same; numbers have double precision here."""


class Vector4f(Vector4d):
    """The same; numbers have double precision here."""


class Vector2i(Vector2d):
    """Two whole numbers."""

    NUMBER = int
    NAN = Vector2d.NAN  # type: ignore[assignment]  # whole numbers have none


class Vector3i(Vector3d):
    """Three whole numbers."""

    NUMBER = int
    NAN = Vector3d.NAN  # type: ignore[assignment]  # whole numbers have none


class Vector4i(Vector4d):
    """Four whole numbers."""

    NUMBER = int
    NAN = Vector4d.NAN  # type: ignore[assignment]  # whole numbers have none
