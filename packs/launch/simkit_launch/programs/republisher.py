"""Base class of nodes that publish the messages of a topic again, whatever type the topic has."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import rclpy
from node_values import value_of
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosidl_runtime_py.utilities import get_message

PERIOD = 0.1
"""Period with which a node looks for the publishers of its input [s]."""


class Republisher(Node):
    """Node that reads a topic and publishes another one with the type and the quality of service of the first.

    The publisher is made when the input has a publisher. A lazy node subscribes only while somebody reads the output.

    Attributes:
        input_topic, output_topic: names of the topics; no input if it is empty.
        is_lazy: True to read only while the output has a subscription.
        publisher: publisher of the output; None until the input has a publisher.
    """

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.input_topic: str = ""
        self.output_topic: str = ""
        self.is_lazy = False
        self.publisher: Any = None
        self._subscription: Any = None
        self._source: tuple[str, str, Any] | None = None
        self.create_timer(PERIOD, self.look_for_source)

    def read_topics(self, words: Sequence[str], suffix: str) -> list[str]:
        """Read the input, the output and `lazy` from the command line or from parameters.

        Args:
            words: words of the command line: the input and the output.
            suffix: ending of the default name of the output.

        Returns:
            The words after the input.
        """
        self.input_topic = self.value("input_topic", words[0] if words else "")
        if not self.input_topic:
            self.get_logger().error("the parameter input_topic is not set")
            raise SystemExit(1)
        self.output_topic = self.value("output_topic", f"{self.input_topic}{suffix}")
        self.is_lazy = self.value("lazy", False)
        return list(words[1:])

    def value(self, name: str, default: Any) -> Any:
        """Declare a parameter and return its value."""
        return value_of(self, name, default)

    def number(self, name: str, default: float) -> float:
        """Declare a parameter, which may be an integer or a float, and return its value."""
        return float(value_of(self, name, default))

    def process(self, message: Any) -> None:
        """Publish a message of the input; derived classes change, delay or drop it."""
        if self.publisher is not None:
            self.publisher.publish(message)

    def look_for_source(self) -> None:
        """Subscribe to the input if it has a publisher, and end a subscription that is not wanted any more."""
        source = self._find_source()
        if source is None:
            self._unsubscribe()
            return
        topic, kind, qos = source
        if source != self._source:
            self._unsubscribe()
            self._source = source
            self._publish_on(self.output_topic, kind, qos)
        if self.is_lazy and not self.publisher.get_subscription_count():
            self._unsubscribe()
        elif self._subscription is None:
            self._subscription = self.create_subscription(get_message(kind), topic, self.receive, qos)

    def receive(self, message: Any) -> None:
        """Take a message of the input."""
        self.process(message)

    def renew_publisher(self) -> None:
        """Publish on the present output topic after a change of its name."""
        if self._source is not None and self.output_topic != "__none":
            self._publish_on(self.output_topic, *self._source[1:])

    def _publish_on(self, topic: str, kind: str, qos: Any) -> None:
        if self.publisher is not None:
            self.destroy_publisher(self.publisher)
        self.publisher = self.create_publisher(get_message(kind), topic, qos)

    def _unsubscribe(self) -> None:
        if self._subscription is not None:
            self.destroy_subscription(self._subscription)
            self._subscription = None

    def _find_source(self) -> tuple[str, str, Any] | None:
        """Return the topic, the type and the quality of service of the input; None if it has no publisher."""
        if not self.input_topic:
            return None
        own = f"{self.get_namespace().rstrip('/')}/{self.get_name()}"
        ends = self.get_publishers_info_by_topic(self.input_topic)
        ends = [end for end in ends if f"{end.node_namespace.rstrip('/')}/{end.node_name}" != own]
        if not ends:
            return None
        profiles = [end.qos_profile for end in ends]
        qos = QoSProfile(depth=10)
        if any(profile.reliability != ReliabilityPolicy.RELIABLE for profile in profiles):
            qos.reliability = ReliabilityPolicy.BEST_EFFORT
        if all(profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for profile in profiles):
            qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
        return self.input_topic, ends[0].topic_type, qos


def run(node: Node) -> None:
    """Run a node to the end of the run."""
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
