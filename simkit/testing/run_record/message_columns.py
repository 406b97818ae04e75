"""Messages of one type as columns of numbers and texts, one for each field."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import pairwise
from operator import attrgetter
from typing import Any, Final, NamedTuple

import numpy as np

from simkit import msgs
from simkit.testing.run_record.record import Column

_STAMPS: Final = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")
_BASE, _NAME = 1, 2  # kinds of fields in the type store of rosbags; other kinds are lists
_NS: Final = 1_000_000_000


class MessageFields(NamedTuple):
    """Fields of a message type as flat paths; a time is one field.

    Attributes:
        numbers, texts, stamps: Paths of single values; numbers with their type.
        arrays: Paths of number lists with their type.
        lists: Paths of text lists.
        parts: Paths of message lists with their type.
    """

    numbers: dict[str, str]
    texts: list[str]
    stamps: list[str]
    arrays: dict[str, str]
    lists: list[str]
    parts: dict[str, str]


@cache
def message_fields(type_name: str) -> MessageFields:
    """Return the fields of a message type."""
    found = MessageFields({}, [], [], {}, [], {})
    _add_fields(found, type_name, "")
    return found


def _add_fields(found: MessageFields, type_name: str, prefix: str) -> None:
    definition: Any = msgs.type_store().fielddefs[msgs.full_name(type_name)][1]
    for field, (kind, of) in definition:
        path = prefix + field
        is_list = int(kind) not in (_BASE, _NAME)
        inner_kind, inner = of[0] if is_list else (kind, of)
        if int(inner_kind) == _NAME:
            if is_list:
                found.parts[path] = str(inner)
            elif inner in _STAMPS:
                found.stamps.append(path)
            else:
                _add_fields(found, str(inner), path + ".")
        elif str(inner[0]) in ("string", "wstring"):
            (found.lists if is_list else found.texts).append(path)
        else:
            (found.arrays if is_list else found.numbers)[path] = _dtype(str(inner[0]))


def _dtype(base: str) -> str:
    return {"byte": "uint8", "octet": "uint8", "char": "uint8"}.get(base, base)


class MessageRows:
    """Collector of the fields of messages.

    Args:
        type_name: Type of all messages.
        skip: Paths that are not collected.
    """

    def __init__(self, type_name: str, skip: frozenset[str] = frozenset()) -> None:
        self._fields = message_fields(type_name)
        fields = self._fields
        self._numbers = [path for path in fields.numbers if path not in skip]
        single = [*self._numbers, *fields.texts, *(f"{p}.{q}" for p in fields.stamps for q in ("sec", "nanosec"))]
        self._single = _getter(single)
        self._rows: list[tuple[Any, ...]] = []
        self._arrays = {path: attrgetter(path) for path in fields.arrays if path not in skip}
        self._lists = {path: attrgetter(path) for path in fields.lists if path not in skip}
        self._kept: dict[str, list[Any]] = {path: [] for path in (*self._arrays, *self._lists)}
        self._parts = {
            path: (attrgetter(path), MessageRows(kind, _nested_path(skip, path)))
            for path, kind in fields.parts.items()
            if path not in skip
        }
        self._counts: dict[str, list[int]] = {path: [] for path in self._parts}

    def __len__(self) -> int:
        return len(self._rows)

    def take(self, message: object) -> None:
        """Add a message; the values of the message are copied."""
        self._rows.append(self._single(message))
        for path, get in self._arrays.items():
            self._kept[path].append(np.array(get(message)))
        for path, get in self._lists.items():
            self._kept[path].append([str(text) for text in get(message)])
        for path, (get, rows) in self._parts.items():
            items = get(message)
            self._counts[path].append(len(items))
            for item in items:
                rows.take(item)

    def columns(self) -> tuple[dict[str, Column], dict[str, list[str]]]:
        """Return all numbers as columns and all texts as lists, by path of the field."""
        fields = self._fields
        columns: dict[str, Column] = {}
        words: dict[str, list[str]] = {}
        turned = zip(*self._rows, strict=True)
        for path in self._numbers:
            columns[path] = Column(np.array(next(turned, ()), dtype=fields.numbers[path]))
        for path in fields.texts:
            words[path] = [str(text) for text in next(turned, ())]
        for path in fields.stamps:
            sec, nanosec = (np.array(next(turned, ()), dtype=np.int64) for _ in range(2))
            columns[path] = Column(sec * _NS + nanosec)
        for path in self._arrays:
            columns[path] = join_arrays([np.atleast_1d(a) for a in self._kept[path]], fields.arrays[path])
        for path in self._lists:
            words[path] = [", ".join(texts) for texts in self._kept[path]]
        for path, (_, rows) in self._parts.items():
            _add_nested_fields(columns, words, path, rows, self._counts[path])
        return columns, words


def join_arrays(arrays: list[Any], dtype: str) -> Column:
    """Join the arrays of all messages: as a table if all have the same length, else one after another."""
    lengths = np.array([len(a) for a in arrays], dtype=np.int64)
    if not len(arrays):
        return Column(np.zeros((0, 0), dtype=dtype))
    if (lengths == lengths[0]).all():
        return Column(np.stack(arrays).astype(dtype, copy=False))
    return Column(np.concatenate(arrays).astype(dtype, copy=False), lengths)


def _add_nested_fields(
    columns: dict[str, Column], words: dict[str, list[str]], path: str, rows: MessageRows, counts: list[int]
) -> None:
    """Add the fields of nested messages; all values of one outer message become one entry."""
    inner, texts = rows.columns()
    starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    is_even = len(set(counts)) == 1 and counts[0] > 0
    for name, column in inner.items():
        if column.lengths is None and is_even and column.values.ndim == 1:
            columns[f"{path}.{name}"] = Column(column.values.reshape(len(counts), counts[0]))
            continue
        width = column.lengths
        if width is None:
            each = int(np.prod(column.values.shape[1:], dtype=np.int64)) if column.values.ndim > 1 else 1
            width = np.full(len(rows), each, dtype=np.int64)
        ends = np.concatenate([[0], np.cumsum(width)])
        lengths = ends[starts[1:]] - ends[starts[:-1]]
        columns[f"{path}.{name}"] = Column(column.values.reshape(-1), lengths)
    for name, values in texts.items():
        words[f"{path}.{name}"] = [", ".join(values[start:stop]) for start, stop in pairwise(starts)]


def _nested_path(skip: frozenset[str], path: str) -> frozenset[str]:
    return frozenset(p.removeprefix(path + ".") for p in skip if p.startswith(path + "."))


def _getter(paths: list[str]) -> Callable[[Any], tuple[Any, ...]]:
    """Return a function that returns the values at all paths as a tuple."""
    if not paths:
        return lambda _: ()
    if len(paths) == 1:
        one = attrgetter(paths[0])
        return lambda message: (one(message),)
    return attrgetter(*paths)
