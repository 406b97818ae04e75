"""The commands `simkit topic hz`, `bw` and `delay`: measure rate, bandwidth and delay in simulated time.

Where a simulation runs faster or slower than real time, its own clock is the one by which sensors have their rates;
`--wall-time` counts by the clock on the wall.
"""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Collection
from typing import Annotated, Protocol

from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.options import option
from simkit.cli.terminal.output import JsonObject, print_json, print_line, print_note
from simkit.cli.terminal.topic_sources import ReceivedMessage, Source, find_topic, open_source
from simkit.cli.topic_echo import MessageFilter, compile_filter
from simkit.errors import InputError

_PRINT_PERIOD = 1.0  # [s] of wall time between two lines
_DEPTH = 10_000  # messages that wait while a line is printed
Window = Annotated[
    int | None, option("Counts the last N messages.", "N", "--window", "-w", min=1, max=10**9, show_default=False)
]
WallTime = Annotated[bool, Option("--wall-time", help="By the clock on the wall, not the simulation's.")]


class Meter(Protocol):
    """Measures what arrives on a topic."""

    def take(self, seconds: float, received: ReceivedMessage) -> None:
        """Take a message and its time [s]."""

    def found(self) -> JsonObject | None:
        """Return what was measured; None before there is anything."""

    def text(self, found: JsonObject) -> str:
        """Format what was measured as `ros2 topic` does."""


class Rates:
    """Rate of what arrives, over a window of messages; a clock that goes back begins anew.

    Args:
        source: decodes the messages.
        window: how many messages it spans at most.
        wanted: says which messages count; None for all.
    """

    def __init__(self, source: Source, window: int, wanted: MessageFilter | None) -> None:
        self._source, self._wanted = source, wanted
        self._gaps: deque[float] = deque(maxlen=window)
        self._last: float | None = None

    def take(self, seconds: float, received: ReceivedMessage) -> None:
        if self._wanted is not None and not self._wanted(self._source.decode(received)):
            return
        if self._last is not None and seconds < self._last:
            self._gaps.clear()
        elif self._last is not None:
            self._gaps.append(seconds - self._last)
        self._last = seconds

    def found(self) -> JsonObject | None:
        """`rate` [Hz], `min`, `max`, `std_dev` of the gaps [s] and `window`; None before there is a gap."""
        if not self._gaps:
            return None
        mean, spread = _statistics(self._gaps)
        return {"rate": 1.0 / mean if mean > 0.0 else 0.0, **spread}

    def text(self, found: JsonObject) -> str:
        return f"average rate: {found['rate']:.3f}\n\t{_statistics_text(found)}"


def _statistics(seconds: Collection[float]) -> tuple[float, JsonObject]:
    """The mean of some times [s], and their `min`, `max`, `std_dev` [s] and how many they are: `window`."""
    mean = sum(seconds) / len(seconds)
    deviation = math.sqrt(sum((one - mean) ** 2 for one in seconds) / len(seconds))
    return mean, {"min": min(seconds), "max": max(seconds), "std_dev": deviation, "window": len(seconds)}


def _statistics_text(found: JsonObject) -> str:
    ends = f"min: {found['min']:.3f}s max: {found['max']:.3f}s std dev: {found['std_dev']:.5f}s"
    return f"{ends} window: {found['window']}"


_SIZES = ("mean", "min", "max")


class Amounts:
    """Bytes a second, over a window of messages; a clock that goes back begins anew."""

    def __init__(self, window: int) -> None:
        self._sizes: deque[tuple[float, int]] = deque(maxlen=window)

    def take(self, seconds: float, received: ReceivedMessage) -> None:
        if self._sizes and seconds < self._sizes[-1][0]:
            self._sizes.clear()
        self._sizes.append((seconds, len(received.data)))

    def found(self) -> JsonObject | None:
        """`bytes_per_second`, `messages`, `mean`, `min` and `max` size; None before there are two messages."""
        if len(self._sizes) < 2 or self._sizes[-1][0] <= self._sizes[0][0]:
            return None
        sizes = [size for _, size in self._sizes]
        per_second = sum(sizes) / (self._sizes[-1][0] - self._sizes[0][0])
        spread = {"mean": sum(sizes) / len(sizes), "min": min(sizes), "max": max(sizes)}
        return {"bytes_per_second": per_second, "messages": len(sizes), **spread}

    def text(self, found: JsonObject) -> str:
        """All numbers are in the unit that fits the rate."""
        per_second = found["bytes_per_second"]
        unit, size, digits = (
            ("B", 1.0, 0) if per_second < 1e3 else ("KB", 1e3, 2) if per_second < 1e6 else ("MB", 1e6, 2)
        )
        rate, mean, low, high = (f"{n / size:.{digits}f} {unit}" for n in (per_second, *(found[k] for k in _SIZES)))
        return f"{rate}/s from {found['messages']} messages\n\tMessage size mean: {mean} min: {low} max: {high}"


class Delays:
    """How much later than their stamps messages are published, over a window of messages."""

    def __init__(self, source: Source, type_name: str, window: int) -> None:
        self._source, self._type_name = source, type_name
        self._late: deque[float] = deque(maxlen=window)

    def take(self, seconds: float, received: ReceivedMessage) -> None:
        from simkit import msgs

        header = getattr(self._source.decode(received), "header", None)
        if header is None:
            raise InputError(f"SK-CLI-033 {self._type_name} has no header, so no stamp", "SK-CLI-033")
        self._late.append(seconds - msgs.stamp_ns(header.stamp) * 1e-9)

    def found(self) -> JsonObject | None:
        if not self._late:
            return None
        mean, spread = _statistics(self._late)
        return {"delay": mean, **spread}

    def text(self, found: JsonObject) -> str:
        return f"average delay: {found['delay']:.3f}\n\t{_statistics_text(found)}"


def _listen(
    source: Source, topic: str, meter: Meter, *, by_wall: bool = False, duration: float | None, json_: bool
) -> None:
    """Takes what comes and tells of it once a second; of a bag, once at its end."""
    feed = source.feed([topic], _DEPTH)
    begun = told = time.monotonic()
    lost, any_came = 0, False
    while True:
        now = time.monotonic()
        if duration is not None and now - begun >= duration:
            break
        wait = max(0.0, told + _PRINT_PERIOD - now)
        received = feed.take(wait if duration is None else min(wait, begun + duration - now))
        if received is not None:
            any_came = True
            meter.take(time.monotonic() if by_wall else received.time_ns * 1e-9, received)
        if feed.is_over:
            break
        if time.monotonic() - told >= _PRINT_PERIOD:
            told = time.monotonic()
            if any_came and feed.is_live:
                _tell(meter, json_)
                any_came = False
        if feed.lost > lost:
            print_note(f"note: {feed.lost - lost} messages came faster than they could be counted")
            lost = feed.lost
    if any_came or not feed.is_live:
        _tell(meter, json_)


def _tell(meter: Meter, json_: bool) -> None:
    found = meter.found()
    if found is not None:
        if json_:
            print_json(found)
        else:
            print_line(meter.text(found))


def _check_clock(source: Source, by_wall: bool) -> None:
    if by_wall and not source.is_live:
        raise InputError("SK-CLI-018 --wall-time: a bag has the clock of the simulation only", "SK-CLI-018")


Duration = Annotated[float | None, option("Ends after so long (wall time).", "S", "--duration", min=0)]


def hz(
    topic: options.Topic,
    window: Window = None,
    filter_: Annotated[str | None, option("Only those m for which this Python is true.", "EXPR", "--filter")] = None,
    wall_time: WallTime = False,
    duration: Duration = None,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """Prints how often messages come, by the clock of the simulation."""
    wanted = compile_filter(filter_)
    with open_source(sim, bag) as source:
        entry = find_topic(source, topic)
        _check_clock(source, wall_time)
        meter = Rates(source, window or 10_000, wanted)
        _listen(source, entry.name, meter, by_wall=wall_time, duration=duration, json_=json_)


def bw(
    topic: options.Topic,
    window: Window = None,
    wall_time: WallTime = False,
    duration: Duration = None,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """Prints how many bytes a second come, by the clock of the simulation."""
    with open_source(sim, bag) as source:
        entry = find_topic(source, topic)
        _check_clock(source, wall_time)
        if not json_:
            print_line(f"Subscribed to [{entry.name}]")
        _listen(source, entry.name, Amounts(window or 100), by_wall=wall_time, duration=duration, json_=json_)


def delay(
    topic: options.Topic,
    window: Window = None,
    duration: Duration = None,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """Prints how much later than its stamp a message is published, by the clock of the simulation."""
    with open_source(sim, bag) as source:
        entry = find_topic(source, topic)
        meter = Delays(source, entry.types[0], window or 10_000)
        _listen(source, entry.name, meter, duration=duration, json_=json_)
