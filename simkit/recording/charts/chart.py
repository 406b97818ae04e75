"""Chart files of numbers over time; each unit has a panel, and the panels are stacked vertically."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from simkit.diagnostics import shorten
from simkit.errors import InputError
from simkit.recording.charts.axis import Axis, axis_over, split_line, thin_line
from simkit.recording.charts.canvas import Canvas, PngCanvas, SvgCanvas, text_width
from simkit.recording.charts.series import Series

SUFFIXES: Final = (".svg", ".png")
_WIDTH, _SINGLE_PANEL, _PANEL = (
    960,
    540,
    240,
)  # [px] width, height of a single panel (3:2 with labels), height if several
_PLANE = 420, 860  # [px] least and largest height of a panel with equal scales
_LEFT, _RIGHT, _TOP, _BOTTOM = 78, 24, 10, 46
_LEGEND, _SIZE, _GAP = 19, 12.0, 12  # [px]
_COLOURS = ("#1f77b4", "#d62728", "#2ca02c", "#ff7f0e", "#9467bd", "#17becf", "#8c564b", "#e377c2", "#7f7f7f")
_DASHES: tuple[tuple[float, ...], ...] = ((), (7, 4), (2, 3), (9, 3, 2, 3))
_DOTTED = 40  # up to this number of values, each value is also drawn as a dot
_MOST_PANELS = 12
_QUANTITIES: Final = {
    "m": "length", "rad": "angle", "m/s": "velocity", "rad/s": "angular velocity", "m/s²": "acceleration",
    "rad/s²": "angular acceleration", "N": "force", "N·m": "torque", "s": "time", "V": "voltage", "A": "current",
    "kg": "mass", "Pa": "pressure", "T": "magnetic field", "K": "temperature", "°C": "temperature", "deg": "angle",
    "Hz": "frequency", "W": "power", "J": "energy",
}  # fmt: skip


@dataclass(frozen=True)
class Style:
    """Style of a line: index of its colour and index of its dash pattern."""

    colour: int = 0
    dash: int = 0

    @property
    def pen(self) -> tuple[str, tuple[float, ...]]:
        """Colour and dash pattern."""
        return _COLOURS[self.colour % len(_COLOURS)], _DASHES[self.dash % len(_DASHES)]


@dataclass(frozen=True)
class Chart:
    """Contents of a chart.

    Attributes:
        series: lines of the chart.
        styles: style of each line; empty for one colour per line.
        title: title of the chart.
        x_label: label of the x axis.
        is_plane: True for equal scales on both axes.
    """

    series: Sequence[Series]
    styles: Sequence[Style] = field(default=())
    title: str = ""
    x_label: str = "time [s]"
    is_plane: bool = False


def check_suffix(name: str) -> None:
    """Check whether a file name has the suffix of a chart.

    Raises:
        InputError: SK-BAG-012 the suffix is not supported.
    """
    ending = name[name.rfind(".") :].lower() if "." in name else ""
    if ending not in SUFFIXES:
        text = f"{name}: found the ending {ending!r}; expected {' or '.join(SUFFIXES)}"
        raise InputError("SK-BAG-012", text)


def render_chart(chart: Chart, ending: str) -> bytes:
    """Return the file content of a chart.

    Args:
        chart: chart to draw.
        ending: `.svg` or `.png`.
    """
    styles = chart.styles or [Style(number) for number in range(len(chart.series))]
    panels: dict[str, list[tuple[Series, Style]]] = {}
    for number, (series, style) in enumerate(zip(chart.series, styles, strict=True)):
        key = series.unit or f"{number if len(chart.series) <= _MOST_PANELS and not chart.styles else ''}"
        panels.setdefault(key, []).append((series, style))
    return _Layout(chart, list(panels.values())).draw(SvgCanvas if ending.lower() == ".svg" else PngCanvas)


class _Layout:
    """Positions of panels, legends and labels in a chart."""

    def __init__(self, chart: Chart, panels: list[list[tuple[Series, Style]]]) -> None:
        self._chart, self._panels = chart, panels
        self._x = axis_over([series.times for series in chart.series], _LEFT, _WIDTH - _RIGHT, margin=0.0)
        self._legends = [_legend([series.label for series, _ in panel]) for panel in panels]
        self._inner = self._panel_height()
        heading = 26 if chart.title else 0
        self._tops, y = [], float(_TOP + heading)
        for rows in self._legends:
            self._tops.append(y + (rows[-1][1] + 1) * _LEGEND)
            y = self._tops[-1] + self._inner + _GAP
        self._height = int(y - _GAP + _BOTTOM)

    def _panel_height(self) -> float:
        """Return the height of each panel [px]; a path gets the proportions of its extent."""
        if len(self._panels) > 1:
            return _PANEL
        if not self._chart.is_plane:
            return _SINGLE_PANEL
        y = axis_over([series.values for series in self._chart.series], 1.0, 0.0, margin=0.06)
        wanted = (y.high - y.low) / (self._x.high - self._x.low) * (_WIDTH - _LEFT - _RIGHT)
        return float(round(min(max(wanted, _PLANE[0]), _PLANE[1])))

    def draw(self, kind: type[SvgCanvas] | type[PngCanvas]) -> bytes:
        canvas = kind(_WIDTH, self._height)
        if self._chart.title:
            canvas.text(_WIDTH / 2, _TOP + 14, _shorten(self._chart.title, _WIDTH - 40, 15), 15, "middle")
        for number, panel in enumerate(self._panels):
            self._panel(canvas, number, panel)
        bottom = self._tops[-1] + self._inner
        for position, label in self._x.ticks(_tick_count(self._x)):
            canvas.text(position, bottom + 16, label, _SIZE, "middle")
        label = self._chart.x_label + self._x.base_text
        canvas.text((_LEFT + _WIDTH - _RIGHT) / 2, bottom + 36, label, _SIZE + 1, "middle")
        return canvas.result()

    def _panel(self, canvas: Canvas, number: int, panel: list[tuple[Series, Style]]) -> None:
        top, bottom = self._tops[number], self._tops[number] + self._inner
        y = axis_over([series.values for series, _ in panel], bottom, top, margin=0.06)
        if self._chart.is_plane:
            self._x, y = _equal_scale(self._x, y)
        x = self._x
        ticks = y.ticks(_tick_count(y))
        for position, label in ticks:
            canvas.line(np.array([[_LEFT, position], [_WIDTH - _RIGHT, position]]), "#e4e4e4")
            canvas.text(_LEFT - 6, position + 4, label, _SIZE, "end")
        for position, _ in x.ticks(_tick_count(x)):
            canvas.line(np.array([[position, top], [position, bottom]]), "#e4e4e4")
        frame = [[_LEFT, top], [_LEFT, bottom], [_WIDTH - _RIGHT, bottom]]
        canvas.line(np.array(frame, dtype=np.float64), "#888888")
        unit = panel[0][0].unit
        quantity = (
            ".".join(panel[0][0].label.rsplit(".", 2)[-2:]) if len(panel) == 1 else _QUANTITIES.get(unit, "value")
        )
        y_label = _shorten(quantity + (f" [{unit}]" if unit else "") + y.base_text, self._inner, _SIZE + 1)
        wide = max((text_width(label, _SIZE) for _, label in ticks), default=0.0)
        beside = max(14.0, _LEFT - 6 - wide - 10)
        canvas.text(beside, (top + bottom) / 2, y_label, _SIZE + 1, "middle", upright=True)
        for series, style in panel:
            self._line(canvas, series, x, y, *style.pen)
        for (series, style), (left, row) in zip(panel, self._legends[number], strict=True):
            colour, dash = style.pen
            at = top - (self._legends[number][-1][1] - row) * _LEGEND - 7
            canvas.line(np.array([[left, at - 4], [left + 24, at - 4]]), colour, 2.0, dash)
            canvas.text(left + 30, at, _shorten(series.label, _WIDTH - _LEFT - 80, _SIZE), _SIZE)

    def _line(self, canvas: Canvas, series: Series, x: Axis, y: Axis, colour: str, dash: tuple[float, ...]) -> None:
        is_over_time = bool(np.all(np.diff(series.times) >= 0))
        for times, values in split_line(series):
            points = np.column_stack((x.at(times), y.at(values)))
            if is_over_time:
                points = thin_line(points, 2.0)
            if len(points) > 1:
                canvas.line(points, colour, 1.4, dash)
            if len(points) == 1 or series.count <= _DOTTED:
                canvas.dots(points, colour, 2.2)


def _tick_count(axis: Axis) -> float:
    return max(2.0, abs(axis.end - axis.start) / (90 if axis.start < axis.end else 45))


def _equal_scale(x: Axis, y: Axis) -> tuple[Axis, Axis]:
    """Return both axes with the same number of pixels per metre."""
    scale = max((a.high - a.low) / abs(a.end - a.start) for a in (x, y))
    axes = []
    for a in (x, y):
        middle, half = (a.low + a.high) / 2, scale * abs(a.end - a.start) / 2
        axes.append(Axis(middle - half, middle + half, a.start, a.end, a.base))
    return axes[0], axes[1]


def _legend(labels: list[str]) -> list[tuple[float, int]]:
    """Return the left end [px] and the row of each legend entry."""
    places, left, row = [], float(_LEFT), 0
    for label in labels:
        wide = 30 + text_width(label, _SIZE) + 22
        if left > _LEFT and left + wide > _WIDTH - _RIGHT:
            left, row = float(_LEFT), row + 1
        places.append((left, row))
        left += wide
    return places


def _shorten(text: str, width: float, size: float) -> str:
    """Shorten a text to a width [px]."""
    return shorten(text, int(width / text_width("x", size)))
