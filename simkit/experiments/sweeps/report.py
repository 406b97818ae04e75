"""HTML report of a sweep: one file that loads no other files and runs no code."""

from __future__ import annotations

import math
import shlex
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from simkit.experiments.sweeps.result_store import ResultStore
from simkit.experiments.sweeps.result_table import column_kinds, flat_row, table_columns
from simkit.experiments.sweeps.sensitivity import Numbers, Sensitivity, sensitivities
from simkit.float_sum import float_sum
from simkit.recording.charts.page_chart import PageChart, page_chart_svg
from simkit.recording.charts.series import Series
from simkit.run_spec import JsonObject
from simkit.writers.atomic_output import write_atomically

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
    text = store.description
    parameters = [name for name in text["parameters"] if name in columns]
    metrics = [name for name in text["metrics"] if name in columns]
    found = sensitivities(text, columns, parameters, metrics)
    wall = float_sum(row["wall_time"] or 0.0 for row in store.timings())
    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters.update(number=_number, values=describe_values)
    template = environment.from_string(_TEMPLATE.read_text("utf-8"))
    page = template.render(
        title=text["title"], finished=len(columns["run"]), count=store.count, statuses=statuses, wall=wall,
        simulated=float(columns["time"].sum()), expressions=text["expressions"],
        summaries=[(name, *_summary(columns[name])) for name in metrics],
        histograms=[page_chart_svg(_histogram(name, columns[name])) for name in metrics if _varies(columns[name])],
        sensitivities=found, has_sobol=any(one.first == one.first for one in found),
        scatters=[page_chart_svg(chart) for chart in _scatters(columns, found)],
        failed=failed, failed_count=sum(n for status, n in statuses.items() if status != "ok"),
        extremes=[one for name in metrics for one in _extremes(name, columns)],
        command=f"simkit sweep replay {shlex.quote(str(folder))}",
    )  # fmt: skip
    write_atomically(target, page.encode("utf-8"))
    return target


def _read(store: ResultStore) -> tuple[dict[str, Numbers], list[JsonObject], Counter[str]]:
    """Return the numeric columns, some failed rows, and the number of runs of each status."""
    kinds, names = column_kinds(store), table_columns(store)
    numeric = [name for name in names if kinds[name] is not str]
    parts: dict[str, list[Numbers]] = {name: [] for name in numeric}
    failed: list[JsonObject] = []
    statuses: Counter[str] = Counter()
    for block in store.blocks:
        rows = store.block_rows(block)
        statuses.update(row["status"] for row in rows)
        failed += [row for row in rows if row["exit_code"]][: max(0, _MOST_FAILED - len(failed))]
        cells = [dict(zip(names, flat_row(row, names), strict=True)) for row in rows]
        for name in numeric:
            listed = [math.nan if one[name] is None else float(one[name]) for one in cells]
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


def _scatters(columns: Mapping[str, Numbers], found: Sequence[Sensitivity]) -> list[PageChart]:
    """Return charts of metrics over parameters, the strongest correlations first."""
    strong = sorted(found, key=lambda one: -abs(one.correlation) if one.correlation == one.correlation else 1.0)
    charts = []
    for one in strong[:_MOST_CHARTS]:
        x, y = columns[one.parameter], columns[one.metric]
        if not _varies(x) or not _varies(y):
            continue
        step = max(1, len(x) // _MOST_DOTS)
        dots = Series(one.metric, times=x[::step], values=y[::step])
        title = f"{one.metric} over {one.parameter}"
        charts.append(PageChart([], title, one.parameter, one.metric, dots=[(dots, "dot")]))
    return charts


def _extremes(name: str, columns: Mapping[str, Numbers]) -> list[_Extreme]:
    values = columns[name]
    if not _varies(values):
        return []
    known = np.flatnonzero(np.isfinite(values))
    order = known[np.argsort(values[known], kind="stable")]
    found = []
    for title, chosen in ((f"lowest {name}", order[:_WORST]), (f"highest {name}", order[::-1][:_WORST])):
        rows = [(int(columns["run"][at]), int(columns["seed"][at]), _number(values[at])) for at in chosen.tolist()]
        found.append(_Extreme(title, rows))
    return found


def describe_values(values: Mapping[str, Any]) -> str:
    """Return the values of a row as one line."""
    return ", ".join(f"{name} = {value}" for name, value in values.items())
