"""Parts of values by name: `.x` of a pose, `.ranges` of a message."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING, Any

from simkit.errors import InputError
from simkit.msgs import Message
from simkit.pose import rpy_from_quat
from simkit.testing.conditions.bound_expression import BoundNode, ValueGetter, as_pose
from simkit.testing.conditions.syntax_tree import REMOVED_CODE, UndecidedValue
from simkit.testing.conditions.value_types import (
    JOINT,
    NUMBER,
    NUMBERS,
    ORIENTATION,
    POSE,
    TRUTH,
    TWIST,
    VECTOR,
    ValueType,
    fields_of,
    is_orientation_like,
    is_pose_like,
)

if TYPE_CHECKING:
    from simkit.runtime import Joint

AttributeGetter = tuple[ValueType, ValueGetter]

_AXES = {"x": 0, "y": 1, "z": 2}
_ANGLES = {"roll": 0, "pitch": 1, "yaw": 2}
_QUATERNION = {"w": 0, "x": 1, "y": 2, "z": 3}
_JOINT_ATTRIBUTES = ("position", "velocity", "effort", "lower", "upper")


def listed_attributes(kind: ValueType) -> list[str]:
    """What parts a value of a kind has."""
    if kind.message:
        derived = [*_ANGLES] if is_orientation_like(kind) else [*_AXES, *_ANGLES] if is_pose_like(kind) else []
        return [*fields_of(kind.message), *derived]
    if kind.has_axes:
        return [*_AXES]
    return {
        POSE: ["position", "orientation", *_AXES, *_ANGLES],
        ORIENTATION: [*_QUATERNION, *_ANGLES],
        TWIST: ["linear", "angular"],
        JOINT: [*_JOINT_ATTRIBUTES],
    }.get(kind, [])


def attribute_of(part: BoundNode, name: str) -> AttributeGetter | None:
    """A part of a value, and its kind; None where it has no such part."""
    kind = part.kind
    if kind.message:
        return _message_attribute(part, name)
    if kind is POSE:
        return _pose_attribute(part.get, name)
    if kind is JOINT:
        return _joint_attribute(part.get(), name)
    if kind is ORIENTATION:
        return _orientation_attribute(part.get, name)
    get = part.get
    if kind.has_axes and name in _AXES:
        at = _AXES[name]
        return NUMBER, lambda: float(get()[at])
    if kind is TWIST and name in ("linear", "angular"):
        which = 0 if name == "linear" else 1
        return VECTOR, lambda: get()[which]
    return None


def _pose_attribute(get: ValueGetter, name: str) -> AttributeGetter | None:
    if name in _AXES:
        at = _AXES[name]
        return NUMBER, lambda: float(get().position[at])
    if name in _ANGLES:
        turn = _ANGLES[name]
        return NUMBER, lambda: float(rpy_from_quat(get().quaternion)[turn])
    if name == "position":
        return VECTOR, lambda: get().position
    if name == "orientation":
        return ORIENTATION, lambda: get().quaternion
    return None


def _orientation_attribute(get: ValueGetter, name: str) -> AttributeGetter | None:
    """Of a quaternion w, x, y, z."""
    if name in _QUATERNION:
        at = _QUATERNION[name]
        return NUMBER, lambda: float(get()[at])
    if name in _ANGLES:
        turn = _ANGLES[name]
        return NUMBER, lambda: float(rpy_from_quat(get())[turn])
    return None


def _joint_attribute(joint: Joint, name: str) -> AttributeGetter | None:
    """Of the handle of a joint: a number for each degree of freedom, which is one number for most."""
    if name not in _JOINT_ATTRIBUTES:
        return None
    read = attrgetter(name)

    def value() -> Any:
        try:
            return read(joint)
        except InputError as error:
            if error.code != REMOVED_CODE:
                raise
            raise UndecidedValue(f"{joint.scoped} was removed") from None

    if joint.dof == 1:
        return NUMBER, lambda: float(value())
    return ValueType(NUMBERS.name, item=NUMBER), value


def _message_attribute(part: BoundNode, name: str) -> AttributeGetter | None:
    get, fields = part.get, fields_of(part.kind.message)
    if name in fields:
        attribute, kind = fields[name]
        read = attrgetter(attribute)
        if kind is NUMBER:
            return kind, lambda: float(read(get()))
        if kind is TRUTH:
            return kind, lambda: bool(read(get()))
        return kind, lambda: read(get())
    if is_pose_like(part.kind):
        return _pose_attribute(as_pose(part), name)
    if is_orientation_like(part.kind) and name in _ANGLES:
        return _orientation_attribute(lambda: _quaternion(get()), name)
    return None


def _quaternion(message: Message) -> tuple[float, float, float, float]:
    return message.w, message.x, message.y, message.z
