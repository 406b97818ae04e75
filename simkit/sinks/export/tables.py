"""Columns as files: CSV, NumPy's `.npz`, Parquet."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from importlib import import_module
from itertools import chain
from pathlib import Path
from typing import Any, Final

import numpy as np

from simkit.errors import InputError
from simkit.sinks.export.columns import TEXT, Column

_WIDEST: Final = 16384  # columns of a CSV file: what spreadsheets open
_NS: Final = 1_000_000_000


def write_csv(path: Path, times: Sequence[int], columns: Sequence[Column]) -> list[str]:
    """A line for each message; lists have a column for each item, and empty cells where a message has fewer.

    Args:
        path: the file.
        times: of the messages [ns].
        columns: what they hold.

    Returns:
        What is left out, in words.
    """
    kept: list[Column] = []
    notes, room = [], _WIDEST - 1
    for column in columns:
        if column.most > room or column.most > _WIDEST // 2:
            notes.append(f"{column.path} has up to {column.most} items and is left out: --format npz has it")
            continue
        room -= column.most
        kept.append(column)
    names = [_name(c, i) for c in kept for i in range(c.most)]
    with path.open("w", encoding="utf-8", errors="replace", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["time", *names])
        for time_ns, *cells in zip(times, *(_cells(c) for c in kept), strict=True):
            writer.writerow([f"{time_ns // _NS}.{time_ns % _NS:09d}", *chain.from_iterable(cells)])
    return notes


def _name(column: Column, number: int) -> str:
    """`ranges[0]` of a list of numbers, `transforms[0].child_frame_id` of a list of messages."""
    if not column.is_list:
        return column.path
    path = column.path.removesuffix(".count")
    if path.count("[]") == 1 and path == column.path:
        return path.replace("[]", f"[{number}]")
    return f"{column.path}[{number}]"


def _cells(column: Column) -> Iterator[list[Any]]:
    """The cells of each message."""
    most, as_text = column.most, _text_of(column.kind)
    for row in column.rows():
        cells = [as_text(v) for v in row] if column.is_list else [as_text(row)]
        yield cells + [""] * (most - len(cells))


def _text_of(kind: str) -> Any:
    """What writes a value so that reading it gives the same bits."""
    if kind == "f4":
        return lambda value: str(np.float32(value))
    if kind == "?":
        return int
    return str if kind == TEXT else repr


def write_npz(path: Path, times: Sequence[int], columns: Sequence[Column]) -> list[str]:
    """An array for each column, and `time_ns`.

    Lists of one length are a matrix; others lie one behind the other, and message i has those from
    `PATH.offsets[i]` to `PATH.offsets[i + 1]`.
    """
    arrays: dict[str, Any] = {"time_ns": np.array(times, dtype=np.int64)}
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
        np.savez_compressed(file, allow_pickle=False, **{_key(name): found for name, found in arrays.items()})
    return []


def _key(name: str) -> str:
    """A name that `savez` has no use for itself."""
    return f"{name}_" if name in ("file", "allow_pickle") else name


def check_parquet() -> None:
    """Sees to it that Parquet can be written.

    Raises:
        InputError: SK-BAG-014 its package is not installed.
    """
    try:
        import_module("pyarrow.parquet")
    except ImportError:
        text = (
            "SK-BAG-014 --format parquet needs the package pyarrow, which is not installed\n"
            "    help: pip install 'simkit-robotics[parquet]', or --format npz"
        )
        raise InputError(text, "SK-BAG-014") from None


def write_parquet(path: Path, times: Sequence[int], columns: Sequence[Column]) -> list[str]:
    """A row for each message; lists stay lists; `time` is a time stamp in nanoseconds."""
    pa, pq = import_module("pyarrow"), import_module("pyarrow.parquet")
    arrays: dict[str, Any] = {"time": pa.array(times, pa.timestamp("ns"))}
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
"""What writes a table, by the ending of its file."""
