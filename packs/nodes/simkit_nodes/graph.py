"""Topics, services and actions between programs and the simulation.

All messages here are simkit's; the modules of ROS convert them to the messages that their programs know. A publisher
and a subscription of programs are connected in pairs, as ROS does. Each message of a program also goes to the
simulation's topic bus, for plugins, scripts, recorders and bridges.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final, TypeVar

from simkit_nodes.graph_actions import GraphActionClient, GraphActions, GraphActionServer, OutsideActions
from simkit_nodes.graph_endpoints import Closable, Delay
from simkit_nodes.graph_services import GraphClient, GraphService, GraphServices, OutsideServices
from simkit_nodes.graph_topics import GraphPublisher, GraphSubscription, OnEvent, Received
from simkit_nodes.qos import Qos, incompatible_policies
from simkit_nodes.simulation_topics import OutsideEndpoint, OutsidePublisher, OutsideTopics

if TYPE_CHECKING:
    from simkit.msgs import Message
    from simkit_nodes.host import Host
    from simkit_nodes.programs import NodeProgram

_DRAWN: Final = 2**64  # `Host.seed_of` returns numbers below it
_NANOSECONDS: Final = 1_000_000_000
EndT = TypeVar("EndT", "GraphPublisher", "GraphSubscription")


@dataclass(frozen=True)
class Endpoint:
    """Publisher or subscription of a topic, for questions about the graph.

    Attributes:
        node: full name of its node.
        type_name: ROS 2 type.
        qos: quality of service.
        gid: 16 numbers that distinguish it from all others; zeros for one of the simulation.
    """

    node: str
    type_name: str
    qos: Qos
    gid: tuple[int, ...] = (0,) * 16


class GraphNode:
    """Node of a program; see `Graph.open_node`.

    Attributes:
        graph: graph.
        program: program of the node.
        name: full name of the node.
        endpoints: what the node has opened.
    """

    def __init__(self, graph: Graph, program: NodeProgram, name: str) -> None:
        self.graph, self.program, self.name = graph, program, name
        self.endpoints: list[Closable] = []

    def advertise(self, topic: str, type_name: str, qos: Qos, on_event: OnEvent | None = None) -> GraphPublisher:
        """Open a publisher.

        Args:
            topic: absolute name of the topic.
            type_name: ROS 2 type, such as `geometry_msgs/msg/Twist`.
            qos: quality of service.
            on_event: function that receives events such as an incompatible subscription.
        """
        publisher = GraphPublisher(self, topic, type_name, qos, on_event)
        self.endpoints.append(publisher)
        self.graph.add_publisher(publisher)
        return publisher

    def subscribe(
        self,
        topic: str,
        type_name: str,
        qos: Qos,
        on_event: OnEvent | None = None,
        on_message: Callable[[], None] | None = None,
    ) -> GraphSubscription:
        """Open a subscription.

        Args:
            topic: absolute name of the topic.
            type_name: ROS 2 type.
            qos: quality of service.
            on_event: function that receives events such as an incompatible publisher.
            on_message: function that is called after a message has been put into the queue; None for `Host.wake`.
        """
        subscription = GraphSubscription(self, topic, type_name, qos, on_event, on_message)
        self.endpoints.append(subscription)
        self.graph.add_subscription(subscription)
        return subscription

    def offer(self, service: str, type_name: str, on_request: Callable[[], None] | None = None) -> GraphService:
        """Open a service.

        Args:
            service: absolute name of the service.
            type_name: service type, such as `std_srvs/srv/Trigger`.
            on_request: function that is called after a request has been put into the queue; None for `Host.wake`.
        """
        offered = GraphService(self, service, type_name, on_request)
        self.endpoints.append(offered)
        self.graph.service_table.add(offered)
        return offered

    def client(self, service: str, type_name: str) -> GraphClient:
        """Open a client of a service.

        Args:
            service: absolute name of the service.
            type_name: service type.
        """
        client = GraphClient(self, service, type_name)
        self.endpoints.append(client)
        return client

    def act(
        self, action: str, type_name: str, result_timeout_ns: int, on_request: Callable[[], None] | None = None
    ) -> GraphActionServer:
        """Open an action.

        Args:
            action: absolute name of the action.
            type_name: action type, such as `example_interfaces/action/Fibonacci`.
            result_timeout_ns: time for which the result of a goal is kept [ns].
            on_request: function that is called after a goal or a cancel request has been put into its queue; None for
                `Host.wake`.
        """
        server = GraphActionServer(self, action, type_name, result_timeout_ns, on_request)
        self.endpoints.append(server)
        self.graph.action_table.add(server)
        return server

    def action_client(self, action: str, type_name: str) -> GraphActionClient:
        """Open a client of an action.

        Args:
            action: absolute name of the action.
            type_name: action type.
        """
        client = GraphActionClient(self, action, type_name)
        self.endpoints.append(client)
        return client

    def close(self) -> None:
        """Close the node and everything that it has opened."""
        while self.endpoints:
            self.endpoints.pop().close()
        self.graph.remove_node(self)


class Graph:
    """Communication of all programs.

    Args:
        outside: topics of the simulation.
        services: services of the simulation.
        actions: actions of the simulation.
        enqueue: function that calls a function after the requests to the simulation that wait.
        host: world around the programs.
        run_programs: function that runs the programs without a step.

    Attributes:
        outside: topics of the simulation.
        service_table: services of the programs.
        action_table: actions of the programs.
        sent: message of a program that the topic bus passes on now.
        has_simulated_time: True if `now_ns` is the simulated time, which `/clock` shows, too.
        jumps: number of times that simulated time has jumped, as after a restore.
        shared: objects that all programs share, by name, such as the parameters of ROS 1.
        run_parameters: first parameters of ROS 1, as pairs of a global name and a value; a reset keeps them.
    """

    has_simulated_time = True

    def __init__(
        self,
        outside: OutsideTopics,
        services: OutsideServices,
        actions: OutsideActions,
        enqueue: Callable[[Callable[[], None]], None],
        host: Host,
        run_programs: Callable[[], None],
    ) -> None:
        self.outside = outside
        self.service_table = GraphServices(services, self, run_programs)
        self.action_table = GraphActions(actions, enqueue, self)
        self.now_ns, self.wake, self.seed_of = host.now_ns, host.wake, host.seed_of
        self.sent: object = None
        self.jumps = 0
        self.shared: dict[str, object] = {}
        self.run_parameters: list[tuple[str, object]] = []
        self._nodes: list[GraphNode] = []
        self._publishers: dict[str, list[GraphPublisher]] = {}
        self._subscriptions: dict[str, list[GraphSubscription]] = {}
        self._calls: list[tuple[int, int, Callable[[], None]]] = []
        self._call_number = self._gid = 0

    # ------------------------------------------------------------------ time

    @property
    def next_ns(self) -> int | None:
        """Time of the next call of `call_at` [ns]; None without one."""
        return self._calls[0][0] if self._calls else None

    def call_at(self, time_ns: int, function: Callable[[], None]) -> None:
        """Call a function at a simulated time [ns], before the programs."""
        is_next = not self._calls or time_ns < self._calls[0][0]
        self._call_number += 1
        heapq.heappush(self._calls, (time_ns, self._call_number, function))
        if is_next:
            self.wake()  # the steps that are made now may have been planned up to a later time

    def follow_jump(self, duration_ns: int) -> None:
        """Move what is due later, after simulated time has jumped by a duration [ns]."""
        self.jumps += 1
        self._calls = [(time_ns + duration_ns, number, function) for time_ns, number, function in self._calls]
        for node in self._nodes:
            for end in node.endpoints:
                if isinstance(end, GraphSubscription):
                    end.follow_jump(duration_ns)
        self.wake()

    def deliver(self) -> None:
        """Make the calls of `call_at` that are due."""
        now = self.now_ns()
        while self._calls and self._calls[0][0] <= now:
            heapq.heappop(self._calls)[2]()

    def after_discovery(self, node: GraphNode, function: Callable[[], None]) -> None:
        """Call a function when others know what a node opens now: after its program's discovery, at least one step."""
        self.call_at(self.now_ns() + self.discovery_ns(node), function)

    def discovery_ns(self, node: GraphNode) -> int:
        """Return the time after which the others know something new of a node [ns]; at least one step."""
        return max(1, round(node.program.options.discovery * _NANOSECONDS))

    def latency_ns(self, subscription: GraphSubscription | Delay, number: int) -> int:
        """Return the latency of a message [ns].

        Args:
            subscription: subscription of the message; or service or action that the message belongs to.
            number: number of the message of this subscription: 1, 2, …
        """
        latency = subscription.node.program.options.latency
        if isinstance(latency, tuple):
            shortest, longest = latency
            drawn = self.seed_of(f"{subscription.node.name}:{subscription.topic}:{number}") / _DRAWN
            latency = shortest + drawn * (longest - shortest)
        return round(latency * _NANOSECONDS)

    # ------------------------------------------------------------------ nodes, publishers and subscriptions

    def open_node(self, program: NodeProgram, name: str) -> GraphNode:
        """Add a node to the graph.

        Args:
            program: program of the node.
            name: full name, such as `/robot/driver`.
        """
        node = GraphNode(self, program, name)
        self._nodes.append(node)
        self.outside.open_node(name)
        return node

    def remove_node(self, node: GraphNode) -> None:
        """Remove a node that was closed."""
        if node in self._nodes:
            self._nodes.remove(node)
            self.outside.close_node(node.name)

    def new_gid(self) -> tuple[int, ...]:
        """Return the next 16 numbers of a publisher or subscription."""
        self._gid += 1
        return tuple((1 << 120 | self._gid).to_bytes(16, "big"))

    def add_publisher(self, publisher: GraphPublisher) -> None:
        """Connect a publisher with its subscriptions: those of its program at once, others after the discovery.

        A program with ROS also knows its own publishers and subscriptions at once.
        """
        for subscription in self._open_ends(GraphSubscription, publisher):
            self._match(publisher, subscription)
        self.after_discovery(publisher.node, partial(self._discover_publisher, publisher))

    def add_subscription(self, subscription: GraphSubscription) -> None:
        """Connect a subscription with its publishers; see `add_publisher`."""
        for publisher in self._open_ends(GraphPublisher, subscription):
            self._match(publisher, subscription)
        self.after_discovery(subscription.node, partial(self._discover_subscription, subscription))

    def _discover_publisher(self, publisher: GraphPublisher) -> None:
        if publisher.is_open:
            self._publishers.setdefault(publisher.topic, []).append(publisher)
            publisher.is_discovered = True
            publisher.discover()
            for subscription in tuple(self._subscriptions.get(publisher.topic, ())):
                if subscription.node.program is not publisher.node.program:
                    self._match(publisher, subscription)
            self.wake()

    def _discover_subscription(self, subscription: GraphSubscription) -> None:
        if subscription.is_open:
            self._subscriptions.setdefault(subscription.topic, []).append(subscription)
            subscription.is_discovered = True
            subscription.discover()
            for publisher in tuple(self._publishers.get(subscription.topic, ())):
                if subscription.node.program is not publisher.node.program:
                    self._match(publisher, subscription)
            self.wake()

    def _open_ends(self, kind: type[EndT], end: GraphPublisher | GraphSubscription) -> list[EndT]:
        """Return the publishers or subscriptions of the same program and topic as another one's."""
        nodes = [node for node in self._nodes if node.program is end.node.program]
        ends = [other for node in nodes for other in node.endpoints if isinstance(other, kind)]
        return [other for other in ends if other.topic == end.topic]

    def _match(self, publisher: GraphPublisher, subscription: GraphSubscription) -> None:
        if publisher.type_name != subscription.type_name:
            publisher.tell("incompatible_type")
            subscription.tell("incompatible_type")
            return
        policies = incompatible_policies(publisher.qos, subscription.qos)
        if policies:
            publisher.tell("incompatible_qos", policies[0])
            subscription.tell("incompatible_qos", policies[0])
            return
        publisher.subscriptions.append(subscription)
        subscription.publishers.append(publisher)
        publisher.tell("matched")
        subscription.tell("matched")
        if subscription.qos.is_transient_local:
            depth = subscription.qos.depth
            kept = publisher.kept
            now = self.now_ns()
            for item in kept if depth is None else kept[-depth:]:
                subscription.receive(Received(item.message, publisher, item.number, item.source_ns, now))

    def is_of_simulation(self, topic: str, message: object) -> bool:
        """Check whether the last message of a latched topic is of the simulation: those of programs come directly."""
        return not any(
            received.message is message for publisher in self._publishers.get(topic, ()) for received in publisher.kept
        )

    def remove_publisher(self, publisher: GraphPublisher) -> None:
        """Disconnect a publisher that was closed."""
        _discard(self._publishers, publisher.topic, publisher)
        _discard_item(publisher.node.endpoints, publisher)
        for subscription in publisher.subscriptions:
            subscription.publishers.remove(publisher)
            subscription.tell("unmatched")
        publisher.subscriptions.clear()

    def remove_subscription(self, subscription: GraphSubscription) -> None:
        """Disconnect a subscription that was closed."""
        _discard(self._subscriptions, subscription.topic, subscription)
        _discard_item(subscription.node.endpoints, subscription)
        for publisher in subscription.publishers:
            publisher.subscriptions.remove(subscription)
            publisher.tell("unmatched")
        subscription.publishers.clear()

    def send_outside(self, outside: OutsidePublisher, message: Message) -> None:
        """Publish a message of a program on the topic bus; the programs do not get it from there."""
        before, self.sent = self.sent, message
        try:
            outside.publish(message)
        finally:
            self.sent = before

    # ------------------------------------------------------------------ questions

    def topics(self, program: NodeProgram | None = None) -> dict[str, list[str]]:
        """Return the types by topic, sorted, also of topics that only have subscriptions.

        Args:
            program: program that asks; it knows its own publishers and subscriptions before their discovery.
        """
        types: dict[str, set[str]] = {topic: {kind} for topic, kind in self.outside.topics().items() if kind}
        for node in self._nodes:
            for end in node.endpoints:
                if isinstance(end, (GraphPublisher, GraphSubscription)) and self._is_known(end, program):
                    types.setdefault(end.topic, set()).add(end.type_name)
        return {topic: sorted(types[topic]) for topic in sorted(types)}

    def services(self) -> dict[str, list[str]]:
        """Return the types by service, sorted, of programs and of the simulation."""
        return {name: [type_name] for name, type_name in self.service_table.names().items()}

    def has_service(self, name: str) -> bool:
        """Check whether there is a service of a name, also one that `services` omits."""
        return self.service_table.exists(name)

    def actions(self) -> dict[str, list[str]]:
        """Return the types by action, sorted, of programs and of the simulation."""
        return {name: [type_name] for name, type_name in self.action_table.names().items()}

    def services_of(self, node: str) -> list[tuple[str, str]]:
        """Return name and type of the services of a program's node, sorted."""
        return self.service_table.of_node(node)

    def service_clients_of(self, node: str) -> list[tuple[str, str]]:
        """Return name and type of the services of which a program's node has clients, sorted."""
        return self.service_table.clients_of_node(node)

    def count_clients(self, service: str) -> int:
        """Return the number of clients that programs have of a service."""
        return sum(client.name == service for client in self.service_table.clients)

    def actions_of(self, node: str) -> list[tuple[str, str]]:
        """Return name and type of the actions of a program's node, sorted."""
        return self.action_table.of_node(node)

    def action_clients_of(self, node: str) -> list[tuple[str, str]]:
        """Return name and type of the actions of which a program's node has clients, sorted."""
        return self.action_table.clients_of_node(node)

    def nodes(self) -> list[str]:
        """Return the full names of all nodes: those of programs in the order of their start, then the simulation's."""
        names = [node.name for node in self._nodes]
        return names + [name for name in self.outside.nodes() if name not in names]

    def publishers(self, topic: str, program: NodeProgram | None = None) -> list[Endpoint]:
        """Return the publishers of a topic; see `topics`."""
        return [*self._inner(GraphPublisher, topic, program), *_outer(self.outside.publishers(topic))]

    def subscriptions(self, topic: str, program: NodeProgram | None = None) -> list[Endpoint]:
        """Return the subscriptions of a topic; see `topics`."""
        return [*self._inner(GraphSubscription, topic, program), *_outer(self.outside.subscriptions(topic))]

    def _is_known(self, end: GraphPublisher | GraphSubscription, program: NodeProgram | None) -> bool:
        return end.is_discovered or end.node.program is program

    def _inner(self, kind: type[EndT], topic: str, program: NodeProgram | None) -> list[Endpoint]:
        ends = [end for node in self._nodes for end in node.endpoints if isinstance(end, kind)]
        return [
            Endpoint(end.node.name, end.type_name, end.qos, end.gid)
            for end in ends
            if end.topic == topic and self._is_known(end, program)
        ]

    # ------------------------------------------------------------------ end

    def close_program(self, program: NodeProgram) -> None:
        """Close the nodes of a program that has ended."""
        for node in tuple(self._nodes):
            if node.program is program:
                node.close()

    def clear(self) -> None:
        """Close everything that programs have opened."""
        for node in tuple(self._nodes):
            node.close()
        self.action_table.clear()
        self._calls.clear()
        self.shared.clear()


def _outer(ends: list[OutsideEndpoint]) -> list[Endpoint]:
    return [Endpoint(end.node, end.type_name, Qos(is_transient_local=end.is_latched)) for end in ends]


def _discard(table: dict[str, list[Any]], topic: str, item: object) -> None:
    """Remove an item of a table of lists, and the list if it is empty."""
    _discard_item(table.get(topic, []), item)
    if topic in table and not table[topic]:
        del table[topic]


def _discard_item(items: list[Any], item: object) -> None:
    if item in items:
        items.remove(item)
