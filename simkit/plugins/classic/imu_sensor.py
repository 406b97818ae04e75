"""The IMU of Gazebo Classic: `libgazebo_ros_imu_sensor.so`, with its ROS 2 and its ROS 1 spelling."""

from __future__ import annotations

from typing import Any

from simkit.params import LARGEST, Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.lookups import private_topic, read_frame

_WORLD = (1.0, 0.0, 0.0, 0.0)


class GazeboRosImuSensor(SensorPlugin):
    """Publishes its IMU on `~/out` (after `<remapping>`), in the link's frame or `<frame_name>`.

    The orientation is measured against the world (REP 145), or with `<initial_orientation_as_reference>` true against
    the attitude at the start. Of ROS 1 are `<gaussianNoise>` on everything that is published, `<rpyOffset>`, which
    turns the orientation, and `<updateRateHZ>`, which may slow the sensor down.
    """

    filenames = ("libgazebo_ros_imu_sensor.so",)

    def load(self, parent: Any, params: Params) -> None:
        topic = private_topic(self, "out", "topicName")
        old = params.boolean("initialOrientationAsReference", False)
        from_start = params.boolean("initial_orientation_as_reference", old)
        body = params.text("bodyName", "")
        if not hasattr(parent, "set_orientation_reference"):
            self.refuse(parent, "imu")
            return
        is_named = any(params.has(name) for name in ("frame_name", "frameName"))
        frame = read_frame(parent, params)
        parent.frame_id = body if body and not is_named else frame
        parent.set_orientation_reference(parent.scene.pose_world.quaternion if from_start else _WORLD)
        parent.publish_on({"imu": topic})
        self._read_ros_1(parent, params)

    def _read_ros_1(self, imu: Any, params: Params) -> None:
        stddev = params.number("gaussianNoise", 0.0, minimum=0, maximum=LARGEST)
        if stddev:
            imu.add_white_noise(stddev)
        turn = params.vector3("rpyOffset", (0.0, 0.0, 0.0))
        if any(turn):
            imu.rotate_orientation(turn)
        if any(params.vector3("xyzOffset", (0.0, 0.0, 0.0))):
            where = params.block("xyzOffset").where
            message = f"plugin {self.name!r}: <xyzOffset> changes no reading, as in Gazebo"
            hint = "the sensor's <pose> puts it elsewhere on its link"
            params.diagnostics.note("SK-SENSOR-072", message, where, hint)
        rate = params.number("updateRateHZ", 0.0, minimum=0)
        if rate and not 0 < imu.update_rate <= rate:
            imu.set_rate(rate)
