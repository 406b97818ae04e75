"""What subscribers of a run get, in short hashes."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from simkit import msgs
from simkit.msgs import Message
from simkit.recording.bags.recorder import matches_topic
from simkit.recording.message_taps import TopicTaps
from simkit.runtime import Simulation
from simkit.runtime.communication.topic_bus import NO_MESSAGE, LazyMessage
from simkit.testing.certify.outcome import TopicOutcome
from simkit.testing.certify.value_hash import short_hash
from simkit.testing.certify.variations import Listening

UNKNOWN = -1


class TopicHashes:
    """Subscriptions to all topics of a run, those that come later included.

    Topics that a bus has aside (`/stats`, whose fields are of the wall clock) are left out unless they are named.

    Args:
        sim: the simulation.
        how: they hear.
        topics: shell patterns of what is heard; empty for all.
        skip: shell patterns of what is not.
    """

    def __init__(self, sim: Simulation, how: Listening, topics: Sequence[str] = (), skip: Sequence[str] = ()) -> None:
        self._sim, self._how, self._topics, self._skip = sim, how, tuple(topics), tuple(skip)
        self._streams: dict[str, _TopicHash] = {}
        self.is_deaf = False
        if how != "none":
            TopicTaps(sim, self._receiver_of).open()

    def take(self) -> None:
        """Looks at what was kept; to be called now and then between two steps."""
        for stream in self._streams.values():
            stream.take()

    def heard(self) -> dict[str, TopicOutcome]:
        """What came, by topic."""
        self.take()
        owners = _topic_publishers(self._sim)
        return {topic: stream.heard(owners.get(topic, "")) for topic, stream in sorted(self._streams.items())}

    def _receiver_of(self, topic: str, type_name: str) -> Callable[[Message], None] | None:
        if topic in self._streams or not self._is_wanted(topic):
            return None
        stream = self._streams[topic] = _TopicHash(self, self._sim, type_name)
        if self._how == "kept":
            return stream.keep
        self._sim.subscribe(topic, stream.receive, keep=1)
        if self._how == "late":
            self._sim.subscribe(topic, lambda _: None, keep=3)
            self._sim.subscribe(topic, keep=2)
        return None  # real subscriptions, so that how a topic is heard differs from run to run

    def _is_wanted(self, topic: str) -> bool:
        if topic in self._sim.communication.bus.aside and topic not in self._topics:
            return False
        return not matches_topic(topic, self._skip) and (not self._topics or matches_topic(topic, self._topics))


class _TopicHash:
    """One topic."""

    def __init__(self, ears: TopicHashes, sim: Simulation, type_name: str) -> None:
        self._ears, self._sim, self._type_name = ears, sim, type_name
        self._digests: list[int] = []
        self._ticks: list[int] = []
        self._kept: list[Message] = []
        self._all = hashlib.sha256()

    def receive(self, message: object) -> None:
        """Called back with a message."""
        if not self._ears.is_deaf:
            self._count(message, self._sim.tick)

    def keep(self, message: object) -> None:
        """Given a message, or what will be one."""
        if not self._ears.is_deaf:
            self._kept.append(message)

    def take(self) -> None:

        kept, self._kept = self._kept, []
        for message in kept:
            made = message.get() if type(message) is LazyMessage else message
            if made is not NO_MESSAGE:
                self._count(made, UNKNOWN)

    def _count(self, message: object, tick: int) -> None:
        content = msgs.serialize(message)
        self._all.update(content)
        self._digests.append(short_hash(content))
        self._ticks.append(tick)

    def heard(self, owner: str) -> TopicOutcome:
        digests, ticks = np.array(self._digests, np.uint64), np.array(self._ticks, np.int64)
        return TopicOutcome(self._type_name, digests, ticks, self._all.hexdigest(), owner)


def _topic_publishers(sim: Simulation) -> dict[str, str]:
    """Who publishes each topic."""
    found: dict[str, list[str]] = {}
    for topic, end, _, does in sim.communication.bus.endpoints():
        if does == "publishes" and end.owner is not None:
            found.setdefault(topic, []).append(plugin_title(end.owner))
    return {topic: " and ".join(dict.fromkeys(names)) for topic, names in found.items()}


def plugin_title(part: Any) -> str:
    """A plugin or a sensor as a report calls it: `plugin 'drive' (robot.sdf:12)`."""
    where = getattr(part, "where", None) or getattr(getattr(part, "scene", None), "where", None)
    kind = "plugin" if hasattr(part, "has_hook") else "sensor" if hasattr(part, "scene") else ""
    if not kind:
        return type(part).__name__
    name = (
        f"{part.scoped}::{part.name}" if kind == "plugin" and part.scoped else getattr(part, "scoped", "") or part.name
    )
    place = f" ({where})" if where is not None and where.line else ""
    return f"{kind} {name!r}{place}"
