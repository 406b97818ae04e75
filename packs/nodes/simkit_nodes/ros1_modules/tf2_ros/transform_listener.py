"""Listener that stores the transforms of `/tf` and `/tf_static` in a buffer."""

from __future__ import annotations

from typing import Any, Final

from simkit_nodes.interfaces import ROS1
from simkit_nodes.ros1_modules.rospy.topics import Subscriber
from simkit_nodes.ros1_modules.tf2_py import BufferCore

__all__ = ["TransformListener"]

_TFMessage = ROS1.message_class("tf2_msgs/msg/TFMessage")
_NO_SENDER: Final = "unknown_publisher"


class TransformListener:
    """Listener of transforms.

    Args:
        buffer: buffer that stores the transforms.
        queue_size: largest number of messages that wait.
        buff_size: accepted as in ROS.
        tcp_nodelay: accepted as in ROS.
    """

    def __init__(
        self, buffer: BufferCore, queue_size: int | None = None, buff_size: int = 65536, tcp_nodelay: bool = False
    ) -> None:
        self.buffer = buffer
        self.tf_sub = Subscriber("/tf", _TFMessage, self.callback, queue_size=queue_size)
        self.tf_static_sub = Subscriber("/tf_static", _TFMessage, self.static_callback, queue_size=queue_size)

    def unregister(self) -> None:
        """Stop listening."""
        self.tf_sub.unregister()
        self.tf_static_sub.unregister()

    def callback(self, data: Any) -> None:
        """Store the transforms of a message of `/tf`."""
        who = data._connection_header.get("callerid", _NO_SENDER)
        for transform in data.transforms:
            self.buffer.set_transform(transform, who)

    def static_callback(self, data: Any) -> None:
        """Store the transforms of a message of `/tf_static`."""
        who = data._connection_header.get("callerid", _NO_SENDER)
        for transform in data.transforms:
            self.buffer.set_transform_static(transform, who)
