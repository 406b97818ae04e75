"""Tables of messages of one type: columns of values, written as CSV, NumPy or Parquet."""

from __future__ import annotations

import csv
from array import array
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit.errors import InputError
from simkit.msgs.definition_parser import BASE, NAME, FieldNode
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
        values: values of all messages, concatenated.
        counts: number of values in each message, for a list.
    """

    path: str
    kind: str
    is_list: bool
    read: Reader
    values: FieldValue = field(default_factory=list)
    counts: list[int] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.kind != TEXT:
            self.values = array(_CODES.get(self.kind) or {"i8": "q", "u8": "Q"}[self.kind])

    def take(self, message: object) -> None:
        """Append the values of a message."""
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
        yield Column(path, _DTYPES.get(inner[1][0], TEXT), True, read)
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


_WIDEST: Final = 16384  # columns of a CSV file that spreadsheets can open
_NS: Final = 1_000_000_000


def write_csv(path: Path, times: Sequence[int], columns: Sequence[Column]) -> list[str]:
    """Write one line per message. Each item of a list has a column; cells of missing items are empty.

    Args:
        path: file to write.
        times: times of the messages [ns].
        columns: values of the messages.

    Returns:
        Notes about columns that were left out.
    """
    included: list[Column] = []
    notes, room = [], _WIDEST - 1
    for column in columns:
        if column.most > room or column.most > _WIDEST // 2:
            notes.append(f"{column.path} has up to {column.most} items and is left out; export it with --format npz")
            continue
        room -= column.most
        included.append(column)
    names = [_column_name(c, i) for c in included for i in range(c.most)]
    with path.open("w", encoding="utf-8", errors="replace", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["time", *names])
        for time_ns, *cells in zip(times, *(_cells(c) for c in included), strict=True):
            writer.writerow([f"{time_ns // _NS}.{time_ns % _NS:09d}", *chain.from_iterable(cells)])
    return notes


def _column_name(column: Column, number: int) -> str:
    """Return `ranges[0]` for a list of numbers, `transforms[0].child_frame_id` for a list of messages."""
    if not column.is_list:
        return column.path
    path = column.path.removesuffix(".count")
    if path.count("[]") == 1 and path == column.path:
        return path.replace("[]", f"[{number}]")
    return f"{column.path}[{number}]"


def _cells(column: Column) -> Iterator[list[object]]:
    """Yield the cells of each message."""
    most, as_text = column.most, _text_writer(column.kind)
    for row in column.rows():
        cells = [as_text(v) for v in row] if column.is_list else [as_text(row)]
        yield cells + [""] * (most - len(cells))


def _text_writer(kind: str) -> Callable[[FieldValue], object]:
    """Return a function that formats a value without loss of bits."""
    if kind == "f4":
        return lambda value: str(np.float32(value))
    if kind == "?":
        return int
    return str if kind == TEXT else repr


def write_npz(path: Path, times: Sequence[int], columns: Sequence[Column]) -> list[str]:
    """Write one array per column, and `time_ns`.

    Lists of equal length become a matrix. Other lists are concatenated, and message i has the values from
    `PATH.offsets[i]` to `PATH.offsets[i + 1]`.
    """
    arrays: dict[str, npt.NDArray[np.generic]] = {"time_ns": np.array(times, dtype=np.int64)}
    for column in columns:
        numbers = column.numbers()
        if column.is_list:
            width = column.width
            if width is None:
                arrays[f"{column.path}.offsets"] = np.concatenate(([0], np.cumsum(column.counts))).astype(np.int64)
            else:
                numbers = numbers.reshape(len(column.counts), width)
        arrays[column.path] = numbers
    with path.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **{_npz_key(name): found for name, found in arrays.items()})
    return []


def _npz_key(name: str) -> str:
    """Rename an array whose name is a parameter of `savez`."""
    return f"{name}_" if name in ("file", "allow_pickle") else name


def check_parquet() -> None:
    """Check whether Parquet files can be written.

    Raises:
        InputError: SK-BAG-014 the package is not installed.
    """
    try:
        import_module("pyarrow.parquet")
    except ImportError:
        text = (
            "SK-BAG-014 --format parquet needs the package pyarrow, which is not installed\n"
            "    help: pip install 'simkit-robotics[parquet]', or use --format npz"
        )
        raise InputError(text, "SK-BAG-014") from None


def write_parquet(path: Path, times: Sequence[int], columns: Sequence[Column]) -> list[str]:
    """Write one row per message. A list is one cell; `time` is a time stamp in nanoseconds."""
    pa, pq = import_module("pyarrow"), import_module("pyarrow.parquet")
    arrays: dict[str, object] = {"time": pa.array(times, pa.timestamp("ns"))}
    for column in columns:
        kind = pa.string() if column.kind == TEXT else pa.from_numpy_dtype(np.dtype(column.kind))
        flat = pa.array(column.values if column.kind == TEXT else column.numbers(), kind)
        if column.is_list:
            offsets = np.concatenate(([0], np.cumsum(column.counts)))
            flat = pa.LargeListArray.from_arrays(pa.array(offsets, pa.int64()), flat)
        arrays[column.path] = flat
    pq.write_table(pa.table(arrays), path)
    return []


WRITERS: Final = {"csv": write_csv, "npz": write_npz, "parquet": write_parquet}
"""Functions that write a table, by the suffix of its file."""
