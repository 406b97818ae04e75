"""Numbers of any message: bias, white noise, spectrum and values that do not change."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit_identification.measures.context import Context
from simkit_identification.measures.measure import Measure
from simkit_identification.measures.recording import Floats, Signal, Stream

_SEGMENT_LENGTHS: Final = (8.0, 4.0, 2.0, 1.0, 0.5)  # [s]
_LEAST_SEGMENTS: Final = 8
_BANDS: Final = ((0.1, 1.0), (1.0, 10.0), (10.0, 100.0), (100.0, 1000.0))  # [Hz]
_LOWEST_PEAK: Final = 1.0  # [Hz], below which motion has its power
_PEAK: Final = 30.0  # power of a peak relative to the median power; noise of eight segments has 4
_PEAK_WIDTH: Final = 3  # bins on each side of a peak that belong to it
_LEAST_QUIET: Final = 100  # values of a still robot for a noise
_TRANSIENT: Final = 30.0  # square of a noise, relative to the median square, that is a shock; normal noise: 3e-4 of all
_POSITIONS: Final = (
    "m",
    "rad",
    "rad or m",
    "°",
    "px",
    "s",
    "ns",
)  # units of signals whose spectrum is that of the motion
_SECOND_DIFFERENCE: Final = 6.0  # variance of the second difference of white noise, relative to the noise


def values(stream: Stream, context: Context) -> Iterator[Measure]:
    """Yield mean, noise and spectrum of each number of the messages."""
    for signal in stream.signals.values():
        if np.count_nonzero(np.isfinite(signal.values)) < 1:
            continue
        relative = start_relative(signal)
        yield Measure(signal.name, signal.unit, "paired", relative, signal.times, signal.is_angle)
        is_derived = " " in signal.name
        if signal.is_setting or is_derived or not stream.is_periodic or len(signal.values) < 20:
            continue
        if not is_constant(signal):
            yield Measure(f"spread of {signal.name}", signal.unit, "spread", relative, signal.times, signal.is_angle)
        noise = without_transients(second_differences(quiet_part(signal, context)) ** 2 / _SECOND_DIFFERENCE)
        yield Measure(f"noise of {signal.name}", signal.unit, "deviation", noise)
        if signal.unit not in _POSITIONS and not is_constant(signal):
            yield from _spectrum(signal, context)


def is_constant(signal: Signal) -> bool:
    """Check whether all values of a signal are equal."""
    finite = signal.values[np.isfinite(signal.values)]
    return bool(len(finite) and np.ptp(finite) == 0.0)


def start_relative(signal: Signal) -> Floats:
    """Return the values of a signal; positions on the earth relative to the first one."""
    if signal.name in ("north", "east"):
        return signal.values - float(signal.values[np.isfinite(signal.values)][0])
    return signal.values


def quiet_part(signal: Signal, context: Context) -> Signal:
    """Return the longest part of a signal in which the robot is still; all if that is unknown or too short."""
    parts = [(signal.times >= start) & (signal.times <= end) for start, end in context.still or ()]
    longest = max(parts, key=np.count_nonzero, default=None)
    if longest is None or np.count_nonzero(longest) < _LEAST_QUIET:
        return signal
    return replace(signal, times=signal.times[longest], values=signal.values[longest])


def second_differences(signal: Signal) -> Floats:
    """Return the second differences of a signal, which has no constant and no steady change any more."""
    series = np.unwrap(signal.values) if signal.is_angle else signal.values
    differences: Floats = np.diff(series, n=2)
    gaps = np.diff(signal.times)
    period = float(np.median(gaps))
    regular = (gaps[1:] < 1.6 * period) & (gaps[:-1] < 1.6 * period)
    return differences[regular & np.isfinite(differences)]


def without_transients(squares: Floats) -> Floats:
    """Return squares of a noise in which a shock, such as the start of a motor, counts no more than a large noise."""
    middle = float(np.median(squares)) if len(squares) else 0.0
    return np.minimum(squares, _TRANSIENT * middle) if middle > 0.0 else squares


def segment_spectra(signal: Signal, duration: float) -> tuple[Floats, Floats] | None:
    """Return the frequencies [Hz] and the power density of each segment of a signal; None if it is too short.

    Segments begin at multiples of their length, have no mean and no trend, and are weighted with Hann's window.
    """
    length = next((t for t in _SEGMENT_LENGTHS if duration / t >= _LEAST_SEGMENTS + 0.5), None)
    known = np.isfinite(signal.values)
    if length is None or np.count_nonzero(known) < 64:
        return None
    times, series = signal.times[known], signal.values[known]
    period = float(np.median(np.diff(times)))
    count = round(length / period) if period > 0.0 else 0
    if count < 8:
        return None
    first = -(-float(times[0]) // length) * length
    segments = int((float(times[-1]) - first + period) / length)
    if segments < 3:
        return None
    grid = first + np.arange(segments * count) * (length / count)
    table = np.interp(grid, times, series).reshape(segments, count)
    across = np.arange(count) - (count - 1) / 2.0
    slopes = (table * across).sum(axis=1) / (across**2).sum()
    table = table - table.mean(axis=1, keepdims=True) - slopes[:, None] * across
    window = np.hanning(count)
    spectra = np.abs(np.fft.rfft(table * window, axis=1)) ** 2 * (2.0 * length / count / (window**2).sum())
    return np.asarray(np.fft.rfftfreq(count, length / count), np.float64), np.asarray(spectra, np.float64)


def _spectrum(signal: Signal, context: Context) -> Iterator[Measure]:
    found = segment_spectra(signal, context.duration)
    if found is None:
        return
    frequencies, spectra = found
    resolution, highest = float(frequencies[1]), float(frequencies[-1])
    for low, high in _BANDS:
        inside = (frequencies >= max(low, 1.5 * resolution)) & (frequencies < high)
        if highest < 2.0 * low or np.count_nonzero(inside) < 2:
            continue
        name = f"{signal.name} from {low:g} to {high:g} Hz"
        yield Measure(name, signal.unit, "power", spectra[:, inside].sum(axis=1) * resolution)
    peak = dominant_peak(frequencies, spectra)
    if peak is not None:
        yield Measure(f"peak of {signal.name}", "Hz", "estimate", np.array([peak, resolution]))


def dominant_peak(frequencies: Floats, spectra: Floats) -> float | None:
    """Return the frequency of the highest peak [Hz]; None if the spectrum has no peak above its noise."""
    inside = frequencies >= _LOWEST_PEAK
    if np.count_nonzero(inside) < 16:
        return None
    mean: npt.NDArray[np.float64] = spectra[:, inside].mean(axis=0)
    at = int(np.argmax(mean))
    away = np.abs(np.arange(len(mean)) - at) > _PEAK_WIDTH
    if at == 0 or mean[at] < _PEAK * float(np.median(mean)) or mean[at] < 2.0 * float(mean[away].max(initial=0.0)):
        return None
    return float(frequencies[inside][at])


FIELD_OF_MEASURE: Final = re.compile(r"^(noise of |peak of |spread of )?(?P<field>.*?)( from .* Hz)?$")
"""Quantity of a measure of this module, with the field that it is about."""
