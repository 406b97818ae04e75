"""`libfetch_gazebo_plugin.so`: controllers that start with their goals and take joints from each other."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import simkit
from simkit.extend import GoalHandle
from simkit.msgs.goal_status import GoalStatus

_INERTIAL = "<inertial><mass>{m}</mass><inertia><ixx>{i}</ixx><iyy>{i}</iyy><izz>{i}</izz></inertia></inertial>"
_AXIS = "<axis><xyz>{axis}</xyz><limit><lower>{low}</lower><upper>{high}</upper><effort>500</effort></limit></axis>"


def _link(name: str, pose: str, mass: float = 0.5, shape: str = "") -> str:
    collision = f"<collision name='c'><geometry>{shape}</geometry></collision>" if shape else ""
    inertial = _INERTIAL.format(m=mass, i=0.01 * mass)
    return f"<link name='{name}'><pose>{pose} 0 0 0</pose>{inertial}{collision}</link>"


def _joint(name: str, kind: str, parent: str, child: str, axis: str, low: float = -2, high: float = 2) -> str:
    ends = f"<parent>{parent}</parent><child>{child}</child>"
    return f"<joint name='{name}' type='{kind}'>{ends}{_AXIS.format(axis=axis, low=low, high=high)}</joint>"


_SPHERE = "<sphere><radius>{}</radius></sphere>"
_ROBOT = "".join(
    (
        _link("base_link", "0 0 0.2", 20.0),
        _link("l_wheel", "0 0.18738 0.0605", 1.0, _SPHERE.format(0.0605)),
        _link("r_wheel", "0 -0.18738 0.0605", 1.0, _SPHERE.format(0.0605)),
        _link("front", "0.15 0 0.0605", 0.5, _SPHERE.format(0.0605)),
        _link("back", "-0.15 0 0.0605", 0.5, _SPHERE.format(0.0605)),
        _joint("l_wheel_joint", "revolute", "base_link", "l_wheel", "0 1 0", -1e16, 1e16),
        _joint("r_wheel_joint", "revolute", "base_link", "r_wheel", "0 1 0", -1e16, 1e16),
        "<joint name='front_joint' type='ball'><parent>base_link</parent><child>front</child></joint>",
        "<joint name='back_joint' type='ball'><parent>base_link</parent><child>back</child></joint>",
        _link("torso", "0 0 0.5"),
        _joint("torso_lift_joint", "prismatic", "base_link", "torso", "0 0 1", 0, 0.4),
        _link("bellows", "0 0 0.4", 0.1),
        _joint("bellows_joint", "prismatic", "base_link", "bellows", "0 0 1", 0, 0.4),
        _link("arm", "0.1 0 0.5"),
        _joint("shoulder_pan_joint", "revolute", "torso", "arm", "0 0 1"),
        _link("hand", "0.4 0 0.5"),
        _joint("wrist_flex_joint", "revolute", "arm", "hand", "0 1 0"),
        _link("l_finger", "0.5 0.02 0.5", 0.08, "<box><size>0.06 0.01 0.03</size></box>"),
        _link("r_finger", "0.5 -0.02 0.5", 0.08, "<box><size>0.06 0.01 0.03</size></box>"),
        _joint("l_gripper_finger_joint", "prismatic", "hand", "l_finger", "0 1 0", -0.015, 0.05),
        _joint("r_gripper_finger_joint", "prismatic", "hand", "r_finger", "0 -1 0", -0.015, 0.05),
        _link("head", "0.05 0 0.9"),
        _joint("head_pan_joint", "revolute", "torso", "head", "0 0 1"),
        _link("eyes", "0.05 0 1.0"),
        _joint("head_tilt_joint", "revolute", "head", "eyes", "0 1 0"),
    )
)
_WORLD = f"""<sdf version='1.9'><world name='w'><model name='ground'><static>true</static><link name='l'>
<collision name='c'><geometry><plane/></geometry></collision></link></model><model name='fetch'>{_ROBOT}
<plugin name='fetch_gazebo_plugin' filename='libfetch_gazebo_plugin.so'/></model>{{more}}</world></sdf>"""
_PARAMETERS = """arm_controller:
  follow_joint_trajectory:
    type: "robot_controllers/FollowJointTrajectoryController"
    joints: [shoulder_pan_joint, wrist_flex_joint]
  gravity_compensation: {type: "robot_controllers/GravityCompensation", root: torso, tip: hand, autostart: true}
arm_with_torso_controller:
  follow_joint_trajectory:
    type: "robot_controllers/FollowJointTrajectoryController"
    joints: [torso_lift_joint, shoulder_pan_joint, wrist_flex_joint]
torso_controller:
  follow_joint_trajectory:
    type: "robot_controllers/FollowJointTrajectoryController"
    joints: [torso_lift_joint]
head_controller:
  point_head: {type: "robot_controllers/PointHeadController"}
  follow_joint_trajectory:
    type: "robot_controllers/FollowJointTrajectoryController"
    joints: [head_pan_joint, head_tilt_joint]
base_controller:
  type: "robot_controllers/DiffDriveBaseController"
  autostart: true
gripper_controller:
  gripper_action: {type: "robot_controllers/ParallelGripperController", centering: {p: 1000.0, d: 0.0}}
bellows_controller:
  type: "robot_controllers/ScaledMimicController"
  mimic_joint: "torso_lift_joint"
  controlled_joint: "bellows_joint"
  mimic_scale: 0.5
  autostart: true
gazebo:
  default_controllers: [arm_controller/follow_joint_trajectory, arm_controller/gravity_compensation,
    arm_with_torso_controller/follow_joint_trajectory, base_controller, head_controller/follow_joint_trajectory,
    head_controller/point_head, torso_controller/follow_joint_trajectory, gripper_controller/gripper_action,
    bellows_controller]
  torso_lift_joint: {position: {p: 1000.0}, velocity: {p: 100000.0}}
"""
_GRIPPER = "gripper_controller/gripper_action"


def load(folder: Path, *, more: str = "", old: str = "", new: str = "") -> simkit.Simulation:
    """Load the robot with its parameter file, in which the text `old` is replaced by `new`."""
    file = folder / "default_controllers.yaml"
    file.write_text(_PARAMETERS.replace(old, new) if old else _PARAMETERS, encoding="utf-8")
    return simkit.load(_WORLD.format(more=more), params_files=[file])


def _trajectory(seconds: float, **goals: float) -> dict[str, object]:
    point = {"positions": list(goals.values()), "time_from_start": simkit.msgs.duration(round(seconds * 1e9))}
    return {"trajectory": {"joint_names": list(goals), "points": [point]}}


def _position(sim: simkit.Simulation, joint: str) -> float:
    return float(sim.joint(f"fetch::{joint}").position)


def _follow(sim: simkit.Simulation, group: str, seconds: float, **goals: float) -> GoalHandle:
    return sim.send_goal(f"/{group}_controller/follow_joint_trajectory", _trajectory(seconds, **goals))


def test_controllers_start_with_a_goal_and_take_the_joints_of_idle_controllers(tmp_path: Path) -> None:
    with load(tmp_path) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        first = _follow(sim, "torso", 1.0, torso_lift_joint=0.3)
        sim.run(0.5)
        assert _position(sim, "torso_lift_joint") == pytest.approx(0.15, abs=0.01)  # half of a cubic
        refused = _follow(sim, "arm_with_torso", 1.0, torso_lift_joint=0.1, shoulder_pan_joint=1, wrist_flex_joint=-1)
        sim.run(0.01)
        assert refused.status is GoalStatus.REJECTED  # the torso has a goal
        assert refused.reason == "Cannot execute, unable to start controller."
        assert not first.is_done
        sim.run(0.6)
        assert first.status is GoalStatus.SUCCEEDED
        assert _position(sim, "torso_lift_joint") == pytest.approx(0.3, abs=2e-3)
        assert _position(sim, "bellows_joint") == pytest.approx(0.15, abs=2e-3)
        second = _follow(sim, "arm_with_torso", 1.0, torso_lift_joint=0.1, shoulder_pan_joint=1, wrist_flex_joint=-1)
        sim.run(1.2)
        assert second.status is GoalStatus.SUCCEEDED
        arm = [_position(sim, name) for name in ("torso_lift_joint", "shoulder_pan_joint", "wrist_flex_joint")]
        assert arm == pytest.approx([0.1, 1.0, -1.0], abs=5e-3)
        third = _follow(sim, "arm", 0.5, shoulder_pan_joint=0, wrist_flex_joint=0)
        sim.run(0.7)
        assert third.status is GoalStatus.SUCCEEDED
        assert _position(sim, "torso_lift_joint") == pytest.approx(0.1, abs=5e-3)  # nobody drives it, it is held


def test_the_base_accelerates_brakes_after_its_timeout_and_reports_odometry(tmp_path: Path) -> None:
    with load(tmp_path) as sim:
        odometry = sim.subscribe("/odom")
        sim.run(0.2)
        start = sim.link("fetch::base_link").pose.position[0]
        for _ in range(20):
            sim.publish("/base_controller/command", {"linear": {"x": 0.5}})
            sim.run(0.1)
        sim.run(1.5)
        # the last command is 0.1 s old at the end of the loop and expires 0.15 s later: 0.5 · (2.15 − 0.25 + 0.25) m
        assert odometry.messages[-1].pose.pose.position.x == pytest.approx(1.075, abs=0.01)
        assert sim.link("fetch::base_link").pose.position[0] - start == pytest.approx(1.075, abs=0.03)
        assert odometry.messages[-1].twist.twist.linear.x == pytest.approx(0.0, abs=1e-3)


def test_cmd_vel_turns_the_base_and_the_acceleration_may_depend_on_the_speed(tmp_path: Path) -> None:
    table = (
        "max_acceleration_r: {interval: 0.5, accel: [2.0, 1.0], decel: [4.0]}\n  max_velocity_r: 1.0\n  timeout: 9\n"
    )
    with load(tmp_path, old='DiffDriveBaseController"\n', new=f'DiffDriveBaseController"\n  {table}') as sim:
        odometry = sim.subscribe("/odom")
        sim.publish("/cmd_vel", {"angular": {"z": 3.0}})
        sim.run(2.0)
        # 0.25 s to 0.5 rad/s, 0.5 s to 1 rad/s, then 1 rad/s
        turn = 0.25 * 0.25 + 0.5 * 0.75 + 1.25
        pose = odometry.messages[-1].pose.pose.orientation
        assert 2.0 * math.atan2(pose.z, pose.w) == pytest.approx(turn, abs=0.03)
        assert odometry.messages[-1].twist.twist.angular.z == pytest.approx(1.0, abs=0.02)


def test_the_gripper_closes_on_a_box_with_the_effort_of_the_goal(tmp_path: Path) -> None:
    box = """<model name='box'><pose>0.5 0 0.5 0 0 0</pose><link name='l'><gravity>false</gravity><inertial><mass>0.2
</mass></inertial><collision name='c'><geometry><box><size>0.03 0.04 0.03</size></box></geometry></collision></link>
</model>"""
    with load(tmp_path, more=box) as sim:
        sim.run(0.1)
        wide = sim.send_goal(f"/{_GRIPPER}", {"command": {"position": 0.1, "max_effort": 5.0}})
        sim.run(1.0)
        assert wide.status is GoalStatus.SUCCEEDED
        assert wide.result.reached_goal
        assert _position(sim, "l_gripper_finger_joint") == pytest.approx(0.05, abs=1e-3)
        closed = sim.send_goal(f"/{_GRIPPER}", {"command": {"position": 0.0, "max_effort": 3.0}})
        sim.run(3.5)
        assert closed.status is GoalStatus.SUCCEEDED
        assert closed.result.stalled
        # the inner sides of the fingers are 0.03 m apart at 0, and the box is 0.04 m wide
        assert closed.result.position == pytest.approx(0.01, abs=1e-3)
        assert closed.result.effort == pytest.approx(6.0, abs=1e-6)  # 3 N at each finger


def test_the_head_points_at_a_target_and_joint_states_come_at_100_hz(tmp_path: Path) -> None:
    with load(tmp_path) as sim:
        states = sim.subscribe("/joint_states")
        target = {"header": {"frame_id": "world"}, "point": {"x": 2.05, "y": 2.0, "z": 1.0}}
        goal = sim.send_goal("/head_controller/point_head", {"target": target})
        sim.run(3.0)
        assert goal.status is GoalStatus.SUCCEEDED
        assert _position(sim, "head_pan_joint") == pytest.approx(0.7854, abs=0.03)
        assert len(states.messages) == pytest.approx(300, abs=2)
        assert "torso_lift_joint" in states.messages[-1].name


def test_a_restored_snapshot_repeats_the_change_of_controllers(tmp_path: Path) -> None:
    with load(tmp_path) as sim:
        _follow(sim, "torso", 0.2, torso_lift_joint=0.1)
        sim.run(0.3)
        start = sim.snapshot()
        ends = []
        for _ in range(2):
            sim.restore(start)
            _follow(sim, "arm_with_torso", 0.2, torso_lift_joint=0, shoulder_pan_joint=1, wrist_flex_joint=1)
            sim.run(0.15)
            ends.append(sim.mj_data.qpos.tobytes())
        assert ends[0] == ends[1]


def test_a_listed_controller_without_a_type_is_reported(tmp_path: Path) -> None:
    listed = "default_controllers: [arm_controller/"
    with load(tmp_path, old=listed, new=f"{listed}follow_joints, arm_controller/") as sim:
        assert [
            d for d in sim.diagnostics if d.code == "SK-CONTROL-013" and "arm_controller/follow_joints" in d.message
        ]
