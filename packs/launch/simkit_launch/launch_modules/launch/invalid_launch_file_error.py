"""Exception for a launch file that cannot be read."""

from __future__ import annotations

from simkit_launch.launch_modules.launch.launch_description_sources import InvalidLaunchFileError

__all__ = ["InvalidLaunchFileError"]
