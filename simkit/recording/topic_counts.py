"""Message counts and rates of topics in simulated time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from simkit.recording.message_taps import Receiver, TopicTaps, is_available

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from simkit.runtime import Simulation
    from simkit.runtime.communication.publisher import Tally

# Types that need rendering; counting them would render every frame only to discard it.
RENDERED = frozenset({"sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo", "sensor_msgs/msg/PointCloud2"})


@dataclass
class TopicCount:
    """Count of the messages of one topic.

    Attributes:
        counted: False for a topic that is not read; its numbers are unknown.
        count: number of messages after `since`.
        since: simulated time [ns] at which counting started.
        second: simulated time [ns] of the second message.
        last: simulated time [ns] of the newest message.
    """

    topic: str
    type_name: str
    counted: bool
    since: int
    count: int = 0
    second: int = 0
    last: int = 0

    def rate(self) -> float | None:
        """Return the messages per simulated second [Hz] after the second message; None before the third message.

        The first message is left out, because the time to the second message can differ from the sensor's period.
        """
        if self.count < 3 or self.last <= self.second:
            return None
        return (self.count - 2) * 1e9 / (self.last - self.second)


@dataclass
class _Tallied:
    """Start of the count of a topic whose publisher knows the number of its messages.

    Attributes:
        tally: function of the publisher.
        count: number of messages before `tick`.
        tick: tick at which counting started.
        generation: generation of the state; another one after a reset.
    """

    tally: Callable[[], Tally | None]
    count: int
    tick: int
    generation: int


class TopicCounter:
    """Counts the messages of all topics, except topics in the bus's `aside` that nothing else reads.

    No message is made or received where the publisher knows the number (`Publisher.tally`).

    Args:
        sim: simulation to observe.
        skip: types to list without reading them.
        is_read: function that returns True for a topic that something else reads; such topics are always counted.
    """

    def __init__(
        self, sim: Simulation, skip: Collection[str] = (), is_read: Callable[[str], bool] | None = None
    ) -> None:
        self._sim, self._skip, self._is_read = sim, frozenset(skip), is_read
        self._rows: dict[str, TopicCount] = {}
        self._tallied: dict[str, _Tallied] = {}
        self._taps = TopicTaps(sim, self._receiver_of)
        self._taps.open()

    @property
    def rows(self) -> list[TopicCount]:
        """One row for each topic, sorted by name, with the present numbers."""
        for topic in self._tallied:
            self._update(topic)
        return [self._rows[topic] for topic in sorted(self._rows)]

    @property
    def total(self) -> int:
        """Number of messages counted on all topics."""
        return sum(row.count for row in self.rows)

    def close(self) -> None:
        """Stop counting."""
        for topic in self._tallied:
            self._update(topic)
        self._tallied.clear()
        self._taps.close()

    def _receiver_of(self, topic: str, type_name: str) -> Receiver | None:
        bus, physics = self._sim.communication.bus, self._sim.engine.physics
        if topic in self._tallied:  # the topic has messages of others from now on
            self._update(topic)
            del self._tallied[topic]
            return self._receiver(self._rows[topic])
        is_read = self._is_read is not None and self._is_read(topic)
        if topic in self._rows or (topic in bus.aside and not is_read):
            return None
        # a topic that nothing reads is only listed if its messages cannot be made here
        is_counted = is_read or (type_name not in self._skip and is_available(self._sim, topic))
        row = self._rows[topic] = TopicCount(topic, type_name, is_counted, self._sim.time_ns)
        tally = bus.tally_of(topic) if is_counted else None
        if tally is not None and (begun := tally()) is not None:
            self._tallied[topic] = _Tallied(tally, begun[0], physics.tick, bus.inbox.generation)
            return None
        return self._receiver(row) if row.counted else None

    def _receiver(self, row: TopicCount) -> Receiver:
        """Return a function that counts each message."""

        def count(_: object) -> None:
            now = self._sim.time_ns
            if now < row.last:
                # the simulation was reset
                row.since, row.count = 0, 0
            row.last = now
            row.count += 1
            if row.count == 2:
                row.second = now

        return count

    def _update(self, topic: str) -> None:
        """Take the numbers of a topic from its publisher."""
        row, begun, bus = self._rows[topic], self._tallied[topic], self._sim.communication.bus
        tally = begun.tally()
        if tally is None:
            return
        count, last_ns, timetable = tally
        if bus.inbox.generation != begun.generation:  # the simulation was reset
            row.since, begun.count, begun.tick, begun.generation = 0, 0, 0, bus.inbox.generation
        clock, second = self._sim.engine.clock, begun.tick
        for _ in range(2):
            second = second + 1 if timetable is None else timetable.next(second)
        row.count, row.second = count - begun.count, clock.time_ns(second)
        row.last = last_ns if row.count else 0
