"""Sender of transforms to `/tf`."""

from __future__ import annotations

from typing import Any

from simkit_nodes.interfaces import ROS2
from simkit_nodes.ros_modules.rclpy.qos import QoSProfile

__all__ = ["TransformBroadcaster"]

_TFMessage = ROS2.message_class("tf2_msgs/msg/TFMessage")


class TransformBroadcaster:
    """Sender of transforms.

    Args:
        node: node that publishes.
        qos: quality of service.
    """

    def __init__(self, node: Any, qos: Any = None) -> None:
        self.pub_tf = node.create_publisher(_TFMessage, "/tf", QoSProfile(depth=100) if qos is None else qos)

    def sendTransform(self, transform: object) -> None:
        """Send a `geometry_msgs.msg.TransformStamped` or several."""
        self.pub_tf.publish(_TFMessage(transforms=transforms_of(transform)))


def transforms_of(transform: object) -> list[Any]:
    """Return a transform, or several, as a list."""
    return list(transform) if hasattr(transform, "__iter__") else [transform]
