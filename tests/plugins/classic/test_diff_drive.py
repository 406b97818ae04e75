"""Differential drive of Gazebo Classic on the ground."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from plugin_worlds import GROUND, classic_drive, element, rover, stamps, world, xyz, yaw

import simkit
from simkit import msgs

TWIST = {"linear": {"x": 0.3}}


def opened(extra: str = "", **values: Any) -> simkit.Simulation:
    return simkit.load(world(GROUND, rover(classic_drive(**values) + extra)))


def test_its_topics_are_those_of_the_ros_node() -> None:
    with opened(publish_odom_tf="true") as sim:
        topics = sim.topics()
    assert topics["/cmd_vel"] == "geometry_msgs/msg/Twist"
    assert topics["/odom"] == "nav_msgs/msg/Odometry"
    assert topics["/tf"] == "tf2_msgs/msg/TFMessage"
    assert "/ground_truth/odom" not in topics


def test_namespace_and_remapping_move_its_topics() -> None:
    ros = "<namespace>/one</namespace><remapping>odom:=wheels</remapping>"
    with opened(ros=ros) as sim:
        assert {"/one/cmd_vel", "/one/wheels"} <= set(sim.topics())


def test_the_robot_drives_at_the_commanded_speed_and_keeps_the_last_command() -> None:
    with opened() as sim:
        sim.run(0.5)
        start = sim.model("rover").pose.position
        sim.publish("/cmd_vel", TWIST)
        sim.run(3.0)
        moved = sim.model("rover").pose.position - start
    assert moved[0] == pytest.approx(0.9, abs=0.02)
    assert abs(moved[1]) < 1e-3


def test_a_stamped_command_does_the_same() -> None:
    ends = []
    for message in (TWIST, {"twist": TWIST}):
        with opened() as sim:
            sim.publish("/cmd_vel", message)
            sim.run(1.0)
            ends.append(sim.model("rover").pose.position)
    np.testing.assert_array_equal(ends[0], ends[1])


def test_a_positive_turn_is_to_the_left_at_the_commanded_rate() -> None:
    with opened() as sim:
        sim.run(0.5)
        sim.publish("/cmd_vel", {"angular": {"z": 0.5}})
        sim.run(2.0)
        assert sim.model("rover").pose.rpy[2] == pytest.approx(1.0, abs=0.03)


def test_odometry_has_the_update_rate_and_the_frames_of_the_file() -> None:
    with opened(update_rate=30, odometry_frame="here", robot_base_frame="base") as sim:
        odometry = sim.subscribe("/odom")
        sim.run(1.0)
    expected = [-(-k * 1_000_000_000 // 30) for k in range(1, 31)]
    expected = [-(-t // 1_000_000) * 1_000_000 for t in expected]
    np.testing.assert_array_equal(stamps(odometry.messages), expected)
    assert (odometry.latest.header.frame_id, odometry.latest.child_frame_id) == ("here", "base")


def test_odometry_from_the_world_is_the_models_pose_and_its_own_velocity() -> None:
    with simkit.load(world(GROUND, rover(classic_drive(odometry_source=1), pose="1 2 0 0 0 1.5707963"))) as sim:
        odometry = sim.subscribe("/odom")
        sim.publish("/cmd_vel", TWIST)
        sim.run(1.0)
        pose = sim.model("rover").pose
        message = odometry.latest
    np.testing.assert_allclose(xyz(message.pose.pose.position), pose.position, atol=1e-12)
    assert yaw(message.pose.pose.orientation) == pytest.approx(pose.rpy[2], abs=1e-9)
    np.testing.assert_allclose(xyz(message.twist.twist.linear)[:2], [0.3, 0.0], atol=3e-3)


def test_odometry_from_encoders_starts_at_zero_and_follows_the_wheels() -> None:
    with simkit.load(world(GROUND, rover(classic_drive(odometry_source=0), pose="1 2 0 0 0 1.5"))) as sim:
        odometry = sim.subscribe("/odom")
        sim.run(0.3)
        start = sim.model("rover").pose
        sim.publish("/cmd_vel", {"linear": {"x": 0.3}, "angular": {"z": 0.4}})
        sim.run(3.0)
        moved = start.inverse() @ sim.model("rover").pose
        message = odometry.latest
    at = xyz(message.pose.pose.position)
    np.testing.assert_allclose(at[:2], moved.position[:2], atol=0.02)
    assert yaw(message.pose.pose.orientation) == pytest.approx(moved.rpy[2], abs=0.03)
    assert message.twist.twist.angular.z == pytest.approx(0.4, abs=5e-3)


def test_driving_backwards_has_a_negative_speed() -> None:
    with opened(odometry_source=0) as sim:
        odometry = sim.subscribe("/odom")
        sim.publish("/cmd_vel", {"linear": {"x": -0.2}})
        sim.run(1.0)
    assert odometry.latest.twist.twist.linear.x == pytest.approx(-0.2, abs=2e-3)


def test_covariances_are_those_of_the_file() -> None:
    with opened(covariance_x=0.1, covariance_y=0.2, covariance_yaw=0.3) as sim:
        odometry = sim.subscribe("/odom")
        sim.run(0.1)
    for part in (odometry.latest.pose, odometry.latest.twist):
        diagonal = np.diag(np.asarray(part.covariance).reshape(6, 6))
        np.testing.assert_allclose(diagonal[[0, 1, 5]], [0.1, 0.2, 0.3])


def test_the_acceleration_limit_is_that_of_the_rim() -> None:
    with opened(max_wheel_acceleration=0.5) as sim:
        sim.run(0.5)
        sim.publish("/cmd_vel", {"linear": {"x": 0.4}})
        sim.run(0.4)
        assert sim.link("rover::base").linear_velocity[0] == pytest.approx(0.2, abs=0.02)
        sim.run(0.8)
        assert sim.link("rover::base").linear_velocity[0] == pytest.approx(0.4, abs=0.01)


def test_the_torque_limit_bounds_the_acceleration() -> None:
    """Two wheels of 0.1 N·m on a rim of 0.1 m push with 2 N; 5.2 kg and two wheels' spin take that as 0.37 m/s²."""
    with opened(max_wheel_torque=0.1) as sim:
        sim.run(0.5)
        sim.publish("/cmd_vel", {"linear": {"x": 5.0}})
        sim.run(1.0)
        speed = sim.link("rover::base").linear_velocity[0]
        # armature that the servo needs makes it a little slower
        assert 0.2 < speed < 2.0 / (5.2 + 2 * 0.002 / 0.1**2) * 1.01


def test_a_saturated_wheel_does_not_oscillate() -> None:
    with opened(max_wheel_torque=0.05) as sim:
        sim.run(0.5)
        sim.publish("/cmd_vel", {"linear": {"x": 0.1}})
        speeds = []
        for _ in range(1500):
            sim.step()
            speeds.append(sim.joint("rover::left_wheel").velocity)
    assert np.max(speeds) < 1.05
    assert np.abs(np.diff(speeds)).max() < 0.05


def test_the_transform_of_the_base_is_on_tf() -> None:
    with opened(publish_odom_tf="true", publish_wheel_tf="true") as sim:
        tf = sim.subscribe("/tf")
        sim.publish("/cmd_vel", TWIST)
        sim.run(0.5)
        position = sim.model("rover").pose.position
    found = {(t.header.frame_id, t.child_frame_id): t.transform for t in tf.latest.transforms}
    assert set(found) == {("odom", "base_footprint"), ("base", "left"), ("base", "right")}
    np.testing.assert_allclose(xyz(found["odom", "base_footprint"].translation), position, atol=1e-12)
    np.testing.assert_allclose(xyz(found["base", "left"].translation), [0, 0.2, -0.03], atol=1e-4)


def test_ground_truth_is_published_on_request() -> None:
    with opened(odometry_source=0, publish_ground_truth="true") as sim:
        odometry, truth = sim.subscribe("/odom"), sim.subscribe("/ground_truth/odom")
        sim.publish("/cmd_vel", TWIST)
        sim.run(1.0)
        position = sim.model("rover").pose.position
    np.testing.assert_array_equal(stamps(odometry.messages), stamps(truth.messages))
    np.testing.assert_allclose(xyz(truth.latest.pose.pose.position), position, atol=1e-12)
    assert truth.latest.header.frame_id == "world"


def test_the_slip_of_the_wheels_is_published_with_the_ground_truth() -> None:
    with opened(odometry_source=0, publish_ground_truth="true") as sim:
        truth, slip = (
            sim.subscribe("/ground_truth/odom"),
            sim.subscribe("/ground_truth/wheel_slip", type=msgs.WheelMotion),
        )
        sim.publish("/cmd_vel", TWIST)
        sim.run(1.0)
        wheels = {wheel.joint: wheel for wheel in sim.wheel_slips("rover")}
    np.testing.assert_array_equal(stamps(slip.messages), stamps(truth.messages))
    assert slip.latest is not None
    assert slip.latest.name == ["left_wheel", "right_wheel"]
    for place, name in enumerate(slip.latest.name):
        assert slip.latest.slip[place] == wheels[f"rover::{name}"].slip


def test_without_a_request_there_is_no_ground_truth() -> None:
    with opened(odometry_source=0) as sim:
        assert not [topic for topic in sim.topics() if "ground_truth" in topic]


def test_the_ros_1_spelling_drives_too() -> None:
    values = {
        "robotNamespace": "one",
        "leftJoint": "left_wheel",
        "rightJoint": "right_wheel",
        "legacyMode": "false",
        "wheelSeparation": 0.4,
        "wheelDiameter": 0.2,
        "wheelTorque": 20,
        "commandTopic": "go",
        "odometryTopic": "where",
        "odometrySource": "encoder",
        "publishWheelJointState": "true",
    }
    plugin = element("plugin", values, "name='drive' filename='libgazebo_ros_diff_drive.so'")
    with simkit.load(world(GROUND, rover(plugin))) as sim:
        where, states = sim.subscribe("/one/where"), sim.subscribe("/one/joint_states")
        sim.publish("/one/go", TWIST)
        sim.run(2.0)
    assert where.latest.pose.pose.position.x == pytest.approx(0.6, abs=0.01)
    assert list(states.latest.name) == ["left_wheel", "right_wheel"]


def test_an_unknown_wheel_is_an_error_with_the_closest_joint() -> None:
    with pytest.raises(simkit.LoadError) as caught:
        opened(left_joint="left_whele")
    (found,) = (d for d in caught.value.diagnostics if d.severity == "error")
    assert found.code == "SK-PLUGIN-003"
    assert "'left_whele'" in found.message and "'left_wheel'" in found.hint
    assert found.line is not None


def test_a_wheel_on_a_fixed_joint_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003.*one axis"):
        opened(left_joint="front_weld")


def test_reset_clears_command_and_odometry() -> None:
    with opened(odometry_source=0) as sim:
        odometry = sim.subscribe("/odom")
        sim.publish("/cmd_vel", TWIST)
        sim.run(1.0)
        sim.reset()
        sim.run(1.0)
    assert abs(odometry.latest.pose.pose.position.x) < 1e-4


def test_a_restored_run_repeats_bit_for_bit() -> None:
    with opened(odometry_source=0, max_wheel_acceleration=0.5) as sim:
        odometry = sim.subscribe("/odom")
        sim.publish("/cmd_vel", TWIST)
        sim.run(0.25)
        snapshot = sim.snapshot()
        runs = []
        for _ in range(2):
            sim.restore(snapshot)
            sim.run(0.5)
            runs.append((*xyz(odometry.latest.pose.pose.position), *sim.model("rover").pose.as_list()))
    assert runs[0] == runs[1]


def test_other_step_lengths_give_the_same_path() -> None:
    for step in (0.001, 0.002, 0.004):
        with simkit.load(world(GROUND, rover(classic_drive()), step=step)) as sim:
            sim.run(0.5)
            start = sim.model("rover").pose.position
            sim.publish("/cmd_vel", TWIST)
            sim.run(2.0)
            moved = sim.model("rover").pose.position - start
        assert moved[0] == pytest.approx(0.6, abs=0.02), step
        assert abs(moved[1]) < 2e-3, step


def test_the_effort_limit_of_a_joint_does_not_bound_its_wheel_motor() -> None:
    text = world(GROUND, rover(classic_drive())).replace("</axis>", "<limit><effort>0</effort></limit></axis>")
    assert "<effort>0</effort>" in text
    with simkit.load(text) as sim:  # ODE's joint motor has its own limit, fmax
        assert not [d for d in sim.diagnostics if d.code == "SK-JOINT-011"]
        sim.run(0.5)
        sim.publish("/cmd_vel", TWIST)
        sim.run(3.0)
        assert sim.model("rover").pose.position[0] == pytest.approx(0.9, abs=0.02)
