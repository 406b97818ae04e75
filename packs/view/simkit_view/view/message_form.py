"""Description of message types for forms: fields with their kinds, limits, constants and defaults."""

from __future__ import annotations

import math
from typing import Final

from simkit.msgs import type_store
from simkit.msgs.definition_parser import ARRAY, BASE, INTEGER_RANGES, NAME, SEQUENCE, TEXTS, FieldNode
from simkit.msgs.message_builder import builder_of
from simkit.msgs.message_text import field_nodes, message_to_dict
from simkit.run_spec import JsonObject

_MOST_TYPES: Final = 200
_LARGEST: Final = {"float32": 3.4028234663852886e38, "float64": 1.7976931348623157e308}
_SAFE: Final = (1 << 53) - 1  # largest whole number that JavaScript holds exactly

Description = JsonObject


def describe_form(type_name: str) -> Description:
    """Return the fields of a type and of all types that it uses.

    Args:
        type_name: message type, or a part of a service or action such as `std_srvs/srv/SetBool_Request`.

    Returns:
        `type`, and `types`: type -> `fields` (`name`, `kind`, limits, `array`, `constants`) and `default` values.

    Raises:
        MessageError: the type is unknown.
    """
    root = builder_of(type_name).name
    descriptions: dict[str, Description] = {}
    waiting = [root]
    while waiting and len(descriptions) < _MOST_TYPES:
        name = waiting.pop(0)
        if name in descriptions:
            continue
        fields = [_field(name, field, node) for field, node in field_nodes(name)]
        descriptions[name] = {"fields": fields, "default": _plain(message_to_dict(builder_of(name).default()))}
        waiting += [field["type"] for field in fields if field["kind"] == "message"]
    return {"type": root, "types": descriptions}


def _field(owner: str, name: str, node: FieldNode) -> Description:
    kind, detail = int(node[0]), node[1]
    array: Description | None = None
    if kind in (ARRAY, SEQUENCE):
        inner, size = detail
        array = {"length": size if kind == ARRAY else 0, "most": size if kind == SEQUENCE else 0}
        kind, detail = int(inner[0]), inner[1]
    if kind == NAME:
        return {"name": name, "kind": "message", "type": detail, "array": array}
    base, bound = detail
    description: Description = {"name": name, "type": base, "array": array, "constants": _constants(owner, name, base)}
    if base in TEXTS:
        return {**description, "kind": "text", "most": bound}
    if base in ("bool", "float32", "float64"):
        low = -_LARGEST.get(base, 0.0)
        return {**description, "kind": "bool" if base == "bool" else "number", "low": low, "high": -low}
    low, high = INTEGER_RANGES.get(base, (0, 255))
    return {**description, "kind": "integer", "low": max(low, -_SAFE), "high": min(high, _SAFE)}


def _constants(owner: str, field: str, base: str) -> list[list[object]]:
    """Return name and value of the constants that a field may have.

    A definition does not connect constants with fields. Those with the field's name in front belong to it; a constant
    without such a field belongs to the only field of its type, if there is only one.
    """
    constants = [(name, value) for name, kind, value in type_store().fielddefs[owner][0] if kind == base]
    fields = [name for name, node in field_nodes(owner) if _base_of(node) == base]
    owned = {name: next((f for f in fields if name.startswith(f"{f.upper()}_")), None) for name, _ in constants}
    alone = fields[0] if len(fields) == 1 else None
    numbers: list[list[object]] = [[name, value] for name, value in constants if (owned[name] or alone) == field]
    return [row for row in numbers if not isinstance(row[1], float) or math.isfinite(row[1])]


def _base_of(node: FieldNode) -> str:
    kind, detail = int(node[0]), node[1]
    if kind in (ARRAY, SEQUENCE):
        kind, detail = int(detail[0][0]), detail[0][1]
    return str(detail[0]) if kind == BASE else ""


def _plain(value: object) -> object:
    """Replace numbers that JSON cannot express by null."""
    if isinstance(value, dict):
        return {name: _plain(item) for name, item in value.items()}
    if isinstance(value, list):
        return [_plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
