"""What the elements of a plugin mean, as far as their text tells: numbers, vectors, poses, truth values, texts."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from simkit.params import Params

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|[+-]?(inf|infinity)", re.IGNORECASE)
_TRUTHS = {"true", "false"}
_POSES = ("pose", "offset", "origin", "transform")


@dataclass(frozen=True)
class Element:
    """What all elements of one name have in common.

    Attributes:
        name: of the element; of an attribute with `@` before it.
        kind: "boolean", "number", "vector", "pose", "text" or "block".
        values: the texts found, in document order, those of the first plugin first.
        size: how many numbers a vector has.
        repeated: whether one plugin has several.
        children: what is in a block.
    """

    name: str
    kind: str
    values: tuple[str, ...] = ()
    size: int = 1
    repeated: bool = False
    children: tuple[Element, ...] = field(default=())

    @property
    def depth(self) -> int:
        """How many blocks are within each other; 0 for a value."""
        return 1 + max((c.depth for c in self.children), default=0) if self.kind == "block" else 0


def elements_of(blocks: Sequence[Params], leave_out: frozenset[str] = frozenset()) -> tuple[Element, ...]:
    """The elements of several plugins of one library, in the order in which they first come.

    Args:
        blocks: their parameters.
        leave_out: names that are read elsewhere.
    """
    names = dict.fromkeys(c.name for block in blocks for c in block.children)
    wanted = [name for name in names if ":" not in name and name not in leave_out]
    return tuple(_element(name, [[c for c in b.children if c.name == name] for b in blocks]) for name in wanted)


def _element(name: str, by_plugin: Sequence[Sequence[Params]]) -> Element:
    found = [element for one in by_plugin for element in one]
    repeated = any(len(one) > 1 for one in by_plugin)
    attributes = dict.fromkeys(a for e in found for a in e.attributes)
    children = elements_of(found)
    if children or (attributes and any(":" not in a for a in attributes)):
        texts = tuple(e.value for e in found if e.value)
        own = tuple(_of_texts(f"@{a}", [e.attributes[a] for e in found if a in e.attributes]) for a in attributes)
        return Element(name, "block", texts, repeated=repeated, children=own + children)
    return _of_texts(name, [e.value for e in found], repeated)


def _of_texts(name: str, texts: Sequence[str], repeated: bool = False) -> Element:
    values = tuple(text.strip() for text in texts)
    words = [value.split() for value in values]
    if all(value.lower() in {*_TRUTHS, "0", "1"} for value in values) and _TRUTHS & {v.lower() for v in values}:
        return Element(name, "boolean", values, repeated=repeated)
    sizes = {len(w) for w in words}
    if len(sizes) == 1 and 0 not in sizes and all(_NUMBER.fullmatch(n) for w in words for n in w):
        size = sizes.pop()
        endless = any("inf" in n.lower() for w in words for n in w)
        if size == 1:
            return Element(name, "number", values, repeated=repeated)
        if size == 6 and not endless and any(word in name.lower() for word in _POSES):
            return Element(name, "pose", values, size, repeated)
        if not endless:
            return Element(name, "vector", values, size, repeated)
    return Element(name, "text", values, repeated=repeated)
