"""Messages as JSON or CBOR in the form of rosbridge: bytes as base64, null for NaN and infinite numbers."""

from __future__ import annotations

import base64
import binascii
import math
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.errors import MessageError
from simkit.msgs.definition_parser import ARRAY, BASE, NAME, SEQUENCE, FieldNode
from simkit.msgs.message_text import field_nodes, field_value, is_message
from simkit.msgs.message_types import FieldValue, Message

_FLOATS: Final = ("float32", "float64")
_BYTES: Final = ("uint8", "char", "octet", "byte")
_CBOR_TAGS: Final = {"u2": 69, "u4": 70, "u8": 71, "i1": 72, "i2": 77, "i4": 78, "i8": 79, "f4": 85, "f8": 86}
"""Tags of arrays of little-endian numbers (RFC 8746), by NumPy's name of the number."""


def message_to_json(message: Message, *, is_binary: bool = False) -> dict[str, FieldValue]:
    """Convert a message to dicts, lists, numbers and texts.

    Args:
        message: message.
        is_binary: True for CBOR: arrays of numbers become bytes with a tag.
    """
    nodes = field_nodes(message.__msgtype__)
    return {name: _plain(field_value(message, name), is_binary) for name, _ in nodes}


def _plain(value: FieldValue, is_binary: bool) -> FieldValue:
    if isinstance(value, np.ndarray):
        return _tagged(value) if is_binary else _listed(value)
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if is_binary or math.isfinite(value) else None
    if isinstance(value, (list, tuple)):
        return [_plain(item, is_binary) for item in value]
    return message_to_json(value, is_binary=is_binary) if is_message(value) else value


def _listed(array: npt.NDArray[np.generic]) -> FieldValue:
    if array.dtype == np.uint8:
        return base64.b64encode(array.tobytes()).decode()
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        return [number if math.isfinite(number) else None for number in array.tolist()]
    return array.tolist()


def _tagged(array: npt.NDArray[np.generic]) -> FieldValue:
    import cbor2

    if array.dtype == np.uint8:
        return array.tobytes()
    tag = _CBOR_TAGS.get(array.dtype.str[1:])
    return array.tolist() if tag is None else cbor2.CBORTag(tag, array.astype(array.dtype.newbyteorder("<")).tobytes())


def message_from_json(type_name: str, values: object) -> Message:
    """Build a message from JSON; bytes may be base64, and null is NaN in fields of floats.

    Raises:
        MessageError: the values do not match the type.
    """
    if not isinstance(values, dict):
        raise MessageError(f"{type_name}: found {values!r:.60}; expected an object of its fields")
    full = msgs.full_name(type_name)
    msgs.type_of(full)
    return msgs.from_dict((full,), _decoded(full, values))


def _decoded(type_name: str, values: dict[str, FieldValue]) -> dict[str, FieldValue]:
    nodes = dict(field_nodes(type_name))
    return {name: _decoded_field(nodes[name], value) if name in nodes else value for name, value in values.items()}


def _decoded_field(node: FieldNode, value: FieldValue) -> FieldValue:
    kind, detail = int(node[0]), node[1]
    if kind == BASE:
        return math.nan if value is None and detail[0] in _FLOATS else value
    if kind == NAME:
        return _decoded(detail, value) if isinstance(value, dict) else value
    if kind not in (ARRAY, SEQUENCE):
        return value
    item = detail[0]
    if isinstance(value, str) and int(item[0]) == BASE and item[1][0] in _BYTES:
        try:
            return base64.b64decode(value, validate=True)
        except (binascii.Error, ValueError):
            raise MessageError(f"found {value!r:.60}; expected numbers or bytes as base64") from None
    return [_decoded_field(item, each) for each in value] if isinstance(value, list) else value
