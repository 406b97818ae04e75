"""The last seconds of a run: every message but pictures, made only once somebody wants them; and marks of the state."""

from __future__ import annotations

import hashlib
import math
import struct
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from simkit import msgs
from simkit.msgs import Message
from simkit.recording.bags.recorder import matches_topic
from simkit.recording.bags.writer import McapBag
from simkit.recording.message_taps import TopicTaps
from simkit.recording.topic_counts import RENDERED
from simkit.run_spec import JsonObject
from simkit.runtime.communication.topic_bus import NO_MESSAGE, LazyMessage
from simkit.runtime.engine.snapshot import state_hash

if TYPE_CHECKING:
    from simkit.runtime import Simulation

MAX_WINDOW_BYTES: Final = 256 << 20
_ASSUMED_MESSAGE_BYTES: Final = 3000  # bytes that a message is taken for which is not packed yet
_TIME: Final = struct.Struct("<q")


class WindowMessage(NamedTuple):
    """One message of the last seconds."""

    time_ns: int
    topic: str
    type_name: str
    data: bytes


class MessageWindow:
    """Keeps the last messages of all topics.

    They are kept as they are, and packed when they are asked for: nearly all go before anybody asks. A publisher that
    sends one object again and again has its messages packed at once.

    Args:
        sim: the simulation.
        seconds: how long messages are kept [s] of simulated time; infinite for all of them.
        topics: shell patterns of topics that are kept although they are pictures, or aside.
        most: bytes that are kept; of more, the oldest go.

    Attributes:
        first: everything since so many steps is there.
    """

    def __init__(
        self, sim: Simulation, seconds: float, topics: Sequence[str] = (), most: int = MAX_WINDOW_BYTES
    ) -> None:
        self._sim, self._patterns, self._most = sim, tuple(topics), most
        self._length = sim.engine.clock.ticks(seconds) if math.isfinite(seconds) else 1 << 62
        self._kept: deque[tuple[int, int, str, Any]] = deque()  # steps, tick, topic, message or type and CDR
        self._packed = 0  # bytes
        self._cut = 0
        self._taps = TopicTaps(sim, self._receiver_of)
        self._taps.open()

    @property
    def first(self) -> int:
        since: int = self._sim.engine.steps - self._length
        return max(0, self._cut, since)

    def close(self) -> None:
        """Hears no more."""
        self._taps.close()

    def messages(self, first: int | None = None) -> Iterator[WindowMessage]:
        """What was heard since so many steps, in its order; what cannot be made any more is left out.

        Args:
            first: steps; those of `first` where None.
        """
        since = self.first if first is None else first
        clock = self._sim.engine.clock
        for steps, tick, topic, content in tuple(self._kept):
            if steps < since:
                continue
            message = content.get() if type(content) is LazyMessage else content
            if message is NO_MESSAGE:
                continue
            packed = message if type(message) is tuple else (msgs.type_name(message), msgs.serialize(message))
            yield WindowMessage(clock.time_ns(tick), topic, *packed)

    def _receiver_of(self, topic: str, type_name: str) -> Callable[[Message], None] | None:
        if not self._is_kept(topic, type_name):
            return None
        sim, kept, length, most = self._sim, self._kept, self._length, self._most // _ASSUMED_MESSAGE_BYTES
        last: Message = None
        is_packed = False

        def hear(message: object) -> None:
            nonlocal last, is_packed
            steps = sim.engine.steps
            if message is last:
                is_packed = True
            last = message
            if is_packed and type(message) is not LazyMessage:
                message = msgs.type_name(message), msgs.serialize(message)
                self._packed += len(message[1])
            kept.append((steps, sim.tick, topic, message))
            while kept[0][0] < steps - length:
                self._drop()
            if len(kept) > most or self._packed > self._most:
                self._cut = self._drop() + 1

        return hear

    def _drop(self) -> int:
        """Lets go of the oldest message; gives the steps that it came after."""
        steps, _, _, content = self._kept.popleft()
        if type(content) is tuple:
            self._packed -= len(content[1])
        return steps

    def _is_kept(self, topic: str, type_name: str) -> bool:
        if matches_topic(topic, self._patterns):
            return True
        return topic not in self._sim.communication.bus.aside and type_name not in RENDERED


class StateHashes:
    """A hash of the state after every simulated second, with the steps made by then."""

    def __init__(self, sim: Simulation) -> None:
        self.found: list[tuple[int, str]] = []
        self._is_on = True

        def mark(_: int) -> None:
            self.found.append((sim.engine.steps, state_hash(sim)[:16]))

        sim.communication.on_demand.add(lambda: self._is_on, 1.0, mark, "after")
        self._sim = sim

    def close(self) -> None:
        """Makes no more."""
        self._is_on = False
        self._sim.communication.on_demand.look()


def topic_digests(messages: Iterator[WindowMessage]) -> dict[str, JsonObject]:
    """Topic -> type, how many messages, and SHA-256 of their times and bytes."""
    found: dict[str, tuple[str, int, hashlib._Hash]] = {}
    for one in messages:
        type_name, count, digest = found.get(one.topic) or (one.type_name, 0, hashlib.sha256())
        digest.update(_TIME.pack(one.time_ns))
        digest.update(one.data)
        found[one.topic] = type_name, count + 1, digest
    return {
        topic: {"type": type_name, "count": count, "sha256": digest.hexdigest()}
        for topic, (type_name, count, digest) in sorted(found.items())
    }


def write_bag(path: Path, messages: Iterator[WindowMessage], latched: frozenset[str]) -> None:
    """Writes messages to one MCAP file."""

    bag = McapBag(path)
    try:
        for one in messages:
            channel = bag.channel(one.topic, one.type_name, one.topic in latched)
            bag.write_raw(channel, one.data, one.time_ns)
    finally:
        bag.close()
