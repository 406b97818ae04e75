"""Fields, constants and default values of a message type, in the form that the generators of classes read."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, Final, Literal

import numpy as np

from simkit.msgs.definition_parser import ARRAY, NAME, PARTS, SEQUENCE, TEXTS, FieldNode
from simkit.msgs.derived_types import derived_type, is_derived
from simkit.msgs.message_types import definition_of, full_name, type_store
from simkit.msgs.shipped_interfaces import NO_FIELD, rosbags_defaults

ARRAY_CODES: Final = {
    "float32": "f",
    "float64": "d",
    "char": "B",
    "int8": "b",
    "uint8": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
}
"""Type code of Python's `array` for each number type whose sequences ROS keeps in one block of memory.

A sequence of `bool` or `byte` is a list in ROS.
"""


@dataclass(frozen=True)
class Field:
    """Field of a message type.

    Attributes:
        name: attribute in the message of a program.
        simkit_name: attribute in the message of simkit; empty if simkit's type has no such field.
        type_name: basic type such as `float64`, or full name of a message type; the type of each item of an array.
        shape: `array` for a fixed length, `sequence` for a variable length, empty for a single value.
        size: length of an array, or largest length of a sequence; 0 for no limit.
        text_bound: largest length of a text; 0 for no limit.
        default: default value of the definition; None for zero, an empty text or an empty sequence.
    """

    name: str
    simkit_name: str
    type_name: str
    shape: Literal["", "array", "sequence"] = ""
    size: int = 0
    text_bound: int = 0
    default: object = None

    @property
    def is_message(self) -> bool:
        """True if the field has messages."""
        return "/" in self.type_name

    @property
    def is_text(self) -> bool:
        """True if the field has texts."""
        return self.type_name in TEXTS

    @property
    def array_code(self) -> str:
        """Type code of Python's `array`; empty for a single value, and for items that are not numbers in ROS."""
        return ARRAY_CODES.get(self.type_name, "") if self.shape else ""


def number_type(name: str) -> np.dtype[Any]:
    """Return NumPy's type of numbers for a type code of `array`, or for a name of NumPy.

    The code `q` alone would be `longlong`, which prints otherwise than `int64` where both have 64 bits.
    """
    return np.dtype(np.dtype(name).name)


@dataclass(frozen=True)
class MessageFields:
    """Fields and constants of one message type.

    Attributes:
        type_name: full name, such as `geometry_msgs/msg/Twist` or `example_interfaces/srv/AddTwoInts_Request`.
        constants: type and value by the name of the constant.
        fields: fields in the order of the definition.
    """

    type_name: str
    constants: dict[str, tuple[str, object]]
    fields: tuple[Field, ...]


@cache
def fields_of(type_name: str) -> MessageFields:
    """Return the fields of a message type of ROS 2, also of the types that ROS derives from services and actions.

    Raises:
        MessageError: the type is unknown.
        InterfaceError: the definition of a type of the user has errors.
    """
    from rosbags.typesys.base import normalize_fieldname

    if is_derived(type_name):
        derived_type(type_name)
    else:
        type_name = full_name(type_name)
    constants, nodes = type_store().fielddefs[type_name]
    definition = None if is_derived(type_name) else definition_of(type_name)
    defaults = definition.defaults if definition else rosbags_defaults(type_name)
    return MessageFields(
        type_name,
        {name: (kind, value) for name, kind, value in constants},
        tuple(_field(normalize_fieldname(name), node, defaults.get(name)) for name, node in nodes if name != NO_FIELD),
    )


def _field(name: str, node: FieldNode, default: object) -> Field:
    shape: Literal["", "array", "sequence"] = ""
    size, (kind, content) = 0, node
    if int(kind) in (ARRAY, SEQUENCE):
        shape = "array" if int(kind) == ARRAY else "sequence"
        (kind, content), size = content
    if int(kind) == NAME:
        return Field(name, name, content, shape, size)
    return Field(name, name, content[0], shape, size or 0, content[1] or 0, default)


def interface_part(type_name: str) -> tuple[str, str]:
    """Return the interface that a message type belongs to, and the name of its part; empty for a message.

    The parts of `example_interfaces/srv/AddTwoInts` are `Request`, `Response` and `Event`.
    """
    folder, _, short = type_name.rpartition("/")
    if folder.endswith("/msg"):
        return type_name, ""
    base, _, part = short.partition("_")
    return f"{folder}/{base}", part


def part_names(interface_name: str) -> tuple[str, ...]:
    """Return the message types of an interface's definition: its own name for a message."""
    return tuple(f"{interface_name}{part}" for part in PARTS[interface_name.split("/")[1]])
