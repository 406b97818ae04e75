"""Type hashes of ROS 2 (REP 2016, `RIHS01_…`) of messages, services and actions.

rosbags computes the same hashes for messages without `wstring` fields.
"""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING, Final

from simkit.msgs.definition_parser import ARRAY, BASE, NAME, SEQUENCE, FieldNode
from simkit.msgs.derived_types import Fields, derived_fields, is_derived
from simkit.msgs.message_types import cache, full_name, type_store
from simkit.msgs.shipped_interfaces import NO_FIELD

if TYPE_CHECKING:
    from simkit.run_spec import JsonObject


_IDS: Final = {
    "int8": 2, "uint8": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7, "int64": 8, "uint64": 9, "float32": 10,
    "float64": 11, "char": 3, "bool": 15, "byte": 16, "string": 17, "wstring": 18,
}  # fmt: skip
"""Field types of `type_description_interfaces/msg/FieldType`; a `char` of a `.msg` file is an `uint8` there."""
_NESTED, _BOUNDED_TEXT = 1, 4  # id of a message; added to the id of a text with a bound
_OFFSETS: Final = {ARRAY: 48, SEQUENCE: 144}
_BOUNDED_SEQUENCE: Final = 96


@cache
def rihs(type_name: str) -> str:
    """Return the type hash as ROS 2 writes it (`RIHS01_…`), of a message type, a service or an action.

    Raises:
        MessageError: the type is unknown.
    """
    name = type_name if is_derived(type_name) else full_name(type_name)
    structs: dict[str, JsonObject] = {}
    _describe(name, structs)
    first = structs.pop(name)
    content = {"type_description": first, "referenced_type_descriptions": [structs[key] for key in sorted(structs)]}
    return "RIHS01_" + hashlib.sha256(json.dumps(content).encode()).hexdigest()


def _describe(name: str, structs: dict[str, JsonObject]) -> None:
    """Add the description of a type, and those of all types that it uses, to a table."""
    if name not in structs:
        fields = _fields(name)
        structs[name] = {"type_name": name, "fields": [_field(field, node) for field, node in fields]}
        for _, (kind, content) in fields:
            inner = content[0] if int(kind) in (ARRAY, SEQUENCE) else (kind, content)
            if int(inner[0]) == NAME:
                _describe(inner[1], structs)


def _field(name: str, node: FieldNode) -> JsonObject:
    kind, content = int(node[0]), node[1]
    offset = size = 0
    inner = node
    if kind in (ARRAY, SEQUENCE):
        inner, size = content
        offset = _BOUNDED_SEQUENCE if kind == SEQUENCE and size else _OFFSETS[kind]
    nested, bound, number = "", 0, _NESTED
    if int(inner[0]) == NAME:
        nested = inner[1]
    else:
        basic, bound = inner[1]
        number = _IDS[basic] + (_BOUNDED_TEXT if bound else 0)
    field_type = {"type_id": offset + number, "capacity": size, "string_capacity": bound, "nested_type_name": nested}
    return {"name": name, "type": field_type}


def _fields(name: str) -> Fields:
    """Return the fields of a message type, or of a type that ROS 2 derives from a service or an action."""
    if is_derived(name):
        return derived_fields(name)
    fields: Fields = list(type_store().fielddefs[full_name(name)][1])
    return fields or [(NO_FIELD, (BASE, ("uint8", 0)))]
