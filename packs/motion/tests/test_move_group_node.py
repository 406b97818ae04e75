"""MoveIt's node `move_group` without MoveIt: groups, limits and names come from its parameters."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from arm_descriptions import SRDF, URDF
from planar_arm import CONTROLLERS, model, world

import simkit

pytest.importorskip("pinocchio")
pytest.importorskip("coal")

LIMITS = {"shoulder": {"has_velocity_limits": True, "max_velocity": 0.5, "has_acceleration_limits": False}}
PARAMETERS: dict[str, Any] = {
    "robot_description": URDF,
    "robot_description_semantic": SRDF,
    "robot_description_planning": {"joint_limits": LIMITS},
    "robot_description_kinematics": {"manipulator": {"kinematics_solver": "kdl_kinematics_plugin/KDLKinematicsPlugin"}},
    "planning_pipelines": ["ompl"],
    "ompl": {"planning_plugin": "ompl_interface/OMPLPlanner"},
    "moveit_simple_controller_manager": {
        "controller_names": ["arm_controller", "gripper"],
        "arm_controller": {"type": "FollowJointTrajectory", "action_ns": "follow_joint_trajectory"},
        "gripper": {"type": "GripperCommand", "action_ns": "gripper_cmd"},
    },
    "sensors_3d": {"kinect": {"max_range": 5.0}},
}
GOAL = {"joint_constraints": [{"joint_name": "shoulder", "position": 0.8}, {"joint_name": "elbow", "position": -0.4}]}


@pytest.fixture
def sim(tmp_path: Path) -> Iterator[simkit.Simulation]:
    """World with the planar arm and its controllers."""
    (tmp_path / "controllers.yaml").write_text(CONTROLLERS, "utf-8")
    (tmp_path / "lab.sdf").write_text(world(model()), "utf-8")
    with simkit.load(tmp_path / "lab.sdf", seed=3) as loaded:
        yield loaded


def messages(sim: simkit.Simulation, code: str) -> list[str]:
    return [item.message for item in sim.diagnostics if item.code == code]


def test_a_group_of_the_semantic_description_moves_within_the_limits_of_the_parameters(sim: simkit.Simulation) -> None:
    sim.add_node("moveit_ros_move_group/move_group", params=PARAMETERS)
    sim.run(0.5)
    goal = sim.send_goal("/move_action", {"request": {"group_name": "manipulator", "goal_constraints": [GOAL]}})
    sim.run_until(lambda _: goal.is_done, timeout=20.0)
    assert goal.status.name == "SUCCEEDED", goal.reason
    assert sim.joint("arm::shoulder").position == pytest.approx(0.8, abs=2e-3)
    points = goal.result.planned_trajectory.joint_trajectory.points
    assert max(point.velocities[0] for point in points) == pytest.approx(0.5, rel=0.02)
    sim.check_nodes()


def test_what_differs_from_moveit_is_told_once(sim: simkit.Simulation) -> None:
    sim.add_node("moveit_ros_move_group/move_group", params=PARAMETERS)
    sim.run(0.5)
    assert messages(sim, "SK-PLAN-002") == [
        "/move_group: RRT-Connect of simkit replaces the planners of ompl",
        "/move_group: damped least squares replaces kdl_kinematics_plugin/KDLKinematicsPlugin",
        "/move_group: plans are not executed by gripper, whose type is not FollowJointTrajectory",
    ]
    assert messages(sim, "SK-PLAN-003") == ["/move_group: no effect here: sensors_3d"]


def test_links_with_disabled_collisions_are_in_the_matrix_of_the_scene(sim: simkit.Simulation) -> None:
    sim.add_node("moveit_ros_move_group/move_group", params=PARAMETERS)
    sim.run(0.5)
    scene = sim.call("/get_planning_scene", {}).scene
    matrix = scene.allowed_collision_matrix
    names = list(matrix.entry_names)
    on = [
        (a, b)
        for a, row in zip(names, matrix.entry_values, strict=True)
        for b, v in zip(names, row.enabled, strict=True)
        if v
    ]
    assert sorted(on) == [("foot", "lower"), ("lower", "foot")]
    state = dict(zip(scene.robot_state.joint_state.name, scene.robot_state.joint_state.position, strict=True))
    assert state["elbow"] == pytest.approx(sim.joint("arm::elbow").position)


def test_the_node_waits_for_the_robot_and_for_descriptions_on_topics(tmp_path: Path) -> None:
    (tmp_path / "controllers.yaml").write_text(CONTROLLERS, "utf-8")
    (tmp_path / "arm.sdf").write_text(f'<sdf version="1.9">{model()}</sdf>', "utf-8")
    (tmp_path / "talker.py").write_text(
        f"""
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("talker")
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
for name, text in (("robot_description", {URDF!r}), ("robot_description_semantic", {SRDF!r})):
    node.create_publisher(String, name, latched).publish(String(data=text))
rclpy.spin(node)
"""
    )
    with simkit.load("empty") as sim:
        sim.add_node("moveit_ros_move_group/move_group")
        sim.run(10.5)
        assert "no robot_description and robot_description_semantic came" in messages(sim, "SK-PLAN-004")[0]
        sim.add_node(tmp_path / "talker.py")
        sim.run(0.5)
        sim.spawn(tmp_path / "arm.sdf")
        sim.run(0.5)
        asked = {"fk_link_names": ["hand"]}
        assert sim.call("/compute_fk", asked).error_code.val == 1
        sim.check_nodes()


def test_two_robots_have_the_groups_and_services_of_their_namespaces(tmp_path: Path) -> None:
    (tmp_path / "controllers.yaml").write_text(CONTROLLERS, "utf-8")
    models = model("left") + model("right", place="0 2 0 0 0 0")
    (tmp_path / "lab.sdf").write_text(world(models), "utf-8")
    with simkit.load(tmp_path / "lab.sdf") as sim:
        for name in ("left", "right"):
            sim.add_node("moveit_ros_move_group/move_group", namespace=name, params=PARAMETERS)
        sim.run(0.5)
        for name, y in (("left", 0.0), ("right", 2.0)):
            found = sim.call(f"/{name}/compute_fk", {"fk_link_names": ["hand"], "header": {"frame_id": "world"}})
            assert found.pose_stamped[0].pose.position.y == pytest.approx(y, abs=1e-3)


def test_parameters_of_ros_1_name_the_action_move_group(sim: simkit.Simulation) -> None:
    sim.set_ros_parameters({"/robot_description": URDF, "/robot_description_semantic": SRDF})
    sim.add_node("moveit_ros_move_group/move_group")
    sim.run(0.5)
    goal = sim.send_goal("/move_group", {"request": {"group_name": "manipulator", "goal_constraints": [GOAL]}})
    sim.run_until(lambda _: goal.is_done, timeout=20.0)
    assert goal.status.name == "SUCCEEDED", goal.reason


def test_a_semantic_description_that_is_not_valid_ends_the_node(sim: simkit.Simulation) -> None:
    node = sim.add_node(
        "moveit_ros_move_group/move_group", params={**PARAMETERS, "robot_description_semantic": "<group/>"}
    )
    sim.run(0.2)
    assert any("has the root element <group>; expected <robot>" in line for line in node.log)
