"""Conversions between message types with the same content, such as `Twist` and `TwistStamped`.

Gazebo's bridge maps several ROS types to one type of Gazebo. A simulation publishes one of them; the others follow from
it by these rules.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import cache, partial
from typing import Final

from simkit import msgs
from simkit.msgs.message_types import Message, type_of

Conversion = Callable[[Message, int], Message]
"""Function that converts a message; its second argument is the time for a new header [ns]."""

_HEADER: Final = "std_msgs/msg/Header"
_POSE: Final = "geometry_msgs/msg/Pose"
_TRANSFORM: Final = "geometry_msgs/msg/Transform"
_POINTS: Final = frozenset(("geometry_msgs/msg/Point", "geometry_msgs/msg/Vector3"))


@cache
def conversion(source: str, target: str) -> Conversion | None:
    """Return the function that converts messages of a type to another one; None if there is none.

    Args:
        source: ROS 2 type of the messages, such as `geometry_msgs/msg/Twist`.
        target: ROS 2 type of the result.
    """
    if source == target:
        return _unchanged
    if (source, target) == ("tf2_msgs/msg/TFMessage", "geometry_msgs/msg/PoseArray"):
        return _pose_array
    direct = _direct(source, target)
    if direct is not None:
        return direct
    inner_source, inner_target = _inner(source), _inner(target)
    if inner_source is not None and inner_target is not None:
        inner = _unchanged if inner_source[1] == inner_target[1] else _direct(inner_source[1], inner_target[1])
        return None if inner is None else partial(_restamp, inner, inner_source[0], target, inner_target[0])
    if inner_target is not None:
        inner = _unchanged if source == inner_target[1] else _direct(source, inner_target[1])
        return None if inner is None else partial(_stamp, inner, target, inner_target[0])
    if inner_source is not None:
        inner = _unchanged if inner_source[1] == target else _direct(inner_source[1], target)
        return None if inner is None else partial(_unstamp, inner, inner_source[0])
    return None


def _direct(source: str, target: str) -> Conversion | None:
    """Return the conversion between two types without headers; None if there is none."""
    if (source, target) == (_POSE, _TRANSFORM):
        return lambda message, _: msgs.make(
            _TRANSFORM, translation=_xyz(message.position), rotation=message.orientation
        )
    if (source, target) == (_TRANSFORM, _POSE):
        return lambda message, _: msgs.make(_POSE, position=_xyz(message.translation), orientation=message.rotation)
    if source != target and {source, target} == _POINTS:
        return lambda message, _: msgs.make(target, **_xyz(message))
    return None


@cache
def _inner(type_name: str) -> tuple[str, str] | None:
    """Return name and type of the field beside the header of a type such as `TwistStamped`; None for other types."""
    fields = [(field.name, str(field.type).replace("__", "/")) for field in dataclasses.fields(type_of(type_name))]
    names = [(name, kind) for name, kind in fields if name not in ("/msgtype/", "__msgtype__")]
    if ("header", _HEADER) not in names:
        return None
    others = [each for each in names if each[0] not in ("header", "child_frame_id")]
    return others[0] if len(others) == 1 and "/msg/" in others[0][1] else None


def _xyz(point: Message) -> dict[str, float]:
    return {"x": point.x, "y": point.y, "z": point.z}


def _unchanged(message: Message, _: int) -> Message:
    return message


def _stamp(inner: Conversion, target: str, name: str, message: Message, time_ns: int) -> Message:
    return msgs.make(target, header=msgs.header(time_ns, ""), **{name: inner(message, time_ns)})


def _unstamp(inner: Conversion, name: str, message: Message, time_ns: int) -> Message:
    return inner(getattr(message, name), time_ns)


def _restamp(inner: Conversion, old: str, target: str, new: str, message: Message, time_ns: int) -> Message:
    return msgs.make(target, header=message.header, **{new: inner(getattr(message, old), time_ns)})


def _pose_array(message: Message, time_ns: int) -> Message:
    poses = [
        msgs.make(_POSE, position=_xyz(each.transform.translation), orientation=each.transform.rotation)
        for each in message.transforms
    ]
    header = message.transforms[0].header if message.transforms else msgs.header(time_ns, "")
    return msgs.make("geometry_msgs/msg/PoseArray", header=header, poses=poses)


# ---------------------------------------------------------------------- frames


TYPES_WITH_FRAMES: Final = frozenset(
    (
        *("tf2_msgs/msg/TFMessage", "geometry_msgs/msg/TransformStamped", "geometry_msgs/msg/PoseStamped"),
        *("geometry_msgs/msg/PoseArray", "nav_msgs/msg/Odometry"),
    )
)
"""Types whose messages have names of entities as frames."""


def with_ros_frames(message: Message) -> Message:
    """Return a message with frames such as `robot/base` instead of Gazebo's `robot::base`, as Gazebo's bridge does."""
    if message.__msgtype__ not in TYPES_WITH_FRAMES:
        return message
    if message.__msgtype__ == "tf2_msgs/msg/TFMessage":
        transforms = [with_ros_frames(each) for each in message.transforms]
        if all(new is old for new, old in zip(transforms, message.transforms, strict=True)):
            return message
        return dataclasses.replace(message, transforms=transforms)
    child = getattr(message, "child_frame_id", "")
    if "::" not in message.header.frame_id and "::" not in child:
        return message
    header = dataclasses.replace(message.header, frame_id=message.header.frame_id.replace("::", "/"))
    changed = {"child_frame_id": child.replace("::", "/")} if child else {}
    return dataclasses.replace(message, header=header, **changed)
