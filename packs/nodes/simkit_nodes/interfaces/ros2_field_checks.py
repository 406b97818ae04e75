"""Checks of values that a program assigns to fields of ROS 2 messages.

rclpy makes these checks, with these texts, if the environment has ROS_PYTHON_CHECK_FIELDS=1. Here they are always made.
The rules are those of ROS 2 Jazzy (rosidl_python 0.22, `rosidl_generator_py/resource/_msg.py.em`).
"""

from __future__ import annotations

import math
from array import array
from collections import UserList, UserString
from collections.abc import Callable, Sequence, Set
from typing import Any, Final

import numpy as np

from simkit.msgs.definition_parser import INTEGER_RANGES
from simkit_nodes.interfaces.message_fields import Field, number_type

Check = Callable[[Any], object]
"""Function that returns the value to store; it raises AssertionError for a value that the field cannot have."""

_LARGEST: Final = {"float32": ("float", 3.402823466e38), "float64": ("double", 1.7976931348623157e308)}
_PYTHON_TYPES: Final[dict[str, type]] = {
    "bool": bool,
    "byte": bytes,
    "float32": float,
    "float64": float,
    "string": str,
    "wstring": str,
}


def check_of(field: Field, message_class: Callable[[str], type]) -> Check:
    """Return the check of a field.

    Args:
        field: field of a message type.
        message_class: function that returns the class of a message type.
    """
    item = message_class(field.type_name) if field.is_message else _PYTHON_TYPES.get(field.type_name, int)
    if field.shape:
        return _sequence_check(field, item)
    if field.type_name in INTEGER_RANGES and item is int:
        return _integer_check(field)
    if field.type_name == "float32":
        return _float32_check(field)
    return _single_check(field, item)


def length_check_of(field: Field, message_class: Callable[[str], type]) -> Check:
    """Return a check of the length of a list, whose items a program may have changed."""
    item = message_class(field.type_name) if field.is_message else _PYTHON_TYPES.get(field.type_name, int)
    size, is_array, text = field.size, field.shape == "array", _sequence_text(field, item)

    def check(value: Any) -> Any:
        if not _has_size(len(value), size, is_array):
            raise AssertionError(text)
        return value

    return check


def _single_check(field: Field, item: type) -> Check:
    bound = field.text_bound
    if field.is_message:
        text = f"must be a sub message of type '{item.__name__}'"
    elif item is bytes:
        text = "must be of type 'bytes' or 'ByteString' with length 1"
    elif bound:
        text = f"must be string value not longer than {bound}"
    else:
        text = f"must be of type '{item.__name__}'"
    types: tuple[type[Any], ...] = (str, UserString) if bound else (bytes, bytearray) if item is bytes else (item,)
    longest, shortest = (1, 1) if item is bytes else (bound, 0)
    text = f"The '{field.name}' field {text}"

    def check(value: Any) -> Any:
        if not isinstance(value, types) or (longest and not shortest <= len(value) <= longest):
            raise AssertionError(text)
        return value

    return check


def _integer_check(field: Field) -> Check:
    low, high = INTEGER_RANGES[field.type_name]
    sign = "an" if low else "an unsigned"

    def check(value: Any) -> Any:
        if not isinstance(value, int):
            raise AssertionError(f"The '{field.name}' field must be of type 'int'")
        if not low <= value <= high:
            raise AssertionError(f"The '{field.name}' field must be {sign} integer in [{low}, {high}]")
        return value

    return check


def _float32_check(field: Field) -> Check:
    name, largest = _LARGEST[field.type_name]

    def check(value: Any) -> Any:
        if not isinstance(value, float):
            raise AssertionError(f"The '{field.name}' field must be of type 'float'")
        if (value < -largest or value > largest) and not math.isinf(value):
            raise AssertionError(f"The '{field.name}' field must be a {name} in [{-largest}, {largest}]")
        return value

    return check


def _sequence_check(field: Field, item: type) -> Check:
    code, size, is_array = field.array_code, field.size, field.shape == "array"
    dtype = number_type(code) if code else None
    name = f"The '{field.name}'"
    text = _sequence_text(field, item)
    has_valid_items = _items_check(field, item)

    def check(value: Any) -> Any:
        if code and is_array and isinstance(value, np.ndarray):
            if value.dtype != dtype:
                raise AssertionError(f"{name} numpy.ndarray() must have the dtype of 'numpy.{dtype}'")
            if value.size != size:
                raise AssertionError(f"{name} numpy.ndarray() must have a size of {size}")
            return value
        if code and not is_array and isinstance(value, array):
            if value.typecode != code:
                raise AssertionError(f"{name} array.array() must have the type code of '{code}'")
            if size and len(value) > size:
                raise AssertionError(f"{name} array.array() must have a size <= {size}")
            return value
        is_sequence = type(value) is list or (
            isinstance(value, (Sequence, Set, UserList)) and not isinstance(value, (str, UserString))
        )
        if not (is_sequence and _has_size(len(value), size, is_array) and has_valid_items(value)):
            raise AssertionError(text)
        if not code:
            return value
        return np.array(value, dtype) if is_array else array(code, value)

    return check


def _has_size(count: int, size: int, is_array: bool) -> bool:
    return count == size if is_array else not size or count <= size


def _items_check(field: Field, item: type) -> Callable[[Any], bool]:
    """Return a function that checks the items of a list."""
    bound = field.text_bound
    low, high = INTEGER_RANGES[field.type_name] if item is int else (0, 0)
    largest = _LARGEST["float32"][1] if field.type_name == "float32" else math.inf

    def has_valid_items(values: Any) -> bool:
        # the types of a list of 360 numbers take 4 µs, isinstance for each of them 15 µs
        if not set(map(type, values)) <= {item} and not all(isinstance(value, item) for value in values):
            return False
        if bound:
            return all(len(value) <= bound for value in values)
        if item is int:
            return not values or (min(values) >= low and max(values) <= high)
        if largest < math.inf:
            return not any((value < -largest or value > largest) and not math.isinf(value) for value in values)
        return True

    return has_valid_items


def _sequence_text(field: Field, item: type) -> str:
    """Return the text of the error for a value that is no valid sequence."""
    parts = [f"The '{field.name}' field must be a set or sequence"]
    if field.size:
        parts.append(f"with length {'' if field.shape == 'array' else '<= '}{field.size}")
    if field.text_bound:
        parts.append(f"and each string value not longer than {field.text_bound}")
    parts.append(f"and each value of type '{item.__name__}'")
    if item is int:
        low, high = INTEGER_RANGES[field.type_name]
        parts.append(f"and each {'integer' if low else 'unsigned integer'} in [{low}, {high}]")
    elif item is float:
        name, largest = _LARGEST[field.type_name]
        parts.append(f"and each {name} in [{-largest:f}, {largest:f}]")
    return " ".join(parts)
