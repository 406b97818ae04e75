"""Store of a sweep's results in a folder: append-only blocks of rows that survive the kill of the program.

    sweep.json             description and fingerprint of the sweep, and its block size
    rows/000012.log        rows of block 12 in the order in which they ended, one JSON object a line
    rows/000012.rows       all rows of block 12 in the order of their numbers; it replaces the log
    timings/000012.log     wall times of these rows, which differ from run to run
    locks/000012.lock      lock of the process that writes block 12

A row is finished when its line, with the line break, is in a file. The names of the complete blocks and the logs of the
others are the index of finished rows, so opening a store with a million rows reads only the open blocks.
"""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from io import RawIOBase
from pathlib import Path
from typing import Final, NotRequired, TypedDict, cast

from simkit import file_lock
from simkit.errors import InputError
from simkit.input_file import read_failure, read_input, read_input_text
from simkit.json_reader import parse_json
from simkit.output_file import open_regular
from simkit.testing import newly_left_out
from simkit.writers.atomic_output import write_atomically
from simkit_learning.sweeps.parameter_space import ParameterValue, Scalar

OTHER_SWEEP: Final = "SK-SWEEP-003"
NO_SWEEP: Final = "SK-SWEEP-008"
_DESCRIPTION: Final = "sweep.json"
_LOCKS: Final = "locks"
_FORMAT: Final = 1
_LARGEST_FILE: Final = 1 << 30  # [bytes]
_MOST_IN_BLOCK: Final = 10_000
_BLOCKS: Final = 64  # number of blocks of a small sweep, so that several machines can share it


class SweepDescription(TypedDict, total=False):
    """Content of `sweep.json`: what a report needs to know about a sweep.

    Attributes:
        title: name of the run.
        parameters, metrics: names of the columns.
        expressions: metrics that are expressions.
        sampling, points, combinations, seeds: numbers of the design.
        sampled: names of the parameters with distributions.
        file: absolute path of the sweep file; empty for a sweep made in Python.
        search: metric whose best value is searched; missing for other sweeps.
        left_out: names of the sensors, plugins and controllers without which the runs were made, with their numbers.
        format, fingerprint, count, block: see `ResultStore`.
    """

    title: str
    parameters: list[str]
    metrics: list[str]
    expressions: dict[str, str]
    sampling: str
    points: int
    combinations: int
    seeds: int
    sampled: list[str]
    file: str
    search: str
    left_out: dict[str, int]
    format: int
    fingerprint: str
    count: int
    block: int


class StoredRow(TypedDict):
    """Row of the results; `RowResult` explains its columns."""

    run: int
    seed: int
    values: dict[str, ParameterValue]
    metrics: dict[str, Scalar]
    exit_code: int
    status: str
    end: str
    code: str
    message: str
    time: float
    steps: int
    state_hash: str
    wall_time: NotRequired[float]


class Timing(TypedDict):
    """Wall time of a run [s]; None if it is not known."""

    run: int
    wall_time: float | None


def block_size(count: int) -> int:
    """Return the number of rows of a block for a sweep with a number of runs."""
    return max(1, min(_MOST_IN_BLOCK, -(-count // _BLOCKS)))


def make_folder(folder: Path) -> None:
    """Make the folder of a sweep.

    Raises:
        InputError: SK-CLI-016 the folder cannot be written to.
    """
    try:
        for name in (_LOCKS, "rows", "timings"):  # a link in the folder would lead the rows to another folder
            if (folder / name).is_symlink():
                raise OSError(errno.ELOOP, "it is a symbolic link", str(folder / name))
        (folder / _LOCKS).mkdir(parents=True, exist_ok=True)
        open_regular(folder / _LOCKS / "folder.lock").close()
    except OSError as error:
        raise _not_writable(folder, error) from None


@contextmanager
def locked_blocks(folder: Path, blocks: Sequence[int]) -> Iterator[None]:
    """Allow one writer at a time for each block of a sweep, however it is divided into parts.

    Each block has its own lock file, which stays in the folder. The system releases the locks of a killed process.

    Raises:
        InputError: SK-SWEEP-010 another process writes one of the blocks; SK-CLI-016 a lock file cannot be written.
    """
    text = f"another process runs the sweep in {folder}, or a part of it"
    busy = InputError("SK-SWEEP-010", text, help="wait for its end, or name another folder")
    with ExitStack() as files:
        for block in blocks:
            try:
                file = files.enter_context(open_regular(folder / _LOCKS / f"{block:06d}.lock"))
                is_free = file_lock.try_lock(file.fileno())
            except OSError as error:
                raise _not_writable(folder, error) from None
            if not is_free:
                raise busy
        yield


def _not_writable(folder: Path, error: OSError) -> InputError:
    place = error.filename or folder
    return InputError("SK-CLI-016", f"cannot write to {place}: {error.strerror or error}")


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
        self.description: SweepDescription = {}
        self._logs: dict[int, tuple[RawIOBase, RawIOBase]] = {}
        self._open_rows: dict[int, set[int]] = {}

    # ------------------------------------------------------------------ begin

    def open(self) -> None:
        """Open a stored sweep for reading.

        Raises:
            InputError: SK-SWEEP-008 the folder has no sweep.
        """
        try:
            description = parse_json(read_input_text(self.folder / _DESCRIPTION, _LARGEST_FILE, inside=self.folder))
            self.count, self.size = int(description["count"]), int(description["block"])
            left_out = description.get("left_out", {})
            is_counted = isinstance(left_out, dict) and all(isinstance(count, int) for count in left_out.values())
            if description["format"] != _FORMAT or self.size < 1 or not is_counted:
                raise ValueError
        except (OSError, ValueError, KeyError, TypeError):
            hint = "name the folder that `simkit sweep SWEEP.yaml -o DIR` wrote"
            raise InputError(NO_SWEEP, f"{self.folder} has no sweep", help=hint) from None
        self.description = description

    def begin(self, fingerprint: str, count: int, description: SweepDescription) -> None:
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
                    OTHER_SWEEP,
                    f"{self.folder} has the results of another sweep: its world, parameters, metrics or seeds differ",
                    help="name another folder with -o, or delete this one",
                )
            if count <= self.count:
                return
        self.count = count
        self.size = int(self.description.get("block", block_size(count)))
        content: SweepDescription = {
            "format": _FORMAT, "fingerprint": fingerprint, "count": count, "block": self.size, **description
        }  # fmt: skip
        if "left_out" in self.description:
            content["left_out"] = self.description["left_out"]
        self._describe(content)

    def check_left_out(self, left_out: Mapping[str, int]) -> None:
        """Store what the worlds of the sweep run without, or compare it with what the stored runs had.

        Raises:
            InputError: SK-SWEEP-003 the stored runs had other sensors, plugins or controllers.
        """
        self.open()  # another part of the sweep may have stored it
        before = self.description.get("left_out")
        if before is None:
            self._describe({**self.description, "left_out": dict(left_out)})
            return
        problems = [f"is now without {name}, which the stored runs had" for name in newly_left_out(before, left_out)]
        problems += [f"now has {name}, which the stored runs lacked" for name in newly_left_out(left_out, before)]
        if problems:
            text = f"{self.folder} has the results of another sweep: the world {'; it '.join(problems)}"
            raise InputError(OTHER_SWEEP, text, help="name another folder with -o, or undo the change")

    def _describe(self, content: SweepDescription) -> None:
        path = self.folder / _DESCRIPTION
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

    def add(self, row: StoredRow) -> None:
        """Append a finished row. The row is on its way to the disk when this function returns."""
        block = row["run"] // self.size
        finished = self._finished(block)
        if row["run"] in finished:
            return
        rows, timings = self._log(block)
        stored: dict[str, object] = {**row}
        timings.write(json.dumps({"run": row["run"], "wall_time": stored.pop("wall_time", None)}).encode() + b"\n")
        rows.write(json.dumps(stored, separators=(",", ":")).encode() + b"\n")  # one call, so lines never mix
        finished.add(row["run"])
        if len(finished) == len(self.runs_of(block)):
            self._complete(block)

    def rows(self) -> Iterator[StoredRow]:
        """Yield all finished rows in the order of their numbers, one block at a time."""
        for block in self.blocks:
            yield from self.block_rows(block)

    def block_rows(self, block: int) -> list[StoredRow]:
        """Return the finished rows of a block in the order of their numbers."""
        path = self._path(block, "rows")
        lines = _ended_lines(path if path.exists() else self._path(block, "log"))
        rows = {row["run"]: row for row in map(_row_of, lines) if row is not None}
        return [rows[run] for run in sorted(rows)]

    def timings(self) -> Iterator[Timing]:
        """Yield the run number and the wall time [s] of finished rows."""
        for block in self.blocks:
            lines = _ended_lines(self.folder / "timings" / f"{block:06d}.log")
            yield from (cast(Timing, row) for row in map(_row_of, lines) if row is not None)

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
        runs = self._open_rows.get(block)
        if runs is None:
            path = self._path(block, "log")
            _repair(path)
            runs = self._open_rows[block] = {row["run"] for row in self.block_rows(block)}
            if runs and len(runs) == len(self.runs_of(block)):  # killed between the last row and its ordered copy
                self._complete(block)
                return set(runs)
        return runs

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
            lines = {row["run"]: line for line in _ended_lines(log_path) if (row := _row_of(line)) is not None}
            content = b"".join(lines[run] + b"\n" for run in sorted(lines))
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
        raise InputError(NO_SWEEP, f"{path} cannot be read: {read_failure(error)}") from None


def _open_log(path: Path) -> RawIOBase:
    return open_regular(path).detach()


def _ended_lines(path: Path) -> list[bytes]:
    """Return the lines of a file that end with a line break."""
    content = _content(path)
    return content[: content.rfind(b"\n") + 1].splitlines()


def _row_of(line: bytes) -> StoredRow | None:
    """Return the row of a line; None for a damaged line, whose run is then repeated."""
    try:
        row = parse_json(line)
    except ValueError:
        return None
    return cast(StoredRow, row) if isinstance(row, dict) and isinstance(row.get("run"), int) else None


def _repair(path: Path) -> None:
    """Remove the incomplete last line of a log, and damaged lines."""
    content = _content(path)
    sound = b"".join(line + b"\n" for line in _ended_lines(path) if _row_of(line) is not None)
    if sound != content:
        write_atomically(path, sound, follow_link=False)
