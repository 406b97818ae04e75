"""Magnetometer: the magnetic field around the sensor, in its own axes."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from simkit import msgs
from simkit.params import Params
from simkit.pose import Vector
from simkit.scene import SceneWorld
from simkit.sensors.base import report_once
from simkit.sensors.environment.geodesy import WorldOnPlanet
from simkit.sensors.environment.magnetic_field import (
    DEFAULT_DATE,
    FIRST_YEAR,
    LAST_YEAR,
    MAX_HEIGHT,
    MIN_HEIGHT,
    EarthField,
    decimal_year,
)
from simkit.sensors.noise import ThreeAxes, read_axes
from simkit.sensors.vector_sensor import VectorSensor

_TYPES = "sensor_msgs/msg/MagneticField", "geometry_msgs/msg/Vector3"
_GAUSS = 1e4  # in a tesla
_EARTH = "EARTH_WGS84"
_SYSTEM = "magnetometer-system"


@dataclass(frozen=True, slots=True)
class MagnetometerOptions:
    """The `<magnetometer>` block.

    Attributes:
        axes: noise per axis [T].
        year: decimal year of the Earth's field.
    """

    axes: ThreeAxes
    year: float


def _read_year(block: Params) -> float:
    given = block.child("date")
    if given is None:
        return DEFAULT_DATE
    try:
        year = decimal_year(given.value)
    except ValueError:
        year = float("nan")
    if FIRST_YEAR <= year <= LAST_YEAR:
        return year
    allowed = f"allowed is a date as 2026-07-01 or 2026.5 from {FIRST_YEAR:g} to {LAST_YEAR:g}"
    message = f"found <date>{given.value[:60]}</date>, {allowed}"
    given.error("SK-SENSOR-063", message)
    return DEFAULT_DATE


class Magnetometer(VectorSensor):
    """`magnetometer`: the world's `<magnetic_field>`, or the Earth's at the place of its `<spherical_coordinates>`.

    In tesla, in the sensor's axes. Settings of the world's Magnetometer system that Gazebo has by default (gauss
    instead of tesla, and north, east, down along the world's x, y, z) count where the file writes them, and in a world
    with `<gazebo_quirks>`.
    """

    kinds = ("magnetometer",)
    example = "<magnetometer/>"
    product, message_type = "magnetometer", _TYPES[0]
    options: MagnetometerOptions

    def read_options(self, params: Params) -> MagnetometerOptions:
        block = params.block("magnetometer")
        return MagnetometerOptions(read_axes(block), _read_year(block))

    def describe(self) -> dict[str, object]:
        """Decimal year of the Earth's field, standard deviations [T]."""
        return {"magnetometer": {"year": self.options.year, "stddev": [axis.stddev for axis in self.options.axes]}}

    def prepare(self) -> None:
        world = self.sim.world
        self.noise = self._make_noise(self.options.axes, "magnetometer")
        self._uniform: Vector = np.array(world.magnetic_field)
        self.relocate()

    def relocate(self) -> None:
        """Takes the field of where the world lies now."""
        world = self.sim.world
        self._earth: EarthField | None = None
        self._scale, self._to_world = 1.0, np.eye(3)
        if world.spherical_coordinates is not None:
            self._locate_on_planet(world)

    def _locate_on_planet(self, world: SceneWorld) -> None:
        place = world.spherical_coordinates
        assert place is not None
        written = world.magnetic_field != SceneWorld().magnetic_field
        if place.surface != _EARTH:
            message = f"no model of the magnetic field of {place.surface}; the world's <magnetic_field> is used"
            report_once(self, "note", "SK-SENSOR-064", message, place.where)
            return
        if written:
            message = "<magnetic_field> is replaced by the Earth's field: the world has <spherical_coordinates>"
            hint = "leave <spherical_coordinates> out for a field of your own"
            report_once(self, "warning", "SK-SENSOR-065", message, world.where, hint)
        if not MIN_HEIGHT <= place.elevation <= MAX_HEIGHT:
            height = f"{place.elevation:g} m, the model of the Earth's field is for {MIN_HEIGHT:g} to {MAX_HEIGHT:g} m"
            message = f"the world is at a height of {height}"
            report_once(self, "warning", "SK-SENSOR-066", message, place.where)
        planet = WorldOnPlanet(place)
        self._earth = EarthField(self.options.year, planet)
        if _read_system_switch(world, "use_units_gauss"):
            self._scale = _GAUSS
        if _read_system_switch(world, "use_earth_frame_ned"):
            # Gazebo takes north, east, down for the world's axes, whatever its heading
            sine, cosine = np.sin(place.heading), np.cos(place.heading)
            self._to_world = np.array(((sine, cosine, 0.0), (cosine, -sine, 0.0), (0.0, 0.0, -1.0)))

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> Vector:
        position, rotation = self._frame_in_world(data)
        field = self._uniform
        if self._earth is not None:
            field = self._to_world @ self._earth.at(position) * self._scale
        seen: Vector = field @ rotation
        return seen

    def _message_of(self, reading: Vector, time_ns: int) -> msgs.MagneticField:
        field, vector = msgs.types_of(*_TYPES)
        header = msgs.header(time_ns, self.frame_id)
        message: msgs.MagneticField = field(header, vector(*reading.tolist()), self.noise.covariance())
        return message


def _read_system_switch(world: SceneWorld, name: str) -> bool:
    """A switch of the world's Magnetometer system; Gazebo's default, which is true, only with its quirks."""
    for plugin in world.plugins:
        if _SYSTEM in plugin.filename or plugin.name.endswith("::Magnetometer"):
            child = next((c for c in plugin.params.children if c.name == name), None)
            if child is not None:
                return child.value.strip().lower() in ("true", "1")
    return world.gazebo_quirks
