"""turtlesim's draw_square: drives a turtle round a square."""

from __future__ import annotations

import math
from typing import Any

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from republisher import run
from std_srvs.srv import Empty
from turtlesim.msg import Pose

SIDE = 2.0
"""Side of the square [m]."""

SPEED = 1.0
"""Speed along a side [m/s]."""

TURNING_SPEED = 0.4
"""Speed of a turn [rad/s]."""


class DrawSquare(Node):
    """Node that drives along a side, stops, turns by 90°, stops, and goes on."""

    def __init__(self) -> None:
        super().__init__("draw_square")
        self._pose: Any = None
        self._goal: tuple[float, float, float] | None = None
        self._is_turning = self._is_stopping = False
        self._publisher = self.create_publisher(Twist, "turtle1/cmd_vel", 1)
        self.create_subscription(Pose, "turtle1/pose", self._receive, 1)
        self._reset = self.create_client(Empty, "reset")
        self._timer = self.create_timer(0.016, self._start)

    def _receive(self, pose: Any) -> None:
        self._pose = pose

    def _start(self) -> None:
        """Wipe the window as soon as the service exists, then drive."""
        if not self._reset.service_is_ready():
            return
        self.destroy_timer(self._timer)
        self._reset.call_async(Empty.Request()).add_done_callback(self._begin)

    def _begin(self, _: Any) -> None:
        self._pose = None
        self._timer = self.create_timer(0.016, self._drive)

    def _command(self, linear: float = 0.0, angular: float = 0.0) -> None:
        command = Twist()
        command.linear.x, command.angular.z = linear, angular
        self._publisher.publish(command)

    def _drive(self) -> None:
        pose = self._pose
        if pose is None:
            return
        if self._goal is None:
            self._set_goal(is_turning=False)
        if self._is_stopping:
            if abs(pose.linear_velocity) < 1e-4 and abs(pose.angular_velocity) < 1e-4:
                self.get_logger().info("Reached goal")
                self._is_stopping = False
                self._set_goal(is_turning=not self._is_turning)
            else:
                self._command()
        elif self._is_at_goal():
            self._is_stopping = True
            self._command()
        elif self._is_turning:
            self._command(angular=TURNING_SPEED)
        else:
            self._command(linear=SPEED)

    def _set_goal(self, *, is_turning: bool) -> None:
        pose, self._is_turning = self._pose, is_turning
        if is_turning:
            theta = (pose.theta + math.pi / 2 + math.pi) % (2 * math.pi) - math.pi
            self._goal = (pose.x, pose.y, theta)
        else:
            x, y = pose.x + SIDE * math.cos(pose.theta), pose.y + SIDE * math.sin(pose.theta)
            self._goal = (x, y, pose.theta)
        self.get_logger().info("New goal [{:f} {:f}, {:f}]".format(*self._goal))

    def _is_at_goal(self) -> bool:
        assert self._goal is not None
        x, y, theta = self._goal
        pose = self._pose
        return abs(pose.x - x) < 0.1 and abs(pose.y - y) < 0.1 and abs(pose.theta - theta) < 0.01


def main() -> None:
    """Run the node."""
    rclpy.init()
    run(DrawSquare())


if __name__ == "__main__":
    main()
