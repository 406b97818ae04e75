"""Types of values in expressions; the type of every node is known before the first step."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Final

from simkit import msgs

if TYPE_CHECKING:
    from simkit.msgs.definition_parser import FieldNode

_BASE, _NAME, _ARRAY = 1, 2, 3  # rosbags.interfaces.Nodetype
_NUMBERS = ("int", "uint", "float")


@dataclass(frozen=True)
class ValueType:
    """Type of a value.

    Attributes:
        name: Name for messages.
        message: ROS type of a message; empty for other values.
        item: Type of a list's items; None for other values.
        length: Fixed number of items; None if it varies.
        has_axes: True for a vector whose three numbers are x, y and z.
    """

    name: str
    message: str = ""
    item: ValueType | None = None
    length: int | None = None
    has_axes: bool = False

    @property
    def is_numbers(self) -> bool:
        """True for a list of numbers, including vectors."""
        return self.item is NUMBER

    def __str__(self) -> str:
        return f"a message ({self.message})" if self.message else self.name


NUMBER: Final = ValueType("a number")
TRUTH: Final = ValueType("true or false")
TEXT: Final = ValueType("a text")
VECTOR: Final = ValueType("a vector", item=NUMBER, length=3, has_axes=True)
NUMBERS: Final = ValueType("a list of numbers", item=NUMBER)
TRUTHS: Final = ValueType("a list of true or false", item=TRUTH)
POSE: Final = ValueType("a pose")
ORIENTATION: Final = ValueType("an orientation")
TWIST: Final = ValueType("a twist")
JOINT: Final = ValueType("a joint")

_AS_VECTOR = {f"geometry_msgs/msg/{name}" for name in ("Vector3", "Point", "Point32")}
_AS_POSE = {"geometry_msgs/msg/Pose"}
_AS_ORIENTATION = {"geometry_msgs/msg/Quaternion"}
SCAN: Final = "sensor_msgs/msg/LaserScan"


def message_type(type_name: str) -> ValueType:
    """Return the type of a ROS message."""
    return ValueType("a message", message=type_name)


def is_vector_like(kind: ValueType) -> bool:
    """Check whether a type is a list of numbers, or a message that represents a vector."""
    return kind.is_numbers or kind.message in _AS_VECTOR


def is_pose_like(kind: ValueType) -> bool:
    """Check whether a type is a pose or a message with a pose."""
    return kind is POSE or kind.message in _AS_POSE


def is_orientation_like(kind: ValueType) -> bool:
    """Check whether a type is an orientation or a message with an orientation."""
    return kind is ORIENTATION or kind.message in _AS_ORIENTATION


@cache
def fields_of(type_name: str) -> dict[str, tuple[str, ValueType]]:
    """Return the fields of a message type: name -> attribute and type."""
    name = msgs.full_name(type_name)
    named_fields: dict[str, tuple[str, ValueType]] = {}
    attributes = list(msgs.type_of(name).__dataclass_fields__)
    for (field, node), attribute in zip(msgs.type_store().fielddefs[name][1], attributes, strict=False):
        named_fields[field] = attribute, _field_type(node)
    return named_fields


def _field_type(node: FieldNode) -> ValueType:
    nodetype, what = int(node[0]), node[1]
    if nodetype == _NAME:
        return message_type(what)
    if nodetype == _BASE:
        return _base_type(what[0])
    inner, size = what
    item = _field_type(inner)
    length = size if nodetype == _ARRAY else None
    if item is NUMBER:
        return ValueType(NUMBERS.name, item=NUMBER, length=length)
    return ValueType(f"a list ({item})", item=item, length=length)


def _base_type(name: str) -> ValueType:
    if name == "string":
        return TEXT
    return TRUTH if name == "bool" else NUMBER
