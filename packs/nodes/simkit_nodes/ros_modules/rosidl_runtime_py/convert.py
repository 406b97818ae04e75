"""Messages as YAML, comma-separated values and dictionaries."""

from __future__ import annotations

import array
import sys
from collections import OrderedDict
from dataclasses import dataclass
from typing import Any

import numpy as np
import yaml

from simkit_nodes.interfaces import ProgramMessage
from simkit_nodes.ros_modules.rosidl_parser import definition

__all__ = ["get_message_slot_types", "message_to_csv", "message_to_ordereddict", "message_to_yaml"]

_SEQUENCES = (list, tuple, array.array, np.ndarray)


@dataclass(frozen=True)
class _Style:
    """Parts of a message that are shortened.

    Attributes:
        truncate_length: longest text and sequence; None for no limit.
        no_arr: True to print only type and length of sequences.
        no_str: True to print only the length of texts.
    """

    truncate_length: int | None
    no_arr: bool
    no_str: bool


class _Dumper(yaml.Dumper):
    """Writer of YAML that keeps the order of fields."""


def _represent(dumper: yaml.Dumper, data: OrderedDict[str, Any]) -> yaml.nodes.MappingNode:
    items = [(dumper.represent_data(key), dumper.represent_data(value)) for key, value in data.items()]
    return yaml.nodes.MappingNode("tag:yaml.org,2002:map", items)


_Dumper.add_representer(OrderedDict, _represent)


def message_to_yaml(
    msg: ProgramMessage,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Return a message as YAML.

    Args:
        msg: message.
        truncate_length: longest text and sequence.
        no_arr: print only type and length of sequences.
        no_str: print only the length of texts.
        flow_style: print braces instead of lines.
    """
    values = _as_dict(msg, _Style(truncate_length, no_arr, no_str))
    return yaml.dump(values, Dumper=_Dumper, allow_unicode=True, width=sys.maxsize, default_flow_style=flow_style)


def message_to_csv(
    msg: ProgramMessage, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> str:
    """Return the values of a message with commas between them; see `message_to_yaml`."""
    return _as_csv(msg, _Style(truncate_length, no_arr, no_str))


def message_to_ordereddict(
    msg: ProgramMessage, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Return the values of a message by the names of its fields; see `message_to_yaml`."""
    return _as_dict(msg, _Style(truncate_length, no_arr, no_str))


def get_message_slot_types(msg: ProgramMessage) -> OrderedDict[str, Any]:
    """Return the type of each field as an object of `rosidl_parser.definition`."""
    return OrderedDict(zip(msg.get_fields_and_field_types(), msg.SLOT_TYPES, strict=True))


def _as_dict(msg: ProgramMessage, style: _Style) -> OrderedDict[str, Any]:
    types = get_message_slot_types(msg)
    return OrderedDict((name, _value(getattr(msg, name), style, kind)) for name, kind in types.items())


def _value(value: Any, style: _Style, kind: Any = None) -> Any:
    limit = style.truncate_length
    if isinstance(value, bytes):
        text = value.decode("latin-1")
        return text if limit is None or len(text) <= limit else f"{text[:limit]}..."
    if isinstance(value, str):
        return _text(value, style)
    if isinstance(value, _SEQUENCES):
        if style.no_arr and kind is not None:
            return _sequence_text(value, kind)
        items = [_value(item, style) for item in (value if limit is None else value[:limit])]
        return items if limit is None or len(value) <= limit else [*items, "..."]
    if isinstance(value, np.number):
        return value.item()
    return value if isinstance(value, (bool, float, int)) else _as_dict(value, style)


def _as_csv(msg: ProgramMessage, style: _Style) -> str:
    return ",".join(_csv(getattr(msg, name), style, kind) for name, kind in get_message_slot_types(msg).items())


def _csv(value: Any, style: _Style, kind: Any = None) -> str:
    limit = style.truncate_length
    if isinstance(value, _SEQUENCES):
        if style.no_arr and kind is not None:
            return _sequence_text(value, kind)
        items = [_csv(item, style) for item in (value if limit is None else value[:limit])]
        return ",".join(items if limit is None or len(value) <= limit else [*items, "..."])
    if isinstance(value, str):
        return _text(value, style)
    if isinstance(value, bytes):
        return str(value if limit is None or len(value) <= limit else value[:limit] + b"...")
    return str(value) if isinstance(value, (bool, float, int, np.number)) else _as_csv(value, style)


def _text(value: str, style: _Style) -> str:
    if style.no_str:
        return f"<string length: <{len(value)}>>"
    limit = style.truncate_length
    return value if limit is None or len(value) <= limit else f"{value[:limit]}..."


def _sequence_text(value: Any, kind: Any) -> str:
    item = _type_name(kind.value_type)
    if isinstance(kind, definition.Array):
        return f"<array type: {item}[{kind.size}]>"
    if isinstance(kind, definition.BoundedSequence):
        return f"<sequence type: {item}[{kind.maximum_size}], length: {len(value)}>"
    return f"<sequence type: {item}, length: {len(value)}>"


def _type_name(kind: Any) -> str:
    if isinstance(kind, definition.BasicType):
        return kind.typename
    if isinstance(kind, definition.NamespacedType):
        return "/".join(kind.namespaced_name())
    return "wstring" if isinstance(kind, definition.AbstractWString) else "string"
