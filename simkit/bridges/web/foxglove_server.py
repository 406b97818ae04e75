"""Program of the process that serves Foxglove, with its WebSocket protocol version 1."""

from __future__ import annotations

import json
import struct
import time
from typing import Any, Final

from simkit import msgs
from simkit.bridges.live.protocol import LARGEST_OUT, JsonObject, LiveClosed, LiveError
from simkit.bridges.simulation_link import robot_descriptions, text_message
from simkit.bridges.web.json_messages import message_from_json, message_to_json
from simkit.bridges.web.web_server import WebClient, WebServer, run_server
from simkit.errors import MessageError, SimkitError
from simkit.input_file import read_failure, read_input

SUBPROTOCOLS: Final = ("foxglove.sdk.v1", "foxglove.websocket.v1")
_CAPABILITIES: Final = ("clientPublish", "time", "parameters", "parametersSubscribe", "services", "assets")
_MESSAGE, _TIME, _CALL, _ASSET = 1, 2, 3, 4  # binary data for the client
_CLIENT_MESSAGE, _CLIENT_CALL = 1, 2  # binary data from the client
_DEPTH: Final = 100  # queued messages of a topic in the simulation
_TIME_PERIOD: Final = 0.02  # [s] between two times for the client
_PARAMETER_PERIOD: Final = 1.0  # [s] between two looks at the parameters
_TEXT: Final = "std_msgs/msg/String"


class FoxgloveClient(WebClient):
    """Client with Foxglove's protocol."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._ids: dict[tuple[str, str], int] = {}  # channels and services, by name and type
        self._channels: dict[int, tuple[str, str]] = {}
        self._services: dict[int, tuple[str, str]] = {}
        self._subscriptions: dict[int, int | None] = {}
        self._publishers: dict[int, tuple[int, str, bool]] = {}
        self._parameters: dict[str, Any] = {}
        self._watched: set[str] = set()
        self._next_time = self._next_look = 0.0
        name = f"simkit {self.server.simulation['name']}"
        session = str(self.server.simulation["pid"])
        encodings = {"supportedEncodings": ["cdr", "json"], "metadata": {}, "sessionId": session}
        self.tell("serverInfo", name=name, capabilities=list(_CAPABILITIES), **encodings)

    def tell(self, op: str, **words: Any) -> None:
        """Send a message of the protocol in JSON."""
        self.send(json.dumps({"op": op, **words}))

    def report_error(self, text: str) -> None:
        """Send a status with an error."""
        self.tell("status", level=2, message=text)

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
        found = {number: entry for number, entry in known.items() if number not in gone}
        fresh = []
        for entry in sorted(wanted - set(found.values())):
            number = self._ids.setdefault(entry, len(self._ids) + 1)
            try:
                fresh.append({"id": number, **(_channel(*entry) if rows == "channels" else _service(*entry))})
            except (SimkitError, KeyError, ValueError):
                continue  # a type without a definition
            found[number] = entry
        if fresh:
            self.tell(op, **{rows: fresh})
        return found

    def apply_time(self, time_ns: int) -> None:
        """Send the time, and the watched parameters that have changed."""
        now = time.monotonic()
        if now >= self._next_time:
            self._next_time = now + _TIME_PERIOD
            self.send(struct.pack("<BQ", _TIME, time_ns))
        if now >= self._next_look and self._watched:
            self._next_look = now + _PARAMETER_PERIOD
            self._ask_parameters(lambda found: self._send_changed(found))

    # ------------------------------------------------------------------ messages of the client

    def take(self, data: str | bytes) -> None:
        """Process a message of the client; an invalid one is answered with a status."""
        try:
            if isinstance(data, bytes):
                self._take_binary(data)
                return
            words = json.loads(data)
            process = getattr(self, f"_on_{words['op']}", None)
            if process is None:
                raise MessageError(f"unknown op {words['op']!r:.80}")
            process(words)
        except LiveClosed:
            raise
        except KeyError as error:
            self.report_error(f"{error} is missing or unknown")
        except (SimkitError, TypeError, ValueError, AttributeError, RecursionError, struct.error, IndexError) as error:
            self.report_error(f"invalid message: {error}")

    def _take_binary(self, data: bytes) -> None:
        number = struct.unpack_from("<I", data, 1)[0]
        if data[0] == _CLIENT_MESSAGE:
            publisher, type_name, is_json = self._publishers[number]
            content = data[5:]
            if is_json:
                content = msgs.serialize(message_from_json(type_name, json.loads(content)))
            self.link.publish(publisher, content)
        elif data[0] == _CLIENT_CALL:
            self._call(number, data)
        else:
            raise MessageError(f"unknown binary op {data[0]}")

    # ------------------------------------------------------------------ topics

    def _on_subscribe(self, words: JsonObject) -> None:
        for row in words["subscriptions"]:
            number, (topic, type_name) = int(row["id"]), self._channels[row["channelId"]]
            if number in self._subscriptions:
                raise MessageError(f"the subscription {number} exists")
            robot = robot_descriptions(self.server.graph).get(topic) if type_name == _TEXT else None
            if robot is None:
                self._subscriptions[number] = self._subscribe(number, topic, type_name)
            else:
                self._subscriptions[number] = None
                self._send_description(number, robot)

    def _subscribe(self, number: int, topic: str, type_name: str) -> int:
        def take(time_ns: int, found_type: str, data: bytes, _: int) -> None:
            self.apply_time(time_ns)
            if found_type == type_name:
                self.send(struct.pack("<BIQ", _MESSAGE, number, time_ns) + data)

        def fail(error: LiveError) -> None:
            self._subscriptions.pop(number, None)
            self.report_error(str(error))

        return self.link.subscribe(topic, take, fail, _DEPTH)

    def _send_description(self, number: int, robot: str) -> None:
        head = struct.pack("<BIQ", _MESSAGE, number, int(self.server.graph["time_ns"]))
        self.link.ask("robot_description", {"name": robot}, then=lambda text, _: self.send(head + text_message(text)))

    def _on_unsubscribe(self, words: JsonObject) -> None:
        for number in words["subscriptionIds"]:
            subscription = self._subscriptions.pop(number)
            if subscription is not None:
                self.link.unsubscribe(subscription)

    def _on_advertise(self, words: JsonObject) -> None:
        for row in words["channels"]:
            self._open_publisher(int(row["id"]), row["topic"], row["encoding"], msgs.full_name(row["schemaName"]))

    def _open_publisher(self, channel: int, topic: str, encoding: str, type_name: str) -> None:
        if encoding not in ("cdr", "json"):
            raise MessageError(f"found encoding {encoding!r:.80}; expected cdr or json")
        number = self.link.next_number()

        def open_channel(found: JsonObject, _: bytes) -> None:
            self._publishers[channel] = number, found["type"], encoding == "json"

        args = {"number": number, "topic": topic, "type": type_name}
        self.link.ask("advertise", args, then=open_channel, failed=lambda error: self.report_error(str(error)))

    def _on_unadvertise(self, words: JsonObject) -> None:
        for number in words["channelIds"]:
            self.link.unadvertise(self._publishers.pop(number)[0])

    # ------------------------------------------------------------------ services

    def _call(self, service: int, data: bytes) -> None:
        call, length = struct.unpack_from("<II", data, 5)
        encoding, content = data[13 : 13 + length].decode(), data[13 + length :]

        def fail(error: object) -> None:
            self.tell("serviceCallFailure", serviceId=service, callId=call, message=str(error))

        def respond(_: Any, answer: bytes) -> None:
            if encoding == "json":
                answer = json.dumps(message_to_json(msgs.deserialize(answer, f"{type_name}_Response"))).encode()
            self.send(struct.pack("<BIII", _CALL, service, call, length) + encoding.encode() + answer)

        try:
            name, type_name = self._services[service]
            if encoding == "json":
                content = msgs.serialize(message_from_json(f"{type_name}_Request", json.loads(content)))
            elif encoding != "cdr":
                raise MessageError(f"found encoding {encoding!r:.80}; expected cdr or json")
        except KeyError:
            fail(f"there is no service {service}")
        except (SimkitError, ValueError, TypeError) as error:
            fail(error)
        else:
            self.link.ask("call", {"name": name, "type": f"{type_name}_Request"}, content, respond, fail)

    # ------------------------------------------------------------------ parameters

    def _ask_parameters(self, then: Any) -> None:
        """Ask for the parameters, and call a function with node, name and value by the name `NODE.NAME`."""

        def convert(nodes: JsonObject, _: bytes) -> None:
            rows = ((node, name, row["value"]) for node, found in nodes.items() for name, row in found.items())
            then({f"{node}.{name}": (node, name, value) for node, name, value in rows})

        self.link.ask("parameters", {}, then=convert)

    def _on_getParameters(self, words: JsonObject) -> None:  # noqa: N802 - ops are found by their name
        self._ask_parameters(lambda found: self._send_parameters(found, words))

    def _send_parameters(self, found: JsonObject, words: JsonObject) -> None:
        names = words.get("parameterNames") or list(found)
        rows = [_parameter(name, found[name][2]) for name in names if name in found]
        self.tell("parameterValues", parameters=rows, **({"id": words["id"]} if words.get("id") else {}))

    def _on_setParameters(self, words: JsonObject) -> None:  # noqa: N802
        wanted = {row["name"]: row["value"] for row in words["parameters"]}

        def set_all(found: JsonObject) -> None:
            for name, value in wanted.items():
                if name not in found:
                    self.report_error(f"there is no parameter {name!r}")
                    continue
                node, short, old = found[name]
                number = float(value) if isinstance(old, float) and isinstance(value, int) else value
                args = {"node": node, "name": short, "value": number}
                self.link.ask("set_parameter", args, failed=lambda error: self.report_error(str(error)))
            if words.get("id"):
                answer = {"parameterNames": list(wanted), "id": words["id"]}
                self._ask_parameters(lambda found: self._send_parameters(found, answer))

        self._ask_parameters(set_all)

    def _on_subscribeParameterUpdates(self, words: JsonObject) -> None:  # noqa: N802
        self._watched.update(words["parameterNames"])

    def _on_unsubscribeParameterUpdates(self, words: JsonObject) -> None:  # noqa: N802
        self._watched.difference_update(words["parameterNames"])

    def _send_changed(self, found: JsonObject) -> None:
        values = {name: found[name][2] for name in self._watched if name in found}
        changed = [_parameter(name, v) for name, v in values.items() if self._parameters.get(name) != v]
        self._parameters = values
        if changed:
            self.tell("parameterValues", parameters=changed)

    # ------------------------------------------------------------------ meshes

    def _on_fetchAsset(self, words: JsonObject) -> None:  # noqa: N802
        number = int(words["requestId"])

        def send(error: object, data: bytes = b"") -> None:
            text = str(error).encode()
            self.send(struct.pack("<BIBI", _ASSET, number, 1 if text else 0, len(text)) + text + data)

        def read(path: str, _: bytes) -> None:
            try:
                send("", read_input(path, LARGEST_OUT))
            except OSError as error:
                send(read_failure(error))

        self.link.ask("asset", {"uri": str(words["uri"])}, then=read, failed=send)


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


def _parameter(name: str, value: Any) -> JsonObject:
    found = {"name": name, "value": value}
    if isinstance(value, float):
        return {**found, "type": "float64"}
    if isinstance(value, list) and value and all(isinstance(item, float) for item in value):
        return {**found, "type": "float64_array"}
    return found


def main(settings: dict[str, Any]) -> int:
    """Serve clients until the simulation ends; return the exit code.

    Args:
        settings: `socket`, the path of the simulation's socket, `host`, `port` and `token`.
    """
    return run_server(lambda: WebServer("foxglove", settings, FoxgloveClient, SUBPROTOCOLS))
