"""Topics with their rates, log messages and parameters, for the panels of the page."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.bridges.live.introspection import parameter_list, topic_list
from simkit.errors import MessageError
from simkit.recording.message_taps import is_available
from simkit.recording.topic_counts import RENDERED
from simkit.run_spec import JsonObject
from simkit.runtime.communication.publisher import KEPT_LOG_MESSAGES, ROSOUT
from simkit_view.view.packet import Stream, make_packet
from simkit_view.view.series_stream import TRUTH, field_paths

if TYPE_CHECKING:
    from simkit import Simulation, Subscription
    from simkit.msgs import Message

_SLOW: Final = 1.0  # [s] of wall time between two looks at lists
_QUICK: Final = 0.2  # [s] of wall time between two packets about messages
_MOST_ENTRIES: Final = 300  # log messages of one answer
_LONGEST_LINE: Final = 4000  # characters of a log message
_SILENT_AFTER: Final = 3  # periods without a message after which a topic has no rate
_SECOND: Final = 2
_ENOUGH: Final = 22  # messages of one measurement of a rate
_BETWEEN: Final = 5.0  # [s] of wall time between two measurements of a rate


class ChangeStream:
    """Stream whose packet is sent when its content has changed.

    Args:
        kind: name of the stream.
        period: least wall time between two looks [s].
        content: function that returns the head of the packet.
    """

    def __init__(self, kind: str, period: float, content: Callable[[], JsonObject]) -> None:
        self._kind, self._period, self._content = kind, period, content
        self._due, self._sent = 0.0, b""

    def packet(self, options: Sequence[object]) -> bytes | None:
        now = time.perf_counter()
        if now < self._due:
            return None
        self._due = now + self._period
        packet = make_packet({"kind": self._kind, **self._content()}, {})
        if packet == self._sent:
            return None
        self._sent = packet
        return packet

    def close(self) -> None:
        """Nothing is open."""


def topics_stream(sim: Simulation, _: str) -> ChangeStream:
    """Return the stream of all topics, with the numbers of their types, and of the models with true values."""
    store, paths = msgs.type_store(), dict[str, list[str]]()

    def paths_of(type_name: str) -> list[str]:
        if type_name not in paths:
            try:
                paths[type_name] = field_paths(msgs.full_name(type_name), store)
            except MessageError:
                paths[type_name] = []
        return paths[type_name]

    def content() -> JsonObject:
        rows = [
            {
                "name": row["name"],
                "type": row["types"][0] if row["types"] else "",
                "publishers": sorted({end["node"] for end in row["publishers"]}),
                "subscribers": sorted({end["node"] for end in row["subscribers"]}),
            }
            for row in topic_list(sim, ())
        ]
        types = {row["type"]: paths_of(row["type"]) for row in rows if row["type"]}
        models = [name for name, model in sim.models.items() if not model.static]
        return {"topics": rows, "types": types, "models": models, "truth": TRUTH}

    return ChangeStream("topics", _SLOW, content)


@dataclass
class _Count:
    """Messages of a topic since its tap was opened.

    Attributes:
        tap: subscription; None between two measurements.
        due: wall time of the next measurement [s].
        count: number of messages.
        since, second, last: simulated time of the tap, of its second and of its newest message [ns].
        rate: rate of the last complete measurement [Hz].
    """

    tap: Subscription | None = None
    due: float = 0.0
    count: int = 0
    since: int = 0
    second: int = 0
    last: int = 0
    rate: float | None = None

    def take(self, now: int) -> None:
        """Count a message."""
        if now < self.last:
            self.count, self.since = 0, now  # after a reset
        self.count += 1
        self.last = now
        if self.count == _SECOND:
            self.second = now  # the time from the first to the second message may differ from the period

    def measured(self, now: int) -> float | None:
        """Return the rate [Hz]; None before the third message, and for a topic that has become silent."""
        if self.tap is not None and self.count > _SECOND and self.last > self.second:
            self.rate = (self.count - _SECOND) * 1e9 / (self.last - self.second)
        newest = max(self.since, self.last)
        if self.tap is not None and self.rate is not None and now - newest > _SILENT_AFTER * 1e9 / self.rate + 1e9:
            self.rate = None
        return self.rate


class RateStream:
    """Rates of the topics in simulated time [Hz]; `rates`. Topics whose messages are rendered are not counted.

    A topic is received until it has sent some messages, and again some seconds later: a subscription to each topic all
    the time costs a robot such as TIAGo a tenth of a core.
    """

    def __init__(self, sim: Simulation, _: str) -> None:
        self._sim, self._counts = sim, dict[str, _Count]()
        self._stream = ChangeStream("rates", _SLOW, self._content)

    def packet(self, options: Sequence[object]) -> bytes | None:
        now = time.perf_counter()
        for topic, counter in self._counts.items():
            if counter.tap is not None and counter.count >= _ENOUGH:
                counter.measured(self._sim.time_ns)
                counter.tap.close()
                counter.tap, counter.due = None, now + _BETWEEN
            elif counter.tap is None and now >= counter.due:
                self._open(topic, counter)
        return self._stream.packet(options)

    def _open(self, topic: str, counter: _Count) -> None:
        sim = self._sim
        counter.count, counter.since, counter.second, counter.last = 0, sim.time_ns, 0, 0
        counter.tap = sim.communication.bus.tap(topic, lambda _: counter.take(sim.time_ns), takes_later=True)

    def _content(self) -> JsonObject:
        sim, bus = self._sim, self._sim.communication.bus
        topics = bus.topics()
        for topic in [topic for topic in self._counts if topic not in topics]:
            self._close(self._counts.pop(topic))
        for topic, type_name in topics.items():
            is_counted = type_name not in RENDERED and topic not in self._counts
            if is_counted and (topic not in bus.aside or bus.wanted(topic)) and is_available(sim, topic):
                self._counts[topic] = _Count()
                self._open(topic, self._counts[topic])
        rates = ((topic, counter.measured(sim.time_ns)) for topic, counter in self._counts.items())
        return {"rates": {topic: round(rate, 3) for topic, rate in rates if rate is not None}}

    def _close(self, counter: _Count) -> None:
        if counter.tap is not None:
            counter.tap.close()

    def close(self) -> None:
        for counter in self._counts.values():
            self._close(counter)


def parameters_stream(sim: Simulation, _: str) -> ChangeStream:
    """Return the stream of the parameters of all nodes."""
    return ChangeStream("parameters", 0.5, lambda: {"nodes": parameter_list(sim)})


class LogEntries:
    """Newest log messages, each with its number.

    Attributes:
        newest: messages for the page.
    """

    def __init__(self) -> None:
        self.newest = deque[JsonObject](maxlen=KEPT_LOG_MESSAGES)

    def entries(self, after: int) -> list[JsonObject]:
        """Return the oldest kept messages after a number."""
        return [entry for entry in self.newest if entry["number"] > after][:_MOST_ENTRIES]


class LogStream(LogEntries):
    """Number of the newest message of `/rosout`; `log`. A page asks for the messages with the request `log`."""

    def __init__(self, sim: Simulation, _: str) -> None:
        super().__init__()
        self._count, self._source = 0, time.monotonic_ns()
        self._stream = ChangeStream("log", _QUICK, lambda: {"last": self._count, "source": self._source})
        self.packet = self._stream.packet
        self._tap = sim.communication.bus.tap(ROSOUT, self._take)

    def _take(self, message: Message) -> None:
        self._count += 1
        self.newest.append(log_entry(message) | {"number": self._count})

    def close(self) -> None:
        self._tap.close()


def log_entry(message: Message) -> JsonObject:
    """Return a message of `/rosout` for the page."""
    place = f"{message.file}:{message.line}" if message.file and message.line else str(message.file)
    return {
        "time": float(msgs.stamp_ns(message.stamp) * 1e-9),
        "level": int(message.level),
        "node": str(message.name),
        "text": str(message.msg)[:_LONGEST_LINE],
        "place": place,
    }


TOPIC_STREAMS: Final[dict[str, Callable[[Simulation, str], Stream]]] = {
    "topics": topics_stream,
    "rates": RateStream,
    "parameters": parameters_stream,
    "log": LogStream,
}
"""Streams of topics, log messages and parameters."""
