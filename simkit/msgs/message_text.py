"""Text formats of messages as ROS 2's commands print them (YAML, CSV, Python, plain values), and access to fields.

Every function accepts the type store of the message; the default is simkit's type store. A bag has its own type store.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sized
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError
from simkit.msgs.definition_parser import ARRAY, NAME, SEQUENCE, FieldNode
from simkit.msgs.message_types import FieldValue, Message, type_store
from simkit.number_text import counted

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

_EMPTY = "structure_needs_at_least_one_member"
NUMBER_CODES = {"float32": "f", "float64": "d", "char": "B", "octet": "B"} | {
    name: letter
    for bits, code in ((8, "b"), (16, "h"), (32, "i"), (64, "q"))
    for name, letter in ((f"int{bits}", code), (f"uint{bits}", code.upper()))
}
"""Type codes of Python's `array` (used by rclpy for numbers) and `struct`, by the name of the number type."""
_STEP = re.compile(r"([^.\[\]]+)|\[(-?\d*)(:?)(-?\d*)\]")
_TypedValue = tuple[FieldValue, FieldNode | None]
_WIDEST = 2**31 - 1


@dataclass(frozen=True)
class TextStyle:
    """Amount of detail in the text of a message.

    Attributes:
        truncate: length above which arrays and strings are truncated; None for no limit.
        no_arr: True to print arrays as type and length.
        no_str: True to print strings as their length.
        flow: True for YAML on one line.
    """

    truncate: int | None = None
    no_arr: bool = False
    no_str: bool = False
    flow: bool = False


FULL_TEXT = TextStyle()


def field_nodes(type_name: str, store: Typestore | None = None) -> list[tuple[str, FieldNode]]:
    """Return name and type of each field of a message type; empty for a type without fields."""
    nodes = (store or type_store()).fielddefs[type_name][1]
    return [(name, node) for name, node in nodes if name != _EMPTY]


def field_value(message: Message, field: str) -> FieldValue:
    """Return a field's value. A field named like a Python keyword is an attribute with a trailing `_`."""
    try:
        return getattr(message, field)
    except AttributeError:
        return getattr(message, f"{field}_")


def is_message(value: object) -> bool:
    """Check whether a value is a message."""
    return isinstance(getattr(value, "__msgtype__", None), str)


def message_to_dict(
    message: Message, style: TextStyle = FULL_TEXT, store: Typestore | None = None
) -> dict[str, FieldValue]:
    """Convert a message to a dict of dicts, lists, numbers and texts, in the order of the fields."""
    return {
        name: _array_summary(field_value(message, name), node)
        if style.no_arr and int(node[0]) in (ARRAY, SEQUENCE)
        else to_plain_value(field_value(message, name), style, store)
        for name, node in field_nodes(message.__msgtype__, store)
    }


def to_plain_value(value: FieldValue, style: TextStyle = FULL_TEXT, store: Typestore | None = None) -> FieldValue:
    """Convert a field's value to dicts, lists, numbers and texts."""
    if isinstance(value, str):
        if style.no_str:
            return f"<string length: <{len(value)}>>"
        return value if style.truncate is None or len(value) <= style.truncate else value[: style.truncate] + "..."
    if isinstance(value, (bool, int, float)):
        return value
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, (list, tuple, np.ndarray)):
        cut = style.truncate is not None and len(value) > style.truncate
        shown = value[: style.truncate] if cut else value
        items = shown.tolist() if isinstance(shown, np.ndarray) else [to_plain_value(v, style, store) for v in shown]
        return [*items, "..."] if cut else items
    return message_to_dict(value, style, store)


def _node_type(node: FieldNode) -> str:
    return str(node[1] if int(node[0]) == NAME else node[1][0])


def _array_summary(value: Sized, node: FieldNode) -> str:
    inner, size = node[1]
    kind = _node_type(inner)
    if int(node[0]) == ARRAY:
        return f"<array type: {kind}[{size}]>"
    return f"<sequence type: {kind}{f'[{size}]' if size else ''}, length: {len(value)}>"


def message_to_yaml(message: Message, style: TextStyle = FULL_TEXT, store: Typestore | None = None) -> str:
    """Format a message as YAML, ending with a line break."""
    return to_yaml(message_to_dict(message, style, store), flow=style.flow)


def to_yaml(value: object, *, flow: bool | None = False) -> str:
    """Format plain values as YAML without line wrapping; mappings keep their order."""
    import yaml

    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    return str(
        yaml.dump(value, Dumper=dumper, allow_unicode=True, width=_WIDEST, default_flow_style=flow, sort_keys=False)
    )


def message_to_csv(message: Message, style: TextStyle = FULL_TEXT, store: Typestore | None = None) -> str:
    """Format all numbers and strings of a message as comma-separated values, in the order of its fields."""
    parts = []
    for name, node in field_nodes(message.__msgtype__, store):
        value = field_value(message, name)
        if style.no_arr and int(node[0]) in (ARRAY, SEQUENCE):
            parts.append(_array_summary(value, node))
        else:
            parts.extend(_csv_values(value, style, store))
    return ",".join(parts)


def _csv_values(value: FieldValue, style: TextStyle, store: Typestore | None) -> Iterator[str]:
    if is_message(value):
        yield message_to_csv(value, style, store)
    elif isinstance(value, (list, tuple, np.ndarray)):
        for index, item in enumerate(value):
            if style.truncate is not None and index >= style.truncate:
                yield "..."
                return
            yield from _csv_values(item, style, store)
    else:
        yield str(to_plain_value(value, style, store))


def to_python(value: FieldValue, store: Typestore | None = None) -> str:
    """Format a message as rclpy does: `geometry_msgs.msg.Point(x=0.0, y=0.0, z=1.0)`."""
    if is_message(value):
        name = value.__msgtype__.replace("/", ".")
        fields = field_nodes(value.__msgtype__, store)
        inside = ", ".join(f"{n}={_python_field(field_value(value, n), node, store)}" for n, node in fields)
        return f"{name}({inside})"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(to_python(v, store) for v in value) + "]"
    return repr(to_plain_value(value, FULL_TEXT, store))


def _python_field(value: FieldValue, node: FieldNode, store: Typestore | None) -> str:
    if int(node[0]) == ARRAY and isinstance(value, np.ndarray):
        return repr(value)
    return repr(value.tolist()) if isinstance(value, np.ndarray) else to_python(value, store)


def field_text(value: FieldValue, node: FieldNode | None, store: Typestore | None = None) -> str:
    """Format one field, as `ros2 topic echo --field` prints a value that is not a message."""
    if isinstance(value, np.ndarray):
        inner = node[1][0] if node is not None and int(node[0]) in (ARRAY, SEQUENCE) else None
        code = NUMBER_CODES.get(_node_type(inner)) if inner is not None else None
        if int(node[0] if node is not None else 0) == SEQUENCE and code is not None:
            return f"array('{code}', {value.tolist()!r})" if len(value) else f"array('{code}')"
        return str(value)
    if isinstance(value, (list, tuple)):
        return to_python(value, store)
    return str(value.item() if isinstance(value, np.generic) else value)


def field_at_path(message: Message, path: str, store: Typestore | None = None) -> _TypedValue:
    """Return the value at a path such as `pose.pose.position.x`, `transforms[0].child_frame_id` or `ranges[0:9]`.

    Returns:
        The value, and its type in the type store (None for an item of an array).

    Raises:
        MessageError: a field is unknown; the message suggests the closest name.
    """
    value, node = message, None
    walked, at = "", 0
    text = path.strip().strip(".")
    while at < len(text):
        if text[at] == "." and walked:
            at += 1
        step = _STEP.match(text, at)
        if step is None:
            raise MessageError(f"{path!r} is not a field path such as pose.position.x or ranges[0]")
        if step[1] is not None:
            value, node = _step_into_field(value, step[1], walked, store)
        else:
            value, node = _step_into_item(value, step, node, walked or "message")
        walked += ("." if step[1] is not None and walked else "") + step[0]
        at = step.end()
    return value, node


def _step_into_field(value: FieldValue, name: str, walked: str, store: Typestore | None) -> _TypedValue:
    if not is_message(value):
        raise MessageError(f"{walked!r} is not a message and has no field {name!r}")
    fields = dict(field_nodes(value.__msgtype__, store))
    if name not in fields:
        hint = did_you_mean(name, fields) or "its fields: " + (", ".join(fields) or "none")
        raise MessageError(f"{value.__msgtype__} has no field {name!r}; {hint}")
    return field_value(value, name), fields[name]


def _step_into_item(value: FieldValue, item: re.Match[str], node: FieldNode | None, walked: str) -> _TypedValue:
    if not isinstance(value, (list, tuple, np.ndarray)):
        raise MessageError(f"{walked!r} is not an array and has no item {item[0]}")
    if item[3]:
        return value[int(item[2]) if item[2] else None : int(item[4]) if item[4] else None], node
    try:
        return value[int(item[2])], None
    except (IndexError, ValueError):
        raise MessageError(f"{walked!r} has {counted(len(value), 'item')}, found {item[0]}") from None
