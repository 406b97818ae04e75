"""Playback of a bag's commands at their recorded ticks, in the recorded world or in another world."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError, MessageError
from simkit.msgs.message_text import message_to_dict
from simkit.msgs.message_types import Message
from simkit.msgs.topic_names import absolute_name
from simkit.recording.bags.bag_contents import BagMessage, unreadable
from simkit.recording.bags.reader import LATEST_SIMULATED_TIME, open_bag_to_read

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_TWIST, _STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
_NS: Final = 1e-9
_ROUNDING: Final = 1e-6  # [steps] tolerance between a time and its tick


class Playback:
    """Sends a bag's messages to a simulation, each at the first tick at or after its time; a context manager.

    A message that simkit recorded is sent at its original tick. The run then repeats bit for bit if nothing else
    differs. Times of a ROS recording are calendar times, so they are counted from the start of the bag.

    Args:
        sim: simulation that receives the messages.
        path: bag to play.
        topics: `TOPIC`, or `OLD:=NEW` to rename a topic; empty for every topic that the world subscribes to and does
            not publish itself.

    Attributes:
        names: played topics of the bag -> topics in the world.
        notes: differences from the recording, as text.
        sent: number of sent messages.

    Raises:
        InputError: SK-CLI-030 the bag or the world has no such topic; SK-CLI-035 the bag is unreadable; SK-BAG-015 the
            type of a topic does not match; SK-BAG-016 the world subscribes to no topic of the bag.
    """

    def __init__(self, sim: Simulation, path: Path, topics: Sequence[str] = ()) -> None:
        self._sim = sim
        self._bag = open_bag_to_read(path)
        try:
            if self._bag.start < LATEST_SIMULATED_TIME <= self._bag.end:  # the run would last for decades
                times = f"{self._bag.start * _NS:.9g} s to {self._bag.end * _NS:.9g} s"
                raise unreadable(path, f"its times, {times}, are simulated times and calendar times")
            self.notes: list[str] = [f"{path}: {self._bag.broken}"] if self._bag.broken else []
            self._input_types = self._world_inputs()
            self.names = self._requested_topics(topics) if topics else self._playable_topics()
            self.sent = 0
            self._sent_types: dict[tuple[str, str], str] = {}
            for topic in self._bag.topics:
                if topic.name in self.names:
                    self._sent_types[topic.name, topic.type_name] = self._matching_input_type(
                        topic.name, topic.type_name
                    )
        except BaseException:
            self._bag.close()
            raise
        self._first_tick = sim.tick
        self._origin = self._bag.time_origin
        self._messages: Iterator[BagMessage] = self._bag.messages(list(self.names))
        self._next = next(self._messages, None)

    def __enter__(self) -> Playback:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Stop sending and close the bag."""
        self._next = None
        self._bag.close()

    @property
    def duration(self) -> float:
        """Time from the start to the bag's last message, played or not [s]."""
        return self._bag.duration

    @property
    def next_tick(self) -> int | None:
        """Tick of the next message; None after the last message."""
        if self._next is None:
            return None
        steps = (self._next.time_ns - self._origin) * _NS / self._sim.timestep
        return self._first_tick + max(0, math.ceil(steps - _ROUNDING))

    def send_due(self) -> None:
        """Send the messages that are due at the present tick.

        Raises:
            InputError: SK-BAG-015 a message does not match its topic; SK-CLI-035 the bag is truncated; SK-CLI-036 a
                message does not match its type.
        """
        while self._next is not None and (tick := self.next_tick) is not None and tick <= self._sim.tick:
            message = self._next
            self._next = next(self._messages, None)
            topic = self.names[message.topic]
            try:
                self._sim.publish(topic, self._message_to_send(message))
            except MessageError as error:
                text = f"{self._bag.path}: {message.topic} at {message.time_ns * _NS:.9g} s: {error}"
                raise InputError("SK-BAG-015", text) from None
            self.sent += 1

    # ------------------------------------------------------------------ topics

    def _world_inputs(self) -> dict[str, tuple[str, ...]]:
        """Return the topics that the world subscribes to, with their types."""
        types_by_topic: dict[str, tuple[str, ...]] = {}
        for topic, endpoint, types, role in self._sim.communication.bus.endpoints():
            if role == "takes" and endpoint.active:
                types_by_topic[topic] = (*types_by_topic.get(topic, ()), *types)
        return types_by_topic

    def _playable_topics(self) -> dict[str, str]:
        published = {
            topic
            for topic, endpoint, _, role in self._sim.communication.bus.endpoints()
            if role == "publishes" and endpoint.active
        }
        bag_topics = dict.fromkeys(topic.name for topic in self._bag.topics)
        playable = {topic: topic for topic in bag_topics if topic in self._input_types and topic not in published}
        if not playable:
            unlisted = self._sim.communication.bus.unlisted
            inputs = ", ".join(sorted(self._input_types.keys() - published - unlisted)) or "none"
            text = f"the world subscribes to no topic of {self._bag.path}; its inputs: {inputs}"
            hint = "map topics with --play-topic OLD:=NEW (play_topics in a scenario)"
            raise InputError("SK-BAG-016", text, help=hint)
        return playable

    def _requested_topics(self, topics: Sequence[str]) -> dict[str, str]:
        bag_topics = {topic.name for topic in self._bag.topics}
        target_by_topic = {}
        for text in topics:
            old, sign, new = text.partition(":=")
            if not old or (sign and not new):
                raise InputError("SK-CLI-018", f"a topic to play: found {text!r}; expected TOPIC or OLD:=NEW")
            old = absolute_name(old)
            new = absolute_name(new) if sign else old
            for name, names, where in (
                (old, bag_topics, str(self._bag.path)),
                (new, set(self._input_types), "the world's inputs"),
            ):
                if name not in names:
                    hint = did_you_mean(name, names) or "known: " + (", ".join(sorted(names)) or "none")
                    raise InputError("SK-CLI-030", f"no topic {name!r} in {where}; {hint}")
            target_by_topic[old] = new
        return target_by_topic

    # ------------------------------------------------------------------ types

    def _matching_input_type(self, topic: str, type_name: str) -> str:
        """Return the message type in which the messages of a topic are sent.

        The messages keep their type if the world accepts this type. Twist and TwistStamped are converted into each
        other if the world needs the other type.
        """
        new = self.names[topic]
        types = self._input_types[new]
        name = _known_full_name(type_name)
        if name in types:
            return name
        counterpart = {_TWIST: _STAMPED, _STAMPED: _TWIST}.get(name)
        if counterpart in types and counterpart is not None:
            self.notes.append(f"{topic}: the {name} messages are converted to {counterpart}, the type of {new}")
            return counterpart
        allowed = " or ".join(dict.fromkeys(types))
        text = f"{self._bag.path}: {topic} has type {type_name}, but {new} needs {allowed}"
        raise InputError("SK-BAG-015", text)

    def _message_to_send(self, message: BagMessage) -> Message:
        """Convert a message to the type in which it is sent."""
        target_type = self._sent_types[message.topic, message.type_name]
        decoded = self._bag.decode(message)
        known_name = _known_full_name(message.type_name)
        if type(decoded) is not msgs.type_of(known_name):  # decoded with the bag's own definition
            decoded = msgs.make(known_name, **message_to_dict(decoded, store=self._bag.store_of(message.type_name)))
        if known_name == target_type:
            return decoded
        if target_type == _TWIST:
            return decoded.twist
        return msgs.type_of(_STAMPED)(msgs.header(self._sim.time_ns, ""), decoded)


def _known_full_name(type_name: str) -> str:
    try:
        return msgs.full_name(type_name)
    except MessageError:
        return type_name
