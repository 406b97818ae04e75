"""Type hashes of ROS 2 (REP 2016, `RIHS01_…`) of messages, services and actions.

rosbags computes the same hashes for messages without `wstring` fields.
"""

from __future__ import annotations

import hashlib
import json
from functools import cache
from typing import Any, Final

from simkit.errors import MessageError
from simkit.msgs.definition_parser import ARRAY, BASE, NAME, PARTS, SEQUENCE, FieldNode
from simkit.msgs.message_types import full_name, type_store
from simkit.msgs.shipped_interfaces import NO_FIELD

_IDS: Final = {
    "int8": 2, "uint8": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7, "int64": 8, "uint64": 9, "float32": 10,
    "float64": 11, "char": 3, "bool": 15, "byte": 16, "string": 17, "wstring": 18,
}  # fmt: skip
"""Field types of `type_description_interfaces/msg/FieldType`; a `char` of a `.msg` file is an `uint8` there."""
_NESTED, _BOUNDED_TEXT = 1, 4  # id of a message; added to the id of a text with a bound
_OFFSETS: Final = {ARRAY: 48, SEQUENCE: 144}
_BOUNDED_SEQUENCE: Final = 96
_EVENT_INFO: Final = "service_msgs/msg/ServiceEventInfo"
_Fields = list[tuple[str, FieldNode]]


@cache
def rihs(type_name: str) -> str:
    """Return the type hash as ROS 2 writes it (`RIHS01_…`), of a message type, a service or an action.

    Raises:
        MessageError: the type is unknown.
    """
    name = type_name if _is_hidden(type_name) else full_name(type_name)
    structs: dict[str, dict[str, Any]] = {}
    _describe(name, structs)
    first = structs.pop(name)
    content = {"type_description": first, "referenced_type_descriptions": [structs[key] for key in sorted(structs)]}
    return "RIHS01_" + hashlib.sha256(json.dumps(content).encode()).hexdigest()


def _describe(name: str, structs: dict[str, dict[str, Any]]) -> None:
    """Add the description of a type, and those of all types that it uses, to a table."""
    if name not in structs:
        fields = _fields(name)
        structs[name] = {"type_name": name, "fields": [_field(field, node) for field, node in fields]}
        for _, (kind, content) in fields:
            inner = content[0] if int(kind) in (ARRAY, SEQUENCE) else (kind, content)
            if int(inner[0]) == NAME:
                _describe(inner[1], structs)


def _field(name: str, node: FieldNode) -> dict[str, Any]:
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
    found = {"type_id": offset + number, "capacity": size, "string_capacity": bound, "nested_type_name": nested}
    return {"name": name, "type": found}


def _is_hidden(name: str) -> bool:
    """Check for a service or action itself, or for a type that ROS 2 generates for it."""
    kind, _, short = name.partition("/")[2].partition("/")
    return kind in ("srv", "action") and "_" + short.partition("_")[2] not in PARTS[kind]


def _fields(name: str) -> _Fields:
    """Return the fields of a message type, and those that ROS 2 gives to services, actions and their hidden types."""
    if _is_hidden(name):
        base, _, suffix = name.rpartition("/")[2].partition("_")
        return _hidden_fields(f"{name.rpartition('/')[0]}/{base}", name.split("/")[1], suffix)
    fields: _Fields = list(type_store().fielddefs[full_name(name)][1])
    return fields or [(NO_FIELD, (BASE, ("uint8", 0)))]


def _service(name: str) -> _Fields:
    return [(f"{part.lower()}_message", (NAME, f"{name}_{part}")) for part in ("Request", "Response", "Event")]


def _event(name: str) -> _Fields:
    parts = [(part.lower(), (SEQUENCE, ((NAME, f"{name}_{part}"), 1))) for part in ("Request", "Response")]
    return [("info", (NAME, _EVENT_INFO)), *parts]


def _hidden_fields(name: str, kind: str, suffix: str) -> _Fields:
    """Return the fields of a service or action itself, or of one of the types that ROS 2 generates for it."""
    if kind == "srv":
        found = {"": _service, "Event": _event}.get(suffix)
        if found is not None:
            return found(name)
    goal_id: tuple[str, FieldNode] = ("goal_id", (NAME, "unique_identifier_msgs/msg/UUID"))
    stamp: tuple[str, FieldNode] = ("stamp", (NAME, "builtin_interfaces/msg/Time"))
    table: dict[str, _Fields] = {
        "": [
            *((part.lower(), (NAME, f"{name}_{part}")) for part in ("Goal", "Result", "Feedback")),
            ("send_goal_service", (NAME, f"{name}_SendGoal")),
            ("get_result_service", (NAME, f"{name}_GetResult")),
            ("feedback_message", (NAME, f"{name}_FeedbackMessage")),
        ],
        "SendGoal_Request": [goal_id, ("goal", (NAME, f"{name}_Goal"))],
        "SendGoal_Response": [("accepted", (BASE, ("bool", 0))), stamp],
        "GetResult_Request": [goal_id],
        "GetResult_Response": [("status", (BASE, ("int8", 0))), ("result", (NAME, f"{name}_Result"))],
        "FeedbackMessage": [goal_id, ("feedback", (NAME, f"{name}_Feedback"))],
    }
    for word in ("SendGoal", "GetResult"):
        table[word], table[f"{word}_Event"] = _service(f"{name}_{word}"), _event(f"{name}_{word}")
    if kind == "action" and suffix in table:
        return table[suffix]
    raise MessageError(f"unknown type {name}_{suffix}")
