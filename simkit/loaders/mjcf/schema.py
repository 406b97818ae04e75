"""Check of element and attribute names against MuJoCo's own table. The check reports all unknown names at once.

MuJoCo's reader stops at the first unknown name. The table comes from MuJoCo itself and is therefore always up to date.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Final

from simkit.diagnostics import did_you_mean
from simkit.params import Params

_LINE: Final = re.compile(r"^( *)(\S+) \((.)\) *(.*)$")
_INDENT: Final = 3
_PREPROCESSED: Final[dict[str, frozenset[str]]] = {
    "include": frozenset({"file"}),
    "frame": frozenset(("name", "class", "childclass", "pos", "quat", "axisangle", "xyaxes", "zaxis", "euler")),
    "replicate": frozenset(("count", "offset", "euler", "sep", "prefix", "childclass")),
}
"""Elements that MuJoCo's reader processes before it uses its table."""
_REMOVED: Final[dict[str, frozenset[str]]] = {
    "compiler": frozenset(("convexhull", "exactmeshinertia")),
    "flag": frozenset(("sensornoise",)),
    "option": frozenset(("apirate",)),
}
"""Attributes of earlier versions that MuJoCo 4.0 refuses, by element; none of them selects what moves or collides."""


@dataclass(slots=True)
class _ElementKind:
    recursive: bool = False
    attributes: set[str] = field(default_factory=set)
    children: dict[str, _ElementKind] = field(default_factory=dict)


@lru_cache(maxsize=1)
def _schema_table(text: str) -> _ElementKind | None:
    """Parse MuJoCo's table into the kind of the outermost element; None if its layout is unknown."""
    stack: list[tuple[int, _ElementKind]] = []
    root: _ElementKind | None = None
    for line in text.splitlines():
        match = _LINE.match(line)
        if match is None:
            if stack:
                stack[-1][1].attributes.update(line.split())
            continue
        level = len(match[1]) // _INDENT
        kind = _ElementKind(match[3] == "R", set(match[4].split()))
        while stack and stack[-1][0] >= level:
            stack.pop()
        if stack:
            for name in ("worldbody", "body") if match[2] == "(world)body" else (match[2],):
                stack[-1][1].children[name] = kind
        else:
            root = kind
        stack.append((level, kind))
    body = root.children.get("body") if root is not None else None
    return root if body is not None and "geom" in body.children and "pos" in body.attributes else None


def check_names(root: Params, schema_text: str) -> None:
    """Record an error for every element and attribute that MJCF does not have, with the closest name.

    Args:
        root: the outermost element.
        schema_text: MuJoCo's own table of the format.
    """
    table = _schema_table(schema_text)
    if table is not None:
        _check_children(root, table, table)


def _check_children(element: Params, kind: _ElementKind, table: _ElementKind) -> None:
    for child in element.children:
        name = child.name
        if name in _PREPROCESSED:
            _check_attributes(child, _PREPROCESSED[name])
            _check_children(child, kind, table)
            continue
        below = kind if kind.recursive and name == _own_name(element, name) else kind.children.get(name)
        if below is None:
            known = [*kind.children, *_PREPROCESSED, *(("body", "default") if kind.recursive else ())]
            hint = did_you_mean(name, known) or _allowed_parents(name, table)
            child.error("SK-MJCF-002", f"<{element.name}> has no element <{name}>", hint)
            continue
        _check_attributes(child, below.attributes)
        _check_children(child, below, table)


def drop_removed_attributes(element: Params) -> None:
    """Remove attributes of earlier versions of MuJoCo from an element and its children, with warnings."""
    for name in sorted(_REMOVED.get(element.name, frozenset()).intersection(element.attributes)):
        del element.attributes[name]
        element.warning("SK-MJCF-016", f"<{element.name}> {name}= is of an earlier version of MuJoCo; it is ignored")
    for child in element.children:
        drop_removed_attributes(child)


def _own_name(element: Params, name: str) -> str:
    """Return `name` if a child of that name is the same kind of element (a body or a default), else an empty text."""
    if name == "body" and element.name in ("worldbody", "body", *_PREPROCESSED):
        return "body"
    return "default" if name == "default" and element.name == "default" else ""


def _check_attributes(element: Params, known: Collection[str]) -> None:
    for name, text in element.attributes.items():
        if name not in known and ":" not in name:
            hint = did_you_mean(name, known) or (f"known are {', '.join(sorted(known))}" if len(known) < 12 else "")
            shown = text if len(text) <= 40 else text[:37] + "..."
            element.error("SK-MJCF-003", f"<{element.name}> has no attribute {name!r} (= {shown!r})", hint)


def _allowed_parents(name: str, table: _ElementKind) -> str:
    """Describe the elements that may contain an element, for a hint; empty if there are none."""
    places = [f"<{p}>" for p, kind in table.children.items() if name in kind.children]
    return f"<{name}> belongs in {' or '.join(places[:3])}" if places else ""
