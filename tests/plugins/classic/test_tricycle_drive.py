"""Tricycle drive of Gazebo Classic."""

from __future__ import annotations

import math

import pytest
from car_worlds import BASE, tricycle, world

import simkit

ROS_2 = """<plugin filename="libgazebo_ros_tricycle_drive.so" name="drive">
  <actuated_wheel_diameter>0.2</actuated_wheel_diameter><encoder_wheel_diameter>0.2</encoder_wheel_diameter>
  <wheel_separation>0.4</wheel_separation><max_wheel_torque>5</max_wheel_torque><publish_odom>true</publish_odom>
  {}</plugin>"""
ROS_1 = """<plugin filename="libgazebo_ros_tricycle_drive.so" name="drive"><robotNamespace>trike</robotNamespace>
  <actuatedWheelDiameter>0.2</actuatedWheelDiameter><encoderWheelDiameter>0.2</encoderWheelDiameter>
  <encoderWheelSeparation>0.4</encoderWheelSeparation><publishWheelJointState>true</publishWheelJointState>
  {}</plugin>"""
GENTLE = "<max_wheel_acceleration>3</max_wheel_acceleration><max_steering_speed>0.5</max_steering_speed>"


def command(sim, speed, angle, topic="/cmd_vel"):
    sim.publish(topic, {"linear": {"x": speed}, "angular": {"z": angle}})


def joint(sim, name):
    return sim.joint(f"trike::{name}_joint")


def test_a_command_is_a_speed_of_the_wheel_and_an_angle_of_the_steering():
    """The base turns about the rear axle at v sin(angle) / base."""
    sim = simkit.load(world(tricycle(ROS_2.format(""))))
    command(sim, 0.4, 0.3)
    sim.run(1.5)
    assert joint(sim, "front_steering").position == pytest.approx(0.3, abs=5e-3)
    assert joint(sim, "front_wheel").velocity == pytest.approx(4.0, rel=0.02)
    assert sim.link("trike::base").angular_velocity[2] == pytest.approx(0.4 * math.sin(0.3) / BASE, rel=0.03)


def test_odometry_is_the_truth_or_the_turns_of_the_rear_wheels():
    for source, expected in ((1, 0.03), (0, 0.03)):
        sim = simkit.load(world(tricycle(ROS_2.format(f"{GENTLE}<odometry_source>{source}</odometry_source>"))))
        odometry, tf = sim.subscribe("/odom"), sim.subscribe("/tf")
        command(sim, 0.4, 0.3)
        sim.run(3.0)
        message, pose = odometry.messages[-1], sim.model("trike").pose
        position, turned = message.pose.pose.position, message.pose.pose.orientation
        at = (pose.position[0], pose.position[1])
        if source == 0:  # of the middle of the rear axle
            yaw = pose.rpy[2]
            at = (at[0] + BASE / 2 * (1 - math.cos(yaw)), at[1] - BASE / 2 * math.sin(yaw))
        assert (position.x, position.y) == pytest.approx(at, abs=expected)
        assert 2 * math.atan2(turned.z, turned.w) == pytest.approx(pose.rpy[2], abs=0.03)
        assert (message.header.frame_id, message.child_frame_id) == ("odom", "base_link")
        assert len(odometry.messages) == 300
        assert tf.messages


def test_the_steering_keeps_its_speed_limit():
    sim = simkit.load(world(tricycle(ROS_2.format("<max_steering_speed>0.5</max_steering_speed>"))))
    command(sim, 0.0, 0.6)
    sim.run(0.6)
    assert joint(sim, "front_steering").position == pytest.approx(0.3, abs=0.02)
    sim.run(1.4)
    assert joint(sim, "front_steering").position == pytest.approx(0.6, abs=0.012)
    command(sim, 0.5, -0.2)
    sim.run(2.5)
    assert joint(sim, "front_steering").position == pytest.approx(-0.2, abs=0.012)


def test_accelerations_limit_the_wheel():
    limits = "<max_wheel_acceleration>2</max_wheel_acceleration><max_wheel_deceleration>8</max_wheel_deceleration>"
    sim = simkit.load(world(tricycle(ROS_2.format(limits))))
    command(sim, 0.4, 0.0)
    sim.run(1.0)
    assert joint(sim, "front_wheel").velocity == pytest.approx(2.0, abs=0.1)
    sim.run(1.5)
    assert joint(sim, "front_wheel").velocity == pytest.approx(4.0, abs=0.05)
    command(sim, 0.0, 0.0)
    sim.run(0.25)
    assert joint(sim, "front_wheel").velocity == pytest.approx(2.0, abs=0.3)


def test_the_ros_1_spelling_is_supported():
    extra = (
        "<commandTopic>go</commandTopic><odometryTopic>where</odometryTopic><odometrySource>encoder</odometrySource>"
    )
    sim = simkit.load(world(tricycle(ROS_1.format(extra))))
    odometry, states = sim.subscribe("/trike/where"), sim.subscribe("/trike/joint_states")
    command(sim, 0.3, 0.0, "/trike/go")
    sim.run(2.0)
    assert odometry.messages[-1].pose.pose.position.x == pytest.approx(0.6, abs=0.03)
    names = ["front_steering_joint", "front_wheel_joint", "left_wheel_joint", "right_wheel_joint"]
    assert list(states.messages[-1].name) == names


def test_all_errors_are_reported_in_one_pass():
    wrong = ROS_2.format("<steering_joint>stering</steering_joint><odometry_source>7</odometry_source>")
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world(tricycle(wrong)))
    for part in ("'stering'", "<odometry_source>"):
        assert part in str(caught.value)


def test_a_reset_returns_to_the_start():
    sim = simkit.load(world(tricycle(ROS_2.format(""))))
    command(sim, 0.4, 0.3)
    sim.run(0.5)
    here = sim.mj_data.qpos.tobytes()
    sim.reset()
    command(sim, 0.4, 0.3)
    sim.run(0.5)
    assert sim.mj_data.qpos.tobytes() == here
