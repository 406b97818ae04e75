"""Location of a world on a planet, with the interface of gz-math."""

from __future__ import annotations

import enum
import math
from typing import ClassVar, Final

import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul
from simkit.scene import SphericalCoordinates as Place
from simkit.sensors.environment.geodesy import WorldOnPlanet
from simkit_gz_python.math.angle import Angle
from simkit_gz_python.math.value_base import CppArgument, Value
from simkit_gz_python.math.vectors import Vector3d, VectorLike, components_of

MEAN_EARTH_RADIUS: Final = 6371000.0  # [m], for distances between points


class Surface(enum.IntEnum):
    """Surfaces of the supported planets, or a custom ellipsoid."""

    EARTH_WGS84 = 1
    MOON_SCS = 2
    CUSTOM_SURFACE = 10


class Coordinates(enum.IntEnum):
    """Coordinate systems of a position."""

    SPHERICAL = 1
    ECEF = 2
    GLOBAL = 3
    LOCAL = 4


_AXES: Final = {  # semi-axes [m]
    Surface.EARTH_WGS84: (6378137.0, 6356752.314245),
    Surface.MOON_SCS: (1738100.0, 1736000.0),
}
_RADIUS: Final = {Surface.EARTH_WGS84: MEAN_EARTH_RADIUS, Surface.MOON_SCS: 1737400.0}


class SphericalCoordinates(Value):
    """Location of the world's origin on a planet; the heading is the counter-clockwise angle from east to the x axis.

    The arguments are `()`, `(coordinates)`, `(surface)`, `(surface, equatorial semi-axis, polar semi-axis)` [m] or
    `(surface, latitude, longitude, elevation, heading)` with `Angle` objects and the elevation [m].
    """

    SurfaceType: ClassVar = Surface
    CoordinateType: ClassVar = Coordinates
    EARTH_WGS84, MOON_SCS, CUSTOM_SURFACE = Surface
    SPHERICAL, ECEF, GLOBAL, LOCAL = Coordinates

    def __init__(self, *values: CppArgument) -> None:
        self._surface = Surface.EARTH_WGS84
        self._equatorial, self._polar = _AXES[self._surface]
        self._latitude, self._longitude, self._heading = Angle(), Angle(), Angle()
        self._elevation = 0.0
        if len(values) == 1 and isinstance(values[0], SphericalCoordinates):
            vars(self).update({k: Angle(v) if isinstance(v, Angle) else v for k, v in vars(values[0]).items()})
        elif len(values) in (1, 3):
            self.set_surface(*values)
        elif len(values) == 5:
            self.set_surface(values[0])
            self._latitude, self._longitude, self._heading = Angle(values[1]), Angle(values[2]), Angle(values[4])
            self._elevation = float(values[3])
        elif values:
            raise TypeError(f"expected 0, 1, 3 or 5 values for spherical coordinates, got {len(values)}")

    @staticmethod
    def convert(value: Surface | str) -> str | Surface:
        """Convert a surface to its name, or a name to its surface; an unknown name becomes the Earth."""
        if isinstance(value, Surface):
            return value.name
        return Surface.__members__.get(value, Surface.EARTH_WGS84)

    # ------------------------------------------------------------------ the surface

    def surface(self) -> Surface:
        return self._surface

    def set_surface(self, surface: Surface, equatorial: float = 0.0, polar: float = 0.0) -> None:
        """Set the surface to a planet, or to a custom ellipsoid with the equatorial and polar semi-axes [m]."""
        self._surface = Surface(surface)
        if self._surface in _AXES:
            self._equatorial, self._polar = _AXES[self._surface]
        elif equatorial > 0.0 and polar > 0.0:
            self._equatorial, self._polar = float(equatorial), float(polar)

    def surface_radius(self) -> float:
        """Return the mean radius [m], which `distance_between_points` uses."""
        return _RADIUS.get(self._surface, (2.0 * self._equatorial + self._polar) / 3.0)

    def surface_axis_equatorial(self) -> float:
        return self._equatorial

    def surface_axis_polar(self) -> float:
        return self._polar

    def surface_flattening(self) -> float:
        return (self._equatorial - self._polar) / self._equatorial

    # ------------------------------------------------------------------ the location

    def latitude_reference(self) -> Angle:
        return Angle(self._latitude)

    def set_latitude_reference(self, angle: Angle) -> None:
        self._latitude = Angle(angle)

    def longitude_reference(self) -> Angle:
        return Angle(self._longitude)

    def set_longitude_reference(self, angle: Angle) -> None:
        self._longitude = Angle(angle)

    def elevation_reference(self) -> float:
        """Return the elevation [m]."""
        return self._elevation

    def set_elevation_reference(self, elevation: float) -> None:
        self._elevation = float(elevation)

    def heading_offset(self) -> Angle:
        return Angle(self._heading)

    def set_heading_offset(self, angle: Angle) -> None:
        self._heading = Angle(angle)

    def update_transformation_matrix(self) -> None:
        """Do nothing: no matrix is cached."""

    # ------------------------------------------------------------------ conversions

    def _place(self) -> WorldOnPlanet:
        return WorldOnPlanet(
            Place(
                float(self._latitude),
                float(self._longitude),
                self._elevation,
                float(self._heading),
                surface=self._surface.name,
                equatorial=self._equatorial,
                polar=self._polar,
            )
        )

    def spherical_from_local_position(self, position: VectorLike) -> Vector3d:
        """Convert a position in the world [m] to latitude [°], longitude [°] and height [m]."""
        latitude, longitude, height = self.position_transform(position, Coordinates.LOCAL, Coordinates.SPHERICAL)
        return Vector3d(math.degrees(latitude), math.degrees(longitude), height)

    def local_from_spherical_position(self, position: VectorLike) -> Vector3d:
        """Convert latitude [°], longitude [°] and height [m] to a position in the world [m]."""
        latitude, longitude, height = components_of(position, 3)
        spherical = Vector3d(math.radians(latitude), math.radians(longitude), height)
        return self.position_transform(spherical, Coordinates.SPHERICAL, Coordinates.LOCAL)

    def global_from_local_velocity(self, velocity: VectorLike) -> Vector3d:
        """Convert a velocity from the world's axes to east, north and up [m/s]."""
        return self.velocity_transform(velocity, Coordinates.LOCAL, Coordinates.GLOBAL)

    def local_from_global_velocity(self, velocity: VectorLike) -> Vector3d:
        """Convert a velocity from east, north and up to the world's axes [m/s]."""
        return self.velocity_transform(velocity, Coordinates.GLOBAL, Coordinates.LOCAL)

    def position_transform(self, position: VectorLike, from_type: Coordinates, to_type: Coordinates) -> Vector3d:
        """Convert a position from one coordinate system to another.

        The systems are spherical (latitude [rad], longitude [rad], height [m]), the planet's axes, east-north-up and
        the world's axes [m].
        """
        place, point = self._place(), np.array(components_of(position, 3))
        level, start, end = self._level(place), Coordinates(from_type), Coordinates(to_type)
        if start is Coordinates.SPHERICAL:
            point = place.ellipsoid.cartesian(*point.tolist())
        elif start is not Coordinates.ECEF:
            axes = level if start is Coordinates.GLOBAL else place.axes
            point = place.origin + matmul(axes, point)
        if end is Coordinates.SPHERICAL:
            return Vector3d(*place.ellipsoid.geodetic(*point.tolist()))
        if end is not Coordinates.ECEF:
            axes = level if end is Coordinates.GLOBAL else place.axes
            point = matmul(axes.T, point - place.origin)
        return Vector3d(*point.tolist())

    def velocity_transform(self, velocity: VectorLike, from_type: Coordinates, to_type: Coordinates) -> Vector3d:
        """Convert a velocity [m/s] between the planet's axes, east-north-up and the world's axes.

        Raises:
            ValueError: one of the two coordinate systems is spherical, in which a velocity is not defined.
        """
        if Coordinates.SPHERICAL in (from_type, to_type):
            raise ValueError("a velocity is not defined in spherical coordinates; use ECEF, GLOBAL or LOCAL")
        place = self._place()
        axes = {Coordinates.ECEF: np.eye(3), Coordinates.GLOBAL: self._level(place), Coordinates.LOCAL: place.axes}
        turned = matmul(axes[Coordinates(to_type)].T, axes[Coordinates(from_type)])
        return Vector3d(*matmul(turned, np.array(components_of(velocity, 3))).tolist())

    def _level(self, place: WorldOnPlanet) -> npt.NDArray[np.float64]:
        """Return east, north and up at the origin as columns in the planet's axes, shape (3, 3)."""
        sine, cosine = math.sin(float(self._heading)), math.cos(float(self._heading))
        level: npt.NDArray[np.float64] = matmul(
            place.axes, np.array(((cosine, sine, 0.0), (-sine, cosine, 0.0), (0.0, 0.0, 1.0)))
        )
        return level

    @staticmethod
    def distance_WGS84(lat_a: Angle, lon_a: Angle, lat_b: Angle, lon_b: Angle) -> float:  # noqa: N802 - gz-math's name
        """Return the distance [m] of two points along a sphere with the Earth's mean radius."""
        return _along_sphere(MEAN_EARTH_RADIUS, lat_a, lon_a, lat_b, lon_b)

    def distance_between_points(self, lat_a: Angle, lon_a: Angle, lat_b: Angle, lon_b: Angle) -> float:
        """Return the distance [m] of two points along a sphere with this surface's mean radius."""
        return _along_sphere(self.surface_radius(), lat_a, lon_a, lat_b, lon_b)

    def __eq__(self, other: object) -> bool:
        return vars(self) == vars(other) if isinstance(other, SphericalCoordinates) else NotImplemented


def _along_sphere(radius: float, lat_a: Angle, lon_a: Angle, lat_b: Angle, lon_b: Angle) -> float:
    """Return the distance [m] along a sphere by the haversine formula."""
    across = math.sin((float(lat_b) - float(lat_a)) / 2) ** 2
    along = math.sin((float(lon_b) - float(lon_a)) / 2) ** 2 * math.cos(float(lat_a)) * math.cos(float(lat_b))
    return 2.0 * radius * math.atan2(math.sqrt(across + along), math.sqrt(1.0 - across - along))
