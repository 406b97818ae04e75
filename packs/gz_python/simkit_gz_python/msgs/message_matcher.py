"""Comparison of gz messages with a pattern, by the rules of gz's TriggeredPublisher.

Numbers may differ by a tolerance, as in protobuf's `MessageDifferencer`. A field that is not set has its default.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from simkit.errors import MessageError
from simkit.extend import did_you_mean
from simkit_gz_python.msgs.message import MESSAGE_CLASSES, PLAIN_DEFAULTS, FieldValue, Message
from simkit_gz_python.msgs.text_format import parse_message, parse_value

TOLERANCE: Final = 1e-8
_SINGLE_PRECISION_MESSAGES: Final = frozenset(
    ("Float", "Float_V", "Color", "LaserScan", "BatteryState", "FluidPressure", "Actuators")
)
"""Messages whose numbers have single precision in gz or in the ROS type of the topic."""


class MessageMatcher:
    """Pattern for messages.

    Args:
        kind: message class.
        text: expected message, or expected value of the field, in protobuf's text format.
        field: path of a field, such as `linear.x`; empty to compare the complete message. Of a repeated field, the
            message must contain every expected value, in any order. Any other field must be equal.
        tolerance: largest difference of two numbers; integers must be equal.
        is_positive: false to invert the result.

    Raises:
        MessageError: the text does not describe the message or field, or the field does not exist.
    """

    def __init__(
        self, kind: type[Message], text: str, field: str = "", tolerance: float = TOLERANCE, is_positive: bool = True
    ) -> None:
        self._tolerance, self._is_positive = tolerance, is_positive
        self._path: tuple[str, ...] = tuple(field.split(".")) if field else ()
        self._owner = kind.__name__
        self._kind = ""
        self._expected: FieldValue
        if not self._path:
            self._expected = parse_message(kind, text)
            return
        self._owner, self._kind = _find_field(kind, self._path)
        self._expected = parse_value(self._kind, text)
        if isinstance(self._expected, str) and self._kind in ("i", "i[]"):
            self._expected = int(getattr(MESSAGE_CLASSES[self._owner], self._expected, -1))

    def meets(self, message: Message) -> bool:
        """Check whether a message matches the pattern."""
        return self._is_same(message) == self._is_positive

    def _is_same(self, message: Message) -> bool:
        value: FieldValue = message
        for name in self._path:
            value = getattr(value, name)
        single = self._owner in _SINGLE_PRECISION_MESSAGES
        if self._kind.endswith("[]"):
            return all(
                any(_values_match(expected, item, self._tolerance, single, True) for item in value)
                for expected in self._expected
            )
        return _values_match(self._expected, value, self._tolerance, single, False)


def _find_field(kind: type[Message], path: Sequence[str]) -> tuple[str, str]:
    """Return the name of the message class that has the last field of a path, and the kind of that field."""
    owner, field_kind = kind.__name__, ""
    for depth, name in enumerate(path):
        fields = MESSAGE_CLASSES[owner].FIELDS
        if name not in fields:
            hint = did_you_mean(name, fields) or f"its fields are {', '.join(fields)}"
            raise MessageError(f"gz.msgs.{owner} has no field {name!r}; {hint}")
        field_kind = fields[name]
        if depth < len(path) - 1:
            if field_kind.endswith("[]"):
                raise MessageError(f"{name!r} of gz.msgs.{owner} is repeated; only the last field of a path may be")
            if field_kind in PLAIN_DEFAULTS:
                raise MessageError(f"{name!r} of gz.msgs.{owner} is a plain value and has no field {path[depth + 1]!r}")
            owner = field_kind
    return owner, field_kind


def _values_match(expected: object, found: FieldValue, tolerance: float, single: bool, is_partial: bool) -> bool:
    """Check whether a value equals the expected value; `is_partial` compares only the fields set in `expected`."""
    if isinstance(expected, Message):
        single = type(expected).__name__ in _SINGLE_PRECISION_MESSAGES
        names = [name for name, _ in expected.ListFields()] if is_partial else list(expected.FIELDS)
        return all(_values_match(getattr(expected, n), getattr(found, n), tolerance, single, is_partial) for n in names)
    if isinstance(expected, list):
        if is_partial:
            return all(any(_values_match(e, item, tolerance, single, True) for item in found) for e in expected)
        return len(expected) == len(found) and all(
            _values_match(e, item, tolerance, single, False) for e, item in zip(expected, found, strict=True)
        )
    if isinstance(expected, float):
        return _numbers_match(expected, float(found), tolerance, single)
    return bool(expected == found)


def _numbers_match(a: float, b: float, tolerance: float, single: bool) -> bool:
    if single:
        a, b = float(np.float32(a)), float(np.float32(b))
    if a == b:  # also if both are infinite
        return True
    return math.isfinite(a) and math.isfinite(b) and abs(a - b) <= tolerance
