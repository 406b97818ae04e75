"""Rangers of Gazebo Classic on ROS 1: `libgazebo_ros_range.so`, a lidar of which the nearest ray counts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.classic.ray_sensor import RADIATION
from simkit.plugins.endpoints import publishes
from simkit.plugins.find_entities import link_name
from simkit.plugins.options import Options, OptionsOf, choice, number, text

if TYPE_CHECKING:
    from simkit.sensors.rays.lidar import Lidar


class GazeboRosRangeOptions(Options):
    """Options of `GazeboRosRange`."""

    topic_name: str = text("range", element="topicName")
    radiation: str = choice(tuple(RADIATION), "ultrasound")
    fov: float = number(0.05, minimum=0, maximum=1e6)
    gaussian_noise: float = number(0.0, element="gaussianNoise", minimum=0, maximum=1e6)
    update_rate: float = number(0.0, "Hz", element="updateRate", minimum=0)
    frame_name: str = text()
    frame_name_ros_1: str = text(element="frameName")


class GazeboRosRange(SensorPlugin):
    """Publishes a `Range` on `<topicName>` (`range`), in the link's frame or `<frameName>`.

    `<fov>` [rad] is only said in the message: the rays are the sensor's. `<gaussianNoise>` [m] is on the nearest range;
    `<updateRate>` [Hz] holds where it is lower than the sensor's own.
    """

    endpoints = (publishes("range", "sensor_msgs/msg/Range", named_by=("topicName",)),)
    options = OptionsOf(GazeboRosRangeOptions)
    filenames = ("libgazebo_ros_range.so",)

    def load(self, parent: Lidar, params: Params) -> None:
        topic = self.ros.topic(self.options.topic_name)
        radiation = RADIATION[self.options.radiation]
        view = self.options.fov
        stddev = self.options.gaussian_noise
        rate = self.options.update_rate
        if not hasattr(parent, "range_noise"):
            self.refuse(parent, "ray")
            return
        parent.frame_id = self.options.frame_name or self.options.frame_name_ros_1 or link_name(parent)
        parent.radiation, parent.field_of_view = radiation, view
        if stddev > 0:
            parent.add_range_noise(stddev)
        if 0 < rate < (parent.update_rate or float("inf")):
            parent.set_rate(rate)
        parent.publish_on({"range": topic})
