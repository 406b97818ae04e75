"""Geodesy: latitude, longitude and height above the ellipsoid of a point of the flat world.

The world is the plane that touches the planet at the origin. Its z axis is the vertical there, and its x axis is
rotated from east by the heading, counter-clockwise. A point far from the origin is therefore above the surface.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from simkit.linear_algebra import matmul
from simkit.pose import Vector
from simkit.scene import SphericalCoordinates

Geodetic = tuple[float, float, float]
"""Latitude [rad], longitude [rad, from -π to π] and height above the ellipsoid [m]."""

_ROUNDS: Final = (
    4  # iterations of Bowring's method; the error above the evolute is 1e-14 rad for any planet's ellipsoid
)


class Ellipsoid:
    """Ellipsoid of revolution, in its own axes (x to longitude 0, z to the north pole; ECEF on Earth).

    Args:
        equatorial, polar: semi-axes [m].
    """

    def __init__(self, equatorial: float, polar: float) -> None:
        self.equatorial, self.polar = equatorial, polar
        self._e2 = 1.0 - (polar / equatorial) ** 2
        self._lift = self._e2 * equatorial**2 / polar  # second eccentricity squared, times the polar semi-axis
        self._drop = self._e2 * equatorial

    def cartesian(self, latitude: float, longitude: float, height: float) -> Vector:
        """Return the position [m], shape (3,), of a latitude [rad], longitude [rad] and height [m]."""
        sine, cosine = math.sin(latitude), math.cos(latitude)
        normal = self.equatorial / math.sqrt(1.0 - self._e2 * sine * sine)
        out = (normal + height) * cosine
        up = (normal * (1.0 - self._e2) + height) * sine
        return np.array((out * math.cos(longitude), out * math.sin(longitude), up))

    def geodetic(self, x: float, y: float, z: float) -> Geodetic:
        """Return the geodetic coordinates of a position [m] (B. R. Bowring, Survey Review 23 (1976), iterated)."""
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
        # a formula without a division, so that it is valid at the poles as well
        height = out * cosine + z * sine - self.equatorial * math.sqrt(1.0 - self._e2 * sine * sine)
        return latitude, math.atan2(y, x), height


def east_north_up(latitude: float, longitude: float) -> Vector:
    """Return the unit vectors east, north and up at a point, as columns in the planet's axes, shape (3, 3)."""
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
    """Frame of the world on its planet.

    Attributes:
        ellipsoid: ellipsoid of the planet.
        origin: origin of the world in the planet's axes [m], shape (3,).
        axes: x, y and z of the world as columns in the planet's axes, shape (3, 3).
    """

    def __init__(self, coordinates: SphericalCoordinates) -> None:
        self.ellipsoid = Ellipsoid(coordinates.equatorial, coordinates.polar)
        latitude, longitude = coordinates.latitude, coordinates.longitude
        self.origin = self.ellipsoid.cartesian(latitude, longitude, coordinates.elevation)
        sine, cosine = math.sin(coordinates.heading), math.cos(coordinates.heading)
        heading = np.array(((cosine, -sine, 0.0), (sine, cosine, 0.0), (0.0, 0.0, 1.0)))
        self.axes = matmul(east_north_up(latitude, longitude), heading)

    def on_planet(self, position: Vector) -> Vector:
        """Return a world position [m] in the planet's axes [m]; both of shape (3,)."""
        position_on_planet: Vector = self.origin + matmul(self.axes, position)
        return position_on_planet

    def geodetic(self, position: Vector) -> Geodetic:
        """Return the geodetic coordinates of a position in the world [m], shape (3,)."""
        return self.ellipsoid.geodetic(*self.on_planet(position).tolist())
