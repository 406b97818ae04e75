"""Commands `simkit topic hz`, `bw` and `delay`: measure rate, bandwidth and delay in simulated time.

A simulation can run faster or slower than real time, and the rates of its sensors refer to its own clock. `--wall-time`
uses wall time instead.
"""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Collection
from typing import Annotated, Protocol

from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.output import JsonObject, print_json, print_line, print_note
from simkit.cli.terminal.topic_sources import ReceivedMessage, Source, open_source
from simkit.errors import InputError
from simkit.extend import counted, option
from simkit.float_sum import float_sum
from simkit_terminal.cli.terminal.named_endpoints import find_topic
from simkit_terminal.cli.terminal.topic_echo import MessageFilter, compile_filter

_PRINT_PERIOD = 1.0  # [s] of wall time between two lines
_DEPTH = 10_000  # queued messages while a line is printed
Window = Annotated[
    int | None, option("Messages to average over.", "N", "--window", "-w", min=1, max=10**9, show_default=False)
]
WallTime = Annotated[bool, Option("--wall-time", help="Use wall time instead of simulated time.")]


class Meter(Protocol):
    """Protocol of a measurement on a topic."""

    def take(self, seconds: float, received: ReceivedMessage) -> None:
        """Add a message and its time [s] to the measurement."""

    def found(self) -> JsonObject | None:
        """Return the measured values; None if there are not enough messages."""

    def text(self, statistics: JsonObject) -> str:
        """Format the measured values as `ros2 topic` does."""


class Rates:
    """Rate of messages, over a window. A clock that goes back restarts the measurement.

    Args:
        source: decoder of the messages.
        window: highest number of messages in the window.
        message_filter: condition on the messages to count; None for all.
    """

    def __init__(self, source: Source, window: int, message_filter: MessageFilter | None) -> None:
        self._source, self._filter = source, message_filter
        self._gaps: deque[float] = deque(maxlen=window)
        self._last: float | None = None

    def take(self, seconds: float, received: ReceivedMessage) -> None:
        if self._filter is not None and not self._filter(self._source.decode(received)):
            return
        if self._last is not None and seconds < self._last:
            self._gaps.clear()
        elif self._last is not None:
            self._gaps.append(seconds - self._last)
        self._last = seconds

    def found(self) -> JsonObject | None:
        """Return `rate` [Hz], `min`, `max` and `std_dev` of the gaps [s] and `window`; None before the first gap."""
        if not self._gaps:
            return None
        mean, spread = _statistics(self._gaps)
        return {"rate": 1.0 / mean if mean > 0.0 else 0.0, **spread}

    def text(self, statistics: JsonObject) -> str:
        return f"average rate: {statistics['rate']:.3f}\n\t{_statistics_text(statistics)}"


def _statistics(seconds: Collection[float]) -> tuple[float, JsonObject]:
    """Return the mean of times [s], and their `min`, `max`, `std_dev` [s] and number (`window`)."""
    mean = float_sum(seconds) / len(seconds)
    deviation = math.sqrt(float_sum((value - mean) ** 2 for value in seconds) / len(seconds))
    return mean, {"min": min(seconds), "max": max(seconds), "std_dev": deviation, "window": len(seconds)}


def _statistics_text(statistics: JsonObject) -> str:
    ends = f"min: {statistics['min']:.3f}s max: {statistics['max']:.3f}s std dev: {statistics['std_dev']:.5f}s"
    return f"{ends} window: {statistics['window']}"


_SIZES = ("mean", "min", "max")


class Bandwidth:
    """Bytes per second, over a window of messages. A clock that goes back restarts the measurement."""

    def __init__(self, window: int) -> None:
        self._sizes: deque[tuple[float, int]] = deque(maxlen=window)

    def take(self, seconds: float, received: ReceivedMessage) -> None:
        if self._sizes and seconds < self._sizes[-1][0]:
            self._sizes.clear()
        self._sizes.append((seconds, len(received.data)))

    def found(self) -> JsonObject | None:
        """Return `bytes_per_second`, `messages`, and `mean`, `min` and `max` size; None before the second message."""
        if len(self._sizes) < 2 or self._sizes[-1][0] <= self._sizes[0][0]:
            return None
        sizes = [size for _, size in self._sizes]
        per_second = sum(sizes) / (self._sizes[-1][0] - self._sizes[0][0])
        spread = {"mean": sum(sizes) / len(sizes), "min": min(sizes), "max": max(sizes)}
        return {"bytes_per_second": per_second, "messages": len(sizes), **spread}

    def text(self, statistics: JsonObject) -> str:
        """Format the measured values, all in the unit that fits the rate."""
        per_second = statistics["bytes_per_second"]
        unit, size, digits = (
            ("B", 1.0, 0) if per_second < 1e3 else ("KB", 1e3, 2) if per_second < 1e6 else ("MB", 1e6, 2)
        )
        rate, mean, low, high = (
            f"{n / size:.{digits}f} {unit}" for n in (per_second, *(statistics[k] for k in _SIZES))
        )
        messages = counted(statistics["messages"], "message")
        return f"{rate}/s from {messages}\n\tMessage size mean: {mean} min: {low} max: {high}"


class Delays:
    """Delay of messages after their stamps, over a window."""

    def __init__(self, source: Source, type_name: str, window: int) -> None:
        self._source, self._type_name = source, type_name
        self._late: deque[float] = deque(maxlen=window)

    def take(self, seconds: float, received: ReceivedMessage) -> None:
        from simkit import msgs

        header = getattr(self._source.decode(received), "header", None)
        if header is None:
            raise InputError("SK-CLI-033", f"{self._type_name} has no header and thus no stamp")
        self._late.append(seconds - msgs.stamp_ns(header.stamp) * 1e-9)

    def found(self) -> JsonObject | None:
        if not self._late:
            return None
        mean, spread = _statistics(self._late)
        return {"delay": mean, **spread}

    def text(self, statistics: JsonObject) -> str:
        return f"average delay: {statistics['delay']:.3f}\n\t{_statistics_text(statistics)}"


def _measure(
    source: Source, topic: str, meter: Meter, *, by_wall: bool = False, duration: float | None, json_: bool
) -> None:
    """Add messages to a meter and print its values once a second; for a bag, once at its end."""
    feed = source.feed([topic], _DEPTH)
    begun = printed = time.monotonic()
    lost, any_came = 0, False
    while True:
        now = time.monotonic()
        if duration is not None and now - begun >= duration:
            break
        wait = max(0.0, printed + _PRINT_PERIOD - now)
        received = feed.take(wait if duration is None else min(wait, begun + duration - now))
        if received is not None:
            any_came = True
            meter.take(time.monotonic() if by_wall else received.time_ns * 1e-9, received)
        if feed.is_over:
            break
        if time.monotonic() - printed >= _PRINT_PERIOD:
            printed = time.monotonic()
            if any_came and feed.is_live:
                _print_values(meter, json_)
                any_came = False
        if feed.lost > lost:
            print_note(
                f"note: {counted(feed.lost - lost, 'message')} dropped: they arrived faster than they were counted"
            )
            lost = feed.lost
    if any_came or not feed.is_live:
        _print_values(meter, json_)


def _print_values(meter: Meter, json_: bool) -> None:
    statistics = meter.found()
    if statistics is not None:
        if json_:
            print_json(statistics)
        else:
            print_line(meter.text(statistics))


def _check_clock(source: Source, by_wall: bool) -> None:
    if by_wall and not source.is_live:
        raise InputError("SK-CLI-018", "--wall-time cannot be used with a bag, which has only simulated time")


Duration = Annotated[float | None, option("Wall time to measure.", "S", "--duration", min=0)]


def hz(
    topic: options.Topic,
    window: Window = None,
    filter_: Annotated[str | None, option("Python condition on the message m.", "EXPR", "--filter")] = None,
    wall_time: WallTime = False,
    duration: Duration = None,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """Print the rate of a topic in simulated time."""
    message_filter = compile_filter(filter_)
    with open_source(sim, bag) as source:
        entry = find_topic(source, topic)
        _check_clock(source, wall_time)
        meter = Rates(source, window or 10_000, message_filter)
        _measure(source, entry.name, meter, by_wall=wall_time, duration=duration, json_=json_)


def bw(
    topic: options.Topic,
    window: Window = None,
    wall_time: WallTime = False,
    duration: Duration = None,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """Print the bandwidth of a topic in simulated time."""
    with open_source(sim, bag) as source:
        entry = find_topic(source, topic)
        _check_clock(source, wall_time)
        if not json_:
            print_line(f"Subscribed to [{entry.name}]")
        _measure(source, entry.name, Bandwidth(window or 100), by_wall=wall_time, duration=duration, json_=json_)


def delay(
    topic: options.Topic,
    window: Window = None,
    duration: Duration = None,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """Print the delay of messages after their stamps, in simulated time."""
    with open_source(sim, bag) as source:
        entry = find_topic(source, topic)
        meter = Delays(source, entry.types[0], window or 10_000)
        _measure(source, entry.name, meter, duration=duration, json_=json_)
