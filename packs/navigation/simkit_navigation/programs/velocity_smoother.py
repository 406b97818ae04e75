"""Velocity smoother of Nav2: limits speeds and accelerations between `cmd_vel` and `cmd_vel_smoothed`."""

import math
import sys

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from node_support import ServerNode, run
from rcl_interfaces.msg import SetParametersResult
from rclpy.lifecycle import TransitionCallbackReturn

from simkit.float_sum import float_sum

DEFAULTS = {
    "smoothing_frequency": 20.0,
    "feedback": "OPEN_LOOP",
    "scale_velocities": False,
    "max_velocity": [0.5, 0.0, 2.5],
    "min_velocity": [-0.5, 0.0, -2.5],
    "max_accel": [2.5, 0.0, 3.2],
    "max_decel": [-2.5, 0.0, -3.2],
    "deadband_velocity": [0.0, 0.0, 0.0],
    "odom_topic": "odom",
    "odom_duration": 0.1,
    "velocity_timeout": 1.0,
    "enable_stamped_cmd_vel": False,
    "stamp_smoothed_velocity_with_smoothing_time": False,
}
"""Parameters and their defaults; vectors are for x [m/s], y [m/s] and the turning rate [rad/s]."""

HIGHEST_FREQUENCY = 1e6
"""Highest rate of the timer [Hz]: a period below one nanosecond would never let time pass."""
VECTORS = ("max_velocity", "min_velocity", "max_accel", "max_decel", "deadband_velocity")
SIGNS = (
    ("max_decel", 1.0, "Positive values set of deceleration! These should be negative to slow down!"),
    ("max_accel", -1.0, "Negative values set of acceleration! These should be positive to speed up!"),
    ("min_velocity", 1.0, "Positive values set of min_velocities! These should be negative!"),
    ("max_velocity", -1.0, "Negative values set of max_velocities! These should be positive!"),
)
"""Vectors of which no number may have the sign, and Nav2's message about one that has it."""


def problem_of(values):
    """Return what Nav2 reports about invalid parameters; an empty text if all are valid."""
    numbers = [number for name in VECTORS for number in values[name]]
    if not all(map(math.isfinite, (*numbers, values["smoothing_frequency"], values["velocity_timeout"]))):
        return "A limit, smoothing_frequency or velocity_timeout is NaN or infinite."
    if any(len(values[name]) != len(DEFAULTS["max_velocity"]) for name in VECTORS):
        return (
            "Invalid setting of kinematic and/or deadband limits! "
            "All limits must be size of 3 representing (x, y, theta)."
        )
    for name, sign, sentence in SIGNS:
        if any(value * sign > 0 for value in values[name]):
            return sentence
    if not 0.0 < values["smoothing_frequency"] <= HIGHEST_FREQUENCY:
        return f"smoothing_frequency must be positive, and at most {HIGHEST_FREQUENCY:g} Hz"
    if values["feedback"] not in ("OPEN_LOOP", "CLOSED_LOOP"):
        return "Invalid feedback_type, options are OPEN_LOOP and CLOSED_LOOP."
    return ""


class VelocitySmoother(ServerNode):
    """Node that passes velocities on while it is active."""

    def __init__(self):
        super().__init__("velocity_smoother")
        for name, value in DEFAULTS.items():
            self.declare_parameter(name, value)
        self.declare_parameter("use_realtime_priority", False)

    def on_configure(self, state):
        """Open the topics."""
        super().on_configure(state)
        self._values = {name: self.get_parameter(name).value for name in DEFAULTS}
        problem = problem_of(self._values)
        if problem:
            self.get_logger().error(problem)
            return TransitionCallbackReturn.FAILURE
        self._command = None
        self._command_ns = self.get_clock().now().nanoseconds
        self._last = (0.0, 0.0, 0.0)
        self._measured = []  # times [ns] and velocities of the last odom_duration
        self._is_stopped = True
        self._has_header = self._values["enable_stamped_cmd_vel"]
        self._frame, self._stamp = "", None
        kind = TwistStamped if self._has_header else Twist
        self._publisher = self.create_publisher(kind, "cmd_vel_smoothed", 1)
        self._subscriptions_of_state = [self.create_subscription(kind, "cmd_vel", self._on_command, 1)]
        if self._values["feedback"] == "CLOSED_LOOP":
            topic = self._values["odom_topic"]
            self._subscriptions_of_state.append(self.create_subscription(Odometry, topic, self._on_odometry, 1))
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        """Begin to publish."""
        super().on_activate(state)
        self._timer = self.create_timer(1.0 / self._values["smoothing_frequency"], self._smooth)
        self._parameters_callback = self._on_parameters
        self.add_on_set_parameters_callback(self._parameters_callback)
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state):
        """Stop to publish."""
        super().on_deactivate(state)
        self.destroy_timer(self._timer)
        self.remove_on_set_parameters_callback(self._parameters_callback)
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        """Close the topics."""
        super().on_cleanup(state)
        self.destroy_publisher(self._publisher)
        for subscription in self._subscriptions_of_state:
            self.destroy_subscription(subscription)
        return TransitionCallbackReturn.SUCCESS

    def _on_parameters(self, parameters):
        """Use changed parameters at once; topics keep their names and types."""
        changes = {item.name: item.value for item in parameters if item.name in DEFAULTS}
        problem = problem_of({**self._values, **changes})
        if problem:
            return SetParametersResult(successful=False, reason=problem)
        self._values.update(changes)
        if "smoothing_frequency" in changes:
            self.destroy_timer(self._timer)
            self._timer = self.create_timer(1.0 / self._values["smoothing_frequency"], self._smooth)
        return SetParametersResult(successful=True)

    def _on_command(self, message):
        twist = message.twist if self._has_header else message
        numbers = (*_components(twist.linear), *_components(twist.angular))
        if not all(map(math.isfinite, numbers)):
            self.get_logger().error("Velocity message contains NaNs or Infs! Ignoring as invalid!")
            return
        self._command_ns = self.get_clock().now().nanoseconds
        if self._has_header:
            self._frame, self._stamp = message.header.frame_id, message.header.stamp
            stamped = self._stamp.sec * 10**9 + self._stamp.nanosec
            self._command_ns = stamped or self._command_ns
        self._command = (twist.linear.x, twist.linear.y, twist.angular.z)

    def _on_odometry(self, message):
        twist, now = message.twist.twist, self.get_clock().now().nanoseconds
        self._measured.append((now, (twist.linear.x, twist.linear.y, twist.angular.z)))
        oldest = now - self._values["odom_duration"] * 1e9
        self._measured = [item for item in self._measured if item[0] >= oldest]

    def _mean_velocity(self):
        """Return the mean of the velocities that were measured in the last odom_duration."""
        count = len(self._measured)
        if not count:
            return (0.0, 0.0, 0.0)
        return tuple(float_sum(axis) / count for axis in zip(*(speeds for _, speeds in self._measured), strict=True))

    def _smooth(self):
        """Publish the next velocity."""
        if self._command is None:
            return
        values = self._values
        is_late = self.get_clock().now().nanoseconds - self._command_ns > values["velocity_timeout"] * 1e9
        if is_late:
            if self._is_stopped or self._last == (0.0, 0.0, 0.0):
                self._is_stopped = True
                return
            self._command = (0.0, 0.0, 0.0)
        self._is_stopped = False
        present = self._last if values["feedback"] == "OPEN_LOOP" else self._mean_velocity()
        limited = tuple(
            min(max(speed, low), high)
            for speed, low, high in zip(self._command, values["min_velocity"], values["max_velocity"], strict=True)
        )
        share = 1.0
        if values["scale_velocities"]:
            share = self._largest_share(present, limited)
        out = tuple(self._next(axis, present[axis], limited[axis], share) for axis in range(3))
        self._last = out
        message, sent = Twist(), None
        if self._has_header:
            sent = TwistStamped()
            has_new_stamp = values["stamp_smoothed_velocity_with_smoothing_time"] or is_late
            sent.header.stamp = self.get_clock().now().to_msg() if has_new_stamp else self._stamp
            sent.header.frame_id = self._frame
            message = sent.twist
        limits = zip(out, values["deadband_velocity"], strict=True)
        speeds = [0.0 if abs(speed) < smallest else speed for speed, smallest in limits]
        message.linear.x, message.linear.y, message.angular.z = speeds
        self._publisher.publish(message if sent is None else sent)

    def _range(self, axis, present, wanted):
        """Return the largest decrease and increase of a speed in one period."""
        speeds_up = abs(wanted) >= abs(present) and present * wanted >= 0.0
        limit = self._values["max_accel" if speeds_up else "max_decel"][axis]
        step = abs(limit) / self._values["smoothing_frequency"]
        return -step, step

    def _largest_share(self, present, wanted):
        """Return the factor of all changes with which the axis that needs the longest time keeps its limit."""
        shares = [1.0]
        for axis in range(3):
            change = wanted[axis] - present[axis]
            low, high = self._range(axis, present[axis], wanted[axis])
            if change > high > 0 or change < low < 0:
                shares.append((high if change > 0 else low) / change)
        return min(shares)

    def _next(self, axis, present, wanted, share):
        low, high = self._range(axis, present, wanted)
        return present + min(max(share * (wanted - present), low), high)


def _components(vector):
    return vector.x, vector.y, vector.z


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    run(VelocitySmoother())


if __name__ == "__main__":
    main()
