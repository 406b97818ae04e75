"""Nodes that others configure, activate, deactivate and shut down."""

from __future__ import annotations

from simkit_nodes.ros_modules.rclpy.lifecycle.managed_entity import (
    ManagedEntity,
    SimpleManagedEntity,
    TransitionCallbackReturn,
)
from simkit_nodes.ros_modules.rclpy.lifecycle.node import LifecycleNode, LifecycleNodeMixin, LifecycleState
from simkit_nodes.ros_modules.rclpy.lifecycle.publisher import LifecyclePublisher

__all__ = [
    "LifecycleNode",
    "LifecycleNodeMixin",
    "LifecyclePublisher",
    "LifecycleState",
    "ManagedEntity",
    "Node",
    "NodeMixin",
    "Publisher",
    "SimpleManagedEntity",
    "State",
    "TransitionCallbackReturn",
]

Node, NodeMixin, State, Publisher = LifecycleNode, LifecycleNodeMixin, LifecycleState, LifecyclePublisher
