"""Plots of a comparison, for its page."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

import numpy as np

from simkit.recording.charts.page_chart import PageChart, page_chart_svg
from simkit.recording.charts.series import Series
from simkit_identification.comparison.row import DIFFERING, Row
from simkit_identification.measures.context import Context
from simkit_identification.measures.inertial import VECTORS, still_statistics
from simkit_identification.measures.motion import pose_paths
from simkit_identification.measures.ranges import RANGE_EDGES, still_blocks
from simkit_identification.measures.recording import Floats, Signal, SignalRecording, Stream
from simkit_identification.measures.signals import FIELD_OF_MEASURE, is_constant, segment_spectra

_MOST_SIGNALS: Final = 4  # signals of a topic that are drawn
_MOST_CHARTS: Final = 60
_MOST_POINTS: Final = 4000
_SAME_INTERVAL: Final = 0.1  # relative differences of intervals up to which they are not drawn
_ROLES: Final = ("a", "b")


def charts_of(a: SignalRecording, b: SignalRecording | None, rows: Sequence[Row]) -> list[tuple[str, str]]:
    """Return title and SVG of each chart of a comparison: topics with differences first."""
    differing = {row.topic for row in rows if row.verdict in DIFFERING}
    topics = list(dict.fromkeys(row.topic for row in rows))
    charts: list[tuple[str, str]] = []
    for topic in sorted(topics, key=lambda name: name not in differing):
        sides = [side.streams.get(topic) for side in (a, b) if side is not None]
        present = [(stream, side, role) for stream, side, role in zip(sides, (a, b), _ROLES, strict=False) if stream]
        wanted = _wanted_signals(rows, topic)
        for chart in _topic_charts([(s, r, role) for s, r, role in present if r is not None], wanted):
            if len(charts) < _MOST_CHARTS:
                charts.append((chart.caption, page_chart_svg(chart)))
    return charts


def _wanted_signals(rows: Sequence[Row], topic: str) -> list[str]:
    """Return the fields of a topic with the clearest differences."""
    chosen = [row for row in rows if row.topic == topic and row.verdict in DIFFERING]
    matches = [FIELD_OF_MEASURE.match(row.quantity) for row in sorted(chosen, key=lambda row: row.chance)]
    return list(dict.fromkeys(match["field"] for match in matches if match is not None))


_Sides = list[tuple[Stream, SignalRecording, str]]


def _topic_charts(sides: _Sides, wanted: Sequence[str]) -> Iterator[PageChart]:
    if not sides:
        return
    topic = sides[0][0].topic
    yield from _interval_charts(topic, sides)
    yield from _path_charts(topic, sides)
    fields = list(dict.fromkeys([*wanted, *(name for s, _, _ in sides for name in s.signals)]))
    drawn = 0
    for field in fields:
        found = [(s.signals[field], side, role) for s, side, role in sides if field in s.signals]
        if drawn == _MOST_SIGNALS or not any(_is_drawn(signal) for signal, _, _ in found):
            continue
        drawn += 1
        title = f"{topic} {field}"
        lines = [(_series(s), role) for s, _, role in found]
        yield PageChart(lines, title, "time [s]", found[0][0].unit or "value", caption=title)
        yield from _spectrum_chart(title, found)
    yield from _allan_charts(topic, sides)
    yield from _noise_charts(topic, sides)


def _is_drawn(signal: Signal) -> bool:
    """Check whether a signal changes by more than an error of rounding."""
    finite = signal.values[np.isfinite(signal.values)]
    return bool(len(finite) and np.ptp(finite) > 1e-12 and not signal.is_setting)


def _series(signal: Signal) -> Series:
    step = max(1, len(signal.times) // _MOST_POINTS)
    values = signal.values[::step]
    return Series(signal.name, signal.unit, signal.is_angle, times=signal.times[::step], values=values)


def _interval_charts(topic: str, sides: _Sides) -> Iterator[PageChart]:
    """Yield the shares of intervals and latencies, if they are not all the same."""
    for name in ("interval", "latency"):
        lines: list[tuple[Series, str]] = []
        for stream, _, role in sides:
            values = np.diff(stream.received) if name == "interval" else stream.received - stream.stamps
            values = np.sort(values[np.isfinite(values)])
            if len(values) > 2:
                shares = np.arange(1, len(values) + 1) / len(values)
                step = max(1, len(values) // _MOST_POINTS)
                lines.append((Series(name, times=values[::step], values=shares[::step]), role))
        every = np.concatenate([line.times for line, _ in lines]) if lines else np.empty(0)
        if len(every) and np.ptp(every) > max(1e-3, _SAME_INTERVAL * abs(float(np.median(every)))):
            title = f"{topic} distribution of the {name}"
            yield PageChart(lines, title, f"{name} [s]", "share up to this", caption=title)


def _path_charts(topic: str, sides: _Sides) -> Iterator[PageChart]:
    lines: list[tuple[Series, str]] = []
    for stream, _, role in sides:
        for path in pose_paths(stream):
            _, x, y, _ = path.in_start_frame()
            if max(np.ptp(x), np.ptp(y)) > 0.05:
                step = max(1, len(x) // _MOST_POINTS)
                lines.append((Series(path.name, times=x[::step], values=y[::step]), role))
                break
    if lines:
        title = f"{topic} path in the frame of its start"
        yield PageChart(lines, title, "x [m]", "y [m]", height=260, caption=title)


def _spectrum_chart(title: str, found: list[tuple[Signal, SignalRecording, str]]) -> Iterator[PageChart]:
    lines: list[tuple[Series, str]] = []
    duration = min(side.duration for _, side, _ in found)
    for signal, _, role in found:
        spectrum = None if signal.unit in ("m", "rad", "share", "") else segment_spectra(signal, duration)
        if spectrum is not None:
            frequencies, spectra = spectrum
            density = spectra.mean(axis=0)[1:]
            lines.append((Series(title, times=frequencies[1:], values=density), role))
    if lines and any(np.any(line.values > 0.0) for line, _ in lines):
        name = f"spectrum of {title}"
        yield PageChart(lines, name, "frequency [Hz]", "power density", is_log=True, caption=name)


def _allan_charts(topic: str, sides: _Sides) -> Iterator[PageChart]:
    for vector in VECTORS:
        lines: list[tuple[Series, str]] = []
        unit = ""
        for stream, side, role in sides:
            context = Context(side, side.duration, side.still_intervals())
            for axis in "xyz":
                signal = stream.signals.get(f"{vector}.{axis}")
                statistics = None if signal is None or is_constant(signal) else still_statistics(signal, context)
                if signal is not None and statistics is not None and len(statistics.taus) > 2:
                    unit = signal.unit
                    lines.append((Series(signal.name, times=statistics.taus, values=statistics.allan[0]), role))
        if lines:
            title = f"{topic} Allan deviation of {vector}, three axes"
            yield PageChart(lines, title, "averaging time [s]", f"deviation [{unit}]", is_log=True, caption=title)


def _noise_charts(topic: str, sides: _Sides) -> Iterator[PageChart]:
    """Yield the noise of ranges over the range."""
    names = dict.fromkeys(name for stream, _, _ in sides for name, array in stream.arrays.items() if array.unit == "m")
    for name in names:
        lines: list[tuple[Series, str]] = []
        for stream, side, role in sides:
            if name not in stream.arrays:
                continue
            blocks = list(still_blocks(stream.arrays[name], side.still_intervals()))
            if blocks:
                ranges, deviations = _noise_by_range(blocks)
                lines.append((Series(name, times=ranges, values=deviations), role))
        if any(len(line.times) > 1 for line, _ in lines):
            title = f"{topic} noise of {name} by range, still scene"
            yield PageChart(lines, title, "range [m]", "standard deviation [m]", caption=title)


def _noise_by_range(blocks: list[tuple[Floats, Floats]]) -> tuple[Floats, Floats]:
    means = np.concatenate([mean for mean, _ in blocks])
    variances = np.concatenate([variance for _, variance in blocks])
    edges = np.array(RANGE_EDGES)
    fine = np.unique(np.concatenate([np.linspace(low, high, 5) for low, high in pairwise(edges)]))
    bins = np.digitize(means, fine)
    rows = [(float(means[bins == k].mean()), math.sqrt(float(variances[bins == k].mean()))) for k in np.unique(bins)]
    return np.array([r for r, _ in rows]), np.array([d for _, d in rows])
