"""Part of a path near the robot, as the path handlers of Nav2's controllers select it."""

from __future__ import annotations

import itertools
import math

import numpy as np

from simkit.pose import wrap_angle
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose


class LocalPath:
    """Path that is followed, without the poses that the robot has passed.

    The rules are those of `nav2_mppi_controller/src/path_handler.cpp` (Jazzy).

    Args:
        poses: x, y [m] and yaw [rad] of each pose, shape (n, 3).
        turns: stop at each point where the direction of motion reverses, and go on only after the robot is there.
        xy_tolerance: distance at which such a point is reached [m].
        yaw_tolerance: angle at which such a point is reached [rad].
    """

    def __init__(
        self, poses: Floats, turns: bool = False, xy_tolerance: float = 0.2, yaw_tolerance: float = 0.4
    ) -> None:
        self._poses, self._turns = poses, turns
        self._tolerances = xy_tolerance, yaw_tolerance
        self._distances = distances_along(poses)
        self._begin = 0
        self._end = self._next_end(0)

    @property
    def goal(self) -> PlanarPose:
        """Last pose of the path."""
        return PlanarPose(*self._poses[-1].tolist())

    def _next_end(self, begin: int) -> int:
        return begin + first_inversion(self._poses[begin:]) if self._turns else len(self._poses)

    def advance(self, pose: PlanarPose, search: float, prune: float, grid: CostGrid | None) -> Floats:
        """Forget the poses before the nearest one, and return the poses from it on.

        Args:
            pose: pose of the robot in the frame of the path.
            search: distance along the path within which the nearest pose is searched [m].
            prune: distance along the path within which poses are returned [m].
            grid: costs whose area the returned poses must not leave; None for no such limit.
        """
        begin = self._begin
        last = self._within(begin, search)
        squares = (self._poses[begin:last, 0] - pose.x) ** 2 + (self._poses[begin:last, 1] - pose.y) ** 2
        begin = self._begin = begin + int(squares.argmin())
        poses = self._poses[begin : self._within(begin, prune)]
        if grid is not None:
            outside = np.flatnonzero(~grid.indices(poses[:, :2])[2])
            poses = poses[: outside[0]] if len(outside) else poses
        if self._end < len(self._poses) and self._is_at_inversion(pose):
            self._begin, self._end = self._end, self._next_end(self._end)
        return poses

    def _within(self, begin: int, distance: float) -> int:
        """Return the end of the poses within a distance along the path [m]; there is at least one."""
        along = self._distances[begin : self._end]
        return begin + max(1, int(np.searchsorted(along, along[0] + distance, side="right")))

    def _is_at_inversion(self, pose: PlanarPose) -> bool:
        x, y, yaw = self._poses[self._end - 1].tolist()
        distance, angle = self._tolerances
        return math.hypot(pose.x - x, pose.y - y) <= distance and abs(wrap_angle(pose.yaw - yaw)) <= angle


def distances_along(poses: Floats) -> Floats:
    """Return the distance along a path from its first pose to each pose [m]."""
    steps = np.hypot(np.diff(poses[:, 0]), np.diff(poses[:, 1]))
    return np.array(list(itertools.accumulate(steps.tolist(), initial=0.0)))


def first_inversion(poses: Floats) -> int:
    """Return the number of poses up to the first point where the direction of motion reverses; all without one."""
    steps = np.diff(poses[:, :2], axis=0)
    products = steps[:-1, 0] * steps[1:, 0] + steps[:-1, 1] * steps[1:, 1]
    inversions = np.flatnonzero(products < 0.0)
    return int(inversions[0]) + 2 if len(inversions) else len(poses)
