"""Messages as dictionaries."""

from __future__ import annotations

import base64
from array import array
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from simkit_nodes.interfaces import ProgramMessage
from simkit_nodes.ros_modules.rclpy.logging import get_logger
from simkit_nodes.ros_modules.rosidl_runtime_py.utilities import get_message, get_service

__all__ = ["convert_dictionary_to_ros_message", "convert_ros_message_to_dictionary"]

_KINDS: Final = {"request": "Request", "response": "Response"}


def convert_ros_message_to_dictionary(message: ProgramMessage, binary_array_as_bytes: bool = True) -> dict[str, Any]:
    """Return the values of a message by the names of its fields.

    Args:
        message: message.
        binary_array_as_bytes: return arrays of bytes as text in base64; False for lists.
    """
    names = message.get_fields_and_field_types()
    return {name: _plain(getattr(message, name), binary_array_as_bytes) for name in names}


def _plain(value: Any, as_base64: bool) -> Any:
    if isinstance(value, array) and value.typecode == "B" and as_base64:
        return base64.b64encode(value.tobytes()).decode()
    if isinstance(value, np.ndarray):
        return base64.b64encode(value.tobytes()).decode() if value.dtype == np.uint8 and as_base64 else value.tolist()
    if isinstance(value, (array, list, tuple)):
        return [_plain(item, as_base64) for item in value]
    return convert_ros_message_to_dictionary(value, as_base64) if hasattr(value, "SLOT_TYPES") else value


def convert_dictionary_to_ros_message(
    message_type: Any,
    dictionary: Mapping[str, Any] | None,
    kind: str = "message",
    strict_mode: bool = True,
    check_missing_fields: bool = False,
    check_types: bool = True,
    log_level: str = "error",
) -> Any:
    """Return a message with values.

    Args:
        message_type: class, or full name such as `std_msgs/msg/String`.
        dictionary: values by the names of the fields.
        kind: `message`, or `request` or `response` of a service.
        strict_mode: a value without a field is an error; otherwise it is logged.
        check_missing_fields: a field without a value is an error.
        check_types: accepted; the message checks its values.
        log_level: level of the log.

    Raises:
        ValueError: the kind is unknown, or names of fields and values differ.
    """
    if kind not in ("message", *_KINDS):
        raise ValueError(f'Unknown kind "{kind}".')
    cls = message_type
    if isinstance(message_type, str):
        cls = get_message(message_type) if kind == "message" else getattr(get_service(message_type), _KINDS[kind])
    message = cls()
    fields = message.get_fields_and_field_types()
    values = dict(dictionary or {})
    unknown = [name for name in values if name not in fields]
    for name in unknown:
        text = f'ROS message type "{message_type}" has no field named "{name}"'
        if strict_mode:
            raise ValueError(text)
        logger = get_logger("rclpy_message_converter")
        getattr(logger, log_level, logger.error)(f"{text}! It will be ignored.")
    missing = {name: kind_ for name, kind_ in fields.items() if name not in values}
    if check_missing_fields and missing:
        raise ValueError(f'Missing fields "{missing}"')
    for name, value in values.items():
        if name not in unknown and value is not None:
            converted = _of_field(getattr(message, name), fields[name], value, strict_mode, check_missing_fields)
            setattr(message, name, converted)
    return message


def _of_field(field: Any, type_name: str, value: Any, strict: bool, complete: bool) -> Any:
    """Return a value in the type of a field."""
    if isinstance(field, array):
        octets = base64.b64decode(value, validate=True) if isinstance(value, (str, bytes)) else value
        return array(field.typecode, octets)
    if isinstance(field, np.ndarray):
        if isinstance(value, str):
            return np.frombuffer(base64.b64decode(value, validate=True), np.uint8)
        return np.array(value, field.dtype)
    if hasattr(field, "SLOT_TYPES"):
        if not isinstance(value, Mapping):
            return value
        return convert_dictionary_to_ros_message(type(field), value, strict_mode=strict, check_missing_fields=complete)
    if isinstance(field, list) and value and isinstance(value[0], Mapping):
        item = get_message(type_name.removeprefix("sequence<").partition(">")[0].partition(",")[0].partition("[")[0])
        return [
            convert_dictionary_to_ros_message(item, entry, strict_mode=strict, check_missing_fields=complete)
            for entry in value
        ]
    return float(value) if isinstance(field, float) and isinstance(value, int) else value
