"""Source of launch descriptions in YAML."""

from __future__ import annotations

from simkit_launch.launch_modules.launch.launch_description_source import YAMLLaunchDescriptionSource

__all__ = ["YAMLLaunchDescriptionSource"]
