"""How one talks to a simulation: topics, services, actions and live parameters, as in ROS 2."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from simkit.runtime.aspect import Aspect
from simkit.runtime.communication.action_server import ActionTable, GoalHandle
from simkit.runtime.communication.parameter_server import Parameter, ParameterTable
from simkit.runtime.communication.service_server import Service, ServiceHandler, ServiceTable
from simkit.runtime.communication.topic_bus import Callback, CallbackErrorPolicy, Subscription, TopicBus

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation


class Communication(Aspect):
    """The part of a simulation that others talk to.

    Attributes:
        bus: the topics.
        service_table, action_table, parameter_table: the others.
    """

    def open_interfaces(self, sim: Simulation) -> None:
        """Makes the tables, all empty."""
        self.bus = TopicBus(sim.reports, lambda: sim.time)
        self.service_table = ServiceTable(sim)
        self.action_table = ActionTable(sim)
        self.parameter_table = ParameterTable(sim)

    def set_active(self, owners: Sequence[object]) -> None:
        """Leaves only what these plugins and sensors opened (and what nobody owns) in use."""
        for table in (self.bus, self.service_table, self.action_table, self.parameter_table):
            table.set_active(owners)

    def forget(self, owners: Sequence[object]) -> None:
        """Takes away for good what these plugins and sensors opened."""
        for table in (self.bus, self.service_table, self.action_table, self.parameter_table):
            table.forget(owners)

    # ------------------------------------------------------------------ topics

    def publish(self, topic: str, message: Any) -> None:
        """Sends a message object, or a dict of its fields; inputs get it before the next step.

        Raises:
            MessageError: unknown topic, or fields that do not fit.
        """
        self._whole._check_open()
        self.bus.publish(topic, message)

    def subscribe(
        self,
        topic: str,
        callback: Callback | None = None,
        keep: int | None = None,
        on_error: CallbackErrorPolicy = "stop",
    ) -> Subscription:
        """Receives a topic, before or after its publisher exists.

        Args:
            topic: absolute, or taken as such.
            callback: called with each message.
            keep: how many messages are kept, the newest; a million where nothing is said.
            on_error: what becomes of a callback that raises: "stop" stops the run with a SubscriberError, "drop" closes
                the subscription with a warning, and the run goes on.
        """
        return self.bus.subscribe(topic, callback, keep, on_error)

    def topics(self) -> dict[str, str]:
        """Topic -> ROS type name."""
        return self.bus.topics()

    # ------------------------------------------------------------------ services

    def call(self, service: str, request: Any = None) -> Any:
        """The response of a service; what it did is done when this returns.

        Args:
            service: absolute, or taken as such.
            request: a message, a dict of its fields, or None for all zero.

        Raises:
            ServiceError: there is no such service; names the closest.
            MessageError: the request does not fit.
            PluginError: the service of a plugin raised.
        """
        self._whole._check_open()
        return self.service_table.call(service, request)

    def offer(self, service: str, type_name: str, handler: ServiceHandler) -> Service:
        """Opens a service of a type such as `std_srvs/srv/Trigger`.

        Args:
            service: absolute, or taken as such.
            type_name: its type.
            handler: given the request, gives the response: a message, a dict of its fields, or None for all zero.

        Raises:
            ServiceError: there is one of that name.
            MessageError: an unknown type.
        """
        return self.service_table.offer(service, type_name, handler)

    def services(self) -> dict[str, str]:
        """Service -> ROS type name."""
        return self.service_table.names()

    # ------------------------------------------------------------------ actions

    def send_goal(
        self,
        action: str,
        goal: Any = None,
        on_feedback: Callable[[Any], None] | None = None,
        on_done: Callable[[GoalHandle], None] | None = None,
    ) -> GoalHandle:
        """Sends a goal; the plugin has it before the next step.

        Args:
            action: absolute, or taken as such.
            goal: a message, a dict of its fields, or None for all zero.
            on_feedback: called with each feedback message.
            on_done: called with the handle once the goal has ended.

        Raises:
            ActionError: there is no such action; names the closest.
            MessageError: the goal does not fit.
        """
        self._whole._check_open()
        return self.action_table.send(action, goal, on_feedback, on_done)

    def actions(self) -> dict[str, str]:
        """Action -> ROS type name."""
        return self.action_table.names()

    # ------------------------------------------------------------------ parameters

    @property
    def parameters(self) -> dict[str, dict[str, Parameter[Any]]]:
        """Live parameters: node -> name -> parameter."""
        return self.parameter_table.nodes()

    def set_parameter(self, node: str, name: str, value: Any) -> None:
        """Changes a live parameter: at once, or from within a hook or a callback before the next step.

        Raises:
            ParameterError: there is none of that name, or it does not take the value.
        """
        self._whole._check_open()
        self.parameter_table.set(node, name, value)
