"""Magnetometer: a uniform field, the Earth's field, headings, units, and the options of Gazebo's system."""

from __future__ import annotations

import math

import numpy as np
import pytest
from sensor_worlds import noise, sensor, world, xyz

import simkit
from simkit.pose import quat_from_rpy, quat_to_matrix

FIELD = (2e-5, -3e-6, -4e-5)
LEVEL = "0 0 0 0 0 0"
UNIFORM = f"<magnetic_field>{FIELD[0]} {FIELD[1]} {FIELD[2]}</magnetic_field>"
QUIRKS = "<gazebo_quirks>true</gazebo_quirks>"
SYSTEM = '<plugin filename="gz-sim-magnetometer-system" name="gz::sim::systems::Magnetometer">{}</plugin>'
GAUSS, NED = "<use_units_gauss>true</use_units_gauss>", "<use_earth_frame_ned>true</use_earth_frame_ned>"
# NOAA's test value of 2025.0 at 80 N, 0 E on the ellipsoid: north, east, down
ARCTIC = np.array((6521.6, 145.9, 54791.5)) * 1e-9


def arctic(heading: float = 0.0, surface: str = "EARTH_WGS84") -> str:
    """Return `<spherical_coordinates>` at the position of NOAA's test value, with a heading [rad]."""
    return f"""<spherical_coordinates><surface_model>{surface}</surface_model><latitude_deg>80</latitude_deg>
      <longitude_deg>0</longitude_deg><elevation>0</elevation><heading_deg>{math.degrees(heading)}</heading_deg>
      </spherical_coordinates>"""


def compass(block: str = "", top: str = "", pose: str = LEVEL, mounted: str = LEVEL, rate: float = 100) -> str:
    block = f"<magnetometer>{block}</magnetometer>"
    return world(sensor("magnetometer", block, extra="<topic>b</topic>", pose=mounted, rate=rate), pose=pose, top=top)


def field(text: str) -> np.ndarray:
    """Return the measured field [T]."""
    with simkit.load(text) as sim:
        sim.step(1)
        return xyz(sim.sensor("m::l::s").latest.magnetic_field)


def test_a_uniform_field_is_seen_from_the_sensors_own_axes() -> None:
    turn = (0.3, -0.8, 2.1)
    pose = f"5 6 7 {turn[0]} {turn[1]} {turn[2]}"
    expected = quat_to_matrix(quat_from_rpy(*turn)).T @ np.array(FIELD)
    np.testing.assert_allclose(field(compass(top=UNIFORM, pose=pose)), expected, atol=1e-18)
    np.testing.assert_allclose(field(compass(top=UNIFORM, mounted=pose)), expected, atol=1e-18)


def test_on_the_earth_the_field_is_the_models_in_east_north_up() -> None:
    north, east, down = ARCTIC
    np.testing.assert_allclose(field(compass(top=arctic())), (east, north, -down), atol=6e-11)


@pytest.mark.parametrize("heading", [0.7, -2.0])
def test_the_heading_of_the_world_turns_the_field(heading: float) -> None:
    """The world's x axis is rotated by `heading` from east towards north."""
    north, east, down = ARCTIC
    x = east * math.cos(heading) + north * math.sin(heading)
    y = -east * math.sin(heading) + north * math.cos(heading)
    np.testing.assert_allclose(field(compass(top=arctic(heading))), (x, y, -down), atol=6e-11)


def test_it_is_the_field_where_the_sensor_is() -> None:
    """NOAA publishes a test value at a height of 100 km."""
    found = field(compass("<simkit:date>2027.5</simkit:date>", top=arctic(), pose="0 0 100000 0 0 0"))
    np.testing.assert_allclose(found, np.array((233.8, 6196.7, -52670.5)) * 1e-9, atol=6e-11)


def test_gazebos_units_and_axes_are_honoured_where_the_world_writes_them() -> None:
    turned = arctic(0.7)
    plain = field(compass(top=turned))
    np.testing.assert_array_equal(field(compass(top=SYSTEM.format("") + turned)), plain)
    np.testing.assert_allclose(field(compass(top=SYSTEM.format(GAUSS) + turned)), plain * 1e4, rtol=1e-12)
    # north, east, down along the world's x, y, z, whatever its heading
    np.testing.assert_allclose(field(compass(top=SYSTEM.format(NED) + turned)), ARCTIC, atol=6e-11)
    np.testing.assert_allclose(field(compass(top=SYSTEM.format("") + QUIRKS + turned)), ARCTIC * 1e4, atol=6e-7)
    off = GAUSS.replace("true", "false") + NED.replace("true", "0")
    np.testing.assert_array_equal(field(compass(top=SYSTEM.format(off) + QUIRKS + turned)), plain)
    old = SYSTEM.format(GAUSS).replace("gz-sim", "libignition-gazebo").replace("gz::sim", "ignition::gazebo")
    np.testing.assert_allclose(field(compass(top=old + turned)), plain * 1e4, rtol=1e-12)


def test_a_uniform_field_is_in_tesla_whatever_the_switches() -> None:
    """The options of Gazebo's system affect only the Earth's field, also in Gazebo."""
    np.testing.assert_allclose(field(compass(top=SYSTEM.format(GAUSS + NED) + QUIRKS + UNIFORM)), FIELD)


def test_an_invalid_boolean_is_an_error_that_is_reported_once() -> None:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(compass(top=SYSTEM.format("<use_units_gauss>perhaps</use_units_gauss>") + arctic()))
    assert [d.code for d in caught.value.diagnostics] == ["SK-PARAM-002"]


def test_a_replaced_noise_element_is_reported_once() -> None:
    two = sensor("magnetometer", "") + sensor("magnetometer", "", name="t")
    with simkit.load(world(two, top=UNIFORM + arctic())) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-065"] == ["warning"]
    with simkit.load(world(two, top=UNIFORM + arctic(surface="MOON_SCS"))) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-064"] == ["note"]
        sim.step(1)
        np.testing.assert_allclose(xyz(sim.sensor("m::l::t").latest.magnetic_field), FIELD)


@pytest.mark.parametrize("date", ["1899-01-01", "2031.0", "soon", "2026-02-30", "nan"])
def test_a_date_that_no_model_covers_is_an_error(date: str) -> None:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(compass(f"<date>{date}</date>", top=arctic()))
    assert [d.code for d in caught.value.diagnostics] == ["SK-SENSOR-063"]


def test_the_date_moves_the_field() -> None:
    first, last = (field(compass(f"<date>{d}</date>", top=arctic())) for d in ("2025-01-01", "2029.9"))
    assert 1e-8 < np.abs(last - first).max() < 1e-6
    np.testing.assert_array_equal(field(compass(top=arctic())), first)


@pytest.mark.parametrize("elevation", ["1e9", "-1e9", "-6356752"])
def test_far_from_the_ground_the_field_is_finite_and_reported(elevation: str) -> None:
    text = compass(top=arctic().replace("<elevation>0<", f"<elevation>{elevation}<"))
    assert np.isfinite(field(text)).all()
    with simkit.load(text) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-066"] == ["warning"]


def test_noise_and_covariance_are_per_axis() -> None:
    block = f"<x>{noise(1e-7)}</x><y>{noise(2e-7)}</y><z>{noise(3e-7, mean=1e-6)}</z>"
    with simkit.load(compass(block, top=UNIFORM, rate=0), seed=7) as sim:
        sub = sim.subscribe("/b")
        sim.step(3000)
        assert sim.topics()["/b"] == "sensor_msgs/msg/MagneticField"
        values = np.array([xyz(m.magnetic_field) for m in sub.messages]) - FIELD
        np.testing.assert_allclose(values.std(axis=0), (1e-7, 2e-7, 3e-7), rtol=0.05)
        np.testing.assert_allclose(values.mean(axis=0), (0, 0, 1e-6), atol=2e-8)
        expected = np.diag((1e-14, 4e-14, 9e-14)).ravel()
        np.testing.assert_allclose(sub.latest.magnetic_field_covariance, expected, rtol=1e-12)
        np.testing.assert_allclose(xyz(sim.sensor("m::l::s").truth.magnetic_field), FIELD)
