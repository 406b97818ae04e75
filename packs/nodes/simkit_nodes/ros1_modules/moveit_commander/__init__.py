"""Package `moveit_commander` of ROS 1: commands for MoveIt's node `move_group`."""

from __future__ import annotations

from simkit_nodes.ros1_modules.moveit_commander.exception import MoveItCommanderException
from simkit_nodes.ros1_modules.moveit_commander.move_group import MoveGroupCommander
from simkit_nodes.ros1_modules.moveit_commander.planning_scene_interface import PlanningSceneInterface
from simkit_nodes.ros1_modules.moveit_commander.robot import RobotCommander
from simkit_nodes.ros1_modules.moveit_commander.roscpp_initializer import roscpp_initialize, roscpp_shutdown

__all__ = [
    "MoveGroupCommander",
    "MoveItCommanderException",
    "PlanningSceneInterface",
    "RobotCommander",
    "roscpp_initialize",
    "roscpp_shutdown",
]
