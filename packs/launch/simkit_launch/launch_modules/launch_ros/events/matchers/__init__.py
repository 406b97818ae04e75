"""Functions that decide whether an event is for a node."""

from __future__ import annotations

from simkit_launch.launch_modules.launch_ros.events.lifecycle import matches_node_name

__all__ = ["matches_node_name"]
