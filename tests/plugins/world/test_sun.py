"""The sun by date, time and place: against published positions, and as a light that moves by itself."""

from __future__ import annotations

import importlib.util
import math
from datetime import UTC, datetime
from typing import Any

import numpy as np
import pytest

pytest.importorskip("pvlib", reason="the sun's position is pvlib's")

import simkit
from simkit.plugins.world import sun, sun_position
from simkit.plugins.world.sun_position import Site, SunPath, air_mass, clear_sky
from simkit.pose import Pose, quat_rotate

LIGHT = "<light name='sun' type='directional'><direction>0.3 0.2 -0.9</direction></light>"
NREL = {
    "start": "2003-10-17T12:30:30-07:00",
    "latitude_deg": 39.742476,
    "longitude_deg": -105.1786,
    "elevation": 1830.14,
    "pressure": 82000,
    "temperature": 284.15,
}
PRAGUE = {"start": "2024-06-21T00:00:00Z", "latitude_deg": 50.08, "longitude_deg": 14.44, "time_scale": 3600}
SENSOR = (
    "<model name='m'><static>true</static><pose>0 0 1 0 0 0</pose><link name='l'><sensor name='s' type='custom' "
    "gz:type='solar'><update_rate>10</update_rate><solar/></sensor></link></model>"
)
S = "m::l::s"


def world(*parts: str, step: float = 0.01, **values: Any) -> str:
    inner = "".join(f"<{k}>{v}</{k}>" for k, v in values.items())
    plugin = f"<plugin name='simkit::Sun' filename='simkit-sun'>{inner}</plugin>"
    physics = f"<physics type='ode'><max_step_size>{step}</max_step_size></physics>"
    return f"<sdf version='1.9'><world name='w'>{physics}{LIGHT}{''.join(parts)}{plugin}</world></sdf>"


def location(*, heading: float = 0.0, latitude: float = 50.08, longitude: float = 14.44) -> str:
    return (
        "<spherical_coordinates><surface_model>EARTH_WGS84</surface_model>"
        f"<latitude_deg>{latitude}</latitude_deg><longitude_deg>{longitude}</longitude_deg>"
        f"<elevation>200</elevation><heading_deg>{heading}</heading_deg></spherical_coordinates>"
    )


def zenith_and_azimuth(direction: Any) -> tuple[float, float]:
    """Return the angles of a direction in east, north, up [degrees]."""
    x, y, z = direction
    return math.degrees(math.acos(z)), math.degrees(math.atan2(x, y)) % 360


def to_the_sun(sim: simkit.Simulation) -> np.ndarray:
    return -sim.light("sun").direction


# ------------------------------------------------------------------ where it stands


def test_the_sun_has_the_position_in_nrels_report() -> None:
    """Table A5.1 of NREL/TP-560-34302: zenith 50.11162 degrees, azimuth 194.34024 degrees, to all digits."""
    with simkit.load(world(**NREL)) as sim:
        zenith, azimuth = zenith_and_azimuth(to_the_sun(sim))
    assert zenith == pytest.approx(50.11162, abs=1e-5)
    assert azimuth == pytest.approx(194.34024, abs=1e-5)


@pytest.mark.parametrize(
    "time, latitude, longitude, zenith",
    [
        # from the equator the sun of an equinox passes through the zenith; at the tropic that of the solstice does
        ("2024-03-20T12:07:26Z", 0.0, 0.0, 0.2),
        ("2024-06-20T12:01:47Z", 23.4362, 0.0, 0.05),
        # at the pole it circles at the height of its declination
        ("2024-06-20T20:51:00Z", 90.0, 0.0, 90 - 23.437),
    ],
)
def test_the_sun_has_the_positions_of_the_seasons(time: str, latitude: float, longitude: float, zenith: float) -> None:
    values = {"start": time, "latitude_deg": latitude, "longitude_deg": longitude, "pressure": 0}
    with simkit.load(world(**values)) as sim:
        found, _ = zenith_and_azimuth(to_the_sun(sim))
    assert found == pytest.approx(zenith, abs=0.2)


def test_interpolation_between_tabulated_times_matches_the_algorithm() -> None:
    site = Site(math.radians(50.08), math.radians(14.44), 200.0, 0.0, 99000.0, 285.15)
    path, algorithm = SunPath(site), sun_position._algorithm()
    start = datetime(2024, 6, 21, tzinfo=UTC).timestamp()
    times = start + np.random.default_rng(0).uniform(0, 86400, 300)
    rows = algorithm(times, 50.08, 14.44, 200.0, 990.0, 12.0, 67.0, 0.5667)
    for time, elevation, azimuth in zip(times, np.radians(rows[2]), np.radians(rows[4]), strict=True):
        found = path.at(float(time))
        assert found.elevation == pytest.approx(elevation, abs=1e-8)
        assert found.azimuth == pytest.approx(azimuth, abs=2e-8)


@pytest.mark.parametrize("heading", [0.0, 30.0, -90.0])
def test_the_worlds_heading_rotates_the_sun(heading: float) -> None:
    """At noon in June the sun of Prague is in the south; the world's x axis points `heading` north of east."""
    values = {"start": "2024-06-21T11:04:00Z"}
    with simkit.load(world(location(heading=heading), **values)) as sim:
        x, y, z = to_the_sun(sim)
    assert math.degrees(math.asin(z)) == pytest.approx(90 - 50.08 + 23.44, abs=0.05)
    south = math.degrees(math.atan2(y, x)) + heading
    assert (south - 270 + 180) % 360 - 180 == pytest.approx(0, abs=0.5)


def test_the_plugins_location_overrides_the_worlds() -> None:
    values = {**NREL, "heading_deg": 0}
    with simkit.load(world(location(heading=77), **values)) as sim:
        zenith, azimuth = zenith_and_azimuth(to_the_sun(sim))
    assert (zenith, azimuth) == (pytest.approx(50.11162, abs=1e-5), pytest.approx(194.34024, abs=1e-5))


def test_a_time_without_an_offset_is_utc() -> None:
    with (
        simkit.load(world(**{**NREL, "start": "2003-10-17T19:30:30"})) as plain,
        simkit.load(world(**NREL)) as told,
    ):
        np.testing.assert_array_equal(to_the_sun(plain), to_the_sun(told))


# ------------------------------------------------------------------ the light


def test_the_light_is_in_the_suns_direction_and_shines_from_there() -> None:
    with simkit.load(world(**NREL)) as sim:
        light = sim.light("sun")
        position = light.pose.position
        assert np.linalg.norm(position) == pytest.approx(149597870700)
        np.testing.assert_allclose(light.direction, -position / np.linalg.norm(position), atol=1e-12)


def test_the_sun_moves_at_the_time_scale() -> None:
    with simkit.load(world(**PRAGUE)) as sim:
        path = SunPath(Site(math.radians(50.08), math.radians(14.44), 0.0, 0.0, 101325.0, 285.15))
        start = datetime(2024, 6, 21, tzinfo=UTC).timestamp()
        for _ in range(7):
            sim.run(2.37)
            np.testing.assert_allclose(to_the_sun(sim), path.at(start + 3600 * sim.time).direction, atol=1e-9)


def test_the_drawn_light_follows_at_the_update_rate() -> None:
    with simkit.load(world(**{**PRAGUE, "start": "2024-06-21T10:00:00Z", "update_rate": 20})) as sim:
        sim.run(0.31)  # drawn last in the step after 0.3 s
        drawn = sim.mj_model.light_dir[0].copy()
        assert np.arccos(drawn @ sim.light("sun").direction) <= math.radians(15) * 0.061
        sim.run(0.02)
        assert np.array_equal(sim.mj_model.light_dir[0], drawn)
        sim.run(0.05)
        assert not np.array_equal(sim.mj_model.light_dir[0], drawn)


def test_below_the_horizon_there_is_no_sunlight() -> None:
    """Sunrise in Prague on 21 June 2024 was at 2:52 UTC, sunset at 19:16 UTC, both of the upper rim."""
    with simkit.load(world(SENSOR, **PRAGUE)) as sim:
        shines = []
        for _ in range(240):
            sim.run(0.1)
            light = sim.light("sun")
            reading = sim.sensor(S).reading
            assert light.on is reading.is_valid is (light.irradiance > 0)
            assert (reading.irradiance > 0) is light.on
            shines.append(light.on)
    rise, fall = (0.1 * (1 + i) for i in np.flatnonzero(np.diff([False, *shines])))
    # its middle rises and sets some 4 minutes later and earlier; a sample is taken every 6 minutes
    assert 2.87 < rise < 3.05
    assert 19.15 < fall < 19.35


def test_at_night_no_light_is_drawn() -> None:
    for hour, shines in (("00", False), ("10", True), ("23", False)):
        with simkit.load(world(**{**PRAGUE, "start": f"2024-06-21T{hour}:00:00Z"})) as sim:
            assert bool(sim.mj_model.light_active[0]) is shines
            sim.run(6.0)
            assert bool(sim.mj_model.light_active[0]) is sim.light("sun").on


def test_a_light_that_is_off_stays_off() -> None:
    text = world(**NREL).replace("</light>", "<light_on>false</light_on></light>")
    with simkit.load(text) as sim:
        assert not sim.light("sun").on


def test_the_courses_solar_sensor_follows_the_sun() -> None:
    station = (
        "<model name='st'><static>true</static><link name='head'/><plugin name='solar' filename='libsolar_sensor.so'>"
        "<light_name>sun</light_name><update_rate>10</update_rate></plugin></model>"
    )
    with simkit.load(world(station, **{**PRAGUE, "start": "2024-06-21T06:00:00Z"})) as sim:
        subscription = sim.subscribe("/sunloin_imu")
        sim.run(5)
        q = subscription.latest.orientation
        np.testing.assert_allclose(quat_rotate((q.w, q.x, q.y, q.z), (1, 0, 0)), to_the_sun(sim), atol=1e-9)


def test_a_sensor_uses_the_sun_at_its_own_time_for_every_reader() -> None:
    found = {}
    for way in ("read", "unread"):
        with simkit.load(world(SENSOR, **{**PRAGUE, "start": "2024-06-21T06:00:00Z"})) as sim:
            if way == "read":
                sim.subscribe(sim.sensor(S).topic)
            sim.run(0.55)
            found[way] = sim.sensor(S).reading.orientation
            sim.light("sun").set_pose(Pose())
            np.testing.assert_array_equal(sim.sensor(S).reading.orientation, found[way])
    np.testing.assert_array_equal(found["read"], found["unread"])


def test_reset_and_restore_bring_the_sun_back_and_a_set_pose_stops_it() -> None:
    with simkit.load(world(**PRAGUE)) as sim:
        sim.run(10)
        before, there = sim.snapshot(), to_the_sun(sim)
        sim.run(3)
        later = to_the_sun(sim)
        assert not np.allclose(there, later)
        sim.light("sun").set_pose(Pose())
        set_by_hand = to_the_sun(sim)
        sim.run(1)
        np.testing.assert_array_equal(to_the_sun(sim), set_by_hand)
        sim.restore(before)
        np.testing.assert_array_equal(to_the_sun(sim), there)
        sim.run(3)
        np.testing.assert_array_equal(to_the_sun(sim), later)
        sim.reset()
        sim.run(13)
        np.testing.assert_array_equal(to_the_sun(sim), later)
        assert bool(sim.mj_model.light_active[0])


# ------------------------------------------------------------------ its light


def test_air_mass_is_kasten_and_youngs() -> None:
    """A flat layer's 1 / sin(elevation) while the sun is high, less when it is low, and 38 on the horizon."""
    for degrees, over_flat in ((90, 1.0), (60, 1.0), (30, 0.997), (10, 0.97), (5, 0.9)):
        elevation = math.radians(degrees)
        assert air_mass(elevation) == pytest.approx(over_flat / math.sin(elevation), rel=3e-3)
    assert air_mass(0) == pytest.approx(38, abs=0.1)


def test_clear_sky_irradiance_is_meinels() -> None:
    assert clear_sky(math.pi / 2, 101325) == pytest.approx(1353 * 0.7, rel=1e-3)
    assert clear_sky(math.radians(30), 101325) == pytest.approx(1353 * 0.7 ** (1.9943**0.678), rel=1e-3)
    assert clear_sky(math.radians(30), 80000) > clear_sky(math.radians(30), 101325)
    assert clear_sky(-0.01, 101325) == 0


def test_irradiance_is_a_clear_skys_or_a_number() -> None:
    for given, facing in ((None, clear_sky(math.radians(90 - 50.11162), 82000)), (1100, 1100)):
        values = NREL if given is None else {**NREL, "irradiance": given}
        with simkit.load(world(SENSOR, **values)) as sim:
            sim.run(0.01)
            assert sim.light("sun").irradiance == pytest.approx(facing, rel=1e-6)
            found = sim.sensor(S).reading.irradiance
            assert found == pytest.approx(facing * math.cos(math.radians(50.11162)), rel=1e-5)


# ------------------------------------------------------------------ what is said


def errors(text: str) -> list[tuple[str, str]]:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(text)
    return [(d.code, f"{d.message} {d.hint}") for d in caught.value.diagnostics if d.severity == "error"]


def test_a_missing_start_and_a_missing_location_are_both_errors() -> None:
    start, site = errors(world())
    assert start[0] == site[0] == "SK-PARAM-001"
    assert "<start>" in start[1] and "2024-06-21T10:30:00Z" in start[1]
    assert "latitude_deg" in site[1] and "spherical_coordinates" in site[1]


def test_invalid_values_are_errors() -> None:
    bad = {"start": "yesterday", "latitude_deg": 91, "longitude_deg": 0, "irradiance": "cloudy", "time_scale": -1}
    assert [code for code, _ in errors(world(**bad))] == ["SK-PARAM-002"] * 4


@pytest.mark.parametrize("elevation", [-1e9, 1e9])
def test_a_world_with_an_extreme_elevation_needs_an_elevation_of_the_plugin(elevation: float) -> None:
    high, start = location().replace("<elevation>200", f"<elevation>{elevation}"), "2024-06-21"
    assert [code for code, _ in errors(world(high, start=start))] == ["SK-PARAM-002"]
    with simkit.load(world(high, start=start, elevation=0)) as sim:
        sim.step()


def test_only_a_directional_light_can_be_the_sun() -> None:
    ((code, message),) = errors(
        world(**NREL).replace("'directional'", "'point'").replace("<start>", "<light_name>sun</light_name><start>")
    )
    assert code == "SK-PLUGIN-003" and "point light" in message
    ((code, message),) = errors(world(**NREL).replace("'directional'", "'point'"))
    assert code == "SK-PLUGIN-003" and "no directional light" in message
    ((code, message),) = errors(world(light_name="son", **NREL))
    assert code == "SK-PLUGIN-003" and "did you mean 'sun'" in message


def test_without_pvlib_the_hint_is_the_install_command(monkeypatch: pytest.MonkeyPatch) -> None:
    sun_position._algorithm.cache_clear()
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    ((code, message),) = errors(world(**NREL))
    assert code == "SK-SENSOR-084" and 'pip install "simkit-robotics[sun] @ git+https://' in message


def test_another_surface_model_still_has_the_sun_of_the_earth() -> None:
    text = world(location().replace("EARTH_WGS84", "MOON_SCS"), start="2024-06-21T10:00:00Z")
    with simkit.load(text) as sim:
        assert [d.code for d in sim.diagnostics if d.severity == "warning"] == ["SK-SENSOR-085"]


@pytest.mark.parametrize("direction", ["0 0 -1", "0 0 1", "1 0 0", "-0.2 0.7 0.1"])
def test_any_initial_direction_of_the_light_is_replaced_by_the_suns(direction: str) -> None:
    text = world(SENSOR, **NREL).replace("0.3 0.2 -0.9", direction)
    with simkit.load(text) as sim:
        position = sim.light("sun").pose.position
        np.testing.assert_allclose(to_the_sun(sim), position / np.linalg.norm(position), atol=1e-12)


@pytest.mark.parametrize(
    "start", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0), (0.6, 0.0, -0.8), (-0.96, 0.28, 0.0)]
)
def test_a_rotation_by_half_a_turn_has_an_axis(start: tuple[float, float, float]) -> None:
    opposite = (-start[0], -start[1], -start[2])
    turned = Pose((0, 0, 0), sun._shortest_rotation(start, opposite)).rotate(start)
    np.testing.assert_allclose(turned, opposite, atol=1e-12)
