"""`imu_sensor_broadcaster`: what an inertial sensor of the hardware measures, as a topic."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from simkit import msgs
from simkit.plugins.ros2_control.controller import Controller
from simkit.plugins.ros_parameter_block import read_numbers

IMU: Final = "sensor_msgs/msg/Imu"
_PARTS: Final = (
    [f"orientation.{axis}" for axis in "xyzw"]
    + [f"angular_velocity.{axis}" for axis in "xyz"]
    + [f"linear_acceleration.{axis}" for axis in "xyz"]
)


class ImuSensorBroadcaster(Controller):
    """The sensor that `sensor_name` names, on `~/imu`, stamped with `frame_id`."""

    types = ("imu_sensor_broadcaster/IMUSensorBroadcaster",)

    def configure(self) -> None:
        params = self.params
        self._sensor = params.text("sensor_name", required=True)
        self._frame = params.text("frame_id", required=True)
        self._covariances = [
            read_numbers(params, f"static_covariance_{part}", [0.0] * 9)
            for part in ("orientation", "angular_velocity", "linear_acceleration")
        ]
        self._publisher = self.advertise("~/imu", IMU)

    def state_interfaces(self) -> Sequence[str]:
        return [f"{self._sensor}/{part}" for part in _PARTS]

    def update(self, now_ns: int, period: float) -> None:
        if not self._publisher.wanted:
            return
        values = self.states.values
        if np.isnan(values).any():
            return  # nothing has been measured yet
        imu, quaternion, vector = msgs.types_of(IMU, "geometry_msgs/msg/Quaternion", "geometry_msgs/msg/Vector3")
        orientation, rate, acceleration = (np.array(covariance) for covariance in self._covariances)
        turn, turning, pull = (part.tolist() for part in (values[:4], values[4:7], values[7:]))
        header = msgs.header(now_ns, self._frame)
        told = imu(header, quaternion(*turn), orientation, vector(*turning), rate, vector(*pull), acceleration)
        self._publisher.publish(told)
