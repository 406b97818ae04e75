"""Recorder of everything that a bundle needs: the journal, state hashes and the last messages.

Messages are serialised only when a bundle is written, on request or after a failure.
"""

from __future__ import annotations

import hashlib
import math
import struct
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import TracebackType
from typing import Final, NamedTuple

from simkit import RunSpec, Simulation, msgs
from simkit.errors import InputError, SimkitError
from simkit.extend import SceneModel
from simkit.msgs import Message
from simkit.recording.bags.bag_contents import matches_topic
from simkit.recording.bags.writer import McapBag
from simkit.recording.message_taps import TopicTaps, is_available
from simkit.recording.topic_counts import RENDERED
from simkit.run_spec import JsonObject
from simkit.runtime.communication.subscription import NO_MESSAGE, LazyMessage
from simkit.runtime.engine.snapshot import state_hash
from simkit_verification.testing.bundles.journal_writer import JournalWriter
from simkit_verification.testing.bundles.manifest import Failure, RunEnd, packed_fields

MAX_WINDOW_BYTES: Final = 256 << 20
_ASSUMED_MESSAGE_BYTES: Final = 3000  # assumed size of a message that is not serialised yet
_TIME: Final = struct.Struct("<q")


class WindowMessage(NamedTuple):
    """Serialised message from the last seconds of a run."""

    time_ns: int
    topic: str
    type_name: str
    data: bytes


class MessageWindow:
    """Buffer of the last messages of all topics.

    Messages are stored as objects and serialised on demand, because most of them are dropped before a bundle is
    written. A publisher that sends the same object repeatedly may change it, so its messages are serialised at once.

    Args:
        sim: Simulation.
        seconds: Length of the window [s] of simulated time; infinite for the whole run.
        topics: Shell patterns of image topics and internal topics to include.
        skip: Shell patterns of topics to leave out.
        most: Maximum size [bytes]; the oldest messages are dropped when the window is larger.

    Attributes:
        first: Number of steps after which no message is missing in the window.
    """

    def __init__(
        self,
        sim: Simulation,
        seconds: float,
        topics: Sequence[str] = (),
        skip: Sequence[str] = (),
        most: int = MAX_WINDOW_BYTES,
    ) -> None:
        self._sim, self._patterns, self._skip, self._most = sim, tuple(topics), tuple(skip), most
        self._length = sim.engine.clock.ticks(seconds) if math.isfinite(seconds) else 1 << 62
        self._kept: deque[tuple[int, int, str, Message]] = deque()  # steps, tick, topic, message or (type, CDR)
        self._packed = 0  # bytes
        self._cut = 0
        self._taps = TopicTaps(sim, self._receiver_of)
        self._taps.open()

    @property
    def first(self) -> int:
        since: int = self._sim.engine.steps - self._length
        return max(0, self._cut, since)

    def close(self) -> None:
        """Stop receiving messages."""
        self._taps.close()

    def messages(self, first: int | None = None) -> Iterator[WindowMessage]:
        """Iterate over the received messages in order; skip lazy messages that can no longer be created.

        Args:
            first: Number of steps at which the iteration begins; None for the property `first`.
        """
        since = self.first if first is None else first
        clock = self._sim.engine.clock
        for steps, tick, topic, content in tuple(self._kept):
            if steps < since:
                continue
            message = content.get() if isinstance(content, LazyMessage) else content
            if message is NO_MESSAGE:
                continue
            packed = message if type(message) is tuple else (msgs.type_name(message), msgs.serialize(message))
            yield WindowMessage(clock.time_ns(tick), topic, *packed)

    def _receiver_of(self, topic: str, type_name: str) -> Callable[[Message], None] | None:
        if not self._is_kept(topic, type_name):
            return None
        sim, buffer, length, most = self._sim, self._kept, self._length, self._most // _ASSUMED_MESSAGE_BYTES
        last: Message = None
        is_packed = False

        def receive(message: object) -> None:
            nonlocal last, is_packed
            steps = sim.engine.steps
            if message is last:
                is_packed = True
            last = message
            if is_packed and not isinstance(message, LazyMessage):
                message = msgs.type_name(message), msgs.serialize(message)
                self._packed += len(message[1])
            buffer.append((steps, sim.tick, topic, message))
            while buffer[0][0] < steps - length:
                self._drop()
            if len(buffer) > most or self._packed > self._most:
                self._cut = self._drop() + 1

        return receive

    def _drop(self) -> int:
        """Drop the oldest message and return the number of steps at which it was received."""
        steps, _, _, content = self._kept.popleft()
        if type(content) is tuple:
            self._packed -= len(content[1])
        return steps

    def _is_kept(self, topic: str, type_name: str) -> bool:
        if self._skip and matches_topic(topic, self._skip):
            return False
        if matches_topic(topic, self._patterns):
            return True
        if topic in self._sim.communication.bus.aside or type_name in RENDERED:
            return False
        return is_available(self._sim, topic)


class StateHashes:
    """Hash of the physics state after every simulated second, with the number of steps."""

    def __init__(self, sim: Simulation) -> None:
        self.found: list[tuple[int, str]] = []
        self._is_on = True

        def mark(_: int) -> None:
            self.found.append((sim.engine.steps, state_hash(sim)[:16]))

        sim.communication.on_demand.add(lambda: self._is_on, 1.0, mark, "after")
        self._sim = sim

    def close(self) -> None:
        """Stop computing hashes."""
        self._is_on = False
        self._sim.communication.on_demand.look()


def topic_digests(messages: Iterator[WindowMessage]) -> dict[str, JsonObject]:
    """Summarise messages by topic: type, count and SHA-256 of the times and bytes."""
    digests: dict[str, _TopicDigest] = {}
    for message in messages:
        if message.topic not in digests:
            digests[message.topic] = _TopicDigest(message.type_name)
        digests[message.topic].add(message)
    return {topic: digest.summary() for topic, digest in sorted(digests.items())}


class _TopicDigest:
    """Count and SHA-256 of the messages of one topic."""

    def __init__(self, type_name: str) -> None:
        self._type_name, self._count, self._digest = type_name, 0, hashlib.sha256()

    def add(self, message: WindowMessage) -> None:
        self._count += 1
        self._digest.update(_TIME.pack(message.time_ns))
        self._digest.update(message.data)

    def summary(self) -> JsonObject:
        return {"type": self._type_name, "count": self._count, "sha256": self._digest.hexdigest()}


def write_bag(path: Path, messages: Iterator[WindowMessage], latched: frozenset[str]) -> None:
    """Write messages to one MCAP file.

    Args:
        path: File to write.
        messages: Messages in order.
        latched: Topics whose last message is sent to subscribers that join later.
    """
    bag = McapBag(path)
    try:
        for message in messages:
            channel = bag.channel(message.topic, message.type_name, message.topic in latched)
            bag.write_raw(channel, message.data, message.time_ns)
    finally:
        bag.close()


WINDOW_SECONDS: Final = 10.0
"""Default length of the message window at the end of a run [s]."""
NOT_RECORDED: Final = "SK-BUNDLE-007"


class BundleRecorder:
    """Recorder of a run's inputs and last seconds; a context manager around the run.

    Args:
        sim: Simulation that was just loaded by `simkit.load` and has made no step.
        seconds: Length of the message window [s] of simulated time.
        topics: Shell patterns of image topics to include.
        run: Specification of the run, for the fields that are no arguments of `simkit.load`; None for none.
        write_failed: Function that writes a bundle when an exception leaves the `with` block; None for no bundle.

    Attributes:
        sim: Simulation.
        run: Specification of the run.
        journal: Recorded inputs.
        window: Messages of the last seconds of the run.
        marks: State hash of every simulated second.
        written: Path of the bundle that was written after a failure; None before.

    Raises:
        InputError: SK-BUNDLE-007 the run has already begun, is already recorded, or was not loaded by `simkit.load`.
    """

    def __init__(
        self,
        sim: Simulation,
        seconds: float = WINDOW_SECONDS,
        topics: Sequence[str] = (),
        run: RunSpec | None = None,
        write_failed: Callable[[BundleRecorder, Exception], Path] | None = None,
    ) -> None:
        if sim.run_spec is None or sim.engine.steps or sim.communication.bus.inbox:
            reason = "has already begun" if sim.run_spec is not None else "was not loaded by simkit.load"
            raise InputError(
                NOT_RECORDED,
                f"cannot record a bundle: this run {reason}",
                help="call simkit_verification.testing.bundles.keep(sim) right after simkit.load",
            )
        if sim.communication.bus.journal is not None:
            raise InputError(NOT_RECORDED, "this run is already recorded for a bundle")
        self.sim, self.seconds, self.topics, self._write_failed = sim, float(seconds), tuple(topics), write_failed
        self.written: Path | None = None
        values = {} if run is None else {n: run.value_of(f) for n, f in packed_fields().items() if not f.is_loaded}
        self.run = sim.run_spec.with_values(values)
        self.window = MessageWindow(sim, seconds, topics, self.run.skip)
        self.marks = StateHashes(sim)
        self.journal = JournalWriter(sim)
        self._listen()

    def end(self, failure: Failure | None = None) -> RunEnd:
        """Return the number of steps, the times and the state hash at this moment."""
        sim = self.sim
        return RunEnd(sim.engine.steps, sim.tick, sim.time_ns, state_hash(sim), failure)

    def _listen(self) -> None:
        sim, sources = self.sim, self.journal.sources
        read = self._read = sim.contents.models_reader

        def read_and_record(source: object, *args: object, **named: object) -> SceneModel:
            sources.append(str(source))
            return read(source, *args, **named)

        sim.contents.models_reader = read_and_record
        self.journal.keeper = self
        sim.communication.bus.journal = self.journal

    def close(self) -> None:
        """Stop recording; the recorded data remain."""
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
            except (SimkitError, OSError) as problem:  # the caller must get the exception of the run, not this one
                error.add_note(f"no bundle was written: {problem}")
            else:
                error.add_note(f"a bundle that repeats this failure: simkit replay {self.written}")
        self.close()


def recorder_of(sim: Simulation) -> BundleRecorder:
    """Return the recorder of a simulation.

    Raises:
        InputError: SK-BUNDLE-007 the simulation is not recorded.
    """
    journal = sim.communication.bus.journal
    keeper = getattr(journal, "keeper", None)
    if not isinstance(keeper, BundleRecorder):
        raise InputError(
            NOT_RECORDED,
            "this run is not recorded for a bundle",
            help="call simkit_verification.testing.bundles.keep(sim) right after simkit.load",
        )
    return keeper
