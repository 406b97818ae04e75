"""Live parameters: typed and bounded values of a plugin that may change during a run, like those of a ROS 2 node.

    sim.communication.parameters["/tb3/gain_tuner"]["p_gain"].value
    sim.set_parameter("/tb3/gain_tuner", "p_gain", 12.0)

A change takes effect between two steps.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np

from simkit.argument_checks import check_text, checked_number, shown
from simkit.diagnostics import did_you_mean, name_hint
from simkit.errors import ParameterError
from simkit.msgs.topic_names import absolute_name
from simkit.runtime.communication.journal import journaled

if TYPE_CHECKING:
    from simkit.runtime.communication.service_call import Service, ServiceHandler
    from simkit.runtime.communication.service_server import ServiceTable
    from simkit.runtime.communication.subscription import Message
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine


ParameterValue = bool | int | float | str | tuple[float, ...]
T = TypeVar("T", bound=ParameterValue)

_INTEGER_LIMIT = 2**63  # ROS has integers of 64 bits
_TYPE_NAMES = {bool: "a boolean", int: "an integer", float: "a number", str: "text", tuple: "numbers"}


class Parameter(Generic[T]):
    """Value that may change while the simulation runs.

    Attributes:
        node: node of the parameter, such as `/tb3/diff_drive`.
        name: name of the parameter.
        value: present value.
        default: value at the declaration.
        minimum: lower bound of a number; None without one.
        maximum: upper bound of a number; None without one.
        choices: allowed values; empty if not limited to a list.
        description: meaning, with its unit.
        on_change: function that receives each new value; None without one.
        owner: plugin of the parameter.
        active: True if the plugin is part of the simulation; False if only a restore can bring the plugin back.
    """

    def __init__(
        self,
        node: str,
        name: str,
        value: T,
        *,
        minimum: float | None = None,
        maximum: float | None = None,
        choices: Sequence[T] = (),
        description: str = "",
        on_change: Callable[[T], None] | None = None,
        owner: object = None,
    ) -> None:
        self.node, self.name, self.value = node, name, value
        self.minimum, self.maximum, self.choices = minimum, maximum, tuple(choices)
        self.description, self.owner = description, owner
        self.default, self.on_change = value, on_change
        self.active = True

    @property
    def allowed(self) -> str:
        """Text of the allowed values."""
        if self.choices:
            return "one of " + ", ".join(map(repr, self.choices))
        words = _TYPE_NAMES[type(self.value)]
        if isinstance(self.value, tuple):
            words = f"{len(self.value)} {words}"
        if self.minimum is not None and self.maximum is not None:
            return f"{words} from {self.minimum:g} to {self.maximum:g}"
        if self.minimum is not None:
            return f"{words} of at least {self.minimum:g}"
        return f"{words} of at most {self.maximum:g}" if self.maximum is not None else words

    def checked(self, value: object) -> T:
        """Check a value, convert it to the type of the parameter, and return it.

        Raises:
            ParameterError: the value has another type or is out of bounds; the message lists the allowed values.
        """
        found = _convert(value, self.value)
        if found is None or not self.is_within(found):
            raise ParameterError(f"{self.node} {self.name}: found {value!r}; expected {self.allowed}")
        return found  # type: ignore[no-any-return]

    def take(self, value: T) -> None:
        """Store a checked value and notify the plugin."""
        self.value = value
        if self.on_change is not None:
            self.on_change(value)

    def is_within(self, value: object) -> bool:
        """Check whether a value of the right type is allowed."""
        if self.choices and value not in self.choices:
            return False
        if isinstance(value, (bool, str)):
            return True
        low = -math.inf if self.minimum is None else self.minimum
        high = math.inf if self.maximum is None else self.maximum
        return all(math.isfinite(v) and low <= v <= high for v in (value if isinstance(value, tuple) else (value,)))

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name!r} of {self.node!r}: {self.value!r}>"

    def __deepcopy__(self, memo: dict[int, object]) -> Parameter[T]:
        return self


AnyParameter = Parameter[Any]


def checked_parameter(node: str, name: str, value: object, **options: Any) -> AnyParameter:
    """Return a parameter of a script or of another process.

    Args:
        node: node of the parameter.
        name: name of the parameter.
        value: first value; a list of numbers is a tuple.
        options: other arguments of `Parameter`.

    Raises:
        ParameterError: a parameter cannot have this value, or not within these bounds.
    """
    check_text(node, "node")
    check_text(name, "name")
    bounds = {end: options.get(end) for end in ("minimum", "maximum")}
    bounds = {end: None if found is None else checked_number(found, end) for end, found in bounds.items()}
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    value, *choices = (tuple(v) if isinstance(v, list) else v for v in (value, *options.get("choices", ())))
    if type(value) not in _TYPE_NAMES or (isinstance(value, tuple) and _convert(value, value) is None):
        kinds = "a boolean, an integer, a number, text or a tuple of numbers"
        raise ParameterError(f"{node} {name}: found {shown(value)}; expected {kinds}")
    parameter: AnyParameter = Parameter(absolute_name(node), name, value, **{**options, **bounds, "choices": choices})
    parameter.value = parameter.default = parameter.checked(parameter.value)
    return parameter


ParameterState = tuple[tuple[AnyParameter, Any], ...]
"""Parameters with their values."""


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
        self._parameters: dict[str, dict[tuple[int, str], AnyParameter]] = {}

    def add(self, parameter: AnyParameter) -> None:
        """Add a parameter to its node."""
        self._parameters.setdefault(parameter.node, {})[id(parameter.owner), parameter.name] = parameter

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
                self._services[node] = offer_parameter_services(services, self, node)

    def remove(self, parameter: AnyParameter) -> None:
        """Remove a parameter that `declare` added; its node's services end with the last parameter."""
        found = self._parameters.get(parameter.node, {})
        if found.get((id(parameter.owner), parameter.name)) is parameter:
            with self._bus.passing("close", endpoint=parameter):
                del found[id(parameter.owner), parameter.name]
                if not any(p.active for p in found.values()):
                    for service in self._services.pop(parameter.node, ()):
                        service.close()

    def node_of(self, owner: object, wanted: str, otherwise: str) -> str:
        """Return a name for a plugin's node: the first free name of `wanted`, `otherwise`, `otherwise_2` and so on."""
        names = itertools.chain((wanted, otherwise), (f"{otherwise}_{i}" for i in itertools.count(2)))
        return next(name for name in names if self._is_free(name, owner))

    def _is_free(self, node: str, owner: object) -> bool:
        return all(p.owner is owner or not p.active for p in self._parameters.get(node, {}).values())

    def node_with(self, owner: object) -> str:
        """Return the first node with a parameter of a plugin; empty if there is none."""
        found = (p.node for table in self._parameters.values() for p in table.values() if p.owner is owner)
        return next(found, "")

    def nodes(self) -> dict[str, dict[str, AnyParameter]]:
        """Return the parameters by node and name, sorted by node."""
        active = ((n, [p for p in self._parameters[n].values() if p.active]) for n in sorted(self._parameters))
        return {node: {p.name: p for p in found} for node, found in active if found}

    def find(self, node: str, name: str) -> AnyParameter:
        """Return a parameter.

        Raises:
            ParameterError: no parameter has that name; the message suggests the closest name.
        """
        check_text(node, "node")
        check_text(name, "name")
        nodes = self.nodes()
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
            self._bus.enqueue(lambda: parameter.take(checked))
        else:
            parameter.take(checked)

    def set_active(self, owners: Sequence[object]) -> None:
        """Enable the parameters of these plugins; disable all others."""
        living = {id(owner) for owner in owners}
        for parameter in (p for found in self._parameters.values() for p in found.values()):
            parameter.active = parameter.owner is None or id(parameter.owner) in living

    def forget(self, owners: Sequence[object]) -> None:
        """Remove every parameter of these plugins permanently."""
        removed = {id(owner) for owner in owners}
        for node, found in list(self._parameters.items()):
            kept = {key: p for key, p in found.items() if id(p.owner) not in removed}
            if kept:
                self._parameters[node] = kept
            else:
                del self._parameters[node]

    def get_state(self) -> ParameterState:
        """Return every parameter with its value."""
        return tuple((p, p.value) for found in self._parameters.values() for p in found.values())

    def set_state(self, state: ParameterState) -> None:
        """Restore values from `get_state`. The plugins are not notified, because their own state is restored too.

        A parameter that a script declared later returns to its declared value.
        """
        for parameter in (p for found in self._parameters.values() for p in found.values() if p.owner is None):
            parameter.value = parameter.default
        for parameter, value in state:
            parameter.value = value


def _convert(value: Any, like: object) -> Any:
    """Convert a value to the type of `like`; return None if the conversion is not allowed."""
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if isinstance(like, (bool, str)):
        return value if isinstance(value, type(like)) else None
    if isinstance(like, tuple):
        if not isinstance(value, (list, tuple)) or len(value) != len(like):
            return None
        found = tuple(_convert(v, 0.0) for v in value)
        return None if None in found else found
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    if isinstance(like, int):
        is_whole = isinstance(value, int) or value.is_integer()
        return int(value) if is_whole and abs(value) < _INTEGER_LIMIT else None
    try:
        return float(value)
    except OverflowError:
        return None


# rcl_interfaces/msg/ParameterType
_ROS_TYPES = {bool: 1, int: 2, float: 3, str: 4, tuple: 8}
_VALUE_FIELDS = {
    1: "bool_value",
    2: "integer_value",
    3: "double_value",
    4: "string_value",
    6: "bool_array_value",
    7: "integer_array_value",
    8: "double_array_value",
    9: "string_array_value",
}


def offer_parameter_services(services: ServiceTable, parameters: ParameterTable, node: str) -> list[Service]:
    """Open the six parameter services of a node."""

    def find(name: str) -> AnyParameter | None:
        return parameters.nodes().get(node, {}).get(name)

    def set_all(values: list[Message]) -> dict[str, object]:
        return _set_parameters(parameters, node, values)

    handlers: dict[str, ServiceHandler] = {
        "GetParameters": lambda request: {"values": [_value_message(find(n)) for n in request.names]},
        "GetParameterTypes": lambda request: {"types": [_value_message(find(n))["type"] for n in request.names]},
        "SetParameters": lambda request: {"results": [set_all([value]) for value in request.parameters]},
        "SetParametersAtomically": lambda request: {"result": set_all(request.parameters)},
        "ListParameters": lambda request: {"result": {"names": _list_names(parameters, node, request.prefixes)}},
        "DescribeParameters": lambda request: {"descriptors": [_descriptor(find(n)) for n in request.names]},
    }
    opened = []
    for name, handler in handlers.items():
        snake = "".join(f"_{c.lower()}" if c.isupper() else c for c in name).lstrip("_")
        opened.append(services.offer(f"{node}/{snake}", f"rcl_interfaces/srv/{name}", handler))
    return opened


def _list_names(parameters: ParameterTable, node: str, prefixes: list[str]) -> list[str]:
    names = list(parameters.nodes().get(node, {}))
    return [n for n in names if not prefixes or any(n == p or n.startswith(f"{p}.") for p in prefixes)]


def _value_message(parameter: AnyParameter | None) -> dict[str, object]:
    """Return a `ParameterValue`, with type 0 for a missing parameter."""
    if parameter is None:
        return {"type": 0}
    kind = _ROS_TYPES[type(parameter.value)]
    value = parameter.value
    return {"type": kind, _VALUE_FIELDS[kind]: list(value) if isinstance(value, tuple) else value}


def _set_parameters(parameters: ParameterTable, node: str, values: list[Message]) -> dict[str, object]:
    """Set all parameters or none."""
    try:
        checked = []
        for item in values:
            parameter = parameters.find(node, item.name)
            field = _VALUE_FIELDS.get(int(item.value.type))
            checked.append((parameter.name, parameter.checked(getattr(item.value, field) if field else None)))
    except ParameterError as error:
        return {"successful": False, "reason": str(error)}
    for name, value in checked:
        parameters.set(node, name, value)
    return {"successful": True}


def _descriptor(parameter: AnyParameter | None) -> dict[str, object]:
    if parameter is None:
        return {}
    found: dict[str, object] = {
        "name": parameter.name,
        "type": _ROS_TYPES[type(parameter.value)],
        "description": parameter.description,
        "additional_constraints": parameter.allowed,
    }
    if parameter.minimum is not None and parameter.maximum is not None and not isinstance(parameter.value, tuple):
        bounds = {"from_value": parameter.minimum, "to_value": parameter.maximum}
        if isinstance(parameter.value, int):
            found["integer_range"] = [{k: int(v) for k, v in bounds.items()}]
        else:
            found["floating_point_range"] = [bounds]
    return found
