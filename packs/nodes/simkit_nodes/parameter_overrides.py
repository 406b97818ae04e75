"""First values of a node's parameters, from the command line of ROS 2: `-p x:=1` and `--params-file FILE`.

The types are those of rcl, not those of PyYAML: `1e3` is a double, `yes` a bool, and a text in quotes stays a text.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

import yaml

from simkit.errors import InputError
from simkit.extend import Where
from simkit.input_file import read_failure, read_input_text
from simkit.plugins.ros_parameter_files import node_matches
from simkit_nodes.names import RosArguments

ParameterContent = bool | int | float | str | list[bool] | list[int] | list[float] | list[str]

_BOOLS: Final = {
    **dict.fromkeys(("y", "Y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"), True),
    **dict.fromkeys(("n", "N", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"), False),
}
_INTEGER: Final = re.compile(r"[-+]?(0[xX][0-9a-fA-F]+|[0-9]+)")
_FLOAT: Final = re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?")
_SPECIAL: Final = re.compile(r"[-+]?\.?(inf|Inf|INF|nan|NaN|NAN)")


def parameter_overrides(
    node: str, arguments: RosArguments, params: Mapping[str, object]
) -> dict[str, ParameterContent]:
    """Return the values that replace the declared ones of a node: of files, then of `-p`, then of `params`.

    Args:
        node: full name of the node, such as `/robot/driver`.
        arguments: arguments after `--ros-args`.
        params: values by name; dicts are namespaces.

    Raises:
        InputError: SK-NODE-030 a value is not valid; SK-NODE-031 a file cannot be read.
    """
    values: dict[str, ParameterContent] = {}
    for path in arguments.parameter_files:
        values.update((name, value) for pattern, name, value in file_values(Path(path)) if node_matches(pattern, node))
    for pattern, name, text in arguments.parameters:
        if not pattern or _is_for(pattern, node):
            values[name] = rule_value(name, text)
    values.update(flat_values(params))
    return values


def parameter_places(node: str, arguments: RosArguments) -> dict[str, Where]:
    """Return file and line of each value and block of a node's parameter files, by its name with dots.

    Args:
        node: full name of the node.
        arguments: arguments after `--ros-args`.

    Raises:
        InputError: SK-NODE-031 a file cannot be read.
    """
    places: dict[str, Where] = {}
    for path in arguments.parameter_files:
        for pattern, block in _nodes_of_file(Path(path)):
            if node_matches(pattern, node):
                places.update(_places("", block, path))
    return places


def _places(prefix: str, block: yaml.Node, path: str) -> Iterator[tuple[str, Where]]:
    if isinstance(block, yaml.MappingNode):
        for key, below in block.value:
            name = f"{prefix}.{key.value}" if prefix else str(key.value)
            yield name, Where(path, key.start_mark.line + 1)
            yield from _places(name, below, path)


def check_parameters(arguments: RosArguments) -> None:
    """Check the files and the values of arguments after `--ros-args`, for all nodes.

    Raises:
        InputError: SK-NODE-030 a value is not valid; SK-NODE-031 a file is not valid.
    """
    for path in arguments.parameter_files:
        list(file_values(Path(path)))
    for _, name, text in arguments.parameters:
        rule_value(name, text)


def ros1_parameters(arguments: RosArguments) -> dict[str, Any]:
    """Return the parameters of a program of ROS 1: of files as of `rosparam`, then of `-p`.

    Raises:
        InputError: SK-NODE-030 a value is not valid; SK-NODE-031 a file is not valid.
    """
    values: dict[str, Any] = {}
    for file in arguments.parameter_files:
        content = _read_yaml(Path(file), yaml.safe_load)
        if content is not None and not isinstance(content, dict):
            raise InputError("SK-NODE-031", f"{file} has no names of parameters", help="write NAME: VALUE")
        values.update(content or {})
    for _, name, text in arguments.parameters:
        try:
            values[name] = yaml.safe_load(text)
        except yaml.YAMLError:
            raise _not_yaml(name, text) from None
    return values


def rule_value(name: str, text: str) -> ParameterContent:
    """Return the value of a rule `-p NAME:=TEXT`.

    Raises:
        InputError: SK-NODE-030 the value is not valid.
    """
    try:
        return _value(yaml.compose(text, yaml.SafeLoader), name)
    except yaml.YAMLError:
        raise _not_yaml(name, text) from None


def _not_yaml(name: str, text: str) -> InputError:
    problem = f"found {text!r} for parameter {name!r}; expected a value in YAML"
    return InputError("SK-NODE-030", problem, help="put a text with special characters in quotes")


def _is_for(pattern: str, node: str) -> bool:
    return node_matches(pattern, node) if "/" in pattern else pattern == node.rpartition("/")[2]


def file_values(path: Path) -> Iterator[tuple[str, str, ParameterContent]]:
    """Yield the pattern of the node's full name, the name and the value of each parameter in a file.

    Raises:
        InputError: SK-NODE-030 a value is not valid; SK-NODE-031 the file is not valid.
    """
    for pattern, block in _nodes_of_file(path):
        yield from ((pattern, name, value) for name, value in _leaves("", block, path))


def _nodes_of_file(path: Path) -> Iterator[tuple[str, yaml.Node]]:
    """Yield the pattern of each node's name in a file, and the block of its parameters."""
    root = _read_yaml(path, _composed)
    if isinstance(root, (yaml.MappingNode, yaml.SequenceNode)):  # rcl accepts an empty file, and a single word
        yield from _nodes_of_block(root, "", path)


@lru_cache(maxsize=8)  # all nodes of a launch file read the same long file
def _composed(text: str) -> yaml.Node | None:
    return yaml.compose(text, yaml.SafeLoader)


def _read_yaml(path: Path, read: Callable[[str], object]) -> Any:
    try:
        return read(read_input_text(path))
    except OSError as error:
        raise InputError("SK-NODE-031", f"{path} cannot be read: {read_failure(error)}") from error
    except (UnicodeDecodeError, yaml.YAMLError) as error:
        mark = getattr(error, "problem_mark", None)
        place = path if mark is None else f"{path}:{mark.line + 1}"
        reason = getattr(error, "problem", None) or error
        raise InputError("SK-NODE-031", f"{place} is not valid YAML: {reason}") from error


def _nodes_of_block(block: yaml.Node, pattern: str, path: Path) -> Iterator[tuple[str, yaml.Node]]:
    if not isinstance(block, yaml.MappingNode):
        problem = f"{path}:{block.start_mark.line + 1} has a value outside of a block ros__parameters"
        raise InputError("SK-NODE-031", problem, help="write NODE: {ros__parameters: {NAME: VALUE}}")
    for key, below in block.value:
        if key.value != "ros__parameters":
            yield from _nodes_of_block(below, f"{pattern}/{str(key.value).strip('/')}", path)
        elif isinstance(below, yaml.MappingNode):
            yield pattern or "/**", below
        else:
            yield from _nodes_of_block(below, pattern, path)


def _leaves(prefix: str, block: yaml.Node, path: Path) -> Iterator[tuple[str, ParameterContent]]:
    if isinstance(block, yaml.MappingNode):
        for key, below in block.value:
            yield from _leaves(f"{prefix}.{key.value}" if prefix else str(key.value), below, path)
    elif isinstance(block, yaml.ScalarNode) and block.style is None and not block.value:
        line = block.start_mark.line + 1
        raise InputError("SK-NODE-031", f"{path}:{line} has no value for the parameter {prefix!r}")
    elif prefix:
        yield prefix, _value(block, prefix)


def _value(node: yaml.Node | None, name: str) -> ParameterContent:
    """Return a value or a list of values of one type."""
    if isinstance(node, yaml.ScalarNode):
        return typed_text(node.value) if node.style is None else str(node.value)
    if node is None:
        return ""
    if not isinstance(node, yaml.SequenceNode):
        problem = f"found a mapping for parameter {name!r}; expected a value or a list"
        raise InputError("SK-NODE-030", problem, help=f"give each parameter of the mapping a value: {name}.NAME")
    items = [_value(item, name) for item in node.value]
    if len({type(item) for item in items}) > 1 or any(isinstance(item, list) for item in items):
        raise InputError(
            "SK-NODE-030",
            f"the list of parameter {name!r} has values of different types",
            help="write all numbers of the list with a decimal point, or none",
        )
    return items  # type: ignore[return-value]  # the items have one type


def typed_text(text: str) -> bool | int | float | str:
    """Return the value of a text without quotes, with rcl's rules: bool, integer, double or string."""
    if text in _BOOLS:
        return _BOOLS[text]
    if _INTEGER.fullmatch(text):
        digits = text.lstrip("+-")
        base = 16 if digits[:2] in ("0x", "0X") else 8 if len(digits) > 1 and digits[0] == "0" else 10
        try:
            value = int(text, base)
        except ValueError:  # such as 08
            return float(text)
        if -(1 << 63) <= value < 1 << 63:
            return value
    if _FLOAT.fullmatch(text):
        return float(text)
    return float(text.replace(".", "")) if _SPECIAL.fullmatch(text) else text


def flat_values(params: Mapping[str, object], prefix: str = "") -> Iterator[tuple[str, ParameterContent]]:
    """Yield name and value of each parameter; the names of nested tables are joined with dots."""
    for key, value in params.items():
        name = f"{prefix}.{key}" if prefix else str(key)
        if isinstance(value, Mapping):
            yield from flat_values(value, name)
            continue
        content = getattr(value, "tolist", lambda value=value: value)()  # numbers and arrays of NumPy
        yield name, list(content) if isinstance(content, tuple) else content
