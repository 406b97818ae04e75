"""Motions as actions and services: playback, refusal and cancellation."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import planar_arm as arm
import pytest

import simkit

JOINTS = ("shoulder", "elbow", "wrist")


@pytest.fixture
def sim(tmp_path: Path) -> Any:
    with arm.load(tmp_path) as sim:
        yield sim


def watched(sim: simkit.Simulation, goal: Any) -> tuple[list[float], list[list[float]]]:
    """Return times and positions of the arm until a goal has ended."""
    times, places = [sim.time], [arm.positions(sim, *JOINTS)]
    while not goal.is_done:
        sim.run(0.01)
        times.append(sim.time)
        places.append(arm.positions(sim, *JOINTS))
    return times, places


def test_a_motion_is_played_through_its_points_in_its_time(sim: Any) -> None:
    goal = sim.send_goal("/play_motion2", {"motion_name": "bow"})
    times, places = watched(sim, goal)
    assert goal.status.name == "SUCCEEDED" and goal.result.success and not goal.result.error
    assert times[-1] == pytest.approx(3.0, abs=0.05)
    at_one = places[int(np.argmin(np.abs(np.array(times) - 1.0)))]
    assert at_one == pytest.approx([0.5, 0.5, 0.0], abs=0.03)  # a period of the controllers at 1 rad/s
    assert places[-1] == pytest.approx([1.0, -0.5, 0.2], abs=2e-3)


def test_the_approach_is_no_faster_than_allowed(tmp_path: Path) -> None:
    with arm.load(tmp_path, element="<approach_velocity>0.25</approach_velocity>") as sim:
        arm.play(sim, "bow")  # ends with the shoulder at 1 rad
        goal = sim.send_goal("/play_motion2", {"motion_name": "rest"})
        times, places = watched(sim, goal)
        assert times[-1] - times[0] == pytest.approx(4.0, abs=0.05)  # 1 rad at 0.25 rad/s on average
        speeds = np.abs(np.diff(np.array(places), axis=0)) / 0.01
        assert speeds.max() <= 1.5 * 0.25 * 1.05  # a smooth start and end: 1.5 times the average halfway


def test_no_joint_is_faster_than_its_limit(sim: Any) -> None:
    goal = arm.play(sim, "open")  # 0.04 m in 0.5 s of a joint of 0.1 m/s: 1.5 · 0.04 / 0.1 s
    assert goal.status.name == "SUCCEEDED"
    assert sim.time == pytest.approx(0.6, abs=0.05)
    assert arm.positions(sim, "left_finger", "right_finger") == pytest.approx([0.04, 0.04], abs=1e-3)


def test_joints_without_a_motion_keep_their_positions(sim: Any) -> None:
    arm.play(sim, "bow")
    before = arm.positions(sim, "shoulder", "elbow")
    assert arm.play(sim, "nod").status.name == "SUCCEEDED"
    assert arm.positions(sim, "shoulder", "elbow") == pytest.approx(before, abs=1e-3)


def test_an_unknown_motion_is_rejected_with_the_closest(sim: Any) -> None:
    goal = arm.play(sim, "bowl")
    assert goal.status.name == "REJECTED"
    assert goal.reason == "Motion 'bowl' is not known; did you mean 'bow'?"


def test_a_motion_beyond_the_limits_is_reported_at_load_and_refused(sim: Any) -> None:
    assert [d.message for d in sim.diagnostics if d.code == "SK-MOTION-004"] == [
        "motion 'too_far' will be refused, because it exceeds the joint limits: "
        "elbow would be at 3.5 rad at 2 s; expected -2.8 to 2.8"
    ]
    goal = arm.play(sim, "too_far")
    assert goal.status.name == "ABORTED" and not goal.result.success
    assert goal.result.error.startswith("motion 'too_far' exceeds the joint limits: elbow would be at 3.5 rad")
    assert arm.positions(sim, *JOINTS) == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)


def test_a_colliding_motion_is_refused_with_the_names_of_both_links(sim: Any) -> None:
    goal = arm.play(sim, "curl")
    assert goal.status.name == "ABORTED" and not goal.result.success
    assert "collides on the way to its first point: upper and hand overlap by" in goal.result.error
    sim.run(0.5)
    assert arm.positions(sim, *JOINTS) == pytest.approx([0.0, 0.0, 0.0], abs=1e-4)


def test_a_wall_in_the_way_is_named_and_skip_planning_ignores_it(tmp_path: Path) -> None:
    with arm.load(tmp_path, arm.box("wall", "0.5 0.6 0.5 0 0 0", "1 0.1 1")) as sim:
        goal = arm.play(sim, "bow")
        assert goal.status.name == "ABORTED" and "wall::body" in goal.result.error
        goal = sim.send_goal("/play_motion2", {"motion_name": "bow", "skip_planning": True})
        sim.run(0.1)
        assert goal.status.name == "EXECUTING"


def test_a_second_motion_is_rejected_while_one_is_played(sim: Any) -> None:
    first = sim.send_goal("/play_motion2", {"motion_name": "bow"})
    sim.run(1.0)
    second = sim.send_goal("/play_motion2", {"motion_name": "open"})
    sim.run(0.1)
    assert second.status.name == "REJECTED" and second.reason == "PlayMotion2 is busy: motion 'bow' is being played"
    sim.run(3.0)
    assert first.status.name == "SUCCEEDED"
    assert arm.play(sim, "open").status.name == "SUCCEEDED"


def test_a_cancelled_motion_stops_and_the_arm_holds_its_position(sim: Any) -> None:
    goal = sim.send_goal("/play_motion2", {"motion_name": "bow"})
    sim.run(2.0)
    goal.cancel()
    sim.run(0.5)
    assert goal.status.name == "CANCELED"
    assert (goal.result.success, goal.result.error) == (False, "Motion canceled")
    held = arm.positions(sim, *JOINTS)
    assert 0.5 < held[0] < 1.0
    sim.run(2.0)
    assert arm.positions(sim, *JOINTS) == pytest.approx(held, abs=1e-3)
    assert arm.play(sim, "rest").status.name == "SUCCEEDED"


def test_another_goal_for_its_controller_ends_the_motion(sim: Any) -> None:
    goal = sim.send_goal("/play_motion2", {"motion_name": "bow"})
    sim.run(1.0)
    point = {"positions": [0.0, 0.0, 0.0], "time_from_start": {"sec": 2}}
    other = {"trajectory": {"joint_names": list(JOINTS), "points": [point]}}
    sim.send_goal("/arm_controller/follow_joint_trajectory", other)
    sim.run(0.5)
    assert goal.status.name == "ABORTED" and goal.result.error.startswith("Joint Trajectory failed: arm_controller: ")


def test_joints_without_an_active_controller_cannot_be_played(sim: Any) -> None:
    host = next(p for p in sim.engine.structure.all_plugins() if hasattr(p, "manager"))
    host.manager.deactivate("gripper_controller")
    goal = arm.play(sim, "open")
    assert goal.status.name == "REJECTED"
    assert goal.reason == "Joints 'left_finger', 'right_finger' are not claimed by any active controller"
    assert not sim.call("/play_motion2/is_motion_ready", {"motion_key": "open"}).is_ready
    assert sim.call("/play_motion2/is_motion_ready", {"motion_key": "bow"}).is_ready


def test_feedback_contains_the_time(sim: Any) -> None:
    reports: list[float] = []
    goal = sim.send_goal(
        "/play_motion2",
        {"motion_name": "bow"},
        lambda f: reports.append(f.current_time.sec + f.current_time.nanosec * 1e-9),
    )
    sim.run(4.0)
    assert goal.status.name == "SUCCEEDED"
    assert 50 < len(reports) < 70 and reports == sorted(reports)  # 20 Hz for 3 s


def test_ros_1_results_have_error_codes(sim: Any) -> None:
    found = {name: arm.play(sim, name, "/play_motion").result for name in ("bowl", "too_far", "curl", "nod")}
    assert {name: result.error_code for name, result in found.items()} == {
        "bowl": -1,  # MOTION_NOT_FOUND
        "too_far": -42,  # OTHER_ERROR
        "curl": -8,  # NO_PLAN_FOUND
        "nod": 1,  # SUCCEEDED
    }
    assert "did you mean 'bow'?" in found["bowl"].error_string


def test_in_ros_1_two_motions_without_common_joints_run_together(sim: Any) -> None:
    first = sim.send_goal("/play_motion", {"motion_name": "bow"})
    sim.run(0.5)
    second = sim.send_goal("/play_motion", {"motion_name": "open"})
    third = sim.send_goal("/play_motion", {"motion_name": "nod"})
    sim.run(4.0)
    assert (first.result.error_code, second.result.error_code, third.result.error_code) == (1, 1, -3)
    assert third.reason == "controller 'arm_controller' is busy: motion 'bow' is being played"


def test_services_list_and_describe_the_motions(sim: Any) -> None:
    names = ["rest", "bow", "nod", "curl", "too_far", "open", "close"]
    assert sim.call("/play_motion2/list_motions").motion_keys == names
    bow = sim.call("/play_motion2/get_motion_info", {"motion_key": "bow"}).motion
    assert (bow.name, bow.usage, bow.description) == ("Bow", "test", "There and elsewhere.")
    assert bow.joints == list(JOINTS)
    assert bow.positions.tolist() == [0.5, 0.5, 0.0, 1.0, -0.5, 0.2]
    assert bow.times_from_start.tolist() == [1.0, 3.0]
    infos = sim.call("/play_motion/list_motions").motions
    assert [(i.name, i.duration.sec, i.duration.nanosec) for i in infos][:2] == [
        ("rest", 0, 500_000_000),
        ("bow", 3, 0),
    ]


def test_services_report_readiness_before_a_goal_is_sent(sim: Any) -> None:
    def is_ready(key: str) -> bool:
        return bool(sim.call("/play_motion2/is_motion_ready", {"motion_key": key}).is_ready)

    assert is_ready("bow") and not is_ready("bowl") and not is_ready("too_far")
    assert sim.call("/play_motion2/is_joint_list_ready", {"joints": ["wrist"]}).is_ready
    assert not sim.call("/play_motion2/is_joint_list_ready", {"joints": ["wrist", "tail"]}).is_ready
    sim.send_goal("/play_motion2", {"motion_name": "bow"})
    sim.run(0.1)
    assert not is_ready("open")


def test_already_there_refers_to_the_first_point(sim: Any) -> None:
    def is_there(name: str, tolerance: float = 0.01) -> bool:
        request = {"motion_name": name, "tolerance": tolerance}
        return bool(sim.call("/play_motion/is_already_there", request).already_there)

    assert is_there("rest") and not is_there("bow") and is_there("bow", 0.6) and not is_there("none")


def test_motions_can_be_added_and_removed_and_a_reset_restores_those_of_the_files(sim: Any) -> None:
    motion = {"key": "tilt", "joints": ["wrist"], "positions": [0.3], "times_from_start": [1.0]}
    assert sim.call("/play_motion2/add_motion", {"motion": motion}).success
    assert not sim.call("/play_motion2/add_motion", {"motion": motion}).success
    assert sim.call("/play_motion2/add_motion", {"motion": {**motion, "positions": [0.4]}, "overwrite": True}).success
    assert not sim.call("/play_motion2/add_motion", {"motion": {**motion, "key": "bad", "positions": []}}).success
    assert arm.play(sim, "tilt").status.name == "SUCCEEDED"
    assert arm.positions(sim, "wrist") == pytest.approx([0.4], abs=2e-3)
    assert sim.call("/play_motion2/remove_motion", {"motion_key": "nod"}).success
    assert not sim.call("/play_motion2/remove_motion", {"motion_key": "nod"}).success
    sim.reset()
    keys = sim.call("/play_motion2/list_motions").motion_keys
    assert "nod" in keys and "tilt" not in keys


def test_a_goal_can_contain_a_motion(sim: Any) -> None:
    motion = {"key": "x", "joints": ["wrist"], "positions": [0.2, 0.3], "times_from_start": [1.0, 2.0]}
    goal = sim.send_goal("/play_motion2/raw", {"motion": motion})
    sim.run(3.0)
    assert goal.status.name == "SUCCEEDED"
    assert arm.positions(sim, "wrist") == pytest.approx([0.3], abs=2e-3)
    bad = sim.send_goal("/play_motion2/raw", {"motion": {**motion, "times_from_start": [2.0, 1.0]}})
    sim.run(0.1)
    assert bad.status.name == "REJECTED" and "its times must increase" in bad.reason


def test_equal_goals_give_equal_bits_also_after_a_restore(sim: Any) -> None:
    def end_of(goal: Any) -> tuple[str, bytes]:
        sim.run(3.0)
        return goal.status.name, sim.mj_data.qpos.tobytes()

    goal = sim.send_goal("/play_motion2", {"motion_name": "bow"})
    sim.run(1.0)
    half_way = sim.snapshot()
    first = end_of(goal)
    sim.restore(half_way)
    assert goal.status.name == "EXECUTING"
    assert end_of(goal) == first
    sim.reset()
    again = sim.send_goal("/play_motion2", {"motion_name": "bow"})
    sim.run(1.0)
    assert end_of(again) == first


def test_missing_files_and_missing_joints_are_reported(tmp_path: Path) -> None:
    with arm.load(tmp_path, element="<motions>others.yaml</motions>") as sim:
        found = [d for d in sim.diagnostics if d.code == "SK-MOTION-001"]
        assert len(found) == 1 and "others.yaml" in found[0].message
        assert "bow" in arm.player(sim).motions
    with arm.load(tmp_path, motions=arm.MOTIONS.replace("joints: [wrist]", "joints: [wirst]")) as sim:
        reports = [(d.message, d.hint) for d in sim.diagnostics if d.code == "SK-MOTION-004"]
        assert (
            "motion 'nod' cannot be played: joint 'wirst' does not exist in 'arm'",
            "did you mean 'wrist'?",
        ) in reports
        goal = arm.play(sim, "nod")
        assert goal.status.name == "REJECTED" and "did you mean 'wrist'?" in goal.reason
    with arm.load(tmp_path, motions=arm.MOTIONS.replace("joints: [wrist]", "joints: [standing]")) as sim:
        reports = [(d.message, d.hint) for d in sim.diagnostics if d.code == "SK-MOTION-004"]
        assert ("motion 'nod' cannot be played: joint 'standing' does not have exactly one axis", "") in reports
        assert arm.play(sim, "nod").status.name == "REJECTED"


def test_two_robots_play_under_their_own_namespaces(tmp_path: Path) -> None:
    arm.load(tmp_path).close()
    spaced = "<ros><namespace>other</namespace></ros>"
    second = arm.model("other", arm.play_motion(spaced), "0 3 0 0 0 0").replace("<parameters>", f"{spaced}<parameters>")
    own = arm.CONTROLLERS.replace("\n", "\n  ").replace("\n  controller_manager", "\nother:\n  controller_manager")
    (tmp_path / "controllers.yaml").write_text(arm.CONTROLLERS + own)
    (tmp_path / "two.sdf").write_text(arm.world(arm.model(extra=arm.play_motion()) + second))
    with simkit.load(tmp_path / "two.sdf") as sim:
        goal = sim.send_goal("/other/play_motion2", {"motion_name": "nod"})
        sim.run(0.6)
        assert float(sim.joint("other::wrist").position) > 0.2
        assert float(sim.joint("arm::wrist").position) == pytest.approx(0.0, abs=1e-6)
        sim.run(2.0)
        assert goal.status.name == "SUCCEEDED"


def test_a_second_robot_without_a_namespace_uses_its_own_name(tmp_path: Path) -> None:
    arm.load(tmp_path).close()
    second = arm.model("other", arm.play_motion(), "0 3 0 0 0 0").replace("libgazebo_ros2_control.so", "none")
    (tmp_path / "two.sdf").write_text(arm.world(arm.model(extra=arm.play_motion()) + second))
    with simkit.load(tmp_path / "two.sdf") as sim:
        assert (
            "/other/play_motion2" in sim.communication.actions.names()
            and "/other/play_motion/list_motions" in sim.communication.services.names()
        )
        note = next(d for d in sim.diagnostics if d.code == "SK-MOTION-007")
        assert note.message == (
            "robot 'other' plays motions under '/other/play_motion2', because another robot uses '/play_motion2'"
        )


def test_a_time_beyond_the_range_of_a_trajectory_is_refused(sim: Any) -> None:
    motion = {"key": "x", "joints": ["wrist"], "positions": [0.2], "times_from_start": [3e9]}
    goal = sim.send_goal("/play_motion2/raw", {"motion": motion})
    sim.run(0.1)
    assert goal.status.name == "ABORTED" and "motion 'x' would take" in goal.result.error


def test_a_number_above_1e15_in_a_motion_is_refused(sim: Any) -> None:
    motion = {"key": "x", "joints": ["wrist"], "positions": [0.2], "times_from_start": [1e300]}
    goal = sim.send_goal("/play_motion2/raw", {"motion": motion})
    sim.run(0.1)
    assert goal.status.name == "REJECTED" and "it has the number 1e+300" in goal.reason


MIMIC = '<mimic joint="right_finger"><multiplier>2</multiplier><offset>0.01</offset><reference>0</reference></mimic>'


@pytest.fixture
def following(tmp_path: Path) -> Any:
    """Return the arm with a left finger that mimics the right one: 2 · right + 0.01."""
    (tmp_path / "controllers.yaml").write_text(arm.CONTROLLERS.replace("[left_finger, right_finger]", "[right_finger]"))
    (tmp_path / "motions.yaml").write_text(arm.MOTIONS)
    limit = "<lower>0.0</lower><upper>0.04</upper><effort>60</effort>"
    text = arm.world(arm.model(extra=arm.play_motion()))
    left, right = text.split('<joint name="right_finger"')
    before, after = left.rsplit(limit, 1)
    left = f"{before}{limit.replace('0.04', '0.1')}{after}".replace("<xyz>0 1 0</xyz>", f"<xyz>0 1 0</xyz>{MIMIC}")
    (tmp_path / "lab.sdf").write_text(f'{left}<joint name="right_finger"{right}')
    with simkit.load(tmp_path / "lab.sdf") as sim:
        yield sim


def test_a_mimic_joint_is_moved_by_its_leader(following: Any) -> None:
    motion = {"key": "x", "joints": ["left_finger"], "positions": [0.05], "times_from_start": [1.0]}
    goal = following.send_goal("/play_motion2/raw", {"motion": motion})
    following.run(2.0)
    assert goal.status.name == "SUCCEEDED"
    assert arm.positions(following, "left_finger", "right_finger") == pytest.approx([0.05, 0.02], abs=1e-3)


def test_a_position_that_contradicts_the_mimic_rule_is_refused(following: Any) -> None:
    goal = arm.play(following, "open")  # both at 0.04
    assert goal.status.name == "ABORTED"
    assert "left_finger would be at 0.04 at 0.5 s, but it mimics right_finger, which moves it to 0.09" in goal.reason


def test_a_motion_that_does_not_finish_times_out(tmp_path: Path) -> None:
    """One controller finishes, the other never does: its goal has a tolerance but no time limit."""
    push = "joints: [left_finger, right_finger, shoulder], positions: [0.005, 0.005, 0.4], times_from_start: [1.0]"
    wall = arm.box("wall", "0.5 0.15 0.5 0 0 0", "1 0.05 0.3")
    arm.load(tmp_path, wall, motions=f"{arm.MOTIONS}      push: {{{push}}}\n").close()
    first, second = (
        f"    {name}_controller: {{type: joint_trajectory_controller/JointTrajectoryController}}\n"
        for name in ("arm", "gripper")
    )
    strict = "    constraints: {goal_time: 0.0, shoulder: {goal: 0.01}}\ngripper_controller:\n  ros__"
    text = arm.CONTROLLERS.replace(first + second, second + first)
    (tmp_path / "controllers.yaml").write_text(text.replace("gripper_controller:\n  ros__", strict))
    with simkit.load(tmp_path / "lab.sdf") as sim:
        goal = sim.send_goal("/play_motion2", {"motion_name": "push", "skip_planning": True})
        sim.run(6.0)
        assert goal.status.name == "ABORTED" and "Timeout exceeded" in goal.result.error


def test_unknown_excluded_joints_are_reported(tmp_path: Path) -> None:
    element = "<exclude_from_planning_joints>left_finger rigth_finger</exclude_from_planning_joints>"
    with arm.load(tmp_path, element=element) as sim:
        (warning,) = [d for d in sim.diagnostics if d.code == "SK-MOTION-006"]
        assert "'arm' has no joint 'rigth_finger'" in warning.message and "'right_finger'" in warning.hint
