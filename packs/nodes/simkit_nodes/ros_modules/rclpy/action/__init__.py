"""Actions: servers, clients and questions about them."""

from __future__ import annotations

from simkit_nodes.ros_modules.rclpy.action.client import ActionClient
from simkit_nodes.ros_modules.rclpy.action.graph import (
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from simkit_nodes.ros_modules.rclpy.action.server import ActionServer, CancelResponse, GoalResponse

__all__ = [
    "ActionClient",
    "ActionServer",
    "CancelResponse",
    "GoalResponse",
    "get_action_client_names_and_types_by_node",
    "get_action_names_and_types",
    "get_action_server_names_and_types_by_node",
]
