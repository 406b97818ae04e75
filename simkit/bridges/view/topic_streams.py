"""Topics with their rates, log messages and parameters, for the panels of the page."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Final

from simkit import msgs
from simkit.bridges.live.introspection import parameter_list, topic_list
from simkit.bridges.view.packet import Head, make_packet
from simkit.bridges.view.series_stream import TRUTH, field_paths
from simkit.errors import MessageError
from simkit.recording.topic_counts import RENDERED, TopicCounter
from simkit.runtime.communication.publisher import KEPT_LOG_MESSAGES, ROSOUT

if TYPE_CHECKING:
    from simkit.msgs.message_types import Message
    from simkit.runtime import Simulation

_SLOW: Final = 1.0  # [s] of wall time between two looks at lists
_QUICK: Final = 0.2  # [s] of wall time between two packets about messages
_MOST_ENTRIES: Final = 300  # log messages of one answer
_LONGEST_LINE: Final = 4000  # characters of a log message
_SILENT_AFTER: Final = 3  # periods without a message after which a topic has no rate


class ChangeStream:
    """Stream whose packet is sent when its content has changed.

    Args:
        kind: name of the stream.
        period: least wall time between two looks [s].
        content: function that returns the head of the packet.
    """

    def __init__(self, kind: str, period: float, content: Callable[[], Head]) -> None:
        self._kind, self._period, self._content = kind, period, content
        self._due, self._sent = 0.0, b""

    def packet(self, options: Sequence[Any]) -> bytes | None:
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

    def content() -> Head:
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


class RateStream:
    """Rates of the topics in simulated time [Hz]; `rates`. Topics whose messages are rendered are not counted."""

    def __init__(self, sim: Simulation, _: str) -> None:
        self._sim, self._counter = sim, TopicCounter(sim, RENDERED)
        self._stream = ChangeStream("rates", _SLOW, self._content)
        self.packet, self._close = self._stream.packet, self._counter.close

    def _content(self) -> Head:
        now, found = self._sim.time_ns, {}
        for row in self._counter.rows:
            rate = row.rate()
            if rate is not None and now - row.last < _SILENT_AFTER * 1e9 / rate + 1e9:
                found[row.topic] = round(rate, 3)
        return {"rates": found}

    def close(self) -> None:
        self._close()


def parameters_stream(sim: Simulation, _: str) -> ChangeStream:
    """Return the stream of the parameters of all nodes."""
    return ChangeStream("parameters", 0.5, lambda: {"nodes": parameter_list(sim)})


class LogEntries:
    """Newest log messages, each with its number.

    Attributes:
        kept: messages for the page.
    """

    def __init__(self) -> None:
        self.kept = deque[dict[str, Any]](maxlen=KEPT_LOG_MESSAGES)

    def entries(self, after: int) -> list[dict[str, Any]]:
        """Return the oldest kept messages after a number."""
        return [entry for entry in self.kept if entry["number"] > after][:_MOST_ENTRIES]


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
        self.kept.append(log_entry(message) | {"number": self._count})

    def close(self) -> None:
        self._tap.close()


def log_entry(message: Message) -> dict[str, Any]:
    """Return a message of `/rosout` for the page."""
    place = f"{message.file}:{message.line}" if message.file and message.line else str(message.file)
    return {
        "time": float(msgs.stamp_ns(message.stamp) * 1e-9),
        "level": int(message.level),
        "node": str(message.name),
        "text": str(message.msg)[:_LONGEST_LINE],
        "place": place,
    }


TOPIC_STREAMS: Final[dict[str, Callable[[Any, str], Any]]] = {
    "topics": topics_stream,
    "rates": RateStream,
    "parameters": parameters_stream,
    "log": LogStream,
}
"""Streams of topics, log messages and parameters."""
