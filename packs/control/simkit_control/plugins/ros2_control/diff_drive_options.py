"""Parameters of the differential drive controller: wheels, frames, and limits of speed, acceleration and jerk."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from simkit import Params
from simkit.extend import SharedByCopies, Vector, counted
from simkit.plugins.ros_parameter_block import read_numbers

_INFINITY = math.inf


class RateLimits(SharedByCopies):
    """Bounds on a speed, on its acceleration and on its jerk, in `linear.x` or `angular.z`.

    All values are in SI units; a missing bound is infinite. The velocity limits apply if `has_velocity_limits` is true.
    They also apply if that switch is absent and the file has a bound, because newer versions have no switch. The same
    rule holds for acceleration and jerk. The default of a lower bound is the negative upper bound. NaN means no bound.

    Attributes:
        least, most: bounds of the speed.
        acceleration: upper bound of the acceleration while the speed is positive or zero (≥ 0).
        deceleration: lower bound of the acceleration while the speed is positive (≤ 0).
        reverse_acceleration: lower bound of the acceleration while the speed is negative or zero (≤ 0).
        reverse_deceleration: upper bound of the acceleration while the speed is negative (≥ 0).
        least_jerk, most_jerk: bounds of the jerk.
    """

    def __init__(self, block: Params) -> None:
        self.least, self.most = _read_bounds(block, "velocity")
        self.least_jerk, self.most_jerk = _read_bounds(block, "jerk")
        down, up = _read_bounds(block, "acceleration")
        deceleration = read_bound(block, "max_deceleration", None, 0.0)
        reverse = read_bound(block, "max_acceleration_reverse", None, 0.0)
        back = read_bound(block, "max_deceleration_reverse", 0.0, None)
        if up == _INFINITY:  # without `max_acceleration`, the other acceleration limits have no effect
            down, deceleration, reverse, back = -_INFINITY, None, None, None
        self.acceleration = up
        self.reverse_acceleration = down if reverse is None else reverse
        self.deceleration = self.reverse_acceleration if deceleration is None else deceleration
        self.reverse_deceleration = up if back is None else back

    def limit(self, target: float, last: float, before_last: float, period: float) -> float:
        """Return a target speed after limiting its jerk, then its acceleration, then the speed itself.

        Jerk is limited only while the acceleration grows in magnitude. Acceleration may end at once, because otherwise
        the speed would oscillate about its target for ever. This is the rule of control_toolbox's RateLimiter since
        2024. The older rule allowed jerks of twice the bound and caused oscillations.

        Args:
            target: requested speed.
            last: speed commanded in the previous period.
            before_last: speed commanded in the period before that.
            period: duration of a period [s].
        """
        speed, change = target, last - before_last
        growth = (speed - last) - change
        if growth * (speed - last) > 0:
            square = period * period
            speed = last + change + min(max(growth, self.least_jerk * square), self.most_jerk * square)
        down = self.deceleration if last > 0 else self.reverse_acceleration
        up = self.reverse_deceleration if last < 0 else self.acceleration
        # compare before adding, so that an unlimited speed keeps its exact value
        if speed - last > up * period:
            speed = last + up * period
        elif speed - last < down * period:
            speed = last + down * period
        return min(max(speed, self.least), self.most)


def _read_bounds(block: Params, quantity: str) -> tuple[float, float]:
    """Read the bounds `min_<quantity>` and `max_<quantity>`; both are infinite if the limits do not apply."""
    has_switch = block.has(f"has_{quantity}_limits")
    is_enabled = block.boolean(f"has_{quantity}_limits", False)
    least, most = read_bound(block, f"min_{quantity}", None, 0.0), read_bound(block, f"max_{quantity}", 0.0, None)
    if has_switch and not is_enabled:
        return -_INFINITY, _INFINITY
    if most is None:
        if is_enabled or least is not None:
            # a lower bound alone has no effect, so it is reported instead of ignored
            _report_missing_maximum(block, quantity)
        return -_INFINITY, _INFINITY
    return -most if least is None else least, most


def _report_missing_maximum(block: Params, quantity: str) -> None:
    setting = f"has_{quantity}_limits is true" if block.has(f"has_{quantity}_limits") else f"min_{quantity} is set"
    hint = f"add max_{quantity}; min_{quantity} defaults to -max_{quantity}"
    block.error("SK-CONTROL-042", f"{setting}, but max_{quantity} [{_UNITS[quantity]}] is missing", hint)


_UNITS = {"velocity": "m/s or rad/s", "acceleration": "m/s² or rad/s²", "jerk": "m/s³ or rad/s³"}


def read_bound(block: Params, name: str, minimum: float | None, maximum: float | None) -> float | None:
    """Read a bound; None if it is absent or NaN."""
    element = block.child(name)
    if element is None or element.value.strip().lstrip(".").lower() == "nan":
        return None
    return block.number(name, minimum=minimum, maximum=maximum, finite=False)


_SMALLEST_SIZE = 1e-6  # [m]
_ROS_1_NAMES = ("left_wheel", "right_wheel")


class DriveOptions(SharedByCopies):
    """Parameters of a differential drive, except for the multipliers, which may change at run time.

    Args:
        params: parameters of the controller.
        namespace: namespace of the controller's node.
        measured: function that measures the wheel separation and radius in the model [m], for the joints of a left and
            a right wheel; None for a size that the model does not define. ROS 1's controller uses these sizes if the
            file has none.

    Attributes:
        left, right: joints of the wheels.
        separation, radius: distance between the wheels and radius of the wheels, without multipliers [m].
        linear, angular: limits of the linear and the angular velocity.
        timeout_ns: time after which a command expires [ns].
        open_loop: true for odometry from the commands.
        position_feedback: true for odometry from the wheels' angles; false for odometry from their speeds.
        window: number of updates over which the twist of the odometry is averaged.
        odom_frame, base_frame: frame names with their prefix.
        pose_covariance, twist_covariance: 6×6 row-major, shape (36,).
        publish_rate: rate of odometry and transform [Hz]; 0 for every update.
        publish_tf: true if the transform of the odometry is published.
        stamped: true if commands are expected with a stamp.
        publish_limited: true if the limited command is published.
        is_ros_1: true if the parameters have the names of ROS 1.
    """

    def __init__(
        self, params: Params, namespace: str, measured: Callable[[str, str], tuple[float | None, float | None]]
    ) -> None:
        self.is_ros_1 = any(params.has(name) for name in _ROS_1_NAMES)
        self.left, self.right = _wheels(params, self.is_ros_1)
        params.child("allow_multiple_cmd_vel_publishers")  # ignored: always as if true
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
    """Read the wheel joints of each side, and report invalid ones."""
    keys = _ROS_1_NAMES if is_ros_1 else ("left_wheel_names", "right_wheel_names")
    left, right = (tuple(element.value for element in params.all(key) if element.value) for key in keys)
    for key, names in zip(keys, (left, right), strict=True):
        if not names:
            hint = f"list its joints: {key}: [wheel_{key.split('_')[0]}_joint]"
            params.error("SK-CONTROL-040", f"{key} names no wheel", hint)
    if left and right and len(left) != len(right):
        message = f"{keys[0]} has {len(left)} and {keys[1]} has {counted(len(right), 'wheel')}; both sides need as many"
        params.error("SK-CONTROL-040", message)
    all_names = left + right
    for name in dict.fromkeys(n for n in all_names if all_names.count(n) > 1):
        params.error("SK-CONTROL-041", f"joint {name!r} is named for several wheels; each wheel needs its own joint")
    count = params.integer("wheels_per_side", 0, minimum=0)
    if count and left and count != len(left):
        message = f"wheels_per_side is {count}, but {keys[0]} names {len(left)}; the named wheels are driven"
        where = (params.child("wheels_per_side") or params).where
        params.diagnostics.warning("SK-CONTROL-043", message, where)
    return left, right


def _wheel_size(
    params: Params, options: DriveOptions, measure: Callable[[str, str], tuple[float | None, float | None]]
) -> tuple[float, float]:
    """Return separation and radius of the wheels [m], from the file or measured in the model."""
    keys = ("wheel_separation", "wheel_radius")
    missing = [key for key in keys if not params.has(key)]
    measured: tuple[float | None, float | None] = (None, None)
    if options.is_ros_1 and missing and options.left and options.right:
        measured = measure(options.left[0], options.right[0])
        for key, value in zip(keys, measured, strict=True):
            if key in missing and value is not None:
                message = f"{params.name}: {key} is missing; the model's value is used: {value:g} m"
                params.diagnostics.note("SK-CONTROL-044", message, params.where)
    sizes = (
        params.number(k, v, required=v is None, minimum=_SMALLEST_SIZE) for k, v in zip(keys, measured, strict=True)
    )
    separation, radius = sizes
    return separation or 1.0, radius or 1.0  # a missing size has already been reported as an error


def _frame_prefix(params: Params, namespace: str) -> str:
    """Return the prefix of the frame names without a leading slash: `tf_frame_prefix`, else the namespace."""
    enabled, prefix = params.boolean("tf_frame_prefix_enable", True), params.text("tf_frame_prefix", "")
    if not enabled:
        return ""
    chosen = (prefix or namespace).strip("/")
    return f"{chosen}/" if chosen else ""


def _covariance(params: Params, name: str) -> Vector:
    """Read a covariance from its diagonal: the variances of x, y, z, roll, pitch and yaw."""
    return np.diag(read_numbers(params, name, [0.0] * 6, minimum=0.0)).reshape(36)
