"""Poses in the plane, from and to messages and transforms."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from simkit import Pose, msgs
from simkit.errors import ArgumentValueError, TransformError
from simkit.linear_algebra import matmul
from simkit.pose import rpy_from_quat, wrap_angle

if TYPE_CHECKING:
    from simkit import Simulation

Floats = npt.NDArray[np.float64]


class PlanarPose(NamedTuple):
    """Pose in the plane: x and y [m], yaw [rad]."""

    x: float
    y: float
    yaw: float

    def compose(self, other: PlanarPose) -> PlanarPose:
        """Return a pose that is given relative to this one in the frame of this one."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        x, y = self.x + cos * other.x - sin * other.y, self.y + sin * other.x + cos * other.y
        return PlanarPose(x, y, wrap_angle(self.yaw + other.yaw))

    def inverse(self) -> PlanarPose:
        """Return the pose of this pose's frame relative to this pose."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return PlanarPose(-cos * self.x - sin * self.y, sin * self.x - cos * self.y, -self.yaw)

    def distance(self, other: PlanarPose) -> float:
        """Return the distance between the positions of two poses [m]."""
        return math.hypot(self.x - other.x, self.y - other.y)

    def transform(self, points: Floats) -> Floats:
        """Return points of this pose's frame, shape (n, 2) [m], in the frame in which this pose is given."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        moved: Floats = matmul(points, np.array([[cos, sin], [-sin, cos]])) + np.array((self.x, self.y))
        return moved


def planar_of(pose: Pose) -> PlanarPose:
    """Return the part of a pose in the plane."""
    x, y, _ = pose.position.tolist()
    return PlanarPose(x, y, float(pose.rpy[2]))


def pose_of_message(message: msgs.Pose) -> PlanarPose | None:
    """Return the part of a `geometry_msgs/msg/Pose` in the plane; None if a number is NaN or infinite."""
    place, turn = message.position, message.orientation
    quaternion = (turn.w, turn.x, turn.y, turn.z)
    if not all(map(math.isfinite, (place.x, place.y, *quaternion))):
        return None
    yaw = float(rpy_from_quat(quaternion)[2]) if any(quaternion) else 0.0
    return PlanarPose(float(place.x), float(place.y), yaw)


def yaw_of(turn: msgs.Quaternion) -> float:
    """Return the yaw of a quaternion [rad]; 0 for one whose numbers are all 0."""
    return math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y**2 + turn.z**2))


def stamped_pose(pose: PlanarPose, header: msgs.Header) -> msgs.PoseStamped:
    """Return a `geometry_msgs/msg/PoseStamped`."""
    return msgs.PoseStamped(header, pose_message(pose))


def pose_message(pose: PlanarPose, z: float = 0.0) -> msgs.Pose:
    """Return a `geometry_msgs/msg/Pose` at a height [m]."""
    turn = msgs.Quaternion(0.0, 0.0, math.sin(pose.yaw / 2), math.cos(pose.yaw / 2))
    return msgs.Pose(msgs.Point(pose.x, pose.y, z), turn)


def path_message(poses: Floats, header: msgs.Header) -> msgs.Path:
    """Return a `nav_msgs/msg/Path` of poses: x, y [m] and yaw [rad], shape (n, 3)."""
    return msgs.Path(header, [stamped_pose(PlanarPose(*row), header) for row in poses.tolist()])


def poses_of_path(path: msgs.Path) -> Floats | None:
    """Return x, y [m] and yaw [rad] of the poses of a path, shape (n, 3); None if a number is NaN or infinite."""
    poses = [pose_of_message(stamped.pose) for stamped in path.poses]
    return None if None in poses else np.array(poses, np.float64).reshape(-1, 3)


def look_up(sim: Simulation, target: str, source: str, stamp: msgs.Time | None = None) -> PlanarPose | None:
    """Return the pose of the frame `source` in the frame `target`; None if it is not known.

    Args:
        sim: simulation.
        target: frame in which the pose is given.
        source: frame whose pose is returned.
        stamp: time of the pose; None for the newest one.
    """
    if target == source:
        return PlanarPose(0.0, 0.0, 0.0)
    try:
        return planar_of(sim.tf.lookup(target, source, stamp))
    except (TransformError, ArgumentValueError):  # a message may name no frame
        return None
