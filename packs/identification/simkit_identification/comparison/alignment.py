"""Alignment of two recordings whose clocks began at different times."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, Literal

import numpy as np

from simkit_identification.measures.recording import Floats, Signal, SignalRecording
from simkit_identification.measures.signals import is_constant

Align = Literal["auto", "none", "start", "correlation"]
ALIGNMENTS: Final[tuple[Align, ...]] = ("auto", "none", "start", "correlation")
_GRID: Final = 0.02  # [s]
_LEAST_OVERLAP: Final = 0.4  # share of the shorter recording
_LEAST_CORRELATION: Final = 0.6
_LONGEST: Final = 3600.0  # [s] of a recording that are correlated
_PREFERRED: Final = ("linear.x", "angular.z", "angular_velocity.z")  # speeds: they vary, and do not drift


def alignment_offset(a: SignalRecording, b: SignalRecording, align: Align) -> tuple[float, str]:
    """Return the time to add to b [s], and a sentence about it.

    Args:
        a: recording.
        b: recording to move.
        align: none, start (first messages of the common topics), or correlation (of the signal that fits best); auto
            is correlation, or start without a signal that fits.
    """
    if align == "none":
        return 0.0, ""
    if align != "start":
        best = _best_shift(a, b)
        if best is not None:
            offset, correlation, name = best
            return offset, f"b is moved by {offset:+.3f} s, where {name} correlates best ({correlation:.2f})"
    offset = _start(a, b) - _start(b, a)
    reason = "no signal fits well enough to align by correlation; " if align != "start" else ""
    return offset, f"{reason}b is moved by {offset:+.3f} s, so that both begin at the same time"


def _start(recording: SignalRecording, other: SignalRecording) -> float:
    """Return the time of the first message on a topic of both recordings [s]."""
    starts = [
        float(stream.received[0])
        for topic, stream in recording.streams.items()
        if stream.count and topic in other.streams and other.streams[topic].count
    ]
    return min(starts, default=0.0)


def _best_shift(a: SignalRecording, b: SignalRecording) -> tuple[float, float, str] | None:
    """Return shift [s], correlation and name of the signal that fits best; None if none fits."""
    best: tuple[float, float, str] | None = None
    for name, one, two in _candidates(a, b):
        shift, correlation = best_shift(one, two)
        if correlation >= _LEAST_CORRELATION and (best is None or correlation > best[1]):
            best = shift, correlation, name
    return best


def _candidates(a: SignalRecording, b: SignalRecording) -> Iterator[tuple[str, Signal, Signal]]:
    for topic, stream in a.streams.items():
        other = b.streams.get(topic)
        if other is None:
            continue
        for name, signal in stream.signals.items():
            twin = other.signals.get(name)
            if twin is None or not name.endswith(_PREFERRED) or is_constant(signal) or is_constant(twin):
                continue
            if min(len(signal.values), len(twin.values)) >= 10:
                yield f"{topic}.{name}", signal, twin


def best_shift(a: Signal, b: Signal) -> tuple[float, float]:
    """Return the shift of b [s] with the largest correlation, and this correlation."""
    first, start_a = _on_grid(a)
    second, start_b = _on_grid(b)
    size = 1 << (len(first) + len(second) - 1).bit_length()
    spectra = [np.fft.rfft(x, size) for x in (first, second)]
    squares = [np.fft.rfft(x * x, size) for x in (first, second)]
    ones = [np.fft.rfft(np.ones(len(x)), size) for x in (first, second)]

    def correlate(one: np.ndarray, two: np.ndarray) -> Floats:
        """Return the sums over the overlap for shifts 0, 1, … of the second signal, then for negative shifts."""
        return np.fft.irfft(one * np.conj(two), size)

    count = np.round(correlate(ones[0], ones[1]))
    power = np.sqrt(np.maximum(correlate(squares[0], ones[1]), 0.0) * np.maximum(correlate(ones[0], squares[1]), 0.0))
    usable = (count >= _LEAST_OVERLAP * min(len(first), len(second))) & (power > 1e-12 * float(power.max(initial=0.0)))
    correlation = np.where(usable, correlate(spectra[0], spectra[1]) / np.where(usable, power, 1.0), -1.0)
    # a small overlap fits by chance: the correlation counts less there
    weighted = correlation * np.sqrt(np.clip(count / min(len(first), len(second)), 0.0, 1.0))
    best = int(np.argmax(weighted))
    steps = best if best <= size // 2 else best - size
    fraction = _parabola(weighted[best - 1], weighted[best], weighted[(best + 1) % size])
    return (steps + fraction) * _GRID + start_a - start_b, float(correlation[best])


def _on_grid(signal: Signal) -> tuple[Floats, float]:
    known = np.isfinite(signal.values)
    times, values = signal.times[known], signal.values[known]
    end = min(float(times[-1]), float(times[0]) + _LONGEST)
    grid = np.arange(float(times[0]), end, _GRID)
    series = np.interp(grid, times, values)
    return series - series.mean(), float(times[0])


def _parabola(left: float, middle: float, right: float) -> float:
    """Return the place of the largest value of a parabola through three points, in steps from the middle one."""
    bend = left - 2.0 * middle + right
    return float(np.clip(0.5 * (left - right) / bend, -0.5, 0.5)) if bend < 0.0 else 0.0
