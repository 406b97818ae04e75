"""Base of sensors of the air: the world's air column, and the sensor's height in it."""

from __future__ import annotations

import mujoco

from simkit.scene import Atmosphere
from simkit.sensors.base import report_once
from simkit.sensors.environment.atmosphere import MAX_ALTITUDE, MIN_ALTITUDE, AirColumn, air_column
from simkit.sensors.vector_sensor import VectorSensor


class AirSensor(VectorSensor):
    """A sensor of the air around it.

    Its height above sea level is its z in the world plus what the sensor says itself of the world's origin. Gazebo
    passes over what the sensor says and a world's `<atmosphere>`; so does a world with `<gazebo_quirks>`. The elevation
    of `<spherical_coordinates>` does not count, as in Gazebo.
    """

    def _read_air_column(self, origin: float = 0.0) -> None:
        """To be called in `prepare`.

        Args:
            origin: height of the world's origin above sea level [m] where the sensor's block says it.
        """
        world = self.sim.world
        quirks = world.gazebo_quirks
        self._column: AirColumn = air_column(Atmosphere() if quirks else world.atmosphere)
        self._origin_height = 0.0 if quirks else origin
        if world.atmosphere.temperature <= 0 and not quirks:
            message = f"air of {world.atmosphere.temperature:g} K has no density"
            report_once(self, "error", "SK-SENSOR-060", message, world.atmosphere.where, "<temperature> is in kelvin")
        height = self._origin_height + float(self.scene.pose_world.position[2])
        if not MIN_ALTITUDE <= height <= MAX_ALTITUDE:
            message = (
                f"sensor {self.scoped!r} is {height:g} m above sea level; the standard atmosphere reaches from "
                f"{MIN_ALTITUDE:g} to {MAX_ALTITUDE:g} m and is extended"
            )
            self.diagnostics.warning("SK-SENSOR-061", message, self.scene.where)

    def _height(self, data: mujoco.MjData) -> float:
        """Of the sensor above sea level [m]."""
        body = self._body
        return self._origin_height + float(data.xpos[body][2] + data.xmat[body][6:] @ self._offset_position)
