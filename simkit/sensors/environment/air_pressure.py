"""Barometer: the static pressure of the air at the sensor's height."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from simkit import msgs
from simkit.params import Params
from simkit.pose import Vector
from simkit.sensors.environment.air_sensor import AirSensor
from simkit.sensors.measured_rows import MeasuredRows
from simkit.sensors.noise import NoiseModel, read_noise


@dataclass(frozen=True, slots=True)
class AirPressureOptions:
    """The `<air_pressure>` block.

    Attributes:
        reference_altitude: height of the world's origin above sea level [m].
        pressure: noise [Pa].
    """

    reference_altitude: float
    pressure: NoiseModel


class AirPressure(AirSensor["msgs.FluidPressure"]):
    """Barometer, `air_pressure`: the pressure of the world's `<atmosphere>` at the height of the sensor's origin."""

    kinds = ("air_pressure",)
    example = "<air_pressure/>"
    sees_scene = False
    product, message_type = "air_pressure", "sensor_msgs/msg/FluidPressure"
    options: AirPressureOptions

    def read_options(self, params: Params) -> AirPressureOptions:
        block = params.block("air_pressure")
        altitude = block.number("reference_altitude", 0.0, minimum=-1e9, maximum=1e9)
        return AirPressureOptions(altitude, read_noise(block.block("pressure")))

    def describe(self) -> dict[str, object]:
        """Return the height of the world's origin in the file [m], and the standard deviation of the noise [Pa]."""
        options = self.options
        altitude, stddev = options.reference_altitude, options.pressure.stddev
        return {"air_pressure": {"reference_altitude": altitude, "pressure_stddev": stddev}}

    def prepare(self) -> None:
        self._read_air_column(self.options.reference_altitude)
        self.noise = self._make_noise((self.options.pressure,), "air_pressure")
        if self.sim.world.gazebo_quirks and self.options.reference_altitude:
            message = "<reference_altitude> has no effect with <gazebo_quirks>, because Gazebo ignores it"
            where = self.scene.params.block("air_pressure").block("reference_altitude").where
            self.diagnostics.warning("SK-SENSOR-062", message, where, "change the z of the model's <pose> instead")

    def array_rule(self) -> MeasuredRows:
        return MeasuredRows(self)

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> Vector:
        return np.array((self._column.at(self._height(data)).pressure,))

    def _message_of(self, reading: Vector, time_ns: int) -> msgs.FluidPressure:
        variance = self.noise.variance()
        if self.sim.world.gazebo_quirks:
            variance = variance**0.25  # Gazebo publishes the square root of the standard deviation
        return msgs.FluidPressure(msgs.header(time_ns, self.frame_id), float(reading[0]), variance)
