"""Menus of interactive markers."""

from __future__ import annotations

from simkit_nodes.interfaces import ROS1
from simkit_nodes.ros_modules.interactive_markers.menu_handler import MenuHandler

__all__ = ["InteractiveMarkerFeedback", "MenuEntry", "MenuHandler"]

InteractiveMarkerFeedback = ROS1.message_class("visualization_msgs/msg/InteractiveMarkerFeedback")
MenuEntry = ROS1.message_class("visualization_msgs/msg/MenuEntry")
