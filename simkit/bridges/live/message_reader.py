"""Decode the messages that clients send: fixed-size types in one call, all others with rosbags."""

from __future__ import annotations

import itertools
import struct
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

from simkit.msgs import type_store
from simkit.msgs.definition_parser import BASE, NAME
from simkit.msgs.message_text import NUMBER_CODES
from simkit.msgs.message_types import Message

_CODES = {**NUMBER_CODES, "bool": "?"}
Reader = Callable[[bytes, int], Message]


@cache
def message_reader(type_name: str) -> Reader:
    """Return a function that decodes a message from CDR at an offset in some bytes.

    The function returns the same messages as `simkit.msgs.deserialize`. It may raise any exception if the bytes are not
    a message of the type.

    Args:
        type_name: full name of a message type.
    """
    store = type_store()

    def decode_generic(data: bytes, begin: int) -> Message:
        return store.deserialize_cdr(data[begin:], type_name)

    try:
        formats, classes = _layout(type_name)
    except _VariableSizeError:
        return decode_generic
    little, big = (struct.Struct(end + formats) for end in "<>")
    unpack, size = little.unpack_from, little.size
    make = _message_builder(classes)

    def read(data: bytes, begin: int) -> Message:
        if not 4 <= len(data) - begin - size <= 7 or data[begin] or data[begin + 1] > 1:
            return decode_generic(data, begin)  # raises an error that describes the fault
        return make((unpack if data[begin + 1] else big.unpack_from)(data, begin + 4))

    return read


class _VariableSizeError(Exception):
    """Error for a type whose messages have no fixed size, or have arrays."""


# Class of a message, with the classes of its fields in the same form; None for a number.
Classes = tuple[type[Message], tuple[Any, ...]]


def _layout(type_name: str) -> tuple[str, Classes]:
    """Return the `struct` format of a message with its alignment gaps, and the classes of its fields."""
    position = 0
    formats: list[str] = []
    store: Any = type_store()

    def walk(name: str) -> Classes:
        nonlocal position
        parts: list[Classes | None] = []
        for _, (kind, about) in store.fielddefs[name][1]:
            code = _CODES.get(about[0]) if int(kind) == BASE else None
            if code is not None:
                width = struct.calcsize(f"<{code}")
                gap = -position % width
                formats.append(f"{gap}x{code}" if gap else code)
                position += gap + width
                parts.append(None)
            elif int(kind) == NAME:
                parts.append(walk(about))
            else:
                raise _VariableSizeError
        return store.types[name], tuple(parts)

    classes = walk(type_name)
    return "".join(formats), classes


def _message_builder(classes: Classes) -> Callable[[tuple[float, ...]], Message]:
    """Return a function that builds a message from its numbers."""
    cls, parts = classes
    if all(part is None for part in parts):
        return lambda values: cls(*values)
    if all(part is not None and all(p is None for p in part[1]) for part in parts):
        lengths = [len(part[1]) for part in parts]
        starts = [0, *itertools.accumulate(lengths)]
        pieces = [(part[0], slice(*ends)) for part, ends in zip(parts, itertools.pairwise(starts), strict=True)]
        if len(pieces) == 2:  # a twist, a wrench, an acceleration: the types of most commands
            (first, first_slice), (second, second_slice) = pieces
            return lambda values: cls(first(*values[first_slice]), second(*values[second_slice]))
        return lambda values: cls(*[inner(*values[piece]) for inner, piece in pieces])

    def build(each: Classes, values: Iterator[float]) -> Message:
        return each[0](*[next(values) if part is None else build(part, values) for part in each[1]])

    return lambda values: build(classes, iter(values))
