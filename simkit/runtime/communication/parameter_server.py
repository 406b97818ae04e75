"""Live parameters: typed and bounded values of a plugin that may change during a run, like those of a ROS 2 node.

    sim.communication.parameters["/tb3/gain_tuner"]["p_gain"].value
    sim.set_parameter("/tb3/gain_tuner", "p_gain", 12.0)

A change takes effect between two steps.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Final, Literal

from simkit import msgs
from simkit.argument_checks import check_text
from simkit.diagnostics import did_you_mean, name_hint
from simkit.errors import ParameterError
from simkit.runtime.communication.journal import journaled
from simkit.runtime.communication.log_topic import open_own_topic
from simkit.runtime.communication.parameter import (
    USE_SIM_TIME,
    VALUE_FIELDS,
    AnyParameter,
    descriptor,
    sim_time_parameter,
    value_message,
)

if TYPE_CHECKING:
    from simkit.msgs import Message
    from simkit.runtime.communication.service_server import Service, ServiceHandler, ServiceTable
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine


PARAMETER_EVENTS: Final = "/parameter_events"
EVENT: Final = "rcl_interfaces/msg/ParameterEvent"
Change = Literal["new", "changed", "deleted"]


ParameterState = tuple[tuple[AnyParameter, object], ...]
"""Parameters with their values."""


ParameterEntries = dict[str, dict[tuple[int, str], AnyParameter]]
"""Parameters by node, then by the identity of the owner and the name."""


class ParameterTable:
    """Parameters of all plugins, by node.

    Args:
        bus: topic bus, whose command queue holds the changes made during a step.
        engine: engine of the simulation.
    """

    def __init__(self, bus: TopicBus, engine: Engine) -> None:
        self._bus, self._engine = bus, engine
        self._services: dict[str, list[Service]] = {}
        # a new model may have the name, and so the node, of a removed model that a restore can bring back
        self._parameters: ParameterEntries = {}
        self._events = ParameterEvents(bus, engine)

    def add(self, parameter: AnyParameter) -> None:
        """Add a parameter to its node."""
        self._parameters.setdefault(parameter.node, {})[id(parameter.owner), parameter.name] = parameter
        parameter.remove = self.remove
        self._events.publish("new", [parameter])

    def open_services(self, services: ServiceTable, node: str) -> None:
        """Open the parameter services of a node."""
        self._services[node] = offer_parameter_services(services, self, node)

    def declare(self, services: ServiceTable, parameter: AnyParameter) -> None:
        """Add a parameter of a script or of another process, with the parameter services of a new node.

        Raises:
            ParameterError: the node has a parameter of that name.
        """
        node, name = parameter.node, parameter.name
        present = self.nodes().get(node, {})
        if name in present:
            raise ParameterError(f"{node!r} has a parameter {name!r} already")
        with self._bus.passing("declare", parameter=parameter):
            self.add(parameter)
            if not present:
                self.open_services(services, node)

    def remove(self, parameter: AnyParameter) -> None:
        """Remove a parameter; its node's services end with the last parameter."""
        of_node = self._parameters.get(parameter.node, {})
        if of_node.get((id(parameter.owner), parameter.name)) is parameter:
            with self._bus.passing("close", endpoint=parameter):
                del of_node[id(parameter.owner), parameter.name]
                self._events.publish("deleted", [parameter])
                if not any(p.active for p in of_node.values()):
                    for service in self._services.pop(parameter.node, ()):
                        service.close()

    def is_free(self, node: str, owner: object) -> bool:
        """Check whether a node has no parameters of another plugin."""
        return all(p.owner is owner or not p.active for p in self._parameters.get(node, {}).values())

    def node_with(self, owner: object) -> str:
        """Return the first node with a parameter of a plugin; empty if there is none."""
        nodes = (p.node for table in self._parameters.values() for p in table.values() if p.owner is owner)
        return next(nodes, "")

    def nodes(self) -> dict[str, dict[str, AnyParameter]]:
        """Return the parameters by node and name, sorted by node."""
        active = ((n, [p for p in self._parameters[n].values() if p.active]) for n in sorted(self._parameters))
        return {node: {p.name: p for p in of_node} for node, of_node in active if of_node}

    def served(self, node: str) -> dict[str, AnyParameter]:
        """Return the parameters of a node as its services show them: also `use_sim_time`; empty for no such node."""
        of_node = self.nodes().get(node, {})
        return of_node and {USE_SIM_TIME: sim_time_parameter(node), **of_node}

    def find(self, node: str, name: str) -> AnyParameter:
        """Return a parameter.

        Raises:
            ParameterError: no parameter has that name; the message suggests the closest name.
        """
        check_text(node, "node")
        check_text(name, "name")
        nodes = self.nodes()
        if node in nodes and name == USE_SIM_TIME:
            return self.served(node)[name]
        if node not in nodes:
            hint = name_hint(node, nodes)
            raise ParameterError(f"no node {node!r} has parameters; {hint}")
        if name not in nodes[node]:
            hint = did_you_mean(name, nodes[node]) or "it has " + ", ".join(nodes[node])
            raise ParameterError(f"{node!r} has no parameter {name!r}; {hint}")
        return nodes[node][name]

    @journaled
    def set(self, node: str, name: str, value: object) -> None:
        """Set a parameter at once; a call during a step takes effect before the next step.

        Raises:
            ParameterError: no parameter has that name, or the value is not allowed.
        """
        parameter = self.find(node, name)
        checked = parameter.checked(value)
        if self._engine.is_stepping:
            self._bus.enqueue(lambda: self._change(parameter, checked))
        else:
            self._change(parameter, checked)

    def _change(self, parameter: AnyParameter, value: object) -> None:
        parameter.take(value)
        self._events.publish("changed", [parameter])

    def set_active(self, owners: Sequence[object]) -> None:
        """Enable the parameters of these plugins; disable all others."""
        living = {id(owner) for owner in owners}
        changed: dict[bool, list[AnyParameter]] = {True: [], False: []}
        for parameter in (p for of_node in self._parameters.values() for p in of_node.values()):
            is_active = parameter.owner is None or id(parameter.owner) in living
            if is_active != parameter.active:
                parameter.active = is_active
                changed[is_active].append(parameter)
        self._events.publish("new", changed[True])
        self._events.publish("deleted", changed[False])

    def forget(self, owners: Sequence[object]) -> None:
        """Remove every parameter of these plugins permanently."""
        removed = {id(owner) for owner in owners}
        for node, of_node in list(self._parameters.items()):
            remaining = {key: p for key, p in of_node.items() if id(p.owner) not in removed}
            if remaining:
                self._parameters[node] = remaining
            else:
                del self._parameters[node]
                self._services.pop(node, None)  # closed with their plugin

    def entries(self) -> ParameterEntries:
        """Return all parameters, including those of removed models that a restore can bring back, by node."""
        return {node: dict(of_node) for node, of_node in self._parameters.items()}

    def replace_entries(self, entries: ParameterEntries) -> None:
        """Undo additions and removals since `entries`."""
        self._parameters = {node: dict(of_node) for node, of_node in entries.items()}

    def get_state(self) -> ParameterState:
        """Return every parameter with its value."""
        return tuple((p, p.value) for of_node in self._parameters.values() for p in of_node.values())

    def set_state(self, state: ParameterState) -> None:
        """Restore values from `get_state`. The plugins are not notified, because their own state is restored too.

        A parameter that a script declared later returns to its declared value.
        """
        for parameter in (p for of_node in self._parameters.values() for p in of_node.values() if p.owner is None):
            parameter.value = parameter.default
        for parameter, value in state:
            parameter.value = value


def offer_parameter_services(services: ServiceTable, parameters: ParameterTable, node: str) -> list[Service]:
    """Open the six parameter services of a node."""

    def find(name: str) -> AnyParameter | None:
        return parameters.served(node).get(name)

    def set_all(values: list[Message]) -> dict[str, object]:
        return _set_parameters(parameters, node, values)

    handlers: dict[str, ServiceHandler] = {
        "GetParameters": lambda request: {"values": [value_message(find(n)) for n in request.names]},
        "GetParameterTypes": lambda request: {"types": [value_message(find(n))["type"] for n in request.names]},
        "SetParameters": lambda request: {"results": [set_all([value]) for value in request.parameters]},
        "SetParametersAtomically": lambda request: {"result": set_all(request.parameters)},
        "ListParameters": lambda request: {"result": {"names": _list_names(parameters, node, request.prefixes)}},
        "DescribeParameters": lambda request: {"descriptors": [descriptor(find(n)) for n in request.names]},
    }
    opened = []
    for name, handler in handlers.items():
        snake = "".join(f"_{c.lower()}" if c.isupper() else c for c in name).lstrip("_")
        opened.append(services.offer(f"{node}/{snake}", f"rcl_interfaces/srv/{name}", handler))
    return opened


def _list_names(parameters: ParameterTable, node: str, prefixes: list[str]) -> list[str]:
    names = list(parameters.served(node))
    return [n for n in names if not prefixes or any(n == p or n.startswith(f"{p}.") for p in prefixes)]


def _set_parameters(parameters: ParameterTable, node: str, values: list[Message]) -> dict[str, object]:
    """Set all parameters or none."""
    try:
        checked = []
        for item in values:
            parameter = parameters.find(node, item.name)
            field = VALUE_FIELDS.get(int(item.value.type))
            checked.append((parameter.name, parameter.checked(getattr(item.value, field) if field else None)))
    except ParameterError as error:
        return {"successful": False, "reason": str(error)}
    for name, value in checked:
        parameters.set(node, name, value)
    return {"successful": True}


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
        for node, changed in by_node.items():
            rows = [{"name": parameter.name, "value": value_message(parameter)} for parameter in changed]
            stamp = msgs.time(self._engine.time_ns)
            self._publisher.publish(msgs.make(EVENT, stamp=stamp, node=node, **{f"{change}_parameters": rows}))
