"""Poses as frames of `PyKDL`, and the other way round."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from simkit_nodes.interfaces import ROS1, ProgramMessage
from simkit_nodes.ros_modules.PyKDL.frames import Frame, Rotation, Vector

__all__ = ["fromCameraParams", "fromMatrix", "fromMsg", "fromTf", "toMatrix", "toMsg", "toTf"]


def fromTf(tf: Any) -> Frame:
    """Return the frame of a position and a quaternion (x, y, z, w)."""
    position, quaternion = tf
    return Frame(Rotation.Quaternion(*quaternion), Vector(*position))


def toTf(f: Frame) -> tuple[tuple[float, float, float], tuple[float, float, float, float]]:
    """Return the position and the quaternion (x, y, z, w) of a frame."""
    return (f.p[0], f.p[1], f.p[2]), f.M.GetQuaternion()


def fromMsg(p: Any) -> Frame:
    """Return the frame of a `geometry_msgs.msg.Pose`."""
    q = p.orientation
    return Frame(Rotation.Quaternion(q.x, q.y, q.z, q.w), Vector(p.position.x, p.position.y, p.position.z))


def toMsg(f: Frame) -> Any:
    """Return a frame as a `geometry_msgs.msg.Pose`."""
    pose: ProgramMessage = ROS1.message_class("geometry_msgs/msg/Pose")()
    pose.position.x, pose.position.y, pose.position.z = f.p
    q = pose.orientation
    q.x, q.y, q.z, q.w = f.M.GetQuaternion()
    return pose


def fromMatrix(m: Any) -> Frame:
    """Return the frame of a 4 × 4 matrix."""
    return Frame(
        Rotation(*(m[row][column] for row in range(3) for column in range(3))), Vector(*(row[3] for row in m[:3]))
    )


def toMatrix(f: Frame) -> npt.NDArray[np.float64]:
    """Return a frame as a 4 × 4 matrix."""
    rows = [[f[row, column] for column in range(4)] for row in range(3)]
    return np.array([*rows, [0.0, 0.0, 0.0, 1.0]])


def fromCameraParams(cv: Any, rvec: Any, tvec: Any) -> Frame:
    """Return the frame of a rotation vector and a position of OpenCV; `cv` has no effect."""
    turn = Vector(*(float(value) for value in np.ravel(rvec)))
    return Frame(Rotation.Rot(turn, turn.Norm()), Vector(*(float(value) for value in np.ravel(tvec))))
