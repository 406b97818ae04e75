"""Commands of ROS 1 in a launch file: `rostopic` and `rosservice`, also as nodes of packages with these names."""

from __future__ import annotations

import sys
from pathlib import PurePath

import rclpy
from command_services import service_command
from command_topics import topic_command
from rclpy.node import Node
from rclpy.utilities import remove_ros_args


def main() -> int:
    """Run the command that the name of the executable names."""
    rclpy.init()
    name = PurePath(sys.argv[0]).name
    node = Node(name)
    words = [name, *(word for word in remove_ros_args(sys.argv)[1:] if not word.startswith("__"))]
    try:
        return service_command(node, words) if name == "rosservice" else topic_command(node, words)
    except KeyboardInterrupt:
        return 0


if __name__ == "__main__":
    sys.exit(main())
