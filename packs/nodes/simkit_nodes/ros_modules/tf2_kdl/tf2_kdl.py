"""Objects of `PyKDL` with a header, and their conversions to other frames."""

from __future__ import annotations

from typing import Any, Final

from simkit_nodes.host import current_program
from simkit_nodes.interfaces import ProgramMessage
from simkit_nodes.message_transforms import Transforms
from simkit_nodes.ros_modules.PyKDL.frames import Frame, Rotation, Twist, Vector, Wrench

__all__ = [
    "convert_vector",
    "do_transform_frame",
    "do_transform_twist",
    "do_transform_vector",
    "do_transform_wrench",
    "from_msg_vector",
    "to_msg_vector",
    "transform_to_kdl",
]


def transform_to_kdl(t: Any) -> Frame:
    """Return the frame of a `geometry_msgs.msg.TransformStamped`."""
    q, p = t.transform.rotation, t.transform.translation
    return Frame(Rotation.Quaternion(q.x, q.y, q.z, q.w), Vector(p.x, p.y, p.z))


def _transformed(value: Any, transform: ProgramMessage) -> Any:
    """Return an object in another frame, with the header of the transform."""
    result = transform_to_kdl(transform) * value
    result.header = transform.header
    return result


do_transform_vector = do_transform_frame = do_transform_twist = do_transform_wrench = _transformed

TRANSFORMS: Final[Transforms] = dict.fromkeys((Vector, Frame, Twist, Wrench), _transformed)


def to_msg_vector(vector: Any) -> Any:
    """Return a vector with a header as a `geometry_msgs.msg.PointStamped`."""
    message: ProgramMessage = current_program().flavour.message_class("geometry_msgs/msg/PointStamped")()
    message.header = vector.header
    message.point.x, message.point.y, message.point.z = vector
    return message


def from_msg_vector(msg: ProgramMessage) -> Vector:
    """Return a `geometry_msgs.msg.PointStamped` as a vector with a header."""
    vector: Any = Vector(msg.point.x, msg.point.y, msg.point.z)
    vector.header = msg.header
    return vector  # type: ignore[no-any-return]


def convert_vector(vector: Any) -> Vector:
    """Return a copy of a vector with a header."""
    copy: Any = Vector(vector)
    copy.header = vector.header
    return copy  # type: ignore[no-any-return]


TO_MESSAGE: Final = {Vector: to_msg_vector}
FROM_MESSAGE: Final = {Vector: from_msg_vector}
