"""Points, vectors, poses and wrenches in other frames, as the ROS 1 package `tf2_geometry_msgs`."""

from __future__ import annotations

from simkit_nodes.interfaces import ROS1
from simkit_nodes.message_transforms import same_message as from_msg_msg
from simkit_nodes.message_transforms import same_message as to_msg_msg
from simkit_nodes.message_transforms import transformed_point as do_transform_point
from simkit_nodes.message_transforms import transformed_pose_stamped as do_transform_pose
from simkit_nodes.message_transforms import transformed_vector as do_transform_vector3
from simkit_nodes.message_transforms import transformed_wrench_stamped as do_transform_wrench

__all__ = [
    "PointStamped",
    "PoseStamped",
    "TransformStamped",
    "Vector3Stamped",
    "WrenchStamped",
    "do_transform_point",
    "do_transform_pose",
    "do_transform_vector3",
    "do_transform_wrench",
    "from_msg_msg",
    "to_msg_msg",
]

PointStamped = ROS1.message_class("geometry_msgs/msg/PointStamped")
PoseStamped = ROS1.message_class("geometry_msgs/msg/PoseStamped")
TransformStamped = ROS1.message_class("geometry_msgs/msg/TransformStamped")
Vector3Stamped = ROS1.message_class("geometry_msgs/msg/Vector3Stamped")
WrenchStamped = ROS1.message_class("geometry_msgs/msg/WrenchStamped")
