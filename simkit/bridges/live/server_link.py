"""Client side of the socket: sends requests to a simulation in another process and dispatches its answers."""

from __future__ import annotations

import itertools
import os
import select
import socket
import struct
import time
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

from simkit.bridges.live import socket_files
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
    JsonObject,
    JsonValue,
    LiveClosed,
    LiveError,
    json_frame,
    read_json_frame,
)
from simkit.bridges.live.type_exchange import SentTypes, detach
from simkit.msgs import own_interfaces
from simkit.number_text import counted

_ENDPOINT_TELLS = ("request", "goal_request", "goal_cancel", "parameter")
_PIECE = 1 << 20  # [bytes] read from the socket at once
_LONGEST_TIMEOUT = 1e6  # [s]; `select` rejects much longer waits on some systems
CONNECT_PERIOD = 0.05
"""[s] of wall time between two attempts to connect to a simulation that does not accept connections yet."""


MessageReceiver = Callable[[int, str, bytes, int], None]
"""Callback for a message: time [ns], type, CDR and number of messages dropped so far."""
GoalListener = Callable[[JsonObject, bytes], None]
"""Callback for feedback, a status or a result of a goal."""


class ServerLink:
    """Connection to the socket of a running simulation. Use each link in one thread only.

    Args:
        path: path of the socket.
        timeout: longest wait for an answer [s], wall time.
        node: name of the client in the simulation's node lists.

    Attributes:
        info: `name`, `world`, `pid` and `version` of the simulation, and `node`, the client's name in its lists.
        subscriptions, goals, endpoints: functions for messages, goal updates and requests, by number.
        requests: requests to the client's services, which are also answered while a callback waits.
        callbacks: other calls of the client's functions, which wait until no other callback runs.
    """

    def __init__(self, path: Path, timeout: float = 10.0, node: str | None = None) -> None:
        self.path, self.timeout = path, timeout
        self.info: JsonObject = {}
        self.subscriptions: dict[int, MessageReceiver] = {}
        self.goals: dict[int, GoalListener] = {}
        self.endpoints: dict[int, GoalListener] = {}
        self.requests: deque[Callable[[], object]] = deque()
        self.callbacks: deque[Callable[[], object]] = deque()
        self._is_in_callback = False
        self._abandoned: set[int] = set()
        self._numbers = itertools.count(1)
        self._answers: dict[int, tuple[JsonObject, bytes]] = {}
        self._types: dict[int, str] = {}
        self._types_sent = SentTypes()
        self._closed: LiveClosed | None = None
        self._piece = memoryview(bytearray(_PIECE))  # a new one for each piece takes longer than its content
        self._socket, token = self._connect()
        self._reader = FrameReader(LARGEST_OUT, (ANSWER, TELL, MESSAGE), token)
        try:
            self._open(node)
        except BaseException:
            self._socket.close()
            raise

    def _connect(self) -> tuple[socket.socket, bytes]:
        """Return a connection to the socket, and the bytes that the simulation must send first."""
        end = time.monotonic() + self.timeout
        try:
            while True:
                try:
                    return socket_files.connect(self.path, min(self.timeout, _LONGEST_TIMEOUT))
                except BlockingIOError:  # the accept queue is full while many clients connect
                    if time.monotonic() >= end:
                        raise self._no_answer() from None
                time.sleep(CONNECT_PERIOD)
        except TimeoutError:
            raise self._no_answer() from None
        except OSError as error:
            text = f"simulation {self.path.stem!r} cannot be reached: {error.strerror}"
            raise LiveError("SK-LIVE-003", text) from None

    def _open(self, node: str | None) -> None:
        name = self.path.stem
        self._wait_for_answer(lambda: bool(self.info))
        if self.info.pop("protocol", None) != PROTOCOL:
            version = self.info.get("version")
            raise LiveError("SK-LIVE-006", f"simulation {name!r} runs simkit {version}, with another protocol version")
        self.info["node"] = self.request("node", {"name": node or f"simkit_{os.getpid()}"})[0]

    def request(
        self, question: str, args: Mapping[str, object], data: bytes = b"", timeout: float | None = None
    ) -> tuple[JsonValue, bytes, str]:
        """Return the answer to a request, with the CDR after it and the CDR's type.

        Args:
            question: name of the request.
            args: arguments of the request.
            data: message as CDR.
            timeout: longest wait for the answer [s]; None for the timeout of the link.

        Raises:
            LiveError: the simulation cannot answer the request; with the code and the message of its error.
            LiveClosed: the simulation has ended.
        """
        return self.answer(self.send_request(question, args, data), timeout)

    def post(self, question: str, args: Mapping[str, object], data: bytes = b"") -> None:
        """Send a request whose answer is not needed."""
        self._abandoned.add(self.send_request(question, args, data))

    def send_request(self, question: str, args: Mapping[str, object], data: bytes = b"") -> int:
        """Send a request; return the number of its answer."""
        number = next(self._numbers)
        try:
            frame = json_frame(ASK, self._types_sent.attach({"id": number, "ask": question, **args}), data)
        except (TypeError, ValueError) as error:
            raise LiveError("SK-LIVE-008", f"the arguments of {question!r} cannot be sent: {error}") from None
        self.send(frame)
        return number

    def answer(self, number: int, timeout: float | None = None) -> tuple[JsonValue, bytes, str]:
        """Wait for the answer with that number and return it."""
        try:
            self._wait_for_answer(lambda: number in self._answers, timeout)
        except BaseException:
            if self._answers.pop(number, None) is None:
                self._abandoned.add(number)
            raise
        words, data = self._answers.pop(number)
        if "error" in words:
            raise LiveError(str(words.get("code", "SK-LIVE-008")), str(words["error"]))
        return words.get("ok"), data, str(words.get("type", ""))

    def has_answer(self, number: int) -> bool:
        """Check whether the answer with that number has arrived, so that `answer` returns at once."""
        return number in self._answers

    def next_number(self) -> int:
        """Return an unused number for a new handle."""
        return next(self._numbers)

    def receive(self, timeout: float | None = 0.0) -> bool:
        """Receive frames, and call the functions of subscriptions, goals, services and actions.

        Within a callback, only requests to this client's services are processed; other callbacks wait for its end.

        Args:
            timeout: longest wait for a frame [s]; None for no limit.

        Returns:
            True if anything arrived.

        Raises:
            LiveClosed: the simulation has ended.
        """
        if self._call_functions():
            return True
        if self._closed is not None:
            raise self._closed
        ready, _, _ = select.select([self._socket], [], [], None if timeout is None else min(timeout, _LONGEST_TIMEOUT))
        if ready:
            self._receive_piece()
            self._call_functions()
        return bool(ready)

    def _call_functions(self) -> bool:
        """Call the functions of this client for what has arrived; return True if there were any."""
        called = False
        while self.requests or (self.callbacks and not self._is_in_callback):
            before, self._is_in_callback = self._is_in_callback, True
            try:
                (self.requests or self.callbacks).popleft()()
            finally:
                self._is_in_callback = before
            called = True
        return called

    def fileno(self) -> int:
        """Return the socket's file descriptor, for `select`."""
        return self._socket.fileno()

    def send(self, frame: bytes) -> None:
        """Send a whole frame.

        Raises:
            LiveClosed: the simulation has ended.
        """
        if self._closed is not None:
            raise self._closed
        if len(frame) > LARGEST_IN:
            text = f"a message of {counted(len(frame), 'byte')} is too large to send; the limit is {LARGEST_IN}"
            raise LiveError("SK-LIVE-008", text)
        try:
            self._socket.sendall(frame)
        except TimeoutError:
            self._fail(LiveClosed(f"simulation {self.path.stem!r} has stopped reading from its socket"))
        except OSError:
            with suppress(LiveClosed):
                while True:  # the reason for the end may still be in the socket
                    self._receive_piece()
            self._fail(self._closed or LiveClosed(self._end_message()))
        except BaseException:
            self.close()  # an incomplete frame may have been sent
            raise

    def wait(self, condition: Callable[[], bool], timeout: float | None) -> bool:
        """Receive until a condition holds; return False after the timeout [s, wall time]."""
        end = None if timeout is None else time.monotonic() + timeout
        while not condition():
            left = None if end is None else end - time.monotonic()
            if left is not None and left <= 0:
                return False
            self.receive(left)
        return True

    def _wait_for_answer(self, condition: Callable[[], bool], timeout: float | None = None) -> None:
        if not self.wait(condition, self.timeout if timeout is None else timeout):
            raise self._no_answer()

    def _receive_piece(self) -> None:
        try:
            size = self._socket.recv_into(self._piece)
        except OSError:
            size = 0
        if not size:
            self._fail(self._closed or LiveClosed(self._end_message()))
        self._reader.feed(self._piece[:size])
        try:
            while (frame := self._reader.next()) is not None:
                self._dispatch(*frame)
        except (BadFrame, ValueError, KeyError, TypeError, struct.error) as error:
            self._fail(LiveClosed("SK-LIVE-006", f"simulation {self.path.stem!r} sent an invalid frame: {error}"))

    def _dispatch(self, kind: int, body: bytes) -> None:
        if kind == MESSAGE:
            number, type_number, time_ns, lost = MESSAGE_HEAD.unpack_from(body)
            subscription = self.subscriptions.get(number)
            if subscription is not None:
                subscription(time_ns, self._types[type_number], body[MESSAGE_HEAD.size :], lost)
            return
        words, data = read_json_frame(body)
        interfaces = detach(words)
        if interfaces:
            own_interfaces.remember_received(interfaces, f"simulation {self.path.stem!r}")
        if kind == ANSWER:
            number = int(words["id"])
            if number in self._abandoned:
                self._abandoned.discard(number)
            else:
                self._answers[number] = words, data
        elif words["tell"] == "type":
            self._types[int(words["number"])] = str(words["type"])
        elif words["tell"] == "goal" and int(words["number"]) in self.goals:
            self.goals[int(words["number"])](words, data)
        elif words["tell"] in _ENDPOINT_TELLS:
            if int(words["number"]) in self.endpoints:
                self.endpoints[int(words["number"])](words, data)
        elif words["tell"] == "hello":
            self.info = {k: v for k, v in words.items() if k != "tell"}
        elif words["tell"] == "invalid":
            self.invalid(words)
        elif words["tell"] == "bye":
            self._closed = LiveClosed(str(words.get("code", "SK-LIVE-005")), str(words["why"]))
            self._socket.close()

    def invalid(self, words: JsonObject) -> None:
        """Process the notification that a message of this client was dropped; only bridges receive it."""

    def _fail(self, error: LiveClosed) -> None:
        """Close the socket and raise the error."""
        self._closed = error
        self._socket.close()
        raise error

    def _end_message(self) -> str:
        return f"simulation {self.path.stem!r} has ended"

    def _no_answer(self) -> LiveError:
        return LiveError(
            "SK-LIVE-004", f"simulation {self.path.stem!r} does not answer (waited {self.timeout:g} s); is it stopped?"
        )

    @property
    def is_closed(self) -> bool:
        """True if the connection has ended."""
        return self._closed is not None

    @property
    def closed(self) -> LiveClosed | None:
        """Reason for the end of the connection; None before the end."""
        return self._closed

    def close(self) -> None:
        """Close the connection. A second call does nothing."""
        self._closed = self._closed or LiveClosed("the client is closed")
        self._socket.close()
