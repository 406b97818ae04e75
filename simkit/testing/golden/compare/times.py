"""When the messages of two streams came: rates, counts, and the first time that is other."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from simkit.testing.golden.compare.difference import Difference, DifferenceKind
from simkit.testing.golden.compare.units import quantity_text, time_text
from simkit.testing.run_record.record import Stream

_REGULAR = 0.02  # part by which intervals may be other at a steady rate: a rate need not divide the step
_EVENTS = 0.02  # part of messages that may be more or fewer on another machine, of topics without a rate

Times = npt.NDArray[np.int64]


def compare_times(golden: Stream, run: Stream, timestep: float, is_exact: bool) -> tuple[int, Difference | None]:
    """How many messages from the first on can be laid side by side, and how times are other.

    Args:
        golden, run: of one topic.
        timestep: of the physics [s]; on another machine an event may be a step off.
        is_exact: whether times must be equal.
    """
    a, b = golden.times_ns, run.times_ns
    both = min(len(a), len(b))
    rates = _rate(a), _rate(b)
    allowed = 0 if is_exact or any(rates) else shift_allowed(timestep)
    apart = np.flatnonzero(np.abs(a[:both] - b[:both]) > allowed)
    same = int(apart[0]) if apart.size else both
    if same == len(a) == len(b):
        return same, None
    if not is_exact and rates[0] is None and abs(len(a) - len(b)) <= max(1.0, _EVENTS * len(a)):
        return same, None
    return same, _first_time_difference(golden, run, same, rates)


def shift_allowed(timestep: float) -> int:
    """By how much an event may come at another time on another machine [ns]: a step."""
    return int(timestep * 1.5e9)


def _first_time_difference(
    golden: Stream, run: Stream, same: int, rates: tuple[float | None, float | None]
) -> Difference:
    a, b, topic = golden.times_ns, run.times_ns, run.topic
    counts = f"{len(a)} messages became {len(b)}" if len(a) != len(b) else f"{len(a)} messages as before"
    if rates[0] and rates[1] and abs(rates[1] / rates[0] - 1.0) > 1e-3:
        words = f"{topic}: {rates[0]:.4g} Hz became {rates[1]:.4g} Hz: {counts}"
        return Difference(
            topic, "", "count", _seconds(b, same, a), abs(rates[1] - rates[0]), "Hz", words, "the same times", same
        )
    if not len(b) or not len(a):
        words = f"{topic}: {'no messages' if not len(b) else f'{len(b)} messages'} instead of {len(a) or 'none'}"
    elif same == len(b):
        words = f"{topic}: ends at {_time_text(b[-1])}: {counts}"
    elif same == len(a):
        words = f"{topic}: goes on after {_time_text(a[-1])}: {counts}"
    elif len(a) == len(b) and np.ptp(b - a) == 0:
        words = f"{topic}: every message comes {_later(int(b[0] - a[0]))}"
        return Difference(
            topic, "", "time", _seconds(b, 0, a), abs(float(b[0] - a[0])) * 1e-9, "s", words, "the same times", 0
        )
    else:
        words = f"{topic}: message {same + 1} comes {_later(int(b[same] - a[same]))} at {_time_text(b[same])}; {counts}"
    kind: DifferenceKind = "count" if len(a) != len(b) else "time"
    size = float(abs(len(b) - len(a))) if kind == "count" else abs(float(b[same] - a[same])) * 1e-9
    unit = "messages" if kind == "count" else "s"
    return Difference(topic, "", kind, _seconds(b, same, a), size, unit, words, "the same times", same)


def _rate(times: Times) -> float | None:
    """Messages per second of a steady topic; None of one that is not."""
    if len(times) < 3:
        return None
    gaps = np.diff(times)[1:]  # the first reading is taken after the first step, which is no multiple of the period
    mean = float(gaps.mean())
    if mean <= 0.0 or float(np.abs(gaps - np.median(gaps)).mean()) > max(_REGULAR * mean, 1e6):
        return None
    rate, error = 1e9 / mean, 2e6 / float(gaps.sum())  # readings come with a step, at most some milliseconds off
    return float(round(rate)) if abs(rate - round(rate)) <= error * rate else rate


def _seconds(times: Times, index: int, others: Times) -> float:
    for known in (times, others):
        if index < len(known):
            return float(known[index]) * 1e-9
    last = [float(known[-1]) for known in (times, others) if len(known)]
    return min(last) * 1e-9 if last else 0.0


def begin_time(stream: Stream) -> float:
    """When the first message came [s]; 0 without one."""
    return float(stream.times_ns[0]) * 1e-9 if len(stream.times_ns) else 0.0


def _time_text(time_ns: np.int64) -> str:
    return time_text(float(time_ns) * 1e-9)


def _later(nanoseconds: int) -> str:
    words = quantity_text(abs(nanoseconds) * 1e-9, "s", signed=False)
    return f"{words} {'later' if nanoseconds > 0 else 'earlier'}"
