"""Settings of plans: tolerances, factors of limits, constraints and the planner."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from simkit_nodes.ros1_modules.moveit_commander.exception import MoveItCommanderException
from simkit_nodes.ros1_modules.moveit_commander.move_group_client import new_message
from simkit_nodes.ros1_modules.rospy.client import get_param, search_param

__all__: list[str] = []

_SLOW: Final = 0.1  # MoveIt's factor of speeds and accelerations without a parameter


class GroupSettings:
    """Settings of the plans of a group.

    Args:
        parameters: name of the parameters with the default factors of limits.
    """

    def __init__(self, parameters: str) -> None:
        self._tolerances = [1e-4, 1e-4, 1e-3]  # of joints, positions and orientations
        self._path_constraints = new_message("moveit_msgs/Constraints")
        self._trajectory_constraints = new_message("moveit_msgs/TrajectoryConstraints")
        self._planning_time, self._attempts = 5.0, 1
        self._planner, self._pipeline, self._support_surface = "", "", ""
        self._looks_around = self._replans = False
        self._workspace: list[float] = []
        self._speed = _default_factor(f"{parameters}/default_velocity_scaling_factor")
        self._acceleration = _default_factor(f"{parameters}/default_acceleration_scaling_factor")
        self._tip_speed, self._tip_speed_link = 0.0, ""

    def set_support_surface_name(self, value: str) -> None:
        """Set the name of the surface for `place`."""
        self._support_surface = value

    def get_goal_tolerance(self) -> tuple[float, float, float]:
        """Return the tolerances of joints, positions and orientations."""
        return self._tolerances[0], self._tolerances[1], self._tolerances[2]

    def get_goal_joint_tolerance(self) -> float:
        """Return the tolerance of joints [rad or m]."""
        return self._tolerances[0]

    def get_goal_position_tolerance(self) -> float:
        """Return the tolerance of positions [m]."""
        return self._tolerances[1]

    def get_goal_orientation_tolerance(self) -> float:
        """Return the tolerance of orientations [rad]."""
        return self._tolerances[2]

    def set_goal_tolerance(self, value: float) -> None:
        """Set all tolerances."""
        self._tolerances = [float(value)] * 3

    def set_goal_joint_tolerance(self, value: float) -> None:
        """Set the tolerance of joints [rad or m]."""
        self._tolerances[0] = float(value)

    def set_goal_position_tolerance(self, value: float) -> None:
        """Set the tolerance of positions [m]."""
        self._tolerances[1] = float(value)

    def set_goal_orientation_tolerance(self, value: float) -> None:
        """Set the tolerance of orientations [rad]."""
        self._tolerances[2] = float(value)

    def allow_looking(self, value: bool) -> None:
        """Allow that the robot looks around; without an effect in simkit."""
        self._looks_around = bool(value)

    def allow_replanning(self, value: bool) -> None:
        """Allow a new plan during the motion; without an effect in simkit."""
        self._replans = bool(value)

    def get_known_constraints(self) -> list[str]:
        """Return the names of constraints in a database: none."""
        return []

    def get_path_constraints(self) -> Any:
        """Return the constraints of the path."""
        return self._path_constraints

    def set_path_constraints(self, value: Any) -> None:
        """Set constraints of the path, a `Constraints`; None for none.

        Raises:
            MoveItCommanderException: the value is the name of constraints in a database.
        """
        if isinstance(value, str):
            raise MoveItCommanderException(f"Unable to set path constraints {value}")
        self._path_constraints = value or new_message("moveit_msgs/Constraints")

    def clear_path_constraints(self) -> None:
        """Remove the constraints of the path."""
        self._path_constraints = new_message("moveit_msgs/Constraints")

    def get_trajectory_constraints(self) -> Any:
        """Return the constraints of the trajectory."""
        return self._trajectory_constraints

    def set_trajectory_constraints(self, value: Any) -> None:
        """Set constraints of the trajectory, a `TrajectoryConstraints`; None for none."""
        self._trajectory_constraints = value or new_message("moveit_msgs/TrajectoryConstraints")

    def clear_trajectory_constraints(self) -> None:
        """Remove the constraints of the trajectory."""
        self._trajectory_constraints = new_message("moveit_msgs/TrajectoryConstraints")

    def set_planning_time(self, seconds: float) -> None:
        """Set the longest time of a plan [s]."""
        self._planning_time = float(seconds)

    def get_planning_time(self) -> float:
        """Return the longest time of a plan [s]."""
        return self._planning_time

    def set_planning_pipeline_id(self, planning_pipeline: str) -> None:
        """Set the name of the planning pipeline; simkit has one planner."""
        self._pipeline = planning_pipeline

    def get_planning_pipeline_id(self) -> str:
        """Return the name of the planning pipeline."""
        return self._pipeline

    def set_planner_id(self, planner_id: str) -> None:
        """Set the name of the planner; simkit has one planner."""
        self._planner = planner_id

    def get_planner_id(self) -> str:
        """Return the name of the planner."""
        return self._planner

    def set_num_planning_attempts(self, num_planning_attempts: int) -> None:
        """Set the number of plans of which the shortest counts."""
        self._attempts = int(num_planning_attempts)

    def set_workspace(self, ws: Sequence[float]) -> None:
        """Set the workspace: 0, 4 or 6 numbers."""
        if len(ws) not in (0, 4, 6):
            raise MoveItCommanderException("Expected 0, 4 or 6 values in list specifying workspace")
        self._workspace = [ws[0], ws[1], 0.0, ws[2], ws[3], 0.0] if len(ws) == 4 else list(ws)

    def set_max_velocity_scaling_factor(self, value: float) -> None:
        """Set the factor of the speed limits, from 0 (exclusive) to 1."""
        self._speed = _checked_factor(value)

    def set_max_acceleration_scaling_factor(self, value: float) -> None:
        """Set the factor of the acceleration limits, from 0 (exclusive) to 1."""
        self._acceleration = _checked_factor(value)

    def limit_max_cartesian_link_speed(self, speed: float, link_name: str = "") -> None:
        """Set the largest speed of a link along straight lines [m/s]."""
        if speed <= 0.0:
            raise MoveItCommanderException("Expected speed value to be greater than 0")
        self._tip_speed, self._tip_speed_link = float(speed), link_name

    def clear_max_cartesian_link_speed(self) -> None:
        """Remove the largest speed of a link."""
        self._tip_speed, self._tip_speed_link = 0.0, ""


def _default_factor(name: str) -> float:
    found = search_param(name)
    value = get_param(found, _SLOW) if found is not None else _SLOW
    return float(value) if isinstance(value, (int, float)) and 0.0 < value <= 1.0 else _SLOW


def _checked_factor(value: float) -> float:
    if not 0.0 < value <= 1.0:
        raise MoveItCommanderException(f"found the scaling factor {value:g}; expected a number from 0 (exclusive) to 1")
    return float(value)
