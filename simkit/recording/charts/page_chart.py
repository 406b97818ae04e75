"""Small charts inside an HTML page, as SVG whose colours come from the page's style sheet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import Final

import numpy as np

from simkit.recording.charts.axis import Axis, axis_over, split_line, thin_line
from simkit.recording.charts.canvas import path_data, printable
from simkit.recording.charts.series import Series

WIDTH: Final = 480
"""Width of a chart [px]; a page may show it smaller or larger."""
_LEFT, _RIGHT, _TOP, _BOTTOM = 58, 8, 8, 34
_TICKS = 5  # about that many on an axis


@dataclass(frozen=True)
class PageChart:
    """A chart for a page.

    Attributes:
        lines: series and the style class of each, the first at the bottom.
        title: for who cannot see it.
        x_label, y_label: quantity and unit.
        height: [px].
        mark: where an upright line is drawn [in x].
        is_log: whether both axes are logarithmic; a value that is not above zero is a gap.
        caption: text below the chart.
    """

    lines: Sequence[tuple[Series, str]]
    title: str
    x_label: str
    y_label: str
    height: int = 180
    mark: float | None = None
    is_log: bool = False
    caption: str = ""


def page_chart_svg(chart: PageChart) -> str:
    """Return a chart as an SVG element."""
    lines = [(_logarithm(one) if chart.is_log else one, role) for one, role in chart.lines]
    bottom, right = chart.height - _BOTTOM, WIDTH - _RIGHT
    x = axis_over([one.times for one, _ in lines], _LEFT, right, margin=0.0, is_log=chart.is_log)
    y = axis_over([one.values for one, _ in lines], bottom, _TOP, margin=0.06, is_log=chart.is_log)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {chart.height}" role="img" class="chart">',
        f"<title>{_text(chart.title)}</title>",
        *_grid(x, y, bottom, right),
    ]
    if chart.mark is not None and x.low <= chart.mark <= x.high:
        parts.append(f'<path class="mark" d="M{float(x.at(np.array(chart.mark))):.1f} {_TOP}V{bottom}"/>')
    parts += [f'<path class="line {role}" d="{path}"/>' for one, role in lines if (path := _path(one, x, y))]
    middle, upright = (_LEFT + right) / 2, (bottom + _TOP) / 2
    parts.append(f'<text x="{middle:.0f}" y="{chart.height - 4}" class="middle">{_text(chart.x_label)}</text>')
    turned = f'transform="translate(11 {upright:.0f}) rotate(-90)"'
    parts.append(f'<text {turned} class="middle">{_text(chart.y_label + y.base_text)}</text></svg>')
    return "".join(parts)


def _grid(x: Axis, y: Axis, bottom: float, right: float) -> list[str]:
    across, up = x.ticks(_TICKS), y.ticks(_TICKS)
    lines = "".join(f"M{_LEFT} {place:.1f}H{right}" for place, _ in up)
    lines += "".join(f"M{place:.1f} {_TOP}V{bottom}" for place, _ in across)
    parts = [f'<path class="grid" d="{lines}"/>'] if lines else []
    parts += [f'<text x="{_LEFT - 4}" y="{place + 3.5:.1f}" class="end">{label}</text>' for place, label in up]
    return parts + [
        f'<text x="{min(place, right - 10):.1f}" y="{bottom + 13}" class="middle">{label}</text>'
        for place, label in across
    ]


def _path(one: Series, x: Axis, y: Axis) -> str:
    """Return the commands of a path; each stretch of finite values is one."""
    found: list[str] = []
    last_column = -1.0
    for times, values in split_line(one):
        px = x.at(times)
        if px[-1] < last_column + 1.0:  # gaps narrower than a pixel: one dot stands for all in the column
            continue
        last_column = float(np.floor(px[-1]))
        with np.errstate(over="ignore"):
            py = np.clip(y.at(values), -1e4, 1e4)
        points = thin_line(np.column_stack((px, py)), 0.5)
        found.append(path_data(points) + ("h.01" if len(points) == 1 else ""))
    return "".join(found)


def _logarithm(one: Series) -> Series:
    with np.errstate(divide="ignore", invalid="ignore"):
        return replace(one, times=np.log10(one.times), values=np.log10(one.values))


def _text(text: str) -> str:
    return escape(printable(text))
