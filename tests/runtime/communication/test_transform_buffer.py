"""`sim.tf`: poses between frames of a running simulation."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest

import simkit
from simkit import msgs
from simkit.errors import InputError, TransformError
from simkit.runtime.engine.snapshot import state_hash

TYPE = "tf2_msgs/msg/TFMessage"
TWIST = {"linear": {"x": 0.2}, "angular": {"z": 0.5}}


@pytest.fixture
def sim() -> Iterator[simkit.Simulation]:
    with simkit.load("turtlebot3_empty", seed=3) as sim:
        sim.publish("/cmd_vel", TWIST)
        yield sim


def test_the_present_pose_is_known_at_the_first_use(sim: simkit.Simulation) -> None:
    sim.run(1.0)
    found = sim.tf.lookup("odom", "base_footprint")
    odometry = sim.subscribe("/odom")
    assert sim.tf.lookup("base_link", "base_scan").position == pytest.approx([-0.064, 0.0, 0.121])
    sim.run(0.04)
    moved = msgs.pose(odometry.latest).position - found.position
    assert float(moved @ moved) ** 0.5 == pytest.approx(0.2 / 30, rel=0.02)  # a period of the odometry later


def test_poses_at_the_stamps_of_messages_are_exact(sim: simkit.Simulation) -> None:
    odometry = sim.subscribe("/odom")
    sim.tf.frames()
    sim.run(2.0)
    for message in odometry.messages:
        assert sim.tf.lookup("odom", "base_footprint", message.header.stamp) == msgs.pose(message)
    assert sim.tf.lookup("odom", "base_footprint") == msgs.pose(odometry.latest)
    earlier, later = (sim.tf.lookup("odom", "base_footprint", t).position[0] for t in (1.02, 1.03))
    assert later - earlier == pytest.approx(0.2 * 0.01 * math.cos(0.5), rel=0.05)


def test_frames_have_their_parents(sim: simkit.Simulation) -> None:
    frames = sim.tf.frames()
    assert frames["odom"] == "" and frames["base_footprint"] == "odom" and frames["base_scan"] == "base_link"


def test_times_before_the_first_use_are_unknown(sim: simkit.Simulation) -> None:
    sim.run(1.0)
    sim.tf.frames()
    sim.run(0.5)
    with pytest.raises(TransformError, match="are received since t=1 s; use `tf` before the time of interest"):
        sim.tf.lookup("odom", "base_scan", 0.5)


def test_nobody_publishes_transforms_before_the_first_use(sim: simkit.Simulation) -> None:
    sim.run(0.1)
    assert not sim.communication.bus.wanted("/tf")
    sim.tf.frames()
    assert sim.communication.bus.wanted("/tf")


def test_transforms_of_scripts_connect_frames(sim: simkit.Simulation) -> None:
    with pytest.raises(TransformError, match="unknown frame 'map'"):
        sim.tf.lookup("map", "base_scan")
    fixed = sim.advertise("/tf_static", TYPE, latched=True)
    fixed.publish({"transforms": [{"header": {"frame_id": "map"}, "child_frame_id": "odom",
                                   "transform": {"translation": {"x": 3.0}}}]})  # fmt: skip
    header, kind = msgs.header(sim.time_ns, "base_scan"), "geometry_msgs/msg/TransformStamped"
    tag = msgs.pose_message(simkit.Pose((0, 0, 1)), kind, header, "tag")
    sim.publish("/tf", msgs.make(TYPE, transforms=[tag]))
    found = sim.tf.lookup("map", "tag")
    assert found.position == pytest.approx([3.0 - 0.064, 0.0, 1.131], abs=1e-3)


def test_latched_transforms_of_an_earlier_time_are_known(sim: simkit.Simulation) -> None:
    fixed = sim.advertise("/tf_static", TYPE, latched=True)
    fixed.publish({"transforms": [{"header": {"frame_id": "map"}, "child_frame_id": "odom"}]})
    sim.run(0.5)
    assert sim.tf.frames()["odom"] == "map"


def test_lookups_change_no_bit() -> None:
    found = []
    for looks in (False, True):
        with simkit.load("turtlebot3_world", seed=1) as sim:
            scans, odometry = sim.subscribe("/scan"), sim.subscribe("/odom")
            sim.publish("/cmd_vel", TWIST)
            for _ in range(10):
                sim.run(0.1)
                if looks:
                    sim.tf.lookup("odom", "base_scan")
            found.append((state_hash(sim), [msgs.serialize(m) for m in (*scans.messages, *odometry.messages)]))
    assert found[0] == found[1]


def test_a_restored_run_has_the_history_of_the_snapshot(sim: simkit.Simulation) -> None:
    sim.tf.frames()
    sim.run(1.0)
    snapshot = sim.snapshot()
    sim.run(1.0)
    expected = [sim.tf.lookup("odom", "base_scan", t) for t in (0.5, 1.5)]
    sim.restore(snapshot)
    with pytest.raises(TransformError, match="known from t=0 s to t=1 s"):
        sim.tf.lookup("odom", "base_scan", 1.5)
    sim.run(1.0)
    assert [sim.tf.lookup("odom", "base_scan", t) for t in (0.5, 1.5)] == expected


def test_a_reset_forgets_the_transforms_of_the_run_before(sim: simkit.Simulation) -> None:
    sim.run(1.0)
    assert sim.tf.lookup("odom", "base_scan").position[0] > 0.0
    sim.reset()
    assert sim.tf.lookup("odom", "base_scan").position[0] == pytest.approx(-0.064)
    sim.run(0.5)
    assert sim.tf.lookup("odom", "base_scan", 0.2).position[0] == pytest.approx(-0.064, abs=1e-4)


def test_moving_joints_are_known_from_the_robot_state_publisher() -> None:
    world = """<sdf version="1.9"><world name="hall"><gravity>0 0 0</gravity><model name="rover">
      <link name="base"/><link name="arm"><pose>1 0 0 0 0 0</pose></link>
      <joint name="shoulder" type="revolute"><parent>base</parent><child>arm</child>
        <pose relative_to="base"/><axis><xyz>0 0 1</xyz></axis></joint>
      <plugin filename="libsimkit_robot_state_publisher.so" name="rsp"/></model></world></sdf>"""
    with simkit.load(world) as sim:
        sim.joint("rover::shoulder").set_velocity(1.0)
        sim.run(0.525)
        assert sim.tf.lookup("base", "arm").rpy[2] == pytest.approx(
            sim.link("rover::arm").pose.rpy[2] - sim.link("rover::base").pose.rpy[2], abs=1e-9
        )


def test_a_closed_simulation_has_no_transforms() -> None:
    with simkit.load("turtlebot3_empty") as sim:
        pass
    with pytest.raises(InputError, match="the simulation is closed"):
        _ = sim.tf
