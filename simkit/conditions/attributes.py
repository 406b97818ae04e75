"""Parts of values by name: `.x` of a pose, `.ranges` of a message."""

from __future__ import annotations

from collections.abc import Callable
from operator import attrgetter
from typing import Any

from simkit.conditions.faults import REMOVED, Undecided
from simkit.conditions.kinds import (
    JOINT,
    NUMBER,
    NUMBERS,
    ORIENTATION,
    POSE,
    TRUTH,
    TWIST,
    VECTOR,
    Kind,
    fields_of,
    is_orientation_like,
    is_pose_like,
)
from simkit.conditions.parts import Part
from simkit.conditions.vectors import as_pose
from simkit.errors import InputError
from simkit.pose import rpy_from_quat

Found = tuple[Kind, Callable[[], Any]]

_AXES = {"x": 0, "y": 1, "z": 2}
_ANGLES = {"roll": 0, "pitch": 1, "yaw": 2}
_QUATERNION = {"w": 0, "x": 1, "y": 2, "z": 3}
_OF_JOINT = ("position", "velocity", "effort", "lower", "upper")


def listed_attributes(kind: Kind) -> list[str]:
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
        JOINT: [*_OF_JOINT],
    }.get(kind, [])


def attribute_of(part: Part, name: str) -> Found | None:
    """A part of a value, and its kind; None where it has no such part."""
    kind = part.kind
    if kind.message:
        return _of_message(part, name)
    if kind is POSE:
        return _of_pose(part.get, name)
    if kind is JOINT:
        return _of_joint(part.get(), name)
    if kind is ORIENTATION:
        return _of_orientation(part.get, name)
    get = part.get
    if kind.has_axes and name in _AXES:
        at = _AXES[name]
        return NUMBER, lambda: float(get()[at])
    if kind is TWIST and name in ("linear", "angular"):
        which = 0 if name == "linear" else 1
        return VECTOR, lambda: get()[which]
    return None


def _of_pose(get: Callable[[], Any], name: str) -> Found | None:
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


def _of_orientation(get: Callable[[], Any], name: str) -> Found | None:
    """Of a quaternion w, x, y, z."""
    if name in _QUATERNION:
        at = _QUATERNION[name]
        return NUMBER, lambda: float(get()[at])
    if name in _ANGLES:
        turn = _ANGLES[name]
        return NUMBER, lambda: float(rpy_from_quat(get())[turn])
    return None


def _of_joint(joint: Any, name: str) -> Found | None:
    """Of the handle of a joint: a number for each degree of freedom, which is one number for most."""
    if name not in _OF_JOINT:
        return None
    read = attrgetter(name)

    def value() -> Any:
        try:
            return read(joint)
        except InputError as error:
            if error.code != REMOVED:
                raise
            raise Undecided(f"{joint.scoped} was removed") from None

    if joint.dof == 1:
        return NUMBER, lambda: float(value())
    return Kind(NUMBERS.name, item=NUMBER), value


def _of_message(part: Part, name: str) -> Found | None:
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
        return _of_pose(as_pose(part), name)
    if is_orientation_like(part.kind) and name in _ANGLES:
        return _of_orientation(lambda: _quaternion(get()), name)
    return None


def _quaternion(message: Any) -> tuple[float, float, float, float]:
    return message.w, message.x, message.y, message.z
