"""Identifiers of goals."""

from __future__ import annotations

from typing import Any

from simkit_nodes.interfaces import ROS1, ProgramMessage
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node
from simkit_nodes.ros1_modules.rospy.rostime import get_rostime

__all__ = ["GoalIDGenerator"]


class GoalIDGenerator:
    """Source of identifiers, which count the goals of the program.

    Args:
        name: first part of the identifiers; None for the name of the node.
    """

    def __init__(self, name: str | None = None) -> None:
        self.set_name(name if name is not None else ros_node().name)

    def set_name(self, name: str) -> None:
        """Set the first part of the identifiers."""
        self.name = name

    def generate_ID(self) -> Any:
        """Return a new `actionlib_msgs.msg.GoalID`."""
        data = ros_node().program.data
        number = data["actionlib goals"] = data.get("actionlib goals", 0) + 1
        now = get_rostime()
        message: ProgramMessage = ROS1.message_class("actionlib_msgs/msg/GoalID")()
        message.id, message.stamp = f"{self.name}-{number}-{now.secs}.{now.nsecs}", now
        return message
