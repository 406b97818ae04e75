"""Sender of transforms to `/tf`."""

from __future__ import annotations

from collections.abc import Sequence

from simkit_nodes.interfaces import ROS1, ProgramMessage
from simkit_nodes.ros1_modules import tf2_ros

__all__ = ["TransformBroadcaster"]


class TransformBroadcaster:
    """Sender of transforms.

    Args:
        queue_size: accepted as in ROS.
    """

    def __init__(self, queue_size: int = 100) -> None:
        self.tf2_broadcaster = tf2_ros.TransformBroadcaster()

    def sendTransform(
        self, translation: Sequence[float], rotation: Sequence[float], time: object, child: str, parent: str
    ) -> None:
        """Send the pose of a frame.

        Args:
            translation: position x, y, z [m].
            rotation: quaternion x, y, z, w.
            time: time of the pose.
            child: frame with this pose.
            parent: frame in which the pose is given.
        """
        message: ProgramMessage = ROS1.message_class("geometry_msgs/msg/TransformStamped")()
        message.header.frame_id, message.header.stamp, message.child_frame_id = parent, time, child
        base, turn = message.transform.translation, message.transform.rotation
        base.x, base.y, base.z = (translation[index] for index in range(3))
        turn.x, turn.y, turn.z, turn.w = (rotation[index] for index in range(4))
        self.sendTransformMessage(message)

    def sendTransformMessage(self, transform: object) -> None:
        """Send a `geometry_msgs.msg.TransformStamped`."""
        self.tf2_broadcaster.sendTransform([transform])
