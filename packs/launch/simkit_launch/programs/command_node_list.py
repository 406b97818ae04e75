"""Commands of `ros2 node`."""

from __future__ import annotations

from command_topics import wait_a_moment
from rclpy.node import Node


def list_command(node: Node, words: list[str]) -> int:
    """Print the names of the nodes; return the exit code.

    Args:
        node: node of the command.
        words: words after `ros2`.
    """
    if words[1:2] != ["list"]:
        node.get_logger().warning(f"`ros2 {' '.join(words)}` has no effect here: use simkit {' '.join(words)}")
        return 0
    wait_a_moment(node)
    names = [name for name in node.get_fully_qualified_node_names() if not name.rpartition("/")[2].startswith("_")]
    print("\n".join(names))
    return 0
