"""Conversion of names to valid topic names."""

from __future__ import annotations

import re

from simkit.argument_checks import check_text


def absolute_name(topic: str) -> str:
    """Return a name with its leading slash; raise an error if it is not a text, or empty."""
    if type(topic) is not str or not topic:
        check_text(topic, "the name")
    return topic if topic.startswith("/") else "/" + topic


def is_hidden(name: str) -> bool:
    """Check whether a part of a name begins with `_`. ROS 2 leaves such names out of lists."""
    return any(part.startswith("_") for part in name.split("/"))


def valid_topic(name: str) -> str:
    """Convert a name to an absolute topic as gz-transport does.

    Spaces become `_`; other invalid characters and empty parts between slashes are removed.
    """
    valid = re.sub(r"[^A-Za-z0-9_/.:-]|:=", "", name.replace(" ", "_"))
    return "/" + re.sub("/{2,}", "/", valid).strip("/")


TYPES_OF_DICTS = (
    *("std_msgs/msg/Bool", "std_msgs/msg/Float64", "std_msgs/msg/String", "std_msgs/msg/Float64MultiArray"),
    *("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped", "geometry_msgs/msg/Pose"),
    *("geometry_msgs/msg/PoseStamped", "sensor_msgs/msg/JointState", "trajectory_msgs/msg/JointTrajectory"),
)
"""Types of a dict on a topic that only has subscriptions, and therefore no type. The first one that fits is used."""
