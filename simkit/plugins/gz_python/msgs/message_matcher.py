"""Match messages of gz against a pattern, as gz's TriggeredPublisher does with each message.

Numbers are compared as protobuf's `MessageDifferencer` does it with a margin, fields that are not set as their value at
the start.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError
from simkit.plugins.gz_python.msgs.message import MESSAGE_CLASSES, PLAIN_DEFAULTS, FieldValue, Message
from simkit.plugins.gz_python.msgs.text_format import parse_message, parse_value

TOLERANCE: Final = 1e-8
_SINGLE_PRECISION_MESSAGES: Final = frozenset(
    ("Float", "Float_V", "Color", "LaserScan", "BatteryState", "FluidPressure", "Actuators")
)
"""Messages whose numbers have single precision in gz or on the topic."""


class MessageMatcher:
    """Pattern of a message.

    Args:
        kind: its class.
        text: the whole message, or the value of the field, in protobuf's text form.
        field: path of a field with dots; empty for the whole message. Of a repeated field the values have to be among
            those of the message, in any order; else the field has to be the same.
        tolerance: by how much numbers that are not whole may differ.
        is_positive: False for one that is met by every message which is not so.

    Raises:
        MessageError: the text is none of that message or field, or there is no such field.
    """

    def __init__(
        self, kind: type[Message], text: str, field: str = "", tolerance: float = TOLERANCE, is_positive: bool = True
    ) -> None:
        self._tolerance, self._is_positive = tolerance, is_positive
        self._path: tuple[str, ...] = tuple(field.split(".")) if field else ()
        self._owner = kind.__name__
        self._kind = ""
        self._wanted: FieldValue
        if not self._path:
            self._wanted = parse_message(kind, text)
            return
        self._owner, self._kind = _find_field(kind, self._path)
        self._wanted = parse_value(self._kind, text)
        if isinstance(self._wanted, str) and self._kind in ("i", "i[]"):
            self._wanted = int(getattr(MESSAGE_CLASSES[self._owner], self._wanted, -1))

    def meets(self, message: Message) -> bool:
        """Check whether a message is as it is to be."""
        return self._is_same(message) == self._is_positive

    def _is_same(self, message: Message) -> bool:
        found: FieldValue = message
        for name in self._path:
            found = getattr(found, name)
        single = self._owner in _SINGLE_PRECISION_MESSAGES
        if self._kind.endswith("[]"):
            return all(
                any(_values_match(want, one, self._tolerance, single, True) for one in found) for want in self._wanted
            )
        return _values_match(self._wanted, found, self._tolerance, single, False)


def _find_field(kind: type[Message], path: Sequence[str]) -> tuple[str, str]:
    """The class that has the last field of a path, and the field's kind."""
    owner, found = kind.__name__, ""
    for place, name in enumerate(path):
        fields = MESSAGE_CLASSES[owner].FIELDS
        if name not in fields:
            hint = did_you_mean(name, fields) or f"its fields are {', '.join(fields)}"
            raise MessageError(f"gz.msgs.{owner} has no field {name!r}; {hint}")
        found = fields[name]
        if place < len(path) - 1:
            if found.endswith("[]"):
                raise MessageError(f"{name!r} of gz.msgs.{owner} is repeated: what is in it has no path of its own")
            if found in PLAIN_DEFAULTS:
                raise MessageError(f"{name!r} of gz.msgs.{owner} is a plain value and has no field {path[place + 1]!r}")
            owner = found
    return owner, found


def _values_match(want: object, found: FieldValue, tolerance: float, single: bool, is_partial: bool) -> bool:
    """Check whether a value is the wanted one; `is_partial`: fields that are not set in it do not count."""
    if isinstance(want, Message):
        single = type(want).__name__ in _SINGLE_PRECISION_MESSAGES
        names = [name for name, _ in want.ListFields()] if is_partial else list(want.FIELDS)
        return all(_values_match(getattr(want, n), getattr(found, n), tolerance, single, is_partial) for n in names)
    if isinstance(want, list):
        if is_partial:
            return all(any(_values_match(w, one, tolerance, single, True) for one in found) for w in want)
        return len(want) == len(found) and all(
            _values_match(w, one, tolerance, single, False) for w, one in zip(want, found, strict=True)
        )
    if isinstance(want, float):
        return _numbers_match(want, float(found), tolerance, single)
    return bool(want == found)


def _numbers_match(one: float, other: float, tolerance: float, single: bool) -> bool:
    if single:
        one, other = float(np.float32(one)), float(np.float32(other))
    if one == other:  # infinite ones too
        return True
    return math.isfinite(one) and math.isfinite(other) and abs(one - other) <= tolerance
