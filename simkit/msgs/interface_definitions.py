"""Names, definitions and prototypes of messages, services and actions, as `ros2 interface` prints them."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError
from simkit.msgs import own_interfaces
from simkit.msgs.definition_parser import BASIC_TYPES, PARTS, TYPE_ALIASES
from simkit.msgs.field_units import unit_of
from simkit.msgs.message_builder import builder_of
from simkit.msgs.message_text import message_to_dict
from simkit.msgs.message_types import FieldValue, full_name, interface_parts, own_package_hint, type_store
from simkit.msgs.shipped_interfaces import definition_files, rosbags_defaults, rosbags_types

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

_TYPE = re.compile(r"^\s*([A-Za-z]\w*(?:/\w+)*)(<=\d+)?(\[[^\]]*\])?\s+[a-z]\w*\b")

_NUMBER = re.compile(r"^\s*(?:u?int\d+|float\d+)(?:\[[^\]]*\])?\s+([a-z]\w*)(?:\s|$)")


def interface_names(kind: str) -> list[str]:
    """Return the full name of every interface of a kind (`msg`, `srv` or `action`), sorted."""
    names = {name for name in (*definition_files(), *own_interfaces.names()) if f"/{kind}/" in name}
    return sorted(names.union(rosbags_types()) if kind == "msg" else names)


def full_interface_name(name: str) -> str:
    """Return the full name of a message, service or action: `std_msgs/String` is `std_msgs/msg/String`.

    Raises:
        MessageError: the name is unknown; the message suggests the closest name.
    """
    package, _, rest = name.partition("/")
    for full in (name, f"{package}/srv/{rest}", f"{package}/action/{rest}"):
        if full.count("/") == 2 and interface_parts(full) is not None:
            return full
    try:
        return full_name(name)
    except MessageError:
        known = [known for kind in ("msg", "srv", "action") for known in interface_names(kind)]
        hint = did_you_mean(name, known)
        text = f"unknown interface {name!r}; {hint}".rstrip("; ") + own_package_hint(package, known)
        raise MessageError(text) from None


def interface_text(
    type_name: str, *, comments: bool = True, all_comments: bool = False, store: Typestore | None = None
) -> str:
    """Return a type's definition, with the definitions of its fields' types indented, as `ros2 interface show` does.

    Raises:
        MessageError: the type is unknown.
    """
    return "\n".join(_lines(type_name if store else full_interface_name(type_name), 0, comments, all_comments, store))


def _lines(name: str, depth: int, comments: bool, below: bool, store: Typestore | None) -> Iterator[str]:
    package = name.split("/")[0]
    definition = _text(name, store).strip("\n")
    if comments and store is None and "#" not in definition:
        definition = _commented(name, definition)
    for line in definition.split("\n"):
        text = line.rstrip()
        if not comments:
            text = text.partition("#")[0].rstrip()
        if text or comments:
            yield "\t" * depth + text
        match = _TYPE.match(text)
        if match and match[1] not in BASIC_TYPES:
            inner = TYPE_ALIASES.get(match[1], match[1])
            inner = inner if "/" in inner else f"{package}/{inner}"
            full = inner.replace("/", "/msg/") if inner.count("/") == 1 else inner
            yield from _lines(full, depth + 1, below, below, store)


def _text(name: str, store: Typestore | None) -> str:
    """Return the text of a type's definition file, or a text made from the type store if there is no file."""
    parts = interface_parts(name) if store is None else None
    if parts is not None:
        return "---\n".join(part.text for part in parts)
    full = name if store else full_name(name)
    definition = (store or type_store()).generate_msgdef(full, ros_version=2)[0]
    text = str(definition).split("=" * 80)[0].rstrip()
    for field, value in ({} if store else rosbags_defaults(full)).items():
        text = re.sub(rf"^\S+ {field}$", rf"\g<0> {str(value).lower()}", text, flags=re.MULTILINE)
    return text


def _commented(name: str, definition: str) -> str:
    """Add a comment about the type and the units of its numbers to a shipped definition that has no comments."""
    if own_interfaces.is_known(name):
        return definition
    lines = [f"# {_type_comments()[name]}"] if name in _type_comments() else []
    for line in definition.split("\n"):
        match = _NUMBER.match(line)
        unit = unit_of(name, match[1]) if match else ""
        lines.append(f"{line.rstrip()}  # [{unit}]" if unit else line)
    return "\n".join(lines)


@cache
def _type_comments() -> dict[str, str]:
    text = Path(__file__).with_name("type_comments.toml").read_text(encoding="utf-8")
    return dict(tomllib.loads(text))


def prototype(type_name: str) -> dict[str, FieldValue]:
    """Return the fields of a message with their default values, as a template.

    For a service, these are the fields of the request; for an action, the fields of the goal.

    Raises:
        MessageError: the type is unknown.
    """
    name = full_interface_name(type_name)
    if name.split("/")[1] != "msg" and interface_parts(name) is not None:
        name += PARTS[name.split("/")[1]][0]
    return message_to_dict(builder_of(name).default())
