"""gz-transport's Python over the topics and services of the simulation: nothing leaves the process.

Messages go as the ROS types that the bridge between Gazebo and ROS makes of them, so what a system publishes is read by
`sim.subscribe` and recorded like all else. Callbacks run between two steps, in order.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, NoReturn

from simkit.diagnostics import NOWHERE
from simkit.errors import MessageError
from simkit.plugins.gz_python import simulation_context
from simkit.plugins.gz_python.math.missing_names import missing_name_error
from simkit.plugins.gz_python.msgs.message import MESSAGE_CLASSES, Message
from simkit.plugins.gz_python.msgs.ros_conversion import call_service, from_ros, to_ros, twins_of
from simkit.plugins.shared_by_copies import SharedByCopies

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin
    from simkit.runtime import Simulation
    from simkit.runtime.communication.publisher import Listener
    from simkit.runtime.communication.publisher import Publisher as TopicPublisher

__all__ = ["AdvertiseMessageOptions", "AdvertiseServiceOptions", "Node", "Publisher", "SubscribeOptions"]

_NO_SIMULATION: Final = (
    "no simulation is there yet that this Node could belong to; use it in a hook, or after the TestFixture is made"
)
_SCENE_POSES: Final = ("/pose/info", "/dynamic_pose/info")
"""Topics whose poses have names without those of what they are in: of gz's scene broadcaster."""

Handler = Callable[[Message], None]

_early_nodes: list[Node] = []
"""Nodes that topics were asked of before there was a simulation: a script may make them first."""


def adopt_early_nodes(sim: Simulation) -> None:
    """Opens on a new simulation what nodes were asked for before it was there."""
    waiting, _early_nodes[:] = list(_early_nodes), []
    for node in waiting:
        node._connect(sim)


class _Options:
    """Options of gz-transport.

    Attributes:
        msgs_per_sec: has no effect here, and a warning (SK-PLUGIN-086) says so: every message arrives.
    """

    def __init__(self, *_: object, **__: object) -> None:
        self.msgs_per_sec = 0


def _warn_of_rate(sim: Simulation, owner: Plugin | None, topic: str, options: _Options | None) -> None:
    rate = getattr(options, "msgs_per_sec", 0)
    if rate:
        message = f"msgs_per_sec = {rate} for {topic!r} has no effect: every message arrives"
        where = getattr(owner, "where", NOWHERE)
        sim.engine.reports.warning("SK-PLUGIN-086", message, where, "count steps, or compare info.sim_time")


class AdvertiseMessageOptions(_Options):
    """Options of a publisher."""


class AdvertiseServiceOptions(_Options):
    """Options of a service."""


class SubscribeOptions(_Options):
    """Options of a subscription."""


class Publisher(SharedByCopies):
    """Publishes messages of one class on one topic."""

    def __init__(self, topic: str, kind: type[Message], options: _Options | None = None) -> None:
        self._topic, self._kind, self._options = topic, kind, options
        self._publisher: TopicPublisher | None = None  # until there is a simulation
        self._ros = ""

    def _connect(self, sim: Simulation, owner: Plugin | None) -> None:
        _warn_of_rate(sim, owner, self._topic, self._options)
        known, types = sim.topics().get(self._topic), [twin.ros for twin in twins_of(self._kind)]
        self._ros = known if known in types else types[0]
        with sim.communication.bus.owned_by(owner):
            self._publisher = sim.communication.bus.advertise(self._topic, self._ros)

    def publish(self, message: Message) -> bool:
        """Sends a message.

        Raises:
            MessageError: it is of another class than was advertised.
        """
        if not isinstance(message, self._kind):
            got = type(message).__name__
            raise MessageError(f"{self._topic!r} was advertised for gz.msgs.{self._kind.__name__}, got {got}")
        if self._publisher is None:
            return True  # nobody could hear it
        if self._publisher.wanted:
            self._publisher.publish(to_ros(message, self._ros))
        return True

    def valid(self) -> bool:
        return True

    def has_connections(self) -> bool:
        """Check whether somebody reads now."""
        return self._publisher is not None and bool(self._publisher.wanted)

    def __bool__(self) -> bool:
        return True


class _Subscription:
    """Subscription of a node to a topic.

    Attributes:
        end: the listener; None until there is a simulation.
    """

    def __init__(self, topic: str, kind: type[Message], callback: Handler, options: _Options | None = None) -> None:
        self.topic, self._kind, self._callback, self._options = topic, kind, callback, options
        self.listener: Listener | None = None

    def _on_message(self, message: object) -> None:
        heard = from_ros(self._kind, message)
        if self._kind is MESSAGE_CLASSES["Pose_V"] and self.topic.endswith(_SCENE_POSES):
            for pose in heard.pose:
                pose.name = pose.name.rpartition("::")[2]
        self._callback(heard)

    def _connect(self, sim: Simulation, owner: Plugin | None) -> None:
        _warn_of_rate(sim, owner, self.topic, self._options)
        known, twins = sim.topics().get(self.topic), [twin.ros for twin in twins_of(self._kind)]
        types = sorted(twins, key=lambda ros: ros != known)  # what is published there is listed first
        called = self._on_message if owner is None else _call_as_owner(sim, owner, self.topic, self._on_message)
        with sim.communication.bus.owned_by(owner):
            self.listener = sim.communication.bus.listen(self.topic, types, called)


class Node(SharedByCopies):
    """An end of the simulation's topics and services."""

    def __init__(self, *_: object) -> None:
        found = simulation_context.current_simulation()
        # made outside of a hook it may have been before its simulation: whose it is shows when it is first used
        is_known = found is not None and found[1] is not None
        self._sim = weakref.ref(found[0]) if is_known and found is not None else None
        self._owner = found[1] if is_known and found is not None else None
        self._subscriptions: dict[str, list[_Subscription]] = {}
        self._advertised: list[str] = []
        self._waiting: list[Publisher | _Subscription] = []

    def _find_simulation(self) -> Simulation | None:
        """The simulation it belongs to; None where there is none yet."""
        if self._sim is None:
            found = simulation_context.current_simulation()
            if found is None:
                return None
            self._sim, self._owner = weakref.ref(found[0]), found[1]
        sim = self._sim()
        if sim is None:
            raise RuntimeError("the simulation that this Node belonged to is gone")
        return sim

    def _simulation(self) -> Simulation:
        sim = self._find_simulation()
        if sim is None:
            raise RuntimeError(_NO_SIMULATION)
        return sim

    def _open(self, end: Publisher | _Subscription) -> None:
        """Opens an end now, or as soon as there is a simulation."""
        sim = self._find_simulation()
        if sim is not None:
            end._connect(sim, self._owner)
            return
        self._waiting.append(end)
        if self not in _early_nodes:
            _early_nodes.append(self)

    def _connect(self, sim: Simulation) -> None:
        self._sim, waiting = weakref.ref(sim), list(self._waiting)
        self._waiting.clear()
        for end in waiting:
            end._connect(sim, None)

    def advertise(self, topic: str, kind: type[Message], options: _Options | None = None) -> Publisher:
        """Opens a topic for messages of a class."""
        twins_of(kind)  # said now, not when there is a simulation
        publisher = Publisher(_absolute_topic(topic), kind, options)
        self._advertised.append(publisher._topic)
        self._open(publisher)
        return publisher

    def subscribe(self, kind: Any, topic: Any, callback: Handler, options: _Options | None = None) -> bool:
        """Calls `callback(message)` between two steps for each message of a class on a topic."""
        if isinstance(kind, str):  # older bindings had the topic first
            kind, topic = topic, kind
        twins_of(kind)
        subscription = _Subscription(_absolute_topic(topic), kind, callback, options)
        self._subscriptions.setdefault(subscription.topic, []).append(subscription)
        self._open(subscription)
        return True

    def unsubscribe(self, topic: str) -> bool:
        """Ends the subscriptions of this node to a topic; whether there were any."""
        ends = self._subscriptions.pop(_absolute_topic(topic), [])
        for end in ends:
            if end in self._waiting:
                self._waiting.remove(end)
            elif end.listener is not None:
                self._simulation().communication.bus.close(end.listener)
        return bool(ends)

    def request(
        self, service: str, request: Message, request_kind: type[Message], response_kind: type[Message], timeout: int
    ) -> tuple[bool, Message]:
        """Calls a service of the simulation: (whether it is there and took it, the response).

        Known are those of a world that take a WorldControl, an EntityFactory, an Entity or a Pose and give a Boolean.
        """
        return call_service(self._simulation(), _absolute_topic(service), request, response_kind)

    def topic_list(self) -> list[str]:
        return list(self._simulation().topics())

    def service_list(self) -> list[str]:
        return list(self._simulation().communication.services.names())

    def advertised_topics(self) -> list[str]:
        return list(self._advertised)

    def subscribed_topics(self) -> list[str]:
        return list(self._subscriptions)

    def __getattr__(self, name: str) -> NoReturn:
        raise missing_name_error("Node", name, dir(type(self)))


def _call_as_owner(sim: Simulation, owner: Plugin | None, topic: str, callback: Handler) -> Handler:
    """Guard a plugin's callback: what it raises is the plugin's fault, and what it opens is the plugin's."""

    def run(message: Message) -> None:
        before = simulation_context.enter_simulation(sim, owner)
        try:
            callback(message)
        finally:
            simulation_context.leave_simulation(before)

    found: Handler = sim.engine.faults.guard(owner, f"its callback for {topic!r}", run)
    return found


def _absolute_topic(topic: str) -> str:
    if not topic or any(c.isspace() for c in topic) or "//" in topic or "@" in topic:
        raise MessageError(f"{topic!r} is no topic's name")
    return topic if topic.startswith("/") else f"/{topic}"


def __getattr__(name: str) -> NoReturn:
    raise missing_name_error("gz.transport", name, __all__)
