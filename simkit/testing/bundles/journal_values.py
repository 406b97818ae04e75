"""Messages and numbers as JSON, exactly: what is read again is what was written, bit by bit."""

from __future__ import annotations

import base64
import binascii
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from simkit import msgs
from simkit.errors import MessageError
from simkit.msgs import Message
from simkit.run_spec import JsonObject

_LISTED: Final = 64  # arrays up to this length are lists of numbers that a person can read
_DTYPES: Final = frozenset(
    ("bool", "float32", "float64", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)))
)


class NotEncodable(Exception):
    """A value that JSON has no word for; says which."""


def encode_message(message: Message) -> JsonObject:
    """A message with its type. CDR would round numbers that the message itself still has in full."""
    return {"type": msgs.type_name(message), "fields": encode_value(message)}


def encode_value(value: Any) -> Any:
    """A value as JSON has it.

    Raises:
        Unpacked: there is no word for it.
    """
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return _encode_array(value)
    if isinstance(value, (list, tuple)):
        return [encode_value(one) for one in value]
    if isinstance(value, Mapping):
        return {str(key): encode_value(one) for key, one in value.items()}
    if hasattr(value, "__msgtype__"):
        names = (name for name in value.__dataclass_fields__ if name != "__msgtype__")
        return {name: encode_value(getattr(value, name)) for name in names}
    raise NotEncodable(type(value).__name__)


def _encode_array(value: Any) -> Any:
    if value.ndim == 1 and value.size <= _LISTED:
        return value.tolist()
    data = np.ascontiguousarray(value)
    return {"dtype": str(data.dtype), "base64": base64.b64encode(data.tobytes()).decode("ascii")}


def decode_message(words: Any) -> Any:
    """The message that `encode_message` was given.

    Raises:
        MessageError: these are the words of none.
    """
    if not isinstance(words, dict) or not isinstance(words.get("type"), str) or not isinstance(words["fields"], dict):
        raise MessageError(f"found {words!r:.80}, allowed is a message's type with its fields")
    return msgs.make(words["type"], **decode_value(words["fields"]))


def decode_value(value: Any) -> Any:
    """A value with its arrays.

    Raises:
        MessageError: an array is none.
    """
    if isinstance(value, list):
        return [decode_value(one) for one in value]
    if not isinstance(value, dict):
        return value
    if set(value) == {"dtype", "base64"}:
        return decode_array(value)
    return {key: decode_value(one) for key, one in value.items()}


def decode_array(words: Any) -> Any:
    """A flat array from a list of numbers, or from its bytes.

    Raises:
        MessageError: it is none.
    """
    try:
        if isinstance(words, list):
            return np.array(words, dtype=float).reshape(-1)
        if words["dtype"] not in _DTYPES:
            raise ValueError(f"numbers of type {words['dtype']!r:.40}")
        return np.frombuffer(base64.b64decode(words["base64"], validate=True), dtype=words["dtype"]).copy()
    except (ValueError, TypeError, KeyError, binascii.Error) as error:
        raise MessageError(f"found no array: {error}") from None
