"""Encoding of messages and numbers as JSON without loss: decoding restores every bit."""

from __future__ import annotations

import base64
import binascii
from collections.abc import Mapping
from typing import Final

import numpy as np

from simkit import msgs
from simkit.errors import MessageError
from simkit.msgs import Message
from simkit.msgs.message_repr import attribute_names
from simkit.run_spec import JsonObject
from simkit.testing.run_record.record import Array

_MAX_LISTED: Final = 64  # arrays up to this length are stored as readable lists of numbers
_DTYPES: Final = frozenset(
    ("bool", "float32", "float64", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)))
)

DEFERRED: Final = "deferred"
"""Result of a callback in the journal, for a response that is an entry of its own."""


class NotEncodable(Exception):
    """Value that JSON cannot represent; the message names its type."""


def encode_message(message: Message) -> JsonObject:
    """Encode a message with its type as JSON, because CDR would round numbers to the precision of the ROS type."""
    return {"type": msgs.type_name(message), "fields": encode_value(message)}


def encode_value(value: object) -> object:
    """Encode a value as JSON.

    Raises:
        NotEncodable: JSON cannot represent the value.
    """
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return _encode_array(value)
    if isinstance(value, (list, tuple)):
        return [encode_value(item) for item in value]
    if isinstance(value, Mapping):
        return {str(key): encode_value(item) for key, item in value.items()}
    if hasattr(value, "__msgtype__"):
        return {name: encode_value(getattr(value, name)) for name in attribute_names(value)}
    raise NotEncodable(type(value).__name__)


def _encode_array(value: Array) -> object:
    if value.ndim == 1 and value.size <= _MAX_LISTED:
        return value.tolist()
    data = np.ascontiguousarray(value)
    return {"dtype": str(data.dtype), "base64": base64.b64encode(data.tobytes()).decode("ascii")}


def decode_message(encoded: object) -> Message:
    """Decode a message that `encode_message` returned.

    Raises:
        MessageError: The value is not an encoded message.
    """
    if (
        not isinstance(encoded, dict)
        or not isinstance(encoded.get("type"), str)
        or not isinstance(encoded["fields"], dict)
    ):
        raise MessageError(f"found {encoded!r:.80}, expected a message type with its fields")
    return msgs.make(encoded["type"], **{name: decode_value(value) for name, value in encoded["fields"].items()})


def decode_value(value: object) -> object:
    """Decode a value and its arrays.

    Raises:
        MessageError: An array is invalid.
    """
    if isinstance(value, list):
        return [decode_value(item) for item in value]
    if not isinstance(value, dict):
        return value
    if set(value) == {"dtype", "base64"}:
        return decode_array(value)
    return {key: decode_value(item) for key, item in value.items()}


def decode_array(encoded: object) -> Array:
    """Decode a flat array from a list of numbers or from its bytes.

    Raises:
        MessageError: The array is invalid.
    """
    try:
        if isinstance(encoded, list):
            return np.array(encoded, dtype=float).reshape(-1)
        if not isinstance(encoded, dict):
            raise ValueError(f"found {encoded!r:.40}")
        if encoded["dtype"] not in _DTYPES:
            raise ValueError(f"unsupported number type {encoded['dtype']!r:.40}")
        return np.frombuffer(base64.b64decode(encoded["base64"], validate=True), dtype=encoded["dtype"]).copy()
    except (ValueError, TypeError, KeyError, binascii.Error) as error:
        raise MessageError(f"invalid array: {error}") from None
