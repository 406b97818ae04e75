"""Questions about actions."""

from __future__ import annotations

from typing import Any

from simkit_nodes.names import join_name
from simkit_nodes.ros_modules.rclpy.node_services import grouped_types

__all__ = [
    "get_action_client_names_and_types_by_node",
    "get_action_names_and_types",
    "get_action_server_names_and_types_by_node",
]

NamesAndTypes = list[tuple[str, list[str]]]


def get_action_client_names_and_types_by_node(
    node: Any, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the names and types of the actions of which a node has clients."""
    full_name = join_name(remote_node_namespace, remote_node_name)
    return grouped_types(node._graph_node.graph.action_clients_of(full_name))


def get_action_server_names_and_types_by_node(
    node: Any, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the names and types of the actions of a node."""
    full_name = join_name(remote_node_namespace, remote_node_name)
    return grouped_types(node._graph_node.graph.actions_of(full_name))


def get_action_names_and_types(node: Any) -> NamesAndTypes:
    """Return the names and types of all actions."""
    return list(node._graph_node.graph.actions().items())
