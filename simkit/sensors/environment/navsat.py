"""Satellite navigation: latitude, longitude, height, and the velocity over ground."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import Final

import mujoco
import numpy as np

from simkit import msgs
from simkit.params import Params
from simkit.pose import Vector
from simkit.scene import SphericalCoordinates
from simkit.sensors.base import Product, Sensor
from simkit.sensors.environment.geodesy import WorldOnPlanet, east_north_up
from simkit.sensors.noise import Noise, NoiseModel, read_noise

FIX, VELOCITY, GPS = "sensor_msgs/msg/NavSatFix", "geometry_msgs/msg/Vector3Stamped", "gps_msgs/msg/GPSFix"
_UNKNOWN, _DIAGONAL = 0, 2  # types of a position's covariance
_STATUS_FIX, _SERVICE_GPS = 0, 1
_SOURCE_GPS, _SOURCE_DOPPLER = 1, 4
# gpsd's uncertainties are those that hold 95 % of the readings: of one and of two normal numbers
_SIGMAS_95_ONE_AXIS, _SIGMAS_95_TWO_AXES = 1.959964, math.sqrt(-2.0 * math.log(0.05))
_FARTHEST: Final = 1e30  # [m] of a reading with noise, so that its square is a number


@dataclass(frozen=True, slots=True)
class NavSatOptions:
    """The `<navsat>` (in Gazebo Classic `<gps>`) block: noise of position [m] and velocity [m/s]."""

    horizontal_position: NoiseModel
    vertical_position: NoiseModel
    horizontal_velocity: NoiseModel
    vertical_velocity: NoiseModel


@dataclass(frozen=True, slots=True)
class NavSatReading:
    """Where it is and how it moves.

    Attributes:
        east, north: on the plane that touches the planet at the world's origin [m].
        latitude, longitude: [rad].
        altitude: above the ellipsoid [m].
        velocity: to east, north and up of where it is [m/s], shape (3,).
    """

    east: float
    north: float
    latitude: float
    longitude: float
    altitude: float
    velocity: Vector


class NavSat(Sensor):
    """`navsat`, `gps`: a receiver in a world with `<spherical_coordinates>`; in one without it gives nothing.

    Noise of the position is in metres. Gazebo takes that of latitude and longitude for degrees, has no covariance, and
    gives the velocity along the world's axes whatever their heading; so does a world with `<gazebo_quirks>`.
    """

    kinds = ("navsat", "gps")
    example = "<navsat/>"
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
        """Standard deviations [m, m/s]."""
        return {"navsat": {f"{f.name}_stddev": getattr(self.options, f.name).stddev for f in fields(NavSatOptions)}}

    def prepare(self) -> None:
        options, place = self.options, self.sim.world.spherical_coordinates
        level, plumb = options.horizontal_position, options.vertical_position
        flat, climb = options.horizontal_velocity, options.vertical_velocity
        self.noise = self._make_noise((level, level, plumb, flat, flat, climb), "navsat")
        self._quirks, self._turn = self.sim.world.gazebo_quirks, 0.0
        self._place: WorldOnPlanet | None = None
        if place is None:
            message = f"sensor {self.scoped!r} gives nothing: the world has no <spherical_coordinates>"
            hint = "give the world <spherical_coordinates> with latitude_deg, longitude_deg and elevation"
            self.diagnostics.warning("SK-SENSOR-067", message, self.scene.where, hint)
        else:
            self._stand(place)

    def relocate(self) -> None:
        """The world lies elsewhere on its planet from now on."""
        place = self.sim.world.spherical_coordinates
        if place is None:
            self._place = None
        else:
            self._stand(replace(place, heading=place.heading + self._turn) if self._turn else place)

    def _stand(self, place: SphericalCoordinates) -> None:
        self._place = WorldOnPlanet(place)
        sine, cosine = math.sin(place.heading), math.cos(place.heading)
        self._heading = np.array(((cosine, -sine), (sine, cosine)))

    def use_classic_noise(self) -> None:
        """With `<gazebo_quirks>` the world's heading is half a turn off, as in Gazebo Classic, and nothing else is."""
        place = self.sim.world.spherical_coordinates
        if self._quirks and place is not None:
            self._quirks, self._turn = False, math.pi
            self._stand(replace(place, heading=place.heading + self._turn))

    def accepts(self, tick: int) -> bool:
        return self._place is not None

    def products(self) -> dict[str, Product]:
        return {
            "fix": Product(FIX, self._fix_of),
            "velocity": Product(VELOCITY, self._velocity_of),
            "gps_fix": Product(GPS, self._gps_fix_of),
        }

    def default_topics(self) -> dict[str, str]:
        topic = self._default_topic("navsat")
        return {"fix": topic, "velocity": f"{topic}/velocity", "gps_fix": f"{topic}/gps_fix"}

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> NavSatReading:
        place = self._place
        assert place is not None
        body = self._body
        lever = data.xmat[body].reshape(3, 3) @ self._offset_position
        position = data.xpos[body] + lever
        velocity = self._velocity_in_world(model, data, lever)
        latitude, longitude, altitude = place.geodetic(position)
        if not self._quirks:
            velocity = (place.axes @ velocity) @ east_north_up(latitude, longitude)
        east, north = (self._heading @ position[:2]).tolist()
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
            latitude, longitude = _normalised(math.radians(first)), _normalised(math.radians(second))
        else:
            latitude, longitude = self._move_over_ground(reading, first - reading.east, second - reading.north)
        return NavSatReading(reading.east, reading.north, latitude, longitude, altitude, values[3:])

    def _move_over_ground(self, reading: NavSatReading, east: float, north: float) -> tuple[float, float]:
        """Latitude and longitude that many metres away along the ground [m]."""
        place = self._place
        assert place is not None
        if not (east or north):
            return reading.latitude, reading.longitude
        east, north = (max(-_FARTHEST, min(v, _FARTHEST)) for v in (east, north))
        across, along, _ = east_north_up(reading.latitude, reading.longitude).T
        at = place.ellipsoid.cartesian(reading.latitude, reading.longitude, reading.altitude)
        moved = at + east * across + north * along
        return place.ellipsoid.geodetic(*moved.tolist())[:2]

    # ------------------------------------------------------------------ messages

    def _covariance(self) -> tuple[Vector, int]:
        """Of the position to east, north and up [m²], and its type."""
        return (np.zeros(9), _UNKNOWN) if self._quirks else (self.noise.covariance(), _DIAGONAL)

    def _fix_of(self, reading: NavSatReading, time_ns: int) -> msgs.NavSatFix:
        covariance, kind = self._covariance()
        return msgs.NavSatFix(
            header=msgs.header(time_ns, self.frame_id),
            status=msgs.NavSatStatus(_STATUS_FIX, _SERVICE_GPS),
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
        covariance, kind = self._covariance()
        level, plumb, flat, climb = (math.sqrt(self.noise.variance(channel)) for channel in (0, 2, 3, 5))
        message: msgs.GPSFix = msgs.make(
            GPS,
            header=msgs.header(time_ns, self.frame_id),
            status={
                "header": msgs.header(time_ns, self.frame_id),
                "status": _STATUS_FIX,
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
            err=math.hypot(_SIGMAS_95_TWO_AXES * level, _SIGMAS_95_ONE_AXIS * plumb),
            err_horz=_SIGMAS_95_TWO_AXES * level,
            err_vert=_SIGMAS_95_ONE_AXIS * plumb,
            err_speed=_SIGMAS_95_TWO_AXES * flat,
            err_climb=_SIGMAS_95_ONE_AXIS * climb,
            position_covariance=covariance,
            position_covariance_type=kind,
        )
        return message


def _normalised(angle: float) -> float:
    """From -π to π."""
    return math.remainder(angle, math.tau)
