"""Small charts for an HTML page, as SVG with colours from the page's style sheet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import Final

import numpy as np

from simkit.elementary_functions import log10
from simkit.recording.charts.axis import Axis, axis_over, split_line, thin_line
from simkit.recording.charts.canvas import path_data, printable
from simkit.recording.charts.series import Series

WIDTH: Final = 480
"""Width of a chart [px]; a page may scale it."""
_LEFT, _RIGHT, _TOP, _BOTTOM = 58, 8, 8, 34
_TICKS = 5  # approximate number per axis


@dataclass(frozen=True)
class PageChart:
    """Chart for a page.

    Attributes:
        lines: each series with its CSS class; the first series is drawn at the bottom.
        title: title for screen readers.
        x_label, y_label: quantity and unit of each axis.
        height: height of the chart [px].
        mark: x value of a vertical line.
        is_log: True for two logarithmic axes; values of zero or less are gaps.
        caption: text below the chart.
        dots: series of which each pair of finite numbers is a dot, with its CSS class; "times" are the x values.
    """

    lines: Sequence[tuple[Series, str]]
    title: str
    x_label: str
    y_label: str
    height: int = 180
    mark: float | None = None
    is_log: bool = False
    caption: str = ""
    dots: Sequence[tuple[Series, str]] = ()


def page_chart_svg(chart: PageChart) -> str:
    """Return a chart as an SVG element."""
    lines = [(_logarithm(series) if chart.is_log else series, role) for series, role in chart.lines]
    dots = [(_logarithm(series) if chart.is_log else series, role) for series, role in chart.dots]
    bottom, right = chart.height - _BOTTOM, WIDTH - _RIGHT
    x = axis_over([series.times for series, _ in (*lines, *dots)], _LEFT, right, margin=0.0, is_log=chart.is_log)
    y = axis_over([series.values for series, _ in (*lines, *dots)], bottom, _TOP, margin=0.06, is_log=chart.is_log)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {chart.height}" role="img" class="chart">',
        f"<title>{_text(chart.title)}</title>",
        *_grid(x, y, bottom, right),
    ]
    if chart.mark is not None and x.low <= chart.mark <= x.high:
        parts.append(f'<path class="mark" d="M{float(x.at(np.array(chart.mark))):.1f} {_TOP}V{bottom}"/>')
    parts += [f'<path class="line {role}" d="{path}"/>' for series, role in lines if (path := _path(series, x, y))]
    parts += [f'<path class="{role}" d="{_dots(series, x, y)}"/>' for series, role in dots]
    middle, upright = (_LEFT + right) / 2, (bottom + _TOP) / 2
    parts.append(f'<text x="{middle:.0f}" y="{chart.height - 4}" class="middle">{_text(chart.x_label)}</text>')
    turned = f'transform="translate(11 {upright:.0f}) rotate(-90)"'
    parts.append(f'<text {turned} class="middle">{_text(chart.y_label + y.base_text)}</text></svg>')
    return "".join(parts)


def _grid(x: Axis, y: Axis, bottom: float, right: float) -> list[str]:
    across, up = x.ticks(_TICKS), y.ticks(_TICKS)
    lines = "".join(f"M{_LEFT} {position:.1f}H{right}" for position, _ in up)
    lines += "".join(f"M{position:.1f} {_TOP}V{bottom}" for position, _ in across)
    parts = [f'<path class="grid" d="{lines}"/>'] if lines else []
    parts += [f'<text x="{_LEFT - 4}" y="{position + 3.5:.1f}" class="end">{label}</text>' for position, label in up]
    return parts + [
        f'<text x="{min(position, right - 10):.1f}" y="{bottom + 13}" class="middle">{label}</text>'
        for position, label in across
    ]


def _path(series: Series, x: Axis, y: Axis) -> str:
    """Return the commands of an SVG path, with one part for each stretch of finite values."""
    pieces: list[str] = []
    last_column = -1.0
    for times, values in split_line(series):
        px = x.at(times)
        if px[-1] < last_column + 1.0:  # several short pieces within one pixel need only one dot
            continue
        last_column = float(np.floor(px[-1]))
        with np.errstate(over="ignore"):
            py = np.clip(y.at(values), -1e4, 1e4)
        points = thin_line(np.column_stack((px, py)), 0.5)
        pieces.append(path_data(points) + ("h.01" if len(points) == 1 else ""))
    return "".join(pieces)


def _dots(series: Series, x: Axis, y: Axis) -> str:
    """Return the commands of an SVG path with a dot for each pair of finite numbers."""
    known = np.isfinite(series.times) & np.isfinite(series.values)
    across, up = x.at(series.times[known]), y.at(series.values[known])
    return "".join(f"M{px:.1f} {py:.1f}h.01" for px, py in zip(across.tolist(), up.tolist(), strict=True))


def _logarithm(series: Series) -> Series:
    with np.errstate(divide="ignore", invalid="ignore"):
        return replace(series, times=log10(series.times), values=log10(series.values))


def _text(text: str) -> str:
    return escape(printable(text))
