"""Axes and lines of charts: conversion of numbers to pixels, round ticks with labels, and thinning of lines."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simkit.recording.charts.series import Series

Numbers = NDArray[np.float64]
Points = NDArray[np.float64]

_LEAST = 1e-200  # smaller differences count as zero


@dataclass(frozen=True)
class Axis:
    """Axis that converts numbers to pixels.

    Attributes:
        low, high: numbers at both ends.
        start, end: pixels of both ends.
        base: number that is subtracted from all numbers in the labels, so that they stay short.
        is_log: True if the numbers are decimal logarithms.
    """

    low: float
    high: float
    start: float
    end: float
    base: float = 0.0
    is_log: bool = False

    @property
    def base_text(self) -> str:
        """Description of the base that is subtracted from the labels; empty without a base."""
        return f", less {self.base:.12g}" if self.base else ""

    def at(self, values: Numbers) -> Numbers:
        """Return the pixels of numbers."""
        return self.start + (values - self.low) / (self.high - self.low) * (self.end - self.start)

    def ticks(self, count: float) -> list[tuple[float, str]]:
        """Return pixel and label of about `count` ticks."""
        low, high = self.low - self.base, self.high - self.base
        step = _round_step((high - low) / count)
        if self.is_log:
            step = max(1.0, round(step))
        values = [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]
        labels = [f"1e{value:.0f}" if self.is_log else _label(value, step) for value in values]
        positions = self.at(np.array(values, dtype=np.float64) + self.base)
        return [(float(position), label) for position, label in zip(positions, labels, strict=True)]


def axis_over(values: Sequence[Numbers], start: float, end: float, *, margin: float, is_log: bool = False) -> Axis:
    """Return an axis that shows all finite numbers.

    Args:
        values: numbers of all lines.
        start: pixel of the low end.
        end: pixel of the high end.
        margin: margin at both ends, as a fraction of the span of the numbers.
        is_log: True if the numbers are decimal logarithms.
    """
    finite = [v[np.isfinite(v)] for v in values]
    finite = [v for v in finite if v.size]
    low = max(min((float(v.min()) for v in finite), default=0.0), -1e300)
    high = min(max((float(v.max()) for v in finite), default=1.0), 1e300)
    size = max(abs(low), abs(high))
    if high - low <= max(1e-12 * size, _LEAST):
        half = 0.5 if is_log else 0.05 * size if size > _LEAST else 1.0
        low, high = low - half, high + half
    room = margin * (high - low)
    low, high = low - room, high + room
    base = 0.0
    if not is_log and high - low < 1e-4 * size:  # else all labels would look equal
        base = round((low + high) / 2, max(0, -math.floor(math.log10(high - low))))
    return Axis(low, high, start, end, base, is_log)


def split_line(series: Series) -> list[tuple[Numbers, Numbers]]:
    """Split a line at missing numbers, and at each point where an angle wraps around after a full turn."""
    times, values = series.times, series.values
    finite = np.isfinite(values) & np.isfinite(times)
    breaks = np.flatnonzero(np.diff(finite.astype(np.int8))) + 1
    if series.is_angle:
        jumps = np.zeros(max(len(values) - 1, 0), dtype=bool)
        with np.errstate(invalid="ignore"):
            jumps[:] = np.abs(np.diff(values)) > math.pi
        breaks = np.union1d(breaks, np.flatnonzero(jumps) + 1)
    edges = np.concatenate(([0], breaks, [len(values)]))
    return [
        (times[a:b], values[a:b])
        for a, b in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True)
        if b > a and finite[a]
    ]


def thin_line(points: Points, columns_per_pixel: float) -> Points:
    """Keep at most four points per column of pixels: the first, the lowest, the highest and the last.

    Args:
        points: points [px], shape (n, 2), sorted by the first coordinate.
        columns_per_pixel: number of columns per pixel.
    """
    columns = np.floor(points[:, 0] * columns_per_pixel).astype(np.int64)
    starts = np.flatnonzero(np.diff(columns, prepend=columns[:1] - 1))
    if len(points) <= 4 * len(starts):
        return points
    indices: list[int] = []
    for start, end in zip(starts.tolist(), [*starts[1:].tolist(), len(points)], strict=True):
        column = points[start:end, 1]
        indices += sorted({start, start + int(column.argmin()), start + int(column.argmax()), end - 1})
    return points[indices]


def _round_step(step: float) -> float:
    """Return the next number of the sequence 1, 2, 5, 10, …."""
    power = 10.0 ** math.floor(math.log10(step))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= step * (1 - 1e-9))


def _label(value: float, step: float) -> str:
    value = 0.0 if abs(value) < step / 2 else value
    if not 1e-5 < step < 1e5:
        if not value:
            return "0"
        digits = max(0, math.floor(math.log10(abs(value))) - math.floor(math.log10(step) + 1e-9))
        return f"{value:.{digits}e}".replace("e-0", "e-").replace("e+0", "e")
    return f"{value:.{max(0, -math.floor(math.log10(step) + 1e-9))}f}"
