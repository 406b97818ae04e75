"""Work that is scheduled only while somebody wants it, so that it costs a run nothing otherwise."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from simkit.runtime.communication.publisher import Publisher
    from simkit.runtime.communication.subscription import Message
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.scheduler import Phase, Scheduler, Task


class OnDemandTasks:
    """Tasks of a simulation that are due only while they are wanted.

    A wish is looked at when the schedule is made, and when somebody says that it changed; so a run in which nobody
    wants anything has the schedule of one without them.

    Args:
        bus: whose readers decide.
        reschedule: called when what is wanted has changed.
    """

    def __init__(self, bus: TopicBus, reschedule: Callable[[], None]) -> None:
        self._bus, self._reschedule = bus, reschedule
        self._tasks: list[tuple[Callable[[], bool], float | None, Task, Phase]] = []
        self._wanted: list[bool] = []

    def add(self, is_wanted: Callable[[], bool], rate: float | None, task: Task, phase: Phase = "after") -> None:
        """Has `task(tick)` called at a rate while `is_wanted()`.

        Args:
            is_wanted: may depend on the state of the run and on who listens.
            rate: [Hz]; None for every step.
            task: what is to be done.
            phase: before the step or after it.
        """
        self._tasks.append((is_wanted, rate, task, phase))
        self.look()

    def broadcast(
        self,
        topics: Mapping[str, str],
        rate: float,
        make: Callable[[str], Message],
        *,
        is_aside: bool = True,
        is_listed: bool = False,
    ) -> dict[str, Publisher]:
        """Publishes on topics at a rate while somebody listens.

        Args:
            topics: topic -> its type.
            rate: [Hz].
            make: gives the message for a topic, or what makes it once somebody looks at it.
            is_aside: whether recorders and counters leave them out unless they are named.
            is_listed: whether those are listed while nobody reads them.

        Returns:
            Topic -> publisher.
        """
        bus = self._bus
        if is_aside:
            bus.aside.update(topics)
            bus.unlisted.update(() if is_listed else topics)
        publishers = {topic: bus.advertise(topic, kind) for topic, kind in topics.items()}

        def publish(_: int) -> None:
            for topic, publisher in publishers.items():
                if publisher.wanted:
                    message = make(topic)
                    if callable(message):
                        publisher.publish_later(message)
                    else:
                        publisher.publish(message)

        for topic in topics:
            bus.on_readers_change(topic, self.look)
        self.add(lambda: any(publisher.wanted for publisher in publishers.values()), rate, publish)
        return publishers

    def look(self) -> None:
        """Says that what is wanted may have changed."""
        wanted = [is_wanted() for is_wanted, _, _, _ in self._tasks]
        if wanted != self._wanted and any(wanted + self._wanted):
            self._reschedule()

    def fill(self, scheduler: Scheduler) -> None:
        """Schedules what is wanted now."""
        self._wanted = [is_wanted() for is_wanted, _, _, _ in self._tasks]
        for wanted, (_, rate, task, phase) in zip(self._wanted, self._tasks, strict=True):
            if wanted:
                scheduler.every(rate, task, phase)
