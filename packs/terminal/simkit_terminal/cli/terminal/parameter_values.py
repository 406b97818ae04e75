"""Conversion of parameter values between text, YAML files and `rcl_interfaces/msg/ParameterValue`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.cli.terminal.output import JsonObject, JsonValue
from simkit.errors import InputError
from simkit.input_file import read_failure, read_input_text
from simkit.yaml_reader import NotYaml, read_yaml

if TYPE_CHECKING:
    from simkit.msgs import ParameterValue

KINDS: Final = (
    "not set",
    "boolean",
    "integer",
    "double",
    "string",
    "byte array",
    "boolean array",
    "integer array",
    "double array",
    "string array",
)
_FIELDS: Final = tuple(f"{kind.replace('boolean', 'bool').replace(' ', '_')}_value" for kind in KINDS)
_KIND_BY_TYPE: Final[dict[type, int]] = {bool: 1, int: 2, float: 3, str: 4}


def plain_value(parameter: ParameterValue) -> JsonValue:
    """Return the value of a ParameterValue as a plain Python value."""
    field = _FIELDS[int(parameter.type)]
    value: JsonValue = getattr(parameter, field, None)
    return value.tolist() if hasattr(value, "tolist") else value


def parse_parameter_value(text: str) -> JsonObject:
    """Parse a text on the command line to a ParameterValue; YAML determines the type, and invalid YAML is a string."""
    value = parameter_value(plain_yaml(text))
    return value if value is not None else {"type": 4, "string_value": text}


def plain_yaml(text: str) -> JsonValue:
    """Return the value of a YAML text; invalid YAML is a string."""
    try:
        return read_yaml(text)
    except NotYaml:
        return text


def parameter_value(plain: JsonValue) -> JsonObject | None:
    """Convert a plain Python value to a ParameterValue; None if no parameter type matches."""
    if isinstance(plain, list):
        kinds = {type(item) for item in plain}
        if kinds == {int, float}:
            kinds = {float}
        if len(kinds) == 1 and (kind := kinds.pop()) in _KIND_BY_TYPE:
            return {"type": _KIND_BY_TYPE[kind] + 5, _FIELDS[_KIND_BY_TYPE[kind] + 5]: [kind(item) for item in plain]}
        return None
    code = _KIND_BY_TYPE.get(type(plain))
    if code == 2 and not -(2**63) <= plain < 2**63:
        return None
    return None if code is None else {"type": code, _FIELDS[code]: plain}


def read_parameter_file(path: Path, node: str, *, wildcard: bool) -> list[tuple[str, JsonObject]]:
    """Read the parameters of a node from a file.

    Returns:
        Names and ParameterValues; those for all nodes come first.

    Raises:
        InputError: SK-CLI-041 the file is invalid, or has no parameters of this node.
    """
    try:
        root = read_yaml(read_input_text(path))
    except (OSError, UnicodeDecodeError) as error:
        raise _file_error(path, f"cannot be read: {read_failure(error)}") from None
    except NotYaml as error:
        raise _file_error(path, f"is not YAML: {error}") from None
    if not isinstance(root, dict):
        raise _file_error(path, "is not a mapping of nodes to ros__parameters")
    parameters: JsonObject = {}
    for key in ("/**", node.rpartition("/")[2], node):
        block = root.get(key) if key != "/**" or wildcard else None
        if block is None:
            continue
        if not isinstance(block, dict) or not isinstance(block.get("ros__parameters"), dict):
            raise _file_error(path, f"{key}: has no ros__parameters")
        parameters |= _flatten(block["ros__parameters"], "")
    if not parameters:
        raise _file_error(path, f"has no parameters of {node}; it has {', '.join(map(str, root)) or 'no nodes'}")
    values = {name: parameter_value(value) for name, value in parameters.items()}
    for name, value in values.items():
        if value is None:
            raise _file_error(path, f"{name}: found {parameters[name]!r}, which is not a valid parameter value")
    return [(name, value) for name, value in values.items() if value is not None]


def _flatten(block: dict[object, JsonValue], above: str) -> JsonObject:
    flat: JsonObject = {}
    for key, value in block.items():
        name = f"{above}{key}"
        flat |= _flatten(value, f"{name}.") if isinstance(value, dict) else {name: value}
    return flat


def _file_error(path: Path, text: str) -> InputError:
    return InputError("SK-CLI-041", f"{path} {text}")
