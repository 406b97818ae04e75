"""An arm of two joints with weight, under the whole of ros2_control: files, manager, controller, hardware, physics."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from perfect_joints import trajectory

import simkit
from simkit.msgs.goal_status import GoalStatus

FOLLOW = "/arm_controller/follow_joint_trajectory"
JOINTS = ["shoulder", "elbow"]
YAML = """
controller_manager:
  ros__parameters:
    update_rate: 100
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
    hand_controller: {type: position_controllers/GripperActionController}
arm_controller:
  ros__parameters:
    joints: [shoulder, elbow]
    state_publish_rate: 50.0
    command_interfaces: [position]
    state_interfaces: [position, velocity]
    constraints:
      goal_time: 0.6
      shoulder: {goal: 0.02}
      elbow: {goal: 0.02}
hand_controller:
  ros__parameters: {joint: finger, goal_tolerance: 0.001, stall_timeout: 0.2}
"""
INERTIA = "<mass>2</mass><inertia><ixx>.03</ixx><iyy>.03</iyy><izz>.01</izz></inertia>"
MASS = f"<inertial><pose>0 0 0.2 0 0 0</pose>{INERTIA}</inertial>"


def _joint(name: str, kind: str, parent: str, child: str, axis: str, limits: tuple[float, ...]) -> str:
    low, high, effort, velocity = limits
    limit = f"<lower>{low}</lower><upper>{high}</upper><effort>{effort}</effort><velocity>{velocity}</velocity>"
    turns = f"<axis><xyz>{axis}</xyz><limit>{limit}</limit></axis>"
    return f"<joint name='{name}' type='{kind}'><parent>{parent}</parent><child>{child}</child>{turns}</joint>"


WALL = """<model name='wall'><static>true</static><pose>0.052 0 1.0 0 0 0</pose><link name='l'><collision name='c'>
<geometry><box><size>0.02 0.2 0.4</size></box></geometry></collision></link></model>"""
TIP = """<link name='tip'><pose>0 0 1.0 0 0 0</pose><inertial><mass>0.1</mass></inertial><collision name='c'>
<geometry><box><size>0.02 0.02 0.02</size></box></geometry></collision></link>"""
WORLD = f"""<sdf version='1.9'><world name='lab'>
<physics type='ode'><max_step_size>STEP</max_step_size></physics>WALL
<model name='arm'>
  <joint name='fixed' type='fixed'><parent>world</parent><child>base</child></joint>
  <link name='base'>{MASS}</link>
  <link name='upper'><pose>0 0 0.2 0 0 0</pose>{MASS}</link><link name='lower'><pose>0 0 0.6 0 0 0</pose>{MASS}</link>
  {TIP}
  {_joint("shoulder", "revolute", "base", "upper", "0 1 0", (-1.5, 1.5, 60, 2))}
  {_joint("elbow", "revolute", "upper", "lower", "0 1 0", (-2, 2, 30, 2))}
  {_joint("finger", "prismatic", "lower", "tip", "1 0 0", (0, 0.05, 10, 0.1))}
  <plugin filename='libgz_ros2_control-system.so' name='gz_ros2_control::GazeboSimROS2ControlPlugin'>
    <parameters>arm.yaml</parameters></plugin>
</model></world></sdf>"""


def arm(folder: Path, step: float = 0.001, wall: str = "") -> Any:
    (folder / "arm.yaml").write_text(YAML)
    (folder / "arm.sdf").write_text(WORLD.replace("STEP", str(step)).replace("WALL", wall))
    return simkit.load(folder / "arm.sdf")


def positions(sim: Any) -> list[float]:
    return [sim.joint(f"arm::{name}").position for name in JOINTS]


@pytest.mark.parametrize("step", [0.001, 0.002, 0.004])
def test_the_arm_follows_the_trajectory_against_gravity(tmp_path: Path, step: float) -> None:
    sim = arm(tmp_path, step)
    worst: list[float] = []
    goal = sim.send_goal(
        FOLLOW,
        {"trajectory": trajectory(JOINTS, (2.0, [0.8, -1.0], [0.3, 0.0]), (4.0, [1.2, 1.0], [0.0, 0.0]))},
        lambda state: worst.append(float(np.abs(state.error.positions).max())),
    )
    sim.run(4.1)
    assert goal.status is GoalStatus.SUCCEEDED
    assert max(worst) < 0.005
    sim.run(1.0)
    assert positions(sim) == pytest.approx([1.2, 1.0], abs=1e-3)


def test_a_cancelled_goal_leaves_the_arm_where_it_is(tmp_path: Path) -> None:
    sim = arm(tmp_path)
    goal = sim.send_goal(FOLLOW, {"trajectory": trajectory(JOINTS, (2.0, [1.0, -1.0], [0.0, 0.0]))})
    sim.run(1.0)
    at = positions(sim)
    goal.cancel()
    sim.run(3.0)
    assert goal.status is GoalStatus.CANCELED
    assert positions(sim) == pytest.approx(at, abs=0.03)
    held = positions(sim)
    sim.run(1.0)
    assert positions(sim) == pytest.approx(held, abs=1e-4)


def test_a_goal_outside_the_limits_stops_at_the_limits(tmp_path: Path) -> None:
    sim = arm(tmp_path)
    goal = sim.send_goal(FOLLOW, {"trajectory": trajectory(JOINTS, (2.0, [1.7, 0.0], [0.0, 0.0]))})
    sim.run(3.0)
    assert (goal.status, goal.result.error_code) == (GoalStatus.ABORTED, -5)
    assert positions(sim)[0] == pytest.approx(1.5, abs=0.01)
    assert "SK-CONTROL-021" in [d.code for d in sim.diagnostics]


def test_a_gripper_on_an_object_stalls_and_keeps_pressing(tmp_path: Path) -> None:
    sim = arm(tmp_path, wall=WALL)
    goal = sim.send_goal("/hand_controller/gripper_cmd", {"command": {"position": 0.05, "max_effort": 5.0}})
    sim.run(2.0)
    assert (goal.status, goal.result.stalled) == (GoalStatus.ABORTED, True)
    at = sim.joint("arm::finger").position
    assert at == pytest.approx(0.032, abs=3e-3)  # the arm gives way to its own 10 N
    assert sim.joint("arm::finger").effort > 1.0


def test_the_same_run_twice_and_after_a_restore_gives_the_same_bits(tmp_path: Path) -> None:
    ends = []
    for _ in range(2):
        sim = arm(tmp_path)
        sim.send_goal(FOLLOW, {"trajectory": trajectory(JOINTS, (1.0, [1.0, -1.0], [0.0, 0.0]))})
        sim.run(0.5)
        saved = sim.snapshot()
        sim.run(1.0)
        ends.append(positions(sim))
        sim.restore(saved)
        sim.run(1.0)
        ends.append(positions(sim))
    assert ends[1:] == ends[:1] * 3


def test_the_times_of_state_messages_do_not_depend_on_when_someone_subscribes(tmp_path: Path) -> None:
    stamps = []
    for wait in (0.0, 0.515):
        sim = arm(tmp_path)
        sim.step(round(wait / sim.timestep))
        states = sim.subscribe("/arm_controller/controller_state")
        sim.step(1000 - sim.tick)
        stamps.append([m.header.stamp.nanosec for m in states.messages if m.header.stamp.nanosec > 540_000_000])
    assert stamps[0] == stamps[1] and len(stamps[0]) > 20
