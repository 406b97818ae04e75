"""Questions of a node about the graph: a part of `rclpy.node.Node`."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from simkit_nodes.host import current_host
from simkit_nodes.names import RosArguments, join_name
from simkit_nodes.ros_modules.rclpy.constants import S_TO_NS
from simkit_nodes.ros_modules.rclpy.expand_topic_name import expand_topic_name
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import Handle, NodeNameNonExistentError
from simkit_nodes.ros_modules.rclpy.qos import profile_of
from simkit_nodes.ros_modules.rclpy.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from simkit_nodes.ros_modules.rclpy.validate_full_topic_name import validate_full_topic_name

if TYPE_CHECKING:
    from simkit_nodes.graph import Endpoint, GraphNode
    from simkit_nodes.programs import NodeProgram


class NodeQueries:
    """Questions of a node about topics and other nodes; a base class of `Node`."""

    _graph_node: GraphNode
    _handle: Handle
    _arguments: RosArguments
    _name: str
    _namespace: str

    def get_topic_names_and_types(self, no_demangle: bool = False) -> list[tuple[str, list[str]]]:
        """Return the topics and their types, sorted."""
        current_host().poll()
        with self._handle:
            return list(self._graph_node.graph.topics(self._graph_node.program).items())

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Return the names and the namespaces of all nodes."""
        current_host().poll()
        with self._handle:
            names = [name.rpartition("/") for name in self._graph_node.graph.nodes()]
        return [(name, namespace or "/") for namespace, _, name in names]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Return the names, the namespaces and the enclaves of all nodes."""
        return [(name, namespace, "/") for name, namespace in self.get_node_names_and_namespaces()]

    def get_node_names(self) -> list[str]:
        """Return the names of all nodes, without namespaces."""
        return [name for name, _ in self.get_node_names_and_namespaces()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """Return the names of all nodes, with namespaces."""
        return [join_name(namespace, name) for name, namespace in self.get_node_names_and_namespaces()]

    def _full_name(self, name: str, *, is_service: bool = False) -> str:
        with self._handle:
            full = expand_topic_name(name, self._name, self._namespace)
        validate_full_topic_name(full, is_service=is_service)
        return full

    def count_publishers(self, topic_name: str) -> int:
        """Return the number of publishers of a topic, without remapping."""
        current_host().poll()
        return len(self._graph_node.graph.publishers(self._full_name(topic_name), self._graph_node.program))

    def count_subscribers(self, topic_name: str) -> int:
        """Return the number of subscriptions of a topic, without remapping."""
        current_host().poll()
        return len(self._graph_node.graph.subscriptions(self._full_name(topic_name), self._graph_node.program))

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """Return the node, the type and the quality of service of each publisher of a topic."""
        current_host().poll()
        ends = self._graph_node.graph.publishers(self._queried_name(topic_name, no_mangle), self._graph_node.program)
        return [_endpoint_info(end, TopicEndpointTypeEnum.PUBLISHER) for end in ends]

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """Return the node, the type and the quality of service of each subscription of a topic."""
        current_host().poll()
        ends = self._graph_node.graph.subscriptions(self._queried_name(topic_name, no_mangle), self._graph_node.program)
        return [_endpoint_info(end, TopicEndpointTypeEnum.SUBSCRIPTION) for end in ends]

    def _queried_name(self, topic: str, no_mangle: bool) -> str:
        return topic if no_mangle else self._arguments.remap(self._full_name(topic), self._name, self._namespace)

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> list[tuple[str, list[str]]]:
        """Return the topics that a node publishes, and their types.

        Raises:
            NodeNameNonExistentError: there is no such node.
        """
        return self._topics_of(node_name, node_namespace, self._graph_node.graph.publishers)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> list[tuple[str, list[str]]]:
        """Return the topics that a node subscribes to, and their types.

        Raises:
            NodeNameNonExistentError: there is no such node.
        """
        return self._topics_of(node_name, node_namespace, self._graph_node.graph.subscriptions)

    def _topics_of(
        self, name: str, namespace: str, ends_of: Callable[[str, NodeProgram], list[Endpoint]]
    ) -> list[tuple[str, list[str]]]:
        full_name = join_name(namespace, name)
        graph, program = self._graph_node.graph, self._graph_node.program
        if full_name not in graph.nodes():
            raise NodeNameNonExistentError(f"cannot get names and types: node name not found: {full_name}")
        types = {
            topic: sorted({end.type_name for end in ends_of(topic, program) if end.node == full_name})
            for topic in graph.topics(program)
        }
        return [(topic, names) for topic, names in types.items() if names]

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Wait until a node exists.

        Args:
            fully_qualified_node_name: name with the namespace.
            timeout: longest wait [s].

        Returns:
            False if there is no such node at the end.
        """
        name = "/" + fully_qualified_node_name.lstrip("/")
        host = current_host()
        end_ns = host.now_ns() + int(timeout * S_TO_NS)
        while name not in self.get_fully_qualified_node_names() and host.now_ns() < end_ns:
            host.wait(min(end_ns, host.now_ns() + S_TO_NS // 10))
        return name in self.get_fully_qualified_node_names()


def _endpoint_info(end: Endpoint, kind: TopicEndpointTypeEnum) -> TopicEndpointInfo:
    namespace, _, name = end.node.rpartition("/")
    return TopicEndpointInfo(
        node_name=name,
        node_namespace=namespace or "/",
        topic_type=end.type_name,
        endpoint_type=kind,
        endpoint_gid=list(end.gid),
        qos_profile=profile_of(end.qos),
    )
