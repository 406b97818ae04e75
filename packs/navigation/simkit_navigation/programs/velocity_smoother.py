"""Velocity smoother of Nav2: limits speeds and accelerations between `cmd_vel` and `cmd_vel_smoothed`."""

import sys

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from node_support import ServerNode, run
from rclpy.lifecycle import TransitionCallbackReturn

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
}
"""Parameters and their defaults; vectors are for x [m/s], y [m/s] and the turning rate [rad/s]."""


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
        for name, wrong_sign, sentence in (
            ("max_accel", -1.0, "Negative values set of acceleration!"),
            ("max_decel", 1.0, "Positive values set of deceleration!"),
        ):
            if any(value * wrong_sign > 0 for value in self._values[name]):
                self.get_logger().error(sentence)
                return TransitionCallbackReturn.FAILURE
        self._command = None
        self._command_ns = self.get_clock().now().nanoseconds
        self._last = self._measured = (0.0, 0.0, 0.0)
        self._is_stopped = True
        self._has_header = self._values["enable_stamped_cmd_vel"]
        self._frame = ""
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
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state):
        """Stop to publish."""
        super().on_deactivate(state)
        self.destroy_timer(self._timer)
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        """Close the topics."""
        super().on_cleanup(state)
        self.destroy_publisher(self._publisher)
        for subscription in self._subscriptions_of_state:
            self.destroy_subscription(subscription)
        return TransitionCallbackReturn.SUCCESS

    def _on_command(self, message):
        if self._has_header:
            self._frame, message = message.header.frame_id, message.twist
        self._command = (message.linear.x, message.linear.y, message.angular.z)
        self._command_ns = self.get_clock().now().nanoseconds

    def _on_odometry(self, message):
        twist = message.twist.twist
        self._measured = (twist.linear.x, twist.linear.y, twist.angular.z)

    def _smooth(self):
        """Publish the next velocity."""
        if self._command is None:
            return
        values = self._values
        if self.get_clock().now().nanoseconds - self._command_ns > values["velocity_timeout"] * 1e9:
            if self._is_stopped or self._last == (0.0, 0.0, 0.0):
                self._is_stopped = True
                return
            self._command = (0.0, 0.0, 0.0)
        self._is_stopped = False
        present = self._last if values["feedback"] == "OPEN_LOOP" else self._measured
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
            sent.header.stamp, sent.header.frame_id = self.get_clock().now().to_msg(), self._frame
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


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    run(VelocitySmoother())


if __name__ == "__main__":
    main()
