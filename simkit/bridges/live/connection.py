"""Server side of one client's connection: received frames, and answers and messages queued for the client."""

from __future__ import annotations

import math
import socket
import time
from collections import deque
from typing import TYPE_CHECKING, Any, Protocol

from simkit import msgs
from simkit.bridges.live.fair_queue import FairQueue
from simkit.bridges.live.message_log import ClientSubscription
from simkit.bridges.live.protocol import (
    ANSWER,
    ASK,
    LARGEST_IN,
    LARGEST_OUT,
    MESSAGE,
    MESSAGE_FRAME_HEAD,
    MESSAGE_HEAD,
    TELL,
    BadFrame,
    FrameReader,
    JsonObject,
    json_frame,
)
from simkit.bridges.live.type_exchange import SentTypes
from simkit.msgs.message_types import Message
from simkit.runtime.communication.service_server import NO_ANSWER

if TYPE_CHECKING:
    from simkit.runtime.communication.action_server import GoalHandle
    from simkit.runtime.communication.publisher import Publisher

MOST_OPEN = 1000  # open subscriptions, publishers or goals of one client
_ANSWERS_FULL = 1 << 18  # [bytes] of queued answers; above this limit no more requests of the client are read
_UNREAD_TIMEOUT = 10.0  # [s] of wall time after which a client that reads no answers is disconnected
_STUCK_SECONDS = 5.0  # [s] of wall time after which a client that reads nothing is stuck
_PIECE = 1 << 16  # [bytes] read or written at once


class ClientEndpoint(Protocol):
    """Service, action, command input or parameter of a client.

    Attributes:
        opened: endpoint in the simulation.
    """

    opened: Any

    def send_due(self) -> None:
        """Send the client what the simulation has queued since the last call."""

    def close(self) -> None:
        """Close the endpoint in the simulation."""


class ClientConnection:
    """Connection of one client.

    Attributes:
        node: name of the client in node lists.
        subscriptions, publishers, goals: open handles of the client, by the client's numbers.
        endpoints: services, actions, command inputs and parameters of the client, by the client's numbers.
        nodes: names of the nodes that the client has opened, in addition to its own name.
        node_by_number: node of each handle that belongs to another node than the client's own.
        is_held: True while reading from the client is paused, because further commands would be dropped.
        is_bridge: True for a bridge, which passes on messages of others: its invalid messages are dropped with a
            notification. Any other client is disconnected for an invalid message.
        skips_own: True if the client does not receive its own messages.
        why: reason for disconnecting the client, after the client was informed; None for a connection in use.
    """

    def __init__(self, connection: socket.socket, number: int) -> None:
        self.socket, self.node = connection, f"/client_{number}"
        self.subscriptions: dict[int, ClientSubscription] = {}
        self.publishers: dict[int, Publisher] = {}
        self.goals: dict[int, tuple[GoalHandle, int]] = {}
        self.endpoints: dict[int, ClientEndpoint] = {}
        self.nodes: list[str] = []
        self.node_by_number: dict[int, str] = {}
        self.is_held = False
        self.is_bridge = self.skips_own = False
        self.why: str | None = None
        self.is_gone = False
        self.reader = FrameReader(LARGEST_IN, (ASK, MESSAGE))
        self._answers: deque[bytes] = deque()
        self._answer_bytes = 0
        self._queue = FairQueue()
        self._types: dict[str, int] = {}
        self._types_sent = SentTypes()
        self._pieces: deque[memoryview] = deque()  # bytes to send next
        self._sent = time.monotonic()

    def node_of(self, number: int) -> str:
        """Return the node of the handle with a number of the client."""
        return self.node_by_number.get(number, self.node)

    @property
    def all_nodes(self) -> list[str]:
        """Names for node lists: the nodes that the client has opened, else its own name."""
        return self.nodes or [self.node]

    # ------------------------------------------------------------------ from the client

    def read(self) -> bool:
        """Read the bytes that have arrived; return False if there are none."""
        try:
            data = self.socket.recv(_PIECE)
        except (BlockingIOError, InterruptedError):
            return False
        except OSError:
            data = b""
        if not data:
            self.is_gone = True
            return False
        self.reader.feed(data)
        return True

    @property
    def is_clogged(self) -> bool:
        """True while too many answers are queued; then no further requests are read."""
        return self._answer_bytes > _ANSWERS_FULL

    # ------------------------------------------------------------------ to the client

    def send_json(self, kind: int, content: JsonObject, data: bytes = b"") -> None:
        """Queue an answer or a notification. Neither is ever dropped."""
        try:
            frame = json_frame(kind, self._types_sent.attach(content), data)
        except (TypeError, ValueError) as error:
            frame = json_frame(kind, {**content, "ok": None, "error": f"the answer cannot be sent: {error}"})
        if len(frame) > LARGEST_OUT:
            raise BadFrame("an answer is too large to be sent")
        if not self.is_waiting:
            self._sent = time.monotonic()
        self._answers.append(frame)
        self._answer_bytes += len(frame)

    def answer_later(self, number: int, response: Message, error: str) -> None:
        """Send the answer to a request that was forwarded to another client: a message, or the text of an error."""
        if self.is_gone:
            return
        if error:
            self.send_json(ANSWER, {"id": number, "error": error, "code": NO_ANSWER})
        else:
            self.send_json(ANSWER, {"id": number, "type": msgs.type_name(response)}, msgs.serialize(response))
        self.write()

    def send_requests(self) -> None:
        """Send the requests, goals and new values of the client's endpoints."""
        for endpoint in list(self.endpoints.values()):
            endpoint.send_due()

    def activate(self, subscribed: ClientSubscription) -> None:
        """Queue a subscription that has new messages."""
        if not self.is_waiting:
            self._sent = time.monotonic()
        self._queue.activate(subscribed)

    def drop_waiting(self, subscribed: ClientSubscription) -> None:
        """Drop the queued messages of a subscription that is closed."""
        self._queue.remove(subscribed)

    def close_endpoints(self) -> None:
        """Close the endpoints of the client; its goals are aborted, and its callers receive an error."""
        for endpoint in list(self.endpoints.values()):
            endpoint.close()
        self.endpoints.clear()

    def clear(self) -> None:
        """Close the endpoints of the client, and release its handles and queued data."""
        self.close_endpoints()
        for table in (self.subscriptions, self.publishers, self.goals, self._answers, self._pieces):
            table.clear()
        self._queue.clear()

    @property
    def is_waiting(self) -> bool:
        """True while something is queued for sending."""
        return bool(self._answers or self._queue or self._pieces)

    @property
    def is_stuck(self) -> bool:
        """True while something is queued for the client and it has read nothing for some seconds of wall time."""
        return self.is_waiting and time.monotonic() - self._sent > _STUCK_SECONDS

    def write(self, until: float = math.inf) -> None:
        """Send as many bytes as the socket accepts, at least one piece, until the time `until` of `perf_counter`."""
        try:
            while self._pieces or self._fill():
                piece = self._pieces[0]
                sent = self.socket.send(piece)
                self._sent = time.monotonic()
                if sent < len(piece):
                    self._pieces[0] = piece[sent:]
                else:
                    self._pieces.popleft()
                if time.perf_counter() > until:
                    return
        except (BlockingIOError, InterruptedError):
            if (self._answers or self.why is not None) and time.monotonic() - self._sent > _UNREAD_TIMEOUT:
                self.is_gone = True
        except OSError:
            self.is_gone = True

    def _fill(self) -> bool:
        """Prepare the next bytes to send: answers first, then messages; return False if there are none."""
        frames: list[bytes] = []
        size = 0
        while self._answers and size < _PIECE:
            frame = self._answers.popleft()
            self._answer_bytes -= len(frame)
            frames.append(frame)
            size += len(frame)
        if size < _PIECE and self._fill_messages(frames, size):
            return True
        if frames:
            self._pieces.append(memoryview(b"".join(frames)))
        return bool(frames)

    def _fill_messages(self, frames: list[bytes], size: int) -> bool:
        """Add messages up to the size of a piece; return True if it queued `frames` and a large message apart."""
        types, lost, pack = self._types, dict[ClientSubscription, int](), MESSAGE_FRAME_HEAD.pack
        while size < _PIECE and (item := self._queue.next()) is not None:
            _, subscribed, (_, time_ns, type_name, data, _) = item
            type_number, length = types.get(type_name), len(data)
            if type_number is None:
                frames.append(self._type_frame(type_name))
                type_number = types[type_name]
            if subscribed not in lost:
                lost[subscribed] = subscribed.lost
            head = MESSAGE_HEAD.size + length, MESSAGE, subscribed.number, type_number, time_ns, lost[subscribed]
            frames.append(pack(*head))
            size += length + MESSAGE_FRAME_HEAD.size
            if length >= _PIECE:  # large data are not copied
                self._pieces += memoryview(b"".join(frames)), memoryview(data)
                return True
            frames.append(data)
        return False

    def _type_frame(self, type_name: str) -> bytes:
        """Return the notification that gives a type its number."""
        number = self._types[type_name] = len(self._types)
        return json_frame(TELL, self._types_sent.attach({"tell": "type", "number": number, "type": type_name}))
