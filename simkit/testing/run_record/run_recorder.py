"""Recorder that runs a scenario and records its topics and physics."""

from __future__ import annotations

import contextlib
import hashlib
import math
import os
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit import msgs
from simkit.deprecation import warn_deprecated
from simkit.errors import NodeError, PluginError, SimulationDiverged, SubscriberError
from simkit.msgs import Message
from simkit.recording.bags.bag_contents import matches_topic
from simkit.recording.message_taps import MessageQueue, TopicTaps
from simkit.run_spec import RunSpec
from simkit.testing.run_record.fingerprint import fingerprint, source_hashes
from simkit.testing.run_record.left_out import count_left_out
from simkit.testing.run_record.message_recorder import MessageRecorder, message_recorder_for
from simkit.testing.run_record.record import RunRecord, Stream
from simkit.testing.run_record.state_recorder import StateRecorder, fields_of_model
from simkit.testing.run_record.world_values import values_of_simulation
from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.testing.conditions.checks import CheckResult


_CONTACTS: Final = "ros_gz_interfaces/msg/Contacts"
_PARTS: Final[dict[str, tuple[str, Callable[[Message], tuple[str, ...]]]]] = {
    "tf2_msgs/msg/TFMessage": ("transforms", attrgetter("child_frame_id", "header.frame_id")),
    _CONTACTS: ("contacts", attrgetter("collision1.name", "collision2.name")),
    "gazebo_msgs/msg/ContactsState": ("states", attrgetter("collision1_name", "collision2_name")),
}
"""Message type -> field with a list of items, and the sort key of the items; items with equal keys keep their order."""
_POINTS: Final[dict[str, tuple[str, ...]]] = {
    _CONTACTS: ("positions", "normals", "depths", "wrenches"),
    "gazebo_msgs/msg/ContactsState": ("contact_positions", "contact_normals", "depths", "wrenches"),
}
"""Message type -> parallel lists of contact points; the first list has the positions."""
_ACROSS: Final = (1.0, math.sqrt(0.5), math.sqrt(1.0 / 3.0))
"""Direction along which contact points are sorted; no edge or diagonal of a box is perpendicular to this direction."""
_ROWS: Final[dict[str, tuple[str, ...]]] = {
    "gazebo_msgs/msg/ModelStates": ("name", "pose", "twist"),
    "gazebo_msgs/msg/LinkStates": ("name", "pose", "twist"),
}
"""Message type -> parallel lists of all entities; the first list has the names."""


def sort_message(message: Message, type_name: str) -> object:
    """Return a message whose items are sorted by name; return other types of messages and sorted messages unchanged.

    Args:
        message: Message; it is not modified.
        type_name: Type of the message.
    """
    if type_name in _PARTS:
        field, key = _PARTS[type_name]
        parts = getattr(message, field)
        if type_name == _CONTACTS and any(contact.collision1.id or contact.collision2.id for contact in parts):
            return sort_message(
                replace(message, contacts=[_without_entity_numbers(contact) for contact in parts]), type_name
            )
        if type_name in _POINTS:
            parts = [_sort_points(part, _POINTS[type_name]) for part in parts]
        ordered = sorted(parts, key=key)
        if all(a is b for a, b in zip(ordered, getattr(message, field), strict=True)):
            return message
        return replace(message, **{field: ordered})
    if type_name in _ROWS:
        names = list(getattr(message, _ROWS[type_name][0]))
        order = sorted(range(len(names)), key=names.__getitem__)
        columns = {field: getattr(message, field) for field in _ROWS[type_name]}
        if order == list(range(len(names))) or any(len(column) != len(names) for column in columns.values()):
            return message
        return replace(message, **{field: [column[i] for i in order] for field, column in columns.items()})
    return message


def _sort_points(part: Message, fields: tuple[str, ...]) -> object:
    """Return a contact with sorted points, because the engine's order depends on the order of models in the file."""
    columns = {field: getattr(part, field) for field in fields}
    places = columns[fields[0]]
    keys = [p.x * _ACROSS[0] + p.y * _ACROSS[1] + p.z * _ACROSS[2] for p in places]
    order = sorted(range(len(keys)), key=keys.__getitem__)
    if order == list(range(len(keys))):
        return part
    moved: dict[str, object] = {
        field: column[order] if isinstance(column, np.ndarray) else [column[i] for i in order]
        for field, column in columns.items()
        if len(column) == len(keys)
    }
    return replace(part, **moved)


def _without_entity_numbers(contact: Message) -> object:
    """Return a contact without entity numbers, which depend on the order in the file; names are sufficient."""
    wrenches = [
        replace(w, body_1_id=replace(w.body_1_id, data=0), body_2_id=replace(w.body_2_id, data=0))
        for w in contact.wrenches
    ]
    return replace(
        contact,
        collision1=replace(contact.collision1, id=0),
        collision2=replace(contact.collision2, id=0),
        wrenches=wrenches,
    )


_CLOCK: Final = "rosgraph_msgs/msg/Clock"
_RENDERED: Final = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
ENVIRONMENT_VARIABLES: Final = ("TURTLEBOT3_MODEL",)
_HASH_LETTERS: Final = 16  # length of the hash of one second in hexadecimal digits


def record_run(scenario: RunSpec, *, sim: Simulation | None = None) -> RunRecord:
    """Run a scenario to its end and record its outputs.

    The record's `simulation` stays open. The caller must close it.

    Args:
        scenario: Scenario.
        sim: Simulation of the scenario's world, in any state; None to load the world.

    Raises:
        InputError: The world, a command or a check is invalid.
        RenderError: There are pictures to render, but no renderer is available.
    """
    results: tuple[CheckResult, ...] = ()
    failed: Exception | None = None
    with contextlib.chdir("."):  # a plugin may change the working directory; restore it afterwards
        opened = open_scenario(scenario) if sim is None else sim
        try:
            with RunRecorder(scenario, opened, scenario.longest) as capture:
                try:
                    ended = run_scenario(scenario, opened)
                    end, results = ended.reason, ended.results
                except (SimulationDiverged, PluginError, SubscriberError, NodeError) as error:
                    end, failed = str(error), error
                record = capture.record(end)
        except BaseException:
            if sim is None:
                opened.close()
            raise
    record.checks, record.error = results, failed
    return record


class RunRecorder:
    """Recorder of the topics and the physics of a simulation from this moment on; a context manager around the run.

    Args:
        scenario: Scenario with topics and tolerances.
        sim: Simulation.
        longest: Maximum duration of the run [s]; it determines the interval between stored states.
    """

    def __init__(self, scenario: RunSpec, sim: Simulation, longest: float) -> None:
        self._scenario, self._sim = scenario, sim
        self._streams: dict[str, StreamRecorder] = {}
        self._leaves, self._places = values_of_simulation(sim)
        self._fields, self._sources = fields_of_model(sim), source_hashes(sim)
        self._diagnostics = Counter(d.code for d in sim.diagnostics)
        self._taps = TopicTaps(sim, self._receiver_of)
        self._taps.open()
        self._marks = StateRecorder(sim, sim.engine.clock.checked_ticks(longest, "duration"))

    def __enter__(self) -> RunRecorder:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Stop recording."""
        for stream in self._streams.values():
            stream.queue.deliver_all()
        self._taps.close()
        self._marks.close()

    def record(self, end: str = "duration") -> RunRecord:
        """Return the record up to now.

        Args:
            end: Reason why the run ended, as in `RunRecord`.
        """
        published = {topic for topic, _, _, does in self._sim.communication.bus.endpoints() if does == "publishes"}
        streams = {}
        for topic in sorted(self._streams):
            stream_recorder = self._streams[topic]
            stream = stream_recorder.stream()
            if len(stream.times_ns) or topic in published:
                streams[topic] = stream
        has_images = any(s.type_name in _RENDERED and len(s.times_ns) for s in streams.values())
        return RunRecord(
            self._scenario,
            fingerprint(self._sim if has_images or self._sim.engine.renderer else None),
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
            left_out=count_left_out(self._sim.diagnostics),
        )

    def _receiver_of(self, topic: str, type_name: str) -> Callable[[object], None] | None:
        if not self._is_recorded(topic, type_name):
            return None
        sim = self._sim
        stream = self._streams[topic] = StreamRecorder(self._scenario, sim, topic, type_name)
        return lambda message: stream.queue.add(topic, sim.time_ns, message)

    def _is_recorded(self, topic: str, type_name: str) -> bool:
        scenario = self._scenario
        if matches_topic(topic, scenario.skip):
            return False
        if scenario.topics:
            return matches_topic(topic, scenario.topics)
        return topic not in self._sim.communication.bus.aside and type_name != _CLOCK


class StreamRecorder:
    """Recorder of one topic.

    Args:
        scenario: Scenario with the tolerances.
        sim: Simulation.
        topic, type_name: Topic and its type.

    Attributes:
        queue: Queue that receives each message with its time of publication [ns].
    """

    def __init__(self, scenario: RunSpec, sim: Simulation, topic: str, type_name: str) -> None:
        self._scenario, self._sim, self._topic, self._type_name = scenario, sim, topic, type_name
        self._message_recorder: MessageRecorder | None = None
        self._times: list[int] = []
        self._whole, self._second = hashlib.sha256(), hashlib.sha256()
        self._chunks: list[str] = []
        self.queue = MessageQueue(self._keep)

    def stream(self) -> Stream:
        """Return the recorded data up to now."""
        self._sim.communication.bus.gather(self._topic)
        self.queue.deliver_all()
        stream = Stream(self._topic, self._type_name, np.array(self._times, np.int64))
        stream.digest = self._whole.hexdigest()
        stream.chunks = [*self._chunks, self._second.hexdigest()[:_HASH_LETTERS]] if self._times else []
        if self._message_recorder is not None:
            self._message_recorder.fill(stream)
        return stream

    def _keep(self, _: list[str], times: list[int], messages: list[object]) -> None:
        for now, message in zip(times, messages, strict=True):
            self._keep_one(now, message)

    def _keep_one(self, now: int, message: object) -> None:
        type_name = msgs.type_name(message)
        if self._message_recorder is None:
            self._type_name = type_name
            self._message_recorder = message_recorder_for(self._scenario, self._sim, self._topic, type_name)
        message = sort_message(message, type_name)
        data = msgs.serialize(message)
        self._whole.update(data)
        second = now // 1_000_000_000
        while len(self._chunks) < second:
            self._chunks.append(self._second.hexdigest()[:_HASH_LETTERS])
            self._second = hashlib.sha256()
        self._second.update(data)
        self._times.append(now)
        if type_name == self._type_name:  # messages of a second type on the topic are only added to the digest
            self._message_recorder.take(message)


def _environment(sim: Simulation) -> dict[str, str]:
    """Return the environment variables that select the world, such as the TurtleBot3 model."""
    is_relevant = any("turtlebot3" in model.name for model in sim.world.models)
    return {name: os.environ.get(name, "") for name in ENVIRONMENT_VARIABLES if is_relevant}


def __getattr__(name: str) -> Any:
    """Return `record_run` by its deprecated name."""
    if name != "run_record":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    warn_deprecated(f"{__name__}.run_record", "simkit.testing.record_run", since="0.3")
    return record_run
