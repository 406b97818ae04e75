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
from simkit_view.web.json_messages import message_from_json, message_to_json
from simkit_view.web.web_server import WebLink

_DEPTH: Final = 100  # queued messages of a topic in the simulation, unless the client requests more
MOST_WAITING: Final = 1000
"""Messages that wait: for a topic that the simulation has not opened yet, or for a client."""


class TopicClient(Protocol):
    """Client with subscriptions and publishers.

    Attributes:
        link: connection to the simulation.
        publishers: publishers by topic.
    """

    link: WebLink
    publishers: dict[str, TopicPublisher]

    def send(self, data: str | bytes) -> None:
        """Queue a message for the client."""

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

    def _encoded(self, time_ns: int, type_name: str, data: bytes) -> str | bytes:
        compression = next(reversed(self.options.values())).compression
        envelope: JsonObject = {"op": "publish", "topic": self._topic}
        if compression == "none":
            return json.dumps({**envelope, "msg": message_to_json(msgs.deserialize(data, type_name))})
        import cbor2

        if compression == "cbor-raw":
            seconds, nanoseconds = divmod(time_ns, 10**9)
            return cbor2.dumps({**envelope, "msg": {"secs": seconds, "nsecs": nanoseconds, "bytes": data}})
        return cbor2.dumps({**envelope, "msg": message_to_json(msgs.deserialize(data, type_name), is_binary=True)})


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
