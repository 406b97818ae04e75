"""Recorder of the values that the checks of an exercise read, in the process that runs the hand-in."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Final

from simkit import Joint, RunSpec, Simulation, Subscription
from simkit.msgs import absolute_name
from simkit.runtime.contact.collision_contacts import collision_table
from simkit.testing.conditions.check_list import CheckList
from simkit.testing.conditions.syntax_tree import Span, UndecidedValue
from simkit.testing.conditions.topic_listeners import LatestMessage, MessageCounter
from simkit.testing.conditions.world_view import Contacts, Entity, History, WorldView
from simkit_verification.testing.grading import run_stream
from simkit_verification.testing.grading.recorded_view import (
    encode_contacts,
    encode_joint,
    encode_message,
    encode_pose,
    encode_twist,
    known,
)
from simkit_verification.testing.grading.run_stream import CLOCK, NUMBER, FrameWriter

if TYPE_CHECKING:
    from simkit.compiler import Compiled

_USER_MODULES: Final = "simkit_user_plugins."  # begin of the names of the modules of plugins in files


class _Source:
    """Value that a check reads.

    Args:
        number: Number in the stream.
        read: Function that returns the bytes of the present value.
    """

    def __init__(self, number: int, read: Callable[[], bytes]) -> None:
        self.head, self.read = NUMBER.pack(number), read
        self.last = b""


class RunRecorder(WorldView):
    """View of a world that binds the checks of an exercise only to find out which values they read, and streams these.

    Args:
        sim: Simulation.
        scenario: Scenario with the checks.
        writer: Writer of the stream.
        hand_in: Files of the hand-in.

    Raises:
        InputError: The expressions do not fit the world.
    """

    def __init__(self, sim: Simulation, scenario: RunSpec, writer: FrameWriter, hand_in: Iterable[Path]) -> None:
        super().__init__(sim, "wait")
        self._writer, self._hand_in = writer, {str(file) for file in hand_in}
        self._commanded = {absolute_name(str(command.get("topic", ""))) for command in scenario.commands}
        self._sources: dict[tuple[str, ...], _Source] = {}
        self._feed_topics: dict[str, None] = {}  # topics whose messages histories observe, in order
        self._feeds: dict[str, Subscription] = {}
        self._sent_messages: dict[str, object] = {}
        self._has_paths = self._has_step_values = False
        self._revision = -1
        self._compiled: Compiled | None = None
        self._ends: list[Callable[[], None]] = []
        self._checks = CheckList(self, scenario.checks, until=scenario.until, timeout=scenario.longest)

    # ------------------------------------------------------------------ names in the expressions

    def entity(self, name: str, source: str, span: Span, *, moves: bool = False) -> Entity:
        entity = super().entity(name, source, span)
        self._add(("pose", entity.name), lambda: encode_pose(entity.pose()))
        if moves:
            self._add(("twist", entity.name), lambda: encode_twist(entity.twist()))
        return entity

    def joint(self, name: str, source: str, span: Span) -> Joint:
        joint = super().joint(name, source, span)
        self._add(("joint", joint.scoped), lambda: encode_joint(self.current_joint(joint)))
        return joint

    def existence(self, name: str) -> Callable[[], bool]:
        is_there = super().existence(name)
        self._add(("exists", name), lambda: b"\1" if is_there() else b"\0")
        return is_there

    def contacts(self, first: str, second: str | None = None) -> Contacts:
        contacts = super().contacts(first, second)
        key = ("contacts", first) if second is None else ("contacts", first, second)
        self._add(key, lambda: encode_contacts(contacts))
        return contacts

    def latest_message(self, topic: str) -> LatestMessage:
        message = super().latest_message(topic)
        self._add(("latest", topic), lambda: encode_message(message.latest()))
        return message

    def message_counter(self, topic: str) -> MessageCounter:
        source = self._add(("count", topic), lambda: b"")
        if topic not in self._counters:
            self._counters[topic] = _RecordedCounter(
                self.sim, topic, lambda: self._add_event(run_stream.MESSAGE, source)
            )
        return super().message_counter(topic)

    def add_history(self, history: History) -> None:
        if not history.topic:
            self._has_paths |= history.rate is not None
            self._has_step_values |= history.rate is None
        else:
            self._feed_topics[history.topic] = None
            if self._is_open:
                self._open_feeds()

    def _add(self, key: tuple[str, ...], read: Callable[[], bytes]) -> _Source:
        source = self._sources.get(key)
        if source is None:
            number = len(self._sources)
            source = self._sources[key] = _Source(number, lambda: known(read))
            self._writer.add_json(run_stream.SOURCE, {"number": number, "key": key})
        return source

    # ------------------------------------------------------------------ the run

    def __enter__(self) -> RunRecorder:
        self.open()
        self._open_feeds()
        self._add_names()
        self._add_values()
        self._writer.add(run_stream.STEP, self._clock_bytes())
        self._writer.flush()
        on_demand = self.sim.communication.on_demand
        self._ends = [
            on_demand.add(lambda: self._is_open and self._needs_every_step, None, self._after_step),
            on_demand.add(lambda: self._is_open and self._has_paths, 100.0, self._sample_paths),
        ]
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
        for end in (*self._ends, *(feed.close for feed in self._feeds.values())):
            end()

    @property
    def _needs_every_step(self) -> bool:
        return self._checks.need_every_step or self._has_step_values

    def show_progress(self) -> None:
        """Send a sign of progress between two steps."""
        if not self._needs_every_step:
            self._look_for_topics()
        self._writer.add(run_stream.BEAT, self._clock_bytes())

    def finish(self, end: dict[str, object]) -> None:
        """Send the last values, and the end of the run.

        Args:
            end: Reason of the end and further JSON values.
        """
        self._look_for_topics()
        self._add_values()
        topics = [key[1] for key in self._sources if key[0] == "count"]
        rates = {topic: self.configured_rate(topic) for topic in topics}
        self._writer.add(run_stream.BEAT, self._clock_bytes())
        self._writer.add_json(run_stream.END, {**end, "rates": rates})
        self._writer.flush()

    def _after_step(self, _: int) -> None:
        self._look_for_topics()
        self._add_values()
        self._writer.add(run_stream.STEP, self._clock_bytes())

    def _sample_paths(self, _: int) -> None:
        for key, source in self._sources.items():
            if key[0] == "pose":
                self._add_value(source)
        self._writer.add(run_stream.OBSERVE, self._clock_bytes())

    def _clock_bytes(self) -> bytes:
        sim = self.sim
        return CLOCK.pack(sim.tick, sim.time_ns, sim.time)

    # ------------------------------------------------------------------ values and messages

    def _add_values(self) -> None:
        for key, source in self._sources.items():
            if key[0] == "latest":
                self._add_latest(key[1], source)
            elif key[0] != "count":
                self._add_value(source)

    def _add_value(self, source: _Source) -> None:
        value = source.read()
        if value != source.last:
            source.last = value
            self._writer.add(run_stream.VALUE, source.head + value)

    def _add_latest(self, topic: str, source: _Source) -> None:
        message: object = None
        with suppress(UndecidedValue):
            message = self._latest_messages[topic].latest()
        if message is not self._sent_messages.get(topic):
            self._sent_messages[topic] = message
            self._writer.add(run_stream.VALUE, source.head + source.read())  # even if it is equal to the one before

    def _open_feeds(self) -> None:
        """Receive the topics of the histories; their newest messages are subscribed before, so they are there."""
        for topic in self._feed_topics:
            if topic not in self._feeds:
                report = partial(self._add_feed, topic, self._sources["latest", topic])
                self._feeds[topic] = self.sim.communication.bus.tap(topic, report)

    def _add_event(self, kind: int, source: _Source) -> None:
        self._writer.add(kind, source.head + self._clock_bytes())

    def _add_feed(self, topic: str, source: _Source, _: object) -> None:
        self._add_latest(topic, source)
        self._add_event(run_stream.FEED, source)

    # ------------------------------------------------------------------ names of the world

    def _look_for_topics(self) -> None:
        """Send the names of the world if its topics or models changed, and bind conditions that wait for a topic."""
        compiled = self.sim.engine.structure.compiled
        if self._revision != self.topics_revision or self._compiled is not compiled:
            self._add_names()
            self._checks.bind_waiting()

    def _add_names(self) -> None:
        self._revision, self._compiled = self.topics_revision, (compiled := self.sim.engine.structure.compiled)
        tables = self._tables
        names = {
            "model": list(tables["model"]),
            "link": list(tables["link"]),
            "joint": {name: joint.dof for name, joint in tables["joint"].items()},
            "collision": list(collision_table(compiled).names),
            "topics": self.all_topics(),
            "foreign": self._foreign_publishers(),
            "timestep": self.sim.timestep,
        }
        self._writer.add_json(run_stream.NAMES, names)

    def _foreign_publishers(self) -> list[str]:
        """Return the topics of checks that a plugin of the exercise publishes, and the hand-in too."""
        topics = []
        for topic in dict.fromkeys(key[1] for key in self._sources if key[0] in ("latest", "count")):
            ends = [end for _, end, _, what in self.sim.communication.bus.endpoints(topic) if what == "publishes"]
            origins = {self._origin(end.owner) for end in ends if end.owner is not None or topic not in self._commanded}
            if {"exercise", "foreign"} <= origins:
                topics.append(topic)
        return topics

    def _origin(self, owner: object) -> str:
        module = type(owner).__module__
        if owner is None:
            return "foreign"
        if not module.startswith(_USER_MODULES):
            return "simkit"
        return "foreign" if module.removeprefix(_USER_MODULES) in self._hand_in else "exercise"


class _RecordedCounter(MessageCounter):
    """Counter that reports every message.

    Args:
        sim: Simulation.
        topic: Absolute name of the topic.
        report: Function that is called for every message.
    """

    def __init__(self, sim: Simulation, topic: str, report: Callable[[], None]) -> None:
        super().__init__(sim, topic)
        self._report = report

    def take(self, now: int) -> None:
        super().take(now)
        self._report()
