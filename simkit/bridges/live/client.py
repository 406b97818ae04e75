"""One end of the line: somebody who talks to a simulation that runs in another process."""

from __future__ import annotations

import itertools
import os
import select
import socket
import struct
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any

from simkit import msgs
from simkit.bridges.live.client_handles import LiveGoal, LivePublisher, LiveSubscription
from simkit.bridges.live.discovery import find_socket
from simkit.bridges.live.protocol import (
    ANSWER,
    ASK,
    LARGEST_IN,
    LARGEST_OUT,
    MESSAGE,
    MESSAGE_HEAD,
    PROTOCOL,
    TELL,
    BadFrame,
    FrameReader,
    LiveClosed,
    LiveError,
    json_frame,
    read_json_frame,
)

_PIECE = 1 << 18  # [bytes] taken from the socket at once
_LONGEST_TIMEOUT = 1e6  # [s] for which a system waits at once without complaint
_POLL_PERIOD = 0.05  # [s] between two looks at whether a simulation has started
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
        time.sleep(_POLL_PERIOD)


class Client:
    """A connection to a running simulation; a context manager. For one thread at a time.

    Args:
        path: of its socket.
        timeout: how long it may take to answer [s], wall time.
        node: what the simulation calls the client in its lists.

    Attributes:
        info: `name`, `world`, `pid` and `version` of the simulation, and `node`, what it calls this client.
    """

    def __init__(self, path: Path, timeout: float = 10.0, node: str | None = None) -> None:
        self.path, self.timeout = path, timeout
        self.info: dict[str, Any] = {}
        self._numbers = itertools.count(1)
        self._reader = FrameReader(LARGEST_OUT, (ANSWER, TELL, MESSAGE))
        self._answers: dict[int, tuple[dict[str, Any], bytes]] = {}
        self._types: dict[int, str] = {}
        self._subscriptions: dict[int, LiveSubscription] = {}
        self._goals: dict[int, LiveGoal] = {}
        self._closed: LiveClosed | None = None
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            self._open(node)
        except BaseException:
            self._socket.close()
            raise

    def _open(self, node: str | None) -> None:
        name = self.path.stem
        self._socket.settimeout(min(self.timeout, _LONGEST_TIMEOUT))
        end = time.monotonic() + self.timeout
        try:
            while not self._called():  # others call at the same time, and wait to be let in
                if time.monotonic() >= end:
                    raise self._silent()
                time.sleep(_POLL_PERIOD)
        except TimeoutError:
            raise self._silent() from None
        except OSError as error:
            raise LiveError(f"simulation {name!r} cannot be reached: {error.strerror}", "SK-LIVE-003") from None
        self._wait(lambda: bool(self.info), self.timeout)
        if self.info.pop("protocol", None) != PROTOCOL:
            found = self.info.get("version")
            raise LiveError(f"simulation {name!r} is of simkit {found}, which speaks another protocol", "SK-LIVE-006")
        self.info["node"] = self.ask("node", name=node or f"simkit_{os.getpid()}")

    def _called(self) -> bool:
        """Connects; False where so many wait to be let in that nobody else can."""
        try:
            self._socket.connect(str(self.path))
        except BlockingIOError:
            return False
        return True

    # ------------------------------------------------------------------ asking

    def ask(self, question: str, **args: Any) -> Any:
        """The answer to a question.

        Raises:
            LiveError: the simulation cannot answer it; with the code and the words of its error.
            LiveClosed: it has ended.
        """
        return self._ask(question, args)[0]

    def _ask(self, question: str, args: Mapping[str, Any], data: bytes = b"") -> tuple[Any, bytes, str]:
        """The answer, with the CDR behind it and its type."""
        return self._answer(self._put(question, args, data))

    def _put(self, question: str, args: Mapping[str, Any], data: bytes = b"") -> int:
        """Sends a question; the number of its answer."""
        number = next(self._numbers)
        try:
            frame = json_frame(ASK, {"id": number, "ask": question, **args}, data)
        except (TypeError, ValueError) as error:
            raise LiveError(f"the arguments of {question!r} cannot be sent: {error}", "SK-LIVE-008") from None
        self._send(frame)
        return number

    def _answer(self, number: int) -> tuple[Any, bytes, str]:
        """The answer of that number, waited for."""
        self._wait(lambda: number in self._answers, self.timeout)
        words, found = self._answers.pop(number)
        if "error" in words:
            raise LiveError(str(words["error"]), str(words.get("code", "SK-LIVE-008")))
        return words.get("ok"), found, str(words.get("type", ""))

    def flush(self) -> None:
        """Returns once everything that was sent has been taken."""
        self.ask("ping")

    def state(self) -> dict[str, Any]:
        """`time_ns`, `tick`, `paused`, `rtf` (the highest allowed, None for none) and `measured_rtf`."""
        found: dict[str, Any] = self.ask("state")
        return found

    def control(self, action: str, value: float | None = None) -> dict[str, Any]:
        """Has the simulation `pause`, `resume`, `step` (`value` steps) or keep an `rtf` (`value`; None: none).

        Returns:
            The state from then on, as `state` gives it.
        """
        found: dict[str, Any] = self.ask("control", action=action, value=value)
        return found

    def topics(self) -> list[dict[str, Any]]:
        """Each topic: `name`, `types`, `publishers` (`node`, `type`, `latched`), `subscribers` (`node`, `types`)."""
        found: list[dict[str, Any]] = self.ask("topics")
        return found

    def models(self) -> list[str]:
        """The names of the models in the world."""
        found: list[str] = self.ask("models")
        return found

    def model(self, name: str) -> dict[str, Any]:
        """A model: `static`, `pose`, `links`, `joints` and `models`.

        A pose is `{"position": [x, y, z], "quaternion": [w, x, y, z], "rpy": [roll, pitch, yaw]}` in the world
        [m, rad]; a joint `{"type", "position", "velocity", "effort"}` [rad, rad/s, N m or m, m/s, N].
        """
        found: dict[str, Any] = self.ask("model", name=name)
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
            number = next(self._numbers)
            subscription = LiveSubscription(self, number, topic if topic.startswith("/") else "/" + topic, depth)
            self._subscriptions[number] = subscription  # its first messages may come with the answer
            opened.append(subscription)
            asked.append(self._put("subscribe", {"number": number, "topic": topic, "depth": depth}))
        failed: LiveError | None = None
        for subscription, number in zip(opened, asked, strict=True):
            try:
                self._answer(number)
            except LiveClosed:
                raise
            except LiveError as error:
                del self._subscriptions[subscription.number]
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
        number = next(self._numbers)
        found = self.ask("advertise", number=number, topic=topic, type=type_name)
        return LivePublisher(self, number, found["topic"], found["type"])

    def receive(self, timeout: float | None = 0.0) -> bool:
        """Takes in what has come, into subscriptions and goals; whether anything came.

        Args:
            timeout: how long to wait for something [s]; None for as long as it takes.

        Raises:
            LiveClosed: the simulation has ended.
        """
        if self._closed is not None:
            raise self._closed
        ready, _, _ = select.select([self._socket], [], [], None if timeout is None else min(timeout, _LONGEST_TIMEOUT))
        if ready:
            self._take_in()
        return bool(ready)

    def fileno(self) -> int:
        """Of the socket, to wait for together with others."""
        return self._socket.fileno()

    # ------------------------------------------------------------------ services and actions

    def services(self) -> dict[str, str]:
        """Service -> type."""
        found: dict[str, str] = self.ask("services")
        return found

    def call(self, name: str, request: Any = None) -> Any:
        """The response of a service, which is at work when this returns.

        Args:
            name: absolute, or taken as such.
            request: a dict of fields, a message, or None for all zero.

        Raises:
            LiveError: there is no such service, or the request does not fit, or the service failed.
        """
        _, data, type_name = self._asked_with("call", name, request)
        return msgs.deserialize(data, type_name)

    def actions(self) -> dict[str, str]:
        """Action -> type."""
        found: dict[str, str] = self.ask("actions")
        return found

    def send_goal(self, name: str, goal: Any = None, on_feedback: Callable[[Any], None] | None = None) -> LiveGoal:
        """Sends a goal to an action.

        Args:
            name: absolute, or taken as such.
            goal: a dict of fields, a message, or None for all zero.
            on_feedback: called with each feedback message, while something is received.
        """
        number = next(self._numbers)
        made = LiveGoal(self, number, on_feedback)
        self._goals[number] = made
        try:
            made.action, made.id = self._asked_with("goal", name, goal, number=number)[0]
        except LiveError:
            del self._goals[number]
            raise
        return made

    def _asked_with(self, question: str, name: str, message: Any, **more: Any) -> tuple[Any, bytes, str]:
        if message is None or isinstance(message, Mapping):
            return self._ask(question, {"name": name, "fields": dict(message or {}), **more})
        content = {"name": name, "type": msgs.type_name(message), **more}
        return self._ask(question, content, msgs.serialize(message))

    # ------------------------------------------------------------------ the line

    def _send(self, frame: bytes) -> None:
        if self._closed is not None:
            raise self._closed
        if len(frame) > LARGEST_IN:
            text = f"a message of {len(frame)} bytes is too large to be sent; allowed are {LARGEST_IN}"
            raise LiveError(text, "SK-LIVE-008")
        try:
            self._socket.sendall(frame)
        except TimeoutError:
            self._end(LiveClosed(f"simulation {self.path.stem!r} has stopped taking what is sent"))
        except OSError:
            with suppress(LiveClosed):
                while True:  # it may have said why
                    self._take_in()
            self._end(self._closed or LiveClosed(self._over()))
        except BaseException:
            self.close()  # half a frame may be on its way
            raise

    def _wait(self, condition: Callable[[], bool], timeout: float | None) -> bool:
        """Receives until something holds; False, or SK-LIVE-004 within an ask, when it does not in time."""
        end = None if timeout is None else time.monotonic() + timeout
        while not condition():
            left = None if end is None else end - time.monotonic()
            if left is not None and left <= 0:
                raise self._silent()
            self.receive(left)
        return True

    def _take_in(self) -> None:
        try:
            data = self._socket.recv(_PIECE)
        except OSError:
            data = b""
        if not data:
            self._end(self._closed or LiveClosed(self._over()))
        self._reader.feed(data)
        try:
            while (frame := self._reader.next()) is not None:
                self._take(*frame)
        except (BadFrame, ValueError, KeyError, TypeError, struct.error) as error:
            self._end(LiveClosed(f"simulation {self.path.stem!r} sent something odd: {error}", "SK-LIVE-006"))

    def _take(self, kind: int, body: bytes) -> None:
        if kind == MESSAGE:
            number, type_number, time_ns, lost = MESSAGE_HEAD.unpack_from(body)
            subscription = self._subscriptions.get(number)
            if subscription is not None:
                subscription._take(time_ns, self._types[type_number], body[MESSAGE_HEAD.size :], lost)
            return
        words, data = read_json_frame(body)
        if kind == ANSWER:
            self._answers[int(words["id"])] = words, data
        elif words["tell"] == "type":
            self._types[int(words["number"])] = str(words["type"])
        elif words["tell"] == "goal" and int(words["number"]) in self._goals:
            self._goals[int(words["number"])]._take(words, data)
        elif words["tell"] == "hello":
            self.info = {k: v for k, v in words.items() if k != "tell"}
        elif words["tell"] == "bye":
            self._closed = LiveClosed(str(words["why"]), str(words.get("code", "SK-LIVE-005")))
            self._socket.close()

    def _end(self, error: LiveClosed) -> None:
        """The line is dead."""
        self._closed = error
        self._socket.close()
        raise error

    def _over(self) -> str:
        return f"simulation {self.path.stem!r} has ended"

    def _silent(self) -> LiveError:
        return LiveError(
            f"simulation {self.path.stem!r} does not answer (waited {self.timeout:g} s); is it stopped?", "SK-LIVE-004"
        )

    @property
    def is_closed(self) -> bool:
        """Whether the line is dead."""
        return self._closed is not None

    def close(self) -> None:
        """Hangs up; does nothing the second time."""
        self._closed = self._closed or LiveClosed("the client is closed")
        self._socket.close()

    def __enter__(self) -> Client:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
