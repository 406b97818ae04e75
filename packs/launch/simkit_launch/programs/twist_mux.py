"""Publishes the velocity command of the source with the highest priority, as twist_mux."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node
from republisher import run
from std_msgs.msg import Bool

from simkit_launch.program_simulation import ros1_parameter


@dataclass
class Source:
    """Topic with velocity commands, or with the state of a lock.

    Attributes:
        name, topic: name in the parameters, and topic.
        timeout: time after which the last message does not count any more [s]; 0 for never.
        priority: number from 0 to 255; the source with the highest one wins.
        stamp: time of the last message [s]; 0 before the first one.
        is_locked: last state of a lock.
    """

    name: str
    topic: str
    timeout: float
    priority: int
    stamp: float = 0.0
    is_locked: bool = False

    def is_expired(self, now: float) -> bool:
        """Check whether the last message is too old; a source without a message is as old as the run."""
        return self.timeout > 0.0 and (not self.stamp or now - self.stamp > self.timeout)


class TwistMux(Node):
    """Node with the topics and locks of its parameters."""

    def __init__(self) -> None:
        super().__init__(
            "twist_mux", allow_undeclared_parameters=True, automatically_declare_parameters_from_overrides=True
        )
        self._topics, self._locks = self._sources("topics"), self._sources("locks")
        if not self._topics:
            self.get_logger().warning("no topics: the parameters have no topics.NAME.topic, .timeout and .priority")
        if self.has_parameter("use_stamped"):
            is_stamped = bool(self.get_parameter("use_stamped").value)
        else:  # the default differs between the versions of twist_mux: follow the nodes around it
            is_stamped = self._has_stamped_end()
        kind = TwistStamped if is_stamped else Twist
        self._publisher = self.create_publisher(kind, "cmd_vel_out", 1)
        for source in self._topics:
            self.create_subscription(kind, source.topic, self._forward(source), 10)
        for source in self._locks:
            self.create_subscription(Bool, source.topic, self._lock(source), 10)

    def _sources(self, kind: str) -> list[Source]:
        """Return the sources below a parameter: a table by name, or the list of tables of ROS 1."""
        listed = ros1_parameter(self.get_fully_qualified_name(), kind)
        if isinstance(listed, list):
            return [_source(str(table.get("name", "")), table) for table in listed if "topic" in table]
        values = {name: each.value for name, each in self.get_parameters_by_prefix(kind).items()}
        tables: dict[str, dict[str, Any]] = {}
        for name, value in values.items():
            if "." in name:
                tables.setdefault(name.rpartition(".")[0], {})[name.rpartition(".")[2]] = value
        return [_source(name, table) for name, table in tables.items() if "topic" in table]

    def _has_stamped_end(self) -> bool:
        ends = [*self.get_subscriptions_info_by_topic("cmd_vel_out")]
        for source in self._topics:
            ends += self.get_publishers_info_by_topic(source.topic)
        return any(end.topic_type == "geometry_msgs/msg/TwistStamped" for end in ends)

    def _now(self) -> float:
        return float(self.get_clock().now().nanoseconds * 1e-9)

    def _lock(self, source: Source) -> Callable[[Any], None]:
        def receive(message: Any) -> None:
            source.stamp, source.is_locked = self._now(), message.data

        return receive

    def _forward(self, source: Source) -> Callable[[Any], None]:
        def receive(message: Any) -> None:
            source.stamp = self._now()
            if self._winner() is source:
                self._publisher.publish(message)

        return receive

    def _winner(self) -> Source | None:
        """Return the source whose commands are published now; None if locks mask all of them."""
        now = self._now()
        locked = max((lock.priority for lock in self._locks if lock.is_expired(now) or lock.is_locked), default=0)
        living = [source for source in self._topics if not source.is_expired(now) and source.priority >= max(locked, 1)]
        return max(living, key=lambda source: source.priority, default=None)


def _source(name: str, table: Mapping[str, Any]) -> Source:
    return Source(name, str(table["topic"]), float(table.get("timeout", 0.0)), int(table.get("priority", 0)))


def main() -> None:
    """Run the node."""
    rclpy.init()
    run(TwistMux())


if __name__ == "__main__":
    main()
