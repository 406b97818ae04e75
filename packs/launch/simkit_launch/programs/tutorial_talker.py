"""Talkers and listeners of ROS' tutorials: demo_nodes_cpp, demo_nodes_py, roscpp_tutorials and rospy_tutorials."""

from __future__ import annotations

import sys
from typing import Any

import rclpy
from rclpy.node import Node
from republisher import run
from std_msgs.msg import String


class Talker(Node):
    """Node that publishes a counted text on `chatter` each period [s]."""

    def __init__(self, period: float) -> None:
        super().__init__("talker")
        self._count = 0
        self._publisher = self.create_publisher(String, "chatter", 10)
        self.create_timer(period, self._publish)

    def _publish(self) -> None:
        self._count += 1
        text = f"Hello World: {self._count}"
        self.get_logger().info(f"Publishing: '{text}'")
        self._publisher.publish(String(data=text))


class Listener(Node):
    """Node that prints the texts of `chatter`."""

    def __init__(self) -> None:
        super().__init__("listener")
        self.create_subscription(String, "chatter", self._show, 10)

    def _show(self, message: Any) -> None:
        self.get_logger().info(f"I heard: [{message.data}]")


def main() -> None:
    """Run the node that the name of the executable names."""
    rclpy.init()
    package, _, name = sys.argv[0].partition("/")
    run(Listener() if "listener" in name.lower() else Talker(0.1 if "tutorials" in package else 1.0))


if __name__ == "__main__":
    main()
