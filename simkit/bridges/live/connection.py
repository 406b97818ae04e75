"""Server side of one client's connection: received frames, and answers and messages queued for the client."""

from __future__ import annotations

import socket
import time
from collections import OrderedDict, deque
from typing import TYPE_CHECKING, Any, Protocol

from simkit import msgs
from simkit.bridges.live.protocol import (
    ANSWER,
    ASK,
    HEAD,
    LARGEST_IN,
    LARGEST_OUT,
    MESSAGE,
    MESSAGE_HEAD,
    TELL,
    BadFrame,
    FrameReader,
    JsonObject,
    json_frame,
)
from simkit.bridges.live.type_exchange import SentTypes
from simkit.msgs.message_types import Message
from simkit.runtime.communication.service_call import NO_ANSWER

if TYPE_CHECKING:
    from simkit.runtime.communication.action_server import GoalHandle
    from simkit.runtime.communication.publisher import Publisher

MOST_BYTES = 32 << 20  # [bytes] of queued messages for one client
MOST_DEPTH = 100_000  # queued messages for one subscription
MOST_OPEN = 1000  # open subscriptions, publishers or goals of one client
_ANSWERS_FULL = 1 << 18  # [bytes] of queued answers; above this limit no more requests of the client are read
_UNREAD_TIMEOUT = 10.0  # [s] of wall time after which a client that reads no answers is disconnected
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


class ClientSubscription:
    """Subscription of a client.

    Attributes:
        number: number that the client chose for the subscription.
        depth: highest number of queued messages.
        lost: number of dropped messages.
        waiting: keys of the subscription's messages in the client's queue, the oldest first.
    """

    __slots__ = ("depth", "lost", "number", "peer", "topic", "waiting")

    def __init__(self, peer: ClientConnection, number: int, topic: str, depth: int) -> None:
        self.peer, self.number, self.topic = peer, number, topic
        self.depth = max(1, min(depth, MOST_DEPTH))
        self.lost = 0
        self.waiting: deque[int] = deque()


class ClientConnection:
    """Connection of one client.

    Attributes:
        node: name of the client in node lists.
        subscriptions, publishers, goals: open handles of the client, by the client's numbers.
        endpoints: services, actions, command inputs and parameters of the client, by the client's numbers.
        is_held: True while reading from the client is paused, because further commands would be dropped.
        is_bridge: True for a bridge, which passes on messages of others: its invalid messages are dropped with a
            notification, and it does not receive its own messages. Any other client is disconnected for an invalid
            message.
        is_publishing: True while a message of a bridge is published.
        why: reason for disconnecting the client, after the client was informed; None for a connection in use.
    """

    def __init__(self, connection: socket.socket, number: int) -> None:
        self.socket, self.node = connection, f"/client_{number}"
        self.subscriptions: dict[int, ClientSubscription] = {}
        self.publishers: dict[int, Publisher] = {}
        self.goals: dict[int, tuple[GoalHandle, int]] = {}
        self.endpoints: dict[int, ClientEndpoint] = {}
        self.is_held = False
        self.is_bridge = self.is_publishing = False
        self.why: str | None = None
        self.is_gone = False
        self.reader = FrameReader(LARGEST_IN, (ASK, MESSAGE))
        self._answers: deque[bytes] = deque()
        self._answer_bytes = 0
        self._queue: OrderedDict[int, tuple[ClientSubscription, int, int, bytes]] = OrderedDict()
        self._queue_bytes = 0
        self._next = 0
        self._types: dict[str, int] = {}
        self._types_sent = SentTypes()
        self._rest: memoryview | None = None  # remaining bytes of a partly sent piece
        self._sent = time.monotonic()

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

    def queue_message(self, subscribed: ClientSubscription, time_ns: int, type_name: str, data: bytes) -> None:
        """Queue a message. If the queue is full, the oldest messages are dropped."""
        size = len(data)
        if size > MOST_BYTES:
            subscribed.lost += 1
            return
        type_number = self._types.get(type_name)
        if type_number is None:
            type_number = self._types[type_name] = len(self._types)
            self.send_json(TELL, {"tell": "type", "number": type_number, "type": type_name})
        waiting, key = subscribed.waiting, self._next
        if not self._queue and not self._answers and self._rest is None:
            self._sent = time.monotonic()
        self._next = key + 1
        if len(waiting) >= subscribed.depth:
            self._drop(waiting.popleft())
        waiting.append(key)
        self._queue[key] = subscribed, time_ns, type_number, data
        self._queue_bytes += size
        while self._queue_bytes > MOST_BYTES:
            oldest = next(iter(self._queue))
            self._queue[oldest][0].waiting.popleft()
            self._drop(oldest)

    def _drop(self, key: int) -> None:
        subscribed, _, _, data = self._queue.pop(key)
        subscribed.lost += 1
        self._queue_bytes -= len(data)

    def drop_waiting(self, subscribed: ClientSubscription) -> None:
        """Drop the queued messages of a subscription that is closed."""
        for key in subscribed.waiting:
            self._queue_bytes -= len(self._queue.pop(key)[3])
        subscribed.waiting.clear()

    def clear(self) -> None:
        """Close the endpoints of the client, and release its handles and queued data."""
        for endpoint in list(self.endpoints.values()):
            endpoint.close()
        for table in (self.subscriptions, self.publishers, self.goals, self.endpoints, self._queue):
            table.clear()
        self._answers.clear()
        self._rest = None

    @property
    def is_waiting(self) -> bool:
        """True while something is queued for sending."""
        return bool(self._answers or self._queue or self._rest is not None)

    def write(self) -> None:
        """Send as many bytes as the socket accepts."""
        try:
            while True:
                if self._rest is None:
                    piece = self._next_piece()
                    if not piece:
                        return
                    self._rest = memoryview(piece)
                sent = self.socket.send(self._rest)
                self._sent = time.monotonic()
                self._rest = self._rest[sent:] if sent < len(self._rest) else None
        except (BlockingIOError, InterruptedError):
            if (self._answers or self.why is not None) and time.monotonic() - self._sent > _UNREAD_TIMEOUT:
                self.is_gone = True
        except OSError:
            self.is_gone = True

    def _next_piece(self) -> bytes:
        """Return the next bytes to send: answers first, then messages in the order of their publication."""
        found: list[bytes] = []
        size = 0
        while self._answers and size < _PIECE:
            frame = self._answers.popleft()
            self._answer_bytes -= len(frame)
            found.append(frame)
            size += len(frame)
        while not self._answers and self._queue and size < _PIECE:
            _, (subscribed, time_ns, type_number, data) = self._queue.popitem(last=False)
            subscribed.waiting.popleft()
            self._queue_bytes -= len(data)
            found.append(HEAD.pack(MESSAGE_HEAD.size + len(data), MESSAGE))
            found.append(MESSAGE_HEAD.pack(subscribed.number, type_number, time_ns, subscribed.lost))
            found.append(data)
            size += len(data) + 29
        return b"".join(found)
