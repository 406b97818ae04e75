"""Topics, services, actions and live parameters of a simulation, as in ROS 2."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from simkit.runtime.communication.action_server import ActionTable
from simkit.runtime.communication.on_demand_tasks import OnDemandTasks
from simkit.runtime.communication.parameter_server import Parameter, ParameterTable
from simkit.runtime.communication.service_server import ServiceTable

if TYPE_CHECKING:
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine


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
