"""Values of parameters in launch files of ROS 1: conversion of texts, YAML with angles, and names of parameters."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import Any, Final

from simkit.loaders.xacro.expansion_limits import Budget, ExpansionError
from simkit.loaders.xacro.expression import Evaluator
from simkit.loaders.xacro.expression_functions import math_functions
from simkit.yaml_reader import NotYaml, compose_nodes, node_value, read_yaml
from simkit_launch.frontends.launch_fault import LaunchFault

INVALID_VALUE: Final = "SK-LAUNCH-025"

PARAMETER_TYPES: Final = ("auto", "str", "string", "int", "double", "bool", "boolean", "yaml")

_ANGLE: Final = re.compile(r"(?P<unit>deg|rad)\((?P<text>[^)]*)\)")
_ANGLE_TAGS: Final = {"!degrees": "deg", "!radians": "rad"}
_TRUE: Final = ("true", "1")
_FALSE: Final = ("false", "0")


def convert_text(text: str, type_name: str = "auto") -> Any:
    """Convert the text of a parameter as roslaunch does.

    Args:
        text: text.
        type_name: one of `PARAMETER_TYPES`; "auto" recognises numbers and truth values.

    Raises:
        LaunchFault: the text does not fit the type, or there is no such type.
    """
    kind = type_name.strip().lower()
    try:
        if kind == "auto":
            return _converted_automatically(text)
        if kind in ("str", "string"):
            return text
        if kind == "int":
            return int(text)
        if kind == "double":
            return float(text)
        if kind == "yaml":
            return read_yaml(text)
    except NotYaml as error:
        raise LaunchFault(INVALID_VALUE, f"found {text!r}; it is not YAML: {error}") from None
    except ValueError:
        raise LaunchFault(INVALID_VALUE, f"found {text!r}; expected a value of type {kind}") from None
    if kind in ("bool", "boolean"):
        return convert_boolean(text)
    hint = f"write one of {', '.join(PARAMETER_TYPES)}"
    raise LaunchFault(INVALID_VALUE, f"there is no parameter type {type_name!r}", hint)


def convert_boolean(text: str) -> bool:
    """Convert a text to a truth value.

    Raises:
        LaunchFault: the text is no truth value.
    """
    folded = text.strip().lower()
    if folded not in (*_TRUE, *_FALSE):
        raise LaunchFault(INVALID_VALUE, f"found {text!r}; expected true, false, 1 or 0")
    return folded in _TRUE


def read_parameters(text: str, source: str) -> Any:
    """Return the values of the YAML text of `<rosparam>`; an empty text has no parameters.

    Texts such as `deg(90)` and `rad(pi/2)`, and values with the tags `!degrees` and `!radians`, are angles in radians.

    Args:
        text: YAML text.
        source: name of the text for messages, such as a file.

    Raises:
        LaunchFault: the text is not YAML, or an angle has an error.
    """
    try:
        root = compose_nodes(text)
        _mark_angles(root)
        data = None if root is None else node_value(root)
    except NotYaml as error:
        line = f", line {error.line}" if error.line else ""
        raise LaunchFault(INVALID_VALUE, f"{source}{line} is not YAML: {error}") from None
    return {} if data is None else _with_angles(data)


def flat_parameters(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Yield the absolute name and the value of each parameter; tables are namespaces."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from flat_parameters(join_names(name, str(key)), inner)
    else:
        yield canonical_name(name), value


def join_names(namespace: str, name: str) -> str:
    """Return a name in a namespace; absolute and private names stay as they are."""
    if name.startswith(("/", "~")) or not namespace:
        return name
    if namespace in ("/", "~") or namespace.endswith("/"):
        return namespace + name
    return f"{namespace}/{name}"


def canonical_name(name: str) -> str:
    """Return a name without doubled slashes and without a slash at its end."""
    parts = "/".join(part for part in name.split("/") if part)
    return f"/{parts}" if name.startswith("/") else parts


def _converted_automatically(text: str) -> Any:
    try:
        if "." in text:
            return float(text)
        if "_" not in text:
            return int(text)
    except ValueError:
        pass
    folded = text.lower()
    return folded == "true" if folded in ("true", "false") else text


def _mark_angles(root: Any) -> None:
    """Replace values with the tags of angles by texts such as `deg(90)`."""
    stack, seen = [root], set()
    while stack:
        node = stack.pop()
        if id(node) in seen:
            continue
        seen.add(id(node))
        if isinstance(node, tuple):
            stack += node
        elif isinstance(getattr(node, "value", None), list):
            stack += node.value
        elif getattr(node, "tag", "") in _ANGLE_TAGS:
            if not _ANGLE.fullmatch(node.value):
                node.value = f"{_ANGLE_TAGS[node.tag]}({node.value})"
            node.tag = "tag:yaml.org,2002:str"


def _with_angles(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _with_angles(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [_with_angles(inner) for inner in value]
    angle = _ANGLE.fullmatch(value) if isinstance(value, str) else None
    if angle is None:
        return value
    try:
        number = float(Evaluator(math_functions(), Budget()).run(angle["text"]))
    except (ExpansionError, TypeError, ValueError):
        raise LaunchFault(INVALID_VALUE, f"found {value!r}; expected an angle such as deg(90) or rad(pi/2)") from None
    return math.radians(number) if angle["unit"] == "deg" else number
