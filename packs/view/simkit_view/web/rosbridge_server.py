"""Program of the process that serves clients of rosbridge, protocol version 2."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.bridges.live.protocol import JsonObject, LiveClosed, LiveError
from simkit.bridges.live.request_fields import (
    RequestRefused,
    client_text,
    read_field,
    read_identifier,
    read_json,
    with_code,
)
from simkit.errors import MessageError
from simkit.msgs.goal_status import GoalStatus
from simkit.msgs.message_text import field_nodes
from simkit_view.web.cdr_values import read_values
from simkit_view.web.json_messages import message_from_json
from simkit_view.web.rosapi import ROSAPI, RosapiCall
from simkit_view.web.rosbridge_topics import (
    MOST_WAITING,
    SharedFrames,
    SubscriptionOptions,
    TopicPublisher,
    TopicSubscription,
)
from simkit_view.web.web_server import WebClient, WebLink, WebServer, run_server, text_frame

if TYPE_CHECKING:
    from websockets.asyncio.server import ServerConnection

_COMPRESSIONS: Final = ("none", "cbor", "cbor-raw")
_Failed = Callable[[str], None]


class RosbridgeClient(WebClient):
    """Client of rosbridge.

    Attributes:
        publishers: publishers by topic.
        frames: frames of messages for all clients of this process.
    """

    can_authenticate_later = True
    frames: Final = SharedFrames()

    def __init__(self, server: WebServer, socket: ServerConnection, link: WebLink, *, is_allowed: bool) -> None:
        super().__init__(server, socket, link, is_allowed=is_allowed)
        self.publishers: dict[str, TopicPublisher] = {}
        self._subscriptions: dict[str, TopicSubscription] = {}
        self._goals: dict[object, int] = {}
        self._offered: dict[str, int] = {}
        self._calls: dict[str, JsonObject] = {}

    # ------------------------------------------------------------------ messages of the client

    def take(self, data: str | bytes) -> None:
        """Process a message of the client; an invalid one is answered with a status."""
        try:
            words = (
                read_json(data) if isinstance(data, str) or data.startswith((b"{", b"[", b" ")) else _read_cbor(data)
            )
            if not isinstance(words, dict):
                raise RequestRefused("the message is not a JSON object")
            identifier, op = read_identifier(words), read_field(words, "op", str)
        except RequestRefused as error:
            self.report_error(str(error))
            return
        if not self.is_allowed and op != "auth":
            self.report_error("send the token first: add ?token=TOKEN to the address, or send op auth", identifier)
        elif op not in _OPERATIONS:
            self.report_error(f"unknown op {op!r:.80}; expected {', '.join(_OPERATIONS)}", identifier)
        else:
            self.guarded(words, lambda words: _OPERATIONS[op](self, words))

    def guarded(self, words: JsonObject, process: Callable[[JsonObject], None]) -> None:
        """Process a message, and answer errors of its content with a status."""
        try:
            process(words)
        except LiveClosed:
            raise
        except Exception as error:  # noqa: BLE001 - the data may be anything
            self.report_error(f"op {words['op']}: {client_text(error)}", words.get("id"))

    def tell(self, op: str, **words: object) -> None:
        """Send a message of the protocol; fields that are None are left out."""
        given = {name: value for name, value in words.items() if value is not None}
        self.send(text_frame(json.dumps({"op": op, **given})))

    def report_error(self, text: str, identifier: object = None) -> None:
        """Send a status with an error."""
        self.tell("status", level="error", msg=with_code(text), id=identifier)

    def authenticate(self, words: JsonObject) -> None:
        """Check the token, in `token` or in `mac`."""
        token = read_field(words, "token", str, "") or read_field(words, "mac", str, "")
        self.is_allowed = self.is_allowed or self.server.is_token(token)
        if not self.is_allowed:
            self.report_error("the token is wrong", words.get("id"))

    # ------------------------------------------------------------------ topics

    def advertise(self, words: JsonObject) -> None:
        """Open a topic for publishing."""
        topic = read_field(words, "topic", str)
        if topic not in self.publishers:
            self.publishers[topic] = TopicPublisher(self, topic, words)

    def unadvertise(self, words: JsonObject) -> None:
        """Close a publisher."""
        publisher = self.publishers.pop(read_field(words, "topic", str), None)
        if publisher is not None:
            self.link.unadvertise(publisher.number)

    def publish(self, words: JsonObject) -> None:
        """Publish a message; a topic that exists need not be advertised."""
        self.advertise(words)
        self.publishers[words["topic"]].publish(words)

    def subscribe(self, words: JsonObject) -> None:
        """Subscribe to a topic."""
        topic, identifier = read_field(words, "topic", str), read_identifier(words)
        length = min(max(0, int(read_field(words, "queue_length", float, 0.0))), MOST_WAITING)
        rate = max(0.0, read_field(words, "throttle_rate", float, 0.0) / 1000)
        compression = read_field(words, "compression", str, "") or "none"
        if compression not in _COMPRESSIONS:
            self.tell("status", level="warning", msg=f"compression {compression!r:.80} is not supported: none is used")
            compression = "none"
        if topic not in self._subscriptions:
            self._subscriptions[topic] = TopicSubscription(self, topic, length)
        self._subscriptions[topic].options[identifier] = SubscriptionOptions(rate, length, compression)

    def unsubscribe(self, words: JsonObject) -> None:
        """End the subscription of an id, or all subscriptions to the topic."""
        topic, identifier = read_field(words, "topic", str), read_identifier(words)
        subscription = self._subscriptions.get(topic)
        if subscription is not None:
            subscription.options.pop(identifier, None)
            if not subscription.options or identifier is None:
                self.drop_subscription(topic)
                self.link.unsubscribe(subscription.number)

    def drop_subscription(self, topic: str) -> None:
        """Forget the subscription to a topic."""
        subscription = self._subscriptions.pop(topic, None)
        if subscription is not None:
            subscription.options.clear()

    # ------------------------------------------------------------------ services

    def call_service(self, words: JsonObject) -> None:
        """Call a service of the simulation or of rosapi."""
        name, identifier = read_field(words, "service", str), read_identifier(words)

        def end(values: object, result: bool = True) -> None:
            self.tell("service_response", id=identifier, service=name, values=values, result=result)

        def fail(text: object) -> None:
            end(with_code(str(text)), False)

        if name in ROSAPI:
            args = read_field(words, "args", dict, {}) if words.get("args") else {}
            self.link.guarded(ROSAPI[name], fail)(RosapiCall(self, args, end, fail))
            return

        def send(kind: str, data: bytes) -> None:
            def respond(_: object, answer: bytes) -> None:
                end(read_values(answer, f"{kind}_Response"))

            self.link.ask("call", {"name": name, "type": f"{kind}_Request"}, data, respond, fail)

        self._with_type("services", name, words, "Request", send, fail)

    def _with_type(
        self, kind: str, name: str, words: JsonObject, part: str, then: Callable[[str, bytes], None], fail: _Failed
    ) -> None:
        """Ask for the type of a service or action; then call a function with the type and the encoded arguments."""

        def receive(interfaces: Mapping[str, str], _: bytes) -> None:
            try:
                if name not in interfaces:
                    raise MessageError(f"there is no {kind[:-1]} {name!r}")
                type_name = interfaces[name]
                fields = words.get("args") or {}
                if isinstance(fields, list):
                    fields = dict(zip((field for field, _ in field_nodes(f"{type_name}_{part}")), fields, strict=False))
                data = msgs.serialize(message_from_json(f"{type_name}_{part}", fields))
            except Exception as error:  # noqa: BLE001 - the client may have sent any value
                fail(client_text(error))
            else:
                then(type_name, data)

        self.link.ask(kind, {}, then=receive, failed=lambda error: fail(client_text(error)))

    def advertise_service(self, words: JsonObject) -> None:
        """Open a service that the client answers."""
        name, kind = read_field(words, "service", str), _service_type(read_field(words, "type", str))
        number = self._offered[name] = self.link.next_number()

        def ask_client(result: JsonObject, data: bytes) -> None:
            identifier = f"call_service:{name}:{result['call']}"
            self._calls[identifier] = {"number": number, "call": result["call"], "type": f"{kind}_Response"}
            values = read_values(data, f"{kind}_Request")
            self.tell("call_service", id=identifier, service=name, args=values)

        def fail(error: LiveError) -> None:
            self._offered.pop(name, None)
            self.report_error(f"{name}: {error}", words.get("id"))

        self.link.endpoints[number] = self.link.guarded(ask_client)
        self.link.ask("offer", {"number": number, "name": name, "type": kind}, failed=fail)

    def unadvertise_service(self, words: JsonObject) -> None:
        """Close a service of the client."""
        number = self._offered.pop(read_field(words, "service", str), None)
        if number is not None:
            self.link.endpoints.pop(number, None)
            self.link.ask("close_endpoint", {"number": number})

    def service_response(self, words: JsonObject) -> None:
        """Pass the response of the client to the caller of its service."""
        args = self._calls.pop(read_field(words, "id", str), None)
        if args is None:
            raise RequestRefused(f"no call with the id {words['id']!r:.80} waits for a response")
        kind = args.pop("type")
        try:
            if words.get("result") is False:
                raise MessageError(str(words.get("values") or "the service failed"))
            data = msgs.serialize(message_from_json(kind, words.get("values") or {}))
        except Exception as error:
            self.link.ask("respond", {**args, "error": client_text(error)})
            raise
        self.link.ask("respond", {**args, "type": kind}, data)

    # ------------------------------------------------------------------ actions

    def send_action_goal(self, words: JsonObject) -> None:
        """Send a goal to an action of the simulation."""
        action, identifier = read_field(words, "action", str), read_identifier(words)
        number = self._goals[identifier] = self.link.next_number()

        def end(values: object, status: GoalStatus, result: bool) -> None:
            self.link.goals.pop(number, None)
            self._goals.pop(identifier, None)
            self.tell("action_result", id=identifier, action=action, values=values, status=int(status), result=result)

        def fail(text: object) -> None:
            end(with_code(str(text)), GoalStatus.UNKNOWN, False)

        def send(kind: str, data: bytes) -> None:
            def update(answer: JsonObject, data: bytes) -> None:
                values = read_values(data, answer["type"]) if data else {}
                if "status" not in answer:
                    if words.get("feedback"):
                        self.tell("action_feedback", id=identifier, action=action, values=values)
                    return
                status = GoalStatus(int(answer["status"]))
                if status is GoalStatus.REJECTED:
                    fail(answer.get("reason") or "the goal was rejected")  # ROS has no status for a rejected goal
                elif status.is_final:
                    end(values, status, True)

            self.link.goals[number] = self.link.guarded(update)
            self.link.ask("goal", {"name": action, "number": number, "type": f"{kind}_Goal"}, data, failed=fail)

        self._with_type("actions", action, words, "Goal", send, fail)

    def cancel_action_goal(self, words: JsonObject) -> None:
        """Request the cancellation of a goal."""
        number = self._goals.get(read_identifier(words))
        if number is None:
            raise RequestRefused(f"there is no goal with the id {words.get('id')!r:.80}")
        # the goal is sent when the simulation has answered a request for its type, which the answer to `ping` follows
        self.link.ask("ping", {}, then=lambda *_: self.link.ask("cancel", {"number": number}))


def _read_cbor(data: bytes) -> object:
    """Return the value of CBOR data.

    Raises:
        RequestRefused: the data are not CBOR.
    """
    import cbor2

    try:
        return cbor2.loads(data)
    except Exception:  # noqa: BLE001 - the data may be anything
        raise RequestRefused("the message is not JSON or CBOR") from None


def _service_type(name: str) -> str:
    """Return the full name of a service type: `std_srvs/SetBool` is `std_srvs/srv/SetBool`."""
    package, _, rest = name.partition("/")
    full_name = name if "/" in rest else f"{package}/srv/{rest}"
    msgs.type_of(f"{full_name}_Request")
    return full_name


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


def main(settings: JsonObject) -> int:
    """Serve clients until the simulation ends; return the exit code.

    Args:
        settings: `socket`, the path of the simulation's socket, `host`, `port` and `token`.
    """
    return run_server(lambda: WebServer("rosbridge", settings, RosbridgeClient))
