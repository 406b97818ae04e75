"""Replacement of gz-transport's Python module: it uses the simulation's topics and services, and no network.

Each message is published as the ROS type that the bridge between Gazebo and ROS (`ros_gz_bridge`) uses. Therefore
`sim.subscribe` receives the messages of a system, and a recording contains them. Callbacks run between two steps, in
the order of the messages.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, NoReturn

from simkit.errors import MessageError
from simkit.extend import SharedByCopies, Where
from simkit_gz_python import simulation_context
from simkit_gz_python.math.missing_names import missing_name_error
from simkit_gz_python.msgs.message import MESSAGE_CLASSES, Message
from simkit_gz_python.msgs.ros_conversion import call_service, from_ros, to_ros, twins_of

if TYPE_CHECKING:
    from simkit import Plugin, Simulation
    from simkit import Publisher as TopicPublisher
    from simkit.runtime.communication.publisher import Listener

__all__ = ["AdvertiseMessageOptions", "AdvertiseServiceOptions", "Node", "Publisher", "SubscribeOptions"]

_NO_SIMULATION: Final = "this Node has no simulation yet; use it in a hook, or after the TestFixture is created"
_SCENE_POSES: Final = ("/pose/info", "/dynamic_pose/info")
"""Endings of the topics of gz's scene broadcaster, whose poses have plain names instead of scoped names."""

Handler = Callable[[Message], None]

_early_nodes: list[Node] = []
"""Nodes that a script created before the first simulation, with publishers or subscriptions to be connected."""


def adopt_early_nodes(sim: Simulation) -> None:
    """Connect publishers and subscriptions that were created before this simulation."""
    waiting, _early_nodes[:] = list(_early_nodes), []
    for node in waiting:
        node._connect(sim)


class _Options:
    """Options of gz-transport.

    Attributes:
        msgs_per_sec: largest rate of messages [Hz]. A value other than 0 has no effect and causes a warning
            (SK-PLUGIN-086), because every message is delivered.
    """

    def __init__(self, *_: object, **__: object) -> None:
        self.msgs_per_sec = 0


def _warn_of_rate(sim: Simulation, owner: Plugin | None, topic: str, options: _Options | None) -> None:
    rate = getattr(options, "msgs_per_sec", 0)
    if rate:
        message = f"msgs_per_sec = {rate} for {topic!r} has no effect: every message arrives"
        where = getattr(owner, "where", Where())
        sim.engine.reports.warning("SK-PLUGIN-086", message, where, "count steps, or compare info.sim_time")


class AdvertiseMessageOptions(_Options):
    """Options of a publisher."""


class AdvertiseServiceOptions(_Options):
    """Options of a service."""


class SubscribeOptions(_Options):
    """Options of a subscription."""


class Publisher(SharedByCopies):
    """Publisher of messages of one class on one topic."""

    def __init__(self, topic: str, kind: type[Message], options: _Options | None = None) -> None:
        self._topic, self._kind, self._options = topic, kind, options
        self._publisher: TopicPublisher | None = None  # None until a simulation exists
        self._ros = ""

    def _connect(self, sim: Simulation, owner: Plugin | None) -> None:
        _warn_of_rate(sim, owner, self._topic, self._options)
        known, types = sim.communication.bus.topics().get(self._topic), [twin.ros for twin in twins_of(self._kind)]
        self._ros = known if known in types else types[0]
        with sim.communication.bus.owned_by(owner):
            self._publisher = sim.communication.bus.advertise(self._topic, self._ros)

    def publish(self, message: Message) -> bool:
        """Publish a message.

        Raises:
            MessageError: the message is not of the advertised class.
        """
        if not isinstance(message, self._kind):
            got = type(message).__name__
            raise MessageError(f"{self._topic!r} was advertised for gz.msgs.{self._kind.__name__}, got {got}")
        if self._publisher is None:
            return True  # without a simulation there is no subscriber
        if self._publisher.wanted:
            self._publisher.publish(to_ros(message, self._ros))
        return True

    def valid(self) -> bool:
        return True

    def has_connections(self) -> bool:
        """Check whether the topic has a subscriber."""
        return self._publisher is not None and bool(self._publisher.wanted)

    def __bool__(self) -> bool:
        return True


class _Subscription:
    """Subscription of a node to a topic.

    Attributes:
        topic: absolute topic name.
        listener: subscriber of the simulation; None until a simulation exists.
    """

    def __init__(self, topic: str, kind: type[Message], callback: Handler, options: _Options | None = None) -> None:
        self.topic, self._kind, self._callback, self._options = topic, kind, callback, options
        self.listener: Listener | None = None

    def _on_message(self, message: object) -> None:
        received = from_ros(self._kind, message)
        if self._kind is MESSAGE_CLASSES["Pose_V"] and self.topic.endswith(_SCENE_POSES):
            for pose in received.pose:
                pose.name = pose.name.rpartition("::")[2]
        self._callback(received)

    def _connect(self, sim: Simulation, owner: Plugin | None) -> None:
        _warn_of_rate(sim, owner, self.topic, self._options)
        known, twins = sim.communication.bus.topics().get(self.topic), [twin.ros for twin in twins_of(self._kind)]
        types = sorted(twins, key=lambda ros: ros != known)  # the type that the topic already has is first
        called = self._on_message if owner is None else _call_as_owner(sim, owner, self.topic, self._on_message)
        with sim.communication.bus.owned_by(owner):
            self.listener = sim.communication.bus.listen(self.topic, types, called)


class Node(SharedByCopies):
    """Node for the simulation's topics and services."""

    def __init__(self, *_: object) -> None:
        current = simulation_context.current_simulation()
        # outside of a hook, the Node may be created before its simulation, so its first use finds the simulation
        is_known = current is not None and current[1] is not None
        self._sim = weakref.ref(current[0]) if is_known and current is not None else None
        self._owner = current[1] if is_known and current is not None else None
        self._subscriptions: dict[str, list[_Subscription]] = {}
        self._advertised: list[str] = []
        self._waiting: list[Publisher | _Subscription] = []

    def _find_simulation(self) -> Simulation | None:
        """Return the simulation of the node; None if no simulation exists yet."""
        if self._sim is None:
            current = simulation_context.current_simulation()
            if current is None:
                return None
            self._sim, self._owner = weakref.ref(current[0]), current[1]
        sim = self._sim()
        if sim is None:
            raise RuntimeError("the simulation of this Node no longer exists")
        return sim

    def _simulation(self) -> Simulation:
        sim = self._find_simulation()
        if sim is None:
            raise RuntimeError(_NO_SIMULATION)
        return sim

    def _open(self, endpoint: Publisher | _Subscription) -> None:
        """Connect a publisher or subscription now, or as soon as a simulation exists."""
        sim = self._find_simulation()
        if sim is not None:
            endpoint._connect(sim, self._owner)
            return
        self._waiting.append(endpoint)
        if self not in _early_nodes:
            _early_nodes.append(self)

    def _connect(self, sim: Simulation) -> None:
        self._sim, waiting = weakref.ref(sim), list(self._waiting)
        self._waiting.clear()
        for endpoint in waiting:
            endpoint._connect(sim, None)

    def advertise(self, topic: str, kind: type[Message], options: _Options | None = None) -> Publisher:
        """Create a publisher of messages of a class on a topic."""
        twins_of(kind)  # an unsupported class is an error here, not later when the simulation is created
        publisher = Publisher(_absolute_topic(topic), kind, options)
        self._advertised.append(publisher._topic)
        self._open(publisher)
        return publisher

    def subscribe(self, kind: Any, topic: Any, callback: Handler, options: _Options | None = None) -> bool:
        """Call `callback(message)` between two steps for each message of a class on a topic."""
        if isinstance(kind, str):  # in older versions of gz-transport, the topic is the first argument
            kind, topic = topic, kind
        twins_of(kind)
        subscription = _Subscription(_absolute_topic(topic), kind, callback, options)
        self._subscriptions.setdefault(subscription.topic, []).append(subscription)
        self._open(subscription)
        return True

    def unsubscribe(self, topic: str) -> bool:
        """Close the subscriptions of this node to a topic; return true if there were any."""
        subscriptions = self._subscriptions.pop(_absolute_topic(topic), [])
        for subscription in subscriptions:
            if subscription in self._waiting:
                self._waiting.remove(subscription)
            elif subscription.listener is not None:
                self._simulation().communication.bus.close(subscription.listener)
        return bool(subscriptions)

    def request(
        self, service: str, request: Message, request_kind: type[Message], response_kind: type[Message], timeout: int
    ) -> tuple[bool, Message]:
        """Call a service of the simulation.

        The supported services are those of a world with a request of type WorldControl, EntityFactory, Entity or Pose
        and a response of type Boolean.

        Returns:
            A flag and the response. The flag is true if the service exists and accepted the request.
        """
        return call_service(self._simulation(), _absolute_topic(service), request, response_kind)

    def topic_list(self) -> list[str]:
        return list(self._simulation().communication.bus.topics())

    def service_list(self) -> list[str]:
        return list(self._simulation().communication.services.names())

    def advertised_topics(self) -> list[str]:
        return list(self._advertised)

    def subscribed_topics(self) -> list[str]:
        return list(self._subscriptions)

    def __getattr__(self, name: str) -> NoReturn:
        raise missing_name_error("Node", name, dir(type(self)))


def _call_as_owner(sim: Simulation, owner: Plugin | None, topic: str, callback: Handler) -> Handler:
    """Wrap a plugin's callback: its errors count as the plugin's, and topics that it opens belong to the plugin."""

    def run(message: Message) -> None:
        previous = simulation_context.enter_simulation(sim, owner)
        try:
            callback(message)
        finally:
            simulation_context.leave_simulation(previous)

    guarded: Handler = sim.engine.faults.guard(owner, f"its callback for {topic!r}", run)
    return guarded


def _absolute_topic(topic: str) -> str:
    if not topic or any(c.isspace() for c in topic) or "//" in topic or "@" in topic:
        raise MessageError(f"{topic!r} is not a valid topic name")
    return topic if topic.startswith("/") else f"/{topic}"


def __getattr__(name: str) -> NoReturn:
    raise missing_name_error("gz.transport", name, __all__)
