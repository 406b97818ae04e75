"""Default topics and frames of a sensor."""

from __future__ import annotations

import math

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import SceneSensor

OPTICAL_POSE = Pose.from_rpy(0.0, 0.0, 0.0, -math.pi / 2, 0.0, -math.pi / 2)
"""Pose of the optical frame (z forward, x right, y down) in the camera frame (x forward, y left, z up); REP 103."""


def entity_topic(world: str, sensor: SceneSensor, suffix: str = "") -> str:
    """Return `/world/<w>/model/<m>[/model/<nested>]/link/<l>/sensor/<s>[/<suffix>]`; a joint's sensor has `joint`."""
    *models, owner = sensor.parent.split("::")
    parts = ["world", world]
    for model in models:
        parts += ["model", model]
    parts += ["joint" if sensor.on_joint else "link", owner, "sensor", sensor.name]
    return valid_topic("/".join([*parts, suffix] if suffix else parts))


def sibling_topic(topic: str, name: str) -> str:
    """Return the topic `name` in the namespace of another topic: `/a/image` and `camera_info` give `/a/camera_info`."""
    return topic.rsplit("/", 1)[0] + "/" + name


def read_frame_id(params: Params) -> str:
    """Read the frame from the sensor's block, in the current spelling or an older one; return "" if there is none."""
    names = [params.text(element, "") for element in ("frame_id", "gz_frame_id", "ignition_frame_id")]
    return next((name for name in names if name), "")


def check_topic(topic: str, block: Params, element: str = "topic") -> None:
    """Report a `<topic>`, or another element of a block, with characters that a topic name must not contain."""
    name, problem = valid_topic(topic), f"found <{element}>{topic}</{element}>"
    if topic and name == "/":
        block.block(element).error("SK-PARAM-002", f"{problem}; expected a name with a letter or a digit")
    elif topic and name.strip("/") != topic.strip("/"):
        message = f"{problem}; expected letters, digits and _ / . : -; the topic is {name!r}, as in Gazebo"
        block.diagnostics.note("SK-SENSOR-129", message, block.block(element).where)
