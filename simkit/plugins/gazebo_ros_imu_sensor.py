"""The IMU of Gazebo Classic: `libgazebo_ros_imu_sensor.so`, with its ROS 2 and its ROS 1 spelling."""

from __future__ import annotations

from typing import Any

from simkit.params import Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.sensor_topics import given_frame, topic_of


class GazeboRosImuSensor(SensorPlugin):
    """Publishes its IMU on `~/out` (after `<remapping>`), in the link's frame or `<frame_name>`.

    The orientation is measured against the world (REP 145), or with `<initial_orientation_as_reference>` true against
    the attitude at the start.
    """

    filenames = ("libgazebo_ros_imu_sensor.so",)

    def load(self, parent: Any, params: Params) -> None:
        topic = topic_of(self, "out", "topicName")
        old = params.boolean("initialOrientationAsReference", False)
        from_start = params.boolean("initial_orientation_as_reference", old)
        if not hasattr(parent, "measure_against"):
            params.error("SK-PLUGIN-003", f"plugin {self.name!r} is for a sensor of type imu, this is {parent.kind!r}")
            return
        parent.frame_id = given_frame(parent, params)
        parent.measure_against(parent.scene.pose_world.quaternion if from_start else (1.0, 0.0, 0.0, 0.0))
        parent.publish_on({"imu": topic})
