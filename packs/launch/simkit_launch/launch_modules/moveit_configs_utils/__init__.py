"""Parameters of MoveIt, as the ROS 2 package `moveit_configs_utils`."""

from __future__ import annotations

from simkit_launch.launch_modules.moveit_configs_utils.moveit_configs_builder import MoveItConfigs, MoveItConfigsBuilder

__all__ = ["MoveItConfigs", "MoveItConfigsBuilder"]
