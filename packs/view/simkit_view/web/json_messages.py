"""Messages from JSON in the form of rosbridge: bytes as base64, null for NaN and infinite numbers."""

from __future__ import annotations

import base64
import binascii
import math
from typing import Final

from simkit import msgs
from simkit.errors import MessageError
from simkit.msgs.definition_parser import ARRAY, BASE, NAME, SEQUENCE, FieldNode
from simkit.msgs.message_text import field_nodes
from simkit.msgs.message_types import FieldValue, Message

_FLOATS: Final = ("float32", "float64")
_BYTES: Final = ("uint8", "char", "octet", "byte")


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
