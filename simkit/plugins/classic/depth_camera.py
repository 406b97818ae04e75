"""Depth cameras of Gazebo Classic as ROS 1 has them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.classic import camera_settings
from simkit.plugins.classic.camera import connect_camera, image_topics
from simkit.plugins.classic.camera_settings import CameraNames, CameraOptions, CameraPlugin
from simkit.plugins.endpoints import publishes
from simkit.plugins.options import OptionsOf, boolean, number, text, without_effect

if TYPE_CHECKING:
    from simkit.sensors.cameras.rgbd_camera import RgbdCamera

_CUTOFF, _CUTOFF_MAX = 0.4, 5.0  # [m] where the file says nothing
_NOT_DRAWN = {
    "reflectanceTopicName": "there is no reflectance",
    "normalsTopicName": "there are no normals",
    "reduceNormals": "there are no normals",
}


class Ros1DepthCameraOptions(CameraOptions):
    """Options of the depth cameras of ROS 1."""

    use_depth_16_uc_1_format: bool = boolean(element="useDepth16UC1Format")
    depth_image_topic_name: str = text("depth/image_raw", element="depthImageTopicName")
    depth_image_camera_info_topic_name: str = text("depth/camera_info", element="depthImageCameraInfoTopicName")
    point_cloud_topic_name: str = text("points", element="pointCloudTopicName")
    point_cloud_cutoff: float = number(
        _CUTOFF, "m", element="pointCloudCutoff", minimum=0, maximum=camera_settings.FARTHEST
    )


class GazeboRosDepthCameraOptions(Ros1DepthCameraOptions):
    """Options of `GazeboRosDepthCamera`."""

    reflectance_topic_name: bool = without_effect(element="reflectanceTopicName")
    normals_topic_name: bool = without_effect(element="normalsTopicName")
    reduce_normals: bool = without_effect(element="reduceNormals")


class KinectOptions(Ros1DepthCameraOptions):
    """Options of `GazeboRosOpenniKinect`."""

    point_cloud_cutoff_max: float = number(_CUTOFF_MAX, "m", element="pointCloudCutoffMax", minimum=0, finite=False)


class Ros1DepthCamera(CameraPlugin):
    """Base of the depth cameras of ROS 1."""

    endpoints = (
        *CameraPlugin.endpoints,
        publishes("{camera_name}/depth/image_raw", "sensor_msgs/msg/Image", named_by=("depthImageTopicName",)),
        publishes(
            "{camera_name}/depth/camera_info", "sensor_msgs/msg/CameraInfo", named_by=("depthImageCameraInfoTopicName",)
        ),
        publishes("{camera_name}/points", "sensor_msgs/msg/PointCloud2", named_by=("pointCloudTopicName",)),
    )
    options = OptionsOf(Ros1DepthCameraOptions)


class GazeboRosDepthCamera(Ros1DepthCamera):
    """Publishes a depth camera below `<cameraName>`, in `<frameName>` or the link's frame, which are optical frames.

    Topics: `<imageTopicName>` (image_raw), `<cameraInfoTopicName>` (camera_info), `<depthImageTopicName>`
    (depth/image_raw), `<depthImageCameraInfoTopicName>` (depth/camera_info), `<pointCloudTopicName>` (points). Depths
    of at most `<pointCloudCutoff>` [m] (0.4) are NaN, in the image and in the cloud; with `<useDepth16UC1Format>` the
    image is in millimetres, and 0 there. Otherwise as `libgazebo_ros_camera.so` in ROS 1.
    """

    options = OptionsOf(GazeboRosDepthCameraOptions)
    filenames = ("libgazebo_ros_depth_camera.so",)

    def load(self, parent: RgbdCamera, params: Params) -> None:
        connect_depth_camera(self, parent, self.options.point_cloud_cutoff, math.inf)
        camera_settings.report_without_effect(self, _NOT_DRAWN)


class GazeboRosOpenniKinect(Ros1DepthCamera):
    """The same, with NaN from `<pointCloudCutoffMax>` [m] (5) on as well."""

    options = OptionsOf(KinectOptions)
    filenames = ("libgazebo_ros_openni_kinect.so",)

    def load(self, parent: RgbdCamera, params: Params) -> None:
        depths = camera_settings.read_depths(self.options, "point_cloud_cutoff", "point_cloud_cutoff_max")
        connect_depth_camera(self, parent, *depths)


def connect_depth_camera(plugin: Ros1DepthCamera, sensor: RgbdCamera, near: float, far: float) -> None:
    """Publishes a depth camera, with depths between `near` and `far` [m] only."""
    options = plugin.options
    in_millimetres = options.use_depth_16_uc_1_format
    if not camera_settings.is_camera(plugin, sensor, "depth", "points"):
        return
    names = CameraNames(plugin, sensor, is_ros_1=True)
    sensor.crop_depth_images(near, far, in_millimetres=in_millimetres)
    sensor.crop_clouds(near, far)
    sensor.use_optical_cloud_axes()
    topics = {
        "depth_image": options.depth_image_topic_name,
        "depth_camera_info": options.depth_image_camera_info_topic_name,
        "points": options.point_cloud_topic_name,
    }
    connect_camera(
        plugin, sensor, names, image_topics(names) | {name: names.topic(topic) for name, topic in topics.items()}
    )
