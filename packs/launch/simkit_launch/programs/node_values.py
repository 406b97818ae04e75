"""Values of a node's parameters, in ROS 2 or from the parameter server of ROS 1."""

from __future__ import annotations

from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from simkit_launch.program_simulation import ros1_parameter


def value_of(node: Node, name: str, default: Any) -> Any:
    """Declare a parameter of any type and return its value; a private parameter of ROS 1 comes first.

    Args:
        node: node.
        name: name, with dots between its parts.
        default: default value.
    """
    found = ros1_parameter(node.get_fully_qualified_name(), name.replace(".", "/"))
    declared = node.declare_parameter(name, default, ParameterDescriptor(dynamic_typing=True)).value
    return declared if found is None else found
