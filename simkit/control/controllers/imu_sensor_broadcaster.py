"""`imu_sensor_broadcaster`: what an inertial sensor of the hardware measures, as a topic."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from simkit import msgs
from simkit.control.controller import Controller
from simkit.control.readings import numbers, vector
from simkit.pose import Vector

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
            numbers(params, f"static_covariance_{part}", [0.0] * 9)
            for part in ("orientation", "angular_velocity", "linear_acceleration")
        ]
        self._out = self.advertise("~/imu", IMU)

    def state_interfaces(self) -> Sequence[str]:
        return [f"{self._sensor}/{part}" for part in _PARTS]

    def update(self, now_ns: int, period: float) -> None:
        if not self._out.wanted:
            return
        values = self.states.values
        if np.isnan(values).any():
            return  # nothing has been measured yet
        orientation, rate, acceleration = self._covariances
        self._out.publish(
            msgs.type_of(IMU)(
                msgs.header(now_ns, self._frame),
                _quaternion(values[:4]),
                np.array(orientation),
                vector(values[4:7]),
                np.array(rate),
                vector(values[7:]),
                np.array(acceleration),
            )
        )


def _quaternion(values: Vector) -> Any:
    return msgs.type_of("geometry_msgs/msg/Quaternion")(*values.tolist())
