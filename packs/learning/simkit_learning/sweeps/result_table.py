"""Tables of a sweep's results: CSV, Parquet and DataFrame, read block by block from the store."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TypeAlias, cast

from simkit.errors import InputError
from simkit.extend import counted
from simkit.input_file import read_failure, read_input_text
from simkit.install_command import install_command
from simkit.msgs.data_frames import DataFrame
from simkit.scene.overrides import value_text
from simkit.writers.atomic_output import AtomicOutput
from simkit_learning.sweeps.parameter_space import Scalar, Values
from simkit_learning.sweeps.result_store import ResultStore, StoredRow
from simkit_learning.sweeps.sweep_spec import RESULT_COLUMNS, ROW_COLUMNS

Cell: TypeAlias = Scalar | None
"""Cell of a table; None for a parameter or metric that the row does not have."""


def table_columns(store: ResultStore) -> list[str]:
    """Return the columns of a stored sweep."""
    parameters, metrics = store.description["parameters"], store.description["metrics"]
    return [*ROW_COLUMNS, *parameters, *metrics, *RESULT_COLUMNS]


def flat_row(row: StoredRow, columns: Sequence[str]) -> list[Cell]:
    """Return the cells of a row."""
    cells: dict[str, object] = {**row, **row["metrics"], **row["values"]}
    return [_cell(cells.get(name)) for name in columns]


def _cell(value: object) -> Cell:
    return value_text(value) if isinstance(value, list) else cast(Cell, value)


def column_kinds(store: ResultStore) -> dict[str, type]:
    """Return the type of each column: bool, int, float or str; a column of several types has the widest one."""
    columns = table_columns(store)
    types: dict[str, set[type]] = {name: set() for name in columns}
    for row in store.rows():
        for name, cell in zip(columns, flat_row(row, columns), strict=True):
            if cell is not None:
                types[name].add(type(cell))
    return {name: _widest(kinds, name) for name, kinds in types.items()}


def _widest(kinds: set[type], name: str) -> type:
    if len(kinds) == 1:
        return next(iter(kinds))
    if not kinds:
        return str if name in ("status", "end", "code", "message", "state_hash") else float
    return float if kinds <= {int, float} else str


def cell_of(kind: type, cell: Cell) -> Cell:
    """Return a cell of a column's type; a missing number is NaN."""
    if cell is None:
        return math.nan if kind is float else None
    return value_text(cell) if kind is str else cast(Cell, kind(cell))


def typed_blocks(store: ResultStore) -> Iterator[dict[str, list[Cell]]]:
    """Yield the columns of each block, with cells of the columns' types."""
    kinds, columns = column_kinds(store), table_columns(store)
    for block in store.blocks:
        rows = [flat_row(row, columns) for row in store.block_rows(block)]
        yield {name: [cell_of(kinds[name], row[at]) for row in rows] for at, name in enumerate(columns)}


def read_table(folder: str | Path) -> DataFrame:
    """Return the results of a stored sweep as a DataFrame, one row for each finished run, in the order of the runs.

    Raises:
        InputError: SK-SWEEP-008 the folder has no sweep; SK-INPUT-004 pandas is not installed.
    """
    try:
        pandas = import_module("pandas")
    except ImportError:
        hint = install_command("experiments")
        raise InputError("SK-INPUT-004", f"the table needs pandas, which is missing: {hint}") from None
    store = ResultStore(Path(folder))
    store.open()
    cells: dict[str, list[Cell]] = {name: [] for name in table_columns(store)}
    for block in typed_blocks(store):
        for name, column in block.items():
            cells[name] += column
    return pandas.DataFrame(cells)


def write_tables(store: ResultStore) -> list[Path]:
    """Write `results.csv` and, if pyarrow is installed, `results.parquet` into the folder; return their paths."""
    path = store.folder / "results.csv"
    with AtomicOutput(path, "results_files", overwrite=True) as output:
        _write_csv(output.file, store)
    if find_spec("pyarrow") is None:
        return [path]
    parquet = store.folder / "results.parquet"
    with AtomicOutput(parquet, "results_files", overwrite=True) as output:
        _write_parquet(output.file, store)
    return [path, parquet]


def _write_csv(path: Path, store: ResultStore) -> None:
    columns = table_columns(store)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for row in store.rows():
            writer.writerow("" if cell is None else value_text(cell) for cell in flat_row(row, columns))


def _write_parquet(path: Path, store: ResultStore) -> None:
    pa, pq = import_module("pyarrow"), import_module("pyarrow.parquet")
    types = {bool: pa.bool_(), int: pa.int64(), float: pa.float64(), str: pa.string()}
    schema = pa.schema([(name, types[kind]) for name, kind in column_kinds(store).items()])
    # an open file, because the library takes only paths that are valid UTF-8
    with path.open("wb") as file, pq.ParquetWriter(file, schema) as writer:
        for block in typed_blocks(store):
            if block["run"]:
                writer.write_table(pa.table(block, schema=schema))


def read_parameters(path: Path) -> tuple[Values, ...]:
    """Return the rows of a CSV file as values by parameter name.

    Raises:
        InputError: SK-SWEEP-001 the file cannot be read, has no rows, or a row has another number of cells.
    """
    try:
        text = read_input_text(path, 256 << 20)
    except (OSError, ValueError) as error:
        raise _bad_list(path, read_failure(error)) from None
    lines = list(csv.reader(text.splitlines()))
    if len(lines) < 2:
        raise _bad_list(path, "expected a line of parameter names and a line for each run")
    names = [name.strip() for name in lines[0]]
    problems = [
        f"{path}:{number}: found {counted(len(line), 'cell')}, expected {len(names)}"
        for number, line in enumerate(lines[1:], 2)
        if line and len(line) != len(names)
    ]
    if problems or len(set(names)) < len(names) or not all(names):
        raise _bad_list(path, "\n".join(problems) or "the names in the first line must be different and not empty")
    return tuple(dict(zip(names, map(_cell_value, line), strict=True)) for line in lines[1:] if line)


def _bad_list(path: Path, reason: str) -> InputError:
    return InputError("SK-SWEEP-001", f"the list of parameters {path} cannot be used: {reason}")


def _cell_value(text: str) -> Scalar:
    """Return a cell of a CSV file as a number, true, false or a text."""
    text = text.strip()
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    for kind in (int, float):
        try:
            number = kind(text)
        except ValueError:
            continue
        return number if math.isfinite(number) else text
    return text
