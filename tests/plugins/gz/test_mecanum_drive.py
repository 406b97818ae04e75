"""Mecanum drive of Gazebo: forwards, sideways, turning, on slopes and against a wall."""

from __future__ import annotations

import math

import numpy as np
import pytest
from mecanum_worlds import mecanum, world

import simkit

LIMITS = "<max_acceleration>1</max_acceleration><min_acceleration>-1</min_acceleration>"
WALL = """<model name="wall"><static>true</static><pose>1 0 0.3 0 0 0</pose><link name="l">
  <collision name="c"><geometry>
  <box><size>0.1 4 0.6</size></box></geometry></collision></link></model>"""


def twist(x=0.0, y=0.0, turn=0.0):
    return {"linear": {"x": x, "y": y}, "angular": {"z": turn}}


def drive(text, command, duration):
    """Return the simulation, the displacement of the base in its own axes, and its odometry."""
    sim = simkit.load(text)
    sim.run(0.2)
    start, odometry = sim.model("robot").pose, sim.subscribe("/model/robot/odometry")
    sim.publish("/model/robot/cmd_vel", command)
    sim.run(duration)
    return sim, start.inverse() @ sim.model("robot").pose, odometry


def arc(x, y, turn, duration):
    """Return the position and heading after a constant twist."""
    angle = turn * duration
    if not angle:
        return np.array([x, y]) * duration, 0.0
    sin, cos = math.sin(angle) / turn, (1 - math.cos(angle)) / turn
    return np.array([sin * x - cos * y, cos * x + sin * y]), angle


@pytest.mark.parametrize("command", [(0.4, 0.0), (0.0, -0.4), (0.3, -0.2)])
@pytest.mark.parametrize("step", [0.002, 0.004])
def test_it_moves_in_the_commanded_direction(command, step):
    """An acceleration limit of 1 m/s² in each direction shortens the distance by v²/2."""
    _, moved, _ = drive(world(mecanum(settings=LIMITS), step=step), twist(*command), 2.0)
    expected = [v * 2.0 - math.copysign(v * v / 2, v) for v in command]
    assert moved.position[:2] == pytest.approx(expected, abs=0.012)
    assert moved.position[2] == pytest.approx(0.0, abs=1e-4)
    assert moved.rpy == pytest.approx((0, 0, 0), abs=3e-3)


def test_it_turns_on_the_spot_and_along_an_arc():
    _, moved, _ = drive(world(mecanum(settings=LIMITS)), twist(turn=0.8), 2.0)
    assert moved.rpy[2] == pytest.approx(0.8 * 2 - 0.8**2 / 2, rel=5e-3)
    assert moved.position[:2] == pytest.approx((0, 0), abs=2e-3)
    _, moved, _ = drive(world(mecanum()), twist(0.2, 0.15, 0.5), 3.0)
    place, angle = arc(0.2, 0.15, 0.5, 3.0)
    assert moved.position[:2] == pytest.approx(place, abs=0.015)
    assert moved.rpy[2] == pytest.approx(angle, abs=0.015)


def test_commands_refer_to_the_axes_of_the_base():
    _, moved, _ = drive(world(mecanum("1 2 0.1 0 0 2.1", LIMITS)), twist(0.0, 0.4), 2.0)
    assert moved.position[:2] == pytest.approx((0.0, 0.72), abs=0.012)


def test_odometry_comes_from_the_wheels_and_agrees_with_the_ground_truth():
    _, moved, odometry = drive(world(mecanum(settings=LIMITS)), twist(0.3, 0.2, 0.4), 3.0)
    message = odometry.messages[-1]
    estimated, turned = message.pose.pose.position, message.pose.pose.orientation
    assert (estimated.x, estimated.y) == pytest.approx(moved.position[:2], abs=0.015)
    assert 2 * math.atan2(turned.z, turned.w) == pytest.approx(moved.rpy[2], abs=0.01)
    speed = message.twist.twist
    assert (speed.linear.x, speed.linear.y, speed.angular.z) == pytest.approx((0.3, 0.2, 0.4), abs=2e-3)
    assert (message.header.frame_id, message.child_frame_id) == ("robot/odom", "robot/base")
    stamps = [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in odometry.messages]
    assert set(np.diff(stamps)) == {20_000_000}


@pytest.mark.parametrize(("slope", "across"), [(0.15, 0.0), (0.1, 0.1)])
def test_it_holds_and_drives_on_a_slope(slope, across):
    """Contacts creep by up to 1.5 cm/s under this load, as with every wheel on a velocity servo."""
    gravity = f"{-9.8 * math.sin(slope)} {-9.8 * math.sin(across)} {-9.8 * math.cos(math.hypot(slope, across))}"
    _, moved, _ = drive(world(mecanum(settings=LIMITS), gravity=gravity), twist(), 2.0)
    assert np.linalg.norm(moved.position[:2]) < 0.035
    _, moved, _ = drive(world(mecanum(settings=LIMITS), gravity=gravity), twist(0.0, 0.4), 2.0)
    assert moved.position[:2] == pytest.approx((0.0, 0.72), abs=0.04)
    assert abs(moved.rpy[2]) < 0.01


def test_against_a_wall_its_wheels_slip_and_it_slides_along():
    _, moved, _ = drive(world(mecanum(), WALL), twist(0.4), 3.0)
    assert moved.position[0] == pytest.approx(0.95 - 0.35, abs=0.002)
    assert abs(moved.rpy[1]) < 0.01
    _, moved, _ = drive(world(mecanum(), WALL), twist(0.4, 0.3), 4.0)
    assert moved.position[0] == pytest.approx(0.6, abs=0.002)
    assert moved.position[1] > 0.4


def test_wheels_without_rollers_are_reported():
    rubber = "<mu>1</mu><mu2>1</mu2>"
    sim, moved, _ = drive(world(mecanum(friction=rubber)), twist(0.0, 0.4), 1.0)
    found = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-090"]
    assert len(found) == 1
    assert "'fl', 'fr', 'bl', 'br'" in found[0].message
    assert np.linalg.norm(moved.position[:2]) < 0.05


def test_stamped_commands_work_and_nan_commands_are_ignored():
    sim = simkit.load(world(mecanum()))
    sim.publish("/model/robot/cmd_vel", {"twist": twist(0.0, 0.3)})
    sim.run(1.0)
    assert sim.model("robot").pose.position[1] > 0.2
    sim.publish("/model/robot/cmd_vel", twist(math.nan))
    sim.run(0.5)
    assert sim.model("robot").pose.position[1] > 0.35


def test_invalid_parameters_are_reported_together():
    settings = "<wheel_radius>-1</wheel_radius><max_velocity>-2</max_velocity>"
    settings += "<odom_publish_frequency>x</odom_publish_frequency>"
    broken = (
        mecanum(settings=settings).replace("<wheel_radius>0.1</wheel_radius>", "").replace("fl_joint<", "wheel_fl<", 1)
    )
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world(broken))
    text = str(caught.value)
    for part in ("<wheel_radius>", "<max_velocity>", "<odom_publish_frequency>", "'wheel_fl'", "fl_joint"):
        assert part in text


def test_a_spawned_robot_drives_and_a_removed_one_leaves_no_trace():
    sim = simkit.load(world())
    assert sim.engine.physics.shaper is None
    sim.spawn(f'<sdf version="1.9">{mecanum()}</sdf>', "robot")
    sim.publish("/model/robot/cmd_vel", twist(0.0, 0.3))
    sim.run(1.0)
    assert sim.model("robot").pose.position[1] == pytest.approx(0.29, abs=0.02)
    sim.remove("robot")
    sim.run(0.1)
    assert sim.engine.physics.shaper is None


def test_runs_after_a_reset_and_a_restore_have_the_same_bits():
    sim, _, _ = drive(world(mecanum(settings=LIMITS)), twist(0.3, 0.2, 0.4), 0.5)
    here, kept = sim.mj_data.qpos.tobytes(), sim.snapshot()
    sim.run(0.5)
    there = sim.mj_data.qpos.tobytes()
    sim.restore(kept)
    sim.run(0.5)
    assert sim.mj_data.qpos.tobytes() == there
    sim.reset()
    sim.run(0.2)
    sim.publish("/model/robot/cmd_vel", twist(0.3, 0.2, 0.4))
    sim.run(0.5)
    assert sim.mj_data.qpos.tobytes() == here


def test_on_a_moving_belt_the_directions_of_the_rollers_stay():
    """The belt carries the base, which drives sideways; the belt does not turn the rollers' direction."""
    belt = """<model name="conveyor"><static>true</static><pose>0 0 0.05 0 0 0</pose><link name="belt">
    <collision name="c"><geometry><box><size>40 4 0.1</size></box></geometry></collision></link>
    <plugin filename="gz-sim-track-controller-system" name="gz::sim::systems::TrackController">
    <link>belt</link></plugin></model>"""
    sim = simkit.load(world(belt, mecanum(pose="0 0 0.2 0 0 0")))
    sim.publish("/model/conveyor/link/belt/track_cmd_vel", {"data": 0.3})
    sim.publish("/model/robot/cmd_vel", {"linear": {"y": 0.2}})
    sim.run(1.0)
    before = sim.model("robot").pose.position
    sim.run(1.0)
    went = sim.model("robot").pose.position - before
    assert went[:2] == pytest.approx((0.3, 0.2), abs=0.02)
