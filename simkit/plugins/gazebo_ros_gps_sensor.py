"""The satellite receiver of Gazebo Classic: `libgazebo_ros_gps_sensor.so` of ROS 2."""

from __future__ import annotations

from typing import Any

from simkit.params import Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.sensor_topics import given_frame

_KINDS = ("gps", "navsat")


class GazeboRosGpsSensor(SensorPlugin):
    """Publishes the fix on `~/out` and the velocity (east, north, up) on `~/vel`, after `<remapping>`.

    In the link's frame or `<frame_name>`.
    """

    filenames = ("libgazebo_ros_gps_sensor.so",)

    def load(self, parent: Any, params: Params) -> None:
        if parent.kind not in _KINDS:
            params.error("SK-PLUGIN-003", f"plugin {self.name!r} is for a sensor of type gps, this is {parent.kind!r}")
            return
        parent.frame_id = given_frame(parent, params)
        parent.publish_on({"fix": self.ros.topic("~/out"), "velocity": self.ros.topic("~/vel")})
