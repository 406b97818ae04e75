"""Names of the ROS 2 package `launch_xml`."""

from __future__ import annotations

__all__: list[str] = []
