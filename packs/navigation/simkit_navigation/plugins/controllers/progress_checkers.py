"""Progress checkers of the controller server, as those of Nav2's `nav2_controller/plugins`."""

from __future__ import annotations

import math
from typing import Final

from simkit import Params
from simkit.extend import Options, number
from simkit.pose import wrap_angle
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose


class ProgressCheckerOptions(Options):
    """Options of the progress checkers; only `PoseProgressChecker` uses the angle."""

    required_movement_radius: float = number(0.5, "m", minimum=0)
    required_movement_angle: float = number(0.5, "rad", minimum=0)
    movement_time_allowance: float = number(10.0, "s", minimum=0)


class SimpleProgressChecker:
    """Checks that the robot moves by a distance in a time.

    Args:
        params: block of parameters.
    """

    def __init__(self, params: Params) -> None:
        self.options = ProgressCheckerOptions(params).read_all()
        self._begin: tuple[int, PlanarPose] | None = None

    def reset(self) -> None:
        """Begin again with the next pose."""
        self._begin = None

    def makes_progress(self, pose: PlanarPose, time_ns: int) -> bool:
        """Check whether the robot has moved enough in the allowed time.

        Args:
            pose: pose of the robot.
            time_ns: time of the pose [ns].
        """
        if self._begin is None or self._has_moved(self._begin[1], pose):
            self._begin = time_ns, pose
            return True
        return time_ns - self._begin[0] <= self.options.movement_time_allowance * 1e9

    def _has_moved(self, before: PlanarPose, pose: PlanarPose) -> bool:
        return math.hypot(pose.x - before.x, pose.y - before.y) > self.options.required_movement_radius


class PoseProgressChecker(SimpleProgressChecker):
    """Checks that the robot moves by a distance, or turns by an angle, in a time."""

    def _has_moved(self, before: PlanarPose, pose: PlanarPose) -> bool:
        angle = abs(wrap_angle(pose.yaw - before.yaw))
        return super()._has_moved(before, pose) or angle > self.options.required_movement_angle


PROGRESS_CHECKERS: Final[dict[str, type[SimpleProgressChecker]]] = {
    "nav2_controller::SimpleProgressChecker": SimpleProgressChecker,
    "nav2_controller::PoseProgressChecker": PoseProgressChecker,
}
"""Progress checkers by their name in Nav2."""
