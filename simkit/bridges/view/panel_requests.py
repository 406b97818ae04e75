"""Requests of the panels: services, actions, parameters and log messages."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from simkit.bridges.live.request_fields import RequestRefused
from simkit.bridges.view.message_form import describe_form
from simkit.bridges.view.page_call import Call
from simkit.bridges.view.page_calls import shown_message
from simkit.bridges.view.topic_streams import LogEntries
from simkit.bridges.web.json_messages import message_from_json, message_to_json
from simkit.msgs.topic_names import absolute_name

_PARTS: Final = {"service": "Request", "action": "Goal"}
_LARGEST_VALUES: Final = 200_000  # characters of a response that a page gets as values


def _interfaces(call: Call) -> object:
    """Return the types of all services and actions."""
    communication = call.sim.communication
    return {"services": communication.services.names(), "actions": communication.actions.names()}


def _describe(call: Call) -> object:
    """Return the form of a service (`kind` service) or an action (`kind` action): `kind`, `name`."""
    kind, name = call.text("kind"), absolute_name(call.text("name"))
    if kind not in _PARTS:
        raise RequestRefused(f"'kind' must be service or action, got {kind!r:.80}")
    communication = call.sim.communication
    endpoint = communication.services.get(name) if kind == "service" else communication.actions.get(name)
    return describe_form(f"{endpoint.type_name}_{_PARTS[kind]}")


def _call(call: Call) -> object:
    """Call a service: `name`, `values`. A service of another process answers later, in the stream `calls`."""
    services = call.sim.communication.services
    service = services.get(absolute_name(call.text("name")))
    request = message_from_json(f"{service.type_name}_Request", call.value("values") or {})
    if service.remote is not None:
        _check_room(call)
        return {"id": call.view.calls.add(services.begin(service.name, request))}
    response = call.sim.call(service.name, request)
    values = message_to_json(response)
    return {"text": shown_message(response), "values": values if len(str(values)) <= _LARGEST_VALUES else None}


def _goal(call: Call) -> object:
    """Send a goal to an action: `name`, `values`; its progress is in the stream `calls`."""
    action = call.sim.communication.actions.get(absolute_name(call.text("name")))
    goal = message_from_json(f"{action.type_name}_Goal", call.value("values") or {})
    _check_room(call)
    return {"id": call.view.calls.add(call.sim.send_goal(action.name, goal))}


def _check_room(call: Call) -> None:
    if call.view.calls.is_full:
        raise RequestRefused("too many goals and calls wait; cancel some of them")


def _cancel(call: Call) -> object:
    """Request the cancellation of a goal: `goal`, its number."""
    number = call.number("goal")
    found = call.view.calls.goal(int(number))
    if found is None:
        raise RequestRefused(f"there is no goal {number:g}")
    if found.is_done:
        return False
    found.cancel()
    return True


def _set_parameter(call: Call) -> None:
    """Set a live parameter: `node`, `name`, `value`."""
    value = call.value("value")
    call.sim.set_parameter(call.text("node"), call.text("name"), tuple(value) if isinstance(value, list) else value)


def _log(call: Call) -> object:
    """Return the log messages after the number `after`, while the page shows the stream `log`."""
    after, stream = call.number("after", 0), call.view.stream("log")
    return stream.entries(int(after)) if isinstance(stream, LogEntries) else []


PANEL_REQUESTS: Final[dict[str, Callable[[Call], object]]] = {
    "interfaces": _interfaces,
    "describe": _describe,
    "call": _call,
    "goal": _goal,
    "cancel": _cancel,
    "set_parameter": _set_parameter,
    "log": _log,
}
"""Function of each request, by the name in `do`."""
