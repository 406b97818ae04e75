"""Goal checkers of the controller server, as those of Nav2's `nav2_controller/plugins`."""

from __future__ import annotations

import math
from typing import Final

from simkit import Params
from simkit.extend import Options, boolean, number
from simkit.pose import wrap_angle
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose


class GoalCheckerOptions(Options):
    """Options of the goal checkers; `xy_goal_tolerance_buffer` and `path_length_tolerance` came with Rolling."""

    xy_goal_tolerance: float = number(0.25, "m", minimum=0)
    yaw_goal_tolerance: float = number(0.25, "rad", minimum=0)
    stateful: bool = boolean(True)
    symmetric_yaw_tolerance: bool = boolean(False)
    xy_goal_tolerance_buffer: float = number(0.0, "m", minimum=0)
    path_length_tolerance: float = number(math.inf, "m", minimum=0, finite=False)
    rot_stopped_velocity: float = number(0.25, "rad/s", minimum=0)
    trans_stopped_velocity: float = number(0.25, "m/s", minimum=0)


class PositionGoalChecker:
    """Checks the position only.

    Args:
        params: block of parameters.

    Attributes:
        options: options.
        is_at_position: True if the position is reached; a stateful checker keeps it until `reset`.
    """

    def __init__(self, params: Params) -> None:
        self.options = GoalCheckerOptions(params).read_all()
        self.is_at_position = False

    def reset(self) -> None:
        """Forget that the position was reached."""
        self.is_at_position = False

    def is_reached(
        self, pose: PlanarPose, goal: PlanarPose, speeds: tuple[float, float, float], remaining: float
    ) -> bool:
        """Check whether a goal is reached.

        Args:
            pose: pose of the robot.
            goal: goal in the same frame.
            speeds: measured speeds forward and to the left [m/s], turning rate [rad/s].
            remaining: length of the path that is not driven yet [m].
        """
        options, distance = self.options, math.hypot(goal.x - pose.x, goal.y - pose.y)
        limit = options.xy_goal_tolerance
        if options.stateful and self.is_at_position:
            buffer = options.xy_goal_tolerance_buffer
            limit = limit + buffer if buffer else math.inf
            self.is_at_position = distance <= limit
        else:
            self.is_at_position = remaining <= options.path_length_tolerance and distance <= limit
        return self.is_at_position and self._is_turned(pose, goal) and self._is_slow(speeds)

    def _is_turned(self, pose: PlanarPose, goal: PlanarPose) -> bool:
        return True

    def _is_slow(self, speeds: tuple[float, float, float]) -> bool:
        return True


class SimpleGoalChecker(PositionGoalChecker):
    """Checks position and yaw."""

    def _is_turned(self, pose: PlanarPose, goal: PlanarPose) -> bool:
        angle = abs(wrap_angle(goal.yaw - pose.yaw))
        if self.options.symmetric_yaw_tolerance:
            angle = min(angle, math.pi - angle)
        return angle <= self.options.yaw_goal_tolerance


class StoppedGoalChecker(SimpleGoalChecker):
    """Checks position, yaw and speeds."""

    def _is_slow(self, speeds: tuple[float, float, float]) -> bool:
        x, y, rate = speeds
        options = self.options
        return math.hypot(x, y) <= options.trans_stopped_velocity and abs(rate) <= options.rot_stopped_velocity


GOAL_CHECKERS: Final[dict[str, type[PositionGoalChecker]]] = {
    "nav2_controller::SimpleGoalChecker": SimpleGoalChecker,
    "nav2_controller::StoppedGoalChecker": StoppedGoalChecker,
    "nav2_controller::PositionGoalChecker": PositionGoalChecker,
}
"""Goal checkers by their name in Nav2."""
