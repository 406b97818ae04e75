"""turtlesim's turtle_teleop_key: drives a turtle with the arrow keys."""

from __future__ import annotations

import math
import os
import select
import sys
import termios
import tty

import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from rclpy.node import Node
from turtlesim.action import RotateAbsolute

TEXT = """Reading from keyboard
---------------------------
Use arrow keys to move the turtle.
Use g|b|v|c|d|e|r|t keys to rotate to absolute orientations. 'f' to cancel a rotation.
'q' to quit."""
ARROWS = {"\x1b[A": (1.0, 0.0), "\x1b[B": (-1.0, 0.0), "\x1b[C": (0.0, -1.0), "\x1b[D": (0.0, 1.0)}
"""Directions of the linear and the angular velocity."""

HEADINGS = {key: math.remainder(number * math.pi / 4, 2 * math.pi) for number, key in enumerate("gtredcvb")}
"""Headings of the keys around `f` [rad]."""


def read_key() -> str:
    """Wait for a key and return it; an arrow has three characters.

    The characters are read without a buffer, which would hide the rest of an arrow from `select`.
    """
    file = sys.stdin.fileno()
    key = os.read(file, 1)
    if key == b"\x1b" and select.select([sys.stdin], [], [], 0.01)[0]:
        key += os.read(file, 2)
    return key.decode(errors="replace")


def main() -> None:
    """Read keys to the end of the run."""
    rclpy.init()
    node = Node("teleop_turtle")
    linear, angular = (node.declare_parameter(name, 2.0).value for name in ("scale_linear", "scale_angular"))
    publisher = node.create_publisher(Twist, "turtle1/cmd_vel", 1)
    client = ActionClient(node, RotateAbsolute, "turtle1/rotate_absolute")
    goal = None
    print(TEXT)
    attributes = termios.tcgetattr(sys.stdin)
    tty.setcbreak(sys.stdin)
    try:
        while True:
            key = read_key()
            if key in ("q", "Q", ""):
                break
            if key in ARROWS:
                command = Twist()
                command.linear.x = ARROWS[key][0] * linear
                command.angular.z = ARROWS[key][1] * angular
                publisher.publish(command)
            elif key.lower() in HEADINGS and client.server_is_ready():
                sent = client.send_goal_async(RotateAbsolute.Goal(theta=HEADINGS[key.lower()]))
                rclpy.spin_until_future_complete(node, sent)
                goal = sent.result()
            elif key in ("f", "F") and goal is not None:
                goal.cancel_goal_async()
    except KeyboardInterrupt:
        pass
    finally:
        termios.tcsetattr(sys.stdin, termios.TCSADRAIN, attributes)


if __name__ == "__main__":
    main()
