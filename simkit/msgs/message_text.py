"""Messages as ROS 2's commands print them: YAML, CSV, Python, plain values; and a part of one by its path.

Every function takes the type store that the message is of, where that is not simkit's: a bag brings its own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError
from simkit.msgs.message_types import ARRAY, NAME, SEQUENCE, type_store

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

_EMPTY = "structure_needs_at_least_one_member"
NUMBER_CODES = {
    "float32": "f",
    "float64": "d",
    "int8": "b",
    "uint8": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "char": "B",
    "octet": "B",
}
"""Letters of Python's `array` (in which rclpy keeps numbers) and `struct` for the numbers of messages."""
_STEP = re.compile(r"([^.\[\]]+)|\[(-?\d*)(:?)(-?\d*)\]")
_WIDEST = 2**31 - 1


@dataclass(frozen=True)
class Style:
    """How much of a message is shown.

    Attributes:
        truncate: arrays and texts longer than this are cut; None for none.
        no_arr: arrays are told by type and length only.
        no_str: so are texts.
        flow: YAML on one line.
    """

    truncate: int | None = None
    no_arr: bool = False
    no_str: bool = False
    flow: bool = False


FULL = Style()


def fields_of(type_name: str, store: Typestore | None = None) -> list[tuple[str, Any]]:
    """Name and description of each field of a type, in order; none of a type without fields."""
    found = (store or type_store()).fielddefs[type_name][1]
    return [(name, node) for name, node in found if name != _EMPTY]


def attribute(message: Any, field: str) -> Any:
    """A field's value; one that is named like a word of Python's carries a `_` behind its name."""
    try:
        return getattr(message, field)
    except AttributeError:
        return getattr(message, f"{field}_")


def is_message(value: Any) -> bool:
    """Whether a value is a message."""
    return isinstance(getattr(value, "__msgtype__", None), str)


def plain(message: Any, style: Style = FULL, store: Typestore | None = None) -> dict[str, Any]:
    """Dicts, lists, numbers and texts, in the order of the fields."""
    return {
        name: _abbreviated(attribute(message, name), node)
        if style.no_arr and int(node[0]) in (ARRAY, SEQUENCE)
        else plain_value(attribute(message, name), style, store)
        for name, node in fields_of(message.__msgtype__, store)
    }


def plain_value(value: Any, style: Style = FULL, store: Typestore | None = None) -> Any:
    """A field's value the same way."""
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
        items = shown.tolist() if isinstance(shown, np.ndarray) else [plain_value(v, style, store) for v in shown]
        return [*items, "..."] if cut else items
    return plain(value, style, store)


def _kind(node: Any) -> str:
    return str(node[1] if int(node[0]) == NAME else node[1][0])


def _abbreviated(value: Any, node: Any) -> str:
    inner, size = node[1]
    kind = _kind(inner)
    if int(node[0]) == ARRAY:
        return f"<array type: {kind}[{size}]>"
    return f"<sequence type: {kind}{f'[{size}]' if size else ''}, length: {len(value)}>"


def yaml_of(message: Any, style: Style = FULL, store: Typestore | None = None) -> str:
    """The message as YAML, ending with a line break."""
    return dump(plain(message, style, store), flow=style.flow)


def dump(value: Any, *, flow: bool | None = False) -> str:
    """Plain values as YAML with lines of any length; mappings keep their order."""
    import yaml

    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    return str(
        yaml.dump(value, Dumper=dumper, allow_unicode=True, width=_WIDEST, default_flow_style=flow, sort_keys=False)
    )


def csv_of(message: Any, style: Style = FULL, store: Typestore | None = None) -> str:
    """All numbers and texts of a message with commas between, in the order of its fields."""
    parts = []
    for name, node in fields_of(message.__msgtype__, store):
        value = attribute(message, name)
        if style.no_arr and int(node[0]) in (ARRAY, SEQUENCE):
            parts.append(_abbreviated(value, node))
        else:
            parts.extend(_flat(value, style, store))
    return ",".join(parts)


def _flat(value: Any, style: Style, store: Typestore | None) -> Iterator[str]:
    if is_message(value):
        yield csv_of(value, style, store)
    elif isinstance(value, (list, tuple, np.ndarray)):
        for index, item in enumerate(value):
            if style.truncate is not None and index >= style.truncate:
                yield "..."
                return
            yield from _flat(item, style, store)
    else:
        yield str(plain_value(value, style, store))


def python_of(value: Any, store: Typestore | None = None) -> str:
    """A message as rclpy writes it: `geometry_msgs.msg.Point(x=0.0, y=0.0, z=1.0)`."""
    if is_message(value):
        name = value.__msgtype__.replace("/", ".")
        fields = fields_of(value.__msgtype__, store)
        inside = ", ".join(f"{n}={_python_field(attribute(value, n), node, store)}" for n, node in fields)
        return f"{name}({inside})"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(python_of(v, store) for v in value) + "]"
    return repr(plain_value(value, FULL, store))


def _python_field(value: Any, node: Any, store: Typestore | None) -> str:
    if int(node[0]) == ARRAY and isinstance(value, np.ndarray):
        return repr(value)
    return repr(value.tolist()) if isinstance(value, np.ndarray) else python_of(value, store)


def field_text(value: Any, node: Any, store: Typestore | None = None) -> str:
    """One field alone, as `ros2 topic echo --field` prints what is no message."""
    if isinstance(value, np.ndarray):
        inner = node[1][0] if node is not None and int(node[0]) in (ARRAY, SEQUENCE) else None
        code = NUMBER_CODES.get(_kind(inner)) if inner is not None else None
        if int(node[0] if node is not None else 0) == SEQUENCE and code is not None:
            return f"array('{code}', {value.tolist()!r})" if len(value) else f"array('{code}')"
        return str(value)
    if isinstance(value, (list, tuple)):
        return python_of(value, store)
    return str(value.item() if isinstance(value, np.generic) else value)


def part(message: Any, path: str, store: Typestore | None = None) -> tuple[Any, Any]:
    """What lies at a path such as `pose.pose.position.x`, `transforms[0].child_frame_id` or `ranges[0:9]`.

    Returns:
        The value, and its description in the type store (None for an item of an array).

    Raises:
        MessageError: there is no such field; names the closest.
    """
    value, node = message, None
    walked, at = "", 0
    text = path.strip().strip(".")
    while at < len(text):
        if text[at] == "." and walked:
            at += 1
        found = _STEP.match(text, at)
        if found is None:
            raise MessageError(f"{path!r} is no path of fields, such as pose.position.x or ranges[0]")
        if found[1] is not None:
            value, node = _field(value, found[1], walked, store)
        else:
            value, node = _item(value, found, node, walked or "message")
        walked += ("." if found[1] is not None and walked else "") + found[0]
        at = found.end()
    return value, node


def _field(value: Any, name: str, walked: str, store: Typestore | None) -> tuple[Any, Any]:
    if not is_message(value):
        raise MessageError(f"{walked!r} is no message and has no field {name!r}")
    fields = dict(fields_of(value.__msgtype__, store))
    if name not in fields:
        hint = did_you_mean(name, fields) or "its fields are " + (", ".join(fields) or "none")
        raise MessageError(f"{value.__msgtype__} has no field {name!r}; {hint}")
    return attribute(value, name), fields[name]


def _item(value: Any, found: re.Match[str], node: Any, walked: str) -> tuple[Any, Any]:
    if not isinstance(value, (list, tuple, np.ndarray)):
        raise MessageError(f"{walked!r} is no array and has no item {found[0]}")
    if found[3]:
        return value[int(found[2]) if found[2] else None : int(found[4]) if found[4] else None], node
    try:
        return value[int(found[2])], None
    except (IndexError, ValueError):
        raise MessageError(f"{walked!r} has {len(value)} items, found {found[0]}") from None
