"""Messages from dictionaries."""

from __future__ import annotations

import array
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from simkit_nodes.interfaces import ROS2
from simkit_nodes.ros_modules.rosidl_parser.definition import AbstractNestedType, NamespacedType
from simkit_nodes.ros_modules.rosidl_runtime_py.convert import get_message_slot_types
from simkit_nodes.ros_modules.rosidl_runtime_py.import_message import import_message_from_namespaced_type

__all__ = ["set_message_fields"]

_Header = ROS2.message_class("std_msgs/msg/Header")
_Time = ROS2.message_class("builtin_interfaces/msg/Time")

SetTime = Callable[[Any], None]


def set_message_fields(
    msg: object, values: Mapping[str, Any], expand_header_auto: bool = False, expand_time_now: bool = False
) -> list[SetTime]:
    """Set fields of a message.

    Args:
        msg: message.
        values: values by the names of the fields; dictionaries for messages.
        expand_header_auto: `auto` as the value of a header means the present time.
        expand_time_now: `now` as the value of a time means the present time.

    Returns:
        Functions that set those times.

    Raises:
        AttributeError: the message has no such field.
        TypeError: a value does not fit its field.
    """
    times: list[SetTime] = []
    _set(msg, values, times, expand_header_auto, expand_time_now)
    return times


def _set(msg: object, values: object, times: list[SetTime], header_auto: bool, time_now: bool) -> None:
    if not hasattr(values, "items"):
        raise TypeError(f"Value '{values}' is expected to be a dictionary but is a {type(values).__name__}")
    types = get_message_slot_types(msg)
    for name, assigned in values.items():
        field = getattr(msg, name)
        cls = type(field)
        value: Any
        if cls is array.array:
            value = array.array(field.typecode, assigned)
        elif cls is np.ndarray:
            value = np.array(assigned, dtype=field.dtype)
        elif type(assigned) is cls:
            value = assigned
        elif cls is _Header and assigned == "auto" and header_auto:
            times.append(partial(setattr, field, "stamp"))
            continue
        elif cls is _Time and assigned == "now" and time_now:
            times.append(partial(setattr, msg, name))
            continue
        else:
            try:
                value = cls(assigned)
            except TypeError:
                value = cls()
                _set(value, assigned, times, header_auto, time_now)
        kind = types[name]
        if isinstance(kind, AbstractNestedType) and isinstance(kind.value_type, NamespacedType):
            item_class = import_message_from_namespaced_type(kind.value_type)
            for index, item in enumerate(value):
                if not isinstance(item, item_class):
                    message = item_class()
                    _set(message, item, times, header_auto, time_now)
                    value[index] = message
        setattr(msg, name, value)
