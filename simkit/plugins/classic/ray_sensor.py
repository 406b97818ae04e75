"""Lidars of Gazebo Classic: `libgazebo_ros_ray_sensor.so` of ROS 2, `libgazebo_ros_laser.so` and others of ROS 1.

ROS 1's `libgazebo_ros_range.so` is a lidar that publishes its nearest ray.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from simkit.params import LARGEST, Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.endpoints import publishes
from simkit.plugins.find_entities import SensorFrameOptions
from simkit.plugins.options import OptionsOf, boolean, choice, number, text

if TYPE_CHECKING:
    from simkit.sensors.rays.lidar import Lidar

_OUTPUTS = {
    "sensor_msgs/LaserScan": "scan",
    "sensor_msgs/PointCloud2": "hits",
    "sensor_msgs/PointCloud": "old_hits",
    "sensor_msgs/Range": "range",
}
RADIATION = {"ultrasound": 0, "infrared": 1}  # values of sensor_msgs/Range


class GazeboRosLaserOptions(SensorFrameOptions):
    """Options of `GazeboRosLaser`."""

    topic_name: str = text(element="topicName")


class GazeboRosRaySensorOptions(GazeboRosLaserOptions):
    """Options of `GazeboRosRaySensor`."""

    output_type: str = choice(tuple(_OUTPUTS), "sensor_msgs/PointCloud2")
    radiation_type: str = choice(tuple(RADIATION), "infrared")
    min_intensity: float = number(0.0)


class GazeboRosRaySensor(SensorPlugin):
    """Publishes its lidar on `~/out` (after `<remapping>`), in the link's frame or `<frame_name>`.

    `<output_type>` is sensor_msgs/LaserScan, PointCloud2 (the default), PointCloud or Range. Intensities below
    `<min_intensity>` become `<min_intensity>`. `<radiation_type>` (ultrasound or infrared) is copied to Range messages.
    """

    endpoints = (
        publishes(
            "~/out",
            "sensor_msgs/msg/LaserScan",
            "sensor_msgs/msg/PointCloud2",
            "sensor_msgs/msg/PointCloud",
            "sensor_msgs/msg/Range",
            named_by=("topicName",),
        ),
    )
    options = OptionsOf(GazeboRosRaySensorOptions)
    filenames = ("libgazebo_ros_ray_sensor.so",)
    only_publishes = True

    def load(self, parent: Lidar, params: Params) -> None:
        output = _OUTPUTS[self.options.output_type]
        radiation = RADIATION[self.options.radiation_type]
        least = self.options.min_intensity
        topic = self.ros.topic(self.options.topic_name or "~/out")
        _connect(self, parent, {output: topic}, least, radiation)


class GazeboRosLaser(SensorPlugin):
    """Publishes a ROS 1 LaserScan on `<topicName>` (`/world`), in the link's frame or `<frameName>`."""

    endpoints = (publishes("/world", "sensor_msgs/msg/LaserScan", named_by=("topicName",)),)
    options = OptionsOf(GazeboRosLaserOptions)
    filenames = ("libgazebo_ros_laser.so", "libgazebo_ros_gpu_laser.so")

    def load(self, parent: Lidar, params: Params) -> None:
        _connect(self, parent, {"scan": _named_topic(self, self.options.topic_name)}, 0.0, RADIATION["infrared"])


class GazeboRosBlockLaserOptions(GazeboRosLaserOptions):
    """Options of `GazeboRosBlockLaser`."""

    gaussian_noise: float = number(0.0, element="gaussianNoise", minimum=0, maximum=LARGEST)
    hokuyo_min_intensity: float = number(0.0, element="hokuyoMinIntensity")
    update_rate: float = number(0.0, "Hz", element="updateRate")


class GazeboRosBlockLaser(SensorPlugin):
    """Publishes a ROS 1 PointCloud with a point for every ray on `<topicName>` (`/world`).

    The frame is the link's frame or `<frameName>`. A ray without a reading ends at the sensor's maximum range.
    `<gaussianNoise>` is the standard deviation of noise on x, y and z [m] of rays with a reading, and on every
    intensity. This noise is in addition to the sensor's own noise. `<hokuyoMinIntensity>` and `<updateRate>` have no
    effect, as in Gazebo.
    """

    endpoints = (publishes("/world", "sensor_msgs/msg/PointCloud", named_by=("topicName",)),)
    options = OptionsOf(GazeboRosBlockLaserOptions)
    filenames = ("libgazebo_ros_block_laser.so",)

    def load(self, parent: Lidar, params: Params) -> None:
        noise = self.options.gaussian_noise
        for name in ("hokuyoMinIntensity", "updateRate"):
            params.number(name, 0.0)
            if params.has(name):
                message = f"plugin {self.name!r}: <{name}> has no effect, as in Gazebo"
                hint = "set the sensor's <update_rate>" if name == "updateRate" else ""
                params.diagnostics.note("SK-PLUGIN-061", message, params.block(name).where, hint)
        topic = _named_topic(self, self.options.topic_name)
        if _connect(self, parent, {"block": topic}, 0.0, RADIATION["infrared"]) and noise > 0:
            parent.add_point_noise(noise)


def _named_topic(plugin: SensorPlugin, topic: str) -> str:
    """Return the topic `<topicName>`, or Gazebo's default `/world` after a warning."""
    if not topic:
        message = f"plugin {plugin.name!r} has no <topicName>: it publishes on '/world', as in Gazebo"
        plugin.params.diagnostics.note("SK-PLUGIN-062", message, plugin.where, "<topicName>scan</topicName>")
    return plugin.ros.topic(topic or "/world")


class GazeboRosVelodyneLaserOptions(GazeboRosLaserOptions):
    """Options of `GazeboRosVelodyneLaser`."""

    min_range: float = number(0.0, minimum=0)
    max_range: float = number(math.inf, finite=False)
    organize_cloud: bool = boolean()
    min_intensity: float = number(-math.inf, finite=False)
    gaussian_noise: float = number(0.0, element="gaussianNoise", minimum=0, maximum=LARGEST)


class GazeboRosVelodyneLaser(SensorPlugin):
    """Publishes a PointCloud2 with x, y, z, intensity and ring on `~/out` (after `<remapping>`; or `<topicName>`).

    The cloud has only points whose distance is between `<min_range>` and `<max_range>` [m] and whose intensity is at
    least `<min_intensity>`. With `<organize_cloud>` every ray has a fixed index in the cloud. `<gaussianNoise>` is the
    standard deviation [m] of noise in addition to the sensor's own noise.
    """

    endpoints = (publishes("~/out", "sensor_msgs/msg/PointCloud2", named_by=("topicName",)),)
    options = OptionsOf(GazeboRosVelodyneLaserOptions)
    filenames = ("libgazebo_ros_velodyne_laser.so", "libgazebo_ros_velodyne_gpu_laser.so")

    def load(self, parent: Lidar, params: Params) -> None:
        limits = self.options.min_range, self.options.max_range
        keeps_order = self.options.organize_cloud
        least = self.options.min_intensity
        noise = self.options.gaussian_noise
        topic = self.ros.topic(self.options.topic_name or "~/out")
        if _connect(self, parent, {"velodyne": topic}, least, RADIATION["infrared"]):
            parent.cloud_range, parent.keeps_order = limits, keeps_order
            if noise > 0:
                parent.add_ray_noise(noise)


def _connect(plugin: SensorPlugin, sensor: Lidar, topics: dict[str, str], min_intensity: float, radiation: int) -> bool:
    if not hasattr(sensor, "min_intensity"):
        plugin.refuse(sensor, "ray")
        return False
    sensor.frame_id = SensorFrameOptions(plugin.params).frame_of(sensor)
    sensor.min_intensity, sensor.radiation = min_intensity, radiation
    sensor.publish_on(topics)
    return True


class GazeboRosRangeOptions(SensorFrameOptions):
    """Options of `GazeboRosRange`."""

    topic_name: str = text("range", element="topicName")
    radiation: str = choice(tuple(RADIATION), "ultrasound")
    fov: float = number(0.05, minimum=0, maximum=1e6)
    gaussian_noise: float = number(0.0, element="gaussianNoise", minimum=0, maximum=1e6)
    update_rate: float = number(0.0, "Hz", element="updateRate", minimum=0)


class GazeboRosRange(SensorPlugin):
    """Publishes a `Range` on `<topicName>` (`range`), in the link's frame or `<frameName>`.

    `<fov>` [rad] only sets a field of the message and does not change the sensor's rays. `<gaussianNoise>` is the
    standard deviation [m] of noise on the nearest range. `<updateRate>` [Hz] is used if it is lower than the sensor's
    own rate.
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
        parent.frame_id = self.options.frame_of(parent)
        parent.radiation, parent.field_of_view = radiation, view
        if stddev > 0:
            parent.add_range_noise(stddev)
        if 0 < rate < (parent.update_rate or float("inf")):
            parent.set_rate(rate)
        parent.publish_on({"range": topic})
