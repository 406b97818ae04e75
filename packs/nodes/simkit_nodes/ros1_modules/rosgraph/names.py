"""Names of ROS 1: global `/a/b`, relative `a/b` and private `~a`, and their remapping on a command line."""

from __future__ import annotations

from simkit_nodes import ros1_names
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node
from simkit_nodes.ros1_names import *  # noqa: F403 - the module has the same names

__all__ = [*ros1_names.__all__, "anonymous_name"]


def anonymous_name(id: str) -> str:
    """Return a name that no other node has."""
    return ros_node().anonymous_name(id)
