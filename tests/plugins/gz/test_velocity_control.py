"""Velocity control of Gazebo: models and links that follow twist commands."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from moved_models import ARM, INERTIA, WALL, arc, box, velocity_control
from plugin_worlds import GROUND, world

import simkit

TOPIC = "/model/box/cmd_vel"


def opened(inner: str = "", *others: str, step: float = 0.002, **values: Any) -> simkit.Simulation:
    return simkit.load(world(GROUND, *others, box(velocity_control(inner), **values), step=step))


def planar(sim: simkit.Simulation) -> np.ndarray:
    pose = sim.model("box").pose
    return np.array((pose.position[0], pose.position[1], pose.rpy[2]))


def test_the_topic_is_that_of_gazebo_or_of_the_file() -> None:
    with opened() as sim:
        assert sim.topics()[TOPIC] == "geometry_msgs/msg/Twist"
    with opened("<topic>go</topic>") as sim:
        assert "/go" in sim.topics()
        assert TOPIC not in sim.topics()


def test_without_a_command_the_model_rests_in_the_air() -> None:
    with opened(pose="0 0 2 0 0.3 0") as sim:
        sim.run(0.5)
        np.testing.assert_allclose(sim.model("box").pose.position, (0, 0, 2), atol=1e-12)
        assert sim.model("box").pose.rpy[1] == pytest.approx(0.3, abs=1e-12)


@pytest.mark.parametrize("step", [0.001, 0.004, 0.01])
def test_it_drives_the_exact_arc_at_any_step(step: float) -> None:
    """A box on the ground at 0.5 m/s and 0.7 rad/s for 1.5 s moves on a circle of radius 5/7 m, without friction."""
    with opened(step=step) as sim:
        sim.publish(TOPIC, {"linear": {"x": 0.5, "y": 0.1}, "angular": {"z": 0.7}})
        sim.run(1.5)
        np.testing.assert_allclose(planar(sim), arc(0.5, 0.7, 1.5, aside=0.1), atol=1e-5)
        assert sim.model("box").pose.position[2] == pytest.approx(0.1, abs=1e-5)


def test_the_twist_is_in_the_models_own_axes_in_space() -> None:
    """Motion along an axis that points up by 0.5 rad, with rotation around it, is a straight line."""
    with opened(pose="0 0 1 0 -0.5 0") as sim:
        sim.publish(TOPIC, {"linear": {"x": 0.4}, "angular": {"x": 1.0}})
        sim.run(2.0)
        expected = (0.8 * math.cos(0.5), 0, 1 + 0.8 * math.sin(0.5))
        np.testing.assert_allclose(sim.model("box").pose.position, expected, atol=1e-9)
        link = sim.link("box::base")
        np.testing.assert_allclose(link.linear_velocity, np.array((math.cos(0.5), 0, math.sin(0.5))) * 0.4, atol=1e-6)


def test_a_screw_ends_where_its_twist_leads() -> None:
    with opened(pose="0 0 1 0 0 0") as sim:
        sim.publish(TOPIC, {"linear": {"x": 1.0, "z": 0.1}, "angular": {"z": 2.0}})
        sim.run(2.0)
        x, y, yaw = arc(1.0, 2.0, 2.0)
        np.testing.assert_allclose(sim.model("box").pose.position, (x, y, 1.2), atol=1e-9)
        assert sim.model("box").pose.rpy[2] == pytest.approx(math.remainder(yaw, 2 * math.pi), abs=1e-9)


def test_initial_velocities_last_until_the_first_command() -> None:
    inner = "<initial_linear>0.3 0 0</initial_linear><initial_angular>0 0 -0.1</initial_angular>"
    with opened(inner) as sim:
        sim.run(1.0)
        np.testing.assert_allclose(planar(sim), arc(0.3, -0.1, 1.0), atol=1e-6)
        sim.publish(TOPIC, {})
        sim.run(0.1)
        at = planar(sim)
        sim.run(0.2)
        np.testing.assert_allclose(planar(sim), at, atol=1e-9)


def test_a_wall_stops_the_model_without_tilting_it() -> None:
    with opened("", WALL) as sim:
        sim.publish(TOPIC, {"linear": {"x": 1.0}})
        sim.run(1.2)
        pose = sim.model("box").pose
        assert (
            0.69 < pose.position[0] < 0.72
        )  # the wall begins at 0.9 m, the box ends 0.2 m ahead of its origin; contacts are soft
        np.testing.assert_allclose(pose.rpy, 0, atol=1e-3)


def test_a_load_on_the_model_is_carried_along() -> None:
    """Friction holds a load of a fifth of the carrier's weight; the carrier sinks by g·dt of it, as in Gazebo."""
    load = box("", name="load", pose="0 0 0.301 0 0 0", mass=1.0)
    with opened("", load) as sim:
        sim.run(0.3)
        sim.publish(TOPIC, {"linear": {"x": 0.3}, "angular": {"z": 0.2}})
        sim.run(1.5)
        np.testing.assert_allclose(planar(sim), arc(0.3, 0.2, 1.5), atol=2e-3)
        load_at = sim.model("load").pose.position
    np.testing.assert_allclose(load_at[:2], arc(0.3, 0.2, 1.5)[:2], atol=0.02)


def test_an_arm_on_the_model_swings_as_on_a_fixed_base() -> None:
    """An arm with 0.28 kg·m² about the hinge and 5.886 N·m at 1 rad is back after a whole period."""
    with simkit.load(world(box(velocity_control(), pose="0 0 2 0 0 0", extra=ARM))) as sim:
        sim.joint("box::hinge").set_position(1.0)
        angles = []
        for _ in range(1600):
            sim.step()
            angles.append(sim.joint("box::hinge").position)
        np.testing.assert_allclose(sim.model("box").pose.position, (0, 0, 2), atol=1e-6)
    angles = np.array(angles)
    assert angles.min() == pytest.approx(-1.0, abs=2e-3)
    # T = 4·sqrt(I/mgl)·K(sin 0.5): K = 1.68575
    period = 4 * math.sqrt((0.1 + 2 * 0.09) / (2 * 9.8 * 0.3)) * 1.68575
    assert (np.argmin(angles) + 1) * 0.001 == pytest.approx(period / 2, abs=0.01)


def test_an_imu_on_the_model_measures_gravity() -> None:
    imu = "<sensor name='imu' type='imu'><update_rate>100</update_rate></sensor>"
    model = box(velocity_control(), pose="0 0 2 0 0 0").replace("</link>", f"{imu}</link>")
    with simkit.load(world(model)) as sim:
        sim.run(0.5)
        acceleration = sim.sensor("box::base::imu").latest.linear_acceleration
        assert (acceleration.x, acceleration.y, acceleration.z) == pytest.approx((0, 0, 9.8), abs=1e-9)


def test_a_link_command_moves_its_connected_links_only() -> None:
    loose = f"<link name='drone'><pose>0 1 0.9 0 0 1.5707963</pose><inertial><mass>1</mass>{INERTIA}</inertial></link>"
    with opened("<link_name>drone</link_name>", extra=loose) as sim:
        topic = "/model/box/link/drone/cmd_vel"
        assert sim.topics()[topic] == "geometry_msgs/msg/Twist"
        sim.publish(TOPIC, {"linear": {"x": 0.2}})
        sim.run(1.0)
        np.testing.assert_allclose(sim.link("box::drone").pose.position, (0.2, 1, 1), atol=1e-9)
        sim.publish(topic, {"linear": {"x": 0.5}, "angular": {"z": 0.5}})
        sim.run(1.0)
        x, y, yaw = arc(0.5, 0.5, 1.0)
        pose = sim.link("box::drone").pose
        np.testing.assert_allclose(pose.position, (0.2 - y, 1 + x, 1), atol=1e-6)
        assert pose.rpy[2] == pytest.approx(math.pi / 2 + yaw, abs=1e-6)
        np.testing.assert_allclose(planar(sim), (0.4, 0, 0), atol=1e-9)


def test_a_link_command_moves_all_links_that_joints_connect_to_it() -> None:
    with opened("<link_name>arm</link_name>", extra=ARM, pose="0 0 2 0 0 0") as sim:
        sim.publish("/model/box/link/arm/cmd_vel", {"linear": {"x": 0.5}})
        sim.run(1.0)
        np.testing.assert_allclose(sim.model("box").pose.position, (0.5, 0, 2), atol=1e-6)


def test_a_nan_or_infinite_command_is_ignored() -> None:
    with opened() as sim:
        sim.publish(TOPIC, {"linear": {"x": 0.5}})
        for _ in range(2):
            sim.publish(TOPIC, {"linear": {"x": math.nan}})
        sim.run(1.0)
        np.testing.assert_allclose(planar(sim), (0.5, 0, 0), atol=1e-6)
        assert [d.code for d in sim.diagnostics if d.severity == "warning"] == ["SK-PLUGIN-041"]


@pytest.mark.parametrize("part", ["linear", "angular"])
def test_a_command_above_the_limit_of_the_engine_counts_as_infinite(part: str) -> None:
    with opened() as sim:
        sim.publish(TOPIC, {"linear": {"x": 0.5}})
        sim.publish(TOPIC, {part: {"z": 1e300}})
        sim.run(1.0)
        np.testing.assert_allclose(planar(sim), (0.5, 0, 0), atol=1e-6)
        assert [d.code for d in sim.diagnostics if d.severity == "warning"] == ["SK-PLUGIN-041"]


def test_a_stamped_command_has_the_same_effect() -> None:
    with opened() as sim:
        sim.publish(TOPIC, {"twist": {"linear": {"x": 0.5}}})
        sim.run(1.0)
        np.testing.assert_allclose(planar(sim), (0.5, 0, 0), atol=1e-6)


def test_an_unknown_link_is_an_error_with_the_closest_name() -> None:
    with pytest.raises(simkit.LoadError) as caught:
        opened("<link_name>bass</link_name>")
    (found,) = (d for d in caught.value.diagnostics if d.severity == "error")
    assert found.code == "SK-PLUGIN-003"
    assert "'bass'" in found.message and "'base'" in found.hint
    assert found.line is not None


def test_a_model_with_a_joint_to_the_world_is_reported_and_does_not_move() -> None:
    anchor = "<joint name='anchor' type='fixed'><parent>world</parent><child>base</child></joint>"
    with opened(extra=anchor) as sim:
        assert "SK-PLUGIN-053" in [d.code for d in sim.diagnostics]
        sim.publish(TOPIC, {"linear": {"x": 0.5}})
        sim.run(0.5)
        np.testing.assert_allclose(planar(sim), 0, atol=1e-12)


def test_reset_and_restore_repeat_bit_for_bit() -> None:
    with opened("", WALL, extra=ARM) as sim:

        def run() -> list[float]:
            sim.publish(TOPIC, {"linear": {"x": 1.0}, "angular": {"z": 0.1}})
            sim.run(0.3)
            snapshot = sim.snapshot()
            sim.run(0.6)
            first = sim.model("box").pose.as_list()
            sim.restore(snapshot)
            sim.run(0.6)
            assert sim.model("box").pose.as_list() == first
            return first

        first = run()
        sim.reset()
        assert run() == first


def test_spawned_and_removed_models_do_not_change_the_motion() -> None:
    with opened() as sim:
        sim.publish(TOPIC, {"linear": {"x": 0.5}, "angular": {"z": 0.7}})
        sim.run(0.4)
        sim.spawn(f"<sdf version='1.9'>{box('', name='other')}</sdf>", pose=simkit.Pose((0, 5, 0.1)))
        sim.run(0.4)
        sim.remove("other")
        sim.run(0.4)
        np.testing.assert_allclose(planar(sim), arc(0.5, 0.7, 1.2), atol=1e-6)


def test_two_models_follow_their_own_commands() -> None:
    other = box(velocity_control(), name="other", pose="0 3 0.1 0 0 0", extra=ARM)
    with opened("", other) as sim:
        sim.publish(TOPIC, {"linear": {"x": 0.5}, "angular": {"z": 0.7}})
        sim.publish("/model/other/cmd_vel", {"linear": {"x": -0.5}, "angular": {"z": 0.7}})
        sim.run(1.0)
        np.testing.assert_allclose(planar(sim), arc(0.5, 0.7, 1.0), atol=1e-6)
        there = sim.model("other").pose
        x, y, yaw = arc(-0.5, 0.7, 1.0)
        np.testing.assert_allclose((*there.position[:2], there.rpy[2]), (x, 3 + y, yaw), atol=1e-5)


@pytest.mark.parametrize("step", [0.002, 0.004])
def test_models_moved_together_have_the_same_bits_as_one_by_one(step: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Six boxes touch the ground and two touch each other, with elliptic and pyramidal friction cones."""
    models = [box(velocity_control(), name=f"b{k}", pose=f"{k} 0 0.1 0 0 0", extra=ARM) for k in range(6)]
    ends = []
    for least in (2, 100):
        monkeypatch.setattr("simkit.runtime.engine.step_tasks.MIN_GROUP_SIZE", least)
        with simkit.load(world(GROUND, *models, step=step)) as sim:
            for k in range(6):
                sim.publish(f"/model/b{k}/cmd_vel", {"linear": {"x": 0.5 - k}, "angular": {"z": 0.1 * k}})
            sim.run(0.3)
            ends.append([sim.model(f"b{k}").pose.as_list() for k in range(6)])
    assert ends[0] == ends[1]
