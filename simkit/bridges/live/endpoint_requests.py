"""Handlers of the requests with which clients open and serve endpoints, and call services."""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import Final, TypeVar

from simkit.bridges.live.client_endpoints import (
    ClientAction,
    ClientEndpoint,
    ClientInput,
    ClientOfEndpoint,
    ClientParameter,
    ClientService,
)
from simkit.bridges.live.request_fields import RequestRefused, read_items
from simkit.bridges.live.requests import Request, RequestHandler, Response, count_new_topic
from simkit.errors import SimkitError
from simkit.msgs.topic_names import absolute_name
from simkit.runtime.communication.log_topic import LOG, log_message
from simkit.runtime.communication.parameter import checked_parameter
from simkit.runtime.communication.publisher import ROSOUT

E = TypeVar("E", bound=ClientEndpoint)
_NAME = re.compile(r"(/[A-Za-z0-9_.-]+)+")
_LONGEST_NAME = 255

LATER: Final = object()
"""Result of a handler whose answer comes later, through `Request.respond`."""


def _name(request: Request, argument: str = "name") -> str:
    """Return the absolute name of a new endpoint."""
    name = absolute_name(request.arg(argument, str))
    if not _NAME.fullmatch(name) or len(name) > _LONGEST_NAME:
        raise RequestRefused(f"{name!r:.80} is not a name; expected letters, digits and _ between slashes")
    return name


def _endpoint(request: Request, kind: type[E]) -> E:
    """Return the client's endpoint with the requested number."""
    endpoint = request.peer.endpoints.get(request.arg("number", int))
    if not isinstance(endpoint, kind):
        raise RequestRefused("there is no such endpoint")
    return endpoint


def call(request: Request) -> object:
    """Call a service. The answer of a service of another client or of a program may come later."""
    services = request.sim.communication.services
    service = services.get(absolute_name(request.arg("name", str)))
    if isinstance(service.remote, ClientService):
        service.remote.forward(services.checked(service, request.message()), request.respond)
        return LATER
    call = services.request(service.name, request.message())
    if not call.is_done:
        call.on_done = lambda call: request.respond(call.response, str(call.error or ""))
        return LATER
    if call.error is not None:
        raise call.error
    return Response(call.response)


def offer(request: Request) -> object:
    """Open a service that the client answers."""
    number = request.new_number(request.peer.endpoints)
    request.note_node(number)
    service = ClientService(request.server, request.peer, number, _name(request), request.arg("type", str))
    request.peer.endpoints[number] = service
    return service.opened.name


def respond(request: Request) -> object:
    """Pass the client's response to the caller of its service."""
    service, number, error = _endpoint(request, ClientService), request.arg("call", int), request.args.get("error")
    if error is not None:
        service.respond(number, None, str(error) or "an error without a text")
        return None
    try:
        message = request.message()
    except SimkitError as problem:  # the caller must not wait for another response
        service.respond(number, None, str(problem))
        raise
    service.respond(number, message, "")
    return None


def act(request: Request) -> object:
    """Open an action whose goals the client executes."""
    number = request.new_number(request.peer.endpoints)
    request.note_node(number)
    name, type_name, cancels = _name(request), request.arg("type", str), request.arg("cancels", bool)
    action = ClientAction(request.server, request.peer, number, name, type_name, cancels)
    request.peer.endpoints[number] = action
    return action.opened.name


def update_goal(request: Request) -> object:
    """Apply a change that the client made to a goal of its action."""
    message = None if request.args.get("type") is None else request.message()
    change, reason = request.arg("change", str), request.arg("reason", str)
    _endpoint(request, ClientAction).update(request.arg("goal", int), change, message, reason)
    return None


def listen(request: Request) -> object:
    """Open a command input whose messages the client receives."""
    number = request.new_number(request.peer.endpoints)
    topic, types = request.topic(), read_items(request.args, "types", str)
    if not request.sim.communication.bus.types_of(topic):
        count_new_topic(request, topic)
    client_input = ClientInput(request.server, request.peer, number, topic, types, request.arg("depth", int))
    request.peer.endpoints[number] = client_input
    return {"topic": topic, "types": list(client_input.opened.types)}


def declare(request: Request) -> object:
    """Declare a parameter of the client, on the node of the client's name unless another node is requested."""
    number, args = request.new_number(request.peer.endpoints), request.args
    node = request.peer.node if args.get("node") is None else _name(request, "node")
    choices = request.arg("choices", list)
    options = {"minimum": args.get("minimum"), "maximum": args.get("maximum"), "choices": choices}
    described = {**options, "description": request.arg("description", str)}
    parameter = checked_parameter(node, request.arg("name", str), args.get("value"), **described)
    request.peer.endpoints[number] = ClientParameter(request.server, request.peer, number, parameter)
    return {"node": parameter.node, "value": parameter.value}


def open_client(request: Request) -> object:
    """Note that a node of the client has a client of a service or an action."""
    number, kind = request.new_number(request.peer.endpoints), request.arg("kind", str)
    messages = request.sim.communication
    if kind not in ("service", "action"):
        raise RequestRefused(f"{kind!r:.80} is not a kind of client; expected service or action")
    request.note_node(number)
    table = messages.services if kind == "service" else messages.actions
    opened = table.open_client(_name(request), request.arg("type", str), node=request.peer.node_of(number))
    request.peer.endpoints[number] = ClientOfEndpoint(opened)
    return None


def close_endpoint(request: Request) -> object:
    """Close an endpoint of the client."""
    _endpoint(request, ClientEndpoint).close()
    del request.peer.endpoints[request.arg("number", int)]
    request.peer.node_by_number.pop(request.arg("number", int), None)
    return None


def subscribers(request: Request) -> object:
    """Return the number of subscriptions and command inputs of a publisher's topic."""
    publisher = request.peer.publishers.get(request.arg("number", int))
    if publisher is None:
        raise RequestRefused("there is no such publisher")
    return publisher.subscribers


def log(request: Request) -> object:
    """Publish a log message of the client on `/rosout`, with the simulated time and the name of the client."""
    number, publishers = request.arg("number", int), request.peer.publishers
    if number not in publishers:
        number = request.new_number(publishers)
        publishers[number] = request.sim.communication.bus.advertise(ROSOUT, LOG, latched=True)
    place = request.arg("file", str), request.arg("function", str), request.arg("line", int)
    message = log_message(
        request.peer.node, request.sim.time_ns, request.arg("level", int), request.arg("text", str), *place
    )
    publishers[number].publish(message)
    return None


ENDPOINT_REQUESTS: Final[Mapping[str, RequestHandler]] = MappingProxyType(
    {
        "call": call,
        "offer": offer,
        "respond": respond,
        "act": act,
        "update_goal": update_goal,
        "listen": listen,
        "declare": declare,
        "open_client": open_client,
        "close_endpoint": close_endpoint,
        "subscribers": subscribers,
        "log": log,
    }
)
"""Handler of each of these requests, by the name that a client sends."""
