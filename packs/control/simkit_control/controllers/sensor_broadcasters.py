"""Broadcasters of the hardware's sensors: `imu_sensor_broadcaster` and `force_torque_sensor_broadcaster`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from simkit import Params, msgs
from simkit.plugins.ros_parameter_block import read_numbers
from simkit_control.plugins.ros2_control.controller import Controller
from simkit_control.plugins.ros2_control.hardware_sensors import SENSOR_INTERFACES

IMU: Final = "sensor_msgs/msg/Imu"
_IMU_FIELDS: Final = tuple(SENSOR_INTERFACES["imu"])


class ImuSensorBroadcaster(Controller):
    """Publishes the measurements of the IMU `sensor_name` on `~/imu`, in the frame `frame_id`."""

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
        return [f"{self._sensor}/{part}" for part in _IMU_FIELDS]

    def update(self, now_ns: int, period: float) -> None:
        if not self._publisher.wanted:
            return
        values = self.states.values
        if np.isnan(values).any():
            return  # nothing has been measured yet
        imu, quaternion, vector = msgs.types_of(IMU, "geometry_msgs/msg/Quaternion", "geometry_msgs/msg/Vector3")
        orientation, rate, acceleration = (np.array(covariance) for covariance in self._covariances)
        rotation, angular, linear = (part.tolist() for part in (values[:4], values[4:7], values[7:]))
        header = msgs.header(now_ns, self._frame)
        message = imu(header, quaternion(*rotation), orientation, vector(*angular), rate, vector(*linear), acceleration)
        self._publisher.publish(message)


WRENCH: Final = "geometry_msgs/msg/WrenchStamped"
_WRENCH_FIELDS: Final = tuple(SENSOR_INTERFACES["force_torque"])


class ForceTorqueSensorBroadcaster(Controller):
    """Publishes the wrench of the sensor `sensor_name`, or of the interfaces in `interface_names`, on `~/wrench`."""

    types = ("force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster",)

    def configure(self) -> None:
        params = self.params
        sensor = params.text("sensor_name", "")
        block = params.block("interface_names")
        single = {part: block.block(part.partition(".")[0]).text(part.partition(".")[2], "") for part in _WRENCH_FIELDS}
        self._frame = params.text("frame_id", required=True)
        if sensor and any(single.values()):
            params.error("SK-PARAM-002", "both 'sensor_name' and 'interface_names' are set; remove one of them")
        elif not sensor and not any(single.values()):
            params.text("sensor_name", required=True)
        names = {p: f"{sensor}/{p}" for p in _WRENCH_FIELDS} if sensor else {p: n for p, n in single.items() if n}
        self._names = list(names.values())
        self._columns = [_WRENCH_FIELDS.index(part) for part in names]
        self._has_all_parts = tuple(names) == _WRENCH_FIELDS
        offset, multiplier = params.block("offset"), params.block("multiplier")
        self._offset = np.array([_number(offset, part, 0.0) for part in _WRENCH_FIELDS])
        self._multiplier = np.array([_number(multiplier, part, 1.0) for part in _WRENCH_FIELDS])
        self._publisher = self.advertise("~/wrench", WRENCH)

    def state_interfaces(self) -> Sequence[str]:
        return self._names

    def update(self, now_ns: int, period: float) -> None:
        if not self._publisher.wanted:
            return
        values = self.states.values
        if not self._has_all_parts:
            measured, values = values, np.full(6, np.nan)  # components without interface are not measured
            values[self._columns] = measured
        values *= self._multiplier
        values += self._offset
        stamped, wrench, vector = msgs.types_of(WRENCH, "geometry_msgs/msg/Wrench", "geometry_msgs/msg/Vector3")
        force, torque = values[:3].tolist(), values[3:].tolist()
        self._publisher.publish(stamped(msgs.header(now_ns, self._frame), wrench(vector(*force), vector(*torque))))


def _number(block: Params, part: str, default: float) -> float:
    name, _, axis = part.partition(".")
    return block.block(name).number(axis, default)
