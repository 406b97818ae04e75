"""Everything that the bridge needs of rclpy: nodes, publishers, subscriptions and services of CDR bytes."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol

from simkit_ros.ros_types import RosType, TypeFinder

if TYPE_CHECKING:
    from rclpy.client import Client
    from rclpy.node import Node
    from rclpy.publisher import Publisher
    from rclpy.qos import QoSProfile
    from rclpy.service import Service
    from rclpy.subscription import Subscription

_DEPTH, _LARGE_DEPTH = 100, 10  # messages that a publisher keeps for a slow subscription
_LARGE = frozenset({"sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/Image", "sensor_msgs/msg/PointCloud2"})
_SERVICES_OF_EVERY_NODE = ("rcl_interfaces/srv/", "type_description_interfaces/srv/")
_LATCHED_DEPTHS = {"/tf_static": 100, "/rosout": 1000}  # the last message is not enough of these latched topics


class Qos(NamedTuple):
    """Quality of service of a publisher or subscription: whether it is reliable, whether it is latched, its depth."""

    is_reliable: bool = True
    is_latched: bool = False
    depth: int = _DEPTH


def publisher_qos(topic: str, type_name: str, *, is_latched: bool) -> Qos:
    """Return the quality of service of an outgoing topic; a reliable publisher serves every subscription.

    Args:
        topic: name of the topic in the simulation.
        type_name: type of its messages.
        is_latched: True if later subscriptions receive the last message.
    """
    name = "/" + topic.rpartition("/")[2]
    usual = 1 if is_latched else _LARGE_DEPTH if type_name in _LARGE else _DEPTH
    return Qos(True, is_latched or name == "/rosout", _LATCHED_DEPTHS.get(name, usual))


class RequestHeader(Protocol):
    """Header of a request in rclpy; its response is sent with the same id."""

    @property
    def request_id(self) -> object: ...


class ServiceEnd:
    """Service server whose requests and responses are CDR.

    Attributes:
        name: name of the service in ROS.
    """

    def __init__(self, service: Service, ros_type: RosType) -> None:
        self.service, self._type, self.name = service, ros_type, str(service.srv_name)

    def take(self) -> tuple[bytes, RequestHeader] | None:
        """Return the CDR of the next request and the header for its answer; None if there is no request."""
        handle = self.service.handle
        with handle:
            request, header = handle.service_take_request(self._type.cls.Request)
        return None if header is None else (self._type.to_cdr(request), header)

    def respond(self, header: RequestHeader, data: bytes) -> None:
        """Send a response, given as CDR."""
        response = self._type.from_cdr(data, self._type.cls.Response)
        handle = self.service.handle
        with handle:
            handle.service_send_response(response, header.request_id)


class ClientEnd:
    """Client of a service whose requests and responses are CDR."""

    def __init__(self, client: Client, ros_type: RosType) -> None:
        self.client, self._type = client, ros_type

    def is_ready(self) -> bool:
        """Check whether ROS has connected the client to the service."""
        return bool(self.client.service_is_ready())

    def send(self, data: bytes) -> int:
        """Send a request, given as CDR, and return its number."""
        request = self._type.from_cdr(data, self._type.cls.Request)
        handle = self.client.handle
        with handle:
            return int(handle.send_request(request))

    def take(self) -> tuple[int, bytes] | None:
        """Return the number of a request and the CDR of its response; None if no response has arrived."""
        handle = self.client.handle
        with handle:
            header, response = handle.take_response(self._type.cls.Response) or (None, None)
        return None if header is None else (int(header.request_id.sequence_number), self._type.to_cdr(response))


class SubscriptionEnd:
    """Subscription whose messages are CDR."""

    def __init__(self, subscription: Subscription, ros_type: RosType) -> None:
        self.subscription, self._type = subscription, ros_type

    def take(self) -> bytes | None:
        """Return the CDR of the next message; None if there is no message."""
        handle = self.subscription.handle
        with handle:
            message = handle.take_message(self._type.cls, True)
        return None if message is None else bytes(message[0])


class RosSession:
    """Participant in the graph of ROS 2, with a main node and one node for each node that has parameters.

    Args:
        name: name of the main node.
        namespace: namespace of all nodes, such as `/robot`; empty for none.
        arguments: arguments of ROS, such as `["-r", "/scan:=/lidar"]`.

    Attributes:
        types: finder of message, service and action classes.
        context: context of rclpy.
        node: main node.
    """

    def __init__(self, name: str, namespace: str, arguments: Sequence[str]) -> None:
        import rclpy
        from rclpy.node import Node

        self._rclpy, self._node_class = rclpy, Node
        self.context = rclpy.Context()
        words = ["--ros-args", *arguments] if arguments else []
        rclpy.init(args=words, context=self.context, signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
        self._nodes: dict[str, Node] = {}
        self.node = self._open_node(name, namespace)
        self.types = TypeFinder()

    def _open_node(self, name: str, namespace: str) -> Node:
        from rclpy.parameter import Parameter

        silent = [Parameter("start_type_description_service", Parameter.Type.BOOL, False)]
        return self._node_class(
            name,
            context=self.context,
            namespace=namespace or "/",
            enable_rosout=False,
            start_parameter_services=False,
            parameter_overrides=silent,
        )

    def node_of(self, full_name: str) -> Node:
        """Return the node with a full name, such as `/arm_controller`; it is opened at the first call."""
        if full_name not in self._nodes:
            namespace, _, name = full_name.rpartition("/")
            self._nodes[full_name] = self._open_node(name, namespace)
        return self._nodes[full_name]

    def close_nodes_except(self, names: Collection[str]) -> None:
        """Close the nodes whose full names are not in a collection; they must have no services any more."""
        for full_name in [n for n in self._nodes if n not in names]:
            self._nodes.pop(full_name).destroy_node()

    @property
    def node_count(self) -> int:
        """Number of open nodes."""
        return 1 + len(self._nodes)

    # ------------------------------------------------------------------ topics

    def profile(self, qos: Qos) -> QoSProfile:
        """Return the profile of rclpy for a quality of service."""
        from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

        return QoSProfile(
            history=HistoryPolicy.KEEP_LAST,
            depth=qos.depth,
            reliability=ReliabilityPolicy.RELIABLE if qos.is_reliable else ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if qos.is_latched else DurabilityPolicy.VOLATILE,
        )

    def advertise(self, topic: str, ros_type: RosType, qos: Qos) -> Publisher:
        """Open a publisher; `publish(cdr)` sends a message, and `get_subscription_count()` counts subscriptions."""
        return self.node.create_publisher(ros_type.cls, topic, self.profile(qos))

    def subscribe(self, topic: str, ros_type: RosType, qos: Qos) -> SubscriptionEnd:
        """Open a subscription."""
        subscription = self.node.create_subscription(ros_type.cls, topic, _unused, self.profile(qos), raw=True)
        return SubscriptionEnd(subscription, ros_type)

    def publishers_of(self, topic: str) -> list[tuple[str, bool, bool]]:
        """Return type, reliability and latching of every publisher of a topic, except those of this session."""
        from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

        ours = {(n.get_name(), n.get_namespace()) for n in (self.node, *self._nodes.values())}
        return [
            (
                end.topic_type,
                end.qos_profile.reliability == ReliabilityPolicy.RELIABLE,
                end.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL,
            )
            for end in self.node.get_publishers_info_by_topic(self.node.resolve_topic_name(topic))
            if (end.node_name, end.node_namespace) not in ours
        ]

    def subscription_qos(self, publishers: Sequence[tuple[str, bool, bool]]) -> Qos:
        """Return the strictest quality of service that all publishers of a topic offer."""
        is_reliable = all(reliable for _, reliable, _ in publishers)
        return Qos(is_reliable, bool(publishers) and all(latched for *_, latched in publishers), _DEPTH)

    # ------------------------------------------------------------------ services

    def offer(self, name: str, ros_type: RosType, node: Node | None = None) -> ServiceEnd:
        """Open a service server on a node; default: the main node."""
        from rclpy.qos import qos_profile_services_default

        owner = self.node if node is None else node
        service = owner.create_service(ros_type.cls, name, _unused, qos_profile=qos_profile_services_default)
        return ServiceEnd(service, ros_type)

    def call(self, name: str, ros_type: RosType) -> ClientEnd:
        """Open a client of a service."""
        return ClientEnd(self.node.create_client(ros_type.cls, name), ros_type)

    def services_of_others(self) -> dict[str, str]:
        """Return the types of the services of other nodes, by name, except those of actions and of parameters."""
        nodes = (self.node, *self._nodes.values())
        ours = {
            name
            for node in nodes
            for name, _ in self.node.get_service_names_and_types_by_node(node.get_name(), node.get_namespace())
        }
        types_by_name = {
            name: types[0]
            for name, types in self.node.get_service_names_and_types()
            if name not in ours and "/_" not in name and not types[0].startswith(_SERVICES_OF_EVERY_NODE)
        }
        # a name may have clients only
        return {name: kind for name, kind in types_by_name.items() if self.node.count_services(name)}

    def close_service(self, end: ServiceEnd) -> None:
        """Close a service server."""
        for node in (self.node, *self._nodes.values()):
            if end.service in node.services:
                node.destroy_service(end.service)

    def close(self) -> None:
        """Close all nodes."""
        for node in (self.node, *self._nodes.values()):
            node.destroy_node()
        self._rclpy.shutdown(context=self.context)


def _unused(*_: object) -> None:
    """Do nothing; the bridge reads messages and requests itself, because no executor runs."""
