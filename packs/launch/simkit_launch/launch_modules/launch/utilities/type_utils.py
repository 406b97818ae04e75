"""Conversion of texts to values with a type."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final, List, get_args, get_origin  # noqa: UP035 - launch files compare with it

import yaml

from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities import (
    ensure_argument_type,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext

__all__ = [
    "AllowedTypesTuple",
    "AllowedTypesType",
    "AllowedValueType",
    "ListTypesTuple",
    "ListValueType",
    "NormalizedScalarType",
    "NormalizedSequenceType",
    "NormalizedValueType",
    "ScalarTypesTuple",
    "ScalarTypesType",
    "ScalarValueType",
    "SequenceValueType",
    "SomeScalarType",
    "SomeSequenceType",
    "SomeValueType",
    "StrSomeValueType",
    "coerce_list",
    "coerce_to_type",
    "extract_type",
    "get_typed_value",
    "is_instance_of",
    "is_instance_of_valid_type",
    "is_normalized_substitution",
    "is_substitution",
    "is_typing_list",
    "is_valid_scalar_type",
    "normalize_typed_substitution",
    "perform_typed_substitution",
]

ScalarTypesTuple: Final[tuple[type, ...]] = (int, float, bool, str)
ListTypesTuple: Final = (List[int], List[float], List[bool], List[str])  # noqa: UP006
AllowedTypesTuple: Final = ScalarTypesTuple + ListTypesTuple
ScalarTypesType = type
AllowedTypesType = Any
ScalarValueType = int | float | bool | str
ListValueType = list[int] | list[float] | list[bool] | list[str]
SequenceValueType = Any
AllowedValueType = Any
SomeScalarType = Any
SomeSequenceType = Any
SomeValueType = Any
StrSomeValueType = Any
NormalizedScalarType = Any
NormalizedSequenceType = Any
NormalizedValueType = Any


def is_typing_list(data_type: Any) -> bool:
    """Return whether a type is a list, such as `List[int]`."""
    return data_type is list or data_type is List or get_origin(data_type) is list  # noqa: UP006


def is_valid_scalar_type(data_type: Any) -> bool:
    """Return whether a type is int, float, bool or str."""
    return data_type in ScalarTypesTuple


def extract_type(data_type: Any) -> tuple[type, bool]:
    """Return the type of a value or of the items of a list, and whether it is a list.

    Raises:
        ValueError: it is neither.
    """
    is_list = is_typing_list(data_type) and bool(get_args(data_type))
    scalar = get_args(data_type)[0] if is_list else data_type
    if not is_valid_scalar_type(scalar):
        raise ValueError(f"Unrecognized data type: {data_type}")
    return scalar, is_list


def is_instance_of_valid_type(value: Any, *, can_be_str: bool = False) -> bool:
    """Return whether a value is a scalar, or a list of scalars of one type."""
    if not isinstance(value, list):
        return isinstance(value, ScalarTypesTuple)
    kinds = {type(each) for each in value} - ({str} if can_be_str else set())
    return len(kinds) <= 1 and all(kind in ScalarTypesTuple for kind in kinds)


def is_instance_of(value: Any, data_type: Any = None, *, can_be_str: bool = False) -> bool:
    """Return whether a value has a type; None for any of the allowed ones."""
    if data_type is None:
        return is_instance_of_valid_type(value, can_be_str=can_be_str)
    scalar, is_list = extract_type(data_type)
    allowed = (scalar, str) if can_be_str else (scalar,)
    if is_list:
        return isinstance(value, list) and all(isinstance(each, allowed) for each in value)
    return isinstance(value, allowed)


def _as_yaml(value: str, problem: str, can_be_str: bool) -> Any:
    if not value:
        return value
    try:
        output = yaml.safe_load(value)
    except yaml.YAMLError as error:
        if can_be_str:
            return value
        raise ValueError(f"{problem}: yaml.safe_load() failed\n{error}") from None
    if not is_instance_of_valid_type(output, can_be_str=can_be_str):
        raise ValueError(f"{problem}: output type is not allowed, got {type(output)}")
    return output


def coerce_to_type(value: str, data_type: Any = None, *, can_be_str: bool = False) -> Any:
    """Convert a text to a type; None for the rules of YAML.

    Args:
        value: text.
        data_type: type, such as `int` or `List[float]`.
        can_be_str: True to keep a text that cannot be converted.

    Raises:
        ValueError: the text is not of the type.
    """
    ensure_argument_type(value, str, "value", "coerce_to_type")
    if data_type is None:
        return _as_yaml(value, f"Failed to convert '{value}' using yaml rules", can_be_str)
    scalar, is_list = extract_type(data_type)
    if not is_list and scalar is str:
        return value
    if not is_list and scalar is not bool:
        try:
            return scalar(value)
        except ValueError:
            if can_be_str:
                return value
            raise
    text = {"1": "true", "0": "false"}.get(value, value) if not is_list else value
    output = _as_yaml(text, f"Failed to convert '{value}' to '{data_type}'", can_be_str)
    if not is_instance_of(output, data_type, can_be_str=can_be_str):
        raise ValueError(f"Cannot convert value '{value}' to '{data_type}'")
    return output


def coerce_list(value: list[str], data_type: Any = None, *, can_be_str: bool = False) -> Any:
    """Convert a list of texts to a list of values of one type."""
    ensure_argument_type(value, list, "value", "coerce_list")
    output = [coerce_to_type(each, data_type, can_be_str=can_be_str) for each in value]
    if not is_instance_of_valid_type(output, can_be_str=can_be_str):
        raise ValueError(f"cannot convert value to {data_type}. Got value=`{value}`")
    return output


def get_typed_value(value: str | list[str], data_type: Any, *, can_be_str: bool = False) -> Any:
    """Convert a text or a list of texts to a type."""
    if not isinstance(value, list):
        return coerce_to_type(value, data_type, can_be_str=can_be_str)
    if data_type is not None:
        data_type, is_list = extract_type(data_type)
        if not is_list:
            raise TypeError(f"Cannot convert input '{value}' of type '{type(value)}' to '{data_type}'")
    return coerce_list(value, data_type, can_be_str=can_be_str)


def is_substitution(x: Any) -> bool:
    """Return whether a value is a substitution, or a sequence of texts and at least one substitution."""
    if isinstance(x, Substitution):
        return True
    if not isinstance(x, Iterable) or isinstance(x, (str, os.PathLike)):
        return False
    items = list(x)
    return all(isinstance(item, (Substitution, str)) for item in items) and any(
        isinstance(item, Substitution) for item in items
    )


def is_normalized_substitution(x: Any) -> bool:
    """Return whether a value is a list of substitutions."""
    return isinstance(x, list) and bool(x) and all(isinstance(item, Substitution) for item in x)


def normalize_typed_substitution(value: Any, data_type: Any) -> Any:
    """Return a value whose substitutions are lists of substitutions.

    Raises:
        TypeError: the value cannot become one of the type.
    """
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, ScalarTypesTuple):
        if not is_instance_of(value, data_type) and not (data_type is float and isinstance(value, int)):
            raise TypeError(f"value='{value}' is not an instance of {data_type}")
        return value
    if is_substitution(value):
        return normalize_to_list_of_substitutions(value)
    if not isinstance(value, Iterable):
        raise TypeError(
            "value should be either a scalar, a substitutions, or a mixed list of scalars and substitutions. "
            f"Got `value={value}` of type `{type(value)}`. "
        )
    items = list(value)
    scalar, is_list = (None, True) if data_type is None else extract_type(data_type)
    if not is_list:
        raise TypeError(
            "The provided value resolves to a list, though the required type is a scalar. "
            f"Got value='{value}', data_type='{data_type}'."
        )
    kinds = {Substitution if is_substitution(item) else type(item) for item in items} - {Substitution}
    kind = float if kinds == {int, float} else next(iter(kinds), None)
    if len(kinds) > 1 and kinds != {int, float}:
        raise TypeError(f"Input value is not an acceptable 'SomeValueType'.Got value='{value}'")
    if kind is not None and (kind not in ScalarTypesTuple or scalar not in (None, kind)):
        raise TypeError(f"Got a list of '{kind}', expected a list of '{data_type}'. value='{value}'")
    return [
        normalize_to_list_of_substitutions(item) if is_substitution(item) else (float(item) if kind is float else item)
        for item in items
    ]


def perform_typed_substitution(context: LaunchContext, value: Any, data_type: Any) -> Any:
    """Return a normalised value with the texts of its substitutions, converted to a type.

    Raises:
        TypeError, ValueError: the value is not of the type.
    """
    if isinstance(value, ScalarTypesTuple):
        if data_type is not None and not is_instance_of(value, data_type):
            if data_type is float and isinstance(value, int):
                return float(value)
            raise TypeError(f"value=`{value}` is a scalar and not an instance of `{data_type}`")
        return value
    if is_normalized_substitution(value):
        return coerce_to_type(perform_substitutions(context, value), data_type)
    if not isinstance(value, list):
        raise TypeError(f"Input value is not an acceptable 'NormalizedValueType'.Got value='{value}'")
    scalar, is_list = (None, True) if data_type is None else extract_type(data_type)
    if not is_list:
        raise ValueError(
            f"The input value is a list, cannot convert it to a scalar. Got value='{value}', expected type {scalar}."
        )
    output = [
        coerce_to_type(perform_substitutions(context, item), scalar) if is_normalized_substitution(item) else item
        for item in value
    ]
    if not is_instance_of(output, data_type):
        raise ValueError(f"The output list does not match the expected type: value='{value}', expected {scalar}.")
    return output
