"""What the sensor plugins of Gazebo Classic have in common: where they publish, and in which frame."""

from __future__ import annotations

from typing import Any

from simkit.params import Params
from simkit.plugins.base import SensorPlugin


def given_frame(sensor: Any, params: Params) -> str:
    """`<frame_name>` (`<frameName>` in ROS 1), else the plain name of the sensor's link."""
    name = params.text("frame_name", "") or params.text("frameName", "")
    return name or sensor.scene.parent.rsplit("::", 1)[-1]


def topic_of(plugin: SensorPlugin, private: str, old_element: str) -> str:
    """The topic behind `~/<private>`; ROS 1 files name it in `old_element` instead."""
    old = plugin.params.text(old_element, "")
    return plugin.ros.topic(old if old else f"~/{private}")
