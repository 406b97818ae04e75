"""Sender of transforms to `/tf_static`."""

from __future__ import annotations

from typing import Any

from simkit_nodes.interfaces import ROS2
from simkit_nodes.ros_modules.rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from simkit_nodes.ros_modules.tf2_ros.transform_broadcaster import transforms_of

__all__ = ["StaticTransformBroadcaster"]

_TFMessage = ROS2.message_class("tf2_msgs/msg/TFMessage")


class StaticTransformBroadcaster:
    """Sender of transforms that are valid at all times. Each message has all of them, for later subscribers.

    Args:
        node: node that publishes.
        qos: quality of service.
    """

    def __init__(self, node: Any, qos: Any = None) -> None:
        if qos is None:
            qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, history=HistoryPolicy.KEEP_LAST)
        self.pub_tf = node.create_publisher(_TFMessage, "/tf_static", qos)
        self.net_message = _TFMessage()

    def sendTransform(self, transform: object) -> None:
        """Send a `geometry_msgs.msg.TransformStamped` or several.

        As in Jazzy, the first transform of a frame stays: a later one is not sent.
        """
        children = {sent.child_frame_id for sent in self.net_message.transforms}
        for new in transforms_of(transform):
            if new.child_frame_id not in children:
                children.add(new.child_frame_id)
                self.net_message.transforms.append(new)
        self.pub_tf.publish(self.net_message)
