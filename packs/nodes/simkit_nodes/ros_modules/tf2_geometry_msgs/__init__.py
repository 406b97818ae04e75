"""Points, vectors, poses and polygons in other frames, as the ROS 2 package `tf2_geometry_msgs`."""

from __future__ import annotations

from simkit_nodes.interfaces import ROS2
from simkit_nodes.ros_modules.tf2_geometry_msgs.tf2_geometry_msgs import (
    do_transform_point,
    do_transform_polygon_stamped,
    do_transform_pose,
    do_transform_pose_stamped,
    do_transform_pose_with_covariance_stamped,
    do_transform_vector3,
    from_msg_msg,
    to_msg_msg,
    transform_covariance,
)

__all__ = [
    "PointStamped",
    "PoseStamped",
    "PoseWithCovarianceStamped",
    "TransformStamped",
    "Vector3Stamped",
    "do_transform_point",
    "do_transform_polygon_stamped",
    "do_transform_pose",
    "do_transform_pose_stamped",
    "do_transform_pose_with_covariance_stamped",
    "do_transform_vector3",
    "from_msg_msg",
    "to_msg_msg",
    "transform_covariance",
]

PointStamped = ROS2.message_class("geometry_msgs/msg/PointStamped")
PoseStamped = ROS2.message_class("geometry_msgs/msg/PoseStamped")
PoseWithCovarianceStamped = ROS2.message_class("geometry_msgs/msg/PoseWithCovarianceStamped")
TransformStamped = ROS2.message_class("geometry_msgs/msg/TransformStamped")
Vector3Stamped = ROS2.message_class("geometry_msgs/msg/Vector3Stamped")
