"""Planar move of Gazebo Classic."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from moved_models import WALL, arc, box, planar_move
from plugin_worlds import GROUND, stamps, world, xyz, yaw

import simkit
from simkit.params import Params
from simkit.plugins.classic.planar_move import read_options


def opened(*others: str, step: float = 0.002, pose: str = "0 0 0.1 0 0 0", **values: Any) -> simkit.Simulation:
    if "robotNamespace" not in values:
        values = {"ros": "", **values}
    return simkit.load(world(GROUND, *others, box(planar_move(**values), pose=pose), step=step))


def planar(sim: simkit.Simulation) -> np.ndarray:
    pose = sim.model("box").pose
    return np.array((pose.position[0], pose.position[1], pose.rpy[2]))


# ------------------------------------------------------------------ parameters


def test_missing_parameters_of_ros_2_have_gazebos_defaults() -> None:
    found = read_options(Params.from_dict({}))
    assert (found.update_rate, found.publish_rate) == (20.0, 20.0)
    assert found.publish_odom and found.publish_odom_tf and not found.is_level
    assert (found.odometry_frame, found.robot_base_frame) == ("odom", "base_footprint")
    assert (found.covariance_x, found.covariance_y, found.covariance_yaw) == (1e-5, 1e-5, 1e-3)


def test_missing_parameters_of_ros_1_have_gazebos_defaults() -> None:
    found = read_options(Params.from_dict({"robotNamespace": ""}))
    assert (found.command_topic, found.odometry_topic, found.publish_rate) == ("cmd_vel", "odom", 20.0)
    assert found.timeout == math.inf and found.is_level
    assert (found.covariance_x, found.covariance_y, found.covariance_yaw) == (1e-5, 1e-5, 1e-3)


@pytest.mark.parametrize("name", ["update_rate", "publish_rate", "covariance_x"])
def test_a_negative_rate_or_variance_is_an_error(name: str) -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        opened(**{name: -1})


# ------------------------------------------------------------------ motion


@pytest.mark.parametrize("step", [0.001, 0.005])
def test_the_model_moves_forward_sideways_and_turns_as_commanded(step: float) -> None:
    """0.4 m/s ahead, 0.2 m/s to the left, 0.6 rad/s: a circle of radius 0.745 m, in the axes of its heading."""
    with opened(step=step, pose="1 2 0.1 0 0 1.5707963267948966", update_rate=0) as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 0.4, "y": 0.2}, "angular": {"z": 0.6}})
        sim.run(2.5)
        x, y, turned = arc(0.4, 0.6, 2.5, aside=0.2)
        np.testing.assert_allclose(
            planar(sim), (1 - y, 2 + x, math.remainder(math.pi / 2 + turned, 2 * math.pi)), atol=1e-4
        )
        assert sim.model("box").pose.position[2] == pytest.approx(0.1, abs=1e-5)


def test_the_last_command_stays_active_and_is_read_at_the_update_rate() -> None:
    """At 20 Hz a command of 10 ms waits until 50 ms."""
    with opened() as sim:
        sim.run(0.01)
        sim.publish("/cmd_vel", {"linear": {"x": 1.0}})
        sim.run(0.99)
        assert planar(sim)[0] == pytest.approx(0.95, abs=1e-3)


def test_the_model_falls_without_contact_and_lands() -> None:
    with opened(pose="0 0 0.5 0 0 0") as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 0.5}})
        sim.run(0.2)
        assert sim.model("box").pose.position[2] == pytest.approx(0.5 - 9.8 * 0.2**2 / 2, abs=3e-3)
        sim.run(0.8)
        assert sim.model("box").pose.position[2] == pytest.approx(0.1, abs=1e-3)
        assert planar(sim)[0] == pytest.approx(0.5, abs=1e-3)
        np.testing.assert_allclose(sim.model("box").pose.rpy, 0, atol=1e-4)


def test_a_model_without_gravity_keeps_its_height() -> None:
    floating = box(planar_move(ros=""), pose="0 0 1 0 0 0").replace("<inertial>", "<gravity>0</gravity><inertial>")
    with simkit.load(world(GROUND, floating)) as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 1.0}})
        sim.run(1.0)
        assert sim.model("box").pose.position[2] == pytest.approx(1.0, abs=1e-9)


def test_a_wall_stops_the_model_and_it_can_move_back() -> None:
    with opened(WALL) as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 1.0}})
        sim.run(1.5)
        assert 0.69 < planar(sim)[0] < 0.72
        sim.publish("/cmd_vel", {"linear": {"x": -1.0}})
        sim.run(0.55)
        assert planar(sim)[0] < 0.25


def test_ros_1_stops_after_the_timeout_without_commands() -> None:
    with opened(robotNamespace="", cmdTimeout=0.5) as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 0.4}})
        sim.run(2.0)
        assert planar(sim)[0] == pytest.approx(0.2, abs=2e-3)


# ------------------------------------------------------------------ odometry


def test_odometry_is_the_true_pose_and_the_twist_along_the_heading() -> None:
    with opened(pose="1 2 0.1 0 0 1.0", update_rate=0) as sim:
        odometry, tf = sim.subscribe("/odom"), sim.subscribe("/tf")
        sim.publish("/cmd_vel", {"linear": {"x": 0.4, "y": 0.2}, "angular": {"z": 0.6}})
        sim.run(1.0)
        pose = sim.model("box").pose
    message = odometry.latest
    np.testing.assert_array_equal(stamps(odometry.messages), np.arange(1, 21) * 50_000_000)
    np.testing.assert_allclose(xyz(message.pose.pose.position), pose.position, atol=1e-12)
    assert yaw(message.pose.pose.orientation) == pytest.approx(pose.rpy[2], abs=1e-9)
    np.testing.assert_allclose(xyz(message.twist.twist.linear), (0.4, 0.2, 0), atol=1e-3)
    np.testing.assert_allclose(xyz(message.twist.twist.angular), (0, 0, 0.6), atol=1e-4)
    assert (message.header.frame_id, message.child_frame_id) == ("odom", "base_footprint")
    (transform,) = tf.latest.transforms
    np.testing.assert_allclose(xyz(transform.transform.translation), pose.position, atol=1e-12)


def test_names_rates_and_variances_are_those_of_the_file() -> None:
    ros = "<namespace>/one</namespace><remapping>cmd_vel:=go</remapping><remapping>odom:=where</remapping>"
    values = {"publish_rate": 10, "odometry_frame": "map", "robot_base_frame": "base", "covariance_yaw": 0.5}
    with opened(ros=ros, publish_odom_tf="false", **values) as sim:
        assert {"/one/go", "/one/where"} <= set(sim.topics())
        assert "/tf" not in sim.topics()
        odometry = sim.subscribe("/one/where")
        sim.run(0.5)
    assert len(odometry.messages) == 5
    assert (odometry.latest.header.frame_id, odometry.latest.child_frame_id) == ("map", "base")
    assert odometry.latest.pose.covariance[35] == odometry.latest.twist.covariance[35] == 0.5


def test_ros_1_has_height_zero() -> None:
    names = {"commandTopic": "go", "odometryTopic": "where", "odometryFrame": "map", "robotBaseFrame": "base"}
    with opened(robotNamespace="one", odometryRate=50, **names) as sim:
        odometry, tf = sim.subscribe("/one/where"), sim.subscribe("/tf")
        sim.publish("/one/go", {"linear": {"y": 0.5}})
        sim.run(1.0)
    assert len(odometry.messages) == 50
    np.testing.assert_allclose(xyz(odometry.latest.pose.pose.position), (0, 0.5, 0), atol=2e-3)
    np.testing.assert_array_equal(odometry.latest.pose.covariance[::7], [1e-5, 1e-5, 1e12, 1e12, 1e12, 1e-3])
    np.testing.assert_array_equal(odometry.latest.twist.covariance, 0)
    assert tf.latest.transforms[0].transform.translation.z == pytest.approx(0.1, abs=1e-3)
    assert tf.latest.transforms[0].child_frame_id == "base"


def test_ros_1_with_rate_zero_publishes_nothing() -> None:
    with opened(robotNamespace="", odometryRate=0) as sim:
        assert "/odom" not in sim.topics()


def test_a_restored_run_repeats_bit_for_bit() -> None:
    with opened(WALL) as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 0.8, "y": 0.1}, "angular": {"z": 0.3}})
        sim.run(0.31)
        snapshot = sim.snapshot()
        ends = []
        for _ in range(2):
            sim.restore(snapshot)
            sim.run(1.0)
            ends.append(sim.model("box").pose.as_list())
    assert ends[0] == ends[1]
