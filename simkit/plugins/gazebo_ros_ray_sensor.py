"""Lidars of Gazebo Classic: `libgazebo_ros_ray_sensor.so` of ROS 2, `libgazebo_ros_laser.so` and kin of ROS 1."""

from __future__ import annotations

import math
from typing import Any

from simkit.params import LARGEST, Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.sensor_topics import given_frame, topic_of

_OUTPUTS = {
    "sensor_msgs/LaserScan": "scan",
    "sensor_msgs/PointCloud2": "hits",
    "sensor_msgs/PointCloud": "old_hits",
    "sensor_msgs/Range": "range",
}
RADIATION = {"ultrasound": 0, "infrared": 1}  # of a Range


class GazeboRosRaySensor(SensorPlugin):
    """Publishes its lidar on `~/out` (after `<remapping>`), in the link's frame or `<frame_name>`.

    `<output_type>` is sensor_msgs/LaserScan, PointCloud2 (the default), PointCloud or Range. Intensities are at least
    `<min_intensity>`. `<radiation_type>` (ultrasound or infrared) goes into Range messages.
    """

    filenames = ("libgazebo_ros_ray_sensor.so",)

    def load(self, parent: Any, params: Params) -> None:
        output = _OUTPUTS[params.choice("output_type", tuple(_OUTPUTS), "sensor_msgs/PointCloud2")]
        radiation = RADIATION[params.choice("radiation_type", tuple(RADIATION), "infrared")]
        least = params.number("min_intensity", 0.0)
        topic = topic_of(self, "out", "topicName")
        _connect(self, parent, {output: topic}, least, radiation)


class GazeboRosLaser(SensorPlugin):
    """ROS 1: a LaserScan on `<topicName>`, in `<frameName>`."""

    filenames = ("libgazebo_ros_laser.so", "libgazebo_ros_gpu_laser.so")

    def load(self, parent: Any, params: Params) -> None:
        topic = self.ros.topic(params.text("topicName", "scan"))
        _connect(self, parent, {"scan": topic}, 0.0, RADIATION["infrared"])


class GazeboRosVelodyneLaser(SensorPlugin):
    """A PointCloud2 with x, y, z, intensity and ring, on `~/out` (after `<remapping>`; or `<topicName>`).

    Only points farther than `<min_range>`, nearer than `<max_range>` and of at least `<min_intensity>`; with
    `<organize_cloud>` every ray has its place. `<gaussianNoise>`, a standard deviation [m], is added to the sensor's.
    """

    filenames = ("libgazebo_ros_velodyne_laser.so", "libgazebo_ros_velodyne_gpu_laser.so")

    def load(self, parent: Any, params: Params) -> None:
        limits = params.number("min_range", 0.0, minimum=0), params.number("max_range", math.inf, finite=False)
        keeps_order = params.boolean("organize_cloud", False)
        least = params.number("min_intensity", -math.inf)
        noise = params.number("gaussianNoise", 0.0, minimum=0, maximum=LARGEST)
        topic = topic_of(self, "out", "topicName")
        if _connect(self, parent, {"velodyne": topic}, least, RADIATION["infrared"]):
            parent.cloud_range, parent.keeps_order = limits, keeps_order
            if noise > 0:
                parent.add_ray_noise(noise)


def _connect(plugin: SensorPlugin, sensor: Any, topics: dict[str, str], min_intensity: float, radiation: int) -> bool:
    if not hasattr(sensor, "min_intensity"):
        plugin.refuse(sensor, "ray")
        return False
    sensor.frame_id = given_frame(sensor, plugin.params)
    sensor.min_intensity, sensor.radiation = min_intensity, radiation
    sensor.publish_on(topics)
    return True
