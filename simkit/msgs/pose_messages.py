"""Poses of messages as `simkit.Pose`, and the other way round."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, overload

from simkit.argument_checks import check_kind, checked_vector, wrong_type, wrong_value
from simkit.errors import ArgumentTypeError
from simkit.msgs.definition_parser import NAME
from simkit.msgs.message_builder import builder_of
from simkit.msgs.message_text import field_nodes, is_message
from simkit.msgs.message_types import FieldValue, M, Message, named_type
from simkit.pose import Pose, checked_pose, quat_from_rpy, rpy_from_quat

if TYPE_CHECKING:
    from simkit.msgs.message_classes import Quaternion

POSE: Final = "geometry_msgs/msg/Pose"
_TRANSFORM: Final = "geometry_msgs/msg/Transform"
_QUATERNION: Final = "geometry_msgs/msg/Quaternion"
_FLAT: Final = ("x", "y", "theta")  # fields of a pose in a plane, such as those of `Pose2D`
_WRAPPING: Final = ("pose", "transform", "initial_pose")
"""Fields that contain the pose of a message, such as `Odometry.pose.pose` or `TransformStamped.transform`."""
_KINDS: Final = "a message with a pose, such as PoseStamped, Odometry or TransformStamped"


def pose(message: Message) -> Pose:
    """Return the pose of a message as a `simkit.Pose`.

    Args:
        message: `Pose`, `Transform`, `Pose2D`, or a message that contains one in its field `pose` or `transform`:
            `PoseStamped`, `PoseWithCovarianceStamped`, `Odometry`, `TransformStamped`, ….

    Raises:
        ArgumentTypeError: the message has no pose.
        ArgumentValueError: the pose has NaN or infinite numbers, or a quaternion of zeros.
    """
    part = message
    while is_message(part) and not isinstance(part, type):
        if part.__msgtype__ == POSE:
            return _pose(part.position, part.orientation)
        if part.__msgtype__ == _TRANSFORM:
            return _pose(part.translation, part.rotation)
        if all(hasattr(part, name) for name in _FLAT):
            x, y, theta = checked_vector((part.x, part.y, part.theta), "the pose of the message").tolist()
            return Pose((x, y, 0.0), quat_from_rpy(0.0, 0.0, theta))
        part = next((getattr(part, name) for name in _WRAPPING if hasattr(part, name)), None)
    if isinstance(message, Pose):
        return message
    raise wrong_type("the message", _KINDS, message)


def _pose(position: FieldValue, rotation: FieldValue) -> Pose:
    x, y, z = checked_vector((position.x, position.y, position.z), "the position of the message").tolist()
    return Pose((x, y, z), _numbers_of(rotation))


def _numbers_of(rotation: Message) -> tuple[float, float, float, float]:
    """Return a quaternion message as (w, x, y, z)."""
    numbers = (rotation.w, rotation.x, rotation.y, rotation.z)
    w, x, y, z = checked_vector(numbers, "the quaternion of the message", 4).tolist()
    if not 1e-12 < math.hypot(w, x, y, z) < math.inf:
        raise wrong_value("the quaternion of the message", "different from zero", rotation)
    return w, x, y, z


def yaw(rotation: Quaternion | Message | Pose) -> float:
    """Return the yaw [rad] of a rotation: its angle about the z axis, from -π to π.

    Args:
        rotation: quaternion message of any length, `simkit.Pose`, or a message with a pose, such as `Odometry`.

    Raises:
        ArgumentTypeError: the value has no rotation.
        ArgumentValueError: the quaternion has NaN or infinite numbers, or only zeros.
    """
    if getattr(rotation, "__msgtype__", "") == _QUATERNION:
        quaternion = Pose((0.0, 0.0, 0.0), _numbers_of(rotation)).quaternion
    else:
        try:
            quaternion = pose(rotation).quaternion
        except ArgumentTypeError:
            raise wrong_type("the rotation", f"a quaternion message, a simkit.Pose, or {_KINDS}", rotation) from None
    return float(rpy_from_quat(quaternion)[2])


@overload
def pose_message(value: Pose, type_name: type[M], header: Message = None, child_frame_id: str = "") -> M: ...


@overload
def pose_message(value: Pose, type_name: str = POSE, header: Message = None, child_frame_id: str = "") -> Message: ...


def pose_message(
    value: Pose, type_name: str | type = POSE, header: Message = None, child_frame_id: str = ""
) -> Message:
    """Return a message with a pose.

    Args:
        value: pose.
        type_name: type of the message, or its class: `geometry_msgs/msg/Pose`, `Transform`, or a type with a field
            `pose` or `transform`, such as `msgs.PoseStamped` or `msgs.TransformStamped`.
        header: time and frame, from `msgs.header`; None for time 0 and no frame.
        child_frame_id: frame of the pose, for types with this field, such as `TransformStamped`.

    Raises:
        ArgumentTypeError: the value is not a pose, or the type has no field for a pose, header or child frame.
        MessageError: the type is unknown.
    """
    checked_pose(value)
    check_kind(type_name, (str, type), "the type", "a text such as 'geometry_msgs/msg/PoseStamped', or a class of msgs")
    builder = builder_of(named_type(type_name))
    fields = _pose_fields(value, builder.name)
    if fields is None:
        raise wrong_type("the type", "that of a message with a pose, such as geometry_msgs/msg/PoseStamped", type_name)
    head = {"header": header} if header is not None else {}
    return builder.build(fields | head | ({"child_frame_id": child_frame_id} if child_frame_id else {}))


def _pose_fields(value: Pose, type_name: str) -> dict[str, FieldValue] | None:
    """Return the fields of a message with a pose; None if its type has no field for a pose."""
    x, y, z = value.position.tolist()
    names = dict(field_nodes(type_name))
    if all(name in names for name in _FLAT):
        return {"x": x, "y": y, "theta": float(value.rpy[2])}
    if type_name in (POSE, _TRANSFORM):
        place, rotation = ("position", "orientation") if type_name == POSE else ("translation", "rotation")
        numbers = dict(zip("wxyz", value.quaternion.tolist(), strict=True))
        return {place: {"x": x, "y": y, "z": z}, rotation: numbers}
    for name, (kind, inner) in names.items():
        if name in _WRAPPING and int(kind) == NAME:
            fields = _pose_fields(value, inner)
            return None if fields is None else {name: fields}
    return None
