"""Report of a fit: an HTML page that loads no other file, and a chart of the readings before and after."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from simkit.recording.charts.chart import Chart, Style, check_suffix, render_chart
from simkit.recording.charts.page_chart import PageChart, page_chart_svg
from simkit.recording.charts.series import Series
from simkit.writers.atomic_output import write_atomically
from simkit_identification.fitting.fitted_values import FitCurve, interval_text
from simkit_identification.fitting.validation import Fold
from simkit_identification.result_texts import percent, write_html

_TEMPLATE: Final = Path(__file__).with_name("report.html.j2")
_MOST_PANELS: Final = 3
_MOST_CHARTS: Final = 24


def write_page(title: str, contents: Mapping[str, Any], overrides: Sequence[str], target: Path) -> Path:
    """Write the page of a fit; return its path.

    Args:
        title: name of the world.
        contents: attributes of the result by name.
        overrides: fitted values, `PATH=VALUE`.
        target: page to write.

    Raises:
        InputError: SK-CLI-016 the page cannot be written.
    """
    curves: Sequence[FitCurve] = contents["curves"]
    folds: Sequence[Fold] = contents["folds"]
    values = {
        "title": title, "result": contents, "overrides": overrides, "hidden": max(0, len(curves) - _MOST_CHARTS),
        "charts": [page_chart_svg(chart) for curve in curves[:_MOST_CHARTS] for chart in _page_charts(curve)],
        "folds": [(f.name, list(f.values.values()), f.error / max(f.own_error, 1e-300)) for f in folds],
        "searched": list(folds[0].values) if folds else [],
    }  # fmt: skip
    filters: dict[str, Callable[..., str]] = {
        "number": lambda value: f"{value:.6g}",
        "percent": percent,
        "interval": interval_text,
    }
    return write_html(_TEMPLATE, values, target, filters)


def _page_charts(curve: FitCurve) -> list[PageChart]:
    title = f"{curve.label} of {curve.recording}"
    lines = [
        (Series("before", times=curve.times, values=curve.before), "before"),
        (Series("recorded", times=curve.times, values=curve.recorded), "recorded"),
        (Series("after", times=curve.times, values=curve.after), "after"),
    ]
    rest = Series("residual", times=curve.times, values=curve.recorded - curve.after)
    return [
        PageChart(lines, title, f"time [s], {curve.recording}", curve.label),
        PageChart([(rest, "after")], f"residual of {title}", "time [s]", "recorded - fitted", height=110),
    ]


def write_chart(title: str, curves: Sequence[FitCurve], target: Path) -> Path:
    """Write a chart of the columns that improve most.

    Args:
        title: name of the world.
        curves: columns.
        target: chart to write.

    Raises:
        InputError: SK-BAG-012 another ending; SK-CLI-016 the chart cannot be written.
    """
    check_suffix(target.name)
    series: list[Series] = []
    styles: list[Style] = []
    for curve in _different(curves):
        unit = curve.label.partition(".")[2]  # lines with the same unit share a panel
        lines = (("recorded", curve.recorded), ("first values", curve.before), ("fitted values", curve.after))
        for colour, (name, values) in enumerate(lines):
            series.append(Series(f"{curve.label}, {name}", unit, times=curve.times, values=values))
            styles.append(Style(colour, colour))
    chart = Chart(series, styles, title=f"{title}: recorded, before and after the fit")
    write_atomically(target, render_chart(chart, target.suffix.lower()))
    return target


def _different(curves: Sequence[FitCurve]) -> list[FitCurve]:
    """Return the first curves that are of different columns of the first recording."""
    if not curves:
        return []
    first = curves[0].recording
    chosen: dict[str, FitCurve] = {}
    for curve in curves:
        if curve.recording == first:
            chosen.setdefault(curve.label, curve)
    return list(chosen.values())[:_MOST_PANELS]
