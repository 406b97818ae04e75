"""Repetition of one run of a stored sweep, compared with its row in the table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, TypedDict

from simkit.errors import InputError
from simkit.run_spec import FilePath
from simkit.testing.scenarios.readable_files import OUTSIDE, ReadableFiles
from simkit_learning.sweeps.result_store import NO_SWEEP, OTHER_SWEEP, ResultStore, StoredRow
from simkit_learning.sweeps.row_runner import RowResult, RowRunner
from simkit_learning.sweeps.sweep_file import read_sweep

_COMPARED: Final = ("exit_code", "end", "code", "time", "steps", "state_hash")


class RepetitionReport(TypedDict):
    """Row of a repeated run, and the names of the columns that differ from the table."""

    row: StoredRow
    differences: list[str]


@dataclass(frozen=True)
class Repetition:
    """Result of a repeated run.

    Attributes:
        stored: row of the table; None if the run was not finished.
        repeated: row of the repeated run.
    """

    stored: StoredRow | None
    repeated: RowResult

    @property
    def differences(self) -> list[str]:
        """Columns that differ from the table."""
        if self.stored is None:
            return []
        row, before = self.repeated.plain(), self.stored
        names = [name for name in _COMPARED if row[name] != before[name]]
        return names + [
            name for name, value in row["metrics"].items() if repr(value) != repr(before["metrics"].get(name))
        ]

    @property
    def is_same(self) -> bool:
        """True if the run has the results of the table, or the table does not have the run yet."""
        return not self.differences

    def as_dict(self) -> RepetitionReport:
        """Return the row and the names of the columns that differ."""
        return {"row": self.repeated.plain(), "differences": self.differences}

    def lines(self) -> list[str]:
        """Return a report."""
        row = self.repeated.plain()
        end = f"{row['status']} at t = {row['time']:g} s, state {row['state_hash'][:16]}"
        lines = [f"run {row['run']}, seed {row['seed']}: {end}"]
        lines += [f"  {name} = {value}" for name, value in {**row["values"], **row["metrics"]}.items()]
        if row["message"]:
            lines.append(f"  {row['message']}")
        if self.stored is None:
            return [*lines, "the table does not have this run yet"]
        same = "same as in the table"
        return [*lines, f"differs from the table: {', '.join(self.differences)}" if self.differences else same]


def repeat_run(
    folder: Path,
    number: int,
    file: Path | None = None,
    bundle: Path | None = None,
    folders: Sequence[FilePath] = (),
    *,
    allow_code: bool = False,
    plugin_paths: Sequence[FilePath] = (),
) -> Repetition:
    """Repeat a run of a sweep in this process.

    Args:
        folder: folder of the results.
        number: number of the run.
        file: sweep file; None for the file that the folder names.
        bundle: bundle to write; None for none.
        folders: folders in which the results may name the sweep file and the sweep file may name files, beside its
            own folder and its project.
        allow_code: allow the code that the sweep file names, as in `read_sweep`.
        plugin_paths: allow the code in these folders only.

    Raises:
        InputError: SK-URI-003 the folder names a file elsewhere; SK-SWEEP-003 the file describes another sweep;
            SK-SWEEP-008 the folder has no such run, or names no file; SK-SCEN-008 the file names code that is not
            allowed.
    """
    store = ResultStore(folder)
    store.open()
    source = file or (Path(store.description["file"]) if store.description.get("file") else None)
    if file is None and source is not None:
        folder = folder.absolute()
        refusal = ReadableFiles(folder / "sweep.json", folders, folder.parent).refusal(source)
        if refusal is not None:
            text = f"{folder / 'sweep.json'}: {OUTSIDE} file: {refusal[0]}"
            raise InputError(OUTSIDE, text, help="pass --file SWEEP.yaml", shows_code=False)
    if source is None:
        text = f"the sweep in {folder} was made in Python, so no file describes its runs"
        raise InputError(NO_SWEEP, text, help="repeat it with simkit.load and the values of the row")
    if not 0 <= number < store.count:
        raise InputError(NO_SWEEP, f"{folder} has no run {number}; its runs are 0 to {store.count - 1}")
    spec = read_sweep(source, folders, allow_code=allow_code, plugin_paths=plugin_paths)
    if spec.fingerprint() != store.description.get("fingerprint"):
        text = f"{source} describes another sweep than {folder}"
        raise InputError(OTHER_SWEEP, text, help="undo the changes of the file or the world, or pass --file")
    stored = next((row for row in store.block_rows(number // store.size) if row["run"] == number), None)
    runner = RowRunner(replace(spec, left_out=store.description.get("left_out")))
    row = spec.design.row(number)
    try:
        repeated = runner.run(row) if bundle is None else runner.keep(row, bundle.absolute())
    finally:
        runner.close()
    return Repetition(stored, repeated)
