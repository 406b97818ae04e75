"""Subscribers of topics for expressions: the newest message, and the number and times of all messages."""

from __future__ import annotations

from abc import ABC, abstractmethod

from simkit.runtime import Simulation, Subscription
from simkit.testing.conditions.syntax_tree import UndecidedValue


class TopicListener(ABC):
    """Subscriber of a topic between the calls of `open` and `close`.

    Args:
        sim: Simulation.
        topic: Absolute name of the topic.
    """

    def __init__(self, sim: Simulation, topic: str) -> None:
        self.topic, self._sim = topic, sim
        self._subscription: Subscription | None = None

    @abstractmethod
    def _subscribe(self) -> Subscription:
        """Subscribe to the topic."""

    def open(self) -> None:
        """Subscribe, if there is no subscription yet."""
        if self._subscription is None:
            self._subscription = self._subscribe()

    def close(self) -> None:
        """End the subscription; received data remain."""
        if self._subscription is not None:
            self._subscription.close()


class LatestMessage(TopicListener):
    """Newest message of a topic; a lazy message is created only when it is read."""

    def _subscribe(self) -> Subscription:
        return self._sim.communication.bus.subscribe(self.topic, keep=1)

    def latest(self) -> object:
        """Return the newest message.

        Raises:
            UndecidedValue: No message was received.
        """
        message = self._subscription.latest if self._subscription is not None else None
        if message is None:
            raise UndecidedValue(f"no message received on {self.topic}")
        return message

    def restore(self, message: object) -> None:
        """Set the newest message, or None, as after the restore of a snapshot."""
        if self._subscription is not None:
            self._subscription.restore_latest(message)


class MessageCounter(TopicListener):
    """Number and times of the messages on a topic; the content of the messages is not read.

    Attributes:
        count: Number of messages since `open` or since the last reset of the simulation.
        first, last: Simulated times of the first and the newest message [ns].
    """

    count = first = last = 0

    def _subscribe(self) -> Subscription:
        return self._sim.communication.bus.tap(self.topic, lambda _: self.take(self._sim.time_ns), takes_later=True)

    def rate(self) -> float | None:
        """Return the rate from the first to the newest message [Hz]; None if no two messages have different times."""
        if self.count < 2 or self.last <= self.first:
            return None
        return (self.count - 1) * 1e9 / (self.last - self.first)

    def take(self, now: int) -> None:
        """Count a message that was published at a simulated time [ns]."""
        if now < self.last:  # the simulation was reset
            self.count = 0
        if not self.count:
            self.first = now
        self.last = now
        self.count += 1
