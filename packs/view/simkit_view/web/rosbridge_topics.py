"""Subscriptions and publishers of clients of rosbridge."""

from __future__ import annotations

import asyncio
import json
import time
from collections import deque
from collections.abc import Callable
from typing import Final, NamedTuple, Protocol

from simkit import msgs
from simkit.bridges.live.protocol import JsonObject, LiveError
from simkit.bridges.live.request_fields import read_field
from simkit_view.web.cdr_values import read_values
from simkit_view.web.json_messages import message_from_json
from simkit_view.web.web_server import WebLink, WebServer, binary_frame, text_frame

_DEPTH: Final = 100  # queued messages of a topic in the simulation, unless the client requests more
_MOST_SHARED: Final = 16 << 20  # [bytes] of frames and messages for several clients
MOST_WAITING: Final = 1000
"""Messages that wait: for a topic that the simulation has not opened yet, or for a client."""


class TopicClient(Protocol):
    """Client with subscriptions and publishers.

    Attributes:
        link: connection to the simulation.
        publishers: publishers by topic.
        server: server with the other clients.
    """

    link: WebLink
    publishers: dict[str, TopicPublisher]
    server: WebServer

    @property
    def frames(self) -> SharedFrames:
        """Frames of messages for all clients."""
        ...

    def send(self, frame: bytes) -> None:
        """Queue a frame for the client."""

    def report_error(self, text: str, identifier: object = None) -> None:
        """Send a status with an error."""

    def guarded(self, words: JsonObject, process: Callable[[JsonObject], None]) -> None:
        """Process a message, and answer errors of its content with a status."""

    def drop_subscription(self, topic: str) -> None:
        """Forget the subscription to a topic."""


class SubscriptionOptions(NamedTuple):
    """Options of a subscription: time between two messages [s], queue length and compression."""

    period: float
    length: int
    compression: str


class TopicSubscription:
    """Subscription of a client to a topic, for all of the client's ids.

    Attributes:
        number: number in the connection to the simulation.
        options: options by id.
    """

    def __init__(self, client: TopicClient, topic: str, depth: int) -> None:
        self._client, self._topic = client, topic
        self.options: dict[object, SubscriptionOptions] = {}
        self._waiting: deque[bytes] = deque()  # frames
        self._next = 0.0
        self.number = client.link.subscribe(topic, self._take, self._fail, max(depth, _DEPTH))

    def _fail(self, error: LiveError) -> None:
        self._client.drop_subscription(self._topic)
        self._client.report_error(f"{self._topic}: {error}", next(iter(self.options), None))

    def _take(self, time_ns: int, type_name: str, data: bytes, lost: int) -> None:
        if not self.options:
            return
        options = self.options.values()
        period, length = min(option.period for option in options), max(option.length for option in options)
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
        period = min((option.period for option in self.options.values()), default=0.0)
        if self._waiting and self.options:
            self._next = time.monotonic() + period
            self._client.send(self._waiting.popleft())
            if self._waiting:
                asyncio.get_running_loop().call_later(period, self._send_next)

    def _encoded(self, time_ns: int, type_name: str, data: bytes) -> bytes:
        """Return the frame of a message."""
        key = next(reversed(self.options.values())).compression, self._topic, type_name, time_ns, data
        return self._client.frames.find(key) if self._client.server.has_many_clients else _encode(*key)


_Key = tuple[str, str, str, int, bytes]  # arguments of `_encode`


class SharedFrames:
    """Frames of the newest messages, so that a message is encoded once for all clients that want the same form."""

    def __init__(self) -> None:
        self._frames: dict[_Key, bytes] = {}
        self._size = 0

    def find(self, key: _Key) -> bytes:
        """Return the frame of a message, which is encoded unless another client has had it."""
        frame = self._frames.get(key)
        if frame is None:
            frame = self._frames[key] = _encode(*key)
            self._size += len(frame) + len(key[-1])
            while self._size > _MOST_SHARED and len(self._frames) > 1:
                oldest = next(iter(self._frames))
                self._size -= len(self._frames.pop(oldest)) + len(oldest[-1])
        return frame


def _encode(compression: str, topic: str, type_name: str, time_ns: int, data: bytes) -> bytes:
    """Return the frame of a message in the form that a client requests."""
    envelope: JsonObject = {"op": "publish", "topic": topic}
    if compression == "none":
        return text_frame(json.dumps({**envelope, "msg": read_values(data, type_name)}))
    import cbor2

    if compression == "cbor-raw":
        seconds, nanoseconds = divmod(time_ns, 10**9)
        values: JsonObject = {"secs": seconds, "nsecs": nanoseconds, "bytes": data}
    else:
        values = read_values(data, type_name, is_binary=True)
    return binary_frame(cbor2.dumps({**envelope, "msg": values}))


class TopicPublisher:
    """Topic that a client publishes. Messages wait until the simulation has opened the topic."""

    def __init__(self, client: TopicClient, topic: str, words: JsonObject) -> None:
        self._client, self._topic = client, topic
        self.number = client.link.next_number()
        self._type: str | None = None
        self._waiting: deque[JsonObject] = deque(maxlen=MOST_WAITING)
        args = {"number": self.number, "topic": topic, "type": read_field(words, "type", str, "") or None}
        latched = words.get("latch") is True
        client.link.ask("advertise", {**args, "latched": latched}, then=self._open, failed=self._fail)

    def _open(self, answer: JsonObject, _: bytes) -> None:
        self._type = answer["type"]
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
            message = message_from_json(self._type, read_field(words, "msg", dict, {}))
            self._client.link.publish(self.number, msgs.serialize(message))
