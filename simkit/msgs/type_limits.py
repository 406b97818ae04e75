"""Limits on the size of message types, checked before rosbags makes Python classes of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from simkit.msgs.definition_parser import ARRAY, BASE, LARGEST_SIZE, NAME, TEXTS, FieldNode
from simkit.number_text import counted


class DefinitionTooLarge(ValueError):
    """Error for a type that contains itself, is too large or is nested too deeply."""


_MOST_VALUES: Final = 5000  # rosbags writes lines of code for each item of a fixed array of messages
_DEEPEST: Final = 50


def check_size(type_name: str, fields_of: Callable[[str], Sequence[tuple[str, FieldNode]]]) -> None:
    """Check that a type has an end and a moderate size.

    Args:
        type_name: full name of the type.
        fields_of: function that returns the fields of a type; it raises an exception for an unknown type.

    Raises:
        DefinitionTooLarge: the type contains itself, has too many values or is nested too deeply.
    """
    known: dict[str, int] = {}
    path: list[str] = []

    def count_node(node: FieldNode) -> int:
        kind = int(node[0])
        if kind == BASE:
            return 1
        if kind == NAME:
            return count_type(node[1])
        item, length = node[1]
        if kind == ARRAY and length > LARGEST_SIZE:
            raise DefinitionTooLarge(f"an array has {counted(length, 'item')}; the largest allowed has {LARGEST_SIZE}")
        is_unrolled = kind == ARRAY and (int(item[0]) != BASE or item[1][0] in TEXTS)
        return count_node(item) * max(1, length if is_unrolled else 1)

    def count_type(name: str) -> int:
        if name in path:
            raise DefinitionTooLarge(f"{name} contains itself")
        if name not in known:
            fields = fields_of(name)
            if len(path) >= _DEEPEST:
                raise DefinitionTooLarge(f"it is nested more than {_DEEPEST} levels deep")
            path.append(name)
            known[name] = sum(count_node(node) for _, node in fields)
            path.pop()
            if known[name] > _MOST_VALUES:
                raise DefinitionTooLarge(f"{name} has more than {_MOST_VALUES} values")
        return known[name]

    count_type(type_name)
