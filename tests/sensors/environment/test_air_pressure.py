"""Barometer: heights, a world's own atmosphere, Gazebo's quirks, and invalid input."""

from __future__ import annotations

import math

import pytest
from sensor_worlds import noise, sensor, world

import simkit

QUIRKS = "<gazebo_quirks>true</gazebo_quirks>"
ZURICH = (
    "<spherical_coordinates><latitude_deg>47.4</latitude_deg><longitude_deg>8.5</longitude_deg>"
    "<elevation>488</elevation></spherical_coordinates>"
)


def barometer(block: str = "", top: str = "", z: float = 0, pose: str = "0 0 0 0 0 0", rate: float = 100) -> str:
    block = f"<air_pressure>{block}</air_pressure>"
    text = sensor("air_pressure", block, extra="<topic>p</topic>", pose=pose, rate=rate)
    return world(text, pose=f"1 2 {z} 0 0 0", top=top)


def pascal(text: str) -> float:
    with simkit.load(text) as sim:
        sim.step(1)
        return float(sim.sensor("m::l::s").latest.fluid_pressure)


def standard(height: float) -> float:
    """Return the pressure of the standard troposphere at a height [Pa]."""
    geopotential = 6356766.0 * height / (6356766.0 + height)
    return float(101325.0 * (1 - 0.0065 * geopotential / 288.15) ** (9.80665 * 28.9644 / (8314.32 * 0.0065)))


@pytest.mark.parametrize(("height", "expected"), [(0, 101325.0), (3, 101288.9657925308), (80.390198, 100362.99)])
def test_heights_that_gazebos_own_tests_know(height: float, expected: float) -> None:
    assert pascal(barometer(z=height)) == pytest.approx(expected, rel=1e-9 if height < 80 else 1e-7)


def test_the_height_is_that_of_the_sensor_not_of_its_link() -> None:
    assert pascal(barometer(z=10, pose="0 0 2.5 0 0 0")) == pytest.approx(standard(12.5), rel=1e-12)


def test_the_origins_height_is_the_sensors_and_the_worlds_elevation_is_ignored_as_in_gazebo() -> None:
    given = "<reference_altitude>1000</reference_altitude>"
    assert pascal(barometer(given, z=20)) == pytest.approx(standard(1020), rel=1e-12)
    assert pascal(barometer(top=ZURICH, z=20)) == pytest.approx(standard(20), rel=1e-12)
    assert pascal(barometer(given, top=ZURICH, z=20)) == pytest.approx(standard(1020), rel=1e-12)


def test_a_world_has_its_own_atmosphere() -> None:
    air = (
        "<atmosphere><temperature>210</temperature><temperature_gradient>0</temperature_gradient>"
        "<pressure>610</pressure></atmosphere>"
    )
    scale = 8314.32 * 210 / 28.9644 / 9.80665
    assert pascal(barometer(top=air, z=500)) == pytest.approx(610 * math.exp(-500 / (1 + 500 / 6356766) / scale), 1e-9)


def test_with_gazebos_quirks_reference_elevation_and_atmosphere_are_ignored() -> None:
    air = "<atmosphere><pressure>610</pressure></atmosphere>"
    text = barometer("<reference_altitude>1000</reference_altitude>", top=QUIRKS + ZURICH + air, z=3)
    assert pascal(text) == pytest.approx(101288.9657925308, rel=1e-9)
    with simkit.load(text) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-062"] == ["warning"]


def test_the_variance_is_the_square_of_the_deviation_and_gazebos_its_root() -> None:
    block = f"<pressure>{noise(9.0)}</pressure>"
    for top, expected in (("", 81.0), (QUIRKS, 3.0)):
        with simkit.load(barometer(block, top=top, rate=0), seed=2) as sim:
            sub = sim.subscribe("/p")
            sim.step(2000)
            assert sub.latest.variance == pytest.approx(expected)
            found = [m.fluid_pressure - 101325 for m in sub.messages]
            assert math.sqrt(sum(v * v for v in found) / len(found)) == pytest.approx(9.0, rel=0.06)
            assert sim.sensor("m::l::s").truth.fluid_pressure == pytest.approx(101325.0)


def test_the_pressure_follows_the_height_of_a_falling_sensor() -> None:
    text = sensor("air_pressure", "<air_pressure/>", rate=0)
    with simkit.load(world(text, static=False, pose="0 0 100 0 0 0")) as sim:
        sim.run(1.0)
        height = sim.sensor("m::l::s").pose.position[2]
        assert height == pytest.approx(95.1, abs=0.01)
        assert sim.sensor("m::l::s").latest.fluid_pressure == pytest.approx(standard(height), rel=1e-12)


@pytest.mark.parametrize(("z", "said"), [(20e3, 0), (45e3, 0), (-10e3, 1), (1e6, 1), (1e14, 1), (-1e14, 1)])
def test_far_above_and_below_ground_the_pressure_is_finite_and_reported(z: float, said: int) -> None:
    with simkit.load(barometer(z=z)) as sim:
        sim.step(1)
        value = sim.sensor("m::l::s").latest.fluid_pressure
        assert math.isfinite(value)
        assert value >= 0
        assert len([d for d in sim.diagnostics if d.code == "SK-SENSOR-061"]) == said


def test_air_at_absolute_zero_is_an_error_that_is_reported_once() -> None:
    two = sensor("air_pressure", "<air_pressure/>") + sensor("air_speed", "<air_speed/>", name="t")
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world(two, top="<atmosphere><temperature>0</temperature></atmosphere>"))
    assert [d.code for d in caught.value.diagnostics] == ["SK-SENSOR-060"]


def test_very_large_noise_gives_finite_readings() -> None:
    assert math.isfinite(pascal(barometer(f"<pressure>{noise(1e100)}</pressure>")))
