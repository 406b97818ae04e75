"""Columns of values of messages of one type, for tables."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit.msgs.definition_parser import ARRAY, BASE, NAME, FieldNode
from simkit.msgs.message_text import field_nodes, field_value
from simkit.msgs.message_types import FieldValue

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

_DTYPES: Final = {
    "bool": "?",
    "byte": "u1",
    "char": "u1",
    "octet": "u1",
    "float32": "f4",
    "float64": "f8",
    **{f"{sign}int{bits}": f"{sign[:1] or 'i'}{bits // 8}" for sign in ("", "u") for bits in (8, 16, 32, 64)},
}
_CODES: Final = {"?": "b", "f4": "f", "f8": "d", "i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I"}
TEXT: Final = "text"
Reader = Callable[[FieldValue], FieldValue]
"""Function that reads a value of a message."""


@dataclass
class Column:
    """Values of one field of all messages of a topic.

    Attributes:
        path: path of the field; a list of messages has `[]` after its name.
        kind: NumPy type of the numbers, or TEXT.
        is_list: True if a message has several values.
        read: function that reads the values from a message.
        length: number of values that the definition of the type fixes; 0 if it fixes none.
        values: values of all messages, concatenated.
        counts: number of values in each message, for a list.
    """

    path: str
    kind: str
    is_list: bool
    read: Reader
    length: int = 0
    values: FieldValue = field(default_factory=list)
    counts: list[int] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.kind != TEXT:
            self.values = array(_CODES.get(self.kind) or {"i8": "q", "u8": "Q"}[self.kind])

    def take(self, message: object) -> None:
        """Append the values of a message."""
        value = self.read(message)
        if not self.is_list:
            self.values.append(value)
            return
        self.counts.append(len(value))
        if isinstance(value, np.ndarray) and self.kind != TEXT:
            self.values.frombytes(np.ascontiguousarray(value, dtype=self.kind).tobytes())
        else:
            self.values.extend(value)

    @property
    def width(self) -> int | None:
        """Number of values in every message; None if the messages differ."""
        if not self.is_list:
            return 1
        return self.counts[0] if len(set(self.counts)) == 1 else None

    @property
    def most(self) -> int:
        """Largest number of values in a message."""
        return max(self.counts, default=0) if self.is_list else 1

    def numbers(self) -> npt.NDArray[np.generic]:
        """Return all values in one array; texts as NumPy strings."""
        if self.kind == TEXT:
            return np.array(self.values, dtype=np.str_) if self.values else np.empty(0, dtype="U1")
        return np.frombuffer(self.values, dtype=self.kind) if len(self.values) else np.empty(0, dtype=self.kind)

    def rows(self) -> Iterator[FieldValue]:
        """Yield the value of each message, or its list of values."""
        values: Sequence[object] = self.values
        if self.kind == "?":
            values = [bool(v) for v in values]
        if not self.is_list:
            yield from values
            return
        at = 0
        for count in self.counts:
            yield values[at : at + count]
            at += count


def columns_of(type_name: str, store: Typestore, without: frozenset[str] = frozenset()) -> list[Column]:
    """Return the columns of a type.

    Args:
        type_name: type of the messages.
        store: type store with the type's definition.
        without: paths of fields to leave out.
    """
    return list(_message_columns(type_name, store, "", _identity, without))


def _message_columns(
    type_name: str, store: Typestore, path: str, read: Reader, without: frozenset[str]
) -> Iterator[Column]:
    for name, node in field_nodes(type_name, store):
        below = f"{path}.{name}" if path else name
        if below not in without:
            yield from _field_columns(node, store, below, _field_of(read, name), without)


def _field_columns(
    node: FieldNode, store: Typestore, path: str, read: Reader, without: frozenset[str]
) -> Iterator[Column]:
    kind = int(node[0])
    if kind == BASE:
        yield Column(path, _DTYPES.get(node[1][0], TEXT), False, read)
        return
    if kind == NAME:
        yield from _message_columns(node[1], store, path, read, without)
        return
    inner = node[1][0]
    if int(inner[0]) == BASE:
        yield Column(path, _DTYPES.get(inner[1][0], TEXT), True, read, node[1][1] if kind == ARRAY else 0)
        return
    for column in _field_columns(inner, store, f"{path}[]", _identity, without):
        if column.is_list:  # a list of lists becomes two columns: the lengths of the lists, and all values
            yield Column(f"{column.path}.count", "i8", True, _lengths(read, column.read))
        yield Column(column.path, column.kind, True, _each_item(read, column))


def _identity(value: object) -> object:
    return value


def _field_of(read: Reader, name: str) -> Reader:
    return lambda message: field_value(read(message), name)


def _each_item(read: Reader, column: Column) -> Reader:
    inner = column.read
    if column.is_list:
        return lambda message: [value for item in read(message) for value in inner(item)]
    return lambda message: [inner(item) for item in read(message)]


def _lengths(read: Reader, inner: Reader) -> Reader:
    return lambda message: [len(inner(item)) for item in read(message)]
