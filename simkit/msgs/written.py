"""Interfaces as they are written down: `.msg`, `.srv` and `.action` text, prototypes, and all their names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError
from simkit.msgs.actions import ACTIONS, MESSAGES
from simkit.msgs.controller_manager import MESSAGES as CONTROL_MESSAGES
from simkit.msgs.extras import DEFINITIONS
from simkit.msgs.forms import form_of
from simkit.msgs.services import SERVICES
from simkit.msgs.store import full_name, type_store
from simkit.msgs.text import plain
from simkit.msgs.world import MESSAGES as WORLD_MESSAGES

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

_TEXTS = {**MESSAGES, **CONTROL_MESSAGES, **WORLD_MESSAGES, **DEFINITIONS}
_TYPE = re.compile(r"^\s*([A-Za-z]\w*(?:/\w+)*)(<=\d+)?(\[[^\]]*\])?\s+[a-z]\w*\b")
_BASIC = frozenset({"bool", "byte", "char", "string", "wstring", "float32", "float64"}) | {
    f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)
}


def names(kind: str) -> list[str]:
    """Every type of a kind (`msg`, `srv` or `action`), sorted."""
    if kind == "srv":
        return sorted(SERVICES)
    if kind == "action":
        return sorted(ACTIONS)
    ours = {name for name in type_store().fielddefs if "/msg/" in name}
    return sorted(ours | set(_TEXTS))


def kind_of(type_name: str) -> str:
    """The full name of a message, service or action type; `std_msgs/String` is `std_msgs/msg/String`.

    Raises:
        MessageError: none of that name; the closest is told.
    """
    package, _, rest = type_name.partition("/")
    for name in (type_name, f"{package}/srv/{rest}", f"{package}/action/{rest}"):
        if name in SERVICES or name in ACTIONS:
            return name
    try:
        return full_name(type_name)
    except MessageError:
        hint = did_you_mean(type_name, [*names("msg"), *SERVICES, *ACTIONS])
        raise MessageError(f"no interface {type_name!r} is known; {hint}".rstrip("; ")) from None


def show(type_name: str, *, comments: bool = True, all_comments: bool = False, store: Typestore | None = None) -> str:
    """The definition of a type, with those of its fields' types indented below, as `ros2 interface show` prints it.

    Raises:
        MessageError: no such type.
    """
    return "\n".join(_lines(type_name if store else kind_of(type_name), 0, comments, all_comments, store))


def _lines(name: str, depth: int, comments: bool, below: bool, store: Typestore | None) -> Iterator[str]:
    package = name.split("/")[0]
    for line in _text(name, store).strip("\n").split("\n"):
        text = line.rstrip()
        if not comments:
            text = text.partition("#")[0].rstrip()
        if text or comments:
            yield "\t" * depth + text
        found = _TYPE.match(text)
        if found and found[1] not in _BASIC:
            inner = found[1] if "/" in found[1] else f"{package}/{found[1]}"
            full = inner.replace("/", "/msg/") if inner.count("/") == 1 else inner
            yield from _lines(full, depth + 1, below, below, store)


def _text(name: str, store: Typestore | None) -> str:
    """What the file of a type holds, as far as it is known."""
    if store is None:
        for table in (SERVICES, ACTIONS, _TEXTS):
            if name in table:
                return table[name]
    found = (store or type_store()).generate_msgdef(name if store else full_name(name), ros_version=2)[0]
    return str(found).split("=" * 80)[0].rstrip()


def prototype(type_name: str, part: str = "") -> dict[str, Any]:
    """A message of a type with every field as it is when nothing is said, to be filled in.

    Args:
        type_name: of a message, service or action.
        part: `Request`, `Goal`, …; where empty the request of a service and the goal of an action.

    Raises:
        MessageError: no such type.
    """
    name = kind_of(type_name)
    if name in SERVICES:
        name = f"{name}_{part or 'Request'}"
    elif name in ACTIONS:
        name = f"{name}_{part or 'Goal'}"
    return plain(form_of(name).zero())
