"""Sender of transforms to `/tf_static`."""

from __future__ import annotations

from typing import Any

from simkit_nodes.interfaces import ROS1, ProgramMessage
from simkit_nodes.ros1_modules.rospy.topics import Publisher

__all__ = ["StaticTransformBroadcaster"]

_TFMessage = ROS1.message_class("tf2_msgs/msg/TFMessage")


class StaticTransformBroadcaster:
    """Sender of transforms that are valid at all times. Each message has all of them, for later subscribers."""

    def __init__(self) -> None:
        self.pub_tf = Publisher("/tf_static", _TFMessage, queue_size=100, latch=True)
        self._sent: dict[str, Any] = {}

    def sendTransform(self, transform: ProgramMessage) -> None:
        """Send a `geometry_msgs.msg.TransformStamped` or a list of them; the newest one of a frame counts."""
        for new in transform if isinstance(transform, list) else [transform]:
            self._sent[new.child_frame_id] = new
        self.pub_tf.publish(_TFMessage(list(self._sent.values())))
