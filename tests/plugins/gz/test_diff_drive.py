"""Differential drive of Gazebo on the ground."""

from __future__ import annotations

from contextlib import suppress

import mujoco
import numpy as np
import pytest
from plugin_worlds import GROUND, gz_drive, rover, stamps, world, xyz, yaw

import simkit


def load(step: float = 0.001, **values: object) -> simkit.Simulation:
    return simkit.load(world(GROUND, rover(gz_drive(**values)), step=step))


def test_the_default_topics_are_those_of_gazebo() -> None:
    with load() as sim:
        topics = sim.topics()
    assert topics["/model/rover/cmd_vel"] == "geometry_msgs/msg/Twist"
    assert topics["/model/rover/enable"] == "std_msgs/msg/Bool"
    assert topics["/model/rover/odometry"] == "nav_msgs/msg/Odometry"
    assert topics["/model/rover/tf"] == "tf2_msgs/msg/TFMessage"


def test_topics_and_frames_can_be_named() -> None:
    with load(topic="cmd_vel", odom_topic="odom", tf_topic="/tf", frame_id="odom", child_frame_id="base") as sim:
        assert {"/cmd_vel", "/odom", "/tf"} <= set(sim.topics())
        odometry = sim.subscribe("/odom")
        sim.run(0.1)
    assert (odometry.latest.header.frame_id, odometry.latest.child_frame_id) == ("odom", "base")


def test_the_default_frames_are_those_of_the_model_and_its_first_link() -> None:
    with load() as sim:
        odometry = sim.subscribe("/model/rover/odometry")
        sim.run(0.1)
    assert (odometry.latest.header.frame_id, odometry.latest.child_frame_id) == ("rover/odom", "rover/base")


def test_odometry_is_published_at_fifty_hertz_after_the_first_twenty_milliseconds() -> None:
    with load() as sim:
        odometry = sim.subscribe("/model/rover/odometry")
        sim.run(0.2)
    np.testing.assert_array_equal(stamps(odometry.messages), np.arange(1, 11) * 20_000_000)


def test_a_frequency_of_zero_is_every_step_and_a_negative_one_an_error() -> None:
    with load(odom_publish_frequency=0) as sim:
        odometry = sim.subscribe("/model/rover/odometry")
        sim.run(0.05)
    np.testing.assert_array_equal(stamps(odometry.messages), np.arange(1, 51) * 1_000_000)
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002.*odom_publish_frequency"):
        load(odom_publish_frequency=-1)


def test_the_twist_is_the_mean_over_the_last_ten_steps() -> None:
    """At 1 m/s² the twist is the wheel speed of 4.5 steps before."""
    with load(max_acceleration=1, min_acceleration=-1) as sim:
        odometry = sim.subscribe("/model/rover/odometry")
        sim.run(0.2)
        sim.publish("/model/rover/cmd_vel", {"linear": {"x": 2.0}, "angular": {"z": 0.5}})
        rims = []
        for _ in range(400):
            sim.step()
            rims.append([0.1 * float(sim.joint(f"rover::{side}_wheel").velocity) for side in ("left", "right")])
    left, right = np.mean(rims[-10:], axis=0)
    twist = odometry.latest.twist.twist
    assert twist.linear.x == pytest.approx((left + right) / 2, abs=1e-9)
    assert twist.angular.z == pytest.approx((right - left) / 0.4, abs=1e-9)


def test_odometry_at_one_hertz_integrates_every_step() -> None:
    """The path is straight for 0.5 s and then a turn; one arc would be wrong."""
    ends = []
    for frequency in (1, 50):
        with load(odom_publish_frequency=frequency) as sim:
            odometry = sim.subscribe("/model/rover/odometry")
            sim.publish("/model/rover/cmd_vel", {"linear": {"x": 0.4}})
            sim.run(0.5)
            sim.publish("/model/rover/cmd_vel", {"angular": {"z": 1.5}})
            sim.run(0.5)
            ends.append(xyz(odometry.latest.pose.pose.position))
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-4)
    assert ends[0][0] == pytest.approx(0.2, abs=0.01)


@pytest.mark.parametrize("quantity", ["velocity", "acceleration", "jerk"])
def test_limits_apply_to_one_speed_or_to_both(quantity: str) -> None:
    """The wheel speeds match the limited command, forwards, backwards and turning."""
    bounds = {f"max_{quantity}": 0.4, f"min_{quantity}": -0.4, f"max_angular_{quantity}": 0.8}
    with load(**bounds, **{f"min_angular_{quantity}": -0.8}) as sim:
        sim.publish("/model/rover/cmd_vel", {"linear": {"x": -9.0}, "angular": {"z": -9.0}})
        sim.run(1.0)
        left, right = (0.1 * float(sim.joint(f"rover::{side}_wheel").velocity) for side in ("left", "right"))
    # after 1 s: the speed itself, a·t, or j·t²/2
    reached = {"velocity": 1.0, "acceleration": 1.0, "jerk": 0.5}[quantity]
    assert (left + right) / 2 == pytest.approx(-0.4 * reached, abs=0.01)
    assert (right - left) / 0.4 == pytest.approx(-0.8 * reached, abs=0.02)


def test_limits_of_speed_and_acceleration_are_kept() -> None:
    """A run of 2 s at 0.4 m/s with 1 m/s² covers 0.72 m."""
    with load(max_linear_acceleration=1, max_linear_velocity=0.4) as sim:
        sim.run(0.5)
        start = sim.model("rover").pose.position
        sim.publish("/model/rover/cmd_vel", {"linear": {"x": 9.0}})
        sim.run(2.0)
        moved = sim.model("rover").pose.position - start
    assert moved[0] == pytest.approx(0.4 * 2 - 0.4**2 / 2, abs=0.02)


def test_odometry_follows_the_wheels_along_an_arc() -> None:
    with load(max_acceleration=2, min_acceleration=-2) as sim:
        odometry = sim.subscribe("/model/rover/odometry")
        sim.run(0.5)
        start = sim.model("rover").pose
        sim.publish("/model/rover/cmd_vel", {"linear": {"x": 0.3}, "angular": {"z": 0.5}})
        sim.run(3.0)
        moved = start.inverse() @ sim.model("rover").pose
        message = odometry.latest
    np.testing.assert_allclose(xyz(message.pose.pose.position)[:2], moved.position[:2], atol=0.015)
    assert yaw(message.pose.pose.orientation) == pytest.approx(moved.rpy[2], abs=0.03)
    assert message.twist.twist.linear.x == pytest.approx(0.3, abs=5e-3)


def test_a_disabled_drive_stops_and_ignores_commands() -> None:
    with load() as sim:

        def speed_after(topic: str, message: dict[str, object]) -> float:
            sim.publish(f"/model/rover/{topic}", message)
            sim.run(0.5)
            return float(sim.joint("rover::left_wheel").velocity)

        assert speed_after("cmd_vel", {"linear": {"x": 0.2}}) == pytest.approx(2.0, abs=0.05)
        assert speed_after("enable", {"data": False}) == pytest.approx(0.0, abs=0.05)
        assert speed_after("cmd_vel", {"linear": {"x": 0.2}}) == pytest.approx(0.0, abs=0.05)
        assert speed_after("enable", {"data": True}) == pytest.approx(0.0, abs=0.05)
        assert speed_after("cmd_vel", {"linear": {"x": 0.2}}) == pytest.approx(2.0, abs=0.05)


def test_ground_truth_is_published_on_request() -> None:
    with load(publish_ground_truth="true") as sim:
        truth = sim.subscribe("/model/rover/ground_truth/odom")
        slip = sim.subscribe("/model/rover/ground_truth/wheel_slip")
        sim.publish("/model/rover/cmd_vel", {"linear": {"x": 0.2}})
        sim.run(1.0)
        assert slip.latest.name == ["left_wheel", "right_wheel"]
        np.testing.assert_allclose(slip.latest.rim_speed, 0.2, rtol=0.01)
        np.testing.assert_allclose(slip.latest.slip, 0.0, atol=1e-4)
        np.testing.assert_allclose(xyz(truth.latest.pose.pose.position), sim.model("rover").pose.position, atol=1e-12)


def test_a_missing_side_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-001.*right_joint"):
        load(right_joint=None)


def test_a_drive_on_the_world_is_left_out_with_a_warning() -> None:
    with simkit.load(world(GROUND, rover(), gz_drive())) as sim:
        assert "SK-PLUGIN-007" in [d.code for d in sim.diagnostics]


def test_an_infinite_command_does_not_stop_other_robots() -> None:
    other = "/model/other/cmd_vel"
    robots = [rover(gz_drive()), rover(gz_drive()).replace("name='rover'", "name='other'")]
    with simkit.load(world(GROUND, robots[0], robots[1])) as sim:
        assert other in sim.topics()
        sim.publish("/model/rover/cmd_vel", {"linear": {"x": 1e12}})
        sim.publish(other, {"linear": {"x": 0.3}})
        before = sim.mj_data.warning.number.copy()
        with suppress(simkit.SimulationDiverged):
            sim.step(50)
        assert not (sim.mj_data.warning.number - before)[int(mujoco.mjtWarning.mjWARN_BADCTRL)]
