"""Topic `/parameter_events`: declared, changed and removed live parameters, as `rcl_interfaces/msg/ParameterEvent`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final, Literal

from simkit import msgs
from simkit.runtime.communication.log_topic import open_own_topic
from simkit.runtime.communication.parameter import AnyParameter, value_message

if TYPE_CHECKING:
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine

PARAMETER_EVENTS: Final = "/parameter_events"
EVENT: Final = "rcl_interfaces/msg/ParameterEvent"
Change = Literal["new", "changed", "deleted"]


class ParameterEvents:
    """Publisher of `/parameter_events`; without subscribers no message is made.

    Args:
        bus: topic bus.
        engine: engine of the simulation.
    """

    def __init__(self, bus: TopicBus, engine: Engine) -> None:
        self._engine = engine
        self._publisher = open_own_topic(bus, PARAMETER_EVENTS, EVENT)

    @property
    def is_wanted(self) -> bool:
        """True if the topic has subscribers."""
        return self._publisher.wanted

    def publish(self, change: Change, parameters: Iterable[AnyParameter]) -> None:
        """Publish a change of parameters, in one message for each node."""
        if not self.is_wanted:
            return
        by_node: dict[str, list[AnyParameter]] = {}
        for parameter in parameters:
            by_node.setdefault(parameter.node, []).append(parameter)
        for node, found in by_node.items():
            rows = [{"name": parameter.name, "value": value_message(parameter)} for parameter in found]
            stamp = msgs.time(self._engine.time_ns)
            self._publisher.publish(msgs.make(EVENT, stamp=stamp, node=node, **{f"{change}_parameters": rows}))
