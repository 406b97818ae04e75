"""Stereo cameras of Gazebo Classic as ROS 1 has them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.classic.camera import TriggeredCameraOptions, connect_stereo, connect_trigger
from simkit.plugins.classic.camera_settings import CameraNames, CameraPlugin
from simkit.plugins.options import OptionsOf

if TYPE_CHECKING:
    from simkit.sensors.cameras.multicamera import MultiCamera


class GazeboRosMultiCamera(CameraPlugin):
    """Publishes the cameras below `<cameraName>/left` and `<cameraName>/right`, others below their own name.

    What is left and right is in the cameras' names. `<hackBaseline>` [m] stands in the right one's projection matrix,
    else what the cameras' poses give.
    """

    filenames = ("libgazebo_ros_multicamera.so",)

    def load(self, parent: MultiCamera, params: Params) -> None:
        if connect_multicamera(self, parent) is None:
            self.refuse(parent, "multicamera")


class GazeboRosTriggeredMultiCamera(CameraPlugin):
    """The same, with pictures after a message on `<triggerTopicName>` (`image_trigger`) below `<cameraName>`."""

    options = OptionsOf(TriggeredCameraOptions)
    filenames = ("libgazebo_ros_triggered_multicamera.so",)

    def load(self, parent: MultiCamera, params: Params) -> None:
        names = connect_multicamera(self, parent)
        if names is None:
            self.refuse(parent, "multicamera")
        else:
            connect_trigger(self, parent, names)


def connect_multicamera(plugin: CameraPlugin, sensor: MultiCamera) -> CameraNames | None:
    """Names the topics; None where the sensor is no multicamera."""
    if not hasattr(sensor, "eyes"):
        return None
    names = CameraNames(plugin, sensor, is_ros_1=True)
    connect_stereo(plugin, sensor, names, _side)
    return names


def _side(name: str) -> str:
    return next((side for side in ("left", "right") if side in name), name)
