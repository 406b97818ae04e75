"""Expansion of the names of topics and services."""

from __future__ import annotations

from simkit_nodes.names import expand_name
from simkit_nodes.ros_modules.rclpy.validate_topic_name import validate_topic_name

__all__ = ["expand_topic_name"]


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """Return the absolute name of a topic or service, without remapping.

    Args:
        topic_name: name as a program writes it.
        node_name: name of the node, without its namespace.
        node_namespace: absolute namespace of the node.

    Raises:
        InvalidTopicNameException: the name is invalid.
        ValueError: the name has an unknown substitution in braces.
    """
    validate_topic_name(topic_name)
    return expand_name(topic_name, node_name, node_namespace)
