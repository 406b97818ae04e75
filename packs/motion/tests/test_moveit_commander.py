"""Programs of ROS 1 with `moveit_commander`: they plan and move the planar arm as with MoveIt."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest
from arm_descriptions import SRDF, URDF
from planar_arm import CONTROLLERS, model, world

import simkit

pytest.importorskip("pinocchio")
pytest.importorskip("coal")

Run = Callable[..., list[str]]
START = """
import sys, math, rospy, moveit_commander, geometry_msgs.msg
from moveit_commander.conversions import pose_to_list
moveit_commander.roscpp_initialize(sys.argv)
rospy.init_node("mover")
robot = moveit_commander.RobotCommander()
scene = moveit_commander.PlanningSceneInterface()
group = moveit_commander.MoveGroupCommander("manipulator")
group.set_max_velocity_scaling_factor(1.0)
group.set_max_acceleration_scaling_factor(1.0)
def show(*values):
    rospy.loginfo(" ".join(f"{value:.3f}" if isinstance(value, float) else str(value) for value in values))
"""


@pytest.fixture
def sim(tmp_path: Path) -> Iterator[simkit.Simulation]:
    """World with the planar arm and `move_group`."""
    (tmp_path / "controllers.yaml").write_text(CONTROLLERS, "utf-8")
    (tmp_path / "lab.sdf").write_text(world(model()), "utf-8")
    with simkit.load(tmp_path / "lab.sdf", seed=3) as loaded:
        loaded.set_ros_parameters({"/robot_description": URDF, "/robot_description_semantic": SRDF})
        loaded.add_node("moveit_ros_move_group/move_group")
        yield loaded


@pytest.fixture
def run(sim: simkit.Simulation, tmp_path: Path) -> Run:
    """Function that runs a program until its end, and returns the texts that it logged."""

    def run_program(text: str, start: str = START, timeout: float = 60.0) -> list[str]:
        file = tmp_path / "mover.py"
        file.write_text(start + dedent(text))
        node = sim.add_node(file)
        sim.run_until(lambda _: node.done, timeout=timeout)
        sim.check_nodes()
        return [line.split("]: ", 1)[1] for line in node.log if "]: " in line]

    return run_program


def test_groups_joints_and_links_come_from_the_descriptions(run: Run) -> None:
    assert run(
        """
        show(robot.get_group_names(), robot.get_planning_frame(), robot.get_root_link())
        show(group.get_active_joints(), group.get_end_effector_link(), group.get_planning_frame())
        show(robot.get_joint_names("whole"), robot.get_link_names("fingers"))
        show(robot.get_joint("elbow").bounds(), robot.left_finger.max_bound(), robot.get_default_owner_group("wrist"))
        show(group.get_named_targets(), robot.has_group("legs"), robot.fingers.has_end_effector_link())
        """
    ) == [
        "['manipulator', 'fingers', 'whole'] world foot",
        "['shoulder', 'elbow', 'wrist'] hand world",
        "['shoulder', 'elbow', 'wrist', 'left_finger', 'right_finger'] ['left_finger_link', 'right_finger_link']",
        "[-2.8, 2.8] 0.040 manipulator",
        "['bent'] False False",
    ]


def test_a_joint_target_and_a_named_target_are_reached(run: Run, sim: simkit.Simulation) -> None:
    assert run(
        """
        show(group.go([0.4, -0.3, 0.2], wait=True))
        show(*(round(value, 2) for value in group.get_current_joint_values()))
        group.set_named_target("bent")
        success, trajectory, planning_time, error_code = group.plan()
        show(success, trajectory.joint_trajectory.joint_names, error_code.val)
        show(group.execute(trajectory, wait=True))
        """
    ) == ["True", "0.400 -0.300 0.200", "True ['shoulder', 'elbow', 'wrist'] 1", "True"]
    found = [float(sim.joint(f"arm::{name}").position) for name in ("shoulder", "elbow", "wrist")]
    assert found == pytest.approx([0.6, -0.8, 0.3], abs=2e-3)


def test_a_pose_target_is_reached_and_the_pose_is_that_of_the_simulation(run: Run, sim: simkit.Simulation) -> None:
    texts = run(
        """
        pose = geometry_msgs.msg.Pose()
        pose.position.x, pose.position.y, pose.position.z = 0.3, 0.4, 0.5
        pose.orientation.z, pose.orientation.w = math.sin(0.45), math.cos(0.45)
        group.set_pose_target(pose)
        show(group.go(wait=True))
        group.stop()
        group.clear_pose_targets()
        show(*pose_to_list(group.get_current_pose().pose)[:2], group.get_current_rpy()[2])
        """
    )
    assert texts == ["True", "0.300 0.400 0.900"]
    assert sim.link("arm::hand").pose.position == pytest.approx((0.3, 0.4, 0.5), abs=2e-3)


def test_position_and_orientation_targets_leave_the_rest_free(run: Run) -> None:
    assert run(
        """
        group.set_position_target([0.2, 0.45, 0.5])
        show(group.go())
        place = group.get_current_pose().pose.position
        show(place.x, place.y)
        group.set_rpy_target([0, 0, 1.2])
        show(group.go())
        show(abs(group.get_current_rpy()[2] - 1.2) < 0.005)
        """
    ) == ["True", "0.200 0.450", "True", "True"]


def test_a_straight_line_is_planned_and_executed(run: Run, sim: simkit.Simulation) -> None:
    assert run(
        """
        group.go([0.6, -1.2, 0.6])
        pose = group.get_current_pose().pose
        pose.position.y += 0.1
        path, fraction = group.compute_cartesian_path([pose], 0.01, 0.0)
        again, also = group.compute_cartesian_path([pose], 0.01, True)
        show(fraction, also, group.execute(path))
        """
    ) == ["1.000 1.000 True"]
    assert sim.link("arm::hand").pose.position[1] == pytest.approx(
        0.3 * (math.sin(0.6) + math.sin(-0.6)) + 0.1, abs=3e-3
    )


def test_an_object_of_the_scene_is_an_obstacle_until_it_is_removed(run: Run) -> None:
    assert run(
        """
        at = geometry_msgs.msg.PoseStamped()
        at.header.frame_id = "foot"
        at.pose.position.y, at.pose.position.z, at.pose.orientation.w = 0.75, 0.25, 1.0
        scene.add_box("crate", at, size=(0.2, 0.2, 0.2))
        show(scene.get_known_object_names(), scene.get_known_object_names_in_roi(-1, 0, 0, 1, 1, 1))
        show(group.plan([math.pi / 2, 0.0, 0.0])[3].val)
        scene.remove_world_object("crate")
        show(scene.get_known_object_names(), group.plan([math.pi / 2, 0.0, 0.0])[3].val)
        """
    ) == [
        "['crate'] ['crate']",
        "Fail: the goal is in collision: crate and hand touch or are too close",
        "-12",
        "[] 1",
    ]


def test_an_attached_object_follows_its_link_and_can_be_detached(run: Run) -> None:
    assert run(
        """
        at = geometry_msgs.msg.PoseStamped()
        at.header.frame_id, at.pose.position.x, at.pose.orientation.w = "hand", 0.5, 1.0
        scene.add_box("rod", at, size=(0.2, 0.02, 0.02))
        show(group.attach_object("rod", touch_links=["hand", "left_finger_link", "right_finger_link"]))
        show(list(scene.get_attached_objects(["rod"])), scene.get_known_object_names())
        scene.remove_attached_object("foot")
        show(list(scene.get_attached_objects()))
        scene.remove_attached_object("hand", name="rod")
        show(list(scene.get_attached_objects()), scene.get_known_object_names())
        """
    ) == ["True", "['rod'] []", "['rod']", "[] ['rod']"]


def test_the_matrix_of_allowed_collisions_can_be_changed(run: Run) -> None:
    assert run(
        """
        matrix = scene.get_planning_scene(128).allowed_collision_matrix
        matrix.set_allowed("crate", "hand", True)
        matrix.set_default("dust", True)
        change = scene.get_planning_scene(128)
        change.is_diff, change.allowed_collision_matrix = True, matrix
        show(scene.apply_planning_scene(change))
        matrix = scene.get_planning_scene(128).allowed_collision_matrix
        show("dust" in matrix.default_entry_names, matrix.entry_names[:2])
        """
    ) == ["True", "True ['foot', 'upper']"]


def test_mistakes_are_exceptions_with_a_reason(run: Run) -> None:
    assert run(
        """
        from moveit_commander import MoveItCommanderException
        def attempt(function, *values):
            try:
                function(*values)
            except (MoveItCommanderException, RuntimeError) as error:
                rospy.loginfo("%s", error)
        attempt(group.set_joint_value_target, [0.0, 5.0, 0.0])
        attempt(group.set_joint_value_target, [0.0])
        attempt(group.set_named_target, "bend")
        attempt(robot.get_group, "arm")
        attempt(moveit_commander.MoveGroupCommander, "arm")
        attempt(robot.fingers.set_pose_target, [0.0] * 6)
        show(group.pick("cup"))
        """
    ) == [
        "Error setting joint target. Is the target within bounds? "
        "joint elbow shall go to 5; its limits are -2.8 and 2.8",
        "Error setting joint target: found 1 positions; expected 3: shoulder, elbow, wrist",
        "Unable to set target bend. Is the target within bounds? Group manipulator has bent",
        "There is no group named arm",
        "Group 'arm' was not found; the robot has manipulator, fingers, whole",
        "group fingers has no end effector, so a pose needs a link",
        "simkit does not plan grasps: the object cup is not picked",
        "99999",
    ]


def test_without_move_group_the_program_gets_the_exceptions_of_moveit(tmp_path: Path) -> None:
    (tmp_path / "mover.py").write_text(
        dedent(
            """
            import rospy, moveit_commander
            rospy.init_node("mover")
            try:
                moveit_commander.RobotCommander()
            except RuntimeError as error:
                rospy.loginfo("%s", error)
            """
        )
    )
    with simkit.load("empty") as sim:
        node = sim.add_node(tmp_path / "mover.py")
        sim.run(6.0)
        assert "neither a parameter nor a topic is named robot_description; start move_group" in node.log[0]


def test_a_program_of_ros_1_uses_move_group_with_parameters_of_ros_2(tmp_path: Path) -> None:
    (tmp_path / "controllers.yaml").write_text(CONTROLLERS, "utf-8")
    (tmp_path / "lab.sdf").write_text(world(model()), "utf-8")
    (tmp_path / "mover.py").write_text(START.replace('"robot_description"', "") + "\nshow(group.go([0.3, 0.2, 0.1]))")
    parameters: dict[str, Any] = {"robot_description": URDF, "robot_description_semantic": SRDF}
    talker = f"""
import rospy
from std_msgs.msg import String
rospy.init_node("talker")
publisher = rospy.Publisher("robot_description", String, latch=True, queue_size=1)
publisher.publish({URDF!r})
rospy.spin()
"""
    (tmp_path / "talker.py").write_text(talker)
    with simkit.load(tmp_path / "lab.sdf") as sim:
        sim.add_node("moveit_ros_move_group/move_group", params=parameters)
        sim.add_node(tmp_path / "talker.py")
        node = sim.add_node(tmp_path / "mover.py")
        sim.run(10.0)
        assert node.log[-1].endswith("]: True")
