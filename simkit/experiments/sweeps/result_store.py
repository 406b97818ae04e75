"""Store of a sweep's results in a folder: append-only blocks of rows that survive the kill of the program.

    sweep.json             description and fingerprint of the sweep, and its block size
    rows/000012.log        rows of block 12 in the order in which they ended, one JSON object a line
    rows/000012.rows       all rows of block 12 in the order of their numbers; it replaces the log
    timings/000012.log     wall times of these rows, which differ from run to run

A row is finished when its line, with the line break, is in a file. The names of the complete blocks and the logs of the
others are the index of finished rows, so opening a store with a million rows reads only the open blocks.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import suppress
from io import RawIOBase
from pathlib import Path
from typing import Any, Final

from simkit.errors import InputError
from simkit.input_file import read_failure, read_input, read_input_text
from simkit.json_reader import parse_json
from simkit.output_file import open_regular
from simkit.run_spec import JsonObject
from simkit.writers.atomic_output import write_atomically

OTHER_SWEEP: Final = "SK-SWEEP-003"
NO_SWEEP: Final = "SK-SWEEP-008"
_DESCRIPTION: Final = "sweep.json"
_FORMAT: Final = 1
_LARGEST_FILE: Final = 1 << 30  # [bytes]
_MOST_IN_BLOCK: Final = 10_000
_BLOCKS: Final = 64  # number of blocks of a small sweep, so that several machines can share it


def block_size(count: int) -> int:
    """Return the number of rows of a block for a sweep with a number of runs."""
    return max(1, min(_MOST_IN_BLOCK, -(-count // _BLOCKS)))


class ResultStore:
    """Folder with the results of a sweep.

    Args:
        folder: folder.

    Attributes:
        count: number of runs of the sweep; 0 before `begin`.
        size: number of rows of a block.
        description: content of `sweep.json`.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.count, self.size = 0, 1
        self.description: JsonObject = {}
        self._logs: dict[int, tuple[RawIOBase, RawIOBase]] = {}
        self._open_rows: dict[int, set[int]] = {}

    # ------------------------------------------------------------------ begin

    def open(self) -> None:
        """Open a stored sweep for reading.

        Raises:
            InputError: SK-SWEEP-008 the folder has no sweep.
        """
        try:
            found = parse_json(read_input_text(self.folder / _DESCRIPTION, _LARGEST_FILE, inside=self.folder))
            self.count, self.size = int(found["count"]), int(found["block"])
            if found["format"] != _FORMAT or self.size < 1:
                raise ValueError
        except (OSError, ValueError, KeyError, TypeError):
            hint = "name the folder that `simkit sweep SWEEP.yaml -o DIR` wrote"
            raise InputError(f"{NO_SWEEP} {self.folder} has no sweep\n    help: {hint}", NO_SWEEP) from None
        self.description = found

    def begin(self, fingerprint: str, count: int, description: JsonObject) -> None:
        """Open the folder for writing: a new sweep, or the same sweep again.

        Args:
            fingerprint: hash of the sweep.
            count: number of runs; a sweep that searches may have more runs than before.
            description: further content of `sweep.json`.

        Raises:
            InputError: SK-SWEEP-003 the folder has another sweep.
        """
        path = self.folder / _DESCRIPTION
        if path.exists():
            self.open()
            if self.description.get("fingerprint") != fingerprint:
                raise InputError(
                    f"{OTHER_SWEEP} {self.folder} has the results of another sweep: its world, parameters, metrics or "
                    "seeds differ\n    help: name another folder with -o, or delete this one",
                    OTHER_SWEEP,
                )
            if count <= self.count:
                return
        self.count = count
        self.size = int(self.description.get("block", block_size(count)))
        content = {"format": _FORMAT, "fingerprint": fingerprint, "count": count, "block": self.size, **description}
        write_atomically(path, (json.dumps(content, indent=1) + "\n").encode(), follow_link=False)
        self.description = content

    # ------------------------------------------------------------------ rows

    @property
    def blocks(self) -> range:
        """Numbers of all blocks."""
        return range(-(-self.count // self.size))

    def runs_of(self, block: int) -> range:
        """Return the numbers of the runs of a block."""
        return range(block * self.size, min((block + 1) * self.size, self.count))

    def missing(self, block: int) -> list[int]:
        """Return the runs of a block that are not finished, and repair its log."""
        if self._is_complete(block):
            return []
        finished = self._finished(block)
        return [run for run in self.runs_of(block) if run not in finished]

    def finished_count(self) -> int:
        """Return the number of finished rows."""
        return sum(
            len(self.runs_of(block)) if self._is_complete(block) else len(self.block_rows(block))
            for block in self.blocks
        )

    def add(self, row: JsonObject) -> None:
        """Append a finished row. The row is on its way to the disk when this function returns."""
        block = int(row["run"]) // self.size
        finished = self._finished(block)
        if row["run"] in finished:
            return
        rows, timings = self._log(block)
        stored = dict(row)
        timings.write(json.dumps({"run": row["run"], "wall_time": stored.pop("wall_time", None)}).encode() + b"\n")
        rows.write(json.dumps(stored, separators=(",", ":")).encode() + b"\n")  # one call, so lines never mix
        finished.add(row["run"])
        if len(finished) == len(self.runs_of(block)):
            self._complete(block)

    def rows(self) -> Iterator[JsonObject]:
        """Yield all finished rows in the order of their numbers, one block at a time."""
        for block in self.blocks:
            yield from self.block_rows(block)

    def block_rows(self, block: int) -> list[JsonObject]:
        """Return the finished rows of a block in the order of their numbers."""
        path = self._path(block, "rows")
        lines = _whole_lines(path if path.exists() else self._path(block, "log"))
        found = {row["run"]: row for row in map(_row_of, lines) if row is not None}
        return [found[run] for run in sorted(found)]

    def timings(self) -> Iterator[JsonObject]:
        """Yield the run number and the wall time [s] of finished rows."""
        for block in self.blocks:
            yield from filter(None, map(_row_of, _whole_lines(self.folder / "timings" / f"{block:06d}.log")))

    def close(self) -> None:
        """Close the open logs."""
        for logs in self._logs.values():
            for log in logs:
                log.close()
        self._logs.clear()

    # ------------------------------------------------------------------ files

    def _path(self, block: int, suffix: str) -> Path:
        return self.folder / "rows" / f"{block:06d}.{suffix}"

    def _is_complete(self, block: int) -> bool:
        """Check whether all rows of a block are stored in order."""
        path = self._path(block, "rows")
        if not path.exists():
            return False
        return len(self.runs_of(block)) == self.size or len(self.block_rows(block)) == len(self.runs_of(block))

    def _finished(self, block: int) -> set[int]:
        found = self._open_rows.get(block)
        if found is None:
            path = self._path(block, "log")
            _repair(path)
            found = self._open_rows[block] = {row["run"] for row in self.block_rows(block)}
            if found and len(found) == len(self.runs_of(block)):  # killed between the last row and its ordered copy
                self._complete(block)
                return set(found)
        return found

    def _log(self, block: int) -> tuple[RawIOBase, RawIOBase]:
        logs = self._logs.get(block)
        if logs is None:
            (self.folder / "rows").mkdir(parents=True, exist_ok=True)
            (self.folder / "timings").mkdir(exist_ok=True)
            rows = self._path(block, "log")
            ordered = self._path(block, "rows")
            if ordered.exists() and not rows.exists():  # the sweep has more runs than when the block was completed
                write_atomically(rows, _content(ordered), follow_link=False)
            timings = self.folder / "timings" / f"{block:06d}.log"
            _repair(timings)
            # without a buffer: a line reaches the system with its call, and a kill of this process cannot lose it
            logs = self._logs[block] = (_open_log(rows), _open_log(timings))
            with suppress(OSError):
                os.fsync(logs[0].fileno())
        return logs

    def _complete(self, block: int) -> None:
        """Replace the log of a block by its rows in order. A kill on the way leaves the log, or both files."""
        for log in self._logs.pop(block, ()):
            log.close()
        log_path = self._path(block, "log")
        if log_path.exists():
            found = {row["run"]: line for line in _whole_lines(log_path) if (row := _row_of(line)) is not None}
            content = b"".join(found[run] + b"\n" for run in sorted(found))
            write_atomically(self._path(block, "rows"), content, follow_link=False)
            log_path.unlink(missing_ok=True)
        self._open_rows.pop(block, None)


def _content(path: Path) -> bytes:
    """Return the content of a file of the store; empty if it does not exist."""
    try:
        return read_input(path, _LARGEST_FILE, inside=path.parent.parent)
    except FileNotFoundError:
        return b""
    except (OSError, ValueError) as error:
        raise InputError(f"{NO_SWEEP} {path} cannot be read: {read_failure(error)}", NO_SWEEP) from None


def _open_log(path: Path) -> RawIOBase:
    return open_regular(path).detach()


def _whole_lines(path: Path) -> list[bytes]:
    """Return the lines of a file that end with a line break."""
    content = _content(path)
    return content[: content.rfind(b"\n") + 1].splitlines()


def _row_of(line: bytes) -> Any:
    """Return the row of a line; None for a damaged line, whose run is then repeated."""
    try:
        row = parse_json(line)
    except ValueError:
        return None
    return row if isinstance(row, dict) and isinstance(row.get("run"), int) else None


def _repair(path: Path) -> None:
    """Remove the incomplete last line of a log, and damaged lines."""
    content = _content(path)
    whole = b"".join(line + b"\n" for line in _whole_lines(path) if _row_of(line) is not None)
    if whole != content:
        write_atomically(path, whole, follow_link=False)
