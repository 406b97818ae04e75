"""turtlesim's mimic: commands the velocity of one turtle to another one."""

from __future__ import annotations

from typing import Any

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from republisher import run
from turtlesim.msg import Pose


class Mimic(Node):
    """Node that publishes the velocities of each pose on `input/pose` as a command on `output/cmd_vel`."""

    def __init__(self) -> None:
        super().__init__("turtle_mimic")
        self._publisher = self.create_publisher(Twist, self._topic("output", "cmd_vel"), 1)
        self.create_subscription(Pose, self._topic("input", "pose"), self._follow, 1)

    def _topic(self, group: str, name: str) -> str:
        """Return a topic of a group; ROS 1 remaps the name of the group, ROS 2 that of the topic."""
        changed = self.resolve_topic_name(group)
        is_same = changed == self.resolve_topic_name(group, only_expand=True)
        return f"{group}/{name}" if is_same else f"{changed}/{name}"

    def _follow(self, pose: Any) -> None:
        command = Twist()
        command.linear.x, command.angular.z = pose.linear_velocity, pose.angular_velocity
        self._publisher.publish(command)


def main() -> None:
    """Run the node."""
    rclpy.init()
    run(Mimic())


if __name__ == "__main__":
    main()
