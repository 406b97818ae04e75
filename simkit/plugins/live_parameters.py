"""Declare parameters of a plugin that can be changed while it runs; the first value comes from the file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from simkit.params import Params
from simkit.runtime.communication.parameter_server import Parameter, offer_parameter_services

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin

T = TypeVar("T", bound="bool | int | float | str | tuple[float, ...]")


def declare(
    plugin: Plugin,
    name: str,
    default: T,
    *,
    minimum: float | None,
    maximum: float | None,
    choices: Sequence[T],
    description: str,
    element: str,
    on_change: Callable[[T], None] | None,
) -> Parameter[T]:
    """Reads the first value, adds the parameter to the plugin's node, and opens the node's services."""
    own = f"{plugin.ros.namespace}/{plugin.name}"
    otherwise = "/" + "/".join(filter(None, (*plugin.scoped.split("::"), plugin.name)))
    # a model has several of one class under one name: then the plugin itself says what tells them apart
    otherwise = getattr(plugin, "node", otherwise)
    node = plugin.sim.parameter_table.node_of(plugin, otherwise if "::" in plugin.name else own, otherwise)
    return declare_at(
        plugin,
        node,
        name,
        default,
        minimum=minimum,
        maximum=maximum,
        choices=choices,
        description=description,
        params=plugin.params,
        element=element,
        on_change=on_change,
    )


def declare_at(
    plugin: Plugin,
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
    """The same at any node, with the first value from an element in `params`."""
    table = plugin.sim.parameter_table
    if on_change is not None:
        on_change = plugin.sim.faults.guard(plugin, f"its callback for parameter {name!r}", on_change)
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
        with plugin.sim.bus.owned_by(plugin):
            offer_parameter_services(plugin.sim, node)
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
