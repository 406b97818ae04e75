"""Serialised messages that differ only in some numbers: the constant parts are serialised once."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.msgs.cdr_serializer import CODES
from simkit.msgs.definition_parser import ARRAY, BASE, NAME, FieldNode
from simkit.msgs.message_types import Message, type_store

_HEAD = 4  # [bytes] before the first field


class CdrTemplate:
    """Message whose number fields are replaced.

    Args:
        message: message with the constant fields; its type and its texts and arrays decide the places of all fields.
        fields: paths of the variable number fields, such as `header.stamp.sec`.
    """

    def __init__(self, message: Message, fields: tuple[str, ...]) -> None:
        self._data = msgs.serialize(message)
        self._places: dict[str, tuple[int, str]] = {}
        self._at = 0
        self._walk(msgs.type_name(message), message, "")
        formats = [self._places[field][1] for field in fields]
        offsets = [self._places[field][0] for field in fields]
        layout = {"names": list(fields), "formats": formats, "offsets": offsets, "itemsize": len(self._data)}
        self._dtype = np.dtype(layout)  # type: ignore[call-overload]

    def fill(self, count: int, values: Mapping[str, npt.NDArray[Any]]) -> list[bytes]:
        """Return `count` serialised messages with these values of the variable fields, each an array (count,)."""
        rows = np.frombuffer(bytearray(self._data * count), self._dtype)
        for field, column in values.items():
            rows[field] = column
        data, size = rows.tobytes(), len(self._data)
        return [data[at : at + size] for at in range(0, count * size, size)]

    def _walk(self, type_name: str, message: Message, prefix: str) -> None:
        from rosbags.typesys.base import normalize_fieldname

        for field, node in type_store().fielddefs[type_name][1]:
            self._step(node, getattr(message, normalize_fieldname(field)), prefix + field)

    def _step(self, node: FieldNode, value: Any, path: str) -> None:
        """Advance over a field, and note the place of a number."""
        kind, content = int(node[0]), node[1]
        if kind == NAME:
            self._walk(content, value, path + ".")
        elif kind == BASE and content[0] == "string":
            self._at += -self._at % 4 + 4 + len(value.encode()) + 1
        elif kind == BASE:
            size = struct.calcsize(CODES[content[0]])
            self._at += -self._at % size
            self._places[path] = self._at + _HEAD, f"<{CODES[content[0]]}"
            self._at += size
        else:
            if kind != ARRAY:
                self._at += -self._at % 4 + 4
            for index, item in enumerate(value):
                self._step(content[0], item, f"{path}[{index}]")
