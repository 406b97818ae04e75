"""Nodes of ROS 1 by name."""

from __future__ import annotations

from simkit_nodes.ros1_modules.rospy.ros_node import ros_node

__all__ = ["ROSNodeException", "ROSNodeIOException", "get_node_names", "rosnode_ping"]


class ROSNodeException(Exception):
    """A question about a node has no answer."""


class ROSNodeIOException(ROSNodeException):
    """The master does not answer; here it always does."""


def get_node_names(namespace: str | None = None) -> list[str]:
    """Return the names of all nodes, or of those below a namespace."""
    return [name for name in ros_node().host.graph.nodes() if namespace is None or name.startswith(namespace)]


def rosnode_ping(node_name: str, max_count: int | None = None, verbose: bool = False, skip_cache: bool = False) -> bool:
    """Check whether a node runs."""
    return ros_node().resolve(node_name) in get_node_names()
