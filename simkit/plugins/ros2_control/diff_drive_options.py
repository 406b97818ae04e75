"""Parameters of the differential drive controller: wheels, frames, and limits of speed, acceleration and jerk."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from simkit.params import Params
from simkit.plugins.ros_parameter_block import read_numbers
from simkit.plugins.shared_by_copies import SharedByCopies
from simkit.pose import Vector

_INFINITY = math.inf


class RateLimits(SharedByCopies):
    """Bounds on a speed, its rate and the rate of that, in `linear.x` or `angular.z`; SI units, infinite for none.

    A kind of limit is in force where `has_velocity_limits` and the like is true, or is not there and a bound is (they
    went out of use); what is not bounded below is bounded as above. NaN is no bound.

    Attributes:
        least, most: of the speed.
        acceleration, deceleration: of the rate while the speed is positive: upwards (≥ 0) and downwards (≤ 0).
        reverse_acceleration, reverse_deceleration: the same while it is negative: away from zero (≤ 0), towards it
            (≥ 0). From rest the bounds are those of the two accelerations.
        least_jerk, most_jerk: of the rate of the rate.
    """

    def __init__(self, block: Params) -> None:
        self.least, self.most = _read_bounds(block, "velocity")
        self.least_jerk, self.most_jerk = _read_bounds(block, "jerk")
        down, up = _read_bounds(block, "acceleration")
        deceleration = _read_bound(block, "max_deceleration", None, 0.0)
        reverse = _read_bound(block, "max_acceleration_reverse", None, 0.0)
        back = _read_bound(block, "max_deceleration_reverse", 0.0, None)
        if up == _INFINITY:  # then the others bound nothing either
            down, deceleration, reverse, back = -_INFINITY, None, None, None
        self.acceleration = up
        self.reverse_acceleration = down if reverse is None else reverse
        self.deceleration = self.reverse_acceleration if deceleration is None else deceleration
        self.reverse_deceleration = up if back is None else back

    def limit(self, wanted: float, last: float, before_last: float, period: float) -> float:
        """The speed to command now: bounded in jerk, then in acceleration, then in speed.

        Jerk is bounded while the change grows; it may end at once, or a speed would swing about the one wanted for
        ever. (The rule of control_toolbox's RateLimiter since 2024; before that jerks of twice the bound went through,
        and the swinging.)

        Args:
            wanted: the speed asked for.
            last, before_last: what was commanded in the two periods before.
            period: [s].
        """
        speed, change = wanted, last - before_last
        growth = (speed - last) - change
        if growth * (speed - last) > 0:
            square = period * period
            speed = last + change + min(max(growth, self.least_jerk * square), self.most_jerk * square)
        down = self.deceleration if last > 0 else self.reverse_acceleration
        up = self.reverse_deceleration if last < 0 else self.acceleration
        # without a bound in force the speed itself, not the one after rounding
        if speed - last > up * period:
            speed = last + up * period
        elif speed - last < down * period:
            speed = last + down * period
        return min(max(speed, self.least), self.most)


def _read_bounds(block: Params, what: str) -> tuple[float, float]:
    """The bounds `min_<what>` and `max_<what>`; infinite where none is in force."""
    told = block.has(f"has_{what}_limits")
    wanted = block.boolean(f"has_{what}_limits", False)
    least, most = _read_bound(block, f"min_{what}", None, 0.0), _read_bound(block, f"max_{what}", 0.0, None)
    if told and not wanted:
        return -_INFINITY, _INFINITY
    if most is None:
        if wanted or least is not None:
            # a lower bound alone would be none, and nobody would know
            _report_missing_maximum(block, what)
        return -_INFINITY, _INFINITY
    return -most if least is None else least, most


def _report_missing_maximum(block: Params, what: str) -> None:
    given = f"has_{what}_limits is true" if block.has(f"has_{what}_limits") else f"there is min_{what}"
    hint = "without it nothing is limited" if block.has(f"max_{what}") else f"min_{what} is -max_{what} unless given"
    block.error("SK-CONTROL-042", f"{given}, but there is no max_{what} [{_UNITS[what]}]", hint)


_UNITS = {"velocity": "m/s or rad/s", "acceleration": "m/s² or rad/s²", "jerk": "m/s³ or rad/s³"}


def _read_bound(block: Params, name: str, minimum: float | None, maximum: float | None) -> float | None:
    """A bound; None where it is absent or NaN."""
    found = block.child(name)
    if found is None or found.value.strip().lstrip(".").lower() == "nan":
        return None
    return block.number(name, minimum=minimum, maximum=maximum, finite=False)


_SMALLEST_SIZE = 1e-6  # [m]
_ROS_1_NAMES = ("left_wheel", "right_wheel")


class DriveOptions(SharedByCopies):
    """Parameters of a differential drive but for the multipliers, which may change as it runs.

    Args:
        params: the controller's.
        namespace: of its node.
        measured: gives the separation and the radius that the model has for a left and a right wheel [m], None where it
            does not show; ROS 1's controller takes those that the file leaves out from there.

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

    def __init__(
        self, params: Params, namespace: str, measured: Callable[[str, str], tuple[float | None, float | None]]
    ) -> None:
        self.is_ros_1 = any(params.has(name) for name in _ROS_1_NAMES)
        self.left, self.right = _wheels(params, self.is_ros_1)
        params.child("allow_multiple_cmd_vel_publishers")  # every publisher is heard, as with true
        self.separation, self.radius = _wheel_size(params, self, measured)
        self.stamped = params.boolean("use_stamped_vel", not self.is_ros_1)
        odom, base = params.text("odom_frame_id", "odom"), params.text("base_frame_id", "base_link")
        prefix = "" if self.is_ros_1 else _frame_prefix(params, namespace)
        self.odom_frame, self.base_frame = prefix + odom, prefix + base
        self.linear = RateLimits(params.block("linear").block("x"))
        self.angular = RateLimits(params.block("angular").block("z"))
        self.timeout_ns = round(params.number("cmd_vel_timeout", 0.5, minimum=0, maximum=1e9) * 1e3) * 1_000_000
        self.open_loop = params.boolean("open_loop", False)
        self.position_feedback = params.boolean("position_feedback", True)
        self.window = params.integer("velocity_rolling_window_size", 10, minimum=1, maximum=100_000)
        self.pose_covariance = _covariance(params, "pose_covariance_diagonal")
        self.twist_covariance = _covariance(params, "twist_covariance_diagonal")
        self.publish_rate = params.number("publish_rate", 50.0, minimum=0)
        self.publish_tf = params.boolean("enable_odom_tf", True)
        self.publish_limited = params.boolean("publish_cmd" if self.is_ros_1 else "publish_limited_velocity", False)


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


def _wheel_size(
    params: Params, options: DriveOptions, measured: Callable[[str, str], tuple[float | None, float | None]]
) -> tuple[float, float]:
    """Separation and radius of the wheels [m]."""
    keys = ("wheel_separation", "wheel_radius")
    missing = [key for key in keys if not params.has(key)]
    shown: tuple[float | None, float | None] = (None, None)
    if options.is_ros_1 and missing and options.left and options.right:
        shown = measured(options.left[0], options.right[0])
        for key, value in zip(keys, shown, strict=True):
            if key in missing and value is not None:
                message = f"{params.name}: {key} is not given, the model's is taken: {value:g} m"
                params.diagnostics.note("SK-CONTROL-044", message, params.where)
    found = (params.number(k, v, required=v is None, minimum=_SMALLEST_SIZE) for k, v in zip(keys, shown, strict=True))
    separation, radius = found
    return separation or 1.0, radius or 1.0  # only where that was reported


def _frame_prefix(params: Params, namespace: str) -> str:
    """Return the prefix of the frames: `tf_frame_prefix`, else the namespace; never with a slash in front."""
    enabled, prefix = params.boolean("tf_frame_prefix_enable", True), params.text("tf_frame_prefix", "")
    if not enabled:
        return ""
    chosen = (prefix or namespace).strip("/")
    return f"{chosen}/" if chosen else ""


def _covariance(params: Params, name: str) -> Vector:
    """A covariance by its diagonal: the variances of x, y, z, roll, pitch, yaw."""
    return np.diag(read_numbers(params, name, [0.0] * 6, minimum=0.0)).reshape(36)
