"""Cameras of Gazebo Classic: `libgazebo_ros_camera.so`, and the depth cameras of ROS 1."""

from __future__ import annotations

from typing import Any

from simkit.params import Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.sensor_topics import given_frame


class GazeboRosCamera(SensorPlugin):
    """Publishes its camera below `<camera_name>` (by default the sensor's name), in the link's frame.

    Topics: `image_raw` and `camera_info`; of a depth camera also `depth/image_raw`, `depth/camera_info` and `points`.
    `<hack_baseline>` [m] stands in the projection matrix, for the right one of a stereo pair. `<triggered>` true takes
    a picture for each message on `image_trigger`. `<min_depth>` and `<max_depth>` [m] bound the depths.
    """

    filenames = ("libgazebo_ros_camera.so",)

    def load(self, parent: Any, params: Params) -> None:
        camera = params.text("camera_name", "") or params.text("cameraName", "") or parent.name
        image = params.text("imageTopicName", "image_raw")
        info = params.text("cameraInfoTopicName", "camera_info")
        triggered = params.boolean("triggered", False)
        baseline = params.number("hack_baseline", params.number("hackBaseline", 0.0))
        if not hasattr(parent, "set_baseline"):
            self.refuse(parent, "camera")
            return
        topics = {"image": f"{camera}/{image}", "camera_info": f"{camera}/{info}"}
        if parent.has_depth:
            parent.bound_depths(*_depth_range(params))
            topics["depth_image"] = f"{camera}/depth/image_raw"
            topics["depth_camera_info"] = f"{camera}/depth/camera_info"
            topics["points"] = f"{camera}/points"
        parent.frame_id = given_frame(parent, params)
        parent.set_baseline(baseline)
        parent.publish_on({product: self.ros.topic(topic) for product, topic in topics.items()})
        if triggered:
            parent.trigger_on(self.ros.topic(f"{camera}/image_trigger"))


def _depth_range(params: Params) -> tuple[float | None, float | None]:
    """Nearest and farthest depth [m]; None where the file says nothing."""
    near = params.number("min_depth", minimum=0) if params.has("min_depth") else None
    far = params.number("max_depth", minimum=0) if params.has("max_depth") else None
    return near, far
