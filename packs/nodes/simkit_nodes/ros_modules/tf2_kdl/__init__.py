"""Objects of `PyKDL` in other frames, as the package `tf2_kdl`."""

from __future__ import annotations

from simkit_nodes.ros_modules.tf2_kdl.tf2_kdl import (
    convert_vector,
    do_transform_frame,
    do_transform_twist,
    do_transform_vector,
    do_transform_wrench,
    from_msg_vector,
    to_msg_vector,
    transform_to_kdl,
)

__all__ = [
    "convert_vector",
    "do_transform_frame",
    "do_transform_twist",
    "do_transform_vector",
    "do_transform_wrench",
    "from_msg_vector",
    "to_msg_vector",
    "transform_to_kdl",
]
