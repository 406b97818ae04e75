"""Sources of topics: a running simulation or a bag; and its clock."""

from __future__ import annotations

import os
import time
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from simkit.cli.terminal.output import print_note
from simkit.errors import InputError, MessageError
from simkit.msgs.message_types import Message

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

    from simkit.live import Client
    from simkit.recording.bags.reader import BagReader, BagTopic

LONGEST_WAIT = 1e6  # [s] of wall time, longest sleep of a command
_POLL_PERIOD = 0.05  # [s] of wall time, longest time between two reads of the simulation's clock
_SLOWEST = 1e-3  # real-time factor below which the simulation counts as stopped


class SimClock:
    """Clock of a running simulation. A reset of the simulation sets it back.

    Args:
        client: connection to the simulation.
        by_wall: True to use wall time instead.
    """

    def __init__(self, client: Client, *, by_wall: bool = False) -> None:
        self._client, self._by_wall = client, by_wall
        self._seen: tuple[float, int] | None = None
        self._speed = 1.0

    def now_ns(self) -> int:
        """Return the present time [ns]."""
        if self._by_wall:
            return time.monotonic_ns()
        now_ns, wall = self.sim_ns(), time.monotonic()
        if self._seen is not None and wall > self._seen[0]:
            self._speed = max((now_ns - self._seen[1]) * 1e-9 / (wall - self._seen[0]), 0.0)
        self._seen = wall, now_ns
        return now_ns

    def sim_ns(self) -> int:
        """Return the present simulated time [ns]."""
        return int(self._client.state()["time_ns"])

    def wait_until(self, due_ns: int, since_ns: int) -> bool:
        """Wait for a time [ns]; return False if the clock was set back before `since_ns`."""
        while True:
            now = self.now_ns()
            if now < since_ns:
                return False
            if now >= due_ns:
                return True
            speed = 1.0 if self._by_wall else max(self._speed, _SLOWEST)
            time.sleep(min(_POLL_PERIOD, (due_ns - now) * 1e-9 / speed))


_DEPTH = 100  # queued messages for a slow terminal; the oldest are dropped first


class ReceivedMessage(NamedTuple):
    """Message for the terminal. Its time is simulated time; for a bag, the time of recording [ns]."""

    time_ns: int
    topic: str
    type_name: str
    data: bytes


@dataclass(frozen=True)
class TopicEndpoint:
    """Publisher or subscriber of a topic."""

    node: str
    types: tuple[str, ...]
    latched: bool = False


@dataclass(frozen=True)
class TopicEntry:
    """Topic with its publishers and subscribers."""

    name: str
    types: tuple[str, ...]
    publishers: tuple[TopicEndpoint, ...] = ()
    subscribers: tuple[TopicEndpoint, ...] = ()


class LiveSource:
    """Topics of a running simulation.

    Attributes:
        client: connection to the simulation.
    """

    is_live = True

    def __init__(self, client: Client) -> None:
        self.client = client

    @property
    def where(self) -> str:
        return connection_name(self.client)

    def topics(self) -> dict[str, TopicEntry]:
        """Return the topics by name, sorted."""
        topic_entries = {}
        for row in sorted(self.client.topics(), key=lambda r: str(r["name"])):
            publishers = tuple(
                TopicEndpoint(p["node"], (p["type"],), bool(p.get("latched"))) for p in row["publishers"]
            )
            subscribers = tuple(TopicEndpoint(s["node"], tuple(s["types"])) for s in row["subscribers"])
            topic_entries[row["name"]] = TopicEntry(row["name"], tuple(row["types"]), publishers, subscribers)
        return topic_entries

    def feed(self, topics: Sequence[str], depth: int = _DEPTH) -> LiveFeed:
        """Subscribe to topics from now on."""
        return LiveFeed(self.client, topics, depth)

    def prepare(self, entry: TopicEntry) -> None:
        """Read the definitions of a topic's types now. This is slow and must not delay the first message."""
        from simkit import msgs

        for type_name in entry.types:
            with suppress(MessageError):
                msgs.type_of(type_name)

    def decode(self, received: ReceivedMessage) -> Message:
        """Decode a message."""
        from simkit import msgs

        return msgs.deserialize(received.data, received.type_name)

    def store(self, type_name: str) -> Typestore | None:
        """Return the type store of a type; None for the type store of simkit."""
        return None


class LiveFeed:
    """Messages of some topics of a running simulation, in the order of arrival.

    Attributes:
        is_over: True after the simulation has ended.
    """

    is_live = True

    def __init__(self, client: Client, topics: Sequence[str], depth: int) -> None:
        self._client = client
        self._subscriptions = dict(zip(topics, client.subscribe_all(topics, depth=depth), strict=True))
        self._ready: deque[ReceivedMessage] = deque()
        self.is_over = False

    @property
    def lost(self) -> int:
        """Number of messages dropped because they arrived faster than they were read."""
        return sum(self.lost_by_topic().values())

    def lost_by_topic(self) -> dict[str, int]:
        """Return the number of dropped messages of each topic."""
        return {topic: subscription.lost for topic, subscription in self._subscriptions.items()}

    def take(self, timeout: float | None = None) -> ReceivedMessage | None:
        """Return the next message; None after the timeout [s, wall time] or the end of the simulation."""
        from simkit.live import LiveClosed

        end = None if timeout is None else time.monotonic() + timeout
        while not self._ready:
            self._drain()
            if self._ready:
                break
            left = None if end is None else end - time.monotonic()
            if self.is_over or (left is not None and left <= 0):
                return None
            try:
                self._client.receive(left)
            except LiveClosed as closed:
                self.is_over = True
                if closed.code != "SK-LIVE-005":
                    raise
                print_note(f"note: {str(closed).removeprefix('SK-LIVE-005 ')}")
        return self._ready.popleft()

    def _drain(self) -> None:
        messages: list[ReceivedMessage] = []
        for topic, subscription in self._subscriptions.items():
            while subscription.waiting:
                time_ns, type_name, data = subscription.waiting.popleft()
                messages.append(ReceivedMessage(time_ns, topic, type_name, data))
        if len(self._subscriptions) > 1:
            messages.sort(key=lambda r: r.time_ns)
        self._ready.extend(messages)

    def close(self) -> None:
        """Close the subscriptions."""
        for subscription in self._subscriptions.values():
            subscription.close()


class BagSource:
    """Topics of a bag.

    Attributes:
        bag: open bag.
    """

    is_live = False

    def __init__(self, bag: BagReader) -> None:
        self.bag = bag

    @property
    def where(self) -> str:
        return f"the bag {self.bag.path}"

    def topics(self) -> dict[str, TopicEntry]:
        """Return the topics by name, sorted. Each recorded topic has a publisher."""
        rows: dict[str, list[BagTopic]] = {}
        for topic in self.bag.topics:
            rows.setdefault(topic.name, []).append(topic)
        return {
            name: TopicEntry(
                name,
                tuple(dict.fromkeys(t.type_name for t in topic_entries)),
                tuple(TopicEndpoint("", (t.type_name,), t.latched) for t in topic_entries),
            )
            for name, topic_entries in rows.items()
        }

    def feed(self, topics: Sequence[str], depth: int = _DEPTH) -> BagFeed:
        """Read all messages of some topics."""
        return BagFeed(self.bag, topics)

    def prepare(self, entry: TopicEntry) -> None:
        """Do nothing, because a bag contains the definitions of all its types."""

    def decode(self, received: ReceivedMessage) -> Message:
        """Decode a message."""
        return self.bag.decode(received)  # type: ignore[arg-type]

    def store(self, type_name: str) -> Typestore | None:
        """Return the type store of a type."""
        return self.bag.store_of(type_name)


class BagFeed:
    """Messages of some topics of a bag, in the order of their times."""

    is_live, lost = False, 0

    def __init__(self, bag: BagReader, topics: Sequence[str]) -> None:
        self._messages = bag.messages(topics)
        self.is_over = False

    def take(self, timeout: float | None = None) -> ReceivedMessage | None:
        """Return the next message; None after the last one."""
        message = next(self._messages, None)
        self.is_over = message is None
        return None if message is None else ReceivedMessage(*message)

    def close(self) -> None:
        """Stop reading."""
        self._messages.close()  # type: ignore[attr-defined]


Source = LiveSource | BagSource
Feed = LiveFeed | BagFeed


@contextmanager
def open_source(sim: str | None, bag: Path | None) -> Iterator[Source]:
    """Open the bag if one is given, else connect to the running simulation.

    Raises:
        InputError: SK-CLI-018 both are given; SK-CLI-035 the bag is unreadable; SK-LIVE-00x no simulation answers.
    """
    if bag is not None:
        if sim is not None and sim != os.environ.get("SIMKIT_SIM"):  # the environment variable is not a conflict
            raise InputError("SK-CLI-018", "--sim and --bag: found both; expected one of them")
        from simkit.recording.bags.reader import open_bag_to_read

        with open_bag_to_read(bag) as reader:
            if reader.broken:
                print_note(f"note: {bag}: {reader.broken}")
            yield BagSource(reader)
        return
    with connect_to_simulation(sim) as client:
        yield LiveSource(client)


@contextmanager
def connect_to_simulation(sim: str | None) -> Iterator[Client]:
    """Connect to a running simulation.

    Raises:
        LiveError: SK-LIVE-00x no simulation answers, or several run and no name is given.
    """
    from simkit.live import connect

    with connect(sim, node=f"_simkit_{os.getpid()}") as client:
        yield client


def connection_name(client: Client) -> str:
    """Describe the simulation of a client."""
    return f"the simulation {client.info.get('name', '')!r}"
