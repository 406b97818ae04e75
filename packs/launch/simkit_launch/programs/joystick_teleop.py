"""teleop_twist_joy: velocity commands from the messages of a joystick."""

from __future__ import annotations

from typing import Any

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from node_values import value_of
from rclpy.node import Node
from republisher import run
from sensor_msgs.msg import Joy

LINEAR = {"x": (5, 0.5, 1.0), "y": (-1, 0.0, 0.0), "z": (-1, 0.0, 0.0)}
"""Default axis, scale and turbo scale of each linear velocity."""

ANGULAR = {"yaw": (2, 0.5, 1.0), "pitch": (-1, 0.0, 0.0), "roll": (-1, 0.0, 0.0)}
"""Default axis, scale and turbo scale of each angular velocity."""

FIELDS = {"x": "x", "y": "y", "z": "z", "roll": "x", "pitch": "y", "yaw": "z"}
"""Field of the velocity by the name in the parameters."""


class JoystickTeleop(Node):
    """Node that publishes velocities while the enable button of the joystick is pressed."""

    def __init__(self) -> None:
        super().__init__("teleop_twist_joy_node")
        self._needs_button = self._value("require_enable_button", True)
        self._button, self._turbo = self._value("enable_button", 5), self._value("enable_turbo_button", -1)
        self._is_inverted = self._value("inverted_reverse", False)
        self._is_stamped, self._frame = (
            self._value("publish_stamped_twist", False),
            self._value("frame", "teleop_twist_joy"),
        )
        self._axes = {"linear": self._table("linear", LINEAR), "angular": self._table("angular", ANGULAR)}
        self._has_sent_stop = True
        self._publisher = self.create_publisher(TwistStamped if self._is_stamped else Twist, "cmd_vel", 10)
        self.create_subscription(Joy, "joy", self._receive, 10)

    def _value(self, name: str, default: Any) -> Any:
        return value_of(self, name, default)

    def _table(self, kind: str, defaults: dict[str, tuple[int, float, float]]) -> dict[str, tuple[int, float, float]]:
        prefixes = (f"axis_{kind}", f"scale_{kind}", f"scale_{kind}_turbo")
        return {
            name: tuple(self._value(f"{prefix}.{name}", value) for prefix, value in zip(prefixes, values, strict=True))
            for name, values in defaults.items()
        }

    def _receive(self, joy: Any) -> None:
        is_turbo = self._is_pressed(joy, self._turbo)
        if is_turbo or not self._needs_button or self._is_pressed(joy, self._button):
            self._publish(self._command(joy, 2 if is_turbo else 1))
            self._has_sent_stop = False
        elif not self._has_sent_stop:
            self._publish(Twist())
            self._has_sent_stop = True

    def _is_pressed(self, joy: Any, button: int) -> bool:
        return 0 <= button < len(joy.buttons) and bool(joy.buttons[button])

    def _command(self, joy: Any, column: int) -> Any:
        """Return the velocity of the axes; `column` chooses the scale."""
        twist = Twist()
        for kind, axes in self._axes.items():
            for name, values in axes.items():
                if 0 <= values[0] < len(joy.axes):
                    setattr(getattr(twist, kind), FIELDS[name], float(joy.axes[values[0]]) * float(values[column]))
        if self._is_inverted and twist.linear.x < 0.0:
            twist.angular.z = -twist.angular.z
        return twist

    def _publish(self, twist: Any) -> None:
        if self._is_stamped:
            twist = TwistStamped(twist=twist)
            twist.header.stamp, twist.header.frame_id = self.get_clock().now().to_msg(), self._frame
        self._publisher.publish(twist)


def main() -> None:
    """Run the node."""
    rclpy.init()
    run(JoystickTeleop())


if __name__ == "__main__":
    main()
