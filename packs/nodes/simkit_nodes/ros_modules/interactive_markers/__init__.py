"""Markers that people move, as the ROS 2 package `interactive_markers`."""

from __future__ import annotations

from simkit_nodes.ros_modules.interactive_markers.interactive_marker_server import InteractiveMarkerServer
from simkit_nodes.ros_modules.interactive_markers.menu_handler import MenuHandler

__all__ = ["InteractiveMarkerServer", "MenuHandler"]
