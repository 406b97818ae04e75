"""What clients may ask, and what is answered: a value, or a message. Each argument is looked at before it is used."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

from simkit import msgs
from simkit.bridges.live.connection import MOST_OPEN, ClientConnection, ClientSubscription
from simkit.bridges.live.introspection import model_state, node_list, parameter_list, topic_list
from simkit.bridges.live.protocol import TELL
from simkit.errors import SimkitError

if TYPE_CHECKING:
    from simkit.bridges.live.server import Server
    from simkit.runtime.simulation import Simulation

T = TypeVar("T")
_TOPIC = re.compile(r"[^\s\x00-\x1f]{1,255}")
_NEW_TOPIC = re.compile(r"(/[A-Za-z0-9_.-]+)+")


class RequestRefused(Exception):
    """A question that cannot be answered."""

    def __init__(self, message: str, code: str = "SK-LIVE-008") -> None:
        super().__init__(message)
        self.code = code


@dataclass(frozen=True)
class Request:
    """A question of a client: its arguments, and the CDR behind them."""

    server: Server
    peer: ClientConnection
    args: dict[str, Any]
    data: bytes

    @property
    def sim(self) -> Simulation:
        return self.server.sim

    def arg(self, name: str, kind: type[T]) -> T:
        """An argument of that type.

        Raises:
            Refused: it is of another, or not there.
        """
        found = self.args.get(name)
        if type(found) is not kind:
            raise RequestRefused(f"{name!r} is to be of type {kind.__name__}, got {found!r:.80}")
        return found

    def topic(self) -> str:
        """The absolute name of a topic."""
        found = self.arg("topic", str)
        found = found if found.startswith("/") else "/" + found
        if not _TOPIC.fullmatch(found):
            raise RequestRefused(f"{found!r:.80} is no name of a topic")
        return found

    def new_number(self, table: dict[int, Any]) -> int:
        """A number for something that is opened."""
        number = self.arg("number", int)
        if not 0 <= number < 1 << 32:
            raise RequestRefused(f"the number {number!r:.40} is none from 0 to {(1 << 32) - 1}")
        if number in table:
            raise RequestRefused(f"the number {number} is taken already")
        if len(table) >= MOST_OPEN:
            raise RequestRefused(f"a client may have {MOST_OPEN} of these open, and has", "SK-LIVE-007")
        return number

    def message(self) -> Any:
        """A request: fields, or CDR with the name of its type."""
        if self.args.get("type") is None:
            return self.arg("fields", dict)
        type_name = msgs.full_name(self.arg("type", str))
        try:
            return msgs.deserialize(self.data, type_name)
        except SimkitError:
            raise
        except Exception as error:  # noqa: BLE001 - bytes from outside may lead a reader anywhere
            raise RequestRefused(f"what was sent is no {type_name}: {error!r}") from None


@dataclass(frozen=True)
class Response:
    """An answer that is a message."""

    message: Any


RequestHandler = Callable[[Request], Any]
QUESTIONS: dict[str, RequestHandler] = {}


def _question(function: RequestHandler) -> RequestHandler:
    QUESTIONS[function.__name__] = function
    return function


@_question
def ping(_: Request) -> Any:
    return "pong"


@_question
def node(asked: Request) -> Any:
    """Gives the client its name, or the first of `name_2`, `name_3`, … that no other one has."""
    wanted = "/" + (re.sub(r"[^A-Za-z0-9_/]+", "_", asked.arg("name", str))[:100].strip("/") or "client")
    taken = {p.node for p in asked.server.peers.values() if p is not asked.peer}
    asked.peer.node, number = wanted, 1
    while asked.peer.node in taken:
        number += 1
        asked.peer.node = f"{wanted}_{number}"
    return asked.peer.node


@_question
def state(asked: Request) -> Any:
    sim = asked.sim
    found = {"time_ns": sim.time_ns, "tick": sim.tick, "timestep": sim.timestep, "paused": sim.paused}
    return {**found, "rtf": sim.pausing.pace, "measured_rtf": asked.server.measured_rtf()}


@_question
def control(asked: Request) -> Any:
    pausing, action, value = asked.sim.pausing, asked.arg("action", str), asked.args.get("value")
    if action == "pause":
        if not pausing.is_paused:
            pausing.pause()
    elif action == "resume":
        pausing.resume()
    elif action == "step":
        count = 1 if value is None else value
        if type(count) is float and count.is_integer():
            count = int(count)
        if type(count) is not int or not 0 < count < 1 << 40:
            raise RequestRefused(f"step: found {value!r:.80}, allowed is a whole number of steps of at least 1")
        pausing.step(count)
    elif action == "rtf":
        if value is not None and not (type(value) in (int, float) and 0 < value < float("inf")):
            raise RequestRefused(
                f"rtf: found {value!r:.80}, allowed is a number over 0, or nothing for as fast as it goes"
            )
        pausing.pace = None if value is None else float(value)
    else:
        raise RequestRefused(f"control: found {action!r:.80}, allowed is pause, resume, step or rtf")
    return state(asked)


# ---------------------------------------------------------------------- topics


@_question
def topics(asked: Request) -> Any:
    return topic_list(asked.server)


@_question
def subscribe(asked: Request) -> Any:
    number, topic = asked.new_number(asked.peer.subscriptions), asked.topic()
    subscribed = asked.peer.subscriptions[number] = ClientSubscription(
        asked.peer, number, topic, asked.arg("depth", int)
    )
    asked.server.feeds.add(subscribed)
    types = (types[0] for _, end, types, _ in asked.sim.bus.ends(topic) if end.active)
    return {"topic": topic, "type": next(types, None)}


@_question
def unsubscribe(asked: Request) -> Any:
    subscribed = asked.peer.subscriptions.pop(asked.arg("number", int), None)
    if subscribed is None:
        raise RequestRefused("there is no such subscription")
    asked.server.feeds.remove(subscribed)
    asked.peer.forget(subscribed)
    return {"lost": subscribed.lost}


@_question
def advertise(asked: Request) -> Any:
    number, topic, bus = asked.new_number(asked.peer.publishers), asked.topic(), asked.sim.bus
    taken = [t for _, end, types, _ in bus.ends(topic) if end.active for t in types]
    if asked.args.get("type") is None and not taken:
        raise RequestRefused(f"there is no topic {topic!r} yet, so that its type has to be given")
    type_name = msgs.full_name(taken[0] if asked.args.get("type") is None else asked.arg("type", str))
    if taken and type_name not in taken:
        raise RequestRefused(f"{topic!r} takes {' or '.join(dict.fromkeys(taken))}, got {type_name}", "SK-MSG-001")
    msgs.type_of(type_name)
    if not taken:
        _count_new_topic(asked, topic)
    asked.peer.publishers[number] = bus.advertise(topic, type_name)
    return {"topic": topic, "type": type_name}


def _count_new_topic(asked: Request, topic: str) -> None:
    """Counts a topic that only a client has: who records or counts topics knows it for as long as the run goes on."""
    if not _NEW_TOPIC.fullmatch(topic):
        raise RequestRefused(f"{topic!r} is no name of a topic; allowed are letters, digits and _ between slashes")
    names = asked.server.founded
    if topic not in names and len(names) >= MOST_OPEN:
        message = f"clients of this run have made {MOST_OPEN} topics that nobody else has, and no more are made"
        raise RequestRefused(message, "SK-LIVE-007")
    names.add(topic)


@_question
def unadvertise(asked: Request) -> Any:
    publisher = asked.peer.publishers.pop(asked.arg("number", int), None)
    if publisher is None:
        raise RequestRefused("there is no such publisher")
    asked.sim.bus.close(publisher)
    return None


# ---------------------------------------------------------------------- services, actions, parameters


@_question
def services(asked: Request) -> Any:
    return asked.sim.services()


@_question
def call(asked: Request) -> Any:
    return Response(asked.sim.call(asked.arg("name", str), asked.message()))


@_question
def actions(asked: Request) -> Any:
    return asked.sim.actions()


@_question
def goal(asked: Request) -> Any:
    number = asked.new_number(asked.peer.goals)

    def on_feedback(feedback: Any) -> None:
        if not asked.peer.is_gone and not asked.peer.is_clogged:
            words = {"tell": "goal", "number": number, "type": msgs.type_name(feedback)}
            asked.peer.say(TELL, words, msgs.serialize(feedback))

    sent = asked.sim.send_goal(asked.arg("name", str), asked.message(), on_feedback)
    asked.peer.goals[number] = sent, int(sent.status)
    return [sent._action.name, sent.id]


@_question
def cancel(asked: Request) -> Any:
    found = asked.peer.goals.get(asked.arg("number", int))
    if found is not None:  # else it has ended
        found[0].cancel()
    return found is not None


@_question
def parameters(asked: Request) -> Any:
    return parameter_list(asked.sim)


@_question
def set_parameter(asked: Request) -> Any:
    value = asked.args.get("value")
    found = tuple(value) if isinstance(value, list) else value
    asked.sim.set_parameter(asked.arg("node", str), asked.arg("name", str), found)
    return None


@_question
def nodes(asked: Request) -> Any:
    return node_list(asked.server)


# ---------------------------------------------------------------------- models


@_question
def models(asked: Request) -> Any:
    return list(asked.sim.models)


@_question
def model(asked: Request) -> Any:
    return model_state(asked.sim, asked.arg("name", str))
