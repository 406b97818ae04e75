"""Air speed: the dynamic pressure in a tube along the sensor's x axis, and the temperature of the air."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from simkit import msgs
from simkit.linear_algebra import matmul
from simkit.params import Params
from simkit.pose import Vector
from simkit.sensors.environment.air_sensor import AirSensor
from simkit.sensors.noise import NoiseModel, read_noise

_HECTO = 100.0  # Gazebo adds the noise to hectopascals


@dataclass(frozen=True, slots=True)
class AirSpeedOptions:
    """The `<air_speed>` block: noise of the pressure [Pa]."""

    pressure: NoiseModel


class AirSpeed(AirSensor["msgs.AirSpeed"]):
    """Air-speed sensor, `air_speed`: ½ρv·|v| with the air speed v along the sensor's x axis and the air density ρ.

    The air moves with the world's wind, including the gusts of a wind plugin. The sensor's velocity is the velocity
    of its own origin, including the lever arm.
    """

    kinds = ("air_speed",)
    example = "<air_speed/>"
    sees_scene = False
    product, message_type = "air_speed", "ros_gz_interfaces/msg/AirSpeed"
    options: AirSpeedOptions

    def read_options(self, params: Params) -> AirSpeedOptions:
        return AirSpeedOptions(read_noise(params.block("air_speed").block("pressure")))

    def describe(self) -> dict[str, object]:
        """Return the standard deviation of the noise [Pa]."""
        return {"air_speed": {"pressure_stddev": self.options.pressure.stddev}}

    def prepare(self) -> None:
        self._read_air_column()
        quirks = self.sim.world.gazebo_quirks
        self._is_calm = quirks
        self._unit = _HECTO if quirks else 1.0
        self.noise = self._make_noise((self.options.pressure,), "air_speed")

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> Vector:
        """Return the dynamic pressure [Pa], negative for air from behind, and the temperature [K]."""
        rotation = data.xmat[self._body].reshape(3, 3)
        velocity = self._velocity_in_world(model, data, matmul(rotation, self._offset_position))
        speed = float(matmul(velocity - self._wind(data), matmul(rotation, self._offset_rotation[:, 0])))
        air = self._column.at(self._height(data))
        return np.array((0.5 * air.density * speed * abs(speed), air.temperature))

    def _wind(self, data: mujoco.MjData) -> Vector:
        """Return the wind velocity of the last step [m/s], shape (3,); zero with Gazebo's quirks, which ignore wind."""
        if self._is_calm:
            return np.zeros(3)
        return np.array(self.sim.engine.wind.at(max(round(data.time / self.sim.timestep) - 1, 0)))

    def perturb(self, reading: Vector, index: int) -> Vector:
        if self.noise.is_silent:
            return reading
        return np.append(self.noise.apply(reading[:1] / self._unit, index) * self._unit, reading[1])

    def _message_of(self, reading: Vector, time_ns: int) -> msgs.AirSpeed:
        return msgs.AirSpeed(msgs.header(time_ns, self.frame_id), *reading.tolist())
