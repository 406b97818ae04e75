"""Depth cameras of Gazebo Classic as ROS 1 has them."""

from __future__ import annotations

import math
from typing import Any

from simkit.params import Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.classic import camera_settings
from simkit.plugins.classic.camera import connect_camera, image_topics
from simkit.plugins.classic.camera_settings import CameraNames

_CUTOFF, _CUTOFF_MAX = 0.4, 5.0  # [m] where the file says nothing
_NOT_DRAWN = {
    "reflectanceTopicName": "there is no reflectance",
    "normalsTopicName": "there are no normals",
    "reduceNormals": "there are no normals",
}


class GazeboRosDepthCamera(SensorPlugin):
    """Publishes a depth camera below `<cameraName>`, in `<frameName>` or the link's frame, which are optical frames.

    Topics: `<imageTopicName>` (image_raw), `<cameraInfoTopicName>` (camera_info), `<depthImageTopicName>`
    (depth/image_raw), `<depthImageCameraInfoTopicName>` (depth/camera_info), `<pointCloudTopicName>` (points). Depths
    of at most `<pointCloudCutoff>` [m] (0.4) are NaN, in the image and in the cloud; with `<useDepth16UC1Format>` the
    image is in millimetres, and 0 there. Otherwise as `libgazebo_ros_camera.so` in ROS 1.
    """

    filenames = ("libgazebo_ros_depth_camera.so",)

    def load(self, parent: Any, params: Params) -> None:
        near = params.number("pointCloudCutoff", _CUTOFF, minimum=0, maximum=camera_settings.FARTHEST)
        connect_depth_camera(self, parent, near, math.inf)
        camera_settings.report_without_effect(self, _NOT_DRAWN)


class GazeboRosOpenniKinect(SensorPlugin):
    """The same, with NaN from `<pointCloudCutoffMax>` [m] (5) on as well."""

    filenames = ("libgazebo_ros_openni_kinect.so",)

    def load(self, parent: Any, params: Params) -> None:
        names = "pointCloudCutoff", "pointCloudCutoffMax"
        connect_depth_camera(self, parent, *camera_settings.read_depths(params, *names, _CUTOFF, _CUTOFF_MAX))


def connect_depth_camera(plugin: SensorPlugin, sensor: Any, near: float, far: float) -> None:
    """Publishes a depth camera, with depths between `near` and `far` [m] only."""
    params = plugin.params
    in_millimetres = params.boolean("useDepth16UC1Format", False)
    if not camera_settings.is_camera(plugin, sensor, "depth", "points"):
        return
    names = CameraNames(plugin, sensor, is_ros_1=True)
    sensor.crop_depth_images(near, far, in_millimetres=in_millimetres)
    sensor.crop_clouds(near, far)
    topics = {
        "depth_image": params.text("depthImageTopicName", "depth/image_raw"),
        "depth_camera_info": params.text("depthImageCameraInfoTopicName", "depth/camera_info"),
        "points": params.text("pointCloudTopicName", "points"),
    }
    connect_camera(
        plugin, sensor, names, image_topics(names) | {name: names.topic(topic) for name, topic in topics.items()}
    )
