"""Conversion of positions in the flat world to latitude, longitude and height."""

from __future__ import annotations

import math

import numpy as np
import pytest

from simkit.scene import SphericalCoordinates
from simkit.sensors.environment.geodesy import Ellipsoid, WorldOnPlanet, east_north_up

WGS84 = Ellipsoid(6378137.0, 6356752.314245)
MOON = Ellipsoid(1737400.0, 1737400.0)
EGG = Ellipsoid(6.3e6, 6.4e6)


@pytest.mark.parametrize("planet", [WGS84, MOON, EGG])
def test_conversion_there_and_back_gives_the_same_position(planet: Ellipsoid) -> None:
    random = np.random.default_rng(0)
    for _ in range(500):
        latitude, longitude = random.uniform(-math.pi / 2, math.pi / 2), random.uniform(-math.pi, math.pi)
        height = random.choice((-9e5, -1e4, 0.0, 1e4, 4e5, 1e7)) * random.uniform()
        found = planet.geodetic(*planet.cartesian(latitude, longitude, height).tolist())
        assert found[0] == pytest.approx(latitude, abs=1e-14)
        assert found[1] == pytest.approx(longitude, abs=1e-15)
        assert found[2] == pytest.approx(height, abs=1e-8)


def test_known_places() -> None:
    """The axes of WGS84, and 45 degrees north; tables of the ellipsoid contain these coordinates."""
    np.testing.assert_allclose(WGS84.cartesian(0, 0, 0), (6378137.0, 0, 0))
    np.testing.assert_allclose(WGS84.cartesian(math.pi / 2, 0, 0), (0, 0, 6356752.314245), atol=1e-9)
    np.testing.assert_allclose(WGS84.cartesian(math.pi / 4, 0, 0), (4517590.879, 0, 4487348.409), atol=1e-3)


@pytest.mark.parametrize("z", [6356752.314245 + 12.5, -6356752.314245 - 12.5])
def test_at_the_poles_latitude_and_height_are_exact(z: float) -> None:
    latitude, _, height = WGS84.geodetic(0.0, 0.0, z)
    assert latitude == math.copysign(math.pi / 2, z)
    assert height == pytest.approx(12.5, abs=1e-9)


def test_the_field_is_finite_far_away_and_at_the_centre() -> None:
    for place in ((0.0, 0.0, 0.0), (1e-9, 0.0, 0.0), (1e100, -1e100, 1e100)):
        assert all(map(math.isfinite, WGS84.geodetic(*place)))


def test_the_axes_of_a_place_are_a_right_handed_frame_with_up_along_the_normal() -> None:
    for latitude, longitude in ((0.3, 2.0), (-1.2, -3.0), (math.pi / 2, 0.0)):
        axes = east_north_up(latitude, longitude)
        np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-15)
        assert np.linalg.det(axes) == pytest.approx(1.0)
        risen = WGS84.cartesian(latitude, longitude, 1.0) - WGS84.cartesian(latitude, longitude, 0.0)
        np.testing.assert_allclose(axes[:, 2], risen, atol=2e-9)


def test_the_heading_turns_x_from_east_towards_north() -> None:
    place = WorldOnPlanet(SphericalCoordinates(latitude=0.0, longitude=0.0, heading=math.pi / 2))
    latitude, longitude, _ = place.geodetic(np.array((1000.0, 0.0, 0.0)))
    assert latitude == pytest.approx(1000 / 6335439.327, rel=1e-6)  # the meridian's radius of curvature at the equator
    assert longitude == pytest.approx(0.0, abs=1e-15)
    latitude, longitude, _ = place.geodetic(np.array((0.0, 1000.0, 0.0)))
    assert longitude == pytest.approx(-1000 / 6378137.0, rel=1e-6)
