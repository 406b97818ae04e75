"""Trees of elements as XML text."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from html import escape

from simkit.params import Params
from simkit.pose import Pose
from simkit.scene.simkit_elements import written_name

_KNOWN = {
    "gz": "http://gazebosim.org/schema",
    "ignition": "http://ignitionrobotics.org/schema",
    "experimental": "http://sdformat.org/schemas/experimental",
    "simkit": "urn:simkit",
}
_ILLEGAL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]")


def element(name: str, text: str = "", children: Iterable[Params | None] = (), /, **attributes: str) -> Params:
    """An element; children that are None are left out."""
    return Params(name, text, attributes, [c for c in children if c is not None])


def number(value: float) -> str:
    """The shortest text that is read as the same number; `inf` and `-inf` too."""
    value = float(value)
    text = repr(value)
    return text.removesuffix(".0") if text != "-0.0" else "0"


def numbers(values: Iterable[float]) -> str:
    return " ".join(number(v) for v in values)


def pose(value: Pose, **attributes: str) -> Params | None:
    """`<pose>`, or None for none at all where there is no attribute to say.

    Angles where they say the same rotation to 1e-12, else a quaternion.
    """
    x, y, z = (float(v) for v in value.position)
    roll, pitch, yaw = (float(v) for v in value.rpy)
    again = Pose.from_rpy(x, y, z, roll, pitch, yaw).quaternion
    w = [float(v) for v in value.quaternion]
    same = min(
        sum(abs(a - b) for a, b in zip(again, w, strict=True)), sum(abs(a + b) for a, b in zip(again, w, strict=True))
    )
    if same > 1e-12:
        text = numbers((x, y, z, w[1], w[2], w[3], w[0]))
        return Params("pose", text, {**attributes, "rotation_format": "quat_xyzw"})
    text = numbers((x, y, z, roll, pitch, yaw))
    return Params("pose", text, dict(attributes)) if attributes or text != "0 0 0 0 0 0" else None


def document(root: Params) -> str:
    """The file: declaration, elements indented by two spaces, our own with our prefix, the prefixes that are used."""
    root = _with_prefixes(root)
    for prefix in sorted(_prefixes(root)):
        root.attributes.setdefault(f"xmlns:{prefix}", _KNOWN.get(prefix, f"urn:{prefix}"))
    return "\n".join(['<?xml version="1.0" encoding="utf-8"?>', *_lines(root, "")]) + "\n"


def _with_prefixes(node: Params) -> Params:
    """A copy in which elements of our own have our prefix; what is inside a plugin's is its own."""
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
    found: set[str] = set()
    while stack:
        one = stack.pop()
        names: Sequence[str] = (one.name, *one.attributes)
        found |= {n.partition(":")[0] for n in names if ":" in n and not n.startswith(("xml:", "xmlns:"))}
        stack += one.children
    return {p for p in found if f"xmlns:{p}" not in node.attributes}
