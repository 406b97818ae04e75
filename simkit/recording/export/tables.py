"""Tables of messages of one type, written as CSV, NumPy or Parquet."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from itertools import chain
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.errors import InputError
from simkit.install_command import install_command
from simkit.msgs.message_columns import TEXT, Column
from simkit.msgs.message_types import FieldValue

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
        np.savez_compressed(file, allow_pickle=False, **{_npz_key(name): array for name, array in arrays.items()})
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
        text = "--format parquet needs the package pyarrow, which is not installed"
        help_ = f"{install_command('parquet')}, or use --format npz"
        raise InputError("SK-BAG-014", text, help=help_) from None


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
