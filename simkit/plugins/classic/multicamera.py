"""Stereo cameras of Gazebo Classic as ROS 1 has them."""

from __future__ import annotations

from typing import Any

from simkit.params import Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.classic.camera import publish_eyes, trigger
from simkit.plugins.classic.pictures import CameraNames


class GazeboRosMultiCamera(SensorPlugin):
    """Publishes the cameras below `<cameraName>/left` and `<cameraName>/right`, others below their own name.

    What is left and right is in the cameras' names. `<hackBaseline>` [m] stands in the right one's projection matrix,
    else what the cameras' poses give.
    """

    filenames = ("libgazebo_ros_multicamera.so",)

    def load(self, parent: Any, params: Params) -> None:
        if connect(self, parent) is None:
            self.refuse(parent, "multicamera")


class GazeboRosTriggeredMultiCamera(SensorPlugin):
    """The same, with pictures after a message on `<triggerTopicName>` (`image_trigger`) below `<cameraName>`."""

    filenames = ("libgazebo_ros_triggered_multicamera.so",)

    def load(self, parent: Any, params: Params) -> None:
        names = connect(self, parent)
        if names is None:
            self.refuse(parent, "multicamera")
        else:
            trigger(self, parent, names)


def connect(plugin: SensorPlugin, sensor: Any) -> CameraNames | None:
    """Names the topics; None where the sensor is no multicamera."""
    if not hasattr(sensor, "eyes"):
        return None
    names = CameraNames(plugin, sensor, is_ros_1=True)
    publish_eyes(plugin, sensor, names, _side)
    return names


def _side(name: str) -> str:
    return next((side for side in ("left", "right") if side in name), name)
