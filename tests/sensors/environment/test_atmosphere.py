"""The U.S. Standard Atmosphere of 1976, compared with its published table."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from simkit.scene import Atmosphere
from simkit.sensors.environment.atmosphere import AirColumn, air_column

# Geometric height [m], temperature [K], pressure [Pa], density [kg/m3]: table I of the standard (NOAA-S/T 76-1562).
TABLE = [
    (-5000, 320.676, 1.7776e5, 1.9311),
    (0, 288.150, 1.01325e5, 1.2250),
    (1000, 281.651, 8.9876e4, 1.1117),
    (5000, 255.676, 5.4048e4, 7.3643e-1),
    (11000, 216.774, 2.2699e4, 3.6480e-1),
    (20000, 216.650, 5.5293e3, 8.8910e-2),
    (32000, 228.490, 8.8906e2, 1.3555e-2),
    (45000, 264.164, 1.4910e2, 1.9663e-3),
    (60000, 247.021, 2.1958e1, 3.0968e-4),
    (70000, 219.585, 5.2209, 8.2829e-5),
]


@pytest.mark.parametrize("row", TABLE, ids=lambda r: f"{r[0]} m")
def test_the_standard_air_is_that_of_the_table(row: tuple[float, ...]) -> None:
    height, temperature, pressure, density = row
    air = air_column(Atmosphere()).at(height)
    assert air.temperature == pytest.approx(temperature, abs=2e-3)
    assert air.pressure == pytest.approx(pressure, rel=6e-5)
    assert air.density == pytest.approx(density, rel=6e-5)


def test_at_three_metres_the_pressure_agrees_with_gazebo() -> None:
    assert air_column(Atmosphere()).at(3.0).pressure == pytest.approx(101288.9657925308, rel=1e-12)
    assert air_column(Atmosphere()).at(0.0).pressure == 101325.0


@pytest.mark.parametrize("gradient", [-0.0065, 0.0, 0.004, 1e-13])
def test_pressure_falls_by_the_weight_of_the_air(gradient: float) -> None:
    """The hydrostatic law dp/dh = -ρ·g, with g at that height, holds for finite differences of the column."""
    column = AirColumn(300.0, gradient, 9e4)
    for height in (-300.0, 10.0, 5000.0, 15e3, 40e3):
        slope = (column.at(height + 0.5).pressure - column.at(height - 0.5).pressure) / 1.0
        gravity = 9.80665 * (6356766.0 / (6356766.0 + height)) ** 2
        assert slope == pytest.approx(-column.at(height).density * gravity, rel=1e-6)


def test_a_world_has_its_own_sea_level() -> None:
    column = AirColumn(250.0, 0.0, 600.0)
    assert column.at(0.0) == (250.0, 600.0, pytest.approx(600 * 28.9644 / (8314.32 * 250)))
    assert column.at(1000.0).pressure == pytest.approx(
        600 * math.exp(-999.84 * 9.80665 * 28.9644 / 8314.32 / 250), 1e-6
    )


@pytest.mark.parametrize("sea_level", [(288.15, -0.0065), (1.0, -1.0), (288.15, -1e9), (288.15, 1e9), (0.0, 0.0)])
@pytest.mark.parametrize("height", [-1e15, -1e5, -1e4, 2e4, 4.5e4, 1e6, 1e15])
def test_the_air_is_finite_at_any_height_and_rate(sea_level: tuple[float, float], height: float) -> None:
    air = AirColumn(*sea_level, 101325.0).at(height)
    assert all(math.isfinite(v) and v >= 0 for v in air)
    assert air.temperature > 0.99


def test_pressure_has_no_step_where_two_layers_meet() -> None:
    for column in (air_column(Atmosphere()), AirColumn(288.15, -0.1, 1e5), AirColumn(288.15, 0.1, 1e5)):
        heights = [100.0 * k for k in range(-400, 1000)]
        pressures = [column.at(h).pressure for h in heights]
        assert all(below >= above for below, above in pairwise(pressures))
        for bound in column._bounds:
            geometric = 6356766.0 * bound / (6356766.0 - bound)
            below, above = (column.at(geometric + d).pressure for d in (-1e-6, 1e-6))
            assert below == pytest.approx(above, rel=1e-6)
