"""Magnetometer: the magnetic field at the sensor, in the sensor's axes."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from simkit import msgs
from simkit.linear_algebra import matmul
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
from simkit.sensors.measured_rows import MeasuredRows
from simkit.sensors.noise import ThreeAxes, read_axes
from simkit.sensors.vector_sensor import VectorSensor

_TYPES = "sensor_msgs/msg/MagneticField", "geometry_msgs/msg/Vector3"
_GAUSS = 1e4  # gauss per tesla
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
    element = block.child("date")
    if element is None:
        return DEFAULT_DATE
    try:
        year = decimal_year(element.value)
    except ValueError:
        year = float("nan")
    if FIRST_YEAR <= year <= LAST_YEAR:
        return year
    allowed = f"expected a date such as 2026-07-01 or 2026.5, from {FIRST_YEAR:g} to {LAST_YEAR:g}"
    element.error("SK-SENSOR-063", f"found <date>{element.value[:60]}</date>, {allowed}")
    return DEFAULT_DATE


class Magnetometer(VectorSensor["msgs.MagneticField"]):
    """Magnetometer, `magnetometer`: the world's `<magnetic_field>`, or the Earth's field if the world has a location.

    The reading is in tesla, in the sensor's axes; `<spherical_coordinates>` give the location. Gazebo's Magnetometer
    system uses gauss instead of tesla, and north, east, down along the world's x, y, z. simkit does the same if the
    file sets these options in the system's plugin, or in a world with `<gazebo_quirks>`.
    """

    kinds = ("magnetometer",)
    example = "<magnetometer/>"
    sees_scene = False
    product, message_type = "magnetometer", _TYPES[0]
    options: MagnetometerOptions

    def read_options(self, params: Params) -> MagnetometerOptions:
        block = params.block("magnetometer")
        return MagnetometerOptions(read_axes(block), _read_year(block))

    def describe(self) -> dict[str, object]:
        """Return the decimal year of the Earth's field and the standard deviations [T]."""
        return {"magnetometer": {"year": self.options.year, "stddev": [axis.stddev for axis in self.options.axes]}}

    def prepare(self) -> None:
        world = self.sim.world
        self.noise = self._make_noise(self.options.axes, "magnetometer")
        self._uniform: Vector = np.array(world.magnetic_field)
        self.relocate()

    def relocate(self) -> None:
        """Update the field after a change of the world's location."""
        world = self.sim.world
        self._earth: EarthField | None = None
        self._scale, self._to_world = 1.0, np.eye(3)
        if world.spherical_coordinates is not None:
            self._locate_on_planet(world)

    def _locate_on_planet(self, world: SceneWorld) -> None:
        coordinates = world.spherical_coordinates
        assert coordinates is not None
        is_field_set = world.magnetic_field != SceneWorld().magnetic_field
        if coordinates.surface != _EARTH:
            message = f"simkit has no magnetic model of {coordinates.surface}; the world's <magnetic_field> is used"
            report_once(self, "note", "SK-SENSOR-064", message, coordinates.where)
            return
        if is_field_set:
            message = "<magnetic_field> is replaced by the Earth's field: the world has <spherical_coordinates>"
            hint = "remove <spherical_coordinates> to use this <magnetic_field>"
            report_once(self, "warning", "SK-SENSOR-065", message, world.where, hint)
        if not MIN_HEIGHT <= coordinates.elevation <= MAX_HEIGHT:
            allowed = f"{MIN_HEIGHT:g} to {MAX_HEIGHT:g} m"
            message = f"<elevation> {coordinates.elevation:g} m is outside the Earth's magnetic model, {allowed}"
            report_once(self, "warning", "SK-SENSOR-066", message, coordinates.where)
        planet = WorldOnPlanet(coordinates)
        self._earth = EarthField(self.options.year, planet)
        if _read_system_switch(world, "use_units_gauss"):
            self._scale = _GAUSS
        if _read_system_switch(world, "use_earth_frame_ned"):
            # Gazebo ignores the world's heading when it maps north, east and down to the world's axes
            sine, cosine = np.sin(coordinates.heading), np.cos(coordinates.heading)
            self._to_world = np.array(((sine, cosine, 0.0), (cosine, -sine, 0.0), (0.0, 0.0, -1.0)))

    def array_rule(self) -> MeasuredRows:
        return MeasuredRows(self)

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> Vector:
        position, rotation = self._frame_in_world(data)
        field = self._uniform
        if self._earth is not None:
            field = matmul(self._to_world, self._earth.at(position)) * self._scale
        measured: Vector = matmul(field, rotation)
        return measured

    def _message_of(self, reading: Vector, time_ns: int) -> msgs.MagneticField:
        field, vector = msgs.types_of(*_TYPES)
        header = msgs.header(time_ns, self.frame_id)
        message: msgs.MagneticField = field(header, vector(*reading.tolist()), self.noise.covariance())
        return message


def _read_system_switch(world: SceneWorld, name: str) -> bool:
    """Read a boolean option of the world's Magnetometer system; the default is true only with `<gazebo_quirks>`."""
    for plugin in world.plugins:
        if _SYSTEM in plugin.filename or plugin.name.endswith("::Magnetometer"):
            child = next((c for c in plugin.params.children if c.name == name), None)
            if child is not None:
                return child.value.strip().lower() in ("true", "1")
    return world.gazebo_quirks
