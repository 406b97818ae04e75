"""Satellite receiver: positions far from the origin, poles, headings, noise in metres, and Gazebo's quirks."""

from __future__ import annotations

import math

import numpy as np
import pytest
from sensor_worlds import noise, sensor, world, xyz

import simkit

QUIRKS = "<gazebo_quirks>true</gazebo_quirks>"
LEVEL = "0 0 0 0 0 0"
CALM = "<gravity>0 0 0</gravity>"
RADIUS = 6378137.0


def spherical_coordinates(
    latitude: float, longitude: float, elevation: float = 0.0, heading: float = 0.0, surface: str = ""
) -> str:
    """Return `<spherical_coordinates>` for a latitude and longitude [degrees], elevation [m] and heading [rad]."""
    return f"""<spherical_coordinates>{surface}<latitude_deg>{latitude}</latitude_deg>
      <longitude_deg>{longitude}</longitude_deg><elevation>{elevation}</elevation>
      <heading_deg>{math.degrees(heading)}</heading_deg></spherical_coordinates>"""


def receiver(
    block: str = "", top: str = "", *, pose: str = LEVEL, mounted: str = LEVEL, static: bool = True, rate: float = 100
) -> str:
    text = sensor("navsat", f"<navsat>{block}</navsat>", extra="<topic>fix</topic>", pose=mounted, rate=rate)
    return world(text, pose=pose, static=static, top=top)


def sensing(position: float = 0, height: float = 0, velocity: float = 0, climb: float = 0, more: str = "") -> str:
    """Return the noise elements of the four channels."""
    groups = []
    for name, horizontal, vertical in (("position", position, height), ("velocity", velocity, climb)):
        parts = f"<horizontal>{noise(horizontal, more=more)}</horizontal><vertical>{noise(vertical)}</vertical>"
        groups.append(f"<{name}_sensing>{parts}</{name}_sensing>")
    return "".join(groups)


def fix(text: str) -> tuple[float, float, float]:
    with simkit.load(text) as sim:
        sim.step(1)
        message = sim.sensor("m::l::s").latest
        return message.latitude, message.longitude, message.altitude


def cartesian(latitude: float, longitude: float, height: float) -> np.ndarray:
    """Return the position on WGS84 [m] of a latitude and longitude [degrees] and a height [m]."""
    e2 = 1 - (6356752.314245 / RADIUS) ** 2
    phi, lam = math.radians(latitude), math.radians(longitude)
    normal = RADIUS / math.sqrt(1 - e2 * math.sin(phi) ** 2)
    out = (normal + height) * math.cos(phi)
    return np.array((out * math.cos(lam), out * math.sin(lam), (normal * (1 - e2) + height) * math.sin(phi)))


def test_at_the_origin_the_fix_is_the_worlds_location() -> None:
    assert fix(receiver(top=spherical_coordinates(43.5, 1.5, 200))) == (
        pytest.approx(43.5, abs=1e-12),
        pytest.approx(1.5, abs=1e-12),
        pytest.approx(200, abs=1e-8),
    )


@pytest.mark.parametrize("origin", [(43.5, 1.5, 200), (-33.9, 179.99, 10), (89.99, -120, 0), (-90, 0, 2800), (0, 0, 0)])
@pytest.mark.parametrize("heading", [0.0, 0.7])
def test_a_position_kilometres_away_converts_back_to_the_world_position(
    origin: tuple[float, float, float], heading: float
) -> None:
    """The fix is converted to Earth-centred coordinates, and then to east, north and up at the world's origin."""
    x, y, z = 3000.0, -20000.0, 150.0
    latitude, longitude, altitude = fix(
        receiver(top=spherical_coordinates(*origin, heading), pose=f"{x} {y} {z} 0 0 1.1")
    )
    apart = cartesian(latitude, longitude, altitude) - cartesian(*origin)
    phi, lam = math.radians(origin[0]), math.radians(origin[1])
    east = np.array((-math.sin(lam), math.cos(lam), 0))
    up = np.array((math.cos(phi) * math.cos(lam), math.cos(phi) * math.sin(lam), math.sin(phi)))
    found = np.array((apart @ east, apart @ np.cross(up, east), apart @ up))
    sine, cosine = math.sin(heading), math.cos(heading)
    np.testing.assert_allclose(found, (x * cosine - y * sine, x * sine + y * cosine, z), atol=2e-7)
    assert -180 <= longitude <= 180
    # far from the origin, the world's plane is above the curved ground
    assert altitude - origin[2] - z == pytest.approx((x * x + y * y) / 2 / RADIUS, rel=0.01)


def test_over_the_antimeridian_the_longitude_changes_its_sign() -> None:
    assert fix(receiver(top=spherical_coordinates(0, 179.999), pose="1000 0 0 0 0 0"))[1] == pytest.approx(
        -179.992017, abs=1e-6
    )


def test_at_the_pole_any_step_is_south() -> None:
    latitude, longitude, _ = fix(receiver(top=spherical_coordinates(90, 0), pose="0 1000 0 0 0 0"))
    assert latitude == pytest.approx(90 - math.degrees(1000 / 6399593.6), abs=1e-8)
    assert abs(longitude) == pytest.approx(180.0)  # the world's y points over the pole


def test_the_moon_and_a_surface_of_ones_own_are_surfaces_too() -> None:
    moon = "<surface_model>MOON_SCS</surface_model>"
    assert fix(receiver(top=spherical_coordinates(0, 0, 0, 0, moon), pose="0 1737.4 0 0 0 0"))[0] == pytest.approx(
        math.degrees(1e-3), rel=1e-6
    )
    own = (
        "<surface_model>CUSTOM_SURFACE</surface_model><surface_axis_equatorial>1000</surface_axis_equatorial>"
        "<surface_axis_polar>1000</surface_axis_polar>"
    )
    latitude, longitude, altitude = fix(receiver(top=spherical_coordinates(0, 0, 0, 0, own), pose="1000 0 0 0 0 0"))
    assert (latitude, longitude) == (0.0, pytest.approx(45.0))
    assert altitude == pytest.approx(1000 * (math.sqrt(2) - 1))


def test_the_velocity_is_to_east_north_and_up_at_the_sensors_position() -> None:
    """The heading is 0.7, and the sensor is 2 m in front of a rotating body's origin, which adds ω × r."""
    top = CALM + spherical_coordinates(10, 20, 0, 0.7)
    with simkit.load(receiver(top=top, static=False, mounted="2 0 0 0 0 0")) as sim:
        velocity = sim.subscribe("/fix/velocity")
        gps = sim.subscribe("/fix/gps_fix")
        sim.model("m").set_velocity((3.0, -4.0, 0.5), (0, 0, 1.5))
        sim.step(1)
        assert sim.topics()["/fix/velocity"] == "geometry_msgs/msg/Vector3Stamped"
        assert sim.topics()["/fix/gps_fix"] == "gps_msgs/msg/GPSFix"
        angle = 0.7
        x, y = 3.0, -4.0 + 2 * 1.5
        expected = (x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle), 0.5)
        np.testing.assert_allclose(xyz(velocity.latest.vector), expected, atol=1e-2)
        message = gps.latest
        assert message.speed == pytest.approx(math.hypot(*expected[:2]), abs=1e-2)
        assert message.track == pytest.approx(math.degrees(math.atan2(expected[0], expected[1])) % 360, abs=0.3)
        assert message.climb == pytest.approx(0.5, abs=1e-6)
        assert message.latitude == sim.sensor("m::l::s").latest.latitude


def test_the_velocity_is_the_change_of_the_fix() -> None:
    """This is also true far from the origin, where east and up differ from the world's axes."""
    top = CALM + spherical_coordinates(50, 20, 0, 0.3)
    with simkit.load(receiver(top=top, static=False, pose="400000 200000 0 0 0 0", rate=0)) as sim:
        sub, velocity = sim.subscribe("/fix"), sim.subscribe("/fix/velocity")
        sim.model("m").set_velocity((200.0, 100.0, 0.0), (0, 0, 0))
        sim.run(1.0)
        first, last = sub.messages[0], sub.messages[-1]
        passed = (len(sub.messages) - 1) * 1e-3
        north = math.radians(last.latitude - first.latitude) * 6389e3 / passed
        assert (last.altitude - first.altitude) / passed == pytest.approx(velocity.latest.vector.z, rel=1e-2)
        assert velocity.latest.vector.z > 10
        assert north == pytest.approx(velocity.latest.vector.y, rel=1e-2)


def test_gazebos_velocity_is_along_the_worlds_axes() -> None:
    top = CALM + QUIRKS + spherical_coordinates(50, 20, 0, 0.7)
    with simkit.load(receiver(top=top, static=False)) as sim:
        velocity = sim.subscribe("/fix/velocity")
        sim.model("m").set_velocity((3.0, -4.0, 0.5), (0, 0, 0))
        sim.step(1)
        np.testing.assert_allclose(xyz(velocity.latest.vector), (3.0, -4.0, 0.5), atol=1e-9)


@pytest.mark.parametrize("latitude", [0.0, 60.0, 89.999, 90.0])
def test_noise_of_the_position_is_in_metres_wherever_it_is(latitude: float) -> None:
    with simkit.load(receiver(sensing(2.5, 4.0), top=spherical_coordinates(latitude, 30), rate=0), seed=3) as sim:
        sub = sim.subscribe("/fix")
        sim.step(2000)
        here = cartesian(latitude, 30, 0)
        apart = np.array([cartesian(m.latitude, m.longitude, 0) - here for m in sub.messages])
        assert math.sqrt((apart**2).sum(axis=1).mean() / 2) == pytest.approx(2.5, rel=0.05)
        assert np.std([m.altitude for m in sub.messages]) == pytest.approx(4.0, rel=0.05)
        message = sub.latest
        np.testing.assert_allclose(message.position_covariance, np.diag((6.25, 6.25, 16.0)).ravel())
        assert message.position_covariance_type == 2
        assert (message.status.status, message.status.service) == (0, 1)
        assert sim.sensor("m::l::s").truth.latitude == pytest.approx(latitude, abs=1e-12)


def test_gazebos_noise_is_in_degrees_and_it_knows_no_covariance() -> None:
    with simkit.load(receiver(sensing(0.01), top=QUIRKS + spherical_coordinates(60, 30), rate=0), seed=3) as sim:
        sub = sim.subscribe("/fix")
        sim.step(2000)
        for name, middle in (("latitude", 60), ("longitude", 30)):
            values = np.array([getattr(m, name) for m in sub.messages])
            assert values.std() == pytest.approx(0.01, rel=0.05)
            assert values.mean() == pytest.approx(middle, abs=1e-3)
        assert sub.latest.position_covariance_type == 0
        assert not sub.latest.position_covariance.any()


def test_velocity_has_noise_and_gps_fix_has_uncertainties() -> None:
    with simkit.load(receiver(sensing(2, 3, 0.1, 0.2), top=spherical_coordinates(60, 30), rate=0), seed=3) as sim:
        sub, gps = sim.subscribe("/fix/velocity"), sim.subscribe("/fix/gps_fix")
        sim.step(2000)
        values = np.array([xyz(m.vector) for m in sub.messages])
        np.testing.assert_allclose(values.std(axis=0), (0.1, 0.1, 0.2), rtol=0.06)
        within = np.mean([math.hypot(*v[:2]) < gps.latest.err_speed for v in values])
        assert within == pytest.approx(0.95, abs=0.015)
        assert gps.latest.err_vert == pytest.approx(1.96 * 3, rel=1e-4)


def test_a_drifting_position_bias_is_in_metres() -> None:
    time = "<dynamic_bias_correlation_time>50</dynamic_bias_correlation_time>"
    more = f"<dynamic_bias_stddev>1</dynamic_bias_stddev>{time}"
    with simkit.load(receiver(sensing(0, more=more), top=spherical_coordinates(45, 0), rate=10), seed=1) as sim:
        sub = sim.subscribe("/fix")
        sim.run(100.0)
        north = np.radians([m.latitude - 45 for m in sub.messages]) * 6367e3
        assert np.diff(north).std() == pytest.approx(math.sqrt(0.1), rel=0.1)
        assert 0.5 < np.abs(north).max() < 20


def test_without_spherical_coordinates_it_warns_and_publishes_nothing() -> None:
    with simkit.load(receiver()) as sim:
        sub = sim.subscribe("/fix")
        sim.run(0.1)
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-067"] == ["warning"]
        assert "/fix" in sim.topics()
        assert not sub.messages
        assert sim.sensor("m::l::s").latest is None
        assert sim.sensor("m::l::s").truth is None


def test_names_are_gazebos_and_gps_is_an_alias() -> None:
    text = world(sensor("gps", f"<gps>{sensing(1.5)}</gps>"), top=spherical_coordinates(1, 2))
    with simkit.load(text) as sim:
        sim.step(1)
        eye = sim.sensor("m::l::s")
        assert eye.topic == "/world/w/model/m/link/l/sensor/s/navsat"
        assert eye.options.horizontal_position.stddev == 1.5
        assert eye.latest.header.frame_id == "m::l::s"


def test_latitude_91_is_an_error_with_what_is_allowed() -> None:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(receiver(top=spherical_coordinates(91, 2)))
    assert ["-90 to 90" in d.message for d in caught.value.diagnostics] == [True]


@pytest.mark.parametrize("text", [
    receiver(sensing(1e100, 1e100, 1e100, 1e100), top=spherical_coordinates(50, 20)),
    receiver(sensing(1e100, 1e100, 1e100, 1e100), top=QUIRKS + spherical_coordinates(50, 20)),
    receiver(top=spherical_coordinates(50, 20, 1e9)),
    receiver(top=spherical_coordinates(50, 20, -6356752.3)),
    receiver(top=spherical_coordinates(50, 20), pose="1e14 -1e14 1e14 0 0 0"),
], ids=["noise", "noise in degrees", "high", "the centre", "far"])  # fmt: skip
def test_the_fix_is_finite_for_any_input(text: str) -> None:
    latitude, longitude, altitude = fix(text)
    assert -180 <= latitude <= 180
    assert -180 <= longitude <= 180
    assert math.isfinite(altitude)


def test_spawned_receivers_have_the_worlds_location_and_a_restored_run_repeats() -> None:
    eye = sensor("navsat", f"<navsat>{sensing(1)}</navsat>")
    model = f'<sdf version="1.9"><model name="d"><static>true</static><link name="l">{eye}</link></model></sdf>'
    on_earth = f'<world name="w">{spherical_coordinates(50, 20)}</world>'
    with simkit.load(f'<sdf version="1.9">{on_earth}</sdf>', seed=4) as sim:
        sim.spawn(model)
        sub = sim.subscribe("/world/w/model/d/link/l/sensor/s/navsat")
        sim.run(0.1)
        snapshot = sim.snapshot()
        sim.run(0.1)
        first = [(m.latitude, m.longitude) for m in sub.messages][-10:]
        sim.restore(snapshot)
        sim.run(0.1)
        assert [(m.latitude, m.longitude) for m in sub.messages][-10:] == first
        sim.remove("d")
        assert sim.topics()["/world/w/model/d/link/l/sensor/s/navsat"] == ""  # only the subscription is left
