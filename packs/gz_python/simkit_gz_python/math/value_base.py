"""Base classes of gz-math's types: copying, comparison, arithmetic, and class constants such as `Vector3d.ZERO`."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Protocol, TypeAlias, TypeVar, cast

import numpy as np
import numpy.typing as npt

from simkit_gz_python.math.scalars import format_number

T = TypeVar("T")
V = TypeVar("V", bound="Value")
C = TypeVar("C", bound="Components")
S = TypeVar("S", bound="Scalar")


# Argument of a function that is overloaded in C++; the type of the argument decides which overload is called.
CppArgument = Any


class ClassConstant:
    """Class constant that is an instance of its own class, such as `Vector3d.ZERO`; created once for each class.

    Args:
        values: arguments of the class for this instance.
    """

    def __init__(self, *values: float) -> None:
        self._values = values
        self._instances: dict[type, object] = {}

    def __get__(self, instance: object, owner: type[T]) -> T:
        if owner not in self._instances:
            self._instances[owner] = owner(*self._values)
        return cast(T, self._instances[owner])


def component_getter(attribute: str, index: int) -> Callable[[object], float]:
    """Create a method that returns one number of a vector attribute."""

    def read(self: object) -> float:
        return float(getattr(self, attribute)[index])

    return read


def component_setter(attribute: str, index: int) -> Callable[[object, float], None]:
    """Create a method that sets one number of a vector attribute."""

    def write(self: object, value: float) -> None:
        getattr(self, attribute)[index] = float(value)

    return write


class Value:
    """Base class of mutable values. They have no hash, because two different values may be equal within a tolerance."""

    __hash__ = None  # type: ignore[assignment]

    def __init__(self, *values: CppArgument) -> None:
        """Create a value from its components, or as a copy of another value."""

    def __copy__(self: V) -> V:
        return type(self)(self)

    def __deepcopy__(self: V, memo: dict[int, object]) -> V:
        return type(self)(self)


class HasComponents(Protocol):
    """Vector of another library that has gz-math's methods."""

    def x(self) -> float: ...

    def y(self) -> float: ...


Operand: TypeAlias = "Components | HasComponents | Sequence[float] | npt.NDArray[np.float64] | float"


class Components(Value):
    """Base class of values with a few numbers; arithmetic applies to each component."""

    _v: list[float]

    def _numbers_of(self, other: Operand) -> Iterable[float] | None:
        """Return the numbers of the right operand; None for an invalid operand."""
        raise NotImplementedError

    def _with(self: C, other: Operand, operation: Callable[[float, float], float]) -> C:
        others = self._numbers_of(other)
        if others is None:
            unsupported: C = NotImplemented
            return unsupported
        return type(self)(*map(operation, self._v, others))

    def __add__(self: C, other: Operand) -> C:
        return self._with(other, operator.add)

    def __sub__(self: C, other: Operand) -> C:
        return self._with(other, operator.sub)

    def _is_near(self, others: Iterable[float], tolerance: float) -> bool:
        return all(abs(a - b) <= tolerance for a, b in zip(self._v, others, strict=True))

    def __reduce__(self: C) -> tuple[type[C], tuple[float, ...]]:
        return (type(self), tuple(self._v))

    def __repr__(self) -> str:
        return " ".join(format_number(a) for a in self._v)


class Scalar(Value):
    """Base class of values with one number."""

    _value: float

    def _number_of(self: S, other: S | float) -> float:
        """Return the number of the right operand."""
        return float(other)

    def __call__(self) -> float:
        return self._value

    def __float__(self) -> float:
        return self._value

    def __add__(self: S, other: S | float) -> S:
        return type(self)(self._value + self._number_of(other))

    def __sub__(self: S, other: S | float) -> S:
        return type(self)(self._value - self._number_of(other))

    def __lt__(self: S, other: S | float) -> bool:
        return self._value < self._number_of(other)

    def __gt__(self: S, other: S | float) -> bool:
        return self._value > self._number_of(other)

    def __repr__(self) -> str:
        return format_number(self._value)
