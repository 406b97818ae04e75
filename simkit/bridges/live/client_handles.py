"""Handles of what a client has open: subscriptions, publishers and goals."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

from simkit import msgs
from simkit.bridges.live.protocol import JsonObject, LiveClosed, message_frame
from simkit.bridges.live.server_link import ServerLink
from simkit.msgs.message_types import Message

if TYPE_CHECKING:
    from simkit.runtime.communication.action_server import GoalStatus


def _goal_statuses() -> type[GoalStatus]:
    # the runtime loads the engine, which a client has no other use for
    from simkit.runtime.communication.action_server import GoalStatus

    return GoalStatus


class Received(NamedTuple):
    """Message as it was received.

    Attributes:
        time_ns: simulated time at which it was published [ns].
        type_name: such as `sensor_msgs/msg/Imu`.
        data: CDR.
    """

    time_ns: int
    type_name: str
    data: bytes

    @property
    def message(self) -> Message:
        """The message itself."""
        return msgs.deserialize(self.data, self.type_name)


class LiveSubscription:
    """Subscription to a topic: `for time_ns, type_name, cdr in subscription` waits for each, until the simulation ends.

    Attributes:
        topic: its absolute name.
        waiting: what has come and nobody has looked at yet.
        lost: how many messages were dropped, since more came than were looked at.
    """

    def __init__(self, link: ServerLink, number: int, topic: str, depth: int) -> None:
        self._link, self.number, self.topic = link, number, topic
        self.waiting: deque[Received] = deque()
        self._depth, self._lost_there, self._lost_here = max(1, depth), 0, 0
        self._closed = False

    @property
    def lost(self) -> int:
        return self._lost_there + self._lost_here

    def get(self, timeout: float | None = None) -> Received | None:
        """The next message; None where none comes in time [s]; None waits for as long as it takes.

        Raises:
            LiveClosed: the simulation has ended.
        """
        if not self.waiting and not self._closed:
            self._link.wait(lambda: bool(self.waiting), timeout)
        return self.waiting.popleft() if self.waiting else None

    def __iter__(self) -> Iterator[Received]:
        return self

    def __next__(self) -> Received:
        try:
            found = self.get()
        except LiveClosed:
            found = None
        if found is None:
            raise StopIteration
        return found

    def close(self) -> None:
        """Receives no more."""
        if not self._closed:
            self._closed = True
            self._link.subscriptions.pop(self.number, None)
            if not self._link.is_closed:
                self._link.request("unsubscribe", {"number": self.number})

    def take(self, time_ns: int, type_name: str, data: bytes, lost: int) -> None:
        """Take a message that arrived."""
        self._lost_there = lost
        if len(self.waiting) >= self._depth:
            self.waiting.popleft()
            self._lost_here += 1
        self.waiting.append(Received(time_ns, type_name, data))


class LivePublisher:
    """Sends messages on a topic; `client.flush()` returns once they have been taken.

    Attributes:
        topic: its absolute name.
        type_name: such as `geometry_msgs/msg/Twist`.
    """

    def __init__(self, link: ServerLink, number: int, topic: str, type_name: str) -> None:
        self._link, self.number, self.topic, self.type_name = link, number, topic, type_name

    def publish(self, message: object) -> None:
        """Sends a message, a dict of its fields, or its CDR.

        Raises:
            MessageError: it does not fit the type.
            LiveClosed: the simulation has ended.
        """
        if isinstance(message, (bytes, bytearray, memoryview)):
            data = bytes(message)
        else:
            data = msgs.serialize(
                msgs.from_dict([self.type_name], message) if isinstance(message, Mapping) else message
            )
        self._link.send(message_frame(self.number, data))

    def close(self) -> None:
        """Publishes no more."""
        if not self._link.is_closed:
            self._link.request("unadvertise", {"number": self.number})


class LiveGoal:
    """A goal that was sent to an action.

    Attributes:
        action: the name of the action.
        id: the number that the simulation gave it.
        status: how far it is.
        result: the result message, once there is one.
        feedback: the newest feedback message.
        reason: why it was rejected, or what else was said with its end.
    """

    def __init__(self, link: ServerLink, number: int, on_feedback: Callable[[Message], None] | None) -> None:
        self._link, self.number, self._on_feedback = link, number, on_feedback
        self.action, self.id = "", 0
        self.status: GoalStatus = _goal_statuses().UNKNOWN
        self.result: Message | None = None
        self.feedback: Message | None = None
        self.reason = ""

    @property
    def is_done(self) -> bool:
        """Whether it was rejected, succeeded, was cancelled or aborted."""
        return self.status.name in ("REJECTED", "SUCCEEDED", "CANCELED", "ABORTED")

    @property
    def is_accepted(self) -> bool:
        """Whether the action accepted it, though it may have ended since."""
        return self.status.name not in ("UNKNOWN", "REJECTED")

    def wait(self, timeout: float | None = None) -> bool:
        """Waits for its end; False where it does not come in time [s, wall time]."""
        return self._link.wait(lambda: self.is_done, timeout)

    def wait_accepted(self, timeout: float | None = None) -> bool:
        """Waits until it is accepted or rejected; False where that does not come in time [s, wall time]."""
        return self._link.wait(lambda: self.status.name != "UNKNOWN", timeout)

    def cancel(self) -> None:
        """Asks for it to be called off; the action may go on."""
        self._link.request("cancel", {"number": self.number})

    def take(self, words: JsonObject, data: bytes) -> None:
        """Take feedback, a status or a result."""
        message = msgs.deserialize(data, str(words["type"])) if "type" in words else None
        if "status" not in words:
            self.feedback = message
            if self._on_feedback is not None:
                self._on_feedback(message)
            return
        self.status, self.reason = _goal_statuses()(int(words["status"])), str(words.get("reason", ""))
        if message is not None:
            self.result = message
