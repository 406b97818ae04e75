"""ros2_controllers' joint trajectory controller: following, ends of goals, bad input."""

from __future__ import annotations

import math
from typing import Any

import pytest
from followers import FOLLOW, TOPIC, arm, codes, send
from perfect_joints import trajectory

from simkit.msgs.goal_status import GoalStatus

# ---------------------------------------------------------------------- following


def test_the_trajectory_is_followed_in_the_controllers_joint_order() -> None:
    sim, plugin = arm()
    told: list[Any] = []
    points = trajectory(["b", "a"], (2.0, [1.0, 2.0], [0.5, 1.0]), (4.0, [0.0, 1.0], [0.0, 0.0]))
    goal = sim.send_goal(FOLLOW, {"trajectory": points}, told.append)
    sim.run(2.0)
    assert plugin.position("a") == pytest.approx(2.0, abs=1e-9)
    assert plugin.position("b") == pytest.approx(1.0, abs=1e-9)
    sim.run(2.02)
    assert goal.status is GoalStatus.SUCCEEDED
    assert (goal.result.error_code, goal.result.error_string) == (0, "Goal successfully reached!")
    assert (plugin.position("a"), plugin.position("b")) == (1.0, 0.0)
    assert list(told[0].joint_names) == ["a", "b"]
    assert len(told) == 81  # 20 Hz over 4 s and the first


def test_each_command_is_for_the_end_of_the_period_that_begins() -> None:
    sim, plugin = arm()
    send(sim, (1.0, [1.0, 0.5]))
    sim.run(0.5)
    assert plugin.position("a") == pytest.approx(0.5, abs=1e-12)


def test_a_trajectory_on_the_topic_is_followed_too() -> None:
    sim, plugin = arm()
    sim.publish(TOPIC, trajectory(["a", "b"], (1.0, [1.0, 0.0])))
    sim.run(1.5)
    assert (plugin.position("a"), plugin.position("b")) == (1.0, 0.0)


def test_the_controller_holds_before_the_first_trajectory_and_is_idle() -> None:
    sim, plugin = arm()
    sim.run(0.2)
    assert plugin.commanded[-1] == [0.0, 0.5]
    assert plugin.controller._is_idle


def test_a_trajectory_with_a_stamp_in_the_future_starts_at_the_stamp() -> None:
    sim, plugin = arm()
    send(sim, (1.0, [1.0, 0.5]), stamp=1.0)
    sim.run(1.0)
    assert plugin.position("a") == pytest.approx(0.5)  # ros2_control moves from now to the first point
    sim.run(1.1)
    assert plugin.position("a") == 1.0


def test_the_past_part_of_a_trajectory_is_skipped() -> None:
    sim, plugin = arm({"constraints": {"goal_time": 0.5}})
    sim.run(2.0)
    send(sim, (0.5, [5.0, 0.5]), (1.5, [6.0, 0.5]), stamp=1.0)
    sim.run(0.01)
    assert plugin.position("a") == pytest.approx(5.51)


def test_a_speed_scaling_stretches_the_time() -> None:
    sim, plugin = arm({"speed_scaling": {"initial_scaling_factor": 0.5}})
    send(sim, (1.0, [1.0, 0.5]))
    sim.run(1.0)
    assert plugin.position("a") == pytest.approx(0.5)
    sim.publish("/arm_controller/speed_scaling_input", {"factor": 1.0})
    sim.run(0.25)
    assert plugin.position("a") == pytest.approx(0.75, abs=0.011)


def test_a_continuous_joint_takes_the_short_way() -> None:
    sim, plugin = arm(start={"a": 6.2, "b": 0.5}, continuous=("a",))
    goal = send(sim, (1.0, [0.1, 0.5]))
    sim.run(1.1)
    assert goal.status is GoalStatus.SUCCEEDED
    assert plugin.position("a") == pytest.approx(0.1 + 2 * math.pi)


def test_a_partial_trajectory_is_accepted_if_allowed() -> None:
    sim, plugin = arm({"allow_partial_joints_goal": True})
    goal = send(sim, (1.0, [0.7]), joints=["a"])
    sim.run(1.1)
    assert goal.status is GoalStatus.SUCCEEDED
    assert (plugin.position("a"), plugin.position("b")) == (0.7, 0.5)


def test_an_open_loop_trajectory_begins_at_the_last_command() -> None:
    at = []
    for values in ({}, {"interpolate_from_desired_state": True}):
        sim, plugin = arm({**values, "constraints": {}}, most={"a": 0.001})
        send(sim, (1.0, [1.0, 0.5]))
        sim.run(0.5)
        send(sim, (1.0, [0.5, 0.5]))
        sim.run(0.02)
        at.append(plugin.commanded[-1][0])
    assert at[0] == pytest.approx(0.06, abs=0.02)
    assert at[1] == pytest.approx(0.5, abs=0.02)


# ---------------------------------------------------------------------- ends


def test_a_violated_path_tolerance_ends_the_goal_and_the_joints_hold() -> None:
    sim, plugin = arm(most={"a": 0.005})
    goal = send(sim, (1.0, [1.0, 0.6]), (2.0, [2.0, 0.6]))
    sim.run(0.5)
    assert goal.status is GoalStatus.ABORTED
    assert (goal.result.error_code, goal.result.error_string) == (-4, "Aborted due to path tolerance violation")
    assert goal.reason.startswith("a: Position Error: 0.1")
    held = plugin.position("a"), plugin.position("b")
    sim.run(1.0)
    assert (plugin.position("a"), plugin.position("b")) == held


def test_a_late_goal_is_aborted() -> None:
    sim, plugin = arm({"constraints": {"goal_time": 0.3, "a": {"goal": 0.02}}}, most={"a": 0.004})
    goal = send(sim, (1.0, [1.0, 0.5]))
    sim.run(1.3)
    assert goal.status is GoalStatus.EXECUTING
    sim.run(0.1)
    assert goal.result.error_code == -5
    assert goal.result.error_string == "Aborted due to goal_time_tolerance exceeding by 0.310000 seconds"
    held = plugin.position("a")
    sim.run(0.5)
    assert plugin.position("a") == pytest.approx(held)


def test_without_a_goal_time_a_goal_waits_for_ever() -> None:
    sim, _ = arm({"constraints": {"a": {"goal": 0.02}}}, most={"a": 0.002})
    goal = send(sim, (1.0, [1.0, 0.5]))
    sim.run(4.5)
    assert goal.status is GoalStatus.EXECUTING
    sim.run(1.0)
    assert goal.status is GoalStatus.SUCCEEDED


def test_tolerances_of_a_goal_replace_those_of_the_file() -> None:
    sim, _ = arm(most={"a": 0.005})
    loose = {"path_tolerance": [{"name": "a", "position": -1.0}], "goal_time_tolerance": {"sec": 3}}
    goal = send(sim, (1.0, [1.0, 0.5]), **loose)
    sim.run(2.2)
    assert goal.status is GoalStatus.SUCCEEDED
    strict = {"goal_tolerance": [{"name": "a", "position": 0.0001}], "goal_time_tolerance": {"nanosec": 100_000_000}}
    goal = send(sim, (0.1, [0.5, 0.5]), **{**strict, "path_tolerance": [{"name": "a", "position": -1.0}]})
    sim.run(0.5)
    assert goal.result.error_code == -5


def test_a_cancelled_goal_leaves_the_joints_where_they_are() -> None:
    sim, plugin = arm()
    goal = send(sim, (1.0, [1.0, 0.5]))
    sim.run(0.5)
    goal.cancel()
    sim.run(0.02)
    held = plugin.position("a")
    sim.run(1.0)
    assert goal.status is GoalStatus.CANCELED
    assert plugin.position("a") == pytest.approx(held)
    assert held == pytest.approx(0.5, abs=0.011)


def test_a_cancelled_goal_may_slow_down_instead() -> None:
    slowing = {"decelerate_on_cancel": True, "a": {"max_deceleration_on_cancel": 2.0}}
    sim, plugin = arm({"constraints": slowing})
    goal = send(sim, (2.0, [2.0, 0.5]))
    sim.run(1.0)
    goal.cancel()
    sim.run(1.0)
    assert plugin.position("a") == pytest.approx(1.0 + 1.0**2 / (2 * 2.0), abs=0.02)


def test_a_second_goal_replaces_the_first() -> None:
    sim, plugin = arm()
    first = send(sim, (1.0, [1.0, 0.5]))
    sim.run(0.5)
    second = send(sim, (1.0, [0.0, 0.5]))
    sim.run(1.1)
    assert first.status is GoalStatus.CANCELED
    assert first.result.error_code == -1
    assert first.result.error_string == "Current goal cancelled due to new incoming action."
    assert second.status is GoalStatus.SUCCEEDED
    assert plugin.position("a") == 0.0


def test_a_finished_trajectory_holds_its_last_command_until_the_timeout() -> None:
    sim, plugin = arm({"cmd_timeout": 1.0, "constraints": {"goal_time": 0.5}}, most={"a": 0.002})
    sim.publish(TOPIC, trajectory(["a", "b"], (1.0, [1.0, 0.5])))
    sim.run(2.2)
    assert plugin.position("a") == pytest.approx(0.4, abs=0.01)
    held = plugin.position("a")
    sim.run(1.0)
    assert plugin.position("a") == pytest.approx(held)


def test_a_timeout_up_to_the_goal_time_is_ignored_with_a_warning() -> None:
    _, plugin = arm({"cmd_timeout": 0.2})
    assert codes(plugin) == ["SK-CONTROL-023"]


def test_deactivation_ends_the_goal() -> None:
    sim, plugin = arm()
    goal = send(sim, (1.0, [1.0, 0.5]))
    sim.run(0.5)
    plugin.controller.deactivate()
    assert goal.status is GoalStatus.ABORTED
    assert goal.result.error_string == "Current goal cancelled during deactivate transition."
    late = send(sim, (1.0, [1.0, 0.5]))
    sim.step()
    assert (late.status, late.reason) == (
        GoalStatus.REJECTED,
        "Can't accept new action goals. Controller is not running.",
    )


# ---------------------------------------------------------------------- bad input


@pytest.mark.parametrize(
    ("joints", "points", "reason"),
    [
        (["a"], [(1.0, [1.0])], "Joints on incoming trajectory don't match the controller joints."),
        (["a", "c"], [(1.0, [1.0, 1.0])], "Incoming joint c doesn't match the controller's joints."),
        (["a", "a"], [(1.0, [1.0, 1.0])], "Joint a comes twice on incoming trajectory."),
        (["a", "b"], [], "Empty trajectory received."),
        (
            ["a", "b"],
            [(1.0, [1.0, 1.0]), (1.0, [1.0, 1.0])],
            "Time between points 0 and 1 is not strictly increasing, it is 1.000000 and 1.000000 respectively",
        ),
        (["a", "b"], [(-1.0, [1.0, 1.0])], "Point #0 is at -1.000000 s: before the start."),
        (["a", "b"], [(1.0, [1.0])], "Mismatch between joint_names size (2) and positions (1) at point #0."),
        (["a", "b"], [(1.0, [])], "Mismatch between joint_names size (2) and positions (0) at point #0."),
        (
            ["a", "b"],
            [(1.0, [1.0, 1.0], [0.0])],
            "Mismatch between joint_names size (2) and velocities (1) at point #0.",
        ),
        (["a", "b"], [(1.0, [math.nan, 1.0])], "The positions at point #0 are not all finite numbers."),
        (
            ["a", "b"],
            [(1.0, [1.0, 1.0], [0.0, 0.2])],
            "Velocity of last trajectory point of joint b is not zero: 0.200000000000000",
        ),
    ],
)
def test_an_invalid_trajectory_is_rejected_with_the_reason_and_changes_nothing(
    joints: list[str], points: list[Any], reason: str
) -> None:
    sim, plugin = arm()
    running = send(sim, (1.0, [1.0, 0.5]))
    sim.run(0.5)
    goal = send(sim, *points, joints=joints)
    sim.publish(TOPIC, trajectory(joints, *points))
    sim.run(0.6)
    assert (goal.status, goal.reason) == (GoalStatus.REJECTED, reason)
    assert running.status is GoalStatus.SUCCEEDED
    assert plugin.position("a") == 1.0
    assert [d.code for d in sim.diagnostics] == ["SK-CONTROL-020"]


def test_a_trajectory_that_ends_in_the_past_is_rejected() -> None:
    sim, _ = arm()
    sim.run(3.0)
    goal = send(sim, (1.0, [1.0, 0.5]), stamp=1.0)
    sim.step()
    ends = "Received trajectory with non-zero start time (1.000000) that ends in the past (2.000000)"
    assert (goal.status, goal.reason) == (GoalStatus.REJECTED, ends)


def test_a_goal_outside_the_limits_ends_there_with_the_goal_tolerance_violated() -> None:
    sim, plugin = arm({"constraints": {"goal_time": 0.5, "a": {"goal": 0.02}}}, limits={"a": (-1.0, 1.0)})
    goal = send(sim, (1.0, [1.5, 0.5]))
    sim.run(1.7)
    assert (goal.status, goal.result.error_code) == (GoalStatus.ABORTED, -5)
    assert plugin.position("a") == 1.0
    (said,) = sim.diagnostics
    assert said.code == "SK-CONTROL-021"
    assert "moves joint 'a' to 1.5, but its limits are -1 and 1" in said.message


def test_tolerances_with_an_unknown_joint_are_ignored() -> None:
    sim, _ = arm(most={"a": 0.005})
    goal = send(sim, (1.0, [1.0, 0.5]), path_tolerance=[{"name": "z", "position": -1.0}])
    sim.run(1.0)
    assert goal.result.error_code == -4
    assert "Path tolerance specified for unknown joint 'z'" in sim.diagnostics[0].message


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"joints": []}, "'joints' parameter is empty."),
        ({"joints": ["a", "a"]}, "'a' occurs twice in 'joints'"),
        ({"command_interfaces": []}, "'command_interfaces' parameter is empty."),
        ({"command_interfaces": ["velocity", "effort"]}, "'command_interfaces' are velocity, effort"),
        ({"state_interfaces": ["velocity"]}, "'state_interfaces' are velocity"),
        ({"command_interfaces": ["effort"], "state_interfaces": ["position"]}, "can only be used alone if"),
        ({"command_joints": ["c"]}, "'command_joints' parameter must have the same size"),
    ],
)
def test_invalid_parameters_have_different_messages(values: dict[str, Any], message: str) -> None:
    _, plugin = arm(values)
    assert "SK-CONTROL-024" in codes(plugin)
    assert any(message in d.message for d in plugin.diagnostics)
