"""Topics, services, actions and live parameters of a simulation, as in ROS 2."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from simkit.runtime.communication.action_server import ActionTable
from simkit.runtime.communication.parameter_server import Parameter, ParameterTable
from simkit.runtime.communication.service_server import ServiceTable

if TYPE_CHECKING:
    from simkit.runtime.communication.publisher import Publisher
    from simkit.runtime.communication.subscription import Message
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.engine.scheduler import Phase, Scheduler, Task


MessageMaker = Callable[[str], "Message"]
"""Makes the message of a topic."""


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
        self, topics: dict[str, str], rate: float, make: MessageMaker, *, is_aside: bool = True, is_listed: bool = False
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


class Communication:
    """Everything that a simulation says and hears.

    Args:
        bus: the topics.
        engine: of the simulation.

    Attributes:
        bus: the topics.
        services: the services.
        actions: the actions, and the goals that were sent.
        live_parameters: the parameters of all plugins.
        on_demand: work that is scheduled only while somebody wants it.
    """

    def __init__(self, bus: TopicBus, engine: Engine) -> None:
        self.bus, self._engine = bus, engine
        self.services = ServiceTable(bus, engine)
        self.actions = ActionTable(bus, engine)
        self.live_parameters = ParameterTable(bus, engine)
        self.on_demand = OnDemandTasks(bus, engine.reschedule)

    def set_active(self, owners: Sequence[object]) -> None:
        """Leaves only what these plugins and sensors opened (and what nobody owns) in use."""
        for table in (self.bus, self.services, self.actions, self.live_parameters):
            table.set_active(owners)

    def forget(self, owners: Sequence[object]) -> None:
        """Takes away for good what these plugins and sensors opened."""
        for table in (self.bus, self.services, self.actions, self.live_parameters):
            table.forget(owners)

    def abandon(self, owner: object, reason: str) -> None:
        """Ends every goal of a plugin that is left out."""
        self.actions.abandon(owner, reason)

    def set_parameter(self, node: str, name: str, value: object) -> None:
        """Changes a live parameter: at once, or from within a hook or a callback before the next step.

        Raises:
            ParameterError: there is none of that name, or it does not take the value.
        """
        self._engine.check_open()
        self.live_parameters.set(node, name, value)

    @property
    def parameters(self) -> dict[str, dict[str, Parameter[Any]]]:
        """Live parameters: node -> name -> parameter."""
        return self.live_parameters.nodes()
