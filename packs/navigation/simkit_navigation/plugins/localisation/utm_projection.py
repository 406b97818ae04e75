"""Universal Transverse Mercator: plane coordinates of geographic ones on the ellipsoid WGS 84.

The series are those of Krüger to the third order; the error is below a millimetre within 3000 km of the meridian.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

_RADIUS: Final = 6378137.0  # [m] semi-major axis
_FLATTENING: Final = 1 / 298.257223563
_N: Final = _FLATTENING / (2 - _FLATTENING)
_MERIDIAN: Final = _RADIUS / (1 + _N) * (1 + _N**2 / 4 + _N**4 / 64)  # [m]
_SCALE: Final = 0.9996
_EAST: Final = 500_000.0  # [m] of the central meridian
_SOUTH: Final = 10_000_000.0  # [m] of the equator, south of it
_FORWARD: Final = (
    _N / 2 - 2 * _N**2 / 3 + 5 * _N**3 / 16,
    13 * _N**2 / 48 - 3 * _N**3 / 5,
    61 * _N**3 / 240,
)
_BACKWARD: Final = (
    _N / 2 - 2 * _N**2 / 3 + 37 * _N**3 / 96,
    _N**2 / 48 + _N**3 / 15,
    17 * _N**3 / 480,
)
_LATITUDE: Final = (
    2 * _N - 2 * _N**2 / 3 - 2 * _N**3,
    7 * _N**2 / 3 - 8 * _N**3 / 5,
    56 * _N**3 / 15,
)


@dataclass(frozen=True)
class UtmZone:
    """Zone of the projection.

    Attributes:
        number: 1 to 60.
        is_south: True south of the equator.
    """

    number: int
    is_south: bool

    @classmethod
    def around(cls, latitude: float, longitude: float) -> UtmZone:
        """Return the zone of a point [deg]; the exceptions of Norway and Svalbard are left out."""
        return cls(int((longitude + 180.0) // 6.0) % 60 + 1, latitude < 0.0)

    @property
    def meridian(self) -> float:
        """Longitude of the central meridian [rad]."""
        return math.radians(self.number * 6 - 183)

    def project(self, latitude: float, longitude: float) -> tuple[float, float]:
        """Return easting and northing [m] of a point [deg]."""
        sine = math.sin(math.radians(latitude))
        share = 2 * math.sqrt(_N) / (1 + _N)
        t = math.sinh(math.atanh(sine) - share * math.atanh(share * sine))
        away = math.radians(longitude) - self.meridian
        xi, eta = math.atan2(t, math.cos(away)), math.atanh(math.sin(away) / math.hypot(1.0, t))
        east, north = eta, xi
        for k, factor in enumerate(_FORWARD, 1):
            east += factor * math.cos(2 * k * xi) * math.sinh(2 * k * eta)
            north += factor * math.sin(2 * k * xi) * math.cosh(2 * k * eta)
        begin = _SOUTH if self.is_south else 0.0
        return _EAST + _SCALE * _MERIDIAN * east, begin + _SCALE * _MERIDIAN * north

    def unproject(self, easting: float, northing: float) -> tuple[float, float]:
        """Return latitude and longitude [deg] of plane coordinates [m]."""
        begin = _SOUTH if self.is_south else 0.0
        xi, eta = (northing - begin) / (_SCALE * _MERIDIAN), (easting - _EAST) / (_SCALE * _MERIDIAN)
        x, y = xi, eta
        for k, factor in enumerate(_BACKWARD, 1):
            x -= factor * math.sin(2 * k * xi) * math.cosh(2 * k * eta)
            y -= factor * math.cos(2 * k * xi) * math.sinh(2 * k * eta)
        conformal = math.asin(math.sin(x) / math.cosh(y))
        latitude = conformal + math.fsum(f * math.sin(2 * k * conformal) for k, f in enumerate(_LATITUDE, 1))
        return math.degrees(latitude), math.degrees(self.meridian + math.atan2(math.sinh(y), math.cos(x)))

    def convergence(self, latitude: float, longitude: float) -> float:
        """Return the angle from true north to the north of the grid at a point, clockwise [rad]."""
        return math.atan(math.tan(math.radians(longitude) - self.meridian) * math.sin(math.radians(latitude)))
