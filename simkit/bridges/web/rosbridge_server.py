"""Program of the process that serves clients of rosbridge, protocol version 2."""

from __future__ import annotations

import asyncio
import json
import time
from collections import deque
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from simkit import msgs
from simkit.bridges.live.protocol import JsonObject, LiveClosed, LiveError
from simkit.bridges.web.json_messages import message_from_json, message_to_json
from simkit.bridges.web.rosapi import ROSAPI, RosapiCall
from simkit.bridges.web.web_server import WebClient, WebServer, run_server
from simkit.errors import MessageError, SimkitError
from simkit.msgs.goal_status import GoalStatus
from simkit.msgs.message_text import field_nodes

_COMPRESSIONS: Final = ("none", "cbor", "cbor-raw")
_DEPTH: Final = 100  # queued messages of a topic in the simulation, unless the client requests more
_MOST_WAITING: Final = 1000  # messages for a topic that the simulation has not opened yet
_Failed = Callable[[str], None]


class _Options(NamedTuple):
    """Options of a subscription: time between two messages [s], queue length and compression."""

    period: float
    length: int
    compression: str


class _Subscription:
    """Subscription of a client to a topic, for all of the client's ids.

    Attributes:
        number: number in the connection to the simulation.
        options: options by id.
    """

    def __init__(self, client: RosbridgeClient, topic: str, depth: int) -> None:
        self._client, self._topic = client, topic
        self.options: dict[object, _Options] = {}
        self._waiting: deque[str | bytes] = deque()
        self._next = 0.0
        self.number = client.link.subscribe(topic, self._take, self._fail, max(depth, _DEPTH))

    def _fail(self, error: LiveError) -> None:
        self._client.drop_subscription(self._topic)
        self._client.report_error(f"{self._topic}: {error}", next(iter(self.options), None))

    def _take(self, time_ns: int, type_name: str, data: bytes, lost: int) -> None:
        if not self.options:
            return
        options = self.options.values()
        period, length = min(one.period for one in options), max(one.length for one in options)
        now = time.monotonic()
        if now >= self._next and not self._waiting:
            self._next = now + period
            self._client.send(self._encoded(time_ns, type_name, data))
        elif length:
            if not self._waiting:
                asyncio.get_running_loop().call_later(self._next - now, self._send_next)
            self._waiting.append(self._encoded(time_ns, type_name, data))
            if len(self._waiting) > length:
                self._waiting.popleft()

    def _send_next(self) -> None:
        period = min((one.period for one in self.options.values()), default=0.0)
        if self._waiting and self.options:
            self._next = time.monotonic() + period
            self._client.send(self._waiting.popleft())
            if self._waiting:
                asyncio.get_running_loop().call_later(period, self._send_next)

    def _encoded(self, time_ns: int, type_name: str, data: bytes) -> str | bytes:
        compression = next(reversed(self.options.values())).compression
        found: JsonObject = {"op": "publish", "topic": self._topic}
        if compression == "none":
            return json.dumps({**found, "msg": message_to_json(msgs.deserialize(data, type_name))})
        import cbor2

        if compression == "cbor-raw":
            seconds, nanoseconds = divmod(time_ns, 10**9)
            return cbor2.dumps({**found, "msg": {"secs": seconds, "nsecs": nanoseconds, "bytes": data}})
        return cbor2.dumps({**found, "msg": message_to_json(msgs.deserialize(data, type_name), is_binary=True)})


class _Publisher:
    """Topic that a client publishes. Messages wait until the simulation has opened the topic."""

    def __init__(self, client: RosbridgeClient, words: JsonObject) -> None:
        self._client, self._topic = client, words["topic"]
        self.number = client.link.next_number()
        self._type: str | None = None
        self._waiting: deque[JsonObject] = deque(maxlen=_MOST_WAITING)
        args = {"number": self.number, "topic": self._topic, "type": words.get("type") or None}
        latched = words.get("latch") is True
        client.link.ask("advertise", {**args, "latched": latched}, then=self._open, failed=self._fail)

    def _open(self, found: JsonObject, _: bytes) -> None:
        self._type = found["type"]
        while self._waiting:
            words = self._waiting.popleft()
            self._client.guarded(words, self.publish)

    def _fail(self, error: LiveError) -> None:
        self._client.publishers.pop(self._topic, None)
        self._client.report_error(f"{self._topic}: {error}")

    def publish(self, words: JsonObject) -> None:
        """Publish a message."""
        if self._type is None:
            self._waiting.append(words)
        else:
            message = message_from_json(self._type, words.get("msg", {}))
            self._client.link.publish(self.number, msgs.serialize(message))


class RosbridgeClient(WebClient):
    """Client of rosbridge.

    Attributes:
        publishers: publishers by topic.
    """

    can_authenticate_later = True

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.publishers: dict[str, _Publisher] = {}
        self._subscriptions: dict[str, _Subscription] = {}
        self._goals: dict[object, int] = {}
        self._offered: dict[str, int] = {}
        self._calls: dict[str, JsonObject] = {}

    # ------------------------------------------------------------------ messages of the client

    def take(self, data: str | bytes) -> None:
        """Process a message of the client; an invalid one is answered with a status."""
        try:
            if isinstance(data, bytes) and not data.startswith((b"{", b"[", b" ")):
                import cbor2

                words = cbor2.loads(data)
            else:
                words = json.loads(data)
        except Exception as error:  # noqa: BLE001 - the data may be anything
            self.report_error(f"the message is not JSON or CBOR: {error}")
            return
        if not isinstance(words, dict):
            self.report_error("the message is not a JSON object")
        elif not self.is_allowed and words.get("op") != "auth":
            self.report_error("send the token first: add ?token=TOKEN to the address, or send op auth", words.get("id"))
        elif words.get("op") not in _OPERATIONS:
            self.report_error(f"unknown op {words.get('op')!r:.80}; expected {', '.join(_OPERATIONS)}", words.get("id"))
        else:
            operation = _OPERATIONS[words["op"]]
            self.guarded(words, lambda words: operation(self, words))

    def guarded(self, words: JsonObject, process: Callable[[JsonObject], None]) -> None:
        """Process a message, and answer errors of its content with a status."""
        try:
            process(words)
        except LiveClosed:
            raise
        except KeyError as error:
            self.report_error(f"op {words.get('op')}: {error} is missing or unknown", words.get("id"))
        except (SimkitError, TypeError, ValueError, AttributeError, RecursionError) as error:
            self.report_error(f"op {words.get('op')}: {error}", words.get("id"))

    def tell(self, op: str, **words: Any) -> None:
        """Send a message of the protocol; fields that are None are left out."""
        self.send(json.dumps({"op": op, **{name: value for name, value in words.items() if value is not None}}))

    def report_error(self, text: str, identifier: object = None) -> None:
        """Send a status with an error."""
        self.tell("status", level="error", msg=text, id=identifier)

    def authenticate(self, words: JsonObject) -> None:
        """Check the token, in `token` or in `mac`."""
        self.is_allowed = self.is_allowed or self.server.is_token(str(words.get("token") or words.get("mac")))
        if not self.is_allowed:
            self.report_error("the token is wrong", words.get("id"))

    # ------------------------------------------------------------------ topics

    def advertise(self, words: JsonObject) -> None:
        """Open a topic for publishing."""
        if words["topic"] not in self.publishers:
            self.publishers[words["topic"]] = _Publisher(self, words)

    def unadvertise(self, words: JsonObject) -> None:
        """Close a publisher."""
        publisher = self.publishers.pop(words["topic"], None)
        if publisher is not None:
            self.link.unadvertise(publisher.number)

    def publish(self, words: JsonObject) -> None:
        """Publish a message; a topic that exists need not be advertised."""
        self.advertise(words)
        self.publishers[words["topic"]].publish(words)

    def subscribe(self, words: JsonObject) -> None:
        """Subscribe to a topic."""
        topic, length = str(words["topic"]), int(words.get("queue_length") or 0)
        compression = words.get("compression") or "none"
        if compression not in _COMPRESSIONS:
            self.tell("status", level="warning", msg=f"compression {compression!r:.80} is not supported: none is used")
            compression = "none"
        if topic not in self._subscriptions:
            self._subscriptions[topic] = _Subscription(self, topic, length)
        rate = max(0.0, float(words.get("throttle_rate") or 0) / 1000)
        self._subscriptions[topic].options[words.get("id")] = _Options(rate, max(0, length), compression)

    def unsubscribe(self, words: JsonObject) -> None:
        """End the subscription of an id, or all subscriptions to the topic."""
        found = self._subscriptions.get(words["topic"])
        if found is not None:
            found.options.pop(words.get("id"), None)
            if not found.options or words.get("id") is None:
                self.drop_subscription(words["topic"])
                self.link.unsubscribe(found.number)

    def drop_subscription(self, topic: str) -> None:
        """Forget the subscription to a topic."""
        found = self._subscriptions.pop(topic, None)
        if found is not None:
            found.options.clear()

    # ------------------------------------------------------------------ services

    def call_service(self, words: JsonObject) -> None:
        """Call a service of the simulation or of rosapi."""
        name, identifier = words["service"], words.get("id")

        def end(values: Any, result: bool = True) -> None:
            self.tell("service_response", id=identifier, service=name, values=values, result=result)

        def fail(text: object) -> None:
            end(str(text), False)

        if name in ROSAPI:
            self.link.guarded(ROSAPI[name], fail)(RosapiCall(self, words.get("args") or {}, end, fail))
            return

        def send(kind: str, data: bytes) -> None:
            def respond(_: Any, answer: bytes) -> None:
                end(message_to_json(msgs.deserialize(answer, f"{kind}_Response")))

            self.link.ask("call", {"name": name, "type": f"{kind}_Request"}, data, respond, fail)

        self._with_type("services", name, words, "Request", send, fail)

    def _with_type(
        self, kind: str, name: str, words: JsonObject, part: str, then: Callable[[str, bytes], None], fail: _Failed
    ) -> None:
        """Ask for the type of a service or action; then call a function with the type and the encoded arguments."""

        def receive(found: Mapping[str, str], _: bytes) -> None:
            try:
                if name not in found:
                    raise MessageError(f"there is no {kind[:-1]} {name!r}")
                type_name = found[name]
                fields = words.get("args") or {}
                if isinstance(fields, list):
                    fields = dict(zip((field for field, _ in field_nodes(f"{type_name}_{part}")), fields, strict=False))
                data = msgs.serialize(message_from_json(f"{type_name}_{part}", fields))
            except (SimkitError, KeyError, TypeError, ValueError) as error:
                fail(str(error))
            else:
                then(type_name, data)

        self.link.ask(kind, {}, then=receive, failed=lambda error: fail(str(error)))

    def advertise_service(self, words: JsonObject) -> None:
        """Open a service that the client answers."""
        name, kind = words["service"], _service_type(words["type"])
        number = self._offered[name] = self.link.next_number()

        def ask_client(found: JsonObject, data: bytes) -> None:
            identifier = f"call_service:{name}:{found['call']}"
            self._calls[identifier] = {"number": number, "call": found["call"], "type": f"{kind}_Response"}
            values = message_to_json(msgs.deserialize(data, f"{kind}_Request"))
            self.tell("call_service", id=identifier, service=name, args=values)

        def fail(error: LiveError) -> None:
            self._offered.pop(name, None)
            self.report_error(f"{name}: {error}", words.get("id"))

        self.link.endpoints[number] = self.link.guarded(ask_client)
        self.link.ask("offer", {"number": number, "name": name, "type": kind}, failed=fail)

    def unadvertise_service(self, words: JsonObject) -> None:
        """Close a service of the client."""
        number = self._offered.pop(words["service"], None)
        if number is not None:
            self.link.endpoints.pop(number, None)
            self.link.ask("close_endpoint", {"number": number})

    def service_response(self, words: JsonObject) -> None:
        """Pass the response of the client to the caller of its service."""
        args = self._calls.pop(words["id"])
        kind = args.pop("type")
        try:
            if words.get("result") is False:
                raise MessageError(str(words.get("values") or "the service failed"))
            data = msgs.serialize(message_from_json(kind, words.get("values") or {}))
        except SimkitError as error:
            self.link.ask("respond", {**args, "error": str(error)})
            raise
        self.link.ask("respond", {**args, "type": kind}, data)

    # ------------------------------------------------------------------ actions

    def send_action_goal(self, words: JsonObject) -> None:
        """Send a goal to an action of the simulation."""
        action, identifier = words["action"], words.get("id")
        number = self._goals[identifier] = self.link.next_number()

        def end(values: Any, status: GoalStatus, result: bool) -> None:
            self.link.goals.pop(number, None)
            self._goals.pop(identifier, None)
            self.tell("action_result", id=identifier, action=action, values=values, status=int(status), result=result)

        def fail(text: object) -> None:
            end(str(text), GoalStatus.UNKNOWN, False)

        def send(kind: str, data: bytes) -> None:
            def update(found: JsonObject, data: bytes) -> None:
                values = message_to_json(msgs.deserialize(data, found["type"])) if data else {}
                if "status" not in found:
                    if words.get("feedback"):
                        self.tell("action_feedback", id=identifier, action=action, values=values)
                    return
                status = GoalStatus(int(found["status"]))
                if status is GoalStatus.REJECTED:
                    fail(found.get("reason") or "the goal was rejected")  # ROS has no status for a rejected goal
                elif status.is_final:
                    end(values, status, True)

            self.link.goals[number] = self.link.guarded(update)
            self.link.ask("goal", {"name": action, "number": number, "type": f"{kind}_Goal"}, data, failed=fail)

        self._with_type("actions", action, words, "Goal", send, fail)

    def cancel_action_goal(self, words: JsonObject) -> None:
        """Request the cancellation of a goal."""
        number = self._goals[words["id"]]
        # the goal is sent when the simulation has answered a request for its type, which the answer to `ping` follows
        self.link.ask("ping", {}, then=lambda *_: self.link.ask("cancel", {"number": number}))


def _service_type(name: str) -> str:
    """Return the full name of a service type: `std_srvs/SetBool` is `std_srvs/srv/SetBool`."""
    package, _, rest = str(name).partition("/")
    found = name if "/" in rest else f"{package}/srv/{rest}"
    msgs.type_of(f"{found}_Request")
    return found


_Operation = Callable[[RosbridgeClient, JsonObject], None]
_OPERATIONS: Final[Mapping[str, _Operation]] = MappingProxyType(
    {
        "auth": RosbridgeClient.authenticate,
        "advertise": RosbridgeClient.advertise,
        "unadvertise": RosbridgeClient.unadvertise,
        "publish": RosbridgeClient.publish,
        "subscribe": RosbridgeClient.subscribe,
        "unsubscribe": RosbridgeClient.unsubscribe,
        "call_service": RosbridgeClient.call_service,
        "advertise_service": RosbridgeClient.advertise_service,
        "unadvertise_service": RosbridgeClient.unadvertise_service,
        "service_response": RosbridgeClient.service_response,
        "send_action_goal": RosbridgeClient.send_action_goal,
        "cancel_action_goal": RosbridgeClient.cancel_action_goal,
        "set_level": lambda _client, _words: None,
    }
)


def main(settings: dict[str, Any]) -> int:
    """Serve clients until the simulation ends; return the exit code.

    Args:
        settings: `socket`, the path of the simulation's socket, `host`, `port` and `token`.
    """
    return run_server(lambda: WebServer("rosbridge", settings, RosbridgeClient))
