"""What comes on topics, as far as an expression asks for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from simkit.conditions.faults import Undecided

if TYPE_CHECKING:
    from simkit.runtime import Simulation


class Feed:
    """The newest message of a topic; it is made only when somebody looks.

    Args:
        sim: the simulation.
        topic: absolute.
    """

    def __init__(self, sim: Simulation, topic: str) -> None:
        self.topic = topic
        self._sim = sim
        self._subscription: Any = None

    def open(self) -> None:
        """Listens from now on."""
        if self._subscription is None:
            self._subscription = self._sim.bus.subscribe(self.topic, keep=1)

    def close(self) -> None:
        """Listens no more; what came last stays."""
        if self._subscription is not None:
            self._subscription.close()

    def latest(self) -> Any:
        """The newest message.

        Raises:
            Undecided: none has come.
        """
        message = self._subscription.latest if self._subscription is not None else None
        if message is None:
            raise Undecided(f"no message has come on {self.topic}")
        return message


class Tally:
    """How many messages come on a topic, and when; the messages are not looked at.

    Args:
        sim: the simulation.
        topic: absolute.

    Attributes:
        count: messages since it was opened, or since time went back.
        first, last: simulated times [ns] of the first and the newest of them.
    """

    def __init__(self, sim: Simulation, topic: str) -> None:
        self.topic = topic
        self.count = self.first = self.last = 0
        self._sim = sim
        self._tap: Any = None

    def open(self) -> None:
        """Counts from now on."""
        if self._tap is None:
            self._tap = self._sim.bus.tap(self.topic, self._take, takes_later=True)

    def close(self) -> None:
        """Counts no more."""
        if self._tap is not None:
            self._tap.close()

    def rate(self) -> float | None:
        """Messages per simulated second from the first to the newest [Hz]; None before two at different times."""
        if self.count < 2 or self.last <= self.first:
            return None
        return (self.count - 1) * 1e9 / (self.last - self.first)

    def _take(self, _: Any) -> None:
        now = self._sim.time_ns
        if now < self.last:  # the simulation was reset
            self.count = 0
        if not self.count:
            self.first = now
        self.last = now
        self.count += 1
