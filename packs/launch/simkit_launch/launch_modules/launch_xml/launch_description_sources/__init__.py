"""Source of launch descriptions in XML."""

from __future__ import annotations

from simkit_launch.launch_modules.launch.launch_description_source import XMLLaunchDescriptionSource

__all__ = ["XMLLaunchDescriptionSource"]
