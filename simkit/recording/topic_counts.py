"""Count the messages of each topic and their true rate in simulated time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from simkit.recording.message_taps import Receiver, TopicTaps

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from simkit.runtime import Simulation

# What has to be rendered for; counting it would make every frame be drawn only to be thrown away.
RENDERED = frozenset({"sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo", "sensor_msgs/msg/PointCloud2"})


@dataclass
class TopicCount:
    """Count of the messages of one topic.

    Attributes:
        counted: False where nobody reads the topic, so that nothing is known.
        count: messages since `since`.
        since, second, last: simulated times [ns] from which they are counted, of the second message and of the newest.
    """

    topic: str
    type_name: str
    counted: bool
    since: int
    count: int = 0
    second: int = 0
    last: int = 0

    def rate(self) -> float | None:
        """Messages per simulated second [Hz] since the second (the first may lie off the grid); None before three."""
        if self.count < 3 or self.last <= self.second:
            return None
        return (self.count - 2) * 1e9 / (self.last - self.second)


class TopicCounter:
    """Counts the messages of every topic but those that the bus has aside and nobody else reads.

    Args:
        sim: the simulation.
        skip: types that are listed but not read.
        is_read: whether somebody else reads a topic, which is then counted whatever its type.
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
        """Return one row for each topic, sorted by name."""
        return [self._rows[topic] for topic in sorted(self._rows)]

    @property
    def total(self) -> int:
        """Messages counted on all topics."""
        return sum(row.count for row in self._rows.values())

    def close(self) -> None:
        """Stops counting."""
        self._taps.close()

    def _receiver_of(self, topic: str, type_name: str) -> Receiver | None:
        is_read = self._is_read is not None and self._is_read(topic)
        if topic in self._rows or (topic in self._sim.communication.bus.aside and not is_read):
            return None
        is_counted = type_name not in self._skip or is_read
        row = self._rows[topic] = TopicCount(topic, type_name, is_counted, self._sim.time_ns)

        def count(_: object) -> None:
            now = self._sim.time_ns
            if now < row.last:
                # The simulation was reset.
                row.since, row.count = 0, 0
            row.last = now
            row.count += 1
            if row.count == 2:
                row.second = now

        return count if row.counted else None
