"""Gripper action on a joint that follows commands at once until an object blocks it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from control_robots import ALL, arm, interfaces, opened, reported_messages
from perfect_joints import PerfectJoints, host

from simkit.msgs.goal_status import GoalStatus
from simkit_control.controllers import gripper_action

ACTION = "/arm_controller/gripper_cmd"


def gripper(values: dict[str, Any] | None = None, **options: Any) -> tuple[Any, PerfectJoints]:
    cls = options.pop("cls", gripper_action.GripperActionController)
    given = {"joint": "finger", "goal_tolerance": 0.001, "stall_timeout": 0.3, **(values or {})}
    return host(cls, given, {"finger": 0.0}, **{"most": {"finger": 0.0005}, **options})


def close(sim: Any, position: float, effort: float = 0.0) -> Any:
    return sim.send_goal(ACTION, {"command": {"position": position, "max_effort": effort}})


def test_a_goal_succeeds_within_its_tolerance() -> None:
    sim, plugin = gripper()
    goal = close(sim, 0.04, 10.0)
    sim.run(0.75)
    assert goal.status is GoalStatus.EXECUTING
    assert goal.feedback.position == pytest.approx(plugin.position("finger"), abs=0.003)
    sim.run(0.1)
    assert goal.status is GoalStatus.SUCCEEDED
    assert goal.result.reached_goal and not goal.result.stalled
    assert goal.result.position == pytest.approx(0.04, abs=0.001)
    assert goal.result.effort == 10.0
    assert plugin.position("finger") == pytest.approx(0.04)


@pytest.mark.parametrize(("allowed", "status"), [(False, GoalStatus.ABORTED), (True, GoalStatus.SUCCEEDED)])
def test_a_stalled_joint_ends_the_goal_and_the_gripper_keeps_pressing(allowed: bool, status: GoalStatus) -> None:
    sim, plugin = gripper({"allow_stalling": allowed}, most={"finger": 0.0})
    goal = close(sim, 0.04)
    sim.run(0.3)
    assert goal.status is GoalStatus.EXECUTING
    sim.run(0.05)
    assert (goal.status, goal.result.stalled, goal.result.reached_goal) == (status, True, False)
    assert goal.reason == "Stall detected moving to goal, 0.04 away from it."
    assert plugin.commanded[-1] == [0.04]


def test_a_cancelled_goal_leaves_the_joint_where_it_is() -> None:
    sim, plugin = gripper()
    goal = close(sim, 0.04)
    sim.run(0.2)
    goal.cancel()
    sim.run(0.02)
    held = plugin.position("finger")
    sim.run(0.5)
    assert goal.status is GoalStatus.CANCELED
    assert plugin.position("finger") == held
    assert held == pytest.approx(0.01, abs=0.001)


def test_a_second_goal_replaces_the_first() -> None:
    sim, plugin = gripper()
    first = close(sim, 0.04)
    sim.run(0.2)
    second = close(sim, 0.0)
    sim.run(0.5)
    assert (first.status, second.status) == (GoalStatus.CANCELED, GoalStatus.SUCCEEDED)
    assert plugin.position("finger") == pytest.approx(0.0, abs=1e-9)


def test_nan_is_rejected_and_a_goal_outside_the_limits_is_a_warning() -> None:
    sim, _ = gripper(limits={"finger": (0.0, 0.045)})
    assert_rejected = close(sim, math.nan)
    sim.step()
    assert (assert_rejected.status, assert_rejected.reason) == (
        GoalStatus.REJECTED,
        "The command is not a finite number.",
    )
    goal = close(sim, 0.1)
    sim.run(1.5)
    assert goal.result.stalled
    assert [d.code for d in sim.diagnostics] == ["SK-CONTROL-021"]


def test_deactivation_ends_the_goal_and_rejects_new_goals() -> None:
    sim, plugin = gripper()
    goal = close(sim, 0.04)
    sim.run(0.2)
    plugin.controller.deactivate()
    late = close(sim, 0.04)
    sim.step()
    assert (goal.status, late.status) == (GoalStatus.ABORTED, GoalStatus.REJECTED)


def test_the_effort_of_the_pid_stays_within_the_goals_limit() -> None:
    values = {"gains": {"finger": {"p": 200.0, "i": 1.0, "d": 5.0, "i_clamp": 1.0}}, "max_effort": 8.0}
    sim, plugin = gripper(values, cls=gripper_action.EffortGripperActionController, most={"finger": 0.0})
    sim.step()
    assert plugin.commanded[-1] == [0.0]
    goal = close(sim, 0.04, 3.0)
    sim.run(0.1)
    assert plugin.commanded[-1] == [3.0]
    goal.cancel()
    sim.run(0.1)
    assert plugin.commanded[-1] == [pytest.approx(0.0, abs=0.01)]


def test_the_parallel_gripper_accepts_a_joint_state_with_speed_and_effort() -> None:
    sim, plugin = gripper(
        {"max_velocity_interface": "velocity", "max_effort_interface": "effort", "max_effort": 2.0},
        cls=gripper_action.ParallelGripperActionController,
        most={"finger": 0.001},
    )
    goal = sim.send_goal(ACTION, {"command": {"name": ["finger"], "position": [0.02], "effort": [5.0]}})
    sim.run(0.1)
    assert plugin.commanded[-1] == [0.02, 0.0, 5.0]
    sim.run(0.2)
    assert goal.status is GoalStatus.SUCCEEDED
    assert goal.result.state.position[0] == pytest.approx(0.02, abs=0.001)
    empty = sim.send_goal(ACTION, {"command": {"name": ["finger"]}})
    sim.step()
    assert (empty.status, empty.reason) == (GoalStatus.REJECTED, "The command has no position.")


def test_a_gripper_without_a_joint_is_an_error() -> None:
    _, plugin = gripper({"joint": ""})
    assert [d.code for d in plugin.diagnostics] == ["SK-CONTROL-026"]


def test_an_effort_gripper_without_gains_is_a_warning(tmp_path: Path) -> None:
    yaml = (
        "controller_manager:\n  ros__parameters:\n    grip: {type: effort_controllers/GripperActionController}\n"
        "grip:\n  ros__parameters: {joint: j1}\n"
    )
    with opened(tmp_path, arm(f'<joint name="j1">{interfaces(ALL)}</joint>'), yaml) as sim:
        assert "gains of joint 'j1' are all 0" in reported_messages(sim, "SK-CONTROL-026")[0]
