"""teleop_twist_keyboard: drives a robot with the keys of a keyboard."""

from __future__ import annotations

import sys
import termios
import tty
from typing import Any

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node

from simkit_launch.program_simulation import ros1_parameter

TEXT = """Reading from the keyboard and publishing velocities!
---------------------------
   u    i    o     forwards
   j    k    l     turn; k and all other keys stop
   m    ,    .     backwards
with shift: sideways; t and b: up and down
q/z, w/x, e/c: 10 % more or less speed, linear speed, angular speed
CTRL-C to quit"""

DIRECTIONS = {
    "i": (1, 0, 0, 0), "o": (1, 0, 0, -1), "j": (0, 0, 0, 1), "l": (0, 0, 0, -1), "u": (1, 0, 0, 1),
    ",": (-1, 0, 0, 0), ".": (-1, 0, 0, 1), "m": (-1, 0, 0, -1),
    "O": (1, -1, 0, 0), "I": (1, 0, 0, 0), "J": (0, 1, 0, 0), "L": (0, -1, 0, 0), "U": (1, 1, 0, 0),
    "<": (-1, 0, 0, 0), ">": (-1, -1, 0, 0), "M": (-1, 1, 0, 0), "t": (0, 0, 1, 0), "b": (0, 0, -1, 0),
}  # fmt: skip
"""Linear x, y and z, and angular z, by key."""

FACTORS = {
    "q": (1.1, 1.1), "z": (0.9, 0.9), "w": (1.1, 1.0), "x": (0.9, 1.0), "e": (1.0, 1.1), "c": (1.0, 0.9),
}  # fmt: skip
"""Factors of the linear and the angular speed, by key."""


class Teleop:
    """Publisher of the velocity that the last key commands.

    Args:
        node: node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        values = {"speed": 0.5, "turn": 1.0}
        for name in values:
            ros1 = ros1_parameter(node.get_fully_qualified_name(), name)
            values[name] = float(node.declare_parameter(name, values[name]).value if ros1 is None else ros1)
        self._speed, self._turn = values["speed"], values["turn"]
        self._is_stamped = bool(node.declare_parameter("stamped", False).value)
        self._frame = str(node.declare_parameter("frame_id", "").value)
        self._publisher = node.create_publisher(TwistStamped if self._is_stamped else Twist, "cmd_vel", 10)
        self._direction = (0, 0, 0, 0)

    def press(self, key: str) -> None:
        """Command what a key means."""
        if key in FACTORS:
            linear, angular = FACTORS[key]
            self._speed, self._turn = self._speed * linear, self._turn * angular
            self.show()
        else:
            self._direction = DIRECTIONS.get(key, (0, 0, 0, 0))
        self.publish(self._direction)

    def show(self) -> None:
        """Print the speeds."""
        print(f"currently:\tspeed {self._speed:g}\tturn {self._turn:g}")

    def publish(self, direction: tuple[int, int, int, int]) -> None:
        """Publish the velocity in a direction."""
        twist: Any = Twist()
        x, y, z, yaw = direction
        twist.linear.x, twist.linear.y, twist.linear.z = x * self._speed, y * self._speed, z * self._speed
        twist.angular.z = yaw * self._turn
        if self._is_stamped:
            twist = TwistStamped(twist=twist)
            twist.header.stamp, twist.header.frame_id = self._node.get_clock().now().to_msg(), self._frame
        self._publisher.publish(twist)


def main() -> None:
    """Read keys to the end of the run."""
    rclpy.init()
    teleop = Teleop(Node("teleop_twist_keyboard"))
    print(TEXT)
    teleop.show()
    attributes = termios.tcgetattr(sys.stdin)
    tty.setraw(sys.stdin)
    try:
        while (key := sys.stdin.read(1)) not in ("", "\x03"):
            teleop.press(key)
        teleop.publish((0, 0, 0, 0))
    except KeyboardInterrupt:
        pass
    finally:
        termios.tcsetattr(sys.stdin, termios.TCSADRAIN, attributes)


if __name__ == "__main__":
    main()
