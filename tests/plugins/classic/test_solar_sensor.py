"""Solar sensor of the course: the direction of the light, seen from a link."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from plugin_worlds import GROUND, element, stamps, world

import simkit
from simkit.pose import Pose, quat_rotate, rpy_from_quat

SUN = "<light name='sun' type='directional'><pose>30 40 50 0 0 0</pose><direction>0 0 -1</direction></light>"
LAMP = "<light name='lamp' type='point'><pose>0 0 9 0 0 0</pose></light>"


def station(pose: str = "0 0 1 0 0 0", **values: Any) -> str:
    """Return a post fixed to the world, with a head half a metre above its origin."""
    plugin = element("plugin", {"light_name": "sun", **values}, "name='solar' filename='libsolar_sensor.so'")
    return (
        f"<model name='station'><pose>{pose}</pose><link name='post'/>"
        "<link name='head'><pose>0 0 0.5 0 0 0</pose></link>"
        "<joint name='fixture' type='fixed'><parent>world</parent><child>post</child></joint>"
        f"<joint name='neck' type='fixed'><parent>post</parent><child>head</child></joint>{plugin}</model>"
    )


def opened(seed: int = 0, **values: Any) -> simkit.Simulation:
    return simkit.load(world(GROUND, SUN, LAMP, station(**values)), seed=seed)


def read(sim: simkit.Simulation, seconds: float = 0.1) -> list[Any]:
    subscription = sim.subscribe("/sunloin_imu")
    sim.run(seconds)
    return list(subscription.messages)


def quaternion(message: Any) -> tuple[float, float, float, float]:
    q = message.orientation
    return q.w, q.x, q.y, q.z


def test_the_x_axis_of_its_orientation_points_at_the_light() -> None:
    with opened(frame_name="head", pose="1 2 3 0.3 -0.2 0.7") as sim:
        message = read(sim)[-1]
        head = sim.link("station::head").pose
    towards = head.inverse().transform((30, 40, 50))
    np.testing.assert_allclose(
        quat_rotate(quaternion(message), (1, 0, 0)), towards / np.linalg.norm(towards), atol=1e-9
    )
    assert rpy_from_quat(quaternion(message))[0] == pytest.approx(0.0, abs=1e-9)


def test_the_frame_is_the_named_link_or_else_the_canonical_one() -> None:
    for values, frame, height in (({"frame_name": "head"}, "head", 1.5), ({}, "post", 1.0)):
        with opened(**values) as sim:
            message = read(sim)[-1]
        assert message.header.frame_id == frame
        towards = np.array([30, 40, 50 - height])
        np.testing.assert_allclose(
            quat_rotate(quaternion(message), (1, 0, 0)), towards / np.linalg.norm(towards), atol=1e-6
        )


def test_the_body_may_differ_from_the_frame() -> None:
    with opened(body_name="head", frame_name="compass") as sim:
        assert read(sim)[-1].header.frame_id == "compass"


def test_the_reading_has_the_update_rate_or_else_every_step() -> None:
    with opened(update_rate=30) as sim:
        found = stamps(read(sim, 1.0))
    assert len(found) == 30
    assert found[0] == 34_000_000
    with opened() as sim:
        assert len(read(sim, 0.05)) == 50


def test_the_offset_is_added_to_the_unit_vector_in_the_links_axes() -> None:
    with opened(xyz_offset="0.1 0.2 -0.3") as sim:
        angles = rpy_from_quat(quaternion(read(sim)[-1]))
    x, y, z = np.array([30, 40, 49]) / math.sqrt(30**2 + 40**2 + 49**2) + (0.1, 0.2, -0.3)
    np.testing.assert_allclose(angles[1:], [math.asin(-z), math.atan2(y, x)], atol=1e-9)


def test_an_offset_beyond_the_unit_sphere_is_clamped_at_the_zenith() -> None:
    with opened(xyz_offset="0 0 5") as sim:
        assert rpy_from_quat(quaternion(read(sim)[-1]))[1] == pytest.approx(-math.pi / 2, abs=1e-6)


def test_the_plural_names_are_read_with_a_warning() -> None:
    with opened(xyz_offsets="0.1 0.2 -0.3") as old, opened(xyz_offset="0.1 0.2 -0.3") as new:
        assert quaternion(read(old)[-1]) == quaternion(read(new)[-1])
        found = [(d.code, d.severity, d.hint) for d in old.diagnostics if "xyz_offsets" in d.message]
    assert found == [("SK-PARAM-004", "warning", "write <xyz_offset>")]


def test_gaussian_noise_is_only_the_covariance_and_rpy_offset_changes_nothing() -> None:
    """The plugin of the course uses neither for the orientation."""
    with opened(gaussian_noise=0.01, rpy_offset="0.1 0.2 0.3") as sim, opened() as plain:
        found, expected = read(sim)[-1], read(plain)[-1]
        notes = [(d.code, d.severity) for d in sim.diagnostics if "rpy_offset" in d.message]
    assert quaternion(found) == quaternion(expected)
    np.testing.assert_allclose(np.asarray(found.orientation_covariance).reshape(3, 3), np.eye(3) * 1e-4, atol=1e-15)
    assert notes == [("SK-PLUGIN-095", "note")]


def test_rpy_noise_has_the_given_deviation_and_its_square_is_added_to_the_covariance() -> None:
    with opened(rpy_noise=0.01, gaussian_noise=0.02, update_rate=0) as sim:
        messages = read(sim, 2.0)
    np.testing.assert_allclose(
        np.asarray(messages[0].orientation_covariance).reshape(3, 3), np.eye(3) * 5e-4, atol=1e-15
    )
    angles = np.array([rpy_from_quat(quaternion(m)) for m in messages])
    np.testing.assert_allclose(angles.std(axis=0), 0.01, rtol=0.08)
    true_pitch, true_yaw = math.asin(-49 / math.sqrt(30**2 + 40**2 + 49**2)), math.atan2(40, 30)
    np.testing.assert_allclose(angles.mean(axis=0), [0, true_pitch, true_yaw], atol=1e-3)


def test_noise_repeats_with_the_seed_and_does_not_depend_on_subscribers() -> None:
    with opened(rpy_noise=0.01) as early, opened(rpy_noise=0.01) as late:
        first = read(early, 0.2)
        late.run(0.1)
        second = read(late, 0.1)
    assert [quaternion(m) for m in first[100:]] == [quaternion(m) for m in second]
    with opened(seed=1, rpy_noise=0.01) as other:
        assert quaternion(read(other, 0.2)[-1]) != quaternion(first[-1])


def test_the_reading_follows_a_moving_light() -> None:
    with opened() as sim:
        sim.light("sun").set_pose(Pose((0, 100, 1)))
        angles = rpy_from_quat(quaternion(read(sim)[-1]))
    np.testing.assert_allclose(angles, [0, 0, math.pi / 2], atol=1e-6)


@pytest.mark.parametrize(("name", "problem"), [(None, "has no <light_name>"), ("son", "no light 'son'")])
def test_a_missing_light_is_told_and_logged_and_the_world_runs(name: str | None, problem: str) -> None:
    with opened(light_name=name) as sim:
        log = sim.subscribe("/rosout")
        assert read(sim) == []
        assert sim.time == pytest.approx(0.1)
        (found,) = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-094"]
        assert found.severity == "warning" and problem in found.message and "'lamp', 'sun'" in found.message
        assert "'sun'" in found.hint if name else not found.hint
        assert [(m.level, m.msg) for m in log.messages if m.name.endswith("solar")] == [(40, found.message)]


def test_an_unknown_link_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003.*no link 'haed'"):
        opened(frame_name="haed")


def test_a_noise_with_an_infinite_variance_is_refused() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        opened(gaussian_noise=1e308)


# ------------------------------------------------------------------ beyond the course

TOWER = (
    "<model name='tower'><static>true</static><pose>15 20 26 0 0 0</pose><link name='l'><visual name='v'>"
    "<geometry><box><size>4 4 4</size></box></geometry></visual></link></model>"
)


def newest(sim: simkit.Simulation, *names: str) -> list[Any]:
    subscriptions = [sim.subscribe(f"/sunloin_imu/{name}") for name in names]
    sim.run(0.01)
    return [s.latest.data for s in subscriptions]


def test_without_simkits_elements_there_are_no_further_topics() -> None:
    with opened() as sim:
        assert [t for t in sim.topics() if "sunloin" in t] == ["/sunloin_imu"]


@pytest.mark.parametrize("prefix", ["", "simkit:"])
def test_a_shadow_on_the_way_to_the_lights_position_makes_the_reading_invalid(prefix: str) -> None:
    values = {f"{prefix}shadow": "true", "gaussian_noise": 0.01}
    with simkit.load(world(GROUND, SUN, TOWER, station(**values))) as sim:
        assert newest(sim, "valid", "shadow") == [False, "tower::l::v"]
        message = read(sim)[-1]
        assert message.orientation_covariance[0] == -1 and quaternion(message) == (1, 0, 0, 0)
        sim.remove("tower")
        assert newest(sim, "valid", "shadow") == [True, ""]
        assert read(sim)[-1].orientation_covariance[0] == pytest.approx(1e-4)


def test_an_object_behind_the_light_casts_no_shadow_unless_rays_are_parallel() -> None:
    near = SUN.replace("30 40 50", "3 4 6")
    for towards, valid in (("position", True), ("direction", False)):
        down = near.replace("0 0 -1", "-30 -40 -50")
        values = {"shadow": "true", "towards": towards}
        with simkit.load(world(GROUND, down, TOWER, station(**values))) as sim:
            assert newest(sim, "valid") == [valid]


def test_parallel_rays_give_the_same_direction_for_every_position_of_the_light() -> None:
    values = {"towards": "direction", "frame_name": "head"}
    with opened(pose="1 2 3 0.3 -0.2 0.7", **values) as sim:
        message = read(sim)[-1]
        up = sim.link("station::head").pose.inverse().rotate((0, 0, 1))
    np.testing.assert_allclose(quat_rotate(quaternion(message), (1, 0, 0)), up, atol=1e-12)


def test_irradiance_and_power_are_on_topics_below_the_orientation() -> None:
    panel = "<area>2</area><efficiency>0.25</efficiency>"
    with opened(irradiance=400, panel=panel) as sim:
        irradiance, power = newest(sim, "irradiance", "power")
        assert "/sunloin_imu/valid" not in sim.topics()
    cosine = 49 / math.sqrt(30**2 + 40**2 + 49**2)
    assert irradiance == pytest.approx(400 * cosine)
    assert power == pytest.approx(400 * cosine * 2 * 0.25)


def test_all_topics_follow_a_remapping() -> None:
    ros = "<remapping>sunloin_imu:=compass</remapping>"
    with opened(ros=ros, irradiance="light") as sim:
        assert {t for t in sim.topics() if "compass" in t} == {"/compass", "/compass/irradiance"}


def test_angular_noise_turns_the_direction_about_random_axes() -> None:
    sigma, n = 0.01, 2000
    with opened(angular_noise=sigma, rotation="0.2 0.4 0.6") as noisy, opened(rotation="0.2 0.4 0.6") as clean:
        messages, true = read(noisy, n * 0.001), quat_rotate(quaternion(read(clean)[-1]), (1, 0, 0))
    found = np.array([quat_rotate(quaternion(m), (1, 0, 0)) for m in messages])
    turns = np.cross(true, found)
    squares = np.arcsin(np.linalg.norm(turns, axis=1)) ** 2
    assert squares.mean() == pytest.approx(2 * sigma**2, abs=4 * 2 * sigma**2 / math.sqrt(n))
    published_covariance = np.mean([np.asarray(m.orientation_covariance).reshape(3, 3) for m in messages], axis=0)
    np.testing.assert_allclose(np.cov(turns.T), published_covariance, atol=4 * sigma**2 * math.sqrt(2 / n))


def test_reset_and_restore_repeat_the_readings() -> None:
    values = {"angular_noise": 0.01, "shadow": "true", "irradiance": 500}
    with simkit.load(world(GROUND, SUN, TOWER, station(**values))) as sim:
        sim.light("sun").set_pose(Pose((0, 100, 1)))
        before = sim.snapshot()
        first = [quaternion(m) for m in read(sim)]
        sim.restore(before)
        assert [quaternion(m) for m in read(sim)] == first
        sim.reset()
        assert newest(sim, "shadow") == ["tower::l::v"]
