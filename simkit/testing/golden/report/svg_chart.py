"""Line charts as SVG inside a page: few bytes, whatever the number of points; colours come from the page's style."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
import numpy.typing as npt

from simkit.testing.golden.report.html_markup import escape_html

Array = npt.NDArray[Any]
WIDTH: Final = 480
"""Of a chart [px]; a page may show it smaller or larger."""
_LEFT, _RIGHT, _TOP, _BOTTOM = 58, 8, 8, 34
_TICKS = 5  # about that many on an axis
_FLAT = 1e-12  # part of a value within which all of them are one


@dataclass(frozen=True)
class Line:
    """One line of a chart.

    Attributes:
        x: ascending, shape (n,).
        y: shape (n,); what is not finite is a gap.
        role: "golden", "run" or "difference": its colour.
    """

    x: Array
    y: Array
    role: Literal["golden", "run", "difference"]


@dataclass(frozen=True)
class _Axis:
    """Values to pixels.

    Attributes:
        low, high: at the two ends.
        start, end: their pixels.
        base: what the labels leave out.
        log: whether the values are decimal logarithms.
    """

    low: float
    high: float
    start: float
    end: float
    base: float = 0.0
    log: bool = False

    def at(self, values: Array) -> Array:
        return self.start + (values - self.low) / (self.high - self.low) * (self.end - self.start)

    def ticks(self) -> list[tuple[float, str]]:
        """Pixel and label."""
        low, high = self.low - self.base, self.high - self.base
        step = _round_tick_step((high - low) / _TICKS)
        if self.log:
            step = max(1.0, round(step))
        values = [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]
        if self.log:
            labels = [f"1e{value:.0f}" for value in values]
        else:
            labels = [_label(value, step) for value in values]
        places = self.at(np.array(values) + self.base)
        return [(float(place), label) for place, label in zip(places, labels, strict=True)]


def chart(
    lines: Sequence[Line],
    *,
    title: str,
    x_label: str,
    y_label: str,
    height: int = 180,
    mark: float | None = None,
    log: bool = False,
) -> str:
    """An SVG element.

    Args:
        lines: what is drawn, the first at the bottom.
        title: for who cannot see it.
        x_label, y_label: quantity and unit.
        height: [px].
        mark: where an upright line is drawn [in x].
        log: whether both axes are logarithmic; what is not above zero is a gap.
    """
    drawn = [_as_log(line) for line in lines] if log else list(lines)
    x = _axis([line.x for line in drawn], _LEFT, WIDTH - _RIGHT, log=log, margin=0.0)
    y = _axis([line.y for line in drawn], height - _BOTTOM, _TOP, log=log, margin=0.06)
    if y.base:
        y_label += f", less {y.base:.12g}"
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img" class="chart">',
        f"<title>{escape_html(title)}</title>",
        *_frame(x, y, height),
    ]
    if mark is not None and x.low <= mark <= x.high:
        place = float(x.at(np.array(mark)))
        parts.append(f'<path class="mark" d="M{place:.1f} {_TOP}V{height - _BOTTOM}"/>')
    parts += [f'<path class="line {line.role}" d="{d}"/>' for line in drawn if (d := _path(line, x, y))]
    middle = (_LEFT + WIDTH - _RIGHT) / 2
    parts.append(f'<text x="{middle:.0f}" y="{height - 4}" class="middle">{escape_html(x_label)}</text>')
    upright = (height - _BOTTOM + _TOP) / 2
    turned = f'transform="translate(11 {upright:.0f}) rotate(-90)"'
    parts.append(f'<text {turned} class="middle">{escape_html(y_label)}</text></svg>')
    return "".join(parts)


def thin_line(x: Array, y: Array) -> tuple[Array, Array]:
    """A line with no more than two points a pixel column, its lowest and its highest, in their order.

    Args:
        x: ascending pixels, (n,).
        y: (n,), finite.
    """
    columns = np.floor(x).astype(np.int64)
    starts = np.flatnonzero(np.diff(columns, prepend=columns[:1] - 1))
    if len(x) <= 2 * len(starts):
        return x, y
    ends = np.append(starts[1:], len(x))
    kept = np.empty((len(starts), 2), np.int64)
    for number, (start, end) in enumerate(zip(starts, ends, strict=True)):
        part = y[start:end]
        kept[number] = sorted((start + int(part.argmin()), start + int(part.argmax())))
    flat = kept.reshape(-1)
    flat = flat[np.diff(flat, prepend=-1) != 0]
    return x[flat], y[flat]


def _as_log(line: Line) -> Line:
    x, y = np.asarray(line.x, float), np.asarray(line.y, float)
    with np.errstate(divide="ignore", invalid="ignore"):
        lx, ly = np.log10(x), np.log10(y)
    keep = np.isfinite(lx)
    return Line(lx[keep], ly[keep], line.role)


def _axis(values: Sequence[Array], start: float, end: float, *, log: bool, margin: float) -> _Axis:
    finite = [np.asarray(v, float)[np.isfinite(v)] for v in values]
    finite = [v for v in finite if len(v)]
    low = min((float(v.min()) for v in finite), default=0.0)
    high = max((float(v.max()) for v in finite), default=1.0)
    low, high = max(low, -1e300), min(high, 1e300)
    size = max(abs(low), abs(high))
    if high - low <= _FLAT * size or high == low:
        half = 0.5 if log else (0.01 * size or 1.0)
        low, high = low - half, high + half
    room = margin * (high - low)
    low, high = low - room, high + room
    base = 0.0
    if not log and (high - low) < 1e-4 * size:  # a small change of a large value: its labels would all look the same
        base = round((low + high) / 2, max(0, -math.floor(math.log10(high - low))))
    return _Axis(low, high, start, end, base, log)


def _frame(x: _Axis, y: _Axis, height: int) -> list[str]:
    bottom, right = height - _BOTTOM, WIDTH - _RIGHT
    grid = "".join(f"M{_LEFT} {place:.1f}H{right}" for place, _ in y.ticks())
    grid += "".join(f"M{place:.1f} {_TOP}V{bottom}" for place, _ in x.ticks())
    parts = [f'<path class="grid" d="{grid}"/>' if grid else ""]
    parts += [f'<text x="{_LEFT - 4}" y="{place + 3.5:.1f}" class="end">{label}</text>' for place, label in y.ticks()]
    parts += [
        f'<text x="{min(place, right - 10):.1f}" y="{bottom + 13}" class="middle">{label}</text>'
        for place, label in x.ticks()
    ]
    return parts


def _path(line: Line, x: _Axis, y: _Axis) -> str:
    """The commands of a path; each stretch of finite values is one."""
    px, values = np.asarray(x.at(np.asarray(line.x, float))), np.asarray(line.y, float)
    finite = np.isfinite(values)
    edges = np.flatnonzero(np.diff(finite.astype(np.int8), prepend=0, append=0))
    parts: list[str] = []
    last_column = -1.0
    for start, end in edges.reshape(-1, 2):
        if px[end - 1] < last_column + 1.0:  # gaps narrower than a pixel: one dot stands for all in the column
            continue
        last_column = float(np.floor(px[end - 1]))
        with np.errstate(over="ignore"):
            py = np.clip(y.at(values[start:end]), -1e4, 1e4)
        xs, ys = thin_line(px[start:end], py)
        points = [f"{a:.1f} {b:.1f}" for a, b in zip(xs, ys, strict=True)]
        parts.append("M" + "L".join(points) + ("h.01" if len(points) == 1 else ""))
    return "".join(parts)


def _round_tick_step(step: float) -> float:
    """The next of 1, 2, 5, 10, … ."""
    power = 10.0 ** math.floor(math.log10(step))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= step * (1 - 1e-9))


def _label(value: float, step: float) -> str:
    value = 0.0 if abs(value) < step / 2 else value
    if not 1e-4 <= abs(step) < 1e5:
        if not value:
            return "0"
        digits = max(0, math.floor(math.log10(abs(value))) - math.floor(math.log10(step)))
        return f"{value:.{digits}e}".replace("e-0", "e-").replace("e+0", "e")
    return f"{value:.{max(0, -math.floor(math.log10(step) + 1e-9))}f}"
