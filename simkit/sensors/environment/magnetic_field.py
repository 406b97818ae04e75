"""Earth's magnetic field: the World Magnetic Model, evaluated at the sensor's position and at a date.

The coefficients in `wmm/` are published by NOAA's National Centers for Environmental Information and the British
Geological Survey (public domain). They are copied from the files `WMM.COF` of 2015 (second version), 2020 and 2025.
Each file is valid for five years. The model contains only the field of the core; on the ground its error is about
150 nT.
"""

from __future__ import annotations

import math
from datetime import date
from functools import lru_cache
from pathlib import Path
from typing import Final

import numpy as np

from simkit.linear_algebra import matmul
from simkit.pose import Vector
from simkit.sensors.environment.geodesy import WorldOnPlanet

DEFAULT_DATE: Final = 2025.0
"""Decimal year of the field if a file gives no date."""

FIRST_YEAR, LAST_YEAR = 2015.0, 2030.0
"""First and last decimal year that the models cover."""

MIN_HEIGHT, MAX_HEIGHT = -1e3, 850e3
"""Lowest and highest height above the ellipsoid that the model is valid for [m]."""

_MODELS: Final = ((2025.0, "WMM_2025.COF"), (2020.0, "WMM_2020.COF"), (2015.0, "WMM_2015v2.COF"))
_DEGREE: Final = 12
_RADIUS: Final = 6371200.0  # [m] radius of the sphere that the coefficients refer to
_CORE: Final = 3480e3  # [m] the sources of the field begin here; closer to the centre the series has no meaning
_CELL: Final = 1000.0  # [m] edge of the cubes in which the field is linearised, with an error below 0.01 nT


def decimal_year(text: str) -> float:
    """Convert `2026-07-01` or `2026.5` into a decimal year.

    Raises:
        ValueError: the text is not a date, or is NaN or infinite.
    """
    text = text.strip()
    if text.count("-") == 2:
        day = date.fromisoformat(text)
        first, following = date(day.year, 1, 1), date(day.year + 1, 1, 1)
        return day.year + (day - first).days / (following - first).days
    year = float(text)
    if not math.isfinite(year):
        raise ValueError(text)
    return year


class MagneticModel:
    """Magnetic model at one date.

    Args:
        year: decimal year.

    Raises:
        ValueError: the year is not from `FIRST_YEAR` to `LAST_YEAR`.
    """

    def __init__(self, year: float) -> None:
        if not FIRST_YEAR <= year <= LAST_YEAR:
            covered = f"from {FIRST_YEAR:g} to {LAST_YEAR:g}"
            raise ValueError(f"there is no model of the Earth's magnetic field for {year:g}; use a year {covered}")
        epoch, file = next(m for m in _MODELS if year >= m[0])
        self._weights = _field_weights(_coefficients(file), year - epoch)

    def at(self, x: float, y: float, z: float) -> Vector:
        """Return the field [T] at a position [m], both in the Earth's axes (ECEF), shape (3,)."""
        distance = math.sqrt(x * x + y * y + z * z)
        if distance < _CORE:
            x, y, z = (x * _CORE / distance, y * _CORE / distance, z * _CORE / distance) if distance else (_CORE, 0, 0)
        harmonics = np.array(_harmonics(x / _RADIUS, y / _RADIUS, z / _RADIUS))
        field: Vector = matmul(self._weights, harmonics.view(np.float64))
        return field


class EarthField:
    """Earth's field in a world's axes, at a position in the world.

    Args:
        year: decimal year.
        planet: frame of the world on the Earth.
    """

    def __init__(self, year: float, planet: WorldOnPlanet) -> None:
        self._model, self._planet = magnetic_model(year), planet
        self._cell = lru_cache(maxsize=1024)(self._linear)

    def at(self, position: Vector) -> Vector:
        """Return the field [T] at a position [m], both in the world's axes, shape (3,)."""
        cell = tuple(round(v / _CELL) for v in position.tolist())
        centre, field, gradient = self._cell(cell)
        field_at_position: Vector = field + matmul(gradient, position - centre)
        return field_at_position

    def exactly_at(self, position: Vector) -> Vector:
        """Return the same field without linearisation."""
        field: Vector = matmul(self._model.at(*self._planet.on_planet(position).tolist()), self._planet.axes)
        return field

    def _linear(self, cell: tuple[int, int, int]) -> tuple[Vector, Vector, Vector]:
        """Return a cell's centre, the field there, and the field's derivatives by each coordinate as columns."""
        centre = np.array(cell, dtype=np.float64) * _CELL
        steps = 0.5 * _CELL * np.eye(3)
        slopes = [(self.exactly_at(centre + s) - self.exactly_at(centre - s)) / _CELL for s in steps]
        return centre, self.exactly_at(centre), np.array(slopes).T


@lru_cache(maxsize=8)
def magnetic_model(year: float) -> MagneticModel:
    """Return the model at a decimal year, cached.

    Raises:
        ValueError: no model covers the year.
    """
    return MagneticModel(year)


@lru_cache(maxsize=4)
def _coefficients(file: str) -> list[list[float]]:
    """Return rows of degree, order, g and h [nT], and their change per year, in Schmidt's semi-normalisation."""
    path = Path(__file__).parent / "wmm" / file
    rows: list[list[float]] = np.loadtxt(path, skiprows=1, max_rows=_DEGREE * (_DEGREE + 3) // 2).tolist()
    return rows


def _harmonic_index(n: int, m: int) -> int:
    """Return the index of the harmonic of degree n and order m."""
    return n * (n + 1) // 2 + m


def _harmonics(x: float, y: float, z: float) -> list[complex]:
    """Compute the exterior solid harmonics V + iW up to one degree above the model's, by Cunningham's recursions.

    Their only singularity is the centre. See L. E. Cunningham, Celestial Mechanics 2 (1970), in the form of
    O. Montenbruck and E. Gill, Satellite Orbits (2000), section 3.2.4.
    """
    inverse = 1.0 / (x * x + y * y + z * z)
    turn, rise = complex(x, y) * inverse, z * inverse
    harmonics: list[complex] = [complex(math.sqrt(inverse))]
    for n in range(1, _DEGREE + 2):
        before, earlier = harmonics[-n:], harmonics[-2 * n + 1 : -n] if n > 1 else []
        for m in range(n - 1):
            harmonics.append(((2 * n - 1) * rise * before[m] - (n + m - 1) * inverse * earlier[m]) / (n - m))
        harmonics.append((2 * n - 1) * rise * before[n - 1])
        harmonics.append((2 * n - 1) * turn * before[n - 1])
    return harmonics


def _field_weights(rows: list[list[float]], years: float) -> Vector:
    """Return the weights of each harmonic's real and imaginary part in the field [T], shape (3, 2·count)."""
    weights = np.zeros((3, _harmonic_index(_DEGREE + 2, 0), 2))
    for degree, order, g, h, g_rate, h_rate in rows:
        n, m = int(degree), int(order)
        schmidt = math.sqrt((2 if m else 1) * math.factorial(n - m) / math.factorial(n + m)) * 1e-9
        c, s = (g + years * g_rate) * schmidt, (h + years * h_rate) * schmidt
        outer, same = _harmonic_index(n + 1, m + 1), _harmonic_index(n + 1, m)
        weights[2, same] += (n - m + 1) * np.array((c, s))
        if m == 0:
            weights[0, outer] += (c, 0.0)
            weights[1, outer] += (0.0, c)
            continue
        inner, factor = _harmonic_index(n + 1, m - 1), 0.5 * (n - m + 2) * (n - m + 1)
        weights[0, outer] += 0.5 * np.array((c, s))
        weights[1, outer] += 0.5 * np.array((-s, c))
        weights[0, inner] -= factor * np.array((c, s))
        weights[1, inner] -= factor * np.array((s, -c))
    return weights.reshape(3, -1)
