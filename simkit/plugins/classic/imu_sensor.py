"""The IMU of Gazebo Classic: `libgazebo_ros_imu_sensor.so`, with its ROS 2 and its ROS 1 spelling."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.params import LARGEST, Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.endpoints import publishes
from simkit.plugins.find_entities import link_name
from simkit.plugins.options import Options, OptionsOf, boolean, number, text, vector3

if TYPE_CHECKING:
    from simkit.sensors.inertial.imu_measurement import ImuMeasurement

_WORLD = (1.0, 0.0, 0.0, 0.0)


class GazeboRosImuSensorOptions(Options):
    """Options of `GazeboRosImuSensor`."""

    topic_name: str = text(element="topicName")
    initial_orientation_as_reference_ros_1: bool = boolean(element="initialOrientationAsReference")
    initial_orientation_as_reference: bool = boolean(instead="initial_orientation_as_reference_ros_1")
    body_name: str = text(element="bodyName")
    frame_name: str = text()
    frame_name_ros_1: str = text(element="frameName")
    gaussian_noise: float = number(0.0, element="gaussianNoise", minimum=0, maximum=LARGEST)
    rpy_offset: tuple[float, float, float] = vector3(unit="rad", element="rpyOffset")
    xyz_offset: tuple[float, float, float] = vector3(unit="m", element="xyzOffset")
    update_rate_hz: float = number(0.0, "Hz", element="updateRateHZ", minimum=0)


class GazeboRosImuSensor(SensorPlugin):
    """Publishes its IMU on `~/out` (after `<remapping>`), in the link's frame or `<frame_name>`.

    The orientation is measured against the world (REP 145), or with `<initial_orientation_as_reference>` true against
    the attitude at the start. Of ROS 1 are `<gaussianNoise>` on everything that is published, `<rpyOffset>`, which
    turns the orientation, and `<updateRateHZ>`, which may slow the sensor down.
    """

    endpoints = (publishes("~/out", "sensor_msgs/msg/Imu", named_by=("topicName",)),)
    options = OptionsOf(GazeboRosImuSensorOptions)
    filenames = ("libgazebo_ros_imu_sensor.so",)

    def load(self, parent: ImuMeasurement, params: Params) -> None:
        topic = self.ros.topic(self.options.topic_name or "~/out")
        from_start = self.options.initial_orientation_as_reference
        body = self.options.body_name
        if not hasattr(parent, "set_orientation_reference"):
            self.refuse(parent, "imu")
            return
        is_named = any(params.has(name) for name in ("frame_name", "frameName"))
        frame = self.options.frame_name or self.options.frame_name_ros_1 or link_name(parent)
        parent.frame_id = body if body and not is_named else frame
        parent.set_orientation_reference(parent.scene.pose_world.quaternion if from_start else _WORLD)
        parent.publish_on({"imu": topic})
        self._read_ros_1(parent, params)

    def _read_ros_1(self, imu: ImuMeasurement, params: Params) -> None:
        stddev = self.options.gaussian_noise
        if stddev:
            imu.add_white_noise(stddev)
        turn = self.options.rpy_offset
        if any(turn):
            imu.rotate_orientation(turn)
        if any(self.options.xyz_offset):
            where = params.block("xyzOffset").where
            message = f"plugin {self.name!r}: <xyzOffset> changes no reading, as in Gazebo"
            hint = "the sensor's <pose> puts it elsewhere on its link"
            params.diagnostics.note("SK-SENSOR-072", message, where, hint)
        rate = self.options.update_rate_hz
        if rate and not 0 < imu.update_rate <= rate:
            imu.set_rate(rate)
