"""Paths of the values in a block of parameters: element names with dots, then perhaps the name of an attribute.

Of several elements with one name, `name` is the first and `name[1]` the second.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator
from typing import Final

from simkit.diagnostics import Where
from simkit.params import Params
from simkit.scene.override_values import number_text

_NUMBERED: Final = re.compile(r"(.+)\[(\d+)\]")
_SPELLINGS: Final = (frozenset({"ray", "lidar", "gpu_ray", "gpu_lidar"}), frozenset({"navsat", "gps"}))
"""Names of one element in different versions of the format."""


def _index(block: Params, name: str) -> int | None:
    """Return the position of a child by its name, in any of its spellings; None if it is absent."""
    match = _NUMBERED.fullmatch(name)
    plain, number = (match[1], int(match[2])) if match else (name, 0)
    indices = [i for i, child in enumerate(block.children) if child.name == plain]
    if not indices:
        same = next((names for names in _SPELLINGS if plain in names), frozenset())
        indices = [i for i, child in enumerate(block.children) if child.name in same]
    return indices[number] if number < len(indices) else None


def has_parameter(params: Params, element: str) -> bool:
    """Check whether a block has an element or attribute."""
    head, _, rest = element.partition(".")
    at = _index(params, head)
    if at is None:
        return not rest and head in params.attributes
    return not rest or has_parameter(params.children[at], rest)


def set_parameter(params: Params, element: str, value: str, source: str) -> Params:
    """Return a copy of a block in which an element or attribute has another value; a missing element is added.

    Args:
        params: the block.
        element: path of the element, with dots.
        value: the new text.
        source: text that messages name as the file of the value.

    Raises:
        ValueError: the path names an element that holds elements, or an element of a list that is too short.
    """
    head, _, rest = element.partition(".")
    block = copy.copy(params)
    block.children = list(params.children)
    at = _index(block, head)
    if at is None and head in params.attributes and not rest and head not in ("name", "filename"):
        block.attributes = {**params.attributes, head: value}
        return block
    if at is None and not value:
        return params  # an absent element is empty
    if at is None:
        if _NUMBERED.fullmatch(head):
            raise ValueError(f"there is no element <{head}>")
        at = len(block.children)
        block.children.append(Params(head, where=Where(source), diagnostics=params.diagnostics))
    old = block.children[at]
    if rest:
        block.children[at] = set_parameter(old, rest, value, source)
        return block
    if old.children:
        inner = ", ".join(dict.fromkeys(c.name for c in old.children))
        raise ValueError(f"<{head}> holds elements; name one of them: {inner}")
    new = copy.copy(old)
    new.value, new.where = value, Where(source)
    block.children[at] = new
    return block


def parameter_values(params: Params) -> Iterator[tuple[str, str]]:
    """Yield path and text of each value in a block; a path that `set_parameter` would not understand is left out.

    If the block has an attribute `defaults`, the defaults of absent elements follow.
    """
    seen: dict[str, int] = {}
    for child in params.children:
        if "." in child.name or ":" in child.name:
            continue
        number = seen.get(child.name, 0)
        seen[child.name] = number + 1
        name = child.name if number == 0 else f"{child.name}[{number}]"
        inner = {c.name for c in child.children}
        for attribute, text in child.attributes.items():
            if (
                attribute not in inner
                and "." not in attribute
                and ":" not in attribute
                and attribute not in _NOT_VALUES
            ):
                yield f"{name}.{attribute}", text
        if child.children:
            yield from ((f"{name}.{path}", text) for path, text in parameter_values(child))
        else:
            yield name, child.value
    for name, default in getattr(params, "defaults", {}).items():
        if _index(params, name) is not None or set(".:") & set(name):
            continue
        if isinstance(default, Params):
            yield from ((f"{name}.{path}", text) for path, text in parameter_values(default))
        elif isinstance(default, (bool, int, float, str)):
            yield name, _text(default)
        elif isinstance(default, tuple) and all(isinstance(value, (int, float)) for value in default):
            yield name, " ".join(map(_text, default))


def _text(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return number_text(value) if isinstance(value, (int, float)) else str(value)


_NOT_VALUES: Final = frozenset({"name", "filename", "xmlns"})
