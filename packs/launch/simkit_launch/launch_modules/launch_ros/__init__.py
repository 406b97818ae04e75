"""Launch files with nodes, as the ROS 2 package `launch_ros`."""

from __future__ import annotations

__all__: list[str] = []
