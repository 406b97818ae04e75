"""Points, vectors, poses and polygons in other frames."""

from __future__ import annotations

from typing import Final

from simkit_nodes.message_transforms import Transforms
from simkit_nodes.message_transforms import same_message as from_msg_msg
from simkit_nodes.message_transforms import same_message as to_msg_msg
from simkit_nodes.message_transforms import transformed_covariance as transform_covariance
from simkit_nodes.message_transforms import transformed_point as do_transform_point
from simkit_nodes.message_transforms import transformed_polygon_stamped as do_transform_polygon_stamped
from simkit_nodes.message_transforms import transformed_pose as do_transform_pose
from simkit_nodes.message_transforms import transformed_pose_stamped as do_transform_pose_stamped
from simkit_nodes.message_transforms import (
    transformed_pose_with_covariance_stamped as do_transform_pose_with_covariance_stamped,
)
from simkit_nodes.message_transforms import transformed_vector as do_transform_vector3

__all__ = [
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

TRANSFORMS: Final[Transforms] = {
    "geometry_msgs/msg/PointStamped": do_transform_point,
    "geometry_msgs/msg/PolygonStamped": do_transform_polygon_stamped,
    "geometry_msgs/msg/PoseStamped": do_transform_pose_stamped,
    "geometry_msgs/msg/PoseWithCovarianceStamped": do_transform_pose_with_covariance_stamped,
    "geometry_msgs/msg/Vector3Stamped": do_transform_vector3,
}
