"""Rangers of Gazebo Classic on ROS 1: `libgazebo_ros_range.so`, a lidar of which the nearest ray counts."""

from __future__ import annotations

from typing import Any

from simkit.params import Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.classic.ray_sensor import RADIATION
from simkit.plugins.lookups import read_frame


class GazeboRosRange(SensorPlugin):
    """Publishes a `Range` on `<topicName>` (`range`), in the link's frame or `<frameName>`.

    `<fov>` [rad] is only said in the message: the rays are the sensor's. `<gaussianNoise>` [m] is on the nearest range;
    `<updateRate>` [Hz] holds where it is lower than the sensor's own.
    """

    filenames = ("libgazebo_ros_range.so",)

    def load(self, parent: Any, params: Params) -> None:
        topic = self.ros.topic(params.text("topicName", "range"))
        radiation = RADIATION[params.choice("radiation", tuple(RADIATION), "ultrasound")]
        view = params.number("fov", 0.05, minimum=0, maximum=1e6)
        stddev = params.number("gaussianNoise", 0.0, minimum=0, maximum=1e6)
        rate = params.number("updateRate", 0.0, minimum=0)
        if not hasattr(parent, "range_noise"):
            self.refuse(parent, "ray")
            return
        parent.frame_id = read_frame(parent, params)
        parent.radiation, parent.field_of_view = radiation, view
        if stddev > 0:
            parent.add_range_noise(stddev)
        if 0 < rate < (parent.update_rate or float("inf")):
            parent.set_rate(rate)
        parent.publish_on({"range": topic})
