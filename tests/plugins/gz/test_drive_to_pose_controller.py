"""Pose controller of Gazebo for drives."""

from __future__ import annotations

import math
from typing import Any

import pytest
from plugin_worlds import GROUND, element, gz_drive, rover, world

import simkit

CMD, REACHED, SPEED = ("/model/rover/" + name for name in ("cmd_pose", "reached_pose", "cmd_vel"))
ODOMETRY = '<plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher"/>'


def controller(**values: Any) -> str:
    name = "name='gz::sim::systems::DriveToPoseController' filename='gz-sim-drive-to-pose-controller-system'"
    return element("plugin", values, name)


def load(*, drive: str = "", odometry: str = ODOMETRY, pose: str = "0 0 0 0 0 0", **values: Any) -> simkit.Simulation:
    return simkit.load(world(GROUND, rover((drive or gz_drive()) + odometry + controller(**values), pose=pose)))


def target(x: float, y: float, yaw: float) -> Any:
    turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
    pose = {"position": {"x": x, "y": y}, "orientation": turn}
    return simkit.msgs.make("geometry_msgs/msg/PoseArray", poses=[pose])


def test_it_turns_drives_turns_and_publishes_the_reached_pose() -> None:
    sim = load()
    reached, speeds = sim.subscribe(REACHED), sim.subscribe(SPEED, keep=20000)
    sim.run(0.1)
    assert not speeds.messages
    sim.publish(CMD, target(1.0, 1.0, 3.0))
    assert sim.run_until(lambda s: bool(reached.messages), 20.0)
    x, y, _ = sim.model("rover").pose.position.tolist()
    assert math.hypot(1 - x, 1 - y) < 0.1 + 0.02  # the pose is published at 50 Hz
    assert sim.model("rover").pose.rpy[2] == pytest.approx(3.0, abs=0.05 + 0.01)
    pose = reached.messages[0]
    assert (pose.position.x, pose.position.y) == pytest.approx((x, y), abs=0.01)
    # only one speed at a time, by the gains: 2 rad/s per radian and 1 m/s per metre
    first = speeds.messages[0]
    assert (first.linear.x, first.angular.z) == pytest.approx((0, 2 * math.pi / 4), abs=1e-3)
    assert not any(m.linear.x and m.angular.z for m in speeds.messages)
    assert max(m.linear.x for m in speeds.messages) == pytest.approx(math.sqrt(2), abs=0.01)
    last = speeds.messages[-1]
    assert (last.linear.x, last.angular.z) == (0, 0)
    count = len(speeds.messages)
    sim.run(0.5)
    assert len(speeds.messages) == count  # nothing is sent at the pose


def test_the_gains_and_tolerances_are_those_of_the_file_and_can_be_changed() -> None:
    sim = load(linear_p_gain=0.5, angular_p_gain=1, linear_deviation=0.3, angular_deviation=0.2)
    speeds = sim.subscribe(SPEED, keep=20000)
    sim.run(0.1)
    sim.publish(CMD, target(2.0, 0.0, 0.1))
    sim.run(0.05)
    assert speeds.messages[0].linear.x == pytest.approx(1.0, abs=1e-3)
    reached = sim.subscribe(REACHED)
    assert sim.run_until(lambda s: bool(reached.messages), 20.0)
    # the yaw is within the tolerance already, and the robot stops 0.3 m before the target
    assert reached.messages[0].position.x == pytest.approx(1.7, abs=0.02)


def test_a_heading_beyond_half_a_turn_is_reached_in_the_shorter_direction() -> None:
    sim = load(pose="0 0 0 0 0 3.0")
    speeds = sim.subscribe(SPEED, keep=20000)
    sim.run(0.1)
    sim.publish(CMD, target(0.0, 0.0, -3.0))
    sim.run(0.1)
    assert speeds.messages[0].angular.z == pytest.approx(2 * (2 * math.pi - 6), abs=0.01)


def test_other_pose_messages_are_accepted_and_empty_ones_ignored() -> None:
    for message in (
        simkit.msgs.make("geometry_msgs/msg/PoseStamped", pose={"position": {"x": 1.0}}),
        simkit.msgs.make("geometry_msgs/msg/Pose", position={"x": 1.0}),
        simkit.msgs.make("tf2_msgs/msg/TFMessage", transforms=[{"transform": {"translation": {"x": 1.0}}}]),
    ):
        sim = load()
        sim.run(0.1)
        sim.publish(CMD, message)
        sim.run(1.0)
        assert sim.model("rover").pose.position[0] > 0.3
    sim = load()
    sim.publish(CMD, simkit.msgs.make("geometry_msgs/msg/PoseArray"))
    sim.publish(CMD, simkit.msgs.make("geometry_msgs/msg/Pose", position={"x": math.nan}))
    sim.run(0.1)
    assert [d.code for d in sim.diagnostics].count("SK-PLUGIN-041") == 2


def test_missing_publishers_and_subscribers_are_reported_once() -> None:
    sim = load(drive=" ", odometry="")
    for _ in range(2):
        sim.publish(CMD, target(1, 0, 0))
        sim.run(0.05)
    warnings = [d.message for d in sim.diagnostics if d.code == "SK-PLUGIN-132"]
    assert len(warnings) == 2
    assert "/model/rover/pose" in warnings[0]
    assert "/model/rover/cmd_vel" in warnings[1]


@pytest.mark.slow
def test_reset_and_restore_include_the_target() -> None:
    sim = load()
    sim.run(0.1)
    sim.publish(CMD, target(1.0, 0.5, 0.0))
    sim.run(1.0)
    kept = sim.snapshot()
    sim.run(2.0)
    place = sim.model("rover").pose.position.tolist()
    sim.restore(kept)
    sim.run(2.0)
    assert sim.model("rover").pose.position.tolist() == place
    sim.reset()
    sim.run(0.5)
    assert sim.model("rover").pose.position[0] == pytest.approx(0, abs=1e-3)
