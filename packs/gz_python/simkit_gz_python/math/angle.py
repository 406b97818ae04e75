"""Angles of gz-math."""

from __future__ import annotations

import math

from simkit_gz_python.math.value_base import ClassConstant, Scalar
from simkit_gz_python.math.vectors import EQUALITY_TOLERANCE


class Angle(Scalar):
    """Angle; as in gz-math, `==`, `<` and `>` treat angles as equal if they differ by at most 1e-3 rad."""

    ZERO = ClassConstant(0.0)
    PI = ClassConstant(math.pi)
    HALF_PI = ClassConstant(math.pi / 2)
    TWO_PI = ClassConstant(math.tau)

    def __init__(self, radian: Angle | float = 0.0) -> None:
        self._value = float(radian)

    def radian(self, *value: float) -> float:
        """Return the angle [rad]; with an argument, set it."""
        if not value:
            return self._value
        self._value = float(value[0])
        return None  # type: ignore[return-value]  # a setter call has no result

    def set_radian(self, value: float) -> None:
        self._value = float(value)

    def degree(self, *value: float) -> float:
        """Return the angle [°]; with an argument, set it."""
        if not value:
            return math.degrees(self._value)
        self._value = math.radians(value[0])
        return None  # type: ignore[return-value]  # a setter call has no result

    def set_degree(self, value: float) -> None:
        self._value = math.radians(value)

    def normalize(self) -> None:
        """Wrap the angle to the range from -π to π."""
        self._value = math.atan2(math.sin(self._value), math.cos(self._value))

    def normalized(self) -> Angle:
        angle = Angle(self)
        angle.normalize()
        return angle

    def _number_of(self, other: Angle | float) -> float:
        if not isinstance(other, Angle):
            raise TypeError(f"expected an Angle, got {other!r}")
        return other._value

    def __mul__(self, other: Angle) -> Angle:
        return Angle(self._value * other._value)

    def __truediv__(self, other: Angle) -> Angle:
        return Angle(self._value / other._value)

    def __eq__(self, other: object) -> bool:
        return abs(self._value - other._value) <= EQUALITY_TOLERANCE if isinstance(other, Angle) else NotImplemented

    def __le__(self, other: Angle) -> bool:
        return self._value < other._value or self == other

    def __ge__(self, other: Angle) -> bool:
        return self._value > other._value or self == other
