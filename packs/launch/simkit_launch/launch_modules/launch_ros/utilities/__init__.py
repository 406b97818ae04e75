"""Functions for names, remappings and parameters of nodes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.substitutions import TextSubstitution
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from simkit_launch.launch_modules.launch_ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext

__all__ = [
    "add_node_name",
    "evaluate_parameter_dict",
    "evaluate_parameters",
    "get_node_name_count",
    "is_namespace_absolute",
    "is_root_namespace",
    "make_namespace_absolute",
    "normalize_parameter_dict",
    "normalize_parameters",
    "normalize_remap_rule",
    "normalize_remap_rules",
    "prefix_namespace",
]

_SCALARS = (bool, int, float, str)


def is_root_namespace(ns: str) -> bool:
    """Return whether a namespace is `/`."""
    return ns == "/"


def is_namespace_absolute(ns: str) -> bool:
    """Return whether a namespace begins with a slash."""
    return ns.startswith("/")


def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None:
    """Return a namespace inside another one; an absolute one stays as it is."""
    if base_ns is None and ns is None:
        return None
    if ns is None:
        joined = base_ns or ""
    elif not base_ns or is_namespace_absolute(ns):
        joined = ns
    else:
        joined = ("" if is_root_namespace(base_ns) else base_ns) + "/" + ns
    return joined if is_root_namespace(joined) else joined.rstrip("/")


def make_namespace_absolute(ns: str | None) -> str | None:
    """Return a namespace with a slash before it."""
    return ns if ns is None or is_namespace_absolute(ns) else "/" + ns


def normalize_remap_rule(remap_rule: tuple[Any, Any]) -> tuple[tuple[Substitution, ...], tuple[Substitution, ...]]:
    """Return the substitutions for the old and the new name."""
    old, new = remap_rule
    return tuple(normalize_to_list_of_substitutions(old)), tuple(normalize_to_list_of_substitutions(new))


def normalize_remap_rules(
    remap_rules: Iterable[tuple[Any, Any]],
) -> list[tuple[tuple[Substitution, ...], tuple[Substitution, ...]]]:
    """Return the substitutions for the old and the new names; those of a set are sorted, so that runs are the same."""
    rules = [normalize_remap_rule(rule) for rule in remap_rules]
    if isinstance(remap_rules, (set, frozenset)):
        rules.sort(key=lambda rule: [sub.describe() for part in rule for sub in part])
    return rules


def normalize_parameters(parameters: Sequence[Any]) -> tuple[Any, ...]:
    """Return files and values of parameters whose texts are substitutions."""
    if isinstance(parameters, str) or not isinstance(parameters, Sequence):
        raise TypeError(f"Expecting list of parameters, got {parameters}")
    return tuple(
        normalize_parameter_dict(each)
        if isinstance(each, Mapping)
        else each
        if isinstance(each, (Parameter, ParameterFile))
        else ParameterFile(each)
        for each in parameters
    )


def normalize_parameter_dict(
    parameters: Mapping[Any, Any], *, _prefix: Sequence[Substitution] | None = None
) -> dict[tuple[Substitution, ...], Any]:
    """Return values of parameters whose texts are substitutions; nested tables are joined with dots."""
    if not isinstance(parameters, Mapping):
        raise TypeError("expected dict")
    normalized: dict[tuple[Substitution, ...], Any] = {}
    for key, value in parameters.items():
        name = normalize_to_list_of_substitutions(key)
        if _prefix:
            name = [*_prefix, TextSubstitution(text="."), *name]
        if isinstance(value, Mapping):
            normalized.update(normalize_parameter_dict(value, _prefix=name))
        elif isinstance(value, Substitution):
            normalized[tuple(name)] = (value,)
        elif isinstance(value, (ParameterValue, bool, int, float, str, bytes)):
            normalized[tuple(name)] = value
        elif isinstance(value, Sequence):
            normalized[tuple(name)] = _normalized_array(value)
        elif hasattr(value, "item"):  # a number of NumPy
            normalized[tuple(name)] = value.item()
        elif isinstance(value, os.PathLike):
            normalized[tuple(name)] = os.fspath(value)
        else:
            raise TypeError(f"Unexpected type for parameter value {value!r}")
    return normalized


def _normalized_array(values: Sequence[Any]) -> tuple[Any, ...]:
    kinds = {Substitution if isinstance(each, Substitution) else type(each) for each in values}
    if kinds == {int} or kinds == {bool}:
        return tuple(values)
    if kinds and kinds <= {int, float}:
        return tuple(float(each) for each in values)
    if Substitution in kinds and kinds <= {str, Substitution}:
        return tuple(normalize_to_list_of_substitutions(values))
    texts = [yaml.dump(each) if isinstance(each, _SCALARS) else each for each in values]
    return tuple(normalize_to_list_of_substitutions(each) for each in texts)


def evaluate_parameters(context: LaunchContext, parameters: Iterable[Any]) -> tuple[Any, ...]:
    """Return paths of files, and values of parameters by name."""
    return tuple(
        each.evaluate(context)
        if isinstance(each, ParameterFile)
        else evaluate_parameter_dict(context, each)
        if isinstance(each, Mapping)
        else each
        for each in parameters
    )


def evaluate_parameter_dict(context: LaunchContext, parameters: Mapping[Any, Any]) -> dict[str, Any]:
    """Return values of parameters by name."""
    if not isinstance(parameters, Mapping):
        raise TypeError("expected dict")
    values: dict[str, Any] = {}
    for key, value in parameters.items():
        name = perform_substitutions(context, key)
        if isinstance(value, ParameterValue):
            values[name] = value.evaluate(context)
        elif isinstance(value, tuple) and value and isinstance(value[0], Substitution):
            values[name] = _from_yaml(perform_substitutions(context, value), name)
        elif isinstance(value, tuple) and value and isinstance(value[0], (list, tuple)):
            texts = [perform_substitutions(context, each) for each in value]
            values[name] = _uniform([yaml.safe_load(text) for text in texts], name)
        else:
            values[name] = value
    return values


def _from_yaml(text: str, name: str) -> Any:
    """Return the value of a text by the rules of YAML."""
    if text.lstrip().startswith("<"):
        return text  # a description of a robot, which is no YAML but takes seconds to read as YAML
    advice = (
        "If the parameter is meant to be a string, try wrapping it in "
        "launch_ros.parameter_descriptions.ParameterValue(value, value_type=str)"
    )
    try:
        value = yaml.safe_load(text or "''")
    except yaml.YAMLError:
        raise TypeError(f"Unable to parse the value of parameter {name} as yaml. {advice}") from None
    if isinstance(value, (bool, int, float, str, bytes)):
        return value
    if isinstance(value, list):
        return _uniform(value, name)
    raise TypeError(f"Got a value of type {type(value)} for parameter {name}. {advice}")


def _uniform(values: list[Any], name: str) -> tuple[Any, ...]:
    if not values or type(values[0]) not in _SCALARS or any(not isinstance(each, type(values[0])) for each in values):
        raise TypeError(
            "Expected a non-empty sequence, with items of uniform type. Allowed sequence item types are bool, int, "
            f'float, str. Got inconsistent input for "{name}"'
        )
    return tuple(values)


def to_parameters_list(
    context: LaunchContext, node_name: str, namespace: str, evaluated_parameters: Iterable[Any]
) -> list[tuple[str, Any]]:
    """Return pairs of a name and a value for a node."""
    del context, node_name, namespace
    return [item for each in evaluated_parameters if isinstance(each, Mapping) for item in each.items()]


def _counts(context: LaunchContext) -> dict[str, int]:
    counts: dict[str, int] = context.get_locals_as_dict().setdefault("unique_ros_node_names", {})
    context.extend_globals({"unique_ros_node_names": counts})
    return counts


def add_node_name(context: LaunchContext, node_name: str) -> None:
    """Count a name of a node."""
    counts = _counts(context)
    counts[node_name] = counts.get(node_name, 0) + 1


def get_node_name_count(context: LaunchContext, node_name: str) -> int:
    """Return how many nodes have a name."""
    return _counts(context).get(node_name, 0)


def plain_value(value: Any) -> Any:
    """Return a value of a parameter as plain data: a path is a text, a tuple is a list."""
    if isinstance(value, tuple):
        return [plain_value(each) for each in value]
    if isinstance(value, bytes):
        return list(value)
    return os.fspath(value) if isinstance(value, Path) else value
