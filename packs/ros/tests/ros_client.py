"""Programs of ROS nodes in these tests, in the Python of ROS: `ros_client.py CODE` prints one JSON value."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import Any

import rclpy
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile

TIMEOUT = 30.0
LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Client:
    """A node and what it has received."""

    def __init__(self, name: str = "client") -> None:
        rclpy.init()
        self.node = rclpy.create_node(name, parameter_overrides=[Parameter("use_sim_time", value=True)])
        self.received: dict[str, list[Any]] = {}

    def hear(self, topic: str, cls: Any, qos: Any = 10, raw: bool = False) -> list[Any]:
        found = self.received.setdefault(topic, [])
        self.node.create_subscription(cls, topic, found.append, qos, raw=raw)
        return found

    def until(self, condition: Callable[[], Any]) -> Any:
        """What the condition returns, once it is true."""
        end = time.monotonic() + TIMEOUT
        while not (found := condition()):
            rclpy.spin_once(self.node, timeout_sec=0.02)
            if time.monotonic() > end:
                raise TimeoutError(
                    f"nothing after {TIMEOUT} s; received { ({k: len(v) for k, v in self.received.items()}) }"
                )
        return found

    def publish_until(self, publisher: Any, message: Any, condition: Callable[[], Any]) -> Any:
        """Publish at about 20 Hz until a condition is true."""
        timer = self.node.create_timer(0.05, lambda: publisher.publish(message), clock=rclpy.clock.Clock())
        try:
            return self.until(condition)
        finally:
            self.node.destroy_timer(timer)

    def result(self, future: Any) -> Any:
        self.until(future.done)
        return future.result()

    def call(self, cls: Any, name: str, request: Any = None) -> Any:
        client = self.node.create_client(cls, name)
        self.until(client.service_is_ready)
        return self.result(client.call_async(request or cls.Request()))


def tell(value: Any) -> None:
    print("answer " + json.dumps(value), flush=True)  # noqa: T201 - for the test


if __name__ == "__main__":
    exec(compile(sys.argv[1], "<client>", "exec"))
