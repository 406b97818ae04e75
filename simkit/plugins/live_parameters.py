"""Live parameters of plugins: the file contains the first value, and the value may change while the simulation runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from simkit.params import Params
from simkit.runtime.communication.parameter import Parameter

if TYPE_CHECKING:
    from simkit.plugins.ros_names import RosNames
    from simkit.runtime import Simulation

T = TypeVar("T", bound="bool | int | float | str | tuple[float, ...]")


class ParameterOwner(Protocol):
    """Plugin that declares a live parameter."""

    sim: Simulation


class ParameterNode(ParameterOwner, Protocol):
    """Plugin whose parameters may have values in the file and in the arguments of a ROS node.

    Attributes:
        params: parameters of the plugin in the file.
        ros: names and arguments of the node.
    """

    params: Params
    ros: RosNames


def find_first_value(plugin: ParameterNode, name: str, element: str) -> tuple[Params, str]:
    """Return the block that may contain the first value of a parameter, and the name of the value in this block.

    A value in the node's arguments replaces that of the file. There, a parameter `a.b` has this name or is in a block
    `a`, as in ROS.

    Args:
        plugin: plugin of the parameter.
        name: name of the parameter.
        element: path of the element in the file.
    """
    builder = plugin.sim.engine.structure.builder
    argument = plugin.ros.values_with(name, builder)
    if argument is not None:
        return argument, name
    block = plugin.ros.values_with(name.partition(".")[0], builder) if "." in name else None
    return descend(plugin.params, element) if block is None else descend(block, name)


def declare_at(plugin: ParameterOwner, parameter: Parameter[T], params: Params, element: str) -> Parameter[T]:
    """Read the first value of a live parameter from the file, and make the parameter available to clients.

    The first parameter of a ROS node also opens the parameter services of the node.

    Args:
        plugin: plugin that declares the parameter.
        parameter: parameter; its `value` is the default.
        params: block of the file that may contain the element.
        element: name of the element.
    """
    communication = plugin.sim.communication
    parameter.value = value = _first_value(params, element, parameter)
    is_new = parameter.node not in communication.live_parameters.nodes()
    if not parameter.is_within(value):
        params.error("SK-PARAM-002", f"found <{element}> {value!r}; expected {parameter.allowed}")
    communication.live_parameters.add(parameter)
    if is_new:
        with communication.bus.owned_by(plugin):
            communication.live_parameters.open_services(communication.services, parameter.node)
    return parameter


def descend(params: Params, path: str) -> tuple[Params, str]:
    """Return the block that contains the element of a path such as `gains.p`, and the element's name."""
    *blocks, last = path.split(".")
    for name in blocks:
        params = params.block(name)
    return params, last


def _first_value(params: Params, element: str, parameter: Parameter[Any]) -> Any:
    default, choices = parameter.value, parameter.choices
    minimum, maximum = parameter.minimum, parameter.maximum
    if isinstance(default, bool):
        return params.boolean(element, default)
    if isinstance(default, str):
        return params.choice(element, list(map(str, choices)), default) if choices else params.text(element, default)
    if isinstance(default, tuple):
        return params.vector(element, len(default), default)
    if isinstance(default, int):
        low, high = (None if bound is None else int(bound) for bound in (minimum, maximum))
        return params.integer(element, default, minimum=low, maximum=high)
    return params.number(element, default, minimum=minimum, maximum=maximum)
