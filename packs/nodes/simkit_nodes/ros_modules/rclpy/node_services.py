"""Services, clients and actions of a node: a part of `rclpy.node.Node`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from simkit_nodes.interfaces import type_name_of
from simkit_nodes.names import join_name
from simkit_nodes.ros_modules.rclpy.client import Client
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import NodeNameNonExistentError
from simkit_nodes.ros_modules.rclpy.qos import QoSProfile, qos_profile_services_default
from simkit_nodes.ros_modules.rclpy.service import Service
from simkit_nodes.ros_modules.rclpy.type_support import check_is_valid_srv_type

if TYPE_CHECKING:
    from simkit_nodes.graph import GraphNode
    from simkit_nodes.graph_actions import GraphActionClient, GraphActionServer
    from simkit_nodes.ros_modules.rclpy.callback_groups import CallbackGroup
    from simkit_nodes.ros_modules.rclpy.context import Context


class NodeServices:
    """Services, clients and actions of a node; a base class of `Node`."""

    context: Context
    default_callback_group: CallbackGroup
    executor: Any
    _graph_node: GraphNode
    _clients: list[Client]
    _services: list[Service]

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the absolute name of a service."""
        raise NotImplementedError

    def _wake_executor(self) -> None:
        """Have the executor look for callbacks."""
        raise NotImplementedError

    def create_client(
        self,
        srv_type: object,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        """Create a client of a service.

        Args:
            srv_type: class of the service.
            srv_name: name of the service.
            qos_profile: QoS, which has no effect.
            callback_group: callback group; None for the default one of the node.
        """
        group = self.default_callback_group if callback_group is None else callback_group
        check_is_valid_srv_type(srv_type)
        graph_client = self._graph_node.client(self.resolve_service_name(srv_name), type_name_of(srv_type))
        client = Client(self.context, graph_client, srv_type, srv_name, qos_profile, group)
        client._wake, client._executor = self._wake_executor, lambda: self.executor
        group.add_entity(client)
        self._clients.append(client)
        self._wake_executor()
        return client

    def create_service(
        self,
        srv_type: object,
        srv_name: str,
        callback: Callable[[Any, Any], object],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Create a service.

        Args:
            srv_type: class of the service.
            srv_name: name of the service.
            callback: function or coroutine function that receives a request and an empty response, and returns the
                response.
            qos_profile: QoS, which has no effect.
            callback_group: callback group; None for the default one of the node.
        """
        group = self.default_callback_group if callback_group is None else callback_group
        check_is_valid_srv_type(srv_type)
        name, type_name = self.resolve_service_name(srv_name), type_name_of(srv_type)
        graph_service = self._graph_node.offer(name, type_name, self._wake_executor)
        service = Service(graph_service, srv_type, srv_name, callback, group, qos_profile)
        group.add_entity(service)
        self._services.append(service)
        self._wake_executor()
        return service

    def destroy_client(self, client: Client) -> bool:
        """Destroy a client; return False if it is not one of this node."""
        if client not in self._clients:
            return False
        self._clients.remove(client)
        client.destroy()
        self._wake_executor()
        return True

    def destroy_service(self, service: Service) -> bool:
        """Destroy a service; return False if it is not one of this node."""
        if service not in self._services:
            return False
        self._services.remove(service)
        service.destroy()
        self._wake_executor()
        return True

    # ------------------------------------------------------------------ questions about the graph

    def get_service_names_and_types(self) -> list[tuple[str, list[str]]]:
        """Return the services and their types, sorted."""
        return list(self._graph_node.graph.services().items())

    def get_service_names_and_types_by_node(self, node_name: str, node_namespace: str) -> list[tuple[str, list[str]]]:
        """Return the services of a node and their types, sorted.

        Raises:
            NodeNameNonExistentError: there is no such node.
        """
        return grouped_types(self._graph_node.graph.services_of(self._known_node(node_name, node_namespace)))

    def get_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> list[tuple[str, list[str]]]:
        """Return the services of which a node has clients, and their types, sorted.

        Raises:
            NodeNameNonExistentError: there is no such node.
        """
        return grouped_types(self._graph_node.graph.service_clients_of(self._known_node(node_name, node_namespace)))

    def _known_node(self, name: str, namespace: str) -> str:
        """Return the full name of a node."""
        full_name = join_name(namespace, name)
        if full_name not in self._graph_node.graph.nodes():
            raise NodeNameNonExistentError(
                f"Cannot get information about node: node '{name}' in namespace '{namespace}' does not exist"
            )
        return full_name

    def count_services(self, service_name: str) -> int:
        """Return 1 if a service exists, otherwise 0."""
        return int(self.resolve_service_name(service_name, only_expand=True) in self._graph_node.graph.services())

    def count_clients(self, service_name: str) -> int:
        """Return the number of clients that programs have of a service."""
        return self._graph_node.graph.count_clients(self.resolve_service_name(service_name, only_expand=True))

    # ------------------------------------------------------------------ actions

    def _open_action_server(self, name: str, type_name: str, result_timeout_ns: int) -> GraphActionServer:
        """Open an action on the graph."""
        absolute = self.resolve_service_name(name)
        return self._graph_node.act(absolute, type_name, result_timeout_ns, self._wake_executor)

    def _open_action_client(self, name: str, type_name: str) -> GraphActionClient:
        """Open a client of an action on the graph."""
        return self._graph_node.action_client(self.resolve_service_name(name), type_name)


def grouped_types(pairs: Iterable[tuple[str, str]]) -> list[tuple[str, list[str]]]:
    """Return each name with its types, sorted."""
    types: dict[str, list[str]] = {}
    for name, type_name in sorted(set(pairs)):
        types.setdefault(name, []).append(type_name)
    return list(types.items())
