"""Live parameters of a controller, at its own node: `<namespace>/<controller>`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from simkit.params import Params
from simkit.runtime.parameter_services import offer_parameter_services
from simkit.runtime.parameters import Parameter

if TYPE_CHECKING:
    from simkit.control.controller import Controller

T = TypeVar("T", bound="bool | int | float | str | tuple[float, ...]")


def declare(
    controller: Controller,
    name: str,
    default: T,
    *,
    minimum: float | None,
    maximum: float | None,
    choices: Sequence[T],
    description: str,
    on_change: Callable[[T], None] | None,
) -> Parameter[T]:
    """Reads the first value from the YAML, adds the parameter to the controller's node, opens the node's services."""
    plugin, sim = controller.plugin, controller.plugin.sim
    if on_change is not None:
        on_change = sim.faults.guard(plugin, f"its callback for parameter {name!r}", on_change)
    own = f"{plugin.ros.namespace}/{controller.name}"
    top = plugin.scoped.partition("::")[0]
    node = sim.parameter_table.node_of(plugin, own, f"/{top}/{controller.name}")
    value: Any = _first_value(controller.params, name, default, minimum, maximum, choices)
    is_new = node not in sim.parameter_table.nodes()
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
    sim.parameter_table.add(parameter)
    if is_new:
        with sim.bus.owned_by(plugin):
            offer_parameter_services(sim, node)
    return parameter


def _first_value(
    params: Params, name: str, default: Any, minimum: float | None, maximum: float | None, choices: Sequence[Any]
) -> Any:
    *blocks, last = name.split(".")
    for block in blocks:
        params = params.block(block)
    if isinstance(default, bool):
        return params.boolean(last, default)
    if isinstance(default, str):
        return params.choice(last, list(choices), default) if choices else params.text(last, default)
    if isinstance(default, tuple):
        return params.vector(last, len(default), default)
    if isinstance(default, int):
        low, high = (None if bound is None else int(bound) for bound in (minimum, maximum))
        return params.integer(last, default, minimum=low, maximum=high)
    return params.number(last, default, minimum=minimum, maximum=maximum)
