"""A joint trajectory controller's interfaces, and what it tells of itself."""

from __future__ import annotations

import math
from typing import Any

import pytest
from followers import arm, codes, send
from perfect_joints import trajectory

from simkit.msgs.goal_status import GoalStatus
from simkit_control.controllers import joint_trajectory_kinds

# ---------------------------------------------------------------------- interfaces


def test_a_pid_reaches_the_goal_by_velocity_alone() -> None:
    gains = {"a": {"p": 8.0, "ff_velocity_scale": 1.0}, "b": {"p": 8.0, "i": 0.1, "i_clamp": 1.0}}
    sim, plugin = arm({"command_interfaces": ["velocity"], "gains": gains, "constraints": {}})
    send(sim, (2.0, [1.0, 0.0], [0.0, 0.0]))
    sim.run(1.0)
    assert plugin.position("a") == pytest.approx(0.5, abs=0.01)  # fed forward
    assert plugin.position("b") > 0.27  # lags
    sim.run(3.0)
    assert plugin.position("b") == pytest.approx(0.0, abs=0.02)


def test_position_and_velocity_are_commanded_together() -> None:
    sim, plugin = arm({"command_interfaces": ["velocity", "position"]})
    send(sim, (1.0, [1.0, 0.5]))
    sim.run(0.5)
    assert plugin.commanded[-1] == pytest.approx([0.5, 0.5, 1.0, 0.0])


def test_measured_joints_need_no_command_interface() -> None:
    sim, plugin = arm({"command_joints": ["b"]})
    goal = send(sim, (1.0, [0.0, 1.0]))
    sim.run(1.1)
    assert goal.status is GoalStatus.SUCCEEDED
    assert plugin.commanded[-1] == [1.0]


def test_the_ros_1_controllers_have_default_interfaces_and_their_topic() -> None:
    values = {"joints": ["a", "b"], "constraints": {}, "command_interfaces": [], "state_interfaces": []}
    sim, plugin = arm(values, cls=joint_trajectory_kinds.PositionJointTrajectoryController)
    sim.publish("/arm_controller/command", trajectory(["a", "b"], (1.0, [1.0, 0.0], [0.2, 0.0])))
    sim.run(1.1)
    assert plugin.position("a") == 1.0


# ---------------------------------------------------------------------- telling


def test_the_state_is_published_to_subscribers() -> None:
    sim, _ = arm()
    told: list[Any] = []
    sim.subscribe("/arm_controller/controller_state", told.append)
    send(sim, (1.0, [1.0, 0.5]))
    sim.run(0.5)
    last = told[-1]
    assert list(last.joint_names) == ["a", "b"]
    assert last.reference.positions[0] == pytest.approx(0.49)
    assert last.feedback.positions[0] == pytest.approx(0.49)
    assert last.output.positions[0] == pytest.approx(0.5)
    assert len(told) == 50 and last.speed_scaling_factor == 1.0
    sim.publish("/arm_controller/speed_scaling_input", {"factor": 0.25})
    sim.run(0.1)
    assert told[-1].speed_scaling_factor == 0.25


def test_the_desired_state_can_be_queried() -> None:
    sim, _ = arm()
    sim.run(1.0)
    send(sim, (1.0, [1.0, 0.5]))
    sim.run(0.02)
    answer = sim.call("/arm_controller/query_state", {"time": {"sec": 1, "nanosec": 500_000_000}})
    assert answer.success and list(answer.name) == ["a", "b"]
    assert answer.position[0] == pytest.approx(0.5)
    assert not sim.call("/arm_controller/query_state", {"time": {"sec": 0}}).success


def test_a_restored_run_continues_like_the_first() -> None:
    sim, plugin = arm()
    goal = send(sim, (1.0, [1.0, 0.5], [0.0, 0.0]))
    sim.run(0.3)
    saved = sim.snapshot()
    sim.run(0.3)
    ends = [plugin.position("a")]
    sim.restore(saved)
    sim.run(0.3)
    assert [plugin.position("a")] == ends
    sim.run(0.5)
    assert goal.status is GoalStatus.SUCCEEDED


def test_tolerances_and_gains_are_live_parameters() -> None:
    sim, _ = arm(most={"a": 0.005})
    sim.set_parameter("/arm_controller", "constraints.a.trajectory", 5.0)
    goal = send(sim, (1.0, [1.0, 0.5]))
    sim.run(0.9)
    assert goal.status is GoalStatus.EXECUTING
    gains = {"a": {"p": 0.0}, "b": {"p": 1.0}}
    sim, plugin = arm({"command_interfaces": ["velocity"], "gains": gains, "constraints": {}})
    send(sim, (0.1, [1.0, 0.5], [0.0, 0.0]))
    sim.run(0.5)
    assert plugin.position("a") == 0.0
    sim.set_parameter("/arm_controller", "gains.a.p", 5.0)
    sim.run(0.5)
    assert plugin.position("a") > 0.8


def test_the_integral_of_a_pid_is_restored_with_the_rest() -> None:
    gains = {"a": {"i": 2.0}, "b": {"p": 1.0}}
    sim, plugin = arm({"command_interfaces": ["velocity"], "gains": gains, "constraints": {}})
    send(sim, (0.1, [1.0, 0.5], [0.0, 0.0]))
    sim.run(0.3)
    saved = sim.snapshot()
    sim.run(0.3)
    once = plugin.commanded[-1]
    sim.restore(saved)
    sim.run(0.3)
    assert plugin.commanded[-1] == once


def test_older_parameter_names_are_read() -> None:
    older = {"stop_trajectory_duration": 0.5, "start_with_holding": True, "gains": {"a": {"angle_wraparound": True}}}
    sim, plugin = arm({**older, "constraints": {}}, start={"a": 6.2, "b": 0.5})
    assert not codes(plugin)
    goal = send(sim, (1.0, [0.1, 0.5], [0.0, 0.0]))
    sim.run(1.1)
    assert goal.status is GoalStatus.SUCCEEDED
    assert plugin.position("a") == pytest.approx(0.1 + 2 * math.pi)
    goal = send(sim, (2.0, [2.0 + 0.1, 0.5]))
    sim.run(1.0)
    goal.cancel()
    sim.run(1.0)
    assert plugin.position("a") == pytest.approx(2 * math.pi + 0.1 + 1.0 + 1.0 * 0.5 / 2, abs=0.02)


def test_huge_numbers_change_nothing() -> None:
    sim, plugin = arm()
    goal = send(sim, (1.0, [1e300, 0.5]))
    sim.publish("/arm_controller/speed_scaling_input", {"factor": 1e300})
    sim.run(0.1)
    assert (goal.status, goal.reason) == (GoalStatus.REJECTED, "The positions at point #0 are not all finite numbers.")
    assert "expected a number from 0 to 1000" in sim.diagnostics[0].message
    assert plugin.position("a") == 0.0
