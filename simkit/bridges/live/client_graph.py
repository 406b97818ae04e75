"""Topics, services, actions and parameters that a client of a running simulation opens."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, overload

from simkit import msgs
from simkit.bridges.live.client_handles import LivePublisher
from simkit.bridges.live.client_servers import (
    LiveAction,
    LiveEndpoint,
    LiveInput,
    LiveParameter,
    LiveServerGoal,
    LiveService,
    T,
)
from simkit.bridges.live.protocol import JsonObject, JsonValue, LiveClosed, LiveError
from simkit.bridges.live.server_link import ServerLink
from simkit.errors import ArgumentTypeError, MessageError
from simkit.msgs.message_types import F, M, Message, R, interface_type, named_type

if TYPE_CHECKING:
    from simkit.deferred_response import DeferredResponse
    from simkit.msgs.message_classes import ActionGoal, ServiceRequest

DEFAULT_DEPTH = 1000
"""Default number of messages that a subscription queues at most, in the client and in the simulation."""
_LABELS: Final = {logging.WARNING: "WARN", logging.CRITICAL: "FATAL"}


class LiveLogger(logging.Logger):
    """Logger of a client that prints as a ROS node does, and whose messages also go to `/rosout` of the simulation.

    `setLevel("DEBUG")` also prints and publishes messages of the level DEBUG.

    Args:
        link: connection to the simulation.
        number: number of the publisher of `/rosout` on the connection.
        node: name of the client.
    """

    def __init__(self, link: ServerLink, number: int, node: str) -> None:
        super().__init__(node.strip("/").replace("/", "."), logging.INFO)
        self._link, self._number = link, number

    def isEnabledFor(self, level: int) -> bool:  # noqa: N802 - overrides logging.Logger, whose cache `setLevel` keeps
        """Check whether a message of this level is printed and published."""
        return not self.disabled and level >= self.level

    def handle(self, record: logging.LogRecord) -> None:
        """Print a message on standard error, and send it to the simulation."""
        text = record.getMessage()
        if record.exc_info:
            text = f"{text}\n{logging.Formatter().formatException(record.exc_info)}"
        label = _LABELS.get(record.levelno, record.levelname)
        sys.stderr.write(f"[{label}] [{record.created:.9f}] [{self.name}]: {text}\n")
        if not self._link.is_closed:
            place = {"file": record.pathname, "function": record.funcName or "", "line": record.lineno}
            words = {"number": self._number, "level": record.levelno, "text": text, **place}
            with suppress(LiveError):  # the simulation has ended
                self._link.post("log", words)


def absolute(name: str) -> str:
    """Return a name with its leading slash; raise ArgumentTypeError if it is not a text."""
    if not isinstance(name, str):
        raise ArgumentTypeError(f"the name must be a text, got {type(name).__name__}")
    return name if name.startswith("/") else "/" + name


def check_callback(value: object, name: str) -> None:
    """Raise ArgumentTypeError if a value cannot be called."""
    if not callable(value):
        raise ArgumentTypeError(f"{name} must be a function, got {type(value).__name__}")


class ClientGraph(ServerLink):
    """Methods with which a client opens topics, services, actions and parameters; the base class of a client.

    Args:
        path: path of the simulation's socket.
        timeout: longest wait for an answer [s], wall time.
        node: name of the client in the simulation's node lists.
    """

    def __init__(self, path: Path, timeout: float = 10.0, node: str | None = None) -> None:
        super().__init__(path, timeout, node)
        self._publishers: dict[str, LivePublisher] = {}

    @cached_property
    def log(self) -> LiveLogger:
        """Logger of this node: prints messages of the level INFO and above, and publishes them on `/rosout`."""
        return LiveLogger(self, self.next_number(), str(self.info["node"]))

    @overload
    def advertise(self, topic: str, type_name: type[M], latched: bool = False) -> LivePublisher[M]: ...

    @overload
    def advertise(self, topic: str, type_name: str | None = None, latched: bool = False) -> LivePublisher[Any]: ...

    def advertise(self, topic: str, type_name: str | type | None = None, latched: bool = False) -> LivePublisher[Any]:
        """Open a topic for publishing.

        Args:
            topic: name of the topic; a leading `/` is added if it is missing.
            type_name: type of the messages, or their class; default: the type that the topic already has.
            latched: send the last message to a later subscriber (transient local).

        Raises:
            LiveError: the topic has another type, or the type is unknown.
        """
        number = self.next_number()
        kind = None if type_name is None else named_type(type_name)
        answer = self.request("advertise", {"number": number, "topic": topic, "type": kind, "latched": latched})[0]
        return LivePublisher(self, number, answer["topic"], answer["type"])

    def publish(self, topic: str, message: object) -> None:
        """Publish a message. A message object on an unknown topic opens the topic.

        Args:
            topic: name of the topic; a leading `/` is added if it is missing.
            message: message, or a dict of its fields if the topic has a type.

        Raises:
            LiveError: the topic has another type, or does not exist.
            MessageError: the message does not match the type of the topic.
        """
        name = absolute(topic)
        if name not in self._publishers:
            type_name = getattr(message, "__msgtype__", None)
            self._publishers[name] = self.advertise(name, type_name if isinstance(type_name, str) else None)
        self._publishers[name].publish(message)

    @overload
    def listen(
        self, topic: str, types: type[M], callback: Callable[[M], object], depth: int = DEFAULT_DEPTH
    ) -> LiveInput[M]: ...

    @overload
    def listen(
        self, topic: str, types: str | Sequence[str], callback: Callable[[Message], object], depth: int = DEFAULT_DEPTH
    ) -> LiveInput[Any]: ...

    def listen(
        self,
        topic: str,
        types: str | type | Sequence[str],
        callback: Callable[[Message], object],
        depth: int = DEFAULT_DEPTH,
    ) -> LiveInput[Any]:
        """Open a topic for commands: `callback(message)` is called for each message, while the client receives.

        Args:
            topic: name of the topic; a leading `/` is added if it is missing.
            types: accepted type or types, or the class of the messages.
            callback: function that receives each message.
            depth: highest number of queued messages; if more arrive, the oldest are dropped and counted.

        Raises:
            LiveError: the topic has another type, or a type is unknown.
        """
        check_callback(callback, "callback")
        number = self.next_number()
        kinds = [types] if isinstance(types, (str, type)) else types
        names = [named_type(kind) for kind in kinds]
        opened = LiveInput[Any](self, number, absolute(topic), depth, callback)
        self.subscriptions[number] = opened.take
        try:
            self.request("listen", {"number": number, "topic": topic, "types": names, "depth": depth})[0]
        except LiveError:
            del self.subscriptions[number]
            raise
        return opened

    def spin(self, timeout: float | None = None) -> None:
        """Receive, and call the functions of this client, until the simulation ends.

        Args:
            timeout: longest time [s], wall time; None for no limit.
        """
        try:
            self.wait(lambda: False, timeout)
        except LiveClosed as error:
            if error.code != "SK-LIVE-005" or not self.is_closed:
                raise

    @overload
    def offer(
        self,
        name: str,
        type_name: type[ServiceRequest[M, R]],
        handler: Callable[[M], R | Mapping[str, object] | DeferredResponse | None],
    ) -> LiveService: ...

    @overload
    def offer(self, name: str, type_name: str, handler: Callable[[Message], object]) -> LiveService: ...

    def offer(self, name: str, type_name: str | type, handler: Callable[[Message], object]) -> LiveService:
        """Open a service, which the client answers while it receives, for example in `spin`.

        Args:
            name: name of the service; a leading `/` is added if it is missing.
            type_name: service type, such as `std_srvs/srv/Trigger`, or the class of its requests.
            handler: function that receives a request and returns the response: a message, a dict of its fields, or None
                for a message whose fields are all zero.

        Raises:
            LiveError: a service of that name exists, or the type is unknown.
        """
        check_callback(handler, "handler")
        type_name = interface_type(type_name, "Request")
        self._load_type(f"{type_name}_Request")  # now, because a caller waits for the first request
        opened = LiveService(self, self.next_number(), absolute(name), type_name, handler)
        self._open_endpoint(opened, "offer", {"name": name, "type": type_name})
        return opened

    @overload
    def act(
        self,
        name: str,
        type_name: type[ActionGoal[M, R, F]],
        callback: Callable[[LiveServerGoal[M]], R | Mapping[str, object] | None],
        on_cancel: Callable[[LiveServerGoal[M]], bool | None] | None = None,
    ) -> LiveAction: ...

    @overload
    def act(
        self,
        name: str,
        type_name: str,
        callback: Callable[[LiveServerGoal], object],
        on_cancel: Callable[[LiveServerGoal], bool | None] | None = None,
    ) -> LiveAction: ...

    def act(
        self,
        name: str,
        type_name: str | type,
        callback: Callable[[LiveServerGoal], object],
        on_cancel: Callable[[LiveServerGoal], bool | None] | None = None,
    ) -> LiveAction:
        """Open an action, whose goals the client executes while it receives, for example in `spin`.

        Args:
            name: name of the action; a leading `/` is added if it is missing.
            type_name: action type, such as `example_interfaces/action/Fibonacci`, or the class of its goals.
            callback: function that receives each new goal. It may reject the goal, or return the result: a message or a
                dict of its fields. Otherwise the goal is active until its method `succeed`, `abort` or `canceled` is
                called.
            on_cancel: function that receives a goal that another client cancels; it returns False to continue the goal.
                Without a function, every goal continues.

        Raises:
            LiveError: an action of that name exists, or the type is unknown.
        """
        check_callback(callback, "callback")
        if on_cancel is not None:
            check_callback(on_cancel, "on_cancel")
        type_name = interface_type(type_name, "Goal")
        self._load_type(f"{type_name}_Goal")
        opened = LiveAction(self, self.next_number(), absolute(name), type_name, callback, on_cancel)
        self._open_endpoint(opened, "act", {"name": name, "type": type_name, "cancels": on_cancel is not None})
        return opened

    def _load_type(self, type_name: str) -> None:
        """Load a type, which may be one that only the simulation knows.

        Raises:
            MessageError: the type is unknown here and in the simulation.
        """
        try:
            msgs.type_of(type_name)
        except MessageError:
            self.request("interfaces", {})  # the answer contains the definitions
            msgs.type_of(type_name)

    def _open_endpoint(self, endpoint: LiveEndpoint, question: str, args: Mapping[str, object]) -> JsonValue:
        """Open an endpoint in the simulation; its first requests may arrive together with the answer."""
        self.endpoints[endpoint.number] = endpoint.take
        try:
            return self.request(question, {"number": endpoint.number, **args})[0]
        except LiveError:
            self.endpoints.pop(endpoint.number, None)
            raise

    # ------------------------------------------------------------------ parameters

    def parameters(self) -> dict[str, JsonObject]:
        """Return the parameters: node -> name -> `value`, `type`, `minimum`, `maximum`, `choices`, `allowed`, …."""
        parameters: dict[str, JsonObject] = self.request("parameters", {})[0]
        return parameters

    def set_parameter(self, node: str, name: str, value: object) -> None:
        """Set a live parameter of a node.

        Raises:
            LiveError: no parameter has that name, or the value is not allowed.
        """
        self.request("set_parameter", {"node": node, "name": name, "value": value})[0]

    def declare(
        self,
        name: str,
        value: T,
        *,
        node: str | None = None,
        minimum: float | None = None,
        maximum: float | None = None,
        choices: Sequence[object] = (),
        description: str = "",
        on_change: Callable[[T], object] | None = None,
    ) -> LiveParameter[T]:
        """Declare a live parameter: `.value` is the newest value that the client has received.

        Args:
            name: name of the parameter, such as `p_gain`.
            value: first value. Later values have its type: bool, int, float, str or tuple of numbers.
            node: ROS node of the parameter; None for the name of this client.
            minimum: lower bound of the number, or of each number of a tuple.
            maximum: upper bound of the number, or of each number of a tuple.
            choices: allowed values; empty for no restriction.
            description: meaning of the parameter, with its unit.
            on_change: function that receives each new value while the client receives.

        Raises:
            LiveError: the node has a parameter of that name, or the value is not allowed.
        """
        if on_change is not None:
            check_callback(on_change, "on_change")
        opened = LiveParameter(self, self.next_number(), name, str(node), value, on_change)
        options = {"minimum": minimum, "maximum": maximum, "choices": list(choices), "description": description}
        answer = self._open_endpoint(opened, "declare", {"name": name, "value": value, "node": node, **options})
        opened.node = answer["node"]
        return opened
