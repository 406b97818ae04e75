"""Topics and frames that a sensor has where its file names none."""

from __future__ import annotations

from simkit.msgs.topics import valid_topic
from simkit.params import Params
from simkit.scene import SceneSensor


def entity_topic(world: str, sensor: SceneSensor, suffix: str = "") -> str:
    """`/world/<w>/model/<m>[/model/<nested>]/link/<l>/sensor/<s>[/<suffix>]`; a joint's sensor has `joint`."""
    *models, owner = sensor.parent.split("::")
    parts = ["world", world]
    for model in models:
        parts += ["model", model]
    parts += ["joint" if sensor.on_joint else "link", owner, "sensor", sensor.name]
    return valid_topic("/".join([*parts, suffix] if suffix else parts))


def sibling_topic(topic: str, name: str) -> str:
    """The topic beside another: `/a/image` and `camera_info` give `/a/camera_info`."""
    return topic.rsplit("/", 1)[0] + "/" + name


def given_frame(params: Params) -> str:
    """The frame that the sensor's block names, in today's spelling or an older one; empty where it names none."""
    names = [params.text(element, "") for element in ("frame_id", "gz_frame_id", "ignition_frame_id")]
    return next((name for name in names if name), "")


def check_topic(topic: str, block: Params, element: str = "topic") -> None:
    """Reports a `<topic>`, or other element of a block, of which no character may stand in a topic's name."""
    if topic and valid_topic(topic) == "/":
        found = f"found <{element}>{topic}</{element}>"
        block.block(element).error("SK-PARAM-002", f"{found}, allowed is a name with a letter or a digit")
