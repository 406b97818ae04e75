"""A client of a simulation that runs in another process: `simkit.live.connect`."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping

from simkit import msgs
from simkit.bridges.live.client_handles import LiveGoal, LivePublisher, LiveSubscription
from simkit.bridges.live.discovery import find_socket
from simkit.bridges.live.protocol import JsonObject, JsonValue, LiveClosed, LiveError
from simkit.bridges.live.server_link import CONNECT_PERIOD, ServerLink
from simkit.msgs.message_types import Message

DEFAULT_DEPTH = 1000
"""So many messages of a subscription wait at most, here and at the simulation, where nothing is said."""


def connect(name: str | None = None, timeout: float = 10.0, node: str | None = None, wait: float = 0.0) -> Client:
    """Connects to a simulation of the same user.

    Args:
        name: of the simulation; else the environment's `SIMKIT_SIM`, else the only one that runs.
        timeout: how long it may take to answer anything [s], wall time.
        node: what the simulation calls the client in its lists.
        wait: how long to wait for one that has not started yet [s], wall time.

    Raises:
        LiveError: SK-LIVE-001 none runs; SK-LIVE-002 several do; SK-LIVE-003 none of that name does; SK-LIVE-004 it
            does not answer.
    """
    end = time.monotonic() + wait
    while True:
        try:
            return Client(find_socket(name), timeout, node)
        except LiveError as error:
            if error.code not in ("SK-LIVE-001", "SK-LIVE-003") or time.monotonic() >= end:
                raise
        time.sleep(CONNECT_PERIOD)


class Client(ServerLink):
    """A connection to a running simulation; a context manager. For one thread at a time.

    Args:
        path: of its socket.
        timeout: how long it may take to answer [s], wall time.
        node: what the simulation calls the client in its lists.

    Attributes:
        info: `name`, `world`, `pid` and `version` of the simulation, and `node`, what it calls this client.
    """

    # ------------------------------------------------------------------ asking

    def ask(self, question: str, **args: object) -> JsonValue:
        """The answer to a question.

        Raises:
            LiveError: the simulation cannot answer it; with the code and the words of its error.
            LiveClosed: it has ended.
        """
        return self.request(question, args)[0]

    def flush(self) -> None:
        """Returns once everything that was sent has been taken."""
        self.ask("ping")

    def state(self) -> JsonObject:
        """`time_ns`, `tick`, `paused`, `rtf` (the highest allowed, None for none) and `measured_rtf`."""
        found: JsonObject = self.ask("state")
        return found

    def control(self, action: str, value: float | None = None) -> JsonObject:
        """Make the simulation `pause`, `resume`, `step` (`value` steps) or keep an `rtf` (`value`; None: none).

        Returns:
            The state from then on, as `state` gives it.
        """
        found: JsonObject = self.ask("control", action=action, value=value)
        return found

    def topics(self) -> list[JsonObject]:
        """Each topic: `name`, `types`, `publishers` (`node`, `type`, `latched`), `subscribers` (`node`, `types`)."""
        found: list[JsonObject] = self.ask("topics")
        return found

    def models(self) -> list[str]:
        """The names of the models in the world."""
        found: list[str] = self.ask("models")
        return found

    def model(self, name: str) -> JsonObject:
        """A model: `static`, `pose`, `links`, `joints` and `models`.

        A pose is `{"position": [x, y, z], "quaternion": [w, x, y, z], "rpy": [roll, pitch, yaw]}` in the world
        [m, rad]; a joint `{"type", "position", "velocity", "effort"}` [rad, rad/s, N m or m, m/s, N].
        """
        found: JsonObject = self.ask("model", name=name)
        return found

    # ------------------------------------------------------------------ topics

    def subscribe(self, topic: str, depth: int = DEFAULT_DEPTH) -> LiveSubscription:
        """Receives a topic, whether it exists yet or not.

        Args:
            topic: absolute, or taken as such.
            depth: how many messages wait at most; of more, the oldest are dropped and counted.
        """
        return self.subscribe_all([topic], depth)[0]

    def subscribe_all(self, topics: Iterable[str], depth: int = DEFAULT_DEPTH) -> list[LiveSubscription]:
        """Receives topics, asked for at once: a simulation with slow steps answers once a step."""
        opened, asked = [], []
        for topic in topics:
            number = self.next_number()
            subscription = LiveSubscription(self, number, topic if topic.startswith("/") else "/" + topic, depth)
            self.subscriptions[number] = subscription.take  # its first messages may come with the answer
            opened.append(subscription)
            asked.append(self.send_request("subscribe", {"number": number, "topic": topic, "depth": depth}))
        failed: LiveError | None = None
        for subscription, number in zip(opened, asked, strict=True):
            try:
                self.answer(number)
            except LiveClosed:
                raise
            except LiveError as error:
                del self.subscriptions[subscription.number]
                failed = failed or error
        if failed is not None:
            raise failed
        return opened

    def advertise(self, topic: str, type_name: str | None = None) -> LivePublisher:
        """Opens a topic for publishing.

        Args:
            topic: absolute, or taken as such.
            type_name: where it is left out, the topic's own.

        Raises:
            LiveError: the topic is of another type, or there is no such type.
        """
        number = self.next_number()
        found = self.ask("advertise", number=number, topic=topic, type=type_name)
        return LivePublisher(self, number, found["topic"], found["type"])

    # ------------------------------------------------------------------ services and actions

    def services(self) -> dict[str, str]:
        """Service -> type."""
        found: dict[str, str] = self.ask("services")
        return found

    def call(self, name: str, request: object = None) -> Message:
        """The response of a service, which is at work when this returns.

        Args:
            name: absolute, or taken as such.
            request: a dict of fields, a message, or None for all zero.

        Raises:
            LiveError: there is no such service, or the request does not fit, or the service failed.
        """
        _, data, type_name = self._request_with_message("call", name, request)
        return msgs.deserialize(data, type_name)

    def actions(self) -> dict[str, str]:
        """Action -> type."""
        found: dict[str, str] = self.ask("actions")
        return found

    def send_goal(
        self, name: str, goal: object = None, on_feedback: Callable[[Message], None] | None = None
    ) -> LiveGoal:
        """Sends a goal to an action.

        Args:
            name: absolute, or taken as such.
            goal: a dict of fields, a message, or None for all zero.
            on_feedback: called with each feedback message, while something is received.
        """
        number = self.next_number()
        made = LiveGoal(self, number, on_feedback)
        self.goals[number] = made.take
        try:
            made.action, made.id = self._request_with_message("goal", name, goal, number=number)[0]
        except LiveError:
            del self.goals[number]
            raise
        return made

    def _request_with_message(
        self, question: str, name: str, message: object, **more: object
    ) -> tuple[JsonValue, bytes, str]:
        if message is None or isinstance(message, Mapping):
            return self.request(question, {"name": name, "fields": dict(message or {}), **more})
        content = {"name": name, "type": msgs.type_name(message), **more}
        return self.request(question, content, msgs.serialize(message))

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
