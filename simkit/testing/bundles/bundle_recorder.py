"""Keep what a bundle needs while a simulation runs: its journal, marks of the state, and the last messages.

Messages are made only once somebody wants them. A bundle is written when that is asked for, or when something fails.
"""

from __future__ import annotations

import hashlib
import math
import struct
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Final, NamedTuple

from simkit import msgs
from simkit.errors import InputError, SimkitError
from simkit.msgs import Message
from simkit.recording.bags.recorder import matches_topic
from simkit.recording.bags.writer import McapBag
from simkit.recording.message_taps import TopicTaps
from simkit.recording.topic_counts import RENDERED
from simkit.run_spec import JsonObject
from simkit.runtime import Simulation
from simkit.runtime.communication.subscription import NO_MESSAGE, LazyMessage
from simkit.runtime.engine.snapshot import state_hash
from simkit.testing.bundles.journal_writer import JournalWriter
from simkit.testing.bundles.manifest import Failure, RunEnd

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


WINDOW_SECONDS: Final = 10.0
"""So much of a run's end is kept, where nothing is said [s]."""
NOT_RECORDED: Final = "SK-BUNDLE-007"


class BundleRecorder:
    """Writes down what comes into a run and keeps its last seconds; a context manager around it.

    Args:
        sim: as `simkit.load` gave it, nothing done yet.
        seconds: how much of the end is kept [s] of simulated time.
        topics: shell patterns of topics that are kept although they are pictures.
        write_failed: writes a bundle when something is raised within the `with`; None for no bundle.

    Attributes:
        sim: the simulation.
        journal: what came in.
        window: the last seconds.
        marks: of the state.
        written: where it was written, once it was.

    Raises:
        InputError: SK-BUNDLE-007 the run has begun already, or was not loaded by `simkit.load`.
    """

    def __init__(
        self,
        sim: Simulation,
        seconds: float = WINDOW_SECONDS,
        topics: Sequence[str] = (),
        write_failed: Callable[[BundleRecorder, Exception], Path] | None = None,
    ) -> None:
        if sim.run_spec is None or sim.engine.steps or sim.communication.bus.inbox:
            why = "has begun already" if sim.run_spec is not None else "was not loaded by simkit.load"
            raise InputError(
                f"{NOT_RECORDED} a bundle begins with the run, and this one {why}; keep it right after load",
                NOT_RECORDED,
            )
        if sim.communication.bus.journal is not None:
            raise InputError(f"{NOT_RECORDED} this run is kept already", NOT_RECORDED)
        self.sim, self.seconds, self.topics, self._write_failed = sim, float(seconds), tuple(topics), write_failed
        self.written: Path | None = None
        self.window = MessageWindow(sim, seconds, topics)
        self.marks = StateHashes(sim)
        self.journal = JournalWriter(sim)
        self._listen()

    def end(self, failure: Failure | None = None) -> RunEnd:
        """How the run stands."""
        sim = self.sim
        return RunEnd(sim.engine.steps, sim.tick, sim.time_ns, state_hash(sim), failure)

    def _listen(self) -> None:
        sim, sources = self.sim, self.journal.sources
        read = self._read = sim.contents.models_reader

        def heard(source: Any, *args: Any, **named: Any) -> Any:
            sources.append(str(source))
            return read(source, *args, **named)

        sim.contents.models_reader = heard
        self.journal.keeper = self
        sim.communication.bus.journal = self.journal

    def close(self) -> None:
        """Keeps nothing more; what was kept stays."""
        self.sim.communication.bus.journal, self.sim.contents.models_reader = None, self._read
        self.window.close()
        self.marks.close()

    def __enter__(self) -> BundleRecorder:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._write_failed is not None and isinstance(error, Exception):
            try:
                self.written = self._write_failed(self, error)
            except (SimkitError, OSError) as problem:  # what went wrong with the run goes on being raised
                error.add_note(f"no bundle was written: {problem}")
            else:
                error.add_note(f"a bundle that repeats this: simkit replay {self.written}")
        self.close()


def recorder_of(sim: Simulation) -> BundleRecorder:
    """Who keeps a simulation.

    Raises:
        InputError: SK-BUNDLE-007 nobody does.
    """
    journal = sim.communication.bus.journal
    keeper = getattr(journal, "keeper", None)
    if not isinstance(keeper, BundleRecorder):
        raise InputError(
            f"{NOT_RECORDED} this run is not kept: call simkit.testing.bundles.keep(sim) right after load", NOT_RECORDED
        )
    return keeper
