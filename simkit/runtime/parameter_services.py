"""The services with which ROS 2 reads and changes the parameters of a node (`rcl_interfaces`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit.errors import ParameterError

if TYPE_CHECKING:
    from simkit.runtime.parameters import Parameter
    from simkit.runtime.simulation import Simulation

# rcl_interfaces/msg/ParameterType
_TYPES = {bool: 1, int: 2, float: 3, str: 4, tuple: 8}
_FIELDS = {
    1: "bool_value",
    2: "integer_value",
    3: "double_value",
    4: "string_value",
    6: "bool_array_value",
    7: "integer_array_value",
    8: "double_array_value",
    9: "string_array_value",
}


def offer_parameter_services(sim: Simulation, node: str) -> None:
    """Opens the six parameter services of a node."""
    services: dict[str, Callable[[Any], Any]] = {
        "GetParameters": lambda request: {"values": [_value(_find(sim, node, n)) for n in request.names]},
        "GetParameterTypes": lambda request: {"types": [_value(_find(sim, node, n))["type"] for n in request.names]},
        "SetParameters": lambda request: {"results": [_set(sim, node, [p]) for p in request.parameters]},
        "SetParametersAtomically": lambda request: {"result": _set(sim, node, request.parameters)},
        "ListParameters": lambda request: {"result": {"names": _listed(sim, node, request.prefixes)}},
        "DescribeParameters": lambda request: {"descriptors": [_described(_find(sim, node, n)) for n in request.names]},
    }
    for name, handler in services.items():
        snake = "".join(f"_{c.lower()}" if c.isupper() else c for c in name).lstrip("_")
        sim.offer(f"{node}/{snake}", f"rcl_interfaces/srv/{name}", handler)


def _find(sim: Simulation, node: str, name: str) -> Parameter[Any] | None:
    return sim.parameter_table.nodes().get(node, {}).get(name)


def _listed(sim: Simulation, node: str, prefixes: list[str]) -> list[str]:
    names = list(sim.parameter_table.nodes().get(node, {}))
    return [n for n in names if not prefixes or any(n == p or n.startswith(f"{p}.") for p in prefixes)]


def _value(parameter: Parameter[Any] | None) -> dict[str, Any]:
    """A `ParameterValue`; type 0 where there is no such parameter."""
    if parameter is None:
        return {"type": 0}
    kind = _TYPES[type(parameter.value)]
    value = parameter.value
    return {"type": kind, _FIELDS[kind]: list(value) if isinstance(value, tuple) else value}


def _set(sim: Simulation, node: str, wanted: list[Any]) -> dict[str, Any]:
    """Changes all of them or none."""
    try:
        checked = []
        for one in wanted:
            parameter = sim.parameter_table.find(node, one.name)
            field = _FIELDS.get(int(one.value.type))
            checked.append((parameter.name, parameter.checked(getattr(one.value, field) if field else None)))
    except ParameterError as error:
        return {"successful": False, "reason": str(error)}
    for name, value in checked:
        sim.parameter_table.set(node, name, value)
    return {"successful": True}


def _described(parameter: Parameter[Any] | None) -> dict[str, Any]:
    if parameter is None:
        return {}
    found: dict[str, Any] = {
        "name": parameter.name,
        "type": _TYPES[type(parameter.value)],
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
