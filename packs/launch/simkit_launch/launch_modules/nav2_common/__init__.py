"""Substitutions of Nav2's launch files, as the ROS 2 package `nav2_common`."""

from __future__ import annotations

__all__: list[str] = []
