"""Actions of ROS 1: goals with feedback and a result."""

from __future__ import annotations

from simkit_nodes.interfaces import ROS1
from simkit_nodes.ros1_modules.actionlib.action_client import ActionClient, ClientGoalHandle
from simkit_nodes.ros1_modules.actionlib.action_server import ActionServer
from simkit_nodes.ros1_modules.actionlib.action_types import (
    CommState,
    SimpleGoalState,
    TerminalState,
    get_name_of_constant,
)
from simkit_nodes.ros1_modules.actionlib.exceptions import ActionException
from simkit_nodes.ros1_modules.actionlib.goal_id_generator import GoalIDGenerator
from simkit_nodes.ros1_modules.actionlib.server_goal_handle import ServerGoalHandle
from simkit_nodes.ros1_modules.actionlib.simple_action_client import SimpleActionClient
from simkit_nodes.ros1_modules.actionlib.simple_action_server import SimpleActionServer

__all__ = [
    "ActionClient",
    "ActionException",
    "ActionServer",
    "ClientGoalHandle",
    "CommState",
    "GoalID",
    "GoalIDGenerator",
    "GoalStatus",
    "GoalStatusArray",
    "ServerGoalHandle",
    "SimpleActionClient",
    "SimpleActionServer",
    "SimpleGoalState",
    "TerminalState",
    "get_name_of_constant",
]

GoalID = ROS1.message_class("actionlib_msgs/msg/GoalID")
GoalStatus = ROS1.message_class("actionlib_msgs/msg/GoalStatus")
GoalStatusArray = ROS1.message_class("actionlib_msgs/msg/GoalStatusArray")
