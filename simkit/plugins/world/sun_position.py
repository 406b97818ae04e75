"""Position of the sun at a location on Earth, by NREL's Solar Position Algorithm, and its light under a clear sky."""

from __future__ import annotations

import importlib
import importlib.util
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np

from simkit.linear_algebra import matmul
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.pose import Vector

_STEP: Final = 60.0  # [s] between the times at which the algorithm runs
_BLOCK: Final = 64
_TERRESTRIAL_LAG: Final = 67.0  # [s], terrestrial time minus universal time; an error of 10 s turns the sun by 1e-7 rad
_AT_SUNRISE: Final = 0.5667  # [degrees], refraction at sunrise and sunset
_SEA_LEVEL: Final = 101325.0  # [Pa]
_BEYOND_AIR: Final = 1353.0  # [W/m²]


@dataclass(frozen=True, slots=True)
class Site:
    """Location on Earth.

    Attributes:
        latitude, longitude: [rad], north and east positive.
        elevation: height above the ellipsoid [m].
        heading: angle from east to the world's x axis, counter-clockwise [rad].
        pressure: local air pressure [Pa].
        temperature: local air temperature [K].
    """

    latitude: float
    longitude: float
    elevation: float
    heading: float
    pressure: float
    temperature: float


@dataclass(frozen=True, slots=True)
class SunDirection:
    """Apparent direction of the sun.

    Attributes:
        direction: unit vector towards the sun, world axes, shape (3,).
        elevation: angle of the sun's centre above the horizon, including the air's refraction [rad].
        azimuth: angle from north towards east [rad], from 0 to 2π.
    """

    direction: Vector
    elevation: float
    azimuth: float


class SunPath(SharedByCopies):
    """Direction of the sun at a site, as a function of time only.

    The algorithm (I. Reda, A. Andreas, Solar Position Algorithm for Solar Radiation Applications, NREL/TP-560-34302)
    takes 2 ms for one time and also for a hundred times. Directions are therefore computed in blocks, for times at
    intervals of 60 s. A cubic through the four nearest directions interpolates with an error below 1e-8 rad.

    Raises:
        ImportError: pvlib is not installed.
    """

    def __init__(self, site: Site) -> None:
        self.site = site
        self._positions = _algorithm()
        self._block: int | None = None
        self._directions: Vector = np.empty((0, 3))

    def at(self, time: float) -> SunDirection:
        """Return the sun's direction at a time [s since 1970-01-01 UTC]."""
        east, north, up = self._geometric(time).tolist()
        azimuth, elevation = math.atan2(east, north), math.atan2(up, math.hypot(east, north))
        elevation += refraction(elevation, self.site.pressure, self.site.temperature)
        level, heading = math.cos(elevation), self.site.heading
        # in the world frame, whose x axis points `heading` to the left of east
        along = math.pi / 2 - azimuth - heading
        direction = np.array((level * math.cos(along), level * math.sin(along), math.sin(elevation)))
        return SunDirection(direction, elevation, azimuth % (2 * math.pi))

    def _geometric(self, time: float) -> Vector:
        """Return the sun's direction (east, north, up) without refraction, shape (3,)."""
        step = math.floor(time / _STEP)
        block, row = divmod(step, _BLOCK)
        if block != self._block:
            # the cubic needs one more row before the block and two after it
            times = _STEP * np.arange(block * _BLOCK - 1, (block + 1) * _BLOCK + 2, dtype=np.float64)
            self._directions, self._block = self._computed_directions(times), block
        t = time / _STEP - step
        weights = (
            -t * (t - 1) * (t - 2) / 6,
            (t + 1) * (t - 1) * (t - 2) / 2,
            -(t + 1) * t * (t - 2) / 2,
            (t + 1) * t * (t - 1) / 6,
        )
        direction: Vector = matmul(np.array(weights), self._directions[row : row + 4])
        return direction / math.sqrt(matmul(direction, direction))

    def _computed_directions(self, times: Vector) -> Vector:
        site = self.site
        place = math.degrees(site.latitude), math.degrees(site.longitude), site.elevation
        air = site.pressure / 100.0, site.temperature - 273.15
        rows = self._positions(times, *place, *air, _TERRESTRIAL_LAG, _AT_SUNRISE)
        elevation, azimuth = np.radians(rows[3]), np.radians(rows[4])
        level = np.cos(elevation)
        return np.stack((level * np.sin(azimuth), level * np.cos(azimuth), np.sin(elevation)), axis=-1)


def refraction(elevation: float, pressure: float, temperature: float) -> float:
    """Return the refraction of sunlight [rad] at a geometric elevation [rad].

    Saemundsson's formula as in NREL's algorithm; 0 if the whole sun is below the horizon.

    Args:
        elevation: elevation of the sun without air [rad].
        pressure: air pressure [Pa].
        temperature: air temperature [K].
    """
    degrees = math.degrees(elevation)
    if degrees < -(0.26667 + _AT_SUNRISE):
        return 0.0
    lift = 1.02 / (60.0 * math.tan(math.radians(degrees + 10.3 / (degrees + 5.11))))
    return math.radians(lift * (pressure / 101000.0) * (283.0 / (temperature - 0.15)))


def air_mass(elevation: float) -> float:
    """Return the path of sunlight through the air, in units of the vertical path at sea level.

    The formula is that of F. Kasten and A. T. Young (1989).

    Args:
        elevation: apparent elevation of the sun [rad], not below the horizon.
    """
    degrees = math.degrees(max(0.0, elevation))
    return float(1.0 / (math.sin(math.radians(degrees)) + 0.50572 * (degrees + 6.07995) ** -1.6364))


def clear_sky(elevation: float, pressure: float) -> float:
    """Return the irradiance [W/m²] of a surface that faces the sun under a clear sky, without diffuse light.

    A. B. Meinel, M. P. Meinel, Applied Solar Energy (1976): 1353 W/m² · 0.7^(AM^0.678), with the air mass by Kasten and
    Young, times the ratio of the pressure to the pressure at sea level.

    Args:
        elevation: apparent elevation of the sun [rad]; the result is 0 below the horizon.
        pressure: air pressure [Pa].
    """
    if elevation <= 0.0:
        return 0.0
    return float(_BEYOND_AIR * 0.7 ** ((air_mass(elevation) * pressure / _SEA_LEVEL) ** 0.678))


@cache
def _algorithm() -> Callable[..., Vector]:
    """Return the function `spa.solar_position` of pvlib.

    Only the file of this function is loaded. The file needs only NumPy, while the whole package takes more than a
    second to import.
    """
    package = importlib.util.find_spec("pvlib")
    if package is None or not package.submodule_search_locations:
        raise ImportError("pvlib is not installed")
    path = Path(next(iter(package.submodule_search_locations))) / "spa.py"
    spec = importlib.util.spec_from_file_location("simkit_pvlib_spa", path) if path.is_file() else None
    if spec is None or spec.loader is None or "pvlib.spa" in sys.modules:
        spa = importlib.import_module("pvlib.spa")
    else:
        spa = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(spa)
    solar_position: Callable[..., Vector] = spa.solar_position
    return solar_position
