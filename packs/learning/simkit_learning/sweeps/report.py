"""HTML report of a sweep: one file that loads no other files and runs no code."""

from __future__ import annotations

import math
import shlex
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from simkit.float_sum import float_sum
from simkit.recording.charts.page_chart import PageChart, page_chart_svg
from simkit.recording.charts.series import Series
from simkit.writers.atomic_output import write_atomically
from simkit_learning.sweeps.result_store import ResultStore, StoredRow
from simkit_learning.sweeps.result_table import column_kinds, flat_row, table_columns
from simkit_learning.sweeps.sensitivity import Numbers, Sensitivity, sensitivities

_TEMPLATE: Final = Path(__file__).with_name("report.html.j2")
_BINS: Final = 24
_MOST_DOTS: Final = 1500
_MOST_CHARTS: Final = 60
_WORST: Final = 5  # runs with the lowest and the highest value of each metric
_MOST_FAILED: Final = 20


@dataclass(frozen=True)
class _Extreme:
    """Runs with the lowest or highest values of a metric."""

    title: str
    rows: Sequence[tuple[int, int, str]]


def write_report(folder: Path, target: Path) -> Path:
    """Write the report of a stored sweep, also of an unfinished one; return its path.

    Raises:
        InputError: SK-SWEEP-008 the folder has no sweep; SK-CLI-016 the page cannot be written.
    """
    from jinja2 import Environment, StrictUndefined

    store = ResultStore(folder)
    store.open()
    columns, failed, statuses = _read(store)
    description = store.description
    parameters = [name for name in description["parameters"] if name in columns]
    metrics = [name for name in description["metrics"] if name in columns]
    influences = sensitivities(description, columns, parameters, metrics)
    wall = float_sum(row["wall_time"] or 0.0 for row in store.timings())
    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters.update(number=_number, values=describe_values)
    template = environment.from_string(_TEMPLATE.read_text("utf-8"))
    page = template.render(
        title=description["title"], finished=len(columns["run"]), count=store.count, statuses=statuses, wall=wall,
        simulated=float(columns["time"].sum()), expressions=description["expressions"],
        summaries=[(name, *_summary(columns[name])) for name in metrics],
        histograms=[page_chart_svg(_histogram(name, columns[name])) for name in metrics if _varies(columns[name])],
        sensitivities=influences, has_sobol=any(influence.first == influence.first for influence in influences),
        scatters=[page_chart_svg(chart) for chart in _scatters(columns, influences)],
        failed=failed, failed_count=sum(n for status, n in statuses.items() if status != "ok"),
        extremes=[extreme for name in metrics for extreme in _extremes(name, columns)],
        command=f"simkit sweep replay {shlex.quote(str(folder))}",
    )  # fmt: skip
    write_atomically(target, page.encode("utf-8"))
    return target


def _read(store: ResultStore) -> tuple[dict[str, Numbers], list[StoredRow], Counter[str]]:
    """Return the numeric columns, some failed rows, and the number of runs of each status."""
    kinds, names = column_kinds(store), table_columns(store)
    numeric = [name for name in names if kinds[name] is not str]
    parts: dict[str, list[Numbers]] = {name: [] for name in numeric}
    failed: list[StoredRow] = []
    statuses: Counter[str] = Counter()
    for block in store.blocks:
        rows = store.block_rows(block)
        statuses.update(row["status"] for row in rows)
        failed += [row for row in rows if row["exit_code"]][: max(0, _MOST_FAILED - len(failed))]
        cells = [dict(zip(names, flat_row(row, names), strict=True)) for row in rows]
        for name in numeric:
            listed = [math.nan if (cell := row[name]) is None else float(cell) for row in cells]
            parts[name].append(np.array(listed, dtype=np.float64))
    return {name: np.concatenate(arrays) if arrays else np.empty(0) for name, arrays in parts.items()}, failed, statuses


def _number(value: float) -> str:
    return "–" if value != value else f"{value:.4g}"


def _summary(values: Numbers) -> tuple[int, float, float, float, float, float]:
    """Return count, mean, standard deviation, 5th percentile, median and 95th percentile of the finite values."""
    finite = values[np.isfinite(values)]
    if not len(finite):
        return (0, *[math.nan] * 5)  # type: ignore[return-value]
    low, middle, high = np.percentile(finite, (5, 50, 95)).tolist()
    deviation = float(finite.std(ddof=1)) if len(finite) > 1 else 0.0
    return len(finite), float(finite.mean()), deviation, low, middle, high


def _varies(values: Numbers) -> bool:
    finite = values[np.isfinite(values)]
    return len(finite) > 1 and bool(np.ptp(finite) > 0)


def _histogram(name: str, values: Numbers) -> PageChart:
    counts, edges = np.histogram(values[np.isfinite(values)], bins=_BINS)
    x = np.repeat(edges, 2)
    y = np.concatenate(([0], np.repeat(counts, 2), [0])).astype(np.float64)
    return PageChart([(Series(name, times=x, values=y), "bar")], f"histogram of {name}", name, "runs", height=150)


def _scatters(columns: Mapping[str, Numbers], influences: Sequence[Sensitivity]) -> list[PageChart]:
    """Return charts of metrics over parameters, the strongest correlations first."""
    charts = []
    for influence in sorted(influences, key=_weakness)[:_MOST_CHARTS]:
        x, y = columns[influence.parameter], columns[influence.metric]
        if not _varies(x) or not _varies(y):
            continue
        step = max(1, len(x) // _MOST_DOTS)
        dots = Series(influence.metric, times=x[::step], values=y[::step])
        title = f"{influence.metric} over {influence.parameter}"
        charts.append(PageChart([], title, influence.parameter, influence.metric, dots=[(dots, "dot")]))
    return charts


def _weakness(influence: Sensitivity) -> float:
    """Return a number that is smallest for the strongest correlation, and largest for an unknown one."""
    return -abs(influence.correlation) if influence.correlation == influence.correlation else 1.0


def _extremes(name: str, columns: Mapping[str, Numbers]) -> list[_Extreme]:
    values = columns[name]
    if not _varies(values):
        return []
    known = np.flatnonzero(np.isfinite(values))
    order = known[np.argsort(values[known], kind="stable")]
    extremes = []
    for title, chosen in ((f"lowest {name}", order[:_WORST]), (f"highest {name}", order[::-1][:_WORST])):
        rows = [(int(columns["run"][at]), int(columns["seed"][at]), _number(values[at])) for at in chosen.tolist()]
        extremes.append(_Extreme(title, rows))
    return extremes


def describe_values(values: Mapping[str, object]) -> str:
    """Return the values of a row as one line."""
    return ", ".join(f"{name} = {value}" for name, value in values.items())
