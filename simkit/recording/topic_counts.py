"""Message counts and rates of topics in simulated time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from simkit.recording.message_taps import Receiver, TopicTaps, is_available

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from simkit.runtime import Simulation

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


class TopicCounter:
    """Counts the messages of all topics, except topics in the bus's `aside` that nothing else reads.

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
        self._taps = TopicTaps(sim, self._receiver_of)
        self._taps.open()

    @property
    def rows(self) -> list[TopicCount]:
        """One row for each topic, sorted by name."""
        return [self._rows[topic] for topic in sorted(self._rows)]

    @property
    def total(self) -> int:
        """Number of messages counted on all topics."""
        return sum(row.count for row in self._rows.values())

    def close(self) -> None:
        """Stop counting."""
        self._taps.close()

    def _receiver_of(self, topic: str, type_name: str) -> Receiver | None:
        is_read = self._is_read is not None and self._is_read(topic)
        if topic in self._rows or (topic in self._sim.communication.bus.aside and not is_read):
            return None
        # a topic that nothing reads is only listed if its messages cannot be made here
        is_counted = is_read or (type_name not in self._skip and is_available(self._sim, topic))
        row = self._rows[topic] = TopicCount(topic, type_name, is_counted, self._sim.time_ns)

        def count(_: object) -> None:
            now = self._sim.time_ns
            if now < row.last:
                # the simulation was reset
                row.since, row.count = 0, 0
            row.last = now
            row.count += 1
            if row.count == 2:
                row.second = now

        return count if row.counted else None
