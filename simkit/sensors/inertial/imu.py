"""Inertial measurement unit: `imu` sensors and their messages."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

from simkit import msgs
from simkit.sensors.base import Product
from simkit.sensors.inertial.imu_batch import TYPES, form_imu_batches
from simkit.sensors.inertial.imu_measurement import ImuMeasurement, ImuReading
from simkit.sensors.inertial.inertial_kinematics import NO_ROTATION


class Imu(ImuMeasurement):
    """`imu`: specific force, angular rate, attitude."""

    kinds = ("imu",)
    example = "<imu/>"

    @classmethod
    def make_batches(cls, sensors: Sequence[Self]) -> None:
        if cls is Imu:
            form_imu_batches(sensors)

    def products(self) -> dict[str, Product]:
        return {"imu": Product(TYPES[0], self._message_of)}

    def default_topics(self) -> dict[str, str]:
        return {"imu": self._default_topic("imu")}

    def _message_of(self, reading: ImuReading, time_ns: int) -> msgs.Imu:
        imu, vector, quaternion = msgs.types_of(*TYPES)
        of_orientation, of_rate, of_force = self.covariances()
        w, x, y, z = reading.orientation if self.options.enable_orientation else NO_ROTATION
        rx, ry, rz, fx, fy, fz = reading.motion
        message: msgs.Imu = imu(
            msgs.header(time_ns, self.frame_id),
            quaternion(x, y, z, w),
            of_orientation,
            vector(rx, ry, rz),
            of_rate,
            vector(fx, fy, fz),
            of_force,
        )
        return message
