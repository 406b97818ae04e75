"""Robots of launch files that start no simulator: `robot_state_publisher` shows its robot in the empty world."""

from __future__ import annotations

from typing import Final

from simkit_launch.known_programs import known_program
from simkit_launch.launch_plan import LaunchedProcess, LaunchPlan

SHOWN_ROBOT: Final = "SIMKIT_SHOWN_ROBOT"
"""Variable of the environment that tells `robot_state_publisher` to show its robot."""
_PUBLISHER: Final = "robot_state_publisher"
_SPAWNERS: Final = frozenset(("create", "spawn_entity", "spawn_model"))
"""Programs of known nodes that spawn a model in the world of a simulator."""
_CONTROL: Final = "ros2_control_node"


def shows_robot(process: LaunchedProcess, plan: LaunchPlan, *, has_simulator: bool) -> bool:
    """Check whether a process is a `robot_state_publisher` of a launch file without a simulator and a spawned robot.

    Args:
        process: process.
        plan: its plan.
        has_simulator: True if the launch file starts a simulator.
    """
    if has_simulator or known_program(process) != _PUBLISHER:
        return False
    return not any(known_program(other) in (*_SPAWNERS, _CONTROL) for other in plan.processes)


def spawns_model(plan: LaunchPlan) -> bool:
    """Check whether a launch file spawns a model as in a simulator."""
    return any(known_program(process) in _SPAWNERS for process in plan.processes)
