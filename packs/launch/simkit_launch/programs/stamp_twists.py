"""twist_stamper and twist_unstamper: add a time to velocity commands, or take it away."""

from __future__ import annotations

import sys
from pathlib import PurePath
from typing import Any

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node
from republisher import run


class Stamper(Node):
    """Node that publishes each Twist of `cmd_vel_in` with the present time on `cmd_vel_out`."""

    def __init__(self) -> None:
        super().__init__("twist_stamper")
        self._frame = str(self.declare_parameter("frame_id", "").value)
        self._publisher = self.create_publisher(TwistStamped, "cmd_vel_out", 10)
        self.create_subscription(Twist, "cmd_vel_in", self._publish, 10)

    def _publish(self, twist: Any) -> None:
        message = TwistStamped(twist=twist)
        message.header.stamp, message.header.frame_id = self.get_clock().now().to_msg(), self._frame
        self._publisher.publish(message)


class Unstamper(Node):
    """Node that publishes the Twist of each TwistStamped of `cmd_vel_in` on `cmd_vel_out`."""

    def __init__(self) -> None:
        super().__init__("twist_unstamper")
        self._publisher = self.create_publisher(Twist, "cmd_vel_out", 10)
        self.create_subscription(TwistStamped, "cmd_vel_in", self._publish, 10)

    def _publish(self, message: Any) -> None:
        self._publisher.publish(message.twist)


def main() -> None:
    """Run the node that the name of the executable names."""
    rclpy.init()
    run(Unstamper() if "unstamper" in PurePath(sys.argv[0]).name else Stamper())


if __name__ == "__main__":
    main()
