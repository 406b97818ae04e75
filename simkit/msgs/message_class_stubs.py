"""Generator of the stubs of all message classes.

python -m simkit.msgs.message_class_stubs > simkit/msgs/message_classes.pyi
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from itertools import groupby

from simkit.msgs.definition_parser import ARRAY, BASE, NAME, SEQUENCE, FieldNode
from simkit.msgs.message_types import class_names, type_store

_HEAD = '''# Written by `python -m simkit.msgs.message_class_stubs`; a test compares it with the definitions.
# ruff: noqa
# fmt: off
"""Fields of every message class: `from simkit.msgs import LaserScan`."""

from dataclasses import dataclass
from typing import ClassVar, Generic, type_check_only

import numpy as np
from numpy.typing import NDArray

from simkit.msgs.message_types import F, M, R

@type_check_only
class ServiceRequest(Generic[M, R]):
    """Request of the class `M`, to which a response of the class `R` belongs. No message has this base at run time."""

@type_check_only
class ActionGoal(Generic[M, R, F]):
    """Goal of the class `M`, with results of the class `R` and feedback of the class `F`. Not a base at run time."""
'''
_SCALARS = {"bool": "bool", "string": "str", "wstring": "str", "float32": "float", "float64": "float"}
_PARTS = {"ServiceRequest": ("Request", "Response"), "ActionGoal": ("Goal", "Result", "Feedback")}
_DTYPES = {"bool": "bool_", "byte": "uint8", "char": "uint8"}


def stub_text() -> str:
    """Return the text of `message_classes.pyi`."""
    classes = {type_name: class_name for class_name, type_name in class_names().items()}
    lines = [_HEAD]
    for package, type_names in groupby(sorted(classes), key=lambda name: name.split("/")[0]):
        lines += [f"# {package}", ""]
        for type_name in type_names:
            lines += [*_class_lines(type_name, classes), ""]
    names = "".join(f'    "{name}",\n' for name in sorted(classes.values()))
    return "\n".join([*lines, f"__all__: list[str] = [\n{names}]\n"])


def _class_lines(type_name: str, classes: dict[str, str]) -> Iterator[str]:
    from rosbags.typesys.base import normalize_fieldname

    constants, fields = type_store().fielddefs[type_name]
    yield "@dataclass"
    yield f"class {classes[type_name]}{_base(type_name, classes)}:"
    yield f'    """`{type_name}`"""'
    for name, node in fields:
        default = " = 0" if name == "structure_needs_at_least_one_member" else ""
        yield f"    {normalize_fieldname(name)}: {_annotation(node, classes)}{default}"
    for name, base, value in constants:
        yield f"    {normalize_fieldname(name)}: ClassVar[{_SCALARS.get(base, 'int')}] = {value!r}"
    yield "    __msgtype__: ClassVar[str]"


def _base(type_name: str, classes: dict[str, str]) -> str:
    """Return the base of a request or goal, which names the classes that belong to it; empty for other messages."""
    interface, _, part = type_name.rpartition("_")
    for generic, parts in _PARTS.items():
        if part == parts[0] and f"{interface}_{parts[1]}" in classes:
            return f"({generic}[{', '.join(classes[f'{interface}_{name}'] for name in parts)}])"
    return ""


def _annotation(node: FieldNode, classes: dict[str, str]) -> str:
    """Return the annotation of a field with this type."""
    kind, content = node
    if kind == NAME:
        return classes[content]
    if kind == BASE:
        return _SCALARS.get(content[0], "int")
    assert kind in (ARRAY, SEQUENCE)
    (inner_kind, inner), _ = content
    if inner_kind == BASE and "string" not in inner[0]:
        return f"NDArray[np.{_DTYPES.get(inner[0], inner[0])}]"
    return f"list[{_annotation((inner_kind, inner), classes)}]"


if __name__ == "__main__":
    sys.stdout.write(stub_text())
