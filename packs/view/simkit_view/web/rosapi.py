"""Services of rosapi that clients of rosbridge ask: topics, types, nodes and parameters of the simulation."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Final

from simkit.bridges.live.protocol import JsonObject
from simkit.bridges.live.request_fields import read_field, read_json
from simkit.msgs import full_name, type_of
from simkit.msgs.definition_parser import ARRAY, BASE, NAME, SEQUENCE
from simkit.msgs.message_text import field_nodes
from simkit.run_spec import JsonMapping
from simkit_view.web.web_server import WebClient


@dataclass(frozen=True)
class RosapiCall:
    """Call of a service of rosapi.

    Attributes:
        client: client that calls the service.
        args: fields of the request.
        end: function that sends the fields of the response.
        fail: function that sends an error.
    """

    client: WebClient
    args: JsonObject
    end: Callable[[object], None]
    fail: Callable[[object], None]

    def text(self, name: str) -> str:
        """Return a field of the request that is a text."""
        return read_field(self.args, name, str)

    def ask(self, question: str, respond: Callable[[Any], JsonObject], args: JsonObject | None = None) -> None:
        """Ask the simulation, and respond with what a function makes of its answer."""
        self.client.link.ask(question, args or {}, then=lambda answer, _: self.end(respond(answer)), failed=self.fail)


def _topic_types(call: RosapiCall, respond: Callable[[dict[str, str]], JsonObject]) -> None:
    call.ask("topics", lambda rows: respond({row["name"]: row["types"][0] for row in rows if row["types"]}))


def _names_of(types: Mapping[str, str], wanted: object) -> list[str]:
    return [name for name, type_name in types.items() if wanted in (type_name, _short(type_name))]


def _short(type_name: str) -> str:
    package, _, rest = type_name.partition("/")
    return f"{package}/{rest.rpartition('/')[2]}"


def _node_details(nodes: Mapping[str, JsonObject], name: str) -> JsonObject:
    node_ends = nodes.get(name, {})
    ends = {"publishing": "publishers", "subscribing": "subscribers", "services": "services"}
    return {field: list(node_ends.get(part, ())) for field, part in ends.items()}


def _typedefs(type_name: str) -> JsonObject:
    """Return the fields of a type and of all types that it uses."""
    full = type_name if type_name.endswith(("_Request", "_Response")) else full_name(type_name)
    typedefs, waiting = dict[str, JsonObject](), [full]
    while waiting:
        name = waiting.pop(0)
        if name in typedefs:
            continue
        type_of(name)
        names, types, lengths = [], [], []
        for field, node in field_nodes(name):
            kind, detail = int(node[0]), node[1]
            length, (inner_kind, inner) = -1, (kind, detail)
            if kind in (ARRAY, SEQUENCE):
                length, (inner_kind, inner) = (detail[1] if kind == ARRAY else 0), detail[0]
            names.append(field)
            types.append(inner[0] if int(inner_kind) == BASE else inner)
            lengths.append(length)
            if int(inner_kind) == NAME:
                waiting.append(inner)
        more = {"examples": [""] * len(names), "constnames": [], "constvalues": []}
        typedefs[name] = {"type": name, "fieldnames": names, "fieldtypes": types, "fieldarraylen": lengths, **more}
    return {"typedefs": list(typedefs.values())}


def _service_details(call: RosapiCall, part: str) -> None:
    package, _, rest = call.text("type").partition("/")
    call.end(_typedefs(f"{package}/{rest if '/' in rest else f'srv/{rest}'}_{part}"))


def _parameters(call: RosapiCall, respond: Callable[[JsonObject], JsonObject]) -> None:
    """Respond with a function of the parameters, by `NODE:NAME`."""

    def convert(nodes: Mapping[str, Mapping[str, JsonObject]]) -> JsonObject:
        return respond(
            {f"{node}:{name}": row["value"] for node, parameters in nodes.items() for name, row in parameters.items()}
        )

    call.ask("parameters", convert)


def _get_param(call: RosapiCall) -> None:
    name, default = call.text("name"), call.args.get("default_value", "")

    def respond(values: JsonMapping) -> JsonObject:
        return {"value": json.dumps(values[name]) if name in values else default, "successful": name in values}

    _parameters(call, respond)


def _set_param(call: RosapiCall) -> None:
    node, _, name = call.text("name").partition(":")
    args = {"node": node, "name": name, "value": read_json(call.text("value"))}
    call.ask("set_parameter", lambda _: {"successful": True}, args)


def _time(state: JsonObject) -> JsonObject:
    seconds, nanoseconds = divmod(int(state["time_ns"]), 10**9)
    return {"time": {"sec": seconds, "nanosec": nanoseconds, "secs": seconds, "nsecs": nanoseconds}}


def _topic_nodes(call: RosapiCall, field: str) -> None:
    topic = call.text("topic")
    call.ask(
        "topics", lambda rows: {field: [end["node"] for row in rows if row["name"] == topic for end in row[field]]}
    )


ROSAPI: Final[Mapping[str, Callable[[RosapiCall], None]]] = MappingProxyType(
    {
        "/rosapi/topics": lambda c: _topic_types(c, lambda t: {"topics": list(t), "types": list(t.values())}),
        "/rosapi/topic_type": lambda c: _topic_types(c, lambda t: {"type": t.get(c.text("topic"), "")}),
        "/rosapi/topics_for_type": lambda c: _topic_types(c, lambda t: {"topics": _names_of(t, c.text("type"))}),
        "/rosapi/publishers": lambda c: _topic_nodes(c, "publishers"),
        "/rosapi/subscribers": lambda c: _topic_nodes(c, "subscribers"),
        "/rosapi/services": lambda c: c.ask("services", lambda types: {"services": list(types)}),
        "/rosapi/service_type": lambda c: c.ask("services", lambda types: {"type": types.get(c.text("service"), "")}),
        "/rosapi/services_for_type": lambda c: c.ask(
            "services", lambda types: {"services": _names_of(types, c.text("type"))}
        ),
        "/rosapi/action_servers": lambda c: c.ask("actions", lambda types: {"action_servers": list(types)}),
        "/rosapi/nodes": lambda c: c.ask("nodes", lambda nodes: {"nodes": list(nodes)}),
        "/rosapi/node_details": lambda c: c.ask("nodes", lambda nodes: _node_details(nodes, c.text("node"))),
        "/rosapi/message_details": lambda c: c.end(_typedefs(c.text("type"))),
        "/rosapi/service_request_details": lambda c: _service_details(c, "Request"),
        "/rosapi/service_response_details": lambda c: _service_details(c, "Response"),
        "/rosapi/get_param_names": lambda c: _parameters(c, lambda values: {"names": list(values)}),
        "/rosapi/has_param": lambda c: _parameters(c, lambda values: {"exists": c.text("name") in values}),
        "/rosapi/get_param": _get_param,
        "/rosapi/set_param": _set_param,
        "/rosapi/get_time": lambda c: c.ask("state", _time),
    }
)
"""Services by name."""
