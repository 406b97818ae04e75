"""Sender of transforms to `/tf`."""

from __future__ import annotations

from simkit_nodes.interfaces import ROS1
from simkit_nodes.ros1_modules.rospy.topics import Publisher

__all__ = ["TransformBroadcaster"]

_TFMessage = ROS1.message_class("tf2_msgs/msg/TFMessage")


class TransformBroadcaster:
    """Sender of transforms."""

    def __init__(self) -> None:
        self.pub_tf = Publisher("/tf", _TFMessage, queue_size=100)

    def sendTransform(self, transform: object) -> None:
        """Send a `geometry_msgs.msg.TransformStamped` or a list of them."""
        self.pub_tf.publish(_TFMessage(transform if isinstance(transform, list) else [transform]))
