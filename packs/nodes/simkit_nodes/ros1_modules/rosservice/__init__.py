"""Services of ROS 1 by name."""

from __future__ import annotations

from typing import Any

from simkit_nodes.ros1_modules.roslib.message import get_service_class
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node

__all__ = ["ROSServiceException", "get_service_class_by_name", "get_service_list", "get_service_type"]


class ROSServiceException(Exception):
    """A service is unknown."""


def get_service_list(node: str | None = None, namespace: str | None = None, include_nodes: bool = False) -> list[str]:
    """Return the names of all services, or of those of a node or below a namespace."""
    graph = ros_node().host.graph
    service_names = [name for name, _ in graph.service_table.of_node(node)] if node else list(graph.services())
    return [name for name in service_names if namespace is None or name.startswith(namespace)]


def get_service_type(service_name: str) -> str | None:
    """Return the type of a service; None if it is unknown."""
    node = ros_node()
    kinds = node.host.graph.services().get(node.resolve(service_name))
    return kinds[0].replace("/srv/", "/") if kinds else None


def get_service_class_by_name(service_name: str) -> type[Any] | None:
    """Return the class of a service.

    Raises:
        ROSServiceException: the service is unknown.
    """
    kind = get_service_type(service_name)
    if kind is None:
        raise ROSServiceException(f"Service [{service_name}] is not available.")
    return get_service_class(kind)
