"""Navigation: goals with replanning and recoveries, behaviours, and the same bits after a restore."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from navigation_worlds import ROBOT, WALL, pose, run_until_done, world

import simkit


def reached(sim: simkit.Simulation, x: float, y: float, yaw: float) -> tuple[float, float]:
    """Return distance [m] and angle [deg] between the true pose and a goal."""
    found = sim.model("turtlebot3").pose
    turn = math.remainder(float(found.rpy[2]) - yaw, math.tau)
    return math.hypot(found.position[0] - x, found.position[1] - y), abs(math.degrees(turn))


BOX = """<sdf version="1.9"><model name="box"><static>true</static><link name="l"><collision name="c"><geometry><box>
  <size>0.4 0.4 1</size></box></geometry></collision></link></model></sdf>"""


@pytest.mark.slow  # a drive of 20 s
def test_an_obstacle_that_the_map_does_not_have_is_seen_and_passed(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path)) as sim:
        sim.run(1.3)
        goal = sim.send_goal("/navigate_to_pose", {"pose": pose(0.0, 3.0, 1.57)})
        sim.run(4.0)
        sim.spawn(BOX, "box", simkit.Pose((0.0, 1.7, 0.5)))
        widest = 0.0
        for _ in range(300):
            sim.run(0.1)
            widest = max(widest, abs(sim.model("turtlebot3").pose.position[0]))
            assert not [c for c in sim.contacts("turtlebot3") if not c.first.startswith("ground")]
            if goal.is_done:
                break
        assert goal.status.name == "SUCCEEDED" and widest > 0.4
        assert reached(sim, 0.0, 3.0, 1.57)[0] < 0.08


@pytest.mark.slow  # a drive of 25 s
def test_the_robot_drives_around_a_wall_and_touches_nothing(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path)) as sim:
        feedback: list[Any] = []
        sim.run(1.3)
        goal = sim.send_goal("/navigate_to_pose", {"pose": pose(2.5, 0.0, 2.0)}, on_feedback=feedback.append)
        for _ in range(200):
            sim.run(0.25)
            assert not [c for c in sim.contacts("turtlebot3") if not c.first.startswith("ground")]
            if goal.is_done:
                break
        assert goal.status.name == "SUCCEEDED"
        distance, angle = reached(sim, 2.5, 0.0, 2.0)
        assert distance < 0.1 and angle < 5.0
        first, last = feedback[0], feedback[-1]
        assert first.distance_remaining == 0.0 and feedback[5].distance_remaining > 4.5 > 1.0 > last.distance_remaining
        assert last.number_of_recoveries == 0 and last.navigation_time.sec > 10
        assert feedback[50].estimated_time_remaining.sec > 5


@pytest.mark.slow
def test_a_restore_in_the_middle_gives_the_same_bits(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path)) as sim:
        sim.run(1.3)
        goal = sim.send_goal("/navigate_to_pose", {"pose": pose(0.5, 0.8, 2.0)})
        sim.run(2.0)
        kept, ends = sim.snapshot(), []
        for _ in range(2):
            run_until_done(sim, goal)
            assert goal.status.name == "SUCCEEDED"
            ends.append((sim.time, sim.mj_data.qpos.tobytes()))
            sim.restore(kept)
        assert ends[0] == ends[1]


def test_a_goal_that_cannot_be_reached_is_aborted_after_recoveries(tmp_path: Path) -> None:
    closed = WALL + "".join(
        WALL.replace('"wall"', f'"wall_{i}"').replace("2 0 0.5 0 0 0", place)
        for i, place in enumerate(("0 2 0.5 0 0 1.5708", "0 -2 0.5 0 0 1.5708", "-2 0 0.5 0 0 0"))
    )
    with simkit.load(world(tmp_path, models=closed)) as sim:
        sim.run(1.3)
        goal = sim.send_goal("/navigate_to_pose", {"pose": pose(2.45, 0.0)})
        run_until_done(sim, goal)
        assert goal.status.name == "ABORTED"
        assert "found no path" in goal.reason and "6 recoveries" in goal.reason
        assert goal.feedback.number_of_recoveries == 6  # each cleared costmap counts, as in Nav2
        assert reached(sim, 0.0, 0.0, 1.57)[0] < 0.05  # clear, then spin
        assert reached(sim, 0.0, 0.0, 1.57)[1] < 8.0
        nowhere = sim.send_goal("/navigate_to_pose", {"pose": pose(math.nan, 0.0)})
        sim.step(2)
        assert nowhere.status.name == "REJECTED"


def test_a_cancelled_goal_stops_the_robot_and_another_goal_replaces_one(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path)) as sim:
        sim.run(1.3)
        first = sim.send_goal("/navigate_to_pose", {"pose": pose(1.0, 1.0)})
        sim.run(2.0)
        sim.publish("/goal_pose", pose(1.2, 0.0))
        sim.run(1.5)
        assert first.status.name == "ABORTED"
        assert np.hypot(*sim.link("turtlebot3::base_footprint").linear_velocity[:2]) > 0.1
        through = {"poses": [pose(0.9, 0.0), pose(1.3, 0.3)]}
        refused = sim.send_goal("/navigate_through_poses", through)
        sim.step(2)
        assert (refused.status.name, refused.reason) == (
            "REJECTED",
            "a goal of navigate_to_pose is active; cancel it first",
        )
        sim.plugins["bt_navigator"]._task.goal.cancel()
        sim.step(2)
        second = sim.send_goal("/navigate_through_poses", through)
        sim.run(1.0)
        assert second.feedback.number_of_poses_remaining in (1, 2)
        second.cancel()
        sim.run(1.0)
        assert second.status.name == "CANCELED"
        assert np.hypot(*sim.link("turtlebot3::base_footprint").linear_velocity[:2]) < 0.01


def test_several_poses_are_reached_in_turn(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path)) as sim:
        sim.run(1.3)
        feedback: list[Any] = []
        poses = [pose(0.9, 0.0), pose(1.1, 0.6, 0.7)]
        goal = sim.send_goal("/navigate_through_poses", {"poses": poses}, on_feedback=feedback.append)
        run_until_done(sim, goal)
        assert goal.status.name == "SUCCEEDED"
        assert {one.number_of_poses_remaining for one in feedback} == {1, 2}
        distance, angle = reached(sim, 1.1, 0.6, 0.7)
        assert distance < 0.08 and angle < 4.0


def test_without_a_planner_a_goal_is_aborted_with_the_reason() -> None:
    robot = """<sdf version="1.9"><world name="w"><plugin filename="libsimkit_bt_navigator.so" name="bt_navigator">
      <robot_base_frame>map</robot_base_frame></plugin></world></sdf>"""
    with simkit.load(robot) as sim:
        goal = sim.send_goal("/navigate_to_pose", {"pose": pose(1.0, 0.0)})
        sim.run(0.1)
        assert goal.status.name == "ABORTED" and "no action '/compute_path_to_pose'" in goal.reason
        empty = sim.send_goal("/navigate_through_poses", {"poses": []})
        sim.step(2)
        assert empty.status.name == "REJECTED"


def test_behaviours_move_by_their_goal(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path)) as sim:
        sim.run(1.0)
        spin = sim.send_goal("/spin", {"target_yaw": 1.57, "time_allowance": {"sec": 9}})
        run_until_done(sim, spin)
        assert spin.status.name == "SUCCEEDED" and reached(sim, 0.0, 0.0, 1.57)[1] < 8.0
        back = sim.send_goal("/backup", {"target": {"x": 0.3}, "speed": 0.1, "time_allowance": {"sec": 9}})
        run_until_done(sim, back)
        assert back.status.name == "SUCCEEDED" and sim.model("turtlebot3").pose.position[1] == pytest.approx(
            -0.3, abs=0.03
        )
        wait = sim.send_goal("/wait", {"time": {"sec": 1}})
        run_until_done(sim, wait)
        assert wait.status.name == "SUCCEEDED" and wait.result.total_elapsed_time.sec == 1
        ahead = sim.send_goal("/drive_on_heading", {"target": {"x": 0.3}, "speed": 0.0})
        sim.step(2)
        assert (ahead.status.name, ahead.result.error_code) == ("ABORTED", 724)
        slow = sim.send_goal("/drive_on_heading", {"target": {"x": 1.0}, "speed": 0.1, "time_allowance": {"sec": 1}})
        run_until_done(sim, slow)
        assert (slow.status.name, slow.result.error_code) == ("ABORTED", 721)


def test_the_end_of_an_old_path_is_not_the_end_of_a_new_goal(tmp_path: Path) -> None:
    """The old path ends after the new goal came and before there is a path to the new goal."""
    with simkit.load(world(tmp_path)) as sim:
        sim.run(1.3)
        sim.send_goal("/navigate_to_pose", {"pose": pose(0.3, 0.0)})
        sim.run(0.5)
        navigator = sim.plugins["bt_navigator"]
        goal = sim.send_goal("/navigate_to_pose", {"pose": pose(0.3, 1.5)})
        follow = next(node for node in navigator._task.tree.nodes if node.tag == "FollowPath")
        sim.plugins["controller_server"]._stop()
        follow.handle.succeed()
        sim.run(0.1)
        assert goal.status.name == "EXECUTING"


def test_a_rejected_goal_of_the_topic_is_in_the_log(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    with simkit.load(world(tmp_path)) as sim:
        sim.run(1.3)
        for goal in (pose(0.5, 0.0, frame="moon"), pose(math.nan, 0.0)):
            sim.publish("/goal_pose", goal)
            sim.step(2)
    moon, nan = (record.getMessage() for record in caplog.records if "Goal rejected" in record.getMessage())
    assert "the pose of the goal is not known in 'map'" in moon and "unknown frame 'moon'" in moon
    assert nan == "Goal rejected: the pose of the goal contains NaN or infinite numbers"


def test_a_goal_before_there_is_a_pose_is_rejected_with_the_frames_that_are_not_connected(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path)) as sim:
        goal = sim.send_goal("/navigate_to_pose", {"pose": pose(0.5, 0.0)})
        sim.step(2)
        assert goal.status.name == "REJECTED"
        text = "the pose of the robot is not known; a localisation must connect the frames 'map' and 'base_footprint'"
        assert goal.reason == text


def test_a_goal_outside_of_the_map_is_aborted_with_the_planners_error_code(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path)) as sim:
        sim.run(1.3)
        goal = sim.send_goal("/navigate_to_pose", {"pose": pose(1e30, 0.0)})
        run_until_done(sim, goal)
        assert (goal.status.name, goal.result.error_code) == ("ABORTED", 204)  # GOAL_OUTSIDE_MAP
        assert goal.reason == "the goal (1e+30, 0) is outside of the costmap"  # no recovery helps
        assert goal.result.error_msg == goal.reason


def test_a_motion_without_end_is_checked_within_the_costmap_only(tmp_path: Path) -> None:
    """The way of 10³⁰ m at 10³⁰ m/s would have 10³² poses; those outside of the costmap cannot touch anything."""
    file = world(tmp_path, models="")
    file.write_text(file.read_text("utf-8").replace("<plugins>obstacle_layer ", "<plugins>"), "utf-8")
    with simkit.load(file) as sim:
        sim.run(0.5)
        request = {"target": {"x": 1e30}, "speed": 1e30, "time_allowance": {"sec": 1}}
        goal = sim.send_goal("/drive_on_heading", request)
        run_until_done(sim, goal)
        assert (goal.status.name, goal.result.error_code) == ("ABORTED", 721)  # TIMEOUT
        assert goal.result.error_msg == goal.reason == "the time allowance is over"


def test_a_motion_ends_if_the_pose_is_lost(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with simkit.load(world(tmp_path)) as sim:
        sim.run(0.5)
        goal = sim.send_goal("/drive_on_heading", {"target": {"x": 5.0}, "speed": 0.1})
        sim.run(0.5)
        assert goal.status.name == "EXECUTING"
        server = sim.plugins["behavior_server"]
        monkeypatch.setattr(server, "_pose", lambda: None)
        sim.run(0.3)
        assert (goal.status.name, goal.result.error_code) == ("ABORTED", 722)


def test_the_true_pose_is_that_of_a_robot_that_replaces_another_one_of_its_name() -> None:
    light = '<light name="sun" type="directional"><direction>0 0 -1</direction></light>'
    plugin = '<plugin filename="libsimkit_fake_localization.so" name="fake"><update_rate>5</update_rate></plugin>'
    with simkit.load(f'<sdf version="1.9"><world name="w">{light}{ROBOT}{plugin}</world></sdf>') as sim:
        poses = sim.subscribe("/amcl_pose", keep=1)
        sim.run(0.45)
        sim.remove("turtlebot3")
        sim.spawn("turtlebot3_waffle", name="turtlebot3", pose=simkit.Pose((3.0, 0.0, 0.0)))
        sim.run(0.7)
        assert poses.latest.pose.pose.position.x == pytest.approx(3.0, abs=0.01)
