"""Handles of the subscriptions, publishers and goals that a client has open."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Generic, NamedTuple

from simkit import msgs
from simkit.bridges.live.protocol import JsonObject, LiveClosed, LiveError, message_frame
from simkit.bridges.live.server_link import ServerLink
from simkit.errors import callback_name
from simkit.msgs.goal_status import GoalStatus
from simkit.msgs.message_arguments import checked_message
from simkit.msgs.message_types import F, M, M_co, Message, R

if TYPE_CHECKING:
    from simkit.msgs.message_classes import ActionGoal


class Received(NamedTuple, Generic[M]):
    """Message with its time and type, as it was received; the type parameter is the class of the message.

    Attributes:
        time_ns: simulated time of publication [ns].
        type_name: full name of the type, such as `sensor_msgs/msg/Imu`.
        data: message as CDR.
    """

    time_ns: int
    type_name: str
    data: bytes

    @property
    def message(self) -> M:
        """Decoded message."""
        message: M = msgs.deserialize(self.data, self.type_name)
        return message


class LiveSubscription(Generic[M]):
    """Subscription to a topic. Its callback, if it has one, is called while the client receives.

    The type parameter is the class of the messages.

    `for time_ns, type_name, cdr in subscription` waits for each message until the simulation ends.

    Attributes:
        topic: absolute name of the topic.
        waiting: messages that have arrived and were not read yet, the oldest first.
        lost: number of messages that were dropped because the queue was full.
    """

    def __init__(
        self,
        link: ServerLink,
        number: int,
        topic: str,
        depth: int,
        callback: Callable[[M], object] | None = None,
        expected: str = "",
    ) -> None:
        self._link, self.number, self.topic, self._callback, self._expected = link, number, topic, callback, expected
        self.waiting: deque[Received[M]] = deque()
        self._depth, self._lost_there, self._lost_here = max(1, depth), 0, 0
        self._closed = False

    @property
    def lost(self) -> int:
        return self._lost_there + self._lost_here

    def get(self, timeout: float | None = None) -> Received[M] | None:
        """Return the next message, or None after the timeout [s]. Without a timeout, wait for ever.

        Raises:
            LiveClosed: the simulation has ended.
        """
        if not self.waiting and not self._closed:
            self._link.wait(lambda: bool(self.waiting), timeout)
        return self.waiting.popleft() if self.waiting else None

    def __repr__(self) -> str:
        return f"<LiveSubscription {self.topic!r}, {len(self.waiting)} waiting, {self.lost} lost>"

    def __iter__(self) -> Iterator[Received[M]]:
        return self

    def __next__(self) -> Received[M]:
        try:
            message = self.get()
        except LiveClosed:
            message = None
        if message is None:
            raise StopIteration
        return message

    def close(self) -> None:
        """Stop receiving messages."""
        if not self._closed:
            self._closed = True
            self._link.subscriptions.pop(self.number, None)
            if not self._link.is_closed:
                self._link.request("unsubscribe", {"number": self.number})

    def check_type(self, type_name: str) -> None:
        """Raise LiveError if a topic with messages of this type does not fit the type that the client named."""
        if self._expected and type_name != self._expected:
            raise LiveError("SK-MSG-001", f"topic {self.topic!r} has type {type_name}, got type={self._expected}")

    def take(self, time_ns: int, type_name: str, data: bytes, lost: int) -> None:
        """Queue a message that has arrived; raise LiveError if it has another type than the client named."""
        self.check_type(type_name)
        self._lost_there = lost
        if len(self.waiting) >= self._depth:
            self.waiting.popleft()
            self._lost_here += 1
        self.waiting.append(Received(time_ns, type_name, data))
        if self._callback is not None and len(self.waiting) == 1:
            self._link.callbacks.append(self._call)

    def _call(self) -> None:
        """Call the callback with each waiting message."""
        while self.waiting and self._callback is not None:
            message = self.waiting.popleft().message
            try:
                self._callback(message)
            except LiveClosed:  # the simulation has ended, which is no error of the callback: `spin` ends
                raise
            except Exception as error:
                if self.waiting:
                    self._link.callbacks.append(self._call)
                name = callback_name(self._callback)
                raise LiveError("SK-TOPIC-002", f"subscriber {name} of {self.topic!r} raised: {error!r}") from error


class LivePublisher(Generic[M]):
    """Publisher of a topic. `client.flush()` waits until the simulation has processed the messages.

    The type parameter is the class of the messages.

    Attributes:
        topic: absolute name of the topic.
        type_name: full name of the type, such as `geometry_msgs/msg/Twist`.
    """

    def __init__(self, link: ServerLink, number: int, topic: str, type_name: str) -> None:
        self._link, self.number, self.topic, self.type_name = link, number, topic, type_name

    @property
    def subscribers(self) -> int:
        """Number of subscriptions and command inputs of the topic; several clients count as one."""
        return int(self._link.request("subscribers", {"number": self.number})[0])

    def publish(self, message: M | Mapping[str, object] | bytes | bytearray | memoryview) -> None:
        """Send a message, given as a message, a dict of its fields, or CDR.

        Raises:
            MessageError: the message does not match the type of the topic.
            LiveClosed: the simulation has ended.
        """
        if isinstance(message, (bytes, bytearray, memoryview)):
            data = bytes(message)
        else:
            data = msgs.serialize(checked_message(message, (self.type_name,), repr(self.topic)))
        self._link.send(message_frame(self.number, data))

    def __repr__(self) -> str:
        return f"<LivePublisher {self.topic!r} {self.type_name}>"

    def close(self) -> None:
        """Stop publishing."""
        if not self._link.is_closed:
            self._link.request("unadvertise", {"number": self.number})


class LiveGoal(Generic[M_co]):
    """Goal that was sent to an action.

    The type parameter is the class of the goal message, from which type checkers know those of result and feedback.

    Attributes:
        action: name of the action.
        id: number that the simulation gave to the goal.
        status: newest status of the goal.
        reason: reason for the rejection, or the message that came with the final status.
    """

    def __init__(self, link: ServerLink, number: int, on_feedback: Callable[[Message], object] | None) -> None:
        self._link, self.number, self._on_feedback = link, number, on_feedback
        self.action, self.id = "", 0
        self.status = GoalStatus.UNKNOWN
        self._result: Message = None
        self._feedback: Message = None
        self.reason = ""

    @property
    def result(self: LiveGoal[ActionGoal[M, R, F]]) -> R | Any:  # `Any` stands for None, as in `Subscription.latest`
        """Result message; None before the goal has one."""
        return self._result

    @property
    def feedback(self: LiveGoal[ActionGoal[M, R, F]]) -> F | Any:  # as `result`
        """Newest feedback message; None before the first."""
        return self._feedback

    @property
    def is_done(self) -> bool:
        """True if the goal was rejected, succeeded, was cancelled or aborted."""
        return self.status.is_final

    @property
    def is_accepted(self) -> bool:
        """True if the action accepted the goal; stays True after the end of the goal."""
        return self.status not in (GoalStatus.UNKNOWN, GoalStatus.REJECTED)

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for the end of the goal; return False after the timeout [s, wall time]."""
        return self._link.wait(lambda: self.is_done, timeout)

    def wait_accepted(self, timeout: float | None = None) -> bool:
        """Wait until the goal is accepted or rejected; return False after the timeout [s, wall time]."""
        return self._link.wait(lambda: self.status is not GoalStatus.UNKNOWN, timeout)

    def cancel(self) -> None:
        """Request the cancellation of the goal. The action may ignore the request."""
        self._link.request("cancel", {"number": self.number})

    def __repr__(self) -> str:
        return f"<LiveGoal {self.id} of {self.action!r}: {self.status.name}>"

    def take(self, update: JsonObject, data: bytes) -> None:
        """Process feedback, a status or a result from the simulation."""
        message = msgs.deserialize(data, str(update["type"])) if "type" in update else None
        if "status" not in update:
            self._feedback = message
            if self._on_feedback is not None:
                self._link.callbacks.append(partial(self._on_feedback, message))
            return
        self.status, self.reason = GoalStatus(int(update["status"])), str(update.get("reason", ""))
        if message is not None:
            self._result = message
