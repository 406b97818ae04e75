"""Serialised messages that differ only in some numbers: the constant parts are serialised once."""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.msgs.cdr_serializer import CODES
from simkit.msgs.definition_parser import ARRAY, BASE, NAME, FieldNode
from simkit.msgs.message_types import FieldValue, Message, type_store

_HEAD = 4  # [bytes] before the first field

Packer = Callable[..., tuple[str, bytes]]
"""Function that returns the type and the CDR of the message that another function makes of the same arguments."""

PACKERS: Final[dict[object, Packer]] = {}
"""Packers by the function that makes the message."""


def packs(make: Callable[..., Message]) -> Callable[[Packer], Packer]:
    """Register the decorated function as the packer of the messages that `make` returns.

    Recorders and sockets need only bytes. A packer fills numbers into a template and creates no message.
    """

    def register(packer: Packer) -> Packer:
        PACKERS[make] = packer
        return packer

    return register


class CdrTemplate:
    """Message whose number fields are replaced.

    Args:
        message: message with the constant fields; its type and its texts and arrays decide the places of all fields.
        fields: paths of the variable fields in the order of the definition: numbers such as `header.stamp.sec` or
            `position[0]`, and whole arrays such as `ranges`, which keep their length.
    """

    def __init__(self, message: Message, fields: tuple[str, ...]) -> None:
        self._data = msgs.serialize(message)
        self._places: dict[str, tuple[int, str, int]] = {}  # place, code of a number, and number of them; 0 for one
        self._at = 0
        self._walk(msgs.type_name(message), message, "")
        self._fields = {field: self._places[field] for field in fields}

    @cached_property
    def _dtype(self) -> np.dtype[np.void]:
        formats = [f"({count},){code}" if count else code for _, code, count in self._fields.values()]
        offsets = [offset for offset, _, _ in self._fields.values()]
        layout = {"names": list(self._fields), "formats": formats, "offsets": offsets, "itemsize": len(self._data)}
        return np.dtype(layout)  # type: ignore[call-overload,no-any-return]

    def packer(self) -> Callable[..., bytes]:
        """Return a function of the variable fields, with arrays as bytes, that returns the serialised message."""
        layout, at = "<", 0
        arguments: list[str] = []
        constants: list[bytes] = []
        for number, (offset, code, count) in enumerate((*self._fields.values(), (len(self._data), "", 0))):
            if offset > at:
                layout += f"{offset - at}s"
                arguments.append(f"c{len(constants)}")
                constants.append(self._data[at:offset])
            if code:
                size = max(1, count) * struct.calcsize(code)
                layout += f"{size}s" if count else code[1:]
                arguments.append(f"v{number}")
                at = offset + size
        names = ", ".join(f"v{number}" for number in range(len(self._fields)))
        known = {"pack": struct.Struct(layout).pack, **{f"c{number}": part for number, part in enumerate(constants)}}
        packer: Callable[..., bytes] = eval(f"lambda {names}: pack({', '.join(arguments)})", known)
        return packer

    def fill(self, count: int, values: Mapping[str, npt.NDArray[np.generic]]) -> list[bytes]:
        """Return `count` serialised messages.

        Args:
            count: number of messages.
            values: values of the variable fields, each an array (count,), or (count, length) for an array.
        """
        rows = np.frombuffer(bytearray(self._data * count), self._dtype)
        for field, column in values.items():
            rows[field] = column
        data, size = rows.tobytes(), len(self._data)
        return [data[at : at + size] for at in range(0, count * size, size)]

    def _walk(self, type_name: str, message: Message, prefix: str) -> None:
        from rosbags.typesys.base import normalize_fieldname

        for field, node in type_store().fielddefs[type_name][1]:
            self._step(node, getattr(message, normalize_fieldname(field)), prefix + field)

    def _step(self, node: FieldNode, value: FieldValue, path: str) -> None:
        """Advance over a field, and note the place of a number."""
        kind, content = int(node[0]), node[1]
        if kind == NAME:
            self._walk(content, value, path + ".")
        elif kind == BASE and content[0] == "string":
            self._at += -self._at % 4 + 4 + len(value.encode()) + 1
        elif kind == BASE:
            size = struct.calcsize(CODES[content[0]])
            self._at += -self._at % size
            self._places[path] = self._at + _HEAD, f"<{CODES[content[0]]}", 0
            self._at += size
        else:
            if kind != ARRAY:
                self._at += -self._at % 4 + 4
            if isinstance(value, np.ndarray) and len(value):
                self._at += -self._at % value.itemsize
                self._places[path] = self._at + _HEAD, f"<{CODES[content[0][1][0]]}", len(value)
            for index, item in enumerate(value):
                self._step(content[0], item, f"{path}[{index}]")
