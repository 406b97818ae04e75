"""Timing of a topic: rate, jitter, gaps, latency and order of stamps."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from simkit_identification.measures.context import Context
from simkit_identification.measures.measure import Measure
from simkit_identification.measures.recording import Stream

_LARGEST_LATENCY: Final = 3600.0  # [s] beyond which the stamps are those of another clock


def timing(stream: Stream, _: Context) -> Iterator[Measure]:
    """Yield rate, jitter and gaps."""
    if stream.count < 3:
        return
    intervals = np.diff(stream.received)
    yield Measure("rate", "Hz", "rate", intervals)
    if not stream.is_periodic:
        yield Measure("longest gap", "s", "largest", intervals)
        return
    period = stream.period
    missed = np.maximum(0.0, np.round(intervals / period - 1.0))
    in_time = missed == 0.0
    yield Measure("interval deviation", "s", "deviation", (intervals[in_time] - float(intervals[in_time].mean())) ** 2)
    yield Measure("longest gap", "messages", "largest", missed)
    yield Measure("missed share", "share", "mean", _missed_flags(missed))


def _missed_flags(missed: np.ndarray) -> np.ndarray:
    """Return one flag for each message, received (0) or missed (1), in the order of time."""
    total = len(missed) + int(missed.sum())
    if total > 1_000_000:
        return missed / (missed + 1.0)
    flags = np.zeros(total)
    at = 0
    for count in missed.astype(int).tolist():
        flags[at + 1 : at + 1 + count] = 1.0
        at += count + 1
    return flags


def latency(stream: Stream, _: Context) -> Iterator[Measure]:
    """Yield the time from the stamp to the receipt of messages, and the order of the stamps."""
    if stream.count < 3 or not np.isfinite(stream.stamps).all():
        return
    late = stream.received - stream.stamps
    if abs(float(np.median(late))) > _LARGEST_LATENCY:
        stream.notes.append("the stamps are those of another clock; no latency")
        return
    yield Measure("latency", "s", "mean", np.where(np.abs(late) < 1e-9, 0.0, late))
    if np.ptp(late) > 1e-9:
        yield Measure("latency distribution", "s", "distribution", late)
    backward = (np.diff(stream.stamps) <= 0.0).astype(np.float64)
    if backward.any():
        yield Measure("stamps out of order", "share", "mean", backward)
