"""Types of topics of ROS 1."""

from __future__ import annotations

from typing import Any

from simkit_nodes.ros1_modules.roslib.message import get_message_class
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node

__all__ = ["ROSTopicException", "get_topic_class", "get_topic_type"]


class ROSTopicException(Exception):
    """The type of a topic is unknown."""


def get_topic_type(topic: str, blocking: bool = False) -> tuple[str | None, str | None, None]:
    """Return the type of a topic, its global name, and None.

    Args:
        topic: name of the topic.
        blocking: True to wait until the topic exists.
    """
    node = ros_node()
    name = node.resolve(topic)
    if blocking:
        node.wait(None, lambda: name in node.host.graph.topics())
    types = node.host.graph.topics().get(name)
    return (types[0].replace("/msg/", "/"), name, None) if types else (None, None, None)


def get_topic_class(topic: str, blocking: bool = False) -> tuple[type[Any] | None, str | None, None]:
    """Return the class of the messages of a topic, its global name, and None; see `get_topic_type`.

    Raises:
        ROSTopicException: the type of the topic is unknown.
    """
    kind, name, _ = get_topic_type(topic, blocking)
    if kind is None:
        return None, None, None
    cls = get_message_class(kind)
    if cls is None:
        raise ROSTopicException(f"Cannot load message class for [{kind}]. Are your messages built?")
    return cls, name, None
