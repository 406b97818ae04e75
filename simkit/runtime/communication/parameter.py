"""Live parameter of a ROS node: a typed and bounded value, and its messages of `rcl_interfaces`."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Final, Generic, TypeVar

import numpy as np

from simkit.argument_checks import check_list, check_text, checked_number, shown
from simkit.errors import ParameterError
from simkit.in_process import InProcess
from simkit.msgs.topic_names import absolute_name

ParameterValue = bool | int | float | str | tuple[float, ...]
T = TypeVar("T", bound=ParameterValue)

_INTEGER_LIMIT = 2**63  # ROS has integers of 64 bits
_TYPE_NAMES = {bool: "a boolean", int: "an integer", float: "a number", str: "text", tuple: "numbers"}


class Parameter(InProcess, Generic[T]):
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
        remove: function that removes the parameter from its node; None before the declaration.
    """

    _internal_names = frozenset({"active", "checked", "is_within", "owner", "remove", "take"})

    def __init__(
        self,
        node: str,
        name: str,
        value: T,
        *,
        minimum: float | None = None,
        maximum: float | None = None,
        choices: Sequence[object] = (),
        description: str = "",
        on_change: Callable[[T], None] | None = None,
        owner: object = None,
    ) -> None:
        self.node, self.name, self.value = node, name, value
        self.minimum, self.maximum, self.choices = minimum, maximum, tuple(choices)
        self.description, self.owner = description, owner
        self.default, self.on_change = value, on_change
        self.active = True
        self.remove: Callable[[AnyParameter], None] | None = None

    def close(self) -> None:
        """Remove the parameter permanently; the services of its node end with the node's last parameter."""
        if self.remove is not None:
            self.remove(self)

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
        converted = _convert(value, self.value)
        if converted is None or not self.is_within(converted):
            raise ParameterError(f"{self.node} {self.name}: found {shown(value)}; expected {self.allowed}")
        return converted  # type: ignore[no-any-return]

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
    check_list(options.get("choices", ()), object, "choices", "values")
    bounds = {end: options.get(end) for end in ("minimum", "maximum")}
    bounds = {end: None if bound is None else checked_number(bound, end) for end, bound in bounds.items()}
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    value, *choices = (tuple(v) if isinstance(v, list) else v for v in (value, *options.get("choices", ())))
    if type(value) not in _TYPE_NAMES or (isinstance(value, tuple) and _convert(value, value) is None):
        kinds = "a boolean, an integer, a number, text or a tuple of numbers"
        raise ParameterError(f"{node} {name}: found {shown(value)}; expected {kinds}")
    parameter: AnyParameter = Parameter(absolute_name(node), name, value, **{**options, **bounds, "choices": choices})
    parameter.value = parameter.default = parameter.checked(parameter.value)
    return parameter


def _convert(value: Any, like: object) -> Any:
    """Convert a value to the type of `like`; return None if the conversion is not allowed."""
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if isinstance(like, (bool, str)):
        return value if isinstance(value, type(like)) else None
    if isinstance(like, tuple):
        if not isinstance(value, (list, tuple)) or len(value) != len(like):
            return None
        items = tuple(_convert(v, 0.0) for v in value)
        return None if None in items else items
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
VALUE_FIELDS = {
    1: "bool_value",
    2: "integer_value",
    3: "double_value",
    4: "string_value",
    6: "bool_array_value",
    7: "integer_array_value",
    8: "double_array_value",
    9: "string_array_value",
}


USE_SIM_TIME: Final = "use_sim_time"
"""Parameter of every node with parameters, as in ROS 2; always true."""


def sim_time_parameter(node: str) -> AnyParameter:
    """Return the parameter `use_sim_time` of a node."""
    described = "true: a node of a simulation uses simulated time"
    return Parameter(node, USE_SIM_TIME, value=True, choices=(True,), description=described)


def value_message(parameter: AnyParameter | None) -> dict[str, object]:
    """Return a `ParameterValue`, with type 0 for a missing parameter."""
    if parameter is None:
        return {"type": 0}
    kind = _ROS_TYPES[type(parameter.value)]
    value = parameter.value
    return {"type": kind, VALUE_FIELDS[kind]: list(value) if isinstance(value, tuple) else value}


def descriptor(parameter: AnyParameter | None) -> dict[str, object]:
    """Return the fields of a `ParameterDescriptor`; none for a missing parameter."""
    if parameter is None:
        return {}
    fields: dict[str, object] = {
        "name": parameter.name,
        "type": _ROS_TYPES[type(parameter.value)],
        "description": parameter.description,
        "additional_constraints": parameter.allowed,
    }
    if parameter.minimum is not None and parameter.maximum is not None and not isinstance(parameter.value, tuple):
        bounds = {"from_value": parameter.minimum, "to_value": parameter.maximum}
        if isinstance(parameter.value, int):
            fields["integer_range"] = [{k: int(v) for k, v in bounds.items()}]
        else:
            fields["floating_point_range"] = [bounds]
    return fields
