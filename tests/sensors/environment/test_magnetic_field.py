"""The Earth's magnetic field, compared with published values."""

from __future__ import annotations

import math
from datetime import date

import numpy as np
import pytest

from simkit.scene import SphericalCoordinates
from simkit.sensors.environment.geodesy import Ellipsoid, WorldOnPlanet, east_north_up
from simkit.sensors.environment.magnetic_field import EarthField, MagneticModel, decimal_year, magnetic_model

WGS84 = Ellipsoid(6378137.0, 6356752.314245)

# Decimal year, height [km], latitude, longitude [degrees]; north, east, down [nT]: NOAA's test values of the models of
# 2015 (second version), 2020 and 2025, and last a value that NOAA's own program gives (test of the package wmm2025).
PUBLISHED = [
    (2015.0, 0, 80, 0, 6636.6, -451.9, 54408.9),
    (2015.0, 100, -80, 240, 5612.2, 14789.3, -50385.8),
    (2017.5, 0, 0, 120, 39569.4, 252.3, -11067.9),
    (2020.0, 0, 80, 0, 6570.4, -146.3, 54606.0),
    (2020.0, 0, 0, 120, 39624.3, 109.9, -10932.5),
    (2020.0, 0, -80, 240, 5940.6, 15772.1, -52480.8),
    (2022.5, 100, 80, 0, 6224.0, -44.5, 52527.0),
    (2022.5, 100, 0, 120, 37694.0, -35.3, -10362.0),
    (2022.5, 100, -80, 240, 5815.0, 14803.0, -49755.3),
    (2020.0, 66, 14, 143, 34916.8, 70.2, 8114.9),
    (2020.5, 6, -36, -137, 23948.6, 8791.9, -32897.6),
    (2025.0, 0, 80, 0, 6521.6, 145.9, 54791.5),
    (2025.0, 0, -80, 240, 6117.5, 15751.9, -52022.5),
    (2027.5, 100, 80, 0, 6196.7, 233.8, 52670.5),
    (2027.5, 100, -80, 240, 5984.0, 14760.1, -49317.7),
    (2026.5, 0, 65, 85, 8739.604, 2229.254, 60367.156),
]


def north_east_down(year: float, height: float, latitude: float, longitude: float) -> np.ndarray:
    """Return the field [nT] at a height [m], latitude and longitude [degrees]."""
    at = math.radians(latitude), math.radians(longitude)
    east, north, up = magnetic_model(year).at(*WGS84.cartesian(*at, height).tolist()) @ east_north_up(*at) * 1e9
    return np.array((north, east, -up))


@pytest.mark.parametrize("row", PUBLISHED, ids=lambda r: f"{r[0]:g} at {r[2]}, {r[3]}, {r[1]} km")
def test_the_field_is_the_published_one_to_the_last_digit(row: tuple[float, ...]) -> None:
    year, kilometres, latitude, longitude, *expected = row
    found = north_east_down(year, kilometres * 1e3, latitude, longitude)
    np.testing.assert_allclose(found, expected, atol=0.051)


@pytest.mark.parametrize("latitude", [90, -90])
def test_at_the_poles_the_field_is_that_of_the_places_around_them(latitude: int) -> None:
    near = np.sign(latitude) * (90 - 1e-7)
    for longitude in (-180, 0, 77):
        here, beside = (north_east_down(2025.0, 0, p, longitude) for p in (latitude, near))
        np.testing.assert_allclose(here, beside, atol=1e-3)


def test_the_field_has_no_sources_outside_the_core() -> None:
    """Divergence and curl are zero; an error in any weight would change one of them."""
    model, step = magnetic_model(2027.3), 100.0
    for at in np.random.default_rng(3).normal(size=(5, 3)):
        centre = at / np.linalg.norm(at) * 6.6e6
        slopes = np.array(
            [(model.at(*(centre + step * e)) - model.at(*(centre - step * e))) / (2 * step) for e in np.eye(3)]
        )
        assert abs(np.trace(slopes)) < 1e-6 * np.abs(slopes).max()
        assert np.abs(slopes - slopes.T).max() < 1e-6 * np.abs(slopes).max()


def test_the_linear_pieces_are_the_field_to_a_hundredth_of_a_nanotesla() -> None:
    field = EarthField(2025.0, WorldOnPlanet(SphericalCoordinates(0.8, 0.1, 200.0, 0.7)))
    for position in np.random.default_rng(1).uniform(-30e3, 30e3, (200, 3)):
        np.testing.assert_allclose(field.at(position), field.exactly_at(position), atol=1e-11)
    # also at the border of two linearised cells
    for x in (499.999999, 500.000001):
        np.testing.assert_allclose(field.at(np.array((x, 0, 0))), field.exactly_at(np.array((x, 0, 0))), atol=1e-11)


@pytest.mark.parametrize("position", [(0.0, 0.0, 0.0), (1e-3, 0.0, 0.0), (0.0, 1e5, -2e6), (1e90, -1e90, 1e90)])
def test_conversion_is_finite_everywhere(position: tuple[float, float, float]) -> None:
    assert np.isfinite(magnetic_model(2025.0).at(*position)).all()


def test_dates_are_days_or_decimal_years() -> None:
    assert decimal_year("2025-01-01") == 2025.0
    assert decimal_year(" 2026.5 ") == 2026.5
    assert decimal_year("2024-12-31") == pytest.approx(2025 - 1 / 366)
    assert decimal_year(str(date(2027, 7, 2))) == pytest.approx(2027.5, abs=2e-3)
    for wrong in ("", "today", "nan", "inf", "2025-13-01", "2025-1"):
        with pytest.raises(ValueError):
            decimal_year(wrong)
    for none in (2014.99, 2030.01, -1e9):
        with pytest.raises(ValueError, match="no model"):
            MagneticModel(none)
