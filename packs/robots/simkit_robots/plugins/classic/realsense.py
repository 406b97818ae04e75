"""Intel RealSense cameras of Gazebo Classic's `librealsense_gazebo_plugin.so` (PAL Robotics, Intel)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, cast

from simkit import ModelPlugin, Params
from simkit.extend import Options, OptionsOf, boolean, did_you_mean, number, publishes, text
from simkit.plugins.classic import camera_settings

if TYPE_CHECKING:
    from simkit import Model
    from simkit.msgs import Image
    from simkit.sensors.cameras.rgbd_camera import RgbdCamera

_STREAMS = {"color": "color", "infrared1": "ired1", "infrared2": "ired2", "depth": "depth"}
"""Parameter prefix of each stream -> suffix of its sensor's name."""

_FOLDERS = {"color": "color", "infrared1": "infra1", "infrared2": "infra2", "depth": "depth"}
_MESSAGES = (("image_raw", "Image", "TopicName"), ("camera_info", "CameraInfo", "CameraInfoTopicName"))
_CUTOFF_MAX = 5.0  # [m], default
_SENSORS_OWN = "a stream has the <update_rate> of its sensor, as in Gazebo's plugin"


class RealSenseOptions(Options):
    """Options of `RealSense`."""

    prefix: str = text()
    range_min_depth: float = number(0.0, element="rangeMinDepth", minimum=0.0, maximum=1e30)
    range_max_depth: float = number(math.inf, element="rangeMaxDepth", minimum=0.0, finite=False)
    point_cloud: bool = boolean(element="pointCloud")
    point_cloud_topic_name: str = text("points", element="pointCloudTopicName")
    point_cloud_cutoff: float = number(0.0, element="pointCloudCutoff", minimum=0.0, maximum=1e30)
    point_cloud_cutoff_max: float = number(_CUTOFF_MAX, element="pointCloudCutoffMax", minimum=0.0, finite=False)
    color_topic_name: str = text(element="colorTopicName")
    color_camera_info_topic_name: str = text(element="colorCameraInfoTopicName")
    color_opticalframe_name: str = text(element="colorOpticalframeName")
    infrared1_topic_name: str = text(element="infrared1TopicName")
    infrared1_camera_info_topic_name: str = text(element="infrared1CameraInfoTopicName")
    infrared1_opticalframe_name: str = text(element="infrared1OpticalframeName")
    infrared2_topic_name: str = text(element="infrared2TopicName")
    infrared2_camera_info_topic_name: str = text(element="infrared2CameraInfoTopicName")
    infrared2_opticalframe_name: str = text(element="infrared2OpticalframeName")
    depth_topic_name: str = text(element="depthTopicName")
    depth_camera_info_topic_name: str = text(element="depthCameraInfoTopicName")
    depth_opticalframe_name: str = text(element="depthOpticalframeName")


class RealSense(ModelPlugin):
    """Publishes the sensors `<prefix>color`, `<prefix>depth`, `<prefix>ired1` and `<prefix>ired2` of its model.

    The topics are `<prefix>/<colorTopicName>` and so on, each with a `camera_info`, in the frames
    `<colorOpticalframeName>` and so on. Depths are in millimetres (`16UC1`), and 0 outside the range from
    `<rangeMinDepth>` to `<rangeMaxDepth>` [m]. If `<pointCloud>` is true, a point cloud in the depth camera's optical
    frame is published on `<prefix>/<pointCloudTopicName>`. Its points are NaN outside the range from
    `<pointCloudCutoff>` to `<pointCloudCutoffMax>` [m].
    """

    endpoints = (
        *(
            publishes(f"{{prefix}}/{folder}/{name}", f"sensor_msgs/msg/{kind}", named_by=(f"{stream}{element}",))
            for stream, folder in _FOLDERS.items()
            for name, kind, element in _MESSAGES
        ),
        publishes("{prefix}/points", "sensor_msgs/msg/PointCloud2", named_by=("pointCloudTopicName",)),
    )
    options = OptionsOf(RealSenseOptions)
    filenames = ("librealsense_gazebo_plugin.so",)

    def load(self, parent: Model, params: Params) -> None:
        prefix = self.options.prefix
        near, far = camera_settings.read_depths(self.options, "range_min_depth", "range_max_depth")
        _ = self.options.point_cloud, self.options.point_cloud_topic_name  # read even without a depth camera
        cloud = camera_settings.read_depths(self.options, "point_cloud_cutoff", "point_cloud_cutoff_max")
        for stream, ending in _STREAMS.items():
            topic = self._below(
                prefix, getattr(self.options, f"{stream}_topic_name") or f"{_FOLDERS[stream]}/image_raw"
            )
            info = getattr(self.options, f"{stream}_camera_info_topic_name")
            topics = topic, self._below(prefix, info) if info else topic.rsplit("/", 1)[0] + "/camera_info"
            frame = getattr(self.options, f"{stream}_opticalframe_name")
            sensor = self._find(parent, prefix + ending, "points" if stream == "depth" else "image")
            if sensor is None:
                continue
            if frame:
                sensor.set_frame_id(frame.lstrip("/"))
            if stream == "depth":
                sensor.crop_depth_images(near, far, in_millimetres=True)
                self._publish_depth(sensor, prefix, topics, cloud)
            else:
                sensor.transform_messages("image", _as_driver)
                sensor.publish_on({"image": topics[0], "camera_info": topics[1]})
        rates = ("depthUpdateRate", "colorUpdateRate", "infraredUpdateRate")
        camera_settings.report_without_effect(self, dict.fromkeys(rates, _SENSORS_OWN))

    def _publish_depth(
        self, sensor: RgbdCamera, prefix: str, topics: tuple[str, str], cloud: tuple[float, float]
    ) -> None:
        topic = self.options.point_cloud_topic_name
        products = {"depth_image": topics[0], "depth_camera_info": topics[1]}
        if self.options.point_cloud and topic:
            sensor.use_optical_cloud_axes()
            sensor.crop_clouds(*cloud)
            products["points"] = self._below(prefix, topic)
        sensor.publish_on(products)

    def _below(self, prefix: str, name: str) -> str:
        return self.ros.topic(f"{prefix}/{name.lstrip('/')}" if prefix else name)

    def _find(self, model: Model, name: str, product: str) -> RgbdCamera | None:
        """Return the model's camera with a name; None after a warning."""
        inside = model.scoped + "::"
        within = [s for scoped, s in self.sim.contents.sensors.items() if scoped.startswith(inside)]
        sensors = cast("list[RgbdCamera]", [sensor for sensor in within if hasattr(sensor, "transform_messages")])
        fitting = {s.name: s for s in sensors if product in s.products()}
        if name in fitting:
            return fitting[name]
        kind = "depth camera" if product == "points" else "camera"
        listed = ", ".join(repr(s.name) for s in sensors) or "none"
        message = f"model {model.scoped!r} has no {kind} {name!r}, so a stream is missing; its cameras are: {listed}"
        self.params.diagnostics.warning("SK-SENSOR-126", message, self.where, did_you_mean(name, fitting))
        return None


def _as_driver(image: Image) -> Image:
    """Return the image with the name that the camera's ROS driver uses for the grey encoding."""
    if image.encoding == "mono8":
        image.encoding = "8UC1"
    return image
