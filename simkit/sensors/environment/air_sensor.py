"""Base of sensors of the air: the world's air column, and the sensor's height in it."""

from __future__ import annotations

import mujoco

from simkit.linear_algebra import matmul
from simkit.msgs.message_types import M
from simkit.scene import Atmosphere
from simkit.sensors.base import report_once
from simkit.sensors.environment.atmosphere import MAX_ALTITUDE, MIN_ALTITUDE, AirColumn, air_column
from simkit.sensors.vector_sensor import VectorSensor


class AirSensor(VectorSensor[M]):
    """Sensor of the surrounding air.

    The sensor's height above sea level is its z in the world plus the height of the world's origin, which the sensor's
    block gives. Gazebo ignores the height of the origin and the world's `<atmosphere>`. A world with `<gazebo_quirks>`
    ignores them too. The elevation of `<spherical_coordinates>` is not used, as in Gazebo.
    """

    def _read_air_column(self, origin: float = 0.0) -> None:
        """Read the world's air column; call this method in `prepare`.

        Args:
            origin: height of the world's origin above sea level [m], from the sensor's block.
        """
        world = self.sim.world
        quirks = world.gazebo_quirks
        self._column: AirColumn = air_column(Atmosphere() if quirks else world.atmosphere)
        self._origin_height = 0.0 if quirks else origin
        if world.atmosphere.temperature <= 0 and not quirks:
            message = f"<temperature> of the atmosphere is {world.atmosphere.temperature:g} K; expected above 0"
            report_once(self, "error", "SK-SENSOR-060", message, world.atmosphere.where, "give <temperature> in kelvin")
        height = self._origin_height + float(self.scene.pose_world.position[2])
        if not MIN_ALTITUDE <= height <= MAX_ALTITUDE:
            message = (
                f"sensor {self.scoped!r} is {height:g} m above sea level; the standard atmosphere is defined from "
                f"{MIN_ALTITUDE:g} to {MAX_ALTITUDE:g} m and is extrapolated"
            )
            self.diagnostics.warning("SK-SENSOR-061", message, self.scene.where)

    def _height(self, data: mujoco.MjData) -> float:
        """Return the height of the sensor above sea level [m]."""
        body = self._body
        return self._origin_height + float(data.xpos[body][2] + matmul(data.xmat[body][6:], self._offset_position))
