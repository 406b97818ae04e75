"""Trajectory controller of two joints that follow commands at once, for tests."""

from __future__ import annotations

from typing import Any

from perfect_joints import PerfectJoints, host, trajectory

from simkit_control.controllers import joint_trajectory

FOLLOW = "/arm_controller/follow_joint_trajectory"
TOPIC = "/arm_controller/joint_trajectory"
BASIC: dict[str, Any] = {
    "joints": ["a", "b"],
    "command_interfaces": ["position"],
    "state_interfaces": ["position", "velocity"],
}
CONSTRAINTS = {"goal_time": 0.5, "a": {"trajectory": 0.1, "goal": 0.02}, "b": {"goal": 0.02}}
START = {"a": 0.0, "b": 0.5}


def arm(values: dict[str, Any] | None = None, **options: Any) -> tuple[Any, PerfectJoints]:
    cls = options.pop("cls", joint_trajectory.JointTrajectoryController)
    start = options.pop("start", START)
    return host(cls, {**BASIC, "constraints": CONSTRAINTS, **(values or {})}, start, **options)


def send(sim: Any, *points: Any, joints: list[str] | None = None, stamp: float = 0.0, **more: Any) -> Any:
    return sim.send_goal(FOLLOW, {"trajectory": trajectory(joints or ["a", "b"], *points, stamp=stamp), **more})


def codes(plugin: PerfectJoints) -> list[str]:
    return [d.code for d in plugin.diagnostics]
