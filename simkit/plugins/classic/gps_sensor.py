"""GPS receiver of Gazebo Classic: `libgazebo_ros_gps_sensor.so` of ROS 2."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.endpoints import publishes
from simkit.plugins.find_entities import SensorFrameOptions
from simkit.plugins.options import OptionsOf

if TYPE_CHECKING:
    from simkit.sensors.environment.navsat import NavSat

_KINDS = ("gps", "navsat")
_BACKWARDS = -0.999  # cosine of a heading close to 180 degrees


class GazeboRosGpsSensor(SensorPlugin):
    """Publishes the fix on `~/out` and the velocity (east, north, up) on `~/vel`, after `<remapping>`.

    The frame is the link's frame or `<frame_name>`.
    """

    endpoints = (
        publishes("~/out", "sensor_msgs/msg/NavSatFix"),
        publishes("~/vel", "geometry_msgs/msg/Vector3Stamped"),
    )
    options = OptionsOf(SensorFrameOptions)
    filenames = ("libgazebo_ros_gps_sensor.so",)

    def load(self, parent: NavSat, params: Params) -> None:
        if parent.kind not in _KINDS:
            self.refuse(parent, "gps")
            return
        parent.frame_id = self.options.frame_of(parent)
        parent.use_classic_noise()
        self._check_heading(params)
        parent.publish_on({"fix": self.ros.topic("~/out"), "velocity": self.ros.topic("~/vel")})

    def _check_heading(self, params: Params) -> None:
        """Warn about a heading of 180 degrees, by which worlds compensate Classic's error of half a turn."""
        place = self.sim.world.spherical_coordinates
        if place is not None and math.cos(place.heading) < _BACKWARDS and not self.sim.world.gazebo_quirks:
            message = "<heading_deg> 180 makes x point west; Gazebo Classic, wrong by half a turn, makes x point east"
            hint = "write <heading_deg>0</heading_deg>, or add <gazebo_quirks> to the world for Classic's heading"
            params.diagnostics.warning("SK-SENSOR-068", message, place.where, hint)
