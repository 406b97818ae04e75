"""Satellite navigation: latitude, longitude, height, and velocity over ground."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import Final

import mujoco
import numpy as np

from simkit import msgs
from simkit.linear_algebra import matmul
from simkit.params import Params
from simkit.pose import Vector, wrap_angle
from simkit.scene import SphericalCoordinates
from simkit.sensors.base import Product, Sensor
from simkit.sensors.environment.geodesy import WorldOnPlanet, east_north_up
from simkit.sensors.measured_rows import MeasuredRows
from simkit.sensors.noise import Noise, NoiseModel, read_noise

FIX, VELOCITY, GPS = "sensor_msgs/msg/NavSatFix", "geometry_msgs/msg/Vector3Stamped", "gps_msgs/msg/GPSFix"
_UNKNOWN, _DIAGONAL = 0, 2  # covariance types of NavSatFix
NO_FIX: Final = -1  # status of NavSatStatus and GPSStatus without a position
_SERVICE_GPS = 1
_SOURCE_GPS, _SOURCE_DOPPLER = 1, 4
# gpsd's uncertainties contain 95 % of the readings; factors of the standard deviation, for one axis and for two axes
_SIGMAS_95_ONE_AXIS, _SIGMAS_95_TWO_AXES = 1.959964, math.sqrt(-2.0 * math.log(0.05))
_FARTHEST: Final = 1e30  # [m] limit of noise, so that its square is finite


@dataclass(frozen=True, slots=True)
class NavSatOptions:
    """The `<navsat>` block (`<gps>` in Gazebo Classic): noise of position [m] and velocity [m/s]."""

    horizontal_position: NoiseModel
    vertical_position: NoiseModel
    horizontal_velocity: NoiseModel
    vertical_velocity: NoiseModel


@dataclass(frozen=True, slots=True)
class NavSatReading:
    """Position and velocity of the receiver.

    Attributes:
        east, north: position on the plane that touches the planet at the world's origin [m].
        latitude, longitude: geodetic position [rad].
        altitude: height above the ellipsoid [m].
        velocity: velocity to east, north and up at the position [m/s], shape (3,).
        status: type of the fix as in `NavSatStatus`: -1 without a fix, 0 with one, 1 and 2 with corrections from
            satellites and from the ground.
        variances: horizontal and vertical variance [m²] that the receiver adds to those of the noise.
        satellites: number of satellites in use; 0 if it is not known.
    """

    east: float
    north: float
    latitude: float
    longitude: float
    altitude: float
    velocity: Vector
    status: int = 0
    variances: tuple[float, float] = (0.0, 0.0)
    satellites: int = 0


class NavSat(Sensor["msgs.NavSatFix"]):
    """Satellite receiver, `navsat` or `gps`; without `<spherical_coordinates>` in the world it publishes nothing.

    Noise of the position is in metres. Gazebo differs in three ways: it adds the noise to latitude and longitude in
    degrees, publishes no covariance, and publishes the velocity along the world's axes without the heading. A world
    with `<gazebo_quirks>` does the same.
    """

    kinds = ("navsat", "gps")
    artefact_families = ("navsat",)
    example = "<navsat/>"
    sees_scene = False
    options: NavSatOptions
    noise: Noise

    def read_options(self, params: Params) -> NavSatOptions:
        block = params.child("navsat") or params.block("gps")
        noises = {
            f"{axis}_{quantity}": read_noise(block.block(f"{quantity}_sensing").block(axis))
            for quantity in ("position", "velocity")
            for axis in ("horizontal", "vertical")
        }
        return NavSatOptions(**noises)

    def describe(self) -> dict[str, object]:
        """Return the standard deviations of position [m] and velocity [m/s]."""
        return {"navsat": {f"{f.name}_stddev": getattr(self.options, f.name).stddev for f in fields(NavSatOptions)}}

    def prepare(self) -> None:
        options, coordinates = self.options, self.sim.world.spherical_coordinates
        horizontal, vertical = options.horizontal_position, options.vertical_position
        horizontal_rate, vertical_rate = options.horizontal_velocity, options.vertical_velocity
        models = (horizontal, horizontal, vertical, horizontal_rate, horizontal_rate, vertical_rate)
        self.noise = self._make_noise(models, "navsat")
        self._quirks, self._heading_offset = self.sim.world.gazebo_quirks, 0.0
        self._planet: WorldOnPlanet | None = None
        if coordinates is None:
            message = f"sensor {self.scoped!r} publishes nothing: the world has no <spherical_coordinates>"
            hint = "add to the world <spherical_coordinates> with latitude_deg, longitude_deg and elevation"
            self.diagnostics.warning("SK-SENSOR-067", message, self.scene.where, hint)
        else:
            self._locate(coordinates)

    def relocate(self) -> None:
        """Update the receiver after a change of the world's location."""
        coordinates, offset = self.sim.world.spherical_coordinates, self._heading_offset
        if coordinates is None:
            self._planet = None
        else:
            self._locate(replace(coordinates, heading=coordinates.heading + offset) if offset else coordinates)

    def _locate(self, coordinates: SphericalCoordinates) -> None:
        self._planet = WorldOnPlanet(coordinates)
        sine, cosine = math.sin(coordinates.heading), math.cos(coordinates.heading)
        self._heading = np.array(((cosine, -sine), (sine, cosine)))

    def use_classic_noise(self) -> None:
        """Use the quirk of Gazebo Classic, a heading rotated by half a turn, in a world with `<gazebo_quirks>`."""
        coordinates = self.sim.world.spherical_coordinates
        if self._quirks and coordinates is not None:
            self._quirks, self._heading_offset = False, math.pi
            self._locate(replace(coordinates, heading=coordinates.heading + self._heading_offset))

    @property
    def selects_ticks(self) -> bool:
        return self._planet is None or self._is_switched

    def accepts(self, tick: int) -> bool:
        return self._planet is not None

    def products(self) -> dict[str, Product]:
        return {
            "fix": Product(FIX, self._fix_of),
            "velocity": Product(VELOCITY, self._velocity_of),
            "gps_fix": Product(GPS, self._gps_fix_of),
        }

    def default_topics(self) -> dict[str, str]:
        topic = self._default_topic("navsat")
        return {"fix": topic, "velocity": f"{topic}/velocity", "gps_fix": f"{topic}/gps_fix"}

    def array_rule(self) -> MeasuredRows:
        return MeasuredRows(self)

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> NavSatReading:
        planet = self._planet
        assert planet is not None
        body = self._body
        lever = matmul(data.xmat[body].reshape(3, 3), self._offset_position)
        position = data.xpos[body] + lever
        velocity = self._velocity_in_world(model, data, lever)
        latitude, longitude, altitude = planet.geodetic(position)
        if not self._quirks:
            velocity = matmul(planet.axes, velocity, east_north_up(latitude, longitude))
        east, north = matmul(self._heading, position[:2]).tolist()
        return NavSatReading(east, north, latitude, longitude, altitude, velocity)

    def perturb(self, reading: NavSatReading, index: int) -> NavSatReading:
        if self.noise.is_silent:
            return reading
        if self._quirks:
            first, second = math.degrees(reading.latitude), math.degrees(reading.longitude)
        else:
            first, second = reading.east, reading.north
        values = self.noise.apply(np.array((first, second, reading.altitude, *reading.velocity.tolist())), index)
        first, second, altitude = values[:3].tolist()
        if self._quirks:
            latitude, longitude = wrap_angle(math.radians(first)), wrap_angle(math.radians(second))
        else:
            latitude, longitude = self.move_over_ground(reading, first - reading.east, second - reading.north)
        return NavSatReading(reading.east, reading.north, latitude, longitude, altitude, values[3:])

    def plane_position(self, reading: NavSatReading) -> tuple[float, float]:
        """Return x and y [m] in the world of the position without noise."""
        x, y = matmul(self._heading.T, np.array((reading.east, reading.north))).tolist()
        return x, y

    def move_over_ground(self, reading: NavSatReading, east: float, north: float) -> tuple[float, float]:
        """Return the latitude and longitude [rad] of a reading displaced by `east` and `north` on the ground [m]."""
        planet = self._planet
        assert planet is not None
        if not (east or north):
            return reading.latitude, reading.longitude
        east, north = (max(-_FARTHEST, min(v, _FARTHEST)) for v in (east, north))
        across, along, _ = east_north_up(reading.latitude, reading.longitude).T
        position = planet.ellipsoid.cartesian(reading.latitude, reading.longitude, reading.altitude)
        moved = position + east * across + north * along
        return planet.ellipsoid.geodetic(*moved.tolist())[:2]

    # ------------------------------------------------------------------ messages

    def _covariance(self, reading: NavSatReading) -> tuple[Vector, int]:
        """Return the covariance of the position to east, north and up [m²], and its type."""
        if self._quirks or reading.status == NO_FIX:
            return np.zeros(9), _UNKNOWN
        covariance = self.noise.covariance()
        horizontal, vertical = reading.variances
        if horizontal or vertical:
            covariance = covariance.copy()
            covariance[[0, 4, 8]] += (horizontal, horizontal, vertical)
        return covariance, _DIAGONAL

    def _fix_of(self, reading: NavSatReading, time_ns: int) -> msgs.NavSatFix:
        covariance, kind = self._covariance(reading)
        return msgs.NavSatFix(
            header=msgs.header(time_ns, self.frame_id),
            status=msgs.NavSatStatus(reading.status, _SERVICE_GPS),
            latitude=math.degrees(reading.latitude),
            longitude=math.degrees(reading.longitude),
            altitude=reading.altitude,
            position_covariance=covariance,
            position_covariance_type=kind,
        )

    def _velocity_of(self, reading: NavSatReading, time_ns: int) -> msgs.Vector3Stamped:
        vector = msgs.Vector3(*reading.velocity.tolist())
        return msgs.Vector3Stamped(msgs.header(time_ns, self.frame_id), vector)

    def _gps_fix_of(self, reading: NavSatReading, time_ns: int) -> msgs.GPSFix:
        east, north, up = reading.velocity.tolist()
        covariance, kind = self._covariance(reading)
        more = (*reading.variances, 0.0, 0.0)
        variances = [self.noise.variance(channel) + extra for channel, extra in zip((0, 2, 3, 5), more, strict=True)]
        unknown = 0.0 if reading.status != NO_FIX else math.nan
        deviations = (math.sqrt(variance) + unknown for variance in variances)
        horizontal, vertical, horizontal_rate, vertical_rate = deviations
        message: msgs.GPSFix = msgs.make(
            GPS,
            header=msgs.header(time_ns, self.frame_id),
            status={
                "header": msgs.header(time_ns, self.frame_id),
                "status": reading.status,
                "satellites_used": reading.satellites,
                "motion_source": _SOURCE_DOPPLER,
                "position_source": _SOURCE_GPS,
            },
            latitude=math.degrees(reading.latitude),
            longitude=math.degrees(reading.longitude),
            altitude=reading.altitude,
            track=math.degrees(math.atan2(east, north)) % 360.0,
            speed=math.hypot(east, north),
            climb=up,
            time=time_ns * 1e-9,
            err=math.hypot(_SIGMAS_95_TWO_AXES * horizontal, _SIGMAS_95_ONE_AXIS * vertical),
            err_horz=_SIGMAS_95_TWO_AXES * horizontal,
            err_vert=_SIGMAS_95_ONE_AXIS * vertical,
            err_speed=_SIGMAS_95_TWO_AXES * horizontal_rate,
            err_climb=_SIGMAS_95_ONE_AXIS * vertical_rate,
            position_covariance=covariance,
            position_covariance_type=kind,
        )
        return message
