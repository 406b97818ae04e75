"""Client of a simulation that runs in another process: `simkit.live.connect`."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, overload

from simkit import msgs
from simkit.argument_checks import check_kind, checked_number
from simkit.bridges.live.client_graph import DEFAULT_DEPTH, ClientGraph, absolute, check_callback
from simkit.bridges.live.client_handles import LiveGoal, LiveSubscription
from simkit.bridges.live.discovery import find_socket
from simkit.bridges.live.protocol import JsonObject, JsonValue, LiveClosed, LiveError
from simkit.bridges.live.server_link import CONNECT_PERIOD
from simkit.msgs.message_arguments import typed_message
from simkit.msgs.message_types import F, M, Message, R, named_type

if TYPE_CHECKING:
    from simkit.bridges.live.client_transforms import LiveTransforms
    from simkit.msgs.message_classes import ActionGoal, ServiceRequest

NO_ANSWER: Final = "SK-SERVICE-010"


def connect(name: str | None = None, timeout: float = 10.0, node: str | None = None, wait: float = 0.0) -> Client:
    """Connect to a simulation of the same user.

    Args:
        name: name of the simulation; default: the environment variable `SIMKIT_SIM`, else the only running simulation.
        timeout: longest wait for any answer of the simulation [s], wall time.
        node: name of the client in the simulation's node lists.
        wait: longest wait for a simulation that has not started yet [s], wall time.

    Raises:
        LiveError: SK-LIVE-001 no simulation runs; SK-LIVE-002 several simulations run; SK-LIVE-003 no simulation has
            the name; SK-LIVE-004 the simulation does not answer.
    """
    check_kind(name, (str, type(None)), "name", "a text")
    end = time.monotonic() + checked_number(wait, "wait", 0.0, unit="s", finite=False)
    while True:
        try:
            return Client(find_socket(name), timeout, node)
        except LiveError as error:
            if error.code not in ("SK-LIVE-001", "SK-LIVE-003") or time.monotonic() >= end:
                raise
        time.sleep(CONNECT_PERIOD)


class Client(ClientGraph):
    """Connection to a running simulation; a context manager. Use each client in one thread only.

    Args:
        path: path of the simulation's socket.
        timeout: longest wait for an answer [s], wall time.
        node: name of the client in the simulation's node lists.

    Attributes:
        info: `name`, `world`, `pid` and `version` of the simulation, and `node`, the client's name in its lists.
    """

    # ------------------------------------------------------------------ requests

    def ask(self, question: str, **args: object) -> JsonValue:
        """Send a request and return its answer.

        Raises:
            LiveError: the simulation cannot answer the request; with the code and the message of its error.
            LiveClosed: the simulation has ended.
        """
        return self.request(question, args)[0]

    def flush(self) -> None:
        """Wait until the simulation has processed everything that this client sent."""
        self.ask("ping")

    def state(self) -> JsonObject:
        """Return `time_ns`, `tick`, `paused`, `rtf` (the highest allowed, None for no limit) and `measured_rtf`."""
        state: JsonObject = self.ask("state")
        return state

    def control(self, action: str, value: float | None = None) -> JsonObject:
        """Pause, resume or step the simulation, or limit its real-time factor.

        Args:
            action: `pause`, `resume`, `step` or `rtf`.
            value: number of steps for `step`; highest real-time factor for `rtf` (None: no limit).

        Returns:
            State after the action, in the form that `state` returns.
        """
        state: JsonObject = self.ask("control", action=action, value=value)
        return state

    def topics(self) -> list[JsonObject]:
        """List the topics.

        Returns:
            Rows with `name`, `types`, `publishers` (`node`, `type`, `latched`) and `subscribers` (`node`, `types`).
        """
        topics: list[JsonObject] = self.ask("topics")
        return topics

    def models(self) -> list[str]:
        """Return the names of the models in the world."""
        names: list[str] = self.ask("models")
        return names

    def model(self, name: str) -> JsonObject:
        """Return the state of a model: `static`, `pose`, `links`, `joints` and `models`.

        A pose is `{"position": [x, y, z], "quaternion": [w, x, y, z], "rpy": [roll, pitch, yaw]}` in the world frame
        [m, rad]. A joint is `{"type", "position", "velocity", "effort"}` [rad, rad/s, N m or m, m/s, N].
        """
        state: JsonObject = self.ask("model", name=name)
        return state

    def interfaces(self) -> list[str]:
        """Return the names of the user's messages, services and actions in the simulation, and define them here."""
        names: list[str] = self.ask("interfaces")
        return names

    # ------------------------------------------------------------------ topics

    @overload
    def subscribe(
        self,
        topic: str,
        callback: Callable[[M], object] | None = None,
        depth: int = DEFAULT_DEPTH,
        *,
        type: type[M],
    ) -> LiveSubscription[M]: ...

    @overload
    def subscribe(
        self,
        topic: str,
        callback: Callable[[Message], object] | None = None,
        depth: int = DEFAULT_DEPTH,
        *,
        type: str | None = None,
    ) -> LiveSubscription[Any]: ...

    def subscribe(
        self,
        topic: str,
        callback: Callable[[Message], object] | None = None,
        depth: int = DEFAULT_DEPTH,
        *,
        type: str | type | None = None,
    ) -> LiveSubscription[Any]:
        """Subscribe to a topic. The topic need not exist yet.

        Args:
            topic: name of the topic; a leading `/` is added if it is missing.
            callback: function that receives each message while the client receives, for example in `spin`. Without it,
                the messages wait in the subscription.
            depth: highest number of queued messages; if more arrive, the oldest are dropped and counted.
            type: class that the messages must have, such as `msgs.LaserScan`, or its type name; None for any. Type
                checkers then know the class of the messages.

        Raises:
            LiveError: SK-MSG-001 the topic has another type. If the topic gets another type later, the method that
                receives its first message raises the error.
        """
        if callback is not None:
            check_callback(callback, "callback")
        return self.subscribe_all([topic], depth, callback, "" if type is None else msgs.full_name(named_type(type)))[0]

    def subscribe_all(
        self,
        topics: Iterable[str],
        depth: int = DEFAULT_DEPTH,
        callback: Callable[[Message], object] | None = None,
        expected: str = "",
    ) -> list[LiveSubscription]:
        """Subscribe to several topics at once, which must have the type `expected`, if it is not empty.

        All requests are sent before the first answer is read, because a simulation with slow steps answers only once
        per step.
        """
        opened: list[LiveSubscription] = []
        requests = []
        for topic in topics:
            number = self.next_number()
            subscription = LiveSubscription[Any](self, number, absolute(topic), depth, callback, expected)
            self.subscriptions[number] = subscription.take  # the first messages may arrive together with the answer
            opened.append(subscription)
            args = {"number": number, "topic": topic, "depth": depth}
            requests.append(self.send_request("subscribe", args))
        failed: LiveError | None = None
        for subscription, number in zip(opened, requests, strict=True):
            try:
                found = self.answer(number)[0]["type"]
            except LiveClosed:
                raise
            except LiveError as error:
                del self.subscriptions[subscription.number]
                failed = failed or error
                continue
            try:
                subscription.check_type(found or expected)
            except LiveError:
                subscription.close()
                raise
        if failed is not None:
            raise failed
        return opened

    @cached_property
    def tf(self) -> LiveTransforms:
        """Poses of frames in other frames, from `/tf` and `/tf_static`; received from the first use on."""
        from simkit.bridges.live.client_transforms import TOPICS, LiveTransforms  # imports NumPy

        return LiveTransforms(self, self.subscribe_all(TOPICS), int(self.state()["time_ns"]))

    # ------------------------------------------------------------------ services and actions

    def services(self) -> dict[str, str]:
        """Return the services: name -> type."""
        type_by_service: dict[str, str] = self.ask("services")
        return type_by_service

    @overload
    def call(self, name: str, request: ServiceRequest[M, R], timeout: float | None = None) -> R: ...

    @overload
    def call(
        self,
        name: str,
        request: Mapping[str, object] | None = None,
        timeout: float | None = None,
        *,
        type: type[ServiceRequest[M, R]],
    ) -> R: ...

    @overload
    def call(
        self,
        name: str,
        request: Mapping[str, object] | None = None,
        timeout: float | None = None,
        *,
        type: str | None = None,
    ) -> Any: ...

    def call(
        self, name: str, request: Message = None, timeout: float | None = None, *, type: str | type | None = None
    ) -> Any:
        """Call a service and return its response. The service has finished when this method returns.

        Args:
            name: name of the service; a leading `/` is added if it is missing.
            request: a dict of fields, a message, or None for a request with all fields zero.
            timeout: longest wait for the response [s], wall time; None for the timeout of the client.
            type: type that the service must have, or the class of its requests, such as `msgs.SetBool_Request`; None
                for any. Type checkers then know the class of the response, as for a request that is a message.

        Raises:
            MessageError: the request does not match `type`.
            LiveError: the service does not exist, the request does not match its type, the service failed, or it gives
                no response in time.
        """
        request = typed_message(request, type, "Request", repr(absolute(name)))
        try:
            _, data, type_name = self._request_with_message("call", name, request, timeout)
        except LiveError as error:
            if error.code != "SK-LIVE-004":
                raise
            wait = self.timeout if timeout is None else timeout
            message = f"service {absolute(name)!r} gave no response within {wait:g} s"
            raise LiveError(NO_ANSWER, f"{message}; it is slow, or its process or the simulation is stopped") from None
        return msgs.deserialize(data, type_name)

    def actions(self) -> dict[str, str]:
        """Return the actions: name -> type."""
        type_by_action: dict[str, str] = self.ask("actions")
        return type_by_action

    @overload
    def send_goal(
        self, name: str, goal: ActionGoal[M, R, F], on_feedback: Callable[[F], object] | None = None
    ) -> LiveGoal[M]: ...

    @overload
    def send_goal(
        self,
        name: str,
        goal: Mapping[str, object] | None = None,
        on_feedback: Callable[[F], object] | None = None,
        *,
        type: type[ActionGoal[M, R, F]],
    ) -> LiveGoal[M]: ...

    @overload
    def send_goal(
        self,
        name: str,
        goal: Mapping[str, object] | None = None,
        on_feedback: Callable[[Message], object] | None = None,
        *,
        type: str | None = None,
    ) -> LiveGoal[Any]: ...

    def send_goal(
        self,
        name: str,
        goal: Message = None,
        on_feedback: Callable[[Message], object] | None = None,
        *,
        type: str | type | None = None,
    ) -> LiveGoal[Any]:
        """Send a goal to an action.

        Args:
            name: name of the action; a leading `/` is added if it is missing.
            goal: a dict of fields, a message, or None for a goal with all fields zero.
            on_feedback: callback for each feedback message; called while the client receives.
            type: type that the action must have, or the class of its goals, such as `msgs.Fibonacci_Goal`; None for
                any. Type checkers then know the classes of feedback and result, as for a goal that is a message.

        Raises:
            MessageError: the goal does not match `type`.
            LiveError: the action does not exist, or the goal does not match its type.
        """
        goal = typed_message(goal, type, "Goal", repr(absolute(name)))
        number = self.next_number()
        handle = LiveGoal[Any](self, number, on_feedback)
        self.goals[number] = handle.take
        try:
            handle.action, handle.id = self._request_with_message("goal", name, goal, number=number)[0]
        except LiveError:
            del self.goals[number]
            raise
        return handle

    def _request_with_message(
        self, question: str, name: str, message: object, timeout: float | None = None, **more: object
    ) -> tuple[JsonValue, bytes, str]:
        if message is None or isinstance(message, Mapping):
            return self.request(question, {"name": name, "fields": dict(message or {}), **more}, b"", timeout)
        content = {"name": name, "type": msgs.type_name(message), **more}
        return self.request(question, content, msgs.serialize(message), timeout)

    def __repr__(self) -> str:
        name, world = self.info.get("name", ""), self.info.get("world", "")
        return f"<Client of {name!r}, world {world!r}{' (closed)' if self.is_closed else ''}>"

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
