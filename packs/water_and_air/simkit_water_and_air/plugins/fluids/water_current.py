"""Velocity of the water on a topic, for the plugins whose links move in it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.plugins.one_time_warnings import are_usable

if TYPE_CHECKING:
    from simkit.msgs import Message

TWIST: Final = "geometry_msgs/msg/TwistStamped"
VECTOR: Final = "geometry_msgs/msg/Vector3"
LAYERS: Final = "dave_gazebo_ros_plugins/msg/StratifiedCurrentVelocity"
"""Type of messages with the velocity of the water at several depths."""
CURRENT_TYPES: Final = (TWIST, VECTOR)
"""Types of messages with the velocity of the water [m/s], in world axes."""


def current_of(message: Message) -> tuple[float, float, float] | None:
    """Return the velocity in a message of one of `CURRENT_TYPES`; None if a number is NaN or infinite."""
    vector = message.twist.linear if hasattr(message, "twist") else message
    velocity = float(vector.x), float(vector.y), float(vector.z)
    return velocity if are_usable(*velocity) else None


def current_message(time_ns: int, velocity: tuple[float, float, float]) -> Message:
    """Return the message with a velocity of the water [m/s] in world axes."""
    linear = dict(zip("xyz", velocity, strict=True))
    return msgs.make(TWIST, header=msgs.header(time_ns, "/world"), twist={"linear": linear})


def absolute_topic(name: str) -> str:
    """Return the topic for a name of Gazebo's transport, which has no namespace of its own."""
    return "/" + name.strip("/")
