"""TIAGo as example-robot-data publishes it, driven by controllers in ROS 1's spelling that its file does not name."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest

import simkit


def published(name: str) -> Path | None:
    """One of its files; None where the package is not installed."""
    try:
        files = metadata.files("example-robot-data") or []
    except metadata.PackageNotFoundError:
        return None
    return next((Path(str(f.locate())) for f in files if f.name == name), None)


ROBOT = published("tiago_no_hand.urdf")
pytestmark = pytest.mark.skipif(ROBOT is None, reason="example-robot-data is not installed")

ARM = [f"arm_{i}_joint" for i in range(1, 8)]
HOME = [0.2, -1.34, -0.2, 1.94, -1.57, 1.37, 0.0]
CONTROLLERS = """
joint_state_controller: {type: joint_state_controller/JointStateController, publish_rate: 50}
arm_controller:
  type: position_controllers/JointTrajectoryController
  joints: [arm_1_joint, arm_2_joint, arm_3_joint, arm_4_joint, arm_5_joint, arm_6_joint, arm_7_joint]
  constraints: {goal_time: 0.6, stopped_velocity_tolerance: 5.0}
torso_controller: {type: position_controllers/JointTrajectoryController, joints: [torso_lift_joint]}
head_controller: {type: position_controllers/JointTrajectoryController, joints: [head_1_joint, head_2_joint]}
"""
BASE = """
mobile_base_controller:
  type: diff_drive_controller/DiffDriveController
  left_wheel: wheel_left_joint
  right_wheel: wheel_right_joint
  wheel_separation: 0.4044
  wheel_radius: 0.0985
  publish_rate: 50.0
  cmd_vel_timeout: 0.25
  linear: {x: {has_velocity_limits: true, max_velocity: 1.0, min_velocity: -0.2,
               has_acceleration_limits: true, max_acceleration: 1.0}}
  angular: {z: {has_velocity_limits: true, max_velocity: 2.09, has_acceleration_limits: true, max_acceleration: 2.09}}
"""
LOOPS = """
gazebo_ros_control:
  pid_gains:
    torso_lift_joint: {p: 90000.0, i: 0.02, d: 25.0, i_clamp: 1.5}
    head_1_joint: {p: 100.0, i: 10.0, d: 0.0, i_clamp: 1.5}
    head_2_joint: {p: 100.0, i: 10.0, d: 0.0, i_clamp: 1.5}
    arm_1_joint: {p: 400.0, i: 0.0, d: 0.5, i_clamp: 3.0}
    arm_2_joint: {p: 750.0, i: 0.5, d: 5.0, i_clamp: 3.0}
    arm_3_joint: {p: 400.0, i: 0.1, d: 0.5, i_clamp: 3.0}
    arm_4_joint: {p: 400.0, i: 0.1, d: 1.0, i_clamp: 3.0}
    arm_5_joint: {p: 100.0, i: 0.01, d: 0.1, i_clamp: 3.0}
    arm_6_joint: {p: 100.0, i: 0.01, d: 0.1, i_clamp: 3.0}
    arm_7_joint: {p: 50.0, i: 0.01, d: 0.1, i_clamp: 3.0}
    wheel_left_joint: {p: 30.0, i: 0.0, d: 0.0, i_clamp: 1.0}
    wheel_right_joint: {p: 30.0, i: 0.0, d: 0.0, i_clamp: 1.0}
"""


@pytest.fixture(scope="module")
def sim(tmp_path_factory: pytest.TempPathFactory) -> Iterator[simkit.Simulation]:
    """The robot without a hand on level ground, its three files beside it as a launch file would load them."""
    folder: Path = tmp_path_factory.mktemp("tiago_controller_configuration")
    files = []
    for name, text in (("controllers.yaml", CONTROLLERS), ("base.yaml", BASE), ("pids.yaml", LOOPS)):
        (folder / name).write_text(text, encoding="utf-8")
        files.append(folder / name)
    robot = f"{ROBOT}:0,0,0:tiago"
    with simkit.load("empty", spawn=[robot], params_files=files) as loaded:
        yield loaded


@pytest.fixture
def fresh(sim: simkit.Simulation) -> simkit.Simulation:
    sim.reset()
    return sim


def test_every_controller_runs_and_nothing_of_the_files_is_told(fresh: simkit.Simulation) -> None:
    found = {c.name: c.state for c in fresh.call("/controller_manager/list_controllers").controller}
    assert found == dict.fromkeys(
        ("joint_state_controller", "arm_controller", "torso_controller", "head_controller", "mobile_base_controller"),
        "running",
    )
    told = [d for d in fresh.diagnostics if (d.file or "").endswith(".yaml")]
    assert [d for d in told if d.severity != "note"] == []


def test_the_arm_follows_a_trajectory_within_what_its_loops_give_way(fresh: simkit.Simulation) -> None:
    """A loop without an integral is off by weight / p: up to some 10 N·m / 400 N·m/rad."""
    points = [{"positions": HOME, "time_from_start": {"sec": 4}}]
    goal = {"trajectory": {"joint_names": ARM, "points": points}}
    handle = fresh.send_goal("/arm_controller/follow_joint_trajectory", goal)
    joints = [fresh.joint(f"tiago::{name}") for name in ARM]
    start = np.array([float(j.position) for j in joints])
    fresh.run(2.0)
    middle = np.array([float(j.position) for j in joints])
    np.testing.assert_allclose(middle, (start + HOME) / 2, atol=0.05)
    fresh.run(4.0)
    assert handle.result.error_code == 0
    np.testing.assert_allclose([float(j.position) for j in joints], HOME, atol=0.03)


def test_torso_and_head_go_where_they_are_sent(fresh: simkit.Simulation) -> None:
    for name, joints, positions in (
        ("torso_controller", ["torso_lift_joint"], [0.2]),
        ("head_controller", ["head_1_joint", "head_2_joint"], [0.5, -0.3]),
    ):
        points = [{"positions": positions, "time_from_start": {"sec": 3}}]
        message = {"joint_names": joints, "points": points}
        fresh.publish(f"/{name}/command", simkit.msgs.make("trajectory_msgs/msg/JointTrajectory", **message))
    fresh.run(4.0)
    found = [float(fresh.joint(f"tiago::{j}").position) for j in ("torso_lift_joint", "head_1_joint", "head_2_joint")]
    assert found == pytest.approx([0.2, 0.5, -0.3], abs=0.02)


def test_the_base_drives(fresh: simkit.Simulation) -> None:
    base, odometry = fresh.model("tiago"), fresh.subscribe("/mobile_base_controller/odom")
    command = simkit.msgs.make("geometry_msgs/msg/Twist", linear={"x": 0.3})
    for _ in range(40):
        fresh.publish("/mobile_base_controller/cmd_vel", command)
        fresh.run(0.1)
    x, y, _ = base.pose.position
    assert x == pytest.approx(0.3 * 4.0, abs=0.1)  # 0.045 m of it are the start
    assert abs(y) < 0.01
    assert odometry.messages[-1].pose.pose.position.x == pytest.approx(x, rel=0.02)


HAND = """
hand_controller:
  type: position_controllers/JointTrajectoryController
  joints: [hand_thumb_joint, hand_index_joint, hand_mrl_joint]
"""
FINGERS = {
    "hand_thumb_abd_joint": 2.0 / 2.0,
    "hand_thumb_flex_2_joint": 2.0 / 3.5,
    "hand_index_abd_joint": 1.5 / 5.0,
    "hand_index_flex_1_joint": 1.5 / 2.5,
    "hand_ring_flex_1_joint": 0.7853981634,  # 3.0 / 2.5 is beyond its limit
    "hand_little_flex_3_joint": 3.0 / 4.0,
}


def test_three_motors_close_a_hand_of_five_fingers(tmp_path: Path) -> None:
    (tmp_path / "hand.yaml").write_text(HAND, encoding="utf-8")
    spawn = [f"{published('tiago.urdf')}:0,0,0:tiago"]
    with simkit.load("empty", spawn=spawn, params_files=["tiago=" + str(tmp_path / "hand.yaml")]) as sim:
        points = [{"positions": [2.0, 1.5, 3.0], "time_from_start": {"sec": 2}}]
        names = ["hand_thumb_joint", "hand_index_joint", "hand_mrl_joint"]
        goal = {"trajectory": {"joint_names": names, "points": points}}
        handle = sim.send_goal("/hand_controller/follow_joint_trajectory", goal)
        sim.run(3.0)
        assert handle.result.error_code == 0
        for name, wanted in FINGERS.items():
            found = float(sim.joint(f"tiago::{name}").position)
            assert found == pytest.approx(wanted, abs=0.02 / 2.0 + 0.005), name  # the motor counts from 0.02 rad on
