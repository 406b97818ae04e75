"""Messages of odometry, and their packers."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from simkit import msgs
from simkit.msgs.cdr_template import CdrTemplate, packs
from simkit.pose import Pose, Vector, quat_from_rpy

if TYPE_CHECKING:
    from simkit.msgs import Message


ODOMETRY = "nav_msgs/msg/Odometry"
TRANSFORMS = "tf2_msgs/msg/TFMessage"


class PlanarPose(NamedTuple):
    """Pose with z = 0; calling it returns the `Pose`, whose checks take as long as three messages.

    Attributes:
        x, y: position [m].
        yaw: yaw angle [rad].
    """

    x: float
    y: float
    yaw: float

    def __call__(self) -> Pose:
        return Pose((self.x, self.y, 0.0), quat_from_rpy(0.0, 0.0, self.yaw))


LatePose = Pose | PlanarPose | Callable[[], Pose]
"""Pose, or a function that returns it at any later time."""

_NS = 1_000_000_000
_MOST_FRAMES = 1024  # templates that are kept, one for each combination of frames
_STAMP = "header.stamp.sec", "header.stamp.nanosec"
_PLACE = (*(f"position.{axis}" for axis in "xyz"), *(f"orientation.{axis}" for axis in "xyzw"))
_MOTION = tuple(f"{part}.{axis}" for part in ("linear", "angular") for axis in "xyz")
_ODOMETRY_FIELDS = (
    *_STAMP,
    *(f"pose.pose.{name}" for name in _PLACE),
    "pose.covariance",
    *(f"twist.twist.{name}" for name in _MOTION),
    "twist.covariance",
)
_TRANSFORM_FIELDS = (
    *_STAMP,
    *(f"transform.translation.{axis}" for axis in "xyz"),
    *(f"transform.rotation.{axis}" for axis in "xyzw"),
)
_NO_COVARIANCE = bytes(36 * 8)


@dataclass(frozen=True, slots=True)
class BodyTwist:
    """Velocities in the body's own axes: linear [m/s] and angular [rad/s], each (x, y, z)."""

    linear: Sequence[float] | Vector = (0.0, 0.0, 0.0)
    angular: Sequence[float] | Vector = (0.0, 0.0, 0.0)


def odometry_message(
    time_ns: int,
    frame: str,
    child: str,
    pose: LatePose,
    twist: BodyTwist,
    covariance: Vector | None = None,
    twist_covariance: Vector | None = None,
) -> msgs.Odometry:
    """Return a `nav_msgs/msg/Odometry`.

    Args:
        time_ns: Time of the message [ns].
        frame: Frame of the pose.
        child: Child frame; the twist is in its axes.
        pose: Pose of `child` in `frame`, or a function that returns this pose at any later time.
        twist: Twist of `child`.
        covariance: Row-major covariance of the pose, shape (36,); zeros if omitted.
        twist_covariance: Covariance of the twist, shape (36,); equal to the pose's if omitted.
    """
    types, (px, py, pz, *axes) = message_types(), _numbers(pose)
    point, vector, quaternion = types["Point"], types["Vector3"], types["Quaternion"]
    # copies: a subscriber may keep or change the arrays of a message
    first = np.zeros(36) if covariance is None else covariance.copy()
    second = first.copy() if twist_covariance is None else twist_covariance.copy()
    pose_message = types["Pose"](point(px, py, pz), quaternion(*axes))
    motion = types["Twist"](vector(*map(float, twist.linear)), vector(*map(float, twist.angular)))
    message: msgs.Odometry = types["Odometry"](
        msgs.header(time_ns, frame),
        child,
        types["PoseWithCovariance"](pose_message, first),
        types["TwistWithCovariance"](motion, second),
    )
    return message


@packs(odometry_message)
def _pack_odometry(
    time_ns: int,
    frame: str,
    child: str,
    pose: LatePose,
    twist: BodyTwist,
    covariance: Vector | None = None,
    twist_covariance: Vector | None = None,
) -> tuple[str, bytes]:
    first = _NO_COVARIANCE if covariance is None else covariance.tobytes()
    second = first if twist_covariance is None else twist_covariance.tobytes()
    place = time_ns // _NS, time_ns % _NS, *_numbers(pose)
    return ODOMETRY, _odometry_packer(frame, child)(*place, first, *twist.linear, *twist.angular, second)


@functools.lru_cache(_MOST_FRAMES)
def _odometry_packer(frame: str, child: str) -> Callable[..., bytes]:
    return CdrTemplate(odometry_message(0, frame, child, Pose(), BodyTwist()), _ODOMETRY_FIELDS).packer()


def transform(time_ns: int, frame: str, child: str, pose: LatePose) -> msgs.TransformStamped:
    """Return a `geometry_msgs/msg/TransformStamped` with the pose of `child` in `frame`."""
    types, (x, y, z, *axes) = message_types(), _numbers(pose)
    transform_message = types["Transform"](types["Vector3"](x, y, z), types["Quaternion"](*axes))
    message: msgs.TransformStamped = types["TransformStamped"](msgs.header(time_ns, frame), child, transform_message)
    return message


def transforms(time_ns: int, *items: tuple[str, str, LatePose]) -> msgs.TFMessage:
    """Return a `tf2_msgs/msg/TFMessage`.

    Args:
        time_ns: Time of the message [ns].
        *items: Frame, child frame and pose of the child in the frame, for each transform.
    """
    message: msgs.TFMessage = msgs.type_of(TRANSFORMS)([transform(time_ns, *item) for item in items])
    return message


@packs(transforms)
def _pack_transforms(time_ns: int, *items: tuple[str, str, LatePose]) -> tuple[str, bytes]:
    stamp, values = divmod(time_ns, _NS), []
    for _, _, pose in items:
        values += [*stamp, *_numbers(pose)]
    return TRANSFORMS, _transforms_packer(tuple([item[:2] for item in items]))(*values)


@functools.lru_cache(_MOST_FRAMES)
def _transforms_packer(frames: tuple[tuple[str, str], ...]) -> Callable[..., bytes]:
    fields = tuple(f"transforms[{i}].{name}" for i in range(len(frames)) for name in _TRANSFORM_FIELDS)
    return CdrTemplate(transforms(0, *((*pair, Pose()) for pair in frames)), fields).packer()


def _numbers(pose: LatePose) -> tuple[float, ...]:
    """Return position and quaternion (x, y, z, w) of a pose."""
    if isinstance(pose, PlanarPose):
        w, *axes = _attitude(pose.yaw)
        return pose.x, pose.y, 0.0, *axes, w
    pose = pose() if callable(pose) else pose
    w, *axes = pose.quaternion.tolist()
    return *pose.position.tolist(), *axes, w


def _attitude(yaw: float) -> tuple[float, float, float, float]:
    """Return the quaternion (w, x, y, z) of a yaw angle [rad]; every bit is as from `quat_from_rpy`."""
    cos, sin = math.cos(yaw / 2), math.sin(yaw / 2)
    return cos + 0.0 * sin, 0.0 * cos - 0.0 * sin, 0.0 * cos + 0.0 * sin, sin - 0.0 * cos


def planar_odometry(
    time_ns: int, frame: str, child: str, x: float, y: float, yaw: float, ahead: float, turn: float
) -> msgs.Odometry:
    """Return a planar `nav_msgs/msg/Odometry` without covariance.

    Units: time [ns], position [m], yaw [rad], forward speed [m/s] and turning rate [rad/s].
    """
    types = message_types()
    w, qx, qy, qz = _attitude(yaw)
    place = types["Pose"](types["Point"](x, y, 0.0), types["Quaternion"](qx, qy, qz, w))
    vector = types["Vector3"]
    motion = types["Twist"](vector(ahead, 0.0, 0.0), vector(0.0, 0.0, turn))
    message: msgs.Odometry = types["Odometry"](
        types["Header"](types["Time"](*divmod(time_ns, _NS)), frame),
        child,
        types["PoseWithCovariance"](place, np.zeros(36)),
        types["TwistWithCovariance"](motion, np.zeros(36)),
    )
    return message


@packs(planar_odometry)
def _pack_planar_odometry(
    time_ns: int, frame: str, child: str, x: float, y: float, yaw: float, ahead: float, turn: float
) -> tuple[str, bytes]:
    w, *axes = _attitude(yaw)
    place = *divmod(time_ns, _NS), x, y, 0.0, *axes, w
    motion = ahead, 0.0, 0.0, 0.0, 0.0, turn
    return ODOMETRY, _odometry_packer(frame, child)(*place, _NO_COVARIANCE, *motion, _NO_COVARIANCE)


def planar_transform(time_ns: int, frame: str, child: str, x: float, y: float, yaw: float) -> msgs.TFMessage:
    """Return a `tf2_msgs/msg/TFMessage` with one planar transform [m, rad]."""
    types = message_types()
    w, qx, qy, qz = _attitude(yaw)
    place = types["Transform"](types["Vector3"](x, y, 0.0), types["Quaternion"](qx, qy, qz, w))
    stamped = types["TransformStamped"]
    header = types["Header"](types["Time"](*divmod(time_ns, _NS)), frame)
    message: msgs.TFMessage = types["TFMessage"]([stamped(header, child, place)])
    return message


@packs(planar_transform)
def _pack_planar_transform(time_ns: int, frame: str, child: str, x: float, y: float, yaw: float) -> tuple[str, bytes]:
    w, *axes = _attitude(yaw)
    return TRANSFORMS, _transforms_packer(((frame, child),))(*divmod(time_ns, _NS), x, y, 0.0, *axes, w)


@functools.cache
def message_types() -> Mapping[str, type[Message]]:
    """Return message classes by name; calling a class is several times faster than `msgs.make`."""
    geometry = "Point Vector3 Quaternion Pose Twist PoseWithCovariance TwistWithCovariance Transform TransformStamped"
    others = (ODOMETRY, TRANSFORMS, "std_msgs/msg/Header", "builtin_interfaces/msg/Time")
    names = (*(f"geometry_msgs/msg/{name}" for name in geometry.split()), *others)
    return {name.rsplit("/", 1)[1]: msgs.type_of(name) for name in names}
