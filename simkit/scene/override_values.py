"""Kinds of values that overrides set: their units, and their conversion from and to text."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from simkit.pose import Pose

_POSE_PARTS = ("x", "y", "z", "roll", "pitch", "yaw")


@dataclass(frozen=True, slots=True)
class ValueKind:
    """Kind of a value.

    Attributes:
        allowed: description of the allowed texts, for messages.
        unit: unit; empty for a number without a unit or for a text.
        parse: function that converts a text; raises ValueError for any other text.
        format: function that converts a value to a text, from which `parse` gives an equal value.
        parts: names of the components, which can be set one by one.
    """

    allowed: str
    unit: str
    parse: Callable[[str], Any]
    format: Callable[[Any], str]
    parts: tuple[str, ...] = ()

    def replace_part(self, value: object, part: str, text: str) -> str:
        """Return the text of a value in which one component has another text."""
        words = self.format(value).split()
        words[self.parts.index(part)] = text
        return " ".join(words)


def number_text(value: float) -> str:
    """Return the shortest text that has exactly this value."""
    return (
        repr(int(value)) if math.isfinite(value) and value == int(value) and abs(value) < 1e15 else repr(float(value))
    )


def _numbers_text(values: Sequence[float]) -> str:
    return " ".join(map(number_text, values))


def _number(text: str) -> float:
    value = float(text)
    if math.isnan(value) or "_" in text:
        raise ValueError(text)
    return value


def _finite_numbers(text: str, count: int) -> tuple[float, ...]:
    values = tuple(_number(word) for word in text.replace(",", " ").split())
    if len(values) != count or not all(map(math.isfinite, values)):
        raise ValueError(text)
    return values


def number(
    unit: str = "", *, minimum: float = -math.inf, above: float = -math.inf, infinite: bool = False
) -> ValueKind:
    """Return the kind of a number of at least `minimum` and greater than `above`."""

    def parse(text: str) -> float:
        value = _number(text)
        if value < minimum or not (value > above or above == -math.inf) or (math.isinf(value) and not infinite):
            raise ValueError(text)
        return value

    allowed = "a positive number" if above == 0.0 else "a number"
    if minimum > -math.inf:
        allowed += f" of at least {minimum:g}"
    return ValueKind(allowed, unit, parse, number_text)


def integer(minimum: int) -> ValueKind:
    """Return the kind of a whole number of at least `minimum`."""

    def parse(text: str) -> int:
        value = int(text)
        if value < minimum:
            raise ValueError(text)
        return value

    return ValueKind(f"a whole number of at least {minimum}", "", parse, str)


def vector(unit: str, parts: str, *, above: float = -math.inf) -> ValueKind:
    """Return the kind of a vector with the named components, all finite and greater than `above`."""
    names = tuple(parts.split())

    def parse(text: str) -> tuple[float, ...]:
        values = _finite_numbers(text, len(names))
        if not all(value > above for value in values):
            raise ValueError(text)
        return values

    allowed = f"{len(names)} {'positive ' if above == 0.0 else ''}numbers"
    return ValueKind(allowed, unit, parse, _numbers_text, names)


def _direction(text: str) -> tuple[float, ...]:
    values = _finite_numbers(text, 3)
    length = math.hypot(*values)
    if length == 0.0:
        raise ValueError(text)
    return values if abs(length - 1.0) < 1e-12 else tuple(value / length for value in values)


def _boolean(text: str) -> bool:
    folded = text.lower()
    if folded not in ("true", "false", "1", "0"):
        raise ValueError(text)
    return folded in ("true", "1")


def choice(options: Sequence[str]) -> ValueKind:
    """Return the kind of one of several words."""

    def parse(text: str) -> str:
        if text not in options:
            raise ValueError(text)
        return text

    return ValueKind(f"one of {', '.join(options)}", "", parse, str)


def _colour(count: int) -> Callable[[str], tuple[float, ...]]:
    def parse(text: str) -> tuple[float, ...]:
        values = tuple(float(word) for word in text.replace(",", " ").split())
        if count == 4 and len(values) == 3:
            values = (*values, 1.0)
        if len(values) != count or not all(0.0 <= value <= 1.0 for value in values):
            raise ValueError(text)
        return values if count == 4 else (*values, 1.0)

    return parse


def _pose(text: str) -> Pose:
    return Pose.from_rpy(*_finite_numbers(text, 6))


def _pose_text(pose: Pose) -> str:
    angles = (float(f"{angle:.12g}") + 0.0 for angle in pose.rpy)
    return _numbers_text((*(float(v) for v in pose.position), *angles))


FLAG = ValueKind("true, false, 1 or 0", "", _boolean, lambda value: str(bool(value)).lower())
TEXT = ValueKind("a text", "", str, str)
POSE = ValueKind("x y z roll pitch yaw", "m, rad", _pose, _pose_text, _POSE_PARTS)
DIRECTION = ValueKind("3 numbers that are not all zero", "", _direction, _numbers_text, ("x", "y", "z"))
RGB = ValueKind("red, green and blue from 0 to 1", "", _colour(3), lambda c: _numbers_text(c[:3]), ("r", "g", "b"))
RGBA = ValueKind("red, green, blue and alpha from 0 to 1", "", _colour(4), _numbers_text, ("r", "g", "b", "a"))
