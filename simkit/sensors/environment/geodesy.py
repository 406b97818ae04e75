"""Latitude, longitude and height above the ellipsoid of a point of the flat world.

The world is the plane that touches the planet at the origin: its z is up there, and its x is turned from east by the
heading, counter-clockwise. What is far from the origin is therefore above the surface.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from simkit.pose import Vector
from simkit.scene import SphericalCoordinates

Geodetic = tuple[float, float, float]
"""Latitude [rad], longitude [rad, from -π to π], height above the ellipsoid [m]."""

_ROUNDS: Final = 4  # of Bowring's iteration: 1e-14 rad anywhere above the evolute, with any ellipsoid of a planet


class Ellipsoid:
    """An ellipsoid of revolution, in its own axes (x to longitude 0, z to the north pole; ECEF on Earth).

    Args:
        equatorial, polar: semi-axes [m].
    """

    def __init__(self, equatorial: float, polar: float) -> None:
        self.equatorial, self.polar = equatorial, polar
        self._e2 = 1.0 - (polar / equatorial) ** 2
        self._lift = self._e2 * equatorial**2 / polar  # second eccentricity squared, times the polar semi-axis
        self._drop = self._e2 * equatorial

    def cartesian(self, latitude: float, longitude: float, height: float) -> Vector:
        """Position [m], shape (3,)."""
        sine, cosine = math.sin(latitude), math.cos(latitude)
        normal = self.equatorial / math.sqrt(1.0 - self._e2 * sine * sine)
        out = (normal + height) * cosine
        up = (normal * (1.0 - self._e2) + height) * sine
        return np.array((out * math.cos(longitude), out * math.sin(longitude), up))

    def geodetic(self, x: float, y: float, z: float) -> Geodetic:
        """Of a position [m]; B. R. Bowring, Survey Review 23 (1976), iterated."""
        out = math.hypot(x, y)
        reduced = math.atan2(self.equatorial * z, self.polar * out)
        latitude = before = math.inf
        for _ in range(_ROUNDS):
            sine, cosine = math.sin(reduced), math.cos(reduced)
            latitude = math.atan2(z + self._lift * sine**3, out - self._drop * cosine**3)
            sine, cosine = math.sin(latitude), math.cos(latitude)
            if latitude == before:
                break
            before = latitude
            reduced = math.atan2(self.polar * sine, self.equatorial * cosine)
        # without a division, so that it holds at the poles as well
        height = out * cosine + z * sine - self.equatorial * math.sqrt(1.0 - self._e2 * sine * sine)
        return latitude, math.atan2(y, x), height


def east_north_up(latitude: float, longitude: float) -> Vector:
    """The directions east, north and up of a place, as columns in the planet's axes, shape (3, 3)."""
    sine, cosine = math.sin(latitude), math.cos(latitude)
    across, along = math.sin(longitude), math.cos(longitude)
    return np.array(
        (
            (-across, -sine * along, cosine * along),
            (along, -sine * across, cosine * across),
            (0.0, cosine, sine),
        )
    )


class WorldOnPlanet:
    """The world's frame on its planet.

    Attributes:
        ellipsoid: of the planet.
        origin: of the world in the planet's axes [m], shape (3,).
        axes: x, y and z of the world as columns in the planet's axes, shape (3, 3).
    """

    def __init__(self, place: SphericalCoordinates) -> None:
        self.ellipsoid = Ellipsoid(place.equatorial, place.polar)
        self.origin = self.ellipsoid.cartesian(place.latitude, place.longitude, place.elevation)
        sine, cosine = math.sin(place.heading), math.cos(place.heading)
        heading = np.array(((cosine, -sine, 0.0), (sine, cosine, 0.0), (0.0, 0.0, 1.0)))
        self.axes = east_north_up(place.latitude, place.longitude) @ heading

    def on_planet(self, position: Vector) -> Vector:
        """A position in the world [m], in the planet's axes [m]; both of shape (3,)."""
        found: Vector = self.origin + self.axes @ position
        return found

    def geodetic(self, position: Vector) -> Geodetic:
        """Of a position in the world [m], shape (3,)."""
        return self.ellipsoid.geodetic(*self.on_planet(position).tolist())
