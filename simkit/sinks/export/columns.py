"""Messages of one type as columns: one for each number or text, lists where there are several."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit.msgs.text import attribute, fields_of

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

_BASE, _NAME, _ARRAY, _SEQUENCE = 1, 2, 3, 4  # rosbags.interfaces.Nodetype
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


@dataclass
class Column:
    """One part of every message of a topic.

    Attributes:
        path: of the field; a list of messages has `[]` behind its name.
        kind: NumPy's name of its numbers, or TEXT.
        is_list: whether a message has several.
        values: all of them, one behind the other.
        counts: of a list, how many each message has.
    """

    path: str
    kind: str
    is_list: bool
    read: Callable[[Any], Any]
    values: Any = field(default_factory=list)
    counts: list[int] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.kind != TEXT:
            self.values = array(_CODES.get(self.kind) or {"i8": "q", "u8": "Q"}[self.kind])

    def take(self, message: Any) -> None:
        """Adds what a message has."""
        found = self.read(message)
        if not self.is_list:
            self.values.append(found)
            return
        self.counts.append(len(found))
        if isinstance(found, np.ndarray) and self.kind != TEXT:
            self.values.frombytes(np.ascontiguousarray(found, dtype=self.kind).tobytes())
        else:
            self.values.extend(found)

    @property
    def width(self) -> int | None:
        """How many numbers every message has; None where they differ."""
        if not self.is_list:
            return 1
        return self.counts[0] if len(set(self.counts)) == 1 else None

    @property
    def most(self) -> int:
        """How many numbers a message has at most."""
        return max(self.counts, default=0) if self.is_list else 1

    def numbers(self) -> np.ndarray[Any, Any]:
        """All values, one behind the other; texts as NumPy's."""
        if self.kind == TEXT:
            return np.array(self.values, dtype=np.str_) if self.values else np.empty(0, dtype="U1")
        return np.frombuffer(self.values, dtype=self.kind) if len(self.values) else np.empty(0, dtype=self.kind)

    def rows(self) -> Iterator[Any]:
        """What each message has: a value, or a list of them."""
        values: Sequence[Any] = self.values
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
    """The columns of a type.

    Args:
        type_name: the messages' type.
        store: the definitions that it is read by.
        without: paths of fields that are left out.
    """
    return list(_of_message(type_name, store, "", _same, without))


def _of_message(
    type_name: str, store: Typestore, path: str, read: Callable[[Any], Any], without: frozenset[str]
) -> Iterator[Column]:
    for name, node in fields_of(type_name, store):
        below = f"{path}.{name}" if path else name
        if below not in without:
            yield from _of_node(node, store, below, _field(read, name), without)


def _of_node(
    node: Any, store: Typestore, path: str, read: Callable[[Any], Any], without: frozenset[str]
) -> Iterator[Column]:
    kind = int(node[0])
    if kind == _BASE:
        yield Column(path, _DTYPES.get(node[1][0], TEXT), False, read)
        return
    if kind == _NAME:
        yield from _of_message(node[1], store, path, read, without)
        return
    inner = node[1][0]
    if int(inner[0]) == _BASE:
        yield Column(path, _DTYPES.get(inner[1][0], TEXT), True, read)
        return
    for column in _of_node(inner, store, f"{path}[]", _same, without):
        if column.is_list:  # a list in a list: how many each has, and all of them
            yield Column(f"{column.path}.count", "i8", True, _lengths(read, column.read))
        yield Column(column.path, column.kind, True, _each(read, column))


def _same(value: Any) -> Any:
    return value


def _field(read: Callable[[Any], Any], name: str) -> Callable[[Any], Any]:
    return lambda message: attribute(read(message), name)


def _each(read: Callable[[Any], Any], column: Column) -> Callable[[Any], Any]:
    inner = column.read
    if column.is_list:
        return lambda message: [value for item in read(message) for value in inner(item)]
    return lambda message: [inner(item) for item in read(message)]


def _lengths(read: Callable[[Any], Any], inner: Callable[[Any], Any]) -> Callable[[Any], Any]:
    return lambda message: [len(inner(item)) for item in read(message)]
