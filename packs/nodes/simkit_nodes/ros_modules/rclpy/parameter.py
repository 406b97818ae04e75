"""Parameters: names, types and values."""

from __future__ import annotations

import array
from collections.abc import Mapping, Sequence
from enum import Enum
from typing import Any, Final

import yaml

from simkit.input_file import read_input_text
from simkit_nodes.interfaces import ROS2, interface_module

__all__ = [
    "PARAMETER_SEPARATOR_STRING",
    "Parameter",
    "ParameterMsg",
    "ParameterType",
    "ParameterValue",
    "get_parameter_value",
    "parameter_dict_from_yaml_file",
    "parameter_value_to_python",
]

_messages: Any = interface_module("rcl_interfaces.msg", ROS2)
ParameterMsg: Any = _messages.Parameter
ParameterType: Any = _messages.ParameterType
ParameterValue: Any = _messages.ParameterValue

PARAMETER_SEPARATOR_STRING: Final = "."

_LISTS: Final = (list, tuple, array.array)


class Parameter:
    """Parameter of a node.

    Args:
        name: name of the parameter.
        type_: type; None for the type of the value.
        value: value of that type.

    Raises:
        TypeError: `type_` is not a `Parameter.Type`, or no type has such values.
        ValueError: the value has another type.
    """

    class Type(Enum):
        """Type of a parameter, with the numbers of `rcl_interfaces/msg/ParameterType`."""

        NOT_SET = 0
        BOOL = 1
        INTEGER = 2
        DOUBLE = 3
        STRING = 4
        BYTE_ARRAY = 5
        BOOL_ARRAY = 6
        INTEGER_ARRAY = 7
        DOUBLE_ARRAY = 8
        STRING_ARRAY = 9

        @classmethod
        def from_parameter_value(cls, parameter_value: object) -> Parameter.Type:
            """Return the type of a value.

            Raises:
                TypeError: no type has such values.
            """
            if parameter_value is None:
                return cls.NOT_SET
            for name, scalar in _SCALARS.items():
                if isinstance(parameter_value, scalar):
                    return cls[name]
            if not isinstance(parameter_value, _LISTS):
                raise TypeError(f"The given value is not one of the allowed types '{parameter_value}'.")
            for name, item in _ITEMS.items():  # an empty list is one of bytes, as in rclpy
                if all(isinstance(value, item) for value in parameter_value):
                    return cls[name]
            raise TypeError(f"The given value is not a list of one of the allowed types '{parameter_value}'.")

        def check(self, parameter_value: object) -> bool:
            """Check whether a value has this type; a bool is an integer, as in Python."""
            if self is Parameter.Type.NOT_SET:
                return parameter_value is None
            if self.name in _SCALARS:
                return isinstance(parameter_value, _SCALARS[self.name])
            is_numeric = self in (Parameter.Type.INTEGER_ARRAY, Parameter.Type.DOUBLE_ARRAY)
            if not isinstance(parameter_value, _LISTS if is_numeric else (list, tuple)):
                return False
            if self is Parameter.Type.BYTE_ARRAY and any(len(v) != 1 for v in parameter_value if isinstance(v, bytes)):
                return False
            return all(isinstance(value, _ITEMS[self.name]) for value in parameter_value)

    @classmethod
    def from_parameter_msg(cls, param_msg: Any) -> Parameter:
        """Return the parameter of a message `rcl_interfaces/msg/Parameter`."""
        type_ = Parameter.Type(value=param_msg.value.type)
        value = None if type_ is Parameter.Type.NOT_SET else getattr(param_msg.value, f"{type_.name.lower()}_value")
        return cls(param_msg.name, type_, value)

    def __init__(self, name: str, type_: Parameter.Type | None = None, value: Any = None) -> None:
        if type_ is None:
            type_ = Parameter.Type.from_parameter_value(value)
        if not isinstance(type_, Parameter.Type):
            raise TypeError(f"type must be an instance of '{Parameter.Type!r}'")
        if not type_.check(value):
            raise ValueError(f"Type '{type_}' and value '{value}' do not agree")
        self._type_, self._name, self._value = type_, name, value

    @property
    def name(self) -> str:
        """Name of the parameter."""
        return self._name

    @property
    def type_(self) -> Parameter.Type:
        """Type of the parameter."""
        return self._type_

    @property
    def value(self) -> Any:
        """Value of the parameter; None if it is not set."""
        return self._value

    def get_parameter_value(self) -> Any:
        """Return the value as a message `rcl_interfaces/msg/ParameterValue`."""
        message = ParameterValue(type=self._type_.value)
        if self._type_ is not Parameter.Type.NOT_SET:
            setattr(message, f"{self._type_.name.lower()}_value", self._value)
        return message

    def to_parameter_msg(self) -> Any:
        """Return the parameter as a message `rcl_interfaces/msg/Parameter`."""
        return ParameterMsg(name=self._name, value=self.get_parameter_value())


_SCALARS: Final[Mapping[str, type]] = {"BOOL": bool, "INTEGER": int, "DOUBLE": float, "STRING": str}
_ITEMS: Final[Mapping[str, type]] = {
    "BYTE_ARRAY": bytes,
    "BOOL_ARRAY": bool,
    "INTEGER_ARRAY": int,
    "DOUBLE_ARRAY": float,
    "STRING_ARRAY": str,
}


def get_parameter_value(string_value: str) -> Any:
    """Return the message `ParameterValue` of a text in YAML; a text that is no other value is a string."""
    try:
        value = yaml.safe_load(string_value)
    except yaml.parser.ParserError:
        value = string_value
    if isinstance(value, list) and not value:
        return Parameter("", Parameter.Type.BOOL_ARRAY, value).get_parameter_value()  # as in rclpy
    try:
        kind = Parameter.Type.from_parameter_value(value)
    except TypeError:
        kind = Parameter.Type.NOT_SET
    if kind is Parameter.Type.NOT_SET:
        kind, value = Parameter.Type.STRING, string_value if value is None or isinstance(value, list) else value
    return Parameter("", kind, value).get_parameter_value()


def parameter_value_to_python(parameter_value: Any) -> Any:
    """Return the value in a message `ParameterValue`; None if it is not set.

    Raises:
        RuntimeError: the message has an unknown type.
    """
    try:
        kind = Parameter.Type(parameter_value.type)
    except ValueError:
        raise RuntimeError(f"unexpected parameter type {parameter_value.type}") from None
    if kind is Parameter.Type.NOT_SET:
        return None
    value = getattr(parameter_value, f"{kind.name.lower()}_value")
    return value if kind.name in _SCALARS else list(value)


def parameter_dict_from_yaml_file(
    parameter_file: str, use_wildcard: bool = False, target_nodes: Sequence[str] | None = None, namespace: str = ""
) -> dict[str, Any]:
    """Return the messages `Parameter` of a parameter file by name.

    Args:
        parameter_file: path of the file.
        use_wildcard: include the parameters of `/**`, which those of nodes replace.
        target_nodes: nodes whose parameters are read; None for all.
        namespace: text in front of each name.

    Raises:
        RuntimeError: the file is no parameter file, or a node is not in it.
    """
    blocks: dict[str, Any] = yaml.safe_load(read_input_text(parameter_file))
    names = ["/**"] if use_wildcard and "/**" in blocks else []
    for node in target_nodes or ():
        if node not in blocks:
            text = f"Param file does not contain parameters for {node},only for nodes: {list(blocks)} "
            raise RuntimeError(text)
    names += target_nodes or [name for name in blocks if name != "/**"]
    if not names:
        raise RuntimeError("Param file does not contain selected parameters")
    parameters: dict[str, Any] = {}
    for name in names:
        if not isinstance(blocks[name], dict) or "ros__parameters" not in blocks[name]:
            raise RuntimeError(f"YAML file is not a valid ROS parameter file for node {name}")
        parameters.update(blocks[name]["ros__parameters"])
    return _flat_messages(namespace, parameters)


def _flat_messages(namespace: str, parameters: Mapping[str, Any]) -> dict[str, Any]:
    messages: dict[str, Any] = {}
    for key, value in parameters.items():
        if isinstance(value, dict):
            messages.update(_flat_messages(f"{namespace}{key}{PARAMETER_SEPARATOR_STRING}", value))
        else:
            name = f"{namespace}{key}"
            messages[name] = ParameterMsg(name=name, value=get_parameter_value(str(value)))
    return messages
