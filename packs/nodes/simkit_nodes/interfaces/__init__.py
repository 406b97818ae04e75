"""Messages, services and actions as classes of Python, as programs with rclpy or rospy know them.

    module = interface_module("geometry_msgs.msg", ROS2)
    twist = module.Twist()
    message = ROS2.to_simkit("geometry_msgs/msg/Twist")(twist)
    copy = ROS2.to_program("geometry_msgs/msg/Twist")(message)

A class has the full name of its type; `type_name_of` returns it. `add_workspace` makes the definitions of a program's
own packages known.
"""

from __future__ import annotations

from simkit.errors import ArgumentTypeError
from simkit_nodes.interfaces.interface_modules import InterfaceModule, interface_module
from simkit_nodes.interfaces.message_flavour import TYPE_ATTRIBUTE, MessageFlavour, ProgramMessage
from simkit_nodes.interfaces.ros1_messages import ROS1
from simkit_nodes.interfaces.ros2_messages import ROS2
from simkit_nodes.interfaces.workspaces import add_workspace

__all__ = [
    "ROS1",
    "ROS2",
    "InterfaceModule",
    "MessageFlavour",
    "ProgramMessage",
    "add_workspace",
    "interface_module",
    "type_name_of",
]


def type_name_of(cls: object) -> str:
    """Return the full name of a class of a message, service or action, such as `geometry_msgs/msg/Twist`.

    Raises:
        ArgumentTypeError: the object is no such class, and no message.
    """
    name = getattr(cls, TYPE_ATTRIBUTE, None)
    if not isinstance(name, str):
        raise ArgumentTypeError(f"{cls!r:.80} is not a class of a message, service or action")
    return name
