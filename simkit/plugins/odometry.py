"""What wheeled bases share: dead reckoning from wheel travel, and the messages that carry it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit import msgs
from simkit.pose import Pose, Vector, quat_from_rpy

if TYPE_CHECKING:
    from simkit.runtime import Joint, Link, Model

ODOMETRY = "nav_msgs/msg/Odometry"
TRANSFORMS = "tf2_msgs/msg/TFMessage"
COMMAND_TYPES = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
_UNKNOWN = 1e12  # variance of what a planar base does not measure, as Gazebo writes it


@dataclass(slots=True)
class DeadReckoning:
    """Planar pose of the point between two wheels, from how far each has rolled: x, y [m], yaw [rad]."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def advance(self, left: float, right: float, separation: float) -> None:
        """Rolls on along an arc of constant curvature.

        Args:
            left, right: distance rolled by each wheel [m].
            separation: between the wheels [m].
        """
        distance, turn = (left + right) / 2, (right - left) / separation
        half = turn / 2
        # chord of the arc; the series keeps full precision where sin(x)/x would lose it
        chord = distance * (math.sin(half) / half if abs(half) > 1e-4 else 1 - half * half / 6)
        self.x += chord * math.cos(self.yaw + half)
        self.y += chord * math.sin(self.yaw + half)
        self.yaw += turn

    @property
    def pose(self) -> Pose:
        return Pose((self.x, self.y, 0.0), quat_from_rpy(0.0, 0.0, self.yaw))


@dataclass(frozen=True, slots=True)
class BodyTwist:
    """Velocities in the body's own axes: linear [m/s] and angular [rad/s], each (x, y, z)."""

    linear: Sequence[float] | Vector = (0.0, 0.0, 0.0)
    angular: Sequence[float] | Vector = (0.0, 0.0, 0.0)


def rolling_twist(wheels: Sequence[Joint], radius: float, separation: float) -> BodyTwist:
    """What the turning of the first two wheels, left and right, says of the body between them; lengths m."""
    left, right = (float(wheel.velocity) * radius for wheel in wheels[:2])
    return BodyTwist(((left + right) / 2, 0.0, 0.0), (0.0, 0.0, (right - left) / separation))


def command_of(message: Any) -> tuple[float, float] | None:
    """Forward speed [m/s] and turning rate [rad/s] of a Twist or TwistStamped; None unless both are finite."""
    twist = getattr(message, "twist", message)
    forward, turn = float(twist.linear.x), float(twist.angular.z)
    return (forward, turn) if math.isfinite(forward) and math.isfinite(turn) else None


def true_state(model: Model, canonical: Link) -> tuple[Pose, BodyTwist]:
    """World pose of a model's frame, and that frame's velocity in its own axes.

    Args:
        model: handle of the model.
        canonical: handle of its canonical link, which carries the frame.
    """
    pose: Pose = model.pose
    turning = canonical.angular_velocity
    moving = canonical.linear_velocity + np.cross(turning, pose.position - canonical.pose.position)
    back = pose.inverse()
    return pose, BodyTwist(back.rotate(moving), back.rotate(turning))


def planar_covariance(x: float, y: float, yaw: float) -> Vector:
    """6×6 row-major covariance, shape (36,): the three planar variances, and a huge one for the rest."""
    return np.diag((x, y, _UNKNOWN, _UNKNOWN, _UNKNOWN, yaw)).reshape(36)


def odometry_message(
    time_ns: int,
    frame: str,
    child: str,
    pose: Pose,
    twist: BodyTwist,
    covariance: Vector | None = None,
) -> Any:
    """A `nav_msgs/msg/Odometry`: pose of `child` in `frame`, twist in `child`'s axes."""
    matrix = np.zeros(36) if covariance is None else covariance
    return msgs.make(
        ODOMETRY,
        header=msgs.header(time_ns, frame),
        child_frame_id=child,
        pose={"pose": {"position": _xyz(pose.position), "orientation": _wxyz(pose)}, "covariance": matrix.copy()},
        twist={"twist": {"linear": _xyz(twist.linear), "angular": _xyz(twist.angular)}, "covariance": matrix.copy()},
    )


def transform(time_ns: int, frame: str, child: str, pose: Pose) -> Any:
    """A `geometry_msgs/msg/TransformStamped`: where `child` is in `frame`."""
    return msgs.make(
        "geometry_msgs/msg/TransformStamped",
        header=msgs.header(time_ns, frame),
        child_frame_id=child,
        transform={"translation": _xyz(pose.position), "rotation": _wxyz(pose)},
    )


def transforms(*items: Any) -> Any:
    """A `tf2_msgs/msg/TFMessage` of several transforms."""
    return msgs.make(TRANSFORMS, transforms=list(items))


def _xyz(vector: Sequence[float] | Vector) -> dict[str, float]:
    return {"x": float(vector[0]), "y": float(vector[1]), "z": float(vector[2])}


def _wxyz(pose: Pose) -> dict[str, float]:
    w, x, y, z = (float(v) for v in pose.quaternion)
    return {"x": x, "y": y, "z": z, "w": w}
