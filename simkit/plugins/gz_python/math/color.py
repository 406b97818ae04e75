"""Colours and temperatures of gz-math."""

from __future__ import annotations

import math
import sys
from typing import Final

from simkit.plugins.gz_python.math.class_constant import ClassConstant, CppArgument
from simkit.plugins.gz_python.math.scalars import DEFAULT_TOLERANCE, clamp, format_number

_KELVIN: Final = 273.15
_LARGEST: Final = sys.float_info.max


class Color:
    """Red, green, blue and alpha from 0 to 1; what is beyond is cut off. `c.r()` reads, `c.r(0.5)` sets."""

    WHITE = ClassConstant(1, 1, 1)
    BLACK = ClassConstant(0, 0, 0)
    RED = ClassConstant(1, 0, 0)
    GREEN = ClassConstant(0, 1, 0)
    BLUE = ClassConstant(0, 0, 1)
    YELLOW = ClassConstant(1, 1, 0)
    MAGENTA = ClassConstant(1, 0, 1)
    CYAN = ClassConstant(0, 1, 1)
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, *values: CppArgument) -> None:
        self._c = [0.0, 0.0, 0.0, 1.0]
        if len(values) == 1:
            values = (values[0].r(), values[0].g(), values[0].b(), values[0].a())
        if values:
            self.set(*values)

    def set(self, r: float = 1.0, g: float = 1.0, b: float = 1.0, a: float = 1.0) -> None:
        self._c = [clamp(float(v), 0.0, 1.0) if math.isfinite(v) else 0.0 for v in (r, g, b, a)]

    def reset(self) -> None:
        self._c = [0.0, 0.0, 0.0, 1.0]

    def _one(self, index: int, value: tuple[float, ...]) -> float:
        if not value:
            return self._c[index]
        self._c[index] = clamp(float(value[0]), 0.0, 1.0)
        return None  # type: ignore[return-value]  # who sets a component takes nothing

    def r(self, *value: float) -> float:
        return self._one(0, value)

    def g(self, *value: float) -> float:
        return self._one(1, value)

    def b(self, *value: float) -> float:
        return self._one(2, value)

    def a(self, *value: float) -> float:
        return self._one(3, value)

    def __getitem__(self, index: int) -> float:
        return self._c[index]

    def _with(self, other: Color | float, sign: float) -> Color:
        others = other._c if isinstance(other, Color) else [float(other)] * 4
        return Color(*(a + sign * b for a, b in zip(self._c, others, strict=True)))

    def __add__(self, other: Color | float) -> Color:
        return self._with(other, 1.0)

    def __sub__(self, other: Color | float) -> Color:
        return self._with(other, -1.0)

    def __mul__(self, other: Color | float) -> Color:
        others = other._c if isinstance(other, Color) else [float(other)] * 4
        return Color(*(a * b for a, b in zip(self._c, others, strict=True)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Color):
            return NotImplemented
        return all(abs(a - b) <= DEFAULT_TOLERANCE for a, b in zip(self._c, other._c, strict=True))

    def __copy__(self) -> Color:
        return Color(self)

    def __deepcopy__(self, memo: dict[int, object]) -> Color:
        return Color(self)

    def __repr__(self) -> str:
        return " ".join(format_number(v) for v in self._c)


class Temperature:
    """A temperature; without an argument 0 K."""

    __hash__ = None  # type: ignore[assignment]

    def __init__(self, kelvin: Temperature | float = 0.0) -> None:
        self._kelvin: float = kelvin._kelvin if isinstance(kelvin, Temperature) else float(kelvin)

    def kelvin(self) -> float:
        return self._kelvin

    def celsius(self) -> float:
        return self._kelvin - _KELVIN

    def fahrenheit(self) -> float:
        return self.celsius() * 1.8 + 32.0

    def set_kelvin(self, value: float) -> None:
        self._kelvin = float(value)

    def set_celsius(self, value: float) -> None:
        self._kelvin = float(value) + _KELVIN

    def set_fahrenheit(self, value: float) -> None:
        self.set_celsius((float(value) - 32.0) / 1.8)

    def __call__(self) -> float:
        return self._kelvin

    def __float__(self) -> float:
        return self._kelvin

    def __add__(self, other: Temperature | float) -> Temperature:
        return Temperature(self._kelvin + float(other))

    def __sub__(self, other: Temperature | float) -> Temperature:
        return Temperature(self._kelvin - float(other))

    def __eq__(self, other: object) -> bool:
        if isinstance(other, (int, float, Temperature)):
            return bool(abs(self._kelvin - float(other)) <= DEFAULT_TOLERANCE)
        return NotImplemented

    def __lt__(self, other: Temperature | float) -> bool:
        return self._kelvin < float(other)

    def __gt__(self, other: Temperature | float) -> bool:
        return self._kelvin > float(other)

    def __repr__(self) -> str:
        return format_number(self._kelvin)
