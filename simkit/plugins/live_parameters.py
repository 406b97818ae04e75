"""Declare parameters of a plugin that can be changed while it runs; the first value comes from the file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from simkit.params import Params
from simkit.runtime.communication.parameter_server import Parameter, offer_parameter_services

if TYPE_CHECKING:
    from simkit.runtime import Simulation

T = TypeVar("T", bound="bool | int | float | str | tuple[float, ...]")


class ParameterOwner(Protocol):
    """A plugin, as a live parameter needs it."""

    sim: Simulation


def declare_at(
    plugin: ParameterOwner,
    node: str,
    name: str,
    default: T,
    *,
    minimum: float | None,
    maximum: float | None,
    choices: Sequence[T],
    description: str,
    params: Params,
    element: str,
    on_change: Callable[[T], None] | None,
) -> Parameter[T]:
    """Read the first value from an element in `params`, add the parameter to a node, and open the node's services."""
    table = plugin.sim.communication.live_parameters
    if on_change is not None:
        on_change = plugin.sim.engine.faults.guard(plugin, f"its callback for parameter {name!r}", on_change)
    value: Any = _first_value(params, element, default, minimum, maximum, choices)
    is_new = node not in table.nodes()
    parameter = Parameter(
        node,
        name,
        value,
        minimum=minimum,
        maximum=maximum,
        choices=choices,
        description=description,
        on_change=on_change,
        owner=plugin,
    )
    if not parameter.is_within(value):
        params.error("SK-PARAM-002", f"found <{element}> {value!r}, allowed is {parameter.allowed}")
    table.add(parameter)
    if is_new:
        with plugin.sim.communication.bus.owned_by(plugin):
            offer_parameter_services(plugin.sim.communication.services, plugin.sim.communication.live_parameters, node)
    return parameter


def _first_value(
    params: Params, element: str, default: Any, minimum: float | None, maximum: float | None, choices: Sequence[Any]
) -> Any:
    if isinstance(default, bool):
        return params.boolean(element, default)
    if isinstance(default, str):
        return params.choice(element, list(choices), default) if choices else params.text(element, default)
    if isinstance(default, tuple):
        return params.vector(element, len(default), default)
    if isinstance(default, int):
        low, high = (None if bound is None else int(bound) for bound in (minimum, maximum))
        return params.integer(element, default, minimum=low, maximum=high)
    return params.number(element, default, minimum=minimum, maximum=maximum)
