"""Points, vectors, poses and wrenches in other frames."""

from __future__ import annotations

from simkit_nodes.ros1_modules.tf2_geometry_msgs import (
    do_transform_point,
    do_transform_pose,
    do_transform_vector3,
    do_transform_wrench,
    from_msg_msg,
    to_msg_msg,
)

__all__ = [
    "do_transform_point",
    "do_transform_pose",
    "do_transform_vector3",
    "do_transform_wrench",
    "from_msg_msg",
    "to_msg_msg",
]
