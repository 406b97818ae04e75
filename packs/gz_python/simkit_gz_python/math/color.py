"""Colours and temperatures of gz-math."""

from __future__ import annotations

import math
import operator
from typing import Final

from simkit_gz_python.math.scalars import DEFAULT_TOLERANCE, clamp
from simkit_gz_python.math.value_base import ClassConstant, Components, CppArgument, Operand, Scalar

_KELVIN: Final = 273.15


class Color(Components):
    """Colour with red, green, blue and alpha from 0 to 1. `c.r()` returns the red value; `c.r(0.5)` sets it."""

    WHITE = ClassConstant(1, 1, 1)
    BLACK = ClassConstant(0, 0, 0)
    RED = ClassConstant(1, 0, 0)
    GREEN = ClassConstant(0, 1, 0)
    BLUE = ClassConstant(0, 0, 1)
    YELLOW = ClassConstant(1, 1, 0)
    MAGENTA = ClassConstant(1, 0, 1)
    CYAN = ClassConstant(0, 1, 1)

    def __init__(self, *values: CppArgument) -> None:
        self._v = [0.0, 0.0, 0.0, 1.0]
        if len(values) == 1:
            values = (values[0].r(), values[0].g(), values[0].b(), values[0].a())
        if values:
            self.set(*values)

    def set(self, r: float = 1.0, g: float = 1.0, b: float = 1.0, a: float = 1.0) -> None:
        self._v = [clamp(float(v), 0.0, 1.0) if math.isfinite(v) else 0.0 for v in (r, g, b, a)]

    def reset(self) -> None:
        self._v = [0.0, 0.0, 0.0, 1.0]

    def _component(self, index: int, value: tuple[float, ...]) -> float:
        if not value:
            return self._v[index]
        self._v[index] = clamp(float(value[0]), 0.0, 1.0)
        return None  # type: ignore[return-value]  # a setter call has no result

    def r(self, *value: float) -> float:
        return self._component(0, value)

    def g(self, *value: float) -> float:
        return self._component(1, value)

    def b(self, *value: float) -> float:
        return self._component(2, value)

    def a(self, *value: float) -> float:
        return self._component(3, value)

    def __getitem__(self, index: int) -> float:
        return self._v[index]

    def _numbers_of(self, other: Operand) -> list[float]:
        return other._v if isinstance(other, Color) else [float(other)] * 4  # type: ignore[arg-type]

    def __mul__(self, other: Operand) -> Color:
        return self._with(other, operator.mul)

    def __eq__(self, other: object) -> bool:
        return self._is_near(other._v, DEFAULT_TOLERANCE) if isinstance(other, Color) else NotImplemented


class Temperature(Scalar):
    """Temperature [K]; `Temperature()` is 0 K."""

    def __init__(self, kelvin: Temperature | float = 0.0) -> None:
        self._value = float(kelvin)

    def kelvin(self) -> float:
        return self._value

    def celsius(self) -> float:
        return self._value - _KELVIN

    def fahrenheit(self) -> float:
        return self.celsius() * 1.8 + 32.0

    def set_kelvin(self, value: float) -> None:
        self._value = float(value)

    def set_celsius(self, value: float) -> None:
        self._value = float(value) + _KELVIN

    def set_fahrenheit(self, value: float) -> None:
        self.set_celsius((float(value) - 32.0) / 1.8)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, (int, float, Temperature)):
            return bool(abs(self._value - float(other)) <= DEFAULT_TOLERANCE)
        return NotImplemented
