"""Runs a scenario and takes down what it gives."""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections import Counter, deque
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit import msgs
from simkit.errors import PluginError, SimulationDiverged, SubscriberError
from simkit.golden.order import in_order
from simkit.golden.record import Record, Stream
from simkit.runtime.topics import NOTHING, Later
from simkit.sinks.topic_patterns import fits

if TYPE_CHECKING:
    from simkit.golden.taking import Taker
    from simkit.runtime import Simulation
    from simkit.scenario import Scenario

_CLOCK: Final = "rosgraph_msgs/msg/Clock"
_RENDERED: Final = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
ENVIRONMENT: Final = ("TURTLEBOT3_MODEL",)
_LETTERS: Final = 16  # of the hash of a second


def run_record(scenario: Scenario, *, sim: Simulation | None = None) -> Record:
    """Runs a scenario to its end and records what it gives.

    The record's `simulation` is left open, for further questions; whoever asked for the record closes it.

    Args:
        scenario: what is run.
        sim: its world, where it is open already; it goes on from where it stands.

    Raises:
        InputError: the world, a command or a check cannot be used.
        RenderError: there are pictures to be drawn and nothing that draws.
    """
    with contextlib.chdir("."):  # where a plugin may have gone is nobody else's place
        return _recorded(scenario, sim)


def _recorded(scenario: Scenario, sim: Simulation | None) -> Record:
    from simkit.scenario.run import open_scenario, run_scenario

    opened = open_scenario(scenario) if sim is None else sim
    results: tuple[Any, ...] = ()
    failed: Exception | None = None
    try:
        longest = scenario.duration if scenario.timeout is None else scenario.timeout
        with Capture(scenario, opened, longest) as capture:
            try:
                ended = run_scenario(scenario, opened)
                end, results = ended.reason, ended.results
            except (SimulationDiverged, PluginError, SubscriberError) as error:
                end, failed = str(error), error
            record = capture.record(end)
    except BaseException:
        if sim is None:
            opened.close()
        raise
    record.checks, record.error = results, failed
    return record


class Capture:
    """Takes down the topics and the physics of a simulation, from now on; a context manager around its run.

    Args:
        scenario: which topics, and how.
        sim: the simulation.
        longest: how long it will run at most [s]; states are kept accordingly.
    """

    def __init__(self, scenario: Scenario, sim: Simulation, longest: float) -> None:
        from simkit.golden.fields import fields_of_model
        from simkit.golden.leaves import leaves_of
        from simkit.golden.marks import Marks
        from simkit.golden.sources import sources_of

        self._scenario, self._sim = scenario, sim
        self._streams: dict[str, StreamTaker] = {}
        self._leaves, self._places = leaves_of(sim)
        self._fields, self._sources = fields_of_model(sim), sources_of(sim)
        self._diagnostics = Counter(d.code for d in sim.diagnostics)
        self._is_open = True
        sim.bus.on_topic(self._add)
        self._marks = Marks(sim, sim.clock.ticks(longest))

    def __enter__(self) -> Capture:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Takes nothing any more."""
        self._is_open = False
        for stream in self._streams.values():
            stream.close()
        self._marks.close()

    def record(self, end: str = "duration") -> Record:
        """What was taken so far.

        Args:
            end: why the run ended.
        """
        from simkit.golden.fingerprint import fingerprint

        published = {topic for topic, _, _, does in self._sim.bus.ends() if does == "publishes"}
        streams = {}
        for topic in sorted(self._streams):
            taker = self._streams[topic]
            stream = taker.stream()
            if len(stream.times_ns) or topic in published:
                streams[topic] = stream
        pictures = any(s.type_name in _RENDERED and len(s.times_ns) for s in streams.values())
        return Record(
            self._scenario,
            fingerprint(pictures=pictures),
            streams,
            self._marks.states(),
            self._leaves,
            self._places,
            self._fields,
            self._sources,
            dict(sorted(self._diagnostics.items())),
            end,
            self._sim,
            environment=_environment(self._sim),
        )

    def _add(self, topic: str, type_name: str) -> None:
        if self._is_open and topic not in self._streams and self._is_asked_for(topic, type_name):
            self._streams[topic] = StreamTaker(self._scenario, self._sim, topic, type_name)

    def _is_asked_for(self, topic: str, type_name: str) -> bool:
        scenario = self._scenario
        if fits(topic, scenario.skip):
            return False
        if scenario.topics:
            return fits(topic, scenario.topics)
        return topic not in self._sim.bus.aside and type_name != _CLOCK


class StreamTaker:
    """Takes down one topic.

    Args:
        scenario: how.
        sim: the simulation.
        topic, type_name: which.
    """

    def __init__(self, scenario: Scenario, sim: Simulation, topic: str, type_name: str) -> None:
        self._scenario, self._sim, self._topic, self._type_name = scenario, sim, topic, type_name
        self._taker: Taker | None = None
        self._times: list[int] = []
        self._whole, self._second = hashlib.sha256(), hashlib.sha256()
        self._chunks: list[str] = []
        self._waiting: deque[tuple[int, Any]] = deque()  # behind a picture that is still being drawn
        self._tap = sim.bus.tap(topic, self._take, takes_later=True)

    def close(self) -> None:
        """Takes nothing any more."""
        self._take_waiting(to_the_end=True)
        self._tap.close()

    def stream(self) -> Stream:
        """What was taken so far."""
        self._sim.bus.gather(self._topic)
        self._take_waiting(to_the_end=True)
        stream = Stream(self._topic, self._type_name, np.array(self._times, np.int64))
        stream.digest = self._whole.hexdigest()
        stream.chunks = [*self._chunks, self._second.hexdigest()[:_LETTERS]] if self._times else []
        if self._taker is not None:
            self._taker.fill(stream)
        return stream

    def _take(self, message: Any) -> None:
        """A message that was published now."""
        now = self._sim.time_ns
        if type(message) is Later and (self._waiting or not message.is_ready):
            self._waiting.append((now, message))
            self._take_waiting()
            return
        if self._waiting:
            self._take_waiting(to_the_end=True)  # this one may be written to later, and stays in its order
        message = message.get() if type(message) is Later else message
        if message is not NOTHING:
            self._keep(now, message)

    def _take_waiting(self, *, to_the_end: bool = False) -> None:
        while self._waiting and (to_the_end or self._waiting[0][1].is_ready):
            now, later = self._waiting.popleft()
            message = later.get()
            if message is not NOTHING:
                self._keep(now, message)

    def _keep(self, now: int, message: Any) -> None:
        type_name = msgs.type_name(message)
        if self._taker is None:
            from simkit.golden.taking import taker_of

            self._type_name = type_name
            self._taker = taker_of(self._scenario, self._sim, self._topic, type_name)
        message = in_order(message, type_name)
        data = msgs.serialize(message)
        self._whole.update(data)
        second = now // 1_000_000_000
        while len(self._chunks) < second:
            self._chunks.append(self._second.hexdigest()[:_LETTERS])
            self._second = hashlib.sha256()
        self._second.update(data)
        self._times.append(now)
        if type_name == self._type_name:  # a second type on one topic counts in the digest
            self._taker.take(message)


def _environment(sim: Simulation) -> dict[str, str]:
    """What the environment says of the world: which TurtleBot3 it is."""
    is_told = any("turtlebot3" in model.name for model in sim.world.models)
    return {name: os.environ.get(name, "") for name in ENVIRONMENT if is_told}
