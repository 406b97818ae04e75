"""Parameters of the differential drive controller, in the spelling of ROS 2 and of ROS 1."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from simkit.control.diff_drive_limits import RateLimits, read_rate_limits
from simkit.control.lists import numbers
from simkit.params import Params
from simkit.pose import Vector

_TINY = 1e-6  # [m]
_ROS_1_NAMES = ("left_wheel", "right_wheel")


@dataclass(frozen=True, slots=True)
class DriveOptions:
    """What a differential drive is told once.

    Attributes:
        left, right: joints of the wheels.
        separation, radius: of the wheels as given, without multipliers [m].
        linear, angular: limits of the speed ahead and of the rate of turning.
        timeout_ns: after which a command counts no more [ns].
        open_loop: odometry by what was commanded.
        position_feedback: odometry by the wheels' angles; else by their speeds.
        window: updates that the odometry's twist is the mean of.
        odom_frame, base_frame: with their prefix.
        pose_covariance, twist_covariance: 6×6 row-major, shape (36,).
        publish_rate: of odometry and transform [Hz]; 0 is every update.
        publish_tf: whether the odometry's transform is told.
        stamped: whether commands are expected with a stamp.
        publish_limited: whether the limited command is told.
        is_ros_1: whether the parameters are in its spelling.
    """

    left: tuple[str, ...]
    right: tuple[str, ...]
    separation: float
    radius: float
    linear: RateLimits
    angular: RateLimits
    timeout_ns: int
    open_loop: bool
    position_feedback: bool
    window: int
    odom_frame: str
    base_frame: str
    pose_covariance: Vector
    twist_covariance: Vector
    publish_rate: float
    publish_tf: bool
    stamped: bool
    publish_limited: bool
    is_ros_1: bool

    def __deepcopy__(self, memo: dict[int, Any]) -> DriveOptions:
        return self


def read_drive_options(
    params: Params, namespace: str, measured: Callable[[str, str], tuple[float | None, float | None]]
) -> DriveOptions:
    """Reads everything but the multipliers, which may change as it runs.

    Args:
        params: the controller's.
        namespace: of its node.
        measured: gives the separation and the radius that the model has for a left and a right wheel [m], None where it
            does not show; ROS 1's controller takes those that the file leaves out from there.
    """
    is_ros_1 = any(params.has(name) for name in _ROS_1_NAMES)
    left, right = _wheels(params, is_ros_1)
    params.child("allow_multiple_cmd_vel_publishers")  # every publisher is heard, as with true
    separation, radius = _size(params, is_ros_1, left, right, measured)
    stamped = params.boolean("use_stamped_vel", not is_ros_1)
    odom, base = params.text("odom_frame_id", "odom"), params.text("base_frame_id", "base_link")
    prefix = "" if is_ros_1 else _frame_prefix(params, namespace)
    linear, angular = (read_rate_limits(params.block(a).block(b)) for a, b in (("linear", "x"), ("angular", "z")))
    return DriveOptions(
        left=left,
        right=right,
        separation=separation,
        radius=radius,
        linear=linear,
        angular=angular,
        timeout_ns=round(params.number("cmd_vel_timeout", 0.5, minimum=0, maximum=1e9) * 1e3) * 1_000_000,
        open_loop=params.boolean("open_loop", False),
        position_feedback=params.boolean("position_feedback", True),
        window=params.integer("velocity_rolling_window_size", 10, minimum=1, maximum=100_000),
        odom_frame=prefix + odom,
        base_frame=prefix + base,
        pose_covariance=_covariance(params, "pose_covariance_diagonal"),
        twist_covariance=_covariance(params, "twist_covariance_diagonal"),
        publish_rate=params.number("publish_rate", 50.0, minimum=0),
        publish_tf=params.boolean("enable_odom_tf", True),
        stamped=stamped,
        publish_limited=params.boolean("publish_cmd" if is_ros_1 else "publish_limited_velocity", False),
        is_ros_1=is_ros_1,
    )


def _wheels(params: Params, is_ros_1: bool) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Joints of the wheels on each side; what cannot be is reported."""
    keys = _ROS_1_NAMES if is_ros_1 else ("left_wheel_names", "right_wheel_names")
    left, right = (tuple(element.value for element in params.all(key) if element.value) for key in keys)
    for key, names in zip(keys, (left, right), strict=True):
        if not names:
            hint = f"a list of joints, such as {key}: [wheel_{key.split('_')[0]}_joint]"
            params.error("SK-CONTROL-040", f"{key} names no wheel", hint)
    if left and right and len(left) != len(right):
        message = f"{keys[0]} has {len(left)} and {keys[1]} has {len(right)} wheels; each side has as many"
        params.error("SK-CONTROL-040", message)
    all_names = left + right
    for name in dict.fromkeys(n for n in all_names if all_names.count(n) > 1):
        params.error("SK-CONTROL-041", f"joint {name!r} is named as several wheels; each wheel has a joint of its own")
    count = params.integer("wheels_per_side", 0, minimum=0)
    if count and left and count != len(left):
        message = f"wheels_per_side is {count}, but {keys[0]} names {len(left)}; those named are driven"
        where = (params.child("wheels_per_side") or params).where
        params.diagnostics.warning("SK-CONTROL-043", message, where)
    return left, right


def _size(
    params: Params,
    is_ros_1: bool,
    left: tuple[str, ...],
    right: tuple[str, ...],
    measured: Callable[[str, str], tuple[float | None, float | None]],
) -> tuple[float, float]:
    """Separation and radius of the wheels [m]."""
    keys = ("wheel_separation", "wheel_radius")
    missing = [key for key in keys if not params.has(key)]
    shown: tuple[float | None, float | None] = (None, None)
    if is_ros_1 and missing and left and right:
        shown = measured(left[0], right[0])
        for key, value in zip(keys, shown, strict=True):
            if key in missing and value is not None:
                message = f"{params.name}: {key} is not given, the model's is taken: {value:g} m"
                params.diagnostics.note("SK-CONTROL-044", message, params.where)
    found = (params.number(k, v, required=v is None, minimum=_TINY) for k, v in zip(keys, shown, strict=True))
    separation, radius = found
    return separation or 1.0, radius or 1.0  # only where that was reported


def _frame_prefix(params: Params, namespace: str) -> str:
    """What goes before the frames: `tf_frame_prefix`, else the namespace; never with a slash in front."""
    enabled, prefix = params.boolean("tf_frame_prefix_enable", True), params.text("tf_frame_prefix", "")
    if not enabled:
        return ""
    chosen = (prefix or namespace).strip("/")
    return f"{chosen}/" if chosen else ""


def _covariance(params: Params, name: str) -> Vector:
    """A covariance by its diagonal: the variances of x, y, z, roll, pitch, yaw."""
    return np.diag(numbers(params, name, [0.0] * 6, minimum=0.0)).reshape(36)
