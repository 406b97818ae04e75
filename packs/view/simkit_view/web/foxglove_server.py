"""Program of the process that serves Foxglove, with its WebSocket protocol version 1."""

from __future__ import annotations

import json
import struct
import time
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.argument_checks import shown
from simkit.bridges.live.protocol import LARGEST_OUT, JsonObject, LiveClosed, LiveError
from simkit.bridges.live.request_fields import (
    RequestRefused,
    checked_value,
    client_text,
    find_handler,
    read_field,
    read_identifier,
    read_items,
    read_json,
    with_code,
)
from simkit.bridges.simulation_link import robot_descriptions, text_message
from simkit.errors import SimkitError
from simkit.input_file import read_failure, read_input
from simkit_view.web.cdr_values import read_values
from simkit_view.web.json_messages import message_from_json
from simkit_view.web.web_server import WebClient, WebLink, WebServer, binary_frame, run_server, text_frame

if TYPE_CHECKING:
    from websockets.asyncio.server import ServerConnection

SUBPROTOCOLS: Final = ("foxglove.sdk.v1", "foxglove.websocket.v1")
_CAPABILITIES: Final = ("clientPublish", "time", "parameters", "parametersSubscribe", "services", "assets")
_MESSAGE, _TIME, _CALL, _ASSET = 1, 2, 3, 4  # binary data for the client
_MESSAGE_HEAD: Final = struct.Struct("<BIQ")
_CLIENT_MESSAGE, _CLIENT_CALL = 1, 2  # binary data from the client
_DEPTH: Final = 100  # queued messages of a topic in the simulation
_TIME_PERIOD: Final = 0.02  # [s] between two times for the client
_PARAMETER_PERIOD: Final = 1.0  # [s] between two looks at the parameters
_TEXT: Final = "std_msgs/msg/String"


class FoxgloveClient(WebClient):
    """Client with Foxglove's protocol."""

    def __init__(self, server: WebServer, socket: ServerConnection, link: WebLink, *, is_allowed: bool) -> None:
        super().__init__(server, socket, link, is_allowed=is_allowed)
        self._ids: dict[tuple[str, str], int] = {}  # channels and services, by name and type
        self._channels: dict[int, tuple[str, str]] = {}
        self._services: dict[int, tuple[str, str]] = {}
        self._subscriptions: dict[int, int | None] = {}
        self._publishers: dict[int, tuple[int, str, bool]] = {}
        self._parameters: JsonObject = {}
        self._watched: set[str] = set()
        self._next_time = self._next_look = 0.0
        name = f"simkit {self.server.simulation['name']}"
        session = str(self.server.simulation["pid"])
        encodings = {"supportedEncodings": ["cdr", "json"], "metadata": {}, "sessionId": session}
        self.tell("serverInfo", name=name, capabilities=list(_CAPABILITIES), **encodings)

    def tell(self, op: str, **words: object) -> None:
        """Send a message of the protocol in JSON."""
        self.send(text_frame(json.dumps({"op": op, **words})))

    def report_error(self, text: str) -> None:
        """Send a status with an error."""
        self.tell("status", level=2, message=with_code(text))

    # ------------------------------------------------------------------ the graph

    def apply_graph(self) -> None:
        """Advertise new topics and services, and remove those that are gone."""
        graph = self.server.graph
        topics = {(topic, _TEXT) for topic in robot_descriptions(graph)}
        for row in graph["topics"]:
            types = [end["type"] for end in row["publishers"] if end["node"] != self.link.node]
            topics.update((row["name"], type_name) for type_name in types[:1])
        self._channels = self._apply("advertise", "channels", "channelIds", self._channels, topics)
        services = set(graph["services"].items())
        self._services = self._apply("advertiseServices", "services", "serviceIds", self._services, services)

    def _apply(
        self, op: str, rows: str, ids: str, known: dict[int, tuple[str, str]], wanted: set[tuple[str, str]]
    ) -> dict[int, tuple[str, str]]:
        """Advertise what is wanted and not known, remove the opposite, and return what is advertised."""
        gone = [number for number, entry in known.items() if entry not in wanted]
        if gone:
            self.tell(f"un{op}", **{ids: gone})
        entries = {number: entry for number, entry in known.items() if number not in gone}
        fresh = []
        for entry in sorted(wanted - set(entries.values())):
            number = self._ids.setdefault(entry, len(self._ids) + 1)
            try:
                fresh.append({"id": number, **(_channel(*entry) if rows == "channels" else _service(*entry))})
            except (SimkitError, KeyError, ValueError):
                continue  # a type without a definition
            entries[number] = entry
        if fresh:
            self.tell(op, **{rows: fresh})
        return entries

    def apply_time(self, time_ns: int) -> None:
        """Send the time, and the watched parameters that have changed."""
        now = time.monotonic()
        if now >= self._next_time:
            self._next_time = now + _TIME_PERIOD
            self.send(binary_frame(struct.pack("<BQ", _TIME, time_ns)))
        if now >= self._next_look and self._watched:
            self._next_look = now + _PARAMETER_PERIOD
            self._ask_parameters(self._send_changed)

    # ------------------------------------------------------------------ messages of the client

    def take(self, data: str | bytes) -> None:
        """Process a message of the client; an invalid one is answered with a status."""
        try:
            if isinstance(data, bytes):
                self._take_binary(data)
                return
            words = checked_value(read_json(data), "the message", dict)
            find_handler(_OPERATIONS, read_field(words, "op", str), "op")(self, words)
        except LiveClosed:
            raise
        except Exception as error:  # noqa: BLE001 - the data may be anything
            self.report_error(client_text(error))

    def _take_binary(self, data: bytes) -> None:
        if len(data) < 5:
            raise RequestRefused(f"a binary message has {len(data)} bytes; expected at least 5")
        number = struct.unpack_from("<I", data, 1)[0]
        if data[0] == _CLIENT_MESSAGE:
            if number not in self._publishers:
                raise RequestRefused(f"the channel {number} is not advertised")
            publisher, type_name, is_json = self._publishers[number]
            content = data[5:]
            if is_json:
                content = msgs.serialize(message_from_json(type_name, read_json(content)))
            self.link.publish(publisher, content)
        elif data[0] == _CLIENT_CALL:
            self._call(number, data)
        else:
            raise RequestRefused(f"unknown binary op {data[0]}")

    # ------------------------------------------------------------------ topics

    def subscribe(self, words: JsonObject) -> None:
        """Subscribe to channels, with the client's numbers."""
        for row in read_items(words, "subscriptions", dict):
            number, channel = _number(row, "id"), read_field(row, "channelId", int)
            if channel not in self._channels:
                raise RequestRefused(f"there is no channel {shown(channel)}")
            topic, type_name = self._channels[channel]
            if number in self._subscriptions:
                raise RequestRefused(f"the subscription {number} exists")
            robot = robot_descriptions(self.server.graph).get(topic) if type_name == _TEXT else None
            if robot is None:
                self._subscriptions[number] = self._subscribe(number, topic, type_name)
            else:
                self._subscriptions[number] = None
                self._send_description(number, robot)

    def _subscribe(self, number: int, topic: str, type_name: str) -> int:
        pack = _MESSAGE_HEAD.pack

        def take(time_ns: int, found_type: str, data: bytes, _: int) -> None:
            self.apply_time(time_ns)
            if found_type == type_name:
                self.send(binary_frame(pack(_MESSAGE, number, time_ns), data))

        def fail(error: LiveError) -> None:
            self._subscriptions.pop(number, None)
            self.report_error(str(error))

        return self.link.subscribe(topic, take, fail, _DEPTH)

    def _send_description(self, number: int, robot: str) -> None:
        head = _MESSAGE_HEAD.pack(_MESSAGE, number, int(self.server.graph["time_ns"]))

        def send(text: str, _: bytes) -> None:
            self.send(binary_frame(head, text_message(text)))

        self.link.ask("robot_description", {"name": robot}, then=send)

    def unsubscribe(self, words: JsonObject) -> None:
        """End subscriptions."""
        for number in read_items(words, "subscriptionIds", int):
            if number not in self._subscriptions:
                raise RequestRefused(f"there is no subscription {shown(number)}")
            subscription = self._subscriptions.pop(number)
            if subscription is not None:
                self.link.unsubscribe(subscription)

    def advertise(self, words: JsonObject) -> None:
        """Open channels for publishing."""
        for row in read_items(words, "channels", dict):
            topic, encoding, schema = (read_field(row, name, str) for name in ("topic", "encoding", "schemaName"))
            self._open_publisher(_number(row, "id"), topic, encoding, msgs.full_name(schema))

    def _open_publisher(self, channel: int, topic: str, encoding: str, type_name: str) -> None:
        if encoding not in ("cdr", "json"):
            raise RequestRefused(f"found encoding {encoding!r:.80}; expected cdr or json")
        number = self.link.next_number()

        def open_channel(answer: JsonObject, _: bytes) -> None:
            self._publishers[channel] = number, answer["type"], encoding == "json"

        args = {"number": number, "topic": topic, "type": type_name}
        self.link.ask("advertise", args, then=open_channel, failed=lambda error: self.report_error(str(error)))

    def unadvertise(self, words: JsonObject) -> None:
        """Close channels of the client."""
        for number in read_items(words, "channelIds", int):
            if number not in self._publishers:
                raise RequestRefused(f"the channel {shown(number)} is not advertised")
            self.link.unadvertise(self._publishers.pop(number)[0])

    # ------------------------------------------------------------------ services

    def _call(self, service: int, data: bytes) -> None:
        if len(data) < 13:
            raise RequestRefused(f"a call has {len(data)} bytes; expected at least 13")
        call, length = struct.unpack_from("<II", data, 5)
        encoding, content = data[13 : 13 + length].decode(errors="replace"), data[13 + length :]

        def fail(error: object) -> None:
            self.tell("serviceCallFailure", serviceId=service, callId=call, message=with_code(str(error)))

        def respond(_: object, answer: bytes) -> None:
            if encoding == "json":
                answer = json.dumps(read_values(answer, f"{type_name}_Response")).encode()
            head = struct.pack("<BIII", _CALL, service, call, length)
            self.send(binary_frame(head, encoding.encode(), answer))

        try:
            if service not in self._services:
                raise RequestRefused(f"there is no service {service}")
            name, type_name = self._services[service]
            if encoding == "json":
                content = msgs.serialize(message_from_json(f"{type_name}_Request", read_json(content)))
            elif encoding != "cdr":
                raise RequestRefused(f"found encoding {encoding!r:.80}; expected cdr or json")
        except Exception as error:  # noqa: BLE001 - the data may be anything
            fail(client_text(error))
        else:
            self.link.ask("call", {"name": name, "type": f"{type_name}_Request"}, content, respond, fail)

    # ------------------------------------------------------------------ parameters

    def _ask_parameters(self, then: Callable[[JsonObject], None]) -> None:
        """Ask for the parameters, and call a function with node, name and value by the name `NODE.NAME`."""

        def convert(nodes: JsonObject, _: bytes) -> None:
            rows = (
                (node, name, row["value"]) for node, parameters in nodes.items() for name, row in parameters.items()
            )
            then({f"{node}.{name}": (node, name, value) for node, name, value in rows})

        self.link.ask("parameters", {}, then=convert)

    def get_parameters(self, words: JsonObject) -> None:
        """Send the values of some parameters, or of all."""
        names = read_items(words, "parameterNames", str) if words.get("parameterNames") else []
        identifier = read_identifier(words)
        self._ask_parameters(lambda nodes: self._send_parameters(nodes, names or list(nodes), identifier))

    def _send_parameters(self, parameters: JsonObject, names: Sequence[str], identifier: object) -> None:
        rows = [_parameter(name, parameters[name][2]) for name in names if name in parameters]
        self.tell("parameterValues", parameters=rows, **({"id": identifier} if identifier else {}))

    def set_parameters(self, words: JsonObject) -> None:
        """Set parameters, and send the values that they have then."""
        rows = read_items(words, "parameters", dict)
        wanted, identifier = {read_field(row, "name", str): row.get("value") for row in rows}, read_identifier(words)

        def set_all(nodes: JsonObject) -> None:
            for name, value in wanted.items():
                if name not in nodes:
                    self.report_error(f"there is no parameter {name!r}")
                    continue
                node, short, old = nodes[name]
                is_whole = isinstance(old, float) and type(value) is int
                number = checked_value(value, f"{name!r}", float) if is_whole else value
                args = {"node": node, "name": short, "value": number}
                self.link.ask("set_parameter", args, failed=lambda error: self.report_error(str(error)))
            if identifier:
                self._ask_parameters(lambda nodes: self._send_parameters(nodes, list(wanted), identifier))

        self._ask_parameters(set_all)

    def subscribe_parameter_updates(self, words: JsonObject) -> None:
        """Send changes of some parameters from now on."""
        self._watched.update(read_items(words, "parameterNames", str))

    def unsubscribe_parameter_updates(self, words: JsonObject) -> None:
        """Send no more changes of some parameters."""
        self._watched.difference_update(read_items(words, "parameterNames", str))

    def _send_changed(self, parameters: JsonObject) -> None:
        values = {name: parameters[name][2] for name in self._watched if name in parameters}
        changed = [_parameter(name, v) for name, v in values.items() if self._parameters.get(name) != v]
        self._parameters = values
        if changed:
            self.tell("parameterValues", parameters=changed)

    # ------------------------------------------------------------------ meshes

    def fetch_asset(self, words: JsonObject) -> None:
        """Send a mesh file or a texture of the world."""
        number, uri = _number(words, "requestId"), read_field(words, "uri", str)

        def send(error: object, data: bytes = b"") -> None:
            text = with_code(str(error)).encode(errors="replace") if error else b""
            head = struct.pack("<BIBI", _ASSET, number, 1 if text else 0, len(text))
            self.send(binary_frame(head, text, data))

        def read(path: str, _: bytes) -> None:
            try:
                send("", read_input(path, LARGEST_OUT))
            except OSError as error:
                send(read_failure(error))

        self.link.ask("asset", {"uri": uri}, then=read, failed=send)


_OPERATIONS: Final[Mapping[str, Callable[[FoxgloveClient, JsonObject], None]]] = MappingProxyType(
    {
        "subscribe": FoxgloveClient.subscribe,
        "unsubscribe": FoxgloveClient.unsubscribe,
        "advertise": FoxgloveClient.advertise,
        "unadvertise": FoxgloveClient.unadvertise,
        "getParameters": FoxgloveClient.get_parameters,
        "setParameters": FoxgloveClient.set_parameters,
        "subscribeParameterUpdates": FoxgloveClient.subscribe_parameter_updates,
        "unsubscribeParameterUpdates": FoxgloveClient.unsubscribe_parameter_updates,
        "fetchAsset": FoxgloveClient.fetch_asset,
    }
)
"""Method of each operation, by the name in `op`."""


def _number(fields: JsonObject, name: str) -> int:
    """Return a field that is a number of 32 bits.

    Raises:
        RequestRefused: the field is missing or has another value.
    """
    number = read_field(fields, name, int)
    if not 0 <= number < 1 << 32:
        raise RequestRefused(f"{name!r} must be from 0 to {(1 << 32) - 1}, got {shown(number)}")
    return number


def _channel(topic: str, type_name: str) -> JsonObject:
    schema = {"schemaName": type_name, "schemaEncoding": "ros2msg", "schema": msgs.definition(type_name)}
    return {"topic": topic, "encoding": "cdr", **schema}


def _service(name: str, type_name: str) -> JsonObject:
    parts: JsonObject = {}
    for part in ("Request", "Response"):
        schema = msgs.definition(f"{type_name}_{part}")
        more = {"schemaName": f"{type_name}_{part}", "schemaEncoding": "ros2msg", "schema": schema}
        parts[part.lower()] = {"encoding": "cdr", **more}
        parts[f"{part.lower()}Schema"] = schema  # for clients of the protocol's first version
    return {"name": name, "type": type_name, **parts}


def _parameter(name: str, value: object) -> JsonObject:
    content = {"name": name, "value": value}
    if isinstance(value, float):
        return {**content, "type": "float64"}
    if isinstance(value, list) and value and all(isinstance(item, float) for item in value):
        return {**content, "type": "float64_array"}
    return content


def main(settings: JsonObject) -> int:
    """Serve clients until the simulation ends; return the exit code.

    Args:
        settings: `socket`, the path of the simulation's socket, `host`, `port` and `token`.
    """
    return run_server(lambda: WebServer("foxglove", settings, FoxgloveClient, SUBPROTOCOLS))
