"""XML text of element trees."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields
from html import escape
from typing import TYPE_CHECKING

from simkit.float_sum import float_sum
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene.simkit_elements import written_name

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

_KNOWN = {
    "gz": "http://gazebosim.org/schema",
    "ignition": "http://ignitionrobotics.org/schema",
    "experimental": "http://sdformat.org/schemas/experimental",
    "simkit": "urn:simkit",
}
_ILLEGAL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]")


def element(name: str, content: str | Iterable[Params | None] = "", /, **attributes: str) -> Params:
    """Make an element with a text or with children; children that are None are left out."""
    if isinstance(content, str):
        return Params(name, content, attributes)
    return Params(name, "", attributes, [c for c in content if c is not None])


def text_element(name: str, value: str | float | bool | tuple[float, ...]) -> Params:
    """Make an element with a value."""
    if isinstance(value, bool):
        return element(name, str(value).lower())
    if isinstance(value, tuple):
        return element(name, numbers(value))
    return element(name, value if isinstance(value, str) else number(value))


def field_elements(value: DataclassInstance, *names: str) -> list[Params]:
    """Make an element for each of some fields, with the field's name and value."""
    return [text_element(name, getattr(value, name)) for name in names]


def changed_elements(value: DataclassInstance, *names: str) -> list[Params]:
    """Make elements for the fields whose values differ from their defaults, which are the format's defaults."""
    defaults = {field.name: field.default for field in fields(value)}
    return field_elements(value, *(name for name in names if getattr(value, name) != defaults[name]))


def changed_element(name: str, value: str | float | None, default: object) -> Params | None:
    """Make an element for a value that differs from the format's default; None for the default."""
    return None if value is None or value == default else text_element(name, value)


def group_element(name: str, children: Iterable[Params | None], /, **attributes: str) -> Params | None:
    """Make an element for children; None if all of them are None."""
    present = [child for child in children if child is not None]
    return element(name, present, **attributes) if present else None


def number(value: float) -> str:
    """Return the shortest text that reads back as the same number, including `inf` and `-inf`."""
    value = float(value)
    text = repr(value)
    return text.removesuffix(".0") if text != "-0.0" else "0"


def numbers(values: Iterable[float]) -> str:
    """Return numbers as text, separated by spaces."""
    return " ".join(number(v) for v in values)


def pose(value: Pose) -> Params | None:
    """Make `<pose>`; None for the identity.

    The rotation is written as angles if they are exact to 1e-12, else as a quaternion.
    """
    x, y, z = (float(v) for v in value.position)
    roll, pitch, yaw = (float(v) for v in value.rpy)
    again = Pose.from_rpy(x, y, z, roll, pitch, yaw).quaternion
    w = [float(v) for v in value.quaternion]
    differences = (float_sum(abs(a - sign * b) for a, b in zip(again, w, strict=True)) for sign in (1, -1))
    if min(differences) > 1e-12:
        return element("pose", numbers((x, y, z, *w[1:], w[0])), rotation_format="quat_xyzw")
    text = numbers((x, y, z, roll, pitch, yaw))
    return element("pose", text) if text != "0 0 0 0 0 0" else None


def document(root: Params) -> str:
    """Return the text of a file: XML declaration, elements with two spaces of indent, and the used prefixes.

    Simkit's own elements get the prefix `simkit`.
    """
    root = _with_prefixes(root)
    for prefix in sorted(_prefixes(root)):
        root.attributes.setdefault(f"xmlns:{prefix}", _KNOWN.get(prefix, f"urn:{prefix}"))
    return "\n".join(['<?xml version="1.0" encoding="utf-8"?>', *_lines(root, "")]) + "\n"


def _with_prefixes(node: Params) -> Params:
    """Copy a tree with the `simkit` prefix on simkit's own elements. The content of plugins is not changed."""
    children = node.children if node.name == "plugin" else [_with_prefixes(child) for child in node.children]
    copies = [Params(written_name(c.name, node.name), c.value, c.attributes, c.children) for c in children]
    return Params(node.name, node.value, node.attributes, copies)


def _lines(node: Params, indent: str) -> Iterator[str]:
    attributes = "".join(f' {k}="{_escape(v)}"' for k, v in node.attributes.items())
    begin, text = f"{indent}<{node.name}{attributes}", _escape(node.value)
    if not node.children:
        yield f"{begin}>{text}</{node.name}>" if text else f"{begin}/>"
        return
    yield f"{begin}>{text}"
    for child in node.children:
        yield from _lines(child, indent + "  ")
    yield f"{indent}</{node.name}>"


def _escape(text: str) -> str:
    return _ILLEGAL.sub("", escape(text, quote=True).replace("&#x27;", "'"))


def _prefixes(node: Params) -> set[str]:
    stack: list[Params] = [node]
    prefixes: set[str] = set()
    while stack:
        child = stack.pop()
        names: Sequence[str] = (child.name, *child.attributes)
        prefixes |= {n.partition(":")[0] for n in names if ":" in n and not n.startswith(("xml:", "xmlns:"))}
        stack += child.children
    return {p for p in prefixes if f"xmlns:{p}" not in node.attributes}
