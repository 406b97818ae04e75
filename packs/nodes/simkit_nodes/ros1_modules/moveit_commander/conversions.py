"""Poses as lists, and the other way round."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import Any

from simkit_nodes.interfaces import ROS1, ProgramMessage
from simkit_nodes.ros1_modules.moveit_commander.exception import MoveItCommanderException
from simkit_nodes.ros1_modules.rospy.rostime import Time
from simkit_nodes.rotations import quaternion_from_euler

__all__ = [
    "list_to_pose",
    "list_to_pose_stamped",
    "list_to_transform",
    "msg_from_string",
    "msg_to_string",
    "pose_to_list",
    "transform_to_list",
]


def msg_to_string(msg: Any) -> bytes:
    """Return the bytes of a message."""
    buffer = BytesIO()
    msg.serialize(buffer)
    return buffer.getvalue()


def msg_from_string(msg: Any, data: bytes) -> None:
    """Read a message from its bytes."""
    msg.deserialize(data)


def pose_to_list(pose_msg: Any) -> list[float]:
    """Return x, y, z, qx, qy, qz, qw of a pose."""
    p, q = pose_msg.position, pose_msg.orientation
    return [p.x, p.y, p.z, q.x, q.y, q.z, q.w]


def list_to_pose(pose_list: Sequence[float]) -> ProgramMessage:
    """Return the pose of x, y, z, qx, qy, qz, qw, or of x, y, z, roll, pitch, yaw.

    Raises:
        MoveItCommanderException: the list has another length.
    """
    if len(pose_list) not in (6, 7):
        lengths = "expected 6 (x, y, z, roll, pitch, yaw) or 7 (x, y, z, qx, qy, qz, qw)"
        raise MoveItCommanderException(f"the list has {len(pose_list)} numbers; {lengths}")
    pose = ROS1.message_class("geometry_msgs/msg/Pose")()
    turn = list(pose_list[3:])
    if len(turn) == 3:
        turn = list(quaternion_from_euler(turn[0], turn[1], turn[2]))
    p, q = pose.position, pose.orientation
    p.x, p.y, p.z = (float(value) for value in pose_list[:3])
    q.x, q.y, q.z, q.w = (float(value) for value in turn)
    return pose


def list_to_pose_stamped(pose_list: Sequence[float], target_frame: str) -> ProgramMessage:
    """Return the pose of a list (see `list_to_pose`) in a frame, at the present time."""
    stamped = ROS1.message_class("geometry_msgs/msg/PoseStamped")()
    stamped.pose = list_to_pose(pose_list)
    stamped.header.frame_id, stamped.header.stamp = target_frame, Time.now()
    return stamped


def transform_to_list(trf_msg: Any) -> list[float]:
    """Return x, y, z, qx, qy, qz, qw of a transform."""
    t, q = trf_msg.translation, trf_msg.rotation
    return [t.x, t.y, t.z, q.x, q.y, q.z, q.w]


def list_to_transform(trf_list: Sequence[float]) -> ProgramMessage:
    """Return the transform of x, y, z, qx, qy, qz, qw."""
    transform = ROS1.message_class("geometry_msgs/msg/Transform")()
    t, q = transform.translation, transform.rotation
    t.x, t.y, t.z, q.x, q.y, q.z, q.w = (float(value) for value in trf_list)
    return transform
