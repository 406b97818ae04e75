"""Intel RealSense cameras as Gazebo Classic's `librealsense_gazebo_plugin.so` (PAL Robotics, Intel) has them."""

from __future__ import annotations

from typing import Any

from simkit.diagnostics import did_you_mean
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.classic import camera_settings

_STREAMS = {"color": "color", "infrared1": "ired1", "infrared2": "ired2", "depth": "depth"}
"""What the parameters of a stream begin with -> how its sensor's name ends."""

_TOPICS = {
    "color": "color/image_raw", "depth": "depth/image_raw",
    "infrared1": "infra1/image_raw", "infrared2": "infra2/image_raw",
}  # fmt: skip
_CUTOFF_MAX = 5.0  # [m] where the file says nothing
_SENSORS_OWN = "a stream comes at its sensor's <update_rate>, as with the plugin itself"


class RealSense(ModelPlugin):
    """On a model whose sensors are named `<prefix>color`, `<prefix>depth`, `<prefix>ired1` and `<prefix>ired2`.

    Each is published on `<prefix>/<colorTopicName>` and so on, with its `camera_info` beside it, in
    `<colorOpticalframeName>` and so on. Depths are in millimetres (`16UC1`), 0 outside `<rangeMinDepth>` to
    `<rangeMaxDepth>` [m]. With `<pointCloud>` true there is a cloud in the depth's optical frame on
    `<prefix>/<pointCloudTopicName>`, NaN outside `<pointCloudCutoff>` to `<pointCloudCutoffMax>` [m].
    """

    filenames = ("librealsense_gazebo_plugin.so",)

    def load(self, parent: Any, params: Params) -> None:
        prefix = params.text("prefix", "")
        near, far = camera_settings.read_depths(params, "rangeMinDepth", "rangeMaxDepth", 0.0)
        cloud = self._read_cloud(params)
        for stream, ending in _STREAMS.items():
            topic = self._below(prefix, params.text(f"{stream}TopicName", "") or _TOPICS[stream])
            info = params.text(f"{stream}CameraInfoTopicName", "")
            topics = topic, self._below(prefix, info) if info else topic.rsplit("/", 1)[0] + "/camera_info"
            frame = params.text(f"{stream}OpticalframeName", "")
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

    def _read_cloud(self, params: Params) -> tuple[str, float, float]:
        """Topic, nearest and farthest depth [m] of the cloud; without a topic there is none."""
        is_wanted = params.boolean("pointCloud", False)
        topic = params.text("pointCloudTopicName", "points")
        names = "pointCloudCutoff", "pointCloudCutoffMax"
        return topic if is_wanted else "", *camera_settings.read_depths(params, *names, 0.0, _CUTOFF_MAX)

    def _publish_depth(
        self, sensor: Any, prefix: str, topics: tuple[str, str], cloud: tuple[str, float, float]
    ) -> None:
        topic, near, far = cloud
        wanted = {"depth_image": topics[0], "depth_camera_info": topics[1]}
        if topic:
            sensor.use_optical_cloud_axes()
            sensor.crop_clouds(near, far)
            wanted["points"] = self._below(prefix, topic)
        sensor.publish_on(wanted)

    def _below(self, prefix: str, name: str) -> str:
        return self.ros.topic(f"{prefix}/{name.lstrip('/')}" if prefix else name)

    def _find(self, model: Any, name: str, product: str) -> Any | None:
        """The model's camera of that name, or None after a warning."""
        inside = model.scoped + "::"
        within = [s for scoped, s in self.sim.sensors.items() if scoped.startswith(inside)]
        sensors = [sensor for sensor in within if hasattr(sensor, "transform_messages")]
        fitting = {s.name: s for s in sensors if product in s.products()}
        if name in fitting:
            return fitting[name]
        kind = "depth camera" if product == "points" else "camera"
        listed = ", ".join(repr(s.name) for s in sensors) or "none"
        message = f"model {model.scoped!r} has no {kind} {name!r}, a stream is left out; its cameras are: {listed}"
        self.params.diagnostics.warning("SK-SENSOR-126", message, self.where, did_you_mean(name, fitting))
        return None


def _as_driver(image: Any) -> Any:
    """Grey as the driver names it."""
    if image.encoding == "mono8":
        image.encoding = "8UC1"
    return image
