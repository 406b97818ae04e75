"""Messages as JSON."""

from __future__ import annotations

import json
from typing import Any

from simkit_nodes.interfaces import ProgramMessage
from simkit_nodes.ros_modules.rclpy_message_converter.message_converter import (
    convert_dictionary_to_ros_message,
    convert_ros_message_to_dictionary,
)

__all__ = ["convert_json_to_ros_message", "convert_ros_message_to_json"]


def convert_json_to_ros_message(message_type: Any, json_message: str, **options: Any) -> Any:
    """Return a message with the values of a JSON object; see `convert_dictionary_to_ros_message`."""
    return convert_dictionary_to_ros_message(message_type, json.loads(json_message), **options)


def convert_ros_message_to_json(message: ProgramMessage, binary_array_as_bytes: bool = True) -> str:
    """Return a message as a JSON object; see `convert_ros_message_to_dictionary`."""
    return json.dumps(convert_ros_message_to_dictionary(message, binary_array_as_bytes))
