"""Handlers of client requests. Each answer is a value or a message. Every argument is validated before it is used."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, Protocol, TypeVar, cast

from simkit import msgs
from simkit.bridges.live.connection import MOST_OPEN, ClientConnection
from simkit.bridges.live.introspection import model_state, node_list, parameter_list, topic_list
from simkit.bridges.live.message_log import ClientSubscription
from simkit.bridges.live.protocol import TELL, JsonObject
from simkit.bridges.live.request_fields import RequestRefused, read_field
from simkit.bridges.live.topic_feed import TopicFeeds
from simkit.errors import SimkitError
from simkit.msgs import own_interfaces

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

T = TypeVar("T")
_TOPIC = re.compile(r"[^\s\x00-\x1f]{1,255}")
_NEW_TOPIC = re.compile(r"(/[A-Za-z0-9_.-]+)+")


class RequestHost(Protocol):
    """Protocol of the server that answers requests.

    Attributes:
        peers: connections of clients, by file descriptor.
        feeds: topics that clients subscribe to.
        client_topics: topics that a client created, because nothing in the simulation used them.
        is_polling: True while `poll` processes data.
        client_types: types that clients defined.
        open_view: function that shows the run in a browser and returns the address; None if the run cannot.
    """

    sim: Simulation
    peers: dict[int, ClientConnection]
    feeds: TopicFeeds
    client_topics: set[str]
    client_types: set[str]
    is_polling: bool
    open_view: Callable[[], str] | None

    def poll(self, wait: float = 0.0) -> bool:
        """Read the frames of clients, and send the data that is queued for them."""
        ...

    def measured_rtf(self) -> float:
        """Return the real-time factor over about the last second of wall time."""
        ...


class SimulationRequest(Protocol):
    """Protocol of a request that only needs the simulation, whichever server receives it.

    Attributes:
        sim: simulation.
        args: arguments by name.
    """

    @property
    def sim(self) -> Simulation: ...

    @property
    def args(self) -> JsonObject: ...

    def arg(self, name: str, kind: type[T]) -> T:
        """Return the argument of that name and type."""
        ...


@dataclass(frozen=True)
class Request:
    """Request of a client: its arguments, and the message (CDR) that follows them.

    Attributes:
        respond: function that sends a later answer: a message, or the text of an error.
    """

    server: RequestHost
    peer: ClientConnection
    args: JsonObject
    data: bytes
    respond: Callable[[object, str], None]

    @property
    def sim(self) -> Simulation:
        return self.server.sim

    def arg(self, name: str, kind: type[T]) -> T:
        """Return the argument of that name and type.

        Raises:
            RequestRefused: the argument is missing or has another type.
        """
        return read_field(self.args, name, kind)

    def topic(self) -> str:
        """Return the absolute name of the requested topic."""
        topic = self.arg("topic", str)
        topic = topic if topic.startswith("/") else "/" + topic
        if not _TOPIC.fullmatch(topic):
            raise RequestRefused(f"{topic!r:.80} is not a topic name")
        return topic

    def new_number(self, table: Mapping[int, object]) -> int:
        """Return the number that the client chose for a new handle."""
        number = self.arg("number", int)
        if not 0 <= number < 1 << 32:
            raise RequestRefused(f"the number {number!r:.40} is outside 0 to {(1 << 32) - 1}")
        if number in table:
            raise RequestRefused(f"the number {number} is in use")
        if len(table) >= MOST_OPEN:
            raise RequestRefused("SK-LIVE-007", f"a client may open at most {MOST_OPEN} of these", shows_code=False)
        return number

    def note_node(self, number: int) -> None:
        """Store the node of a new handle, if the request names another node than the client's own."""
        if self.args.get("node") is not None:
            self.peer.node_by_number[number] = node_name(self.arg("node", str))

    def message(self) -> object:
        """Return the message of the request, from its fields or from CDR with the name of its type."""
        if self.args.get("type") is None:
            return self.arg("fields", dict)
        type_name = msgs.full_name(self.arg("type", str))
        try:
            return msgs.deserialize(self.data, type_name)
        except SimkitError:
            raise
        except Exception as error:
            raise RequestRefused(f"the data is not a valid {type_name}") from error


@dataclass(frozen=True)
class Response:
    """Answer that is a message."""

    message: object


RequestHandler = Callable[[Request], object]


def node_name(name: str) -> str:
    """Return the absolute name of a node, with `_` for characters that names cannot have."""
    return "/" + (re.sub(r"[^A-Za-z0-9_/]+", "_", name)[:100].strip("/") or "client")


def node(request: Request) -> object:
    """Set the client's node name: the requested name, or the first free of `name_2`, `name_3`, …."""
    name = node_name(request.arg("name", str))
    request.peer.is_bridge = bool(request.args.get("is_bridge"))
    request.peer.skips_own = request.peer.is_bridge or bool(request.args.get("skips_own"))
    names_in_use = {p.node for p in request.server.peers.values() if p is not request.peer}
    request.peer.node, number = name, 1
    while request.peer.node in names_in_use:
        number += 1
        request.peer.node = f"{name}_{number}"
    return request.peer.node


def open_node(request: Request) -> object:
    """Add a node to those of the client; requests for handles may name it with `node`."""
    if len(request.peer.nodes) >= MOST_OPEN:
        raise RequestRefused("SK-LIVE-007", f"a client may open at most {MOST_OPEN} nodes", shows_code=False)
    request.peer.nodes.append(node_name(request.arg("name", str)))
    return request.peer.nodes[-1]


def close_node(request: Request) -> object:
    """Remove a node from those of the client."""
    name = node_name(request.arg("name", str))
    if name not in request.peer.nodes:
        raise RequestRefused("there is no such node")
    request.peer.nodes.remove(name)
    return None


def state(request: Request) -> object:
    """Return the simulated time, the tick, and the current and allowed real-time factors."""
    sim = request.sim
    clock = {"time_ns": sim.time_ns, "tick": sim.tick, "timestep": sim.timestep, "paused": sim.paused}
    return {**clock, "rtf": sim.control.pausing.pace, "measured_rtf": request.server.measured_rtf()}


def make_steps(sim: Simulation, count: object) -> None:
    """Pause the simulation after some steps.

    Raises:
        RequestRefused: the number is not a whole number of at least 1.
    """
    steps = int(count) if isinstance(count, float) and count.is_integer() else count
    if type(steps) is not int or not 0 < steps < 1 << 40:
        raise RequestRefused(f"step: found {count!r:.80}; expected a whole number of steps of at least 1")
    sim.control.pausing.step(steps)


def set_pace(sim: Simulation, pace: object) -> None:
    """Set the highest real-time factor; None for no limit.

    Raises:
        RequestRefused: the factor is not a number above 0.
    """
    if pace is None:
        sim.control.pausing.pace = None
    elif type(pace) in (int, float) and 0 < cast("float", pace) <= sys.float_info.max:
        sim.control.pausing.pace = float(cast("float", pace))
    else:
        raise RequestRefused(f"rtf: found {pace!r:.80}; expected a number above 0, or nothing for no limit")


def control(request: Request) -> object:
    """Pause, resume or step the simulation, or set its highest real-time factor."""
    pausing, action, value = request.sim.control.pausing, request.arg("action", str), request.args.get("value")
    if action == "pause":
        if not pausing.is_paused:
            pausing.pause()
    elif action == "resume":
        pausing.resume()
    elif action == "step":
        make_steps(request.sim, 1 if value is None else value)
    elif action == "rtf":
        set_pace(request.sim, value)
    else:
        raise RequestRefused(f"control: found {action!r:.80}; expected pause, resume, step or rtf")
    return state(request)


# ---------------------------------------------------------------------- topics


def subscribe(request: Request) -> object:
    """Open a subscription of the client; with `skips_latched`, it receives only messages that are published later."""
    number, topic = request.new_number(request.peer.subscriptions), request.topic()
    subscribed = ClientSubscription(request.peer, number, topic, request.arg("depth", int))
    request.server.feeds.add(subscribed, takes_latched=request.args.get("skips_latched") is not True)
    request.peer.subscriptions[number] = subscribed
    request.note_node(number)
    types = (types[0] for _, end, types, _ in request.sim.communication.bus.endpoints(topic) if end.active)
    return {"topic": topic, "type": next(types, None)}


def unsubscribe(request: Request) -> object:
    """Close a subscription of the client and return the number of dropped messages."""
    subscribed = request.peer.subscriptions.pop(request.arg("number", int), None)
    if subscribed is None:
        raise RequestRefused("there is no such subscription")
    request.peer.node_by_number.pop(subscribed.number, None)
    request.server.feeds.remove(subscribed)
    request.peer.drop_waiting(subscribed)
    return {"lost": subscribed.lost}


def advertise(request: Request) -> object:
    """Open a publisher of the client."""
    number, topic, bus = request.new_number(request.peer.publishers), request.topic(), request.sim.communication.bus
    types_in_use = [t for _, end, types, _ in bus.endpoints(topic) if end.active for t in types]
    if request.args.get("type") is None and not types_in_use:
        raise RequestRefused(f"topic {topic!r} does not exist yet, so its type is required")
    type_name = msgs.full_name(types_in_use[0] if request.args.get("type") is None else request.arg("type", str))
    if types_in_use and type_name not in types_in_use:
        allowed = " or ".join(dict.fromkeys(types_in_use))
        raise RequestRefused("SK-MSG-001", f"topic {topic!r} has type {allowed}, got {type_name}", shows_code=False)
    msgs.type_of(type_name)
    if not types_in_use:
        count_new_topic(request, topic)
    request.peer.publishers[number] = bus.advertise(topic, type_name, latched=request.args.get("latched") is True)
    request.note_node(number)
    return {"topic": topic, "type": type_name}


def define_types(server: RequestHost, texts: Mapping[str, str]) -> None:
    """Define the types that a client sent. Their number is limited, because they are kept until the process ends."""
    if len(server.client_types.union(texts)) > MOST_OPEN:
        message = f"clients of this run have already defined {MOST_OPEN} types; no more can be defined"
        raise RequestRefused("SK-LIVE-007", message, shows_code=False)
    own_interfaces.add_received(texts)
    server.client_types.update(texts)


def count_new_topic(request: Request, topic: str) -> None:
    """Count a topic that a client creates. Their number is limited, because recordings keep topics until the end."""
    if not _NEW_TOPIC.fullmatch(topic):
        raise RequestRefused(f"{topic!r} is not a topic name; expected letters, digits and _ between slashes")
    names = request.server.client_topics
    if topic not in names and len(names) >= MOST_OPEN:
        message = f"clients of this run have already created {MOST_OPEN} topics; no more can be created"
        raise RequestRefused("SK-LIVE-007", message, shows_code=False)
    names.add(topic)


def unadvertise(request: Request) -> object:
    """Close a publisher of the client."""
    number = request.arg("number", int)
    publisher = request.peer.publishers.pop(number, None)
    if publisher is None:
        raise RequestRefused("there is no such publisher")
    request.peer.node_by_number.pop(number, None)
    request.sim.communication.bus.close(publisher)
    return None


# ---------------------------------------------------------------------- services, actions, parameters


def goal(request: Request) -> object:
    """Send a goal to an action for the client, and return the action's name and the goal's number."""
    number = request.new_number(request.peer.goals)

    def on_feedback(feedback: object) -> None:
        if not request.peer.is_gone and not request.peer.is_clogged:
            words = {"tell": "goal", "number": number, "type": msgs.type_name(feedback)}
            request.peer.send_json(TELL, words, msgs.serialize(feedback))

    sent = request.sim.communication.actions.send(request.arg("name", str), request.message(), on_feedback)
    request.peer.goals[number] = sent, int(sent.status)
    return [sent.action.name, sent.id]


def cancel(request: Request) -> object:
    """Request the cancellation of a goal; return False if the goal has ended."""
    goal = request.peer.goals.get(request.arg("number", int))
    if goal is not None:  # None: the goal has ended
        goal[0].cancel()
    return goal is not None


def set_parameter(request: SimulationRequest) -> object:
    """Set a parameter of a node."""
    value = request.args.get("value")
    checked = tuple(value) if isinstance(value, list) else value
    request.sim.set_parameter(request.arg("node", str), request.arg("name", str), checked)
    return None


def use_parameter_server(request: SimulationRequest) -> object:
    """Use the parameter server of ROS 1: get, set, add, delete or search a name, or list all names.

    Returns:
        The value, names or name; None for a deleted or stored value, and an empty list if there is no such parameter.
        A value is in a list of one item.
    """
    server, action, name = request.sim.ros1_parameters(), request.arg("action", str), request.arg("name", str)
    value = request.args.get("value")
    changes = {"set": server.set, "add": server.add}
    try:
        if action == "get":
            return [server.get(name)]
        if action == "search":
            return [server.search(request.arg("node", str), name)]
        if action == "names":
            return server.names()
        if action == "delete":
            server.delete(name)
            return [None]
        if action in changes:
            changes[action](name, value)
            return [None]
    except KeyError:
        return []
    except (TypeError, OverflowError) as error:
        raise RequestRefused(f"parameter {name!r:.80} of the parameter server: {error}") from None
    raise RequestRefused(f"{action!r:.80} is not an action; expected get, set, add, delete, search or names")


def view(request: Request) -> object:
    """Show the run in a browser, and return the address of the page."""
    if request.server.open_view is None:
        raise RequestRefused("this simulation is stepped by a script; call sim.view() there")
    return request.server.open_view()


REQUESTS: Final[Mapping[str, RequestHandler]] = MappingProxyType(
    {
        "ping": lambda _: "pong",
        "interfaces": lambda _: own_interfaces.known_names(),
        "node": node,
        "open_node": open_node,
        "close_node": close_node,
        "state": state,
        "control": control,
        "topics": lambda request: topic_list(request.sim, request.server.peers.values()),
        "subscribe": subscribe,
        "unsubscribe": unsubscribe,
        "advertise": advertise,
        "unadvertise": unadvertise,
        "services": lambda request: request.sim.communication.services.names(),
        "actions": lambda request: request.sim.communication.actions.names(),
        "goal": goal,
        "cancel": cancel,
        "parameters": lambda request: parameter_list(request.sim),
        "set_parameter": set_parameter,
        "parameter_server": use_parameter_server,
        "nodes": lambda request: node_list(request.sim, request.server.peers.values()),
        "models": lambda request: list(request.sim.models),
        "view": view,
        "model": lambda request: model_state(request.sim, request.arg("name", str)),
    }
)
"""Handler of each request, by the name that a client sends."""
