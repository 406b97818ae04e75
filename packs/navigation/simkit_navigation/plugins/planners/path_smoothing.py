"""Smoothing of paths, with the methods of Nav2's `nav2_smoother` and of the smoother in `nav2_smac_planner`."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from simkit.elementary_functions import arctan2
from simkit.pose import wrap_angle
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.navigation.planar_pose import Floats

_BATCH: Final = 32  # iterations whose points are checked for obstacles together
_SAME_PLACE: Final = 1e-4  # [m]; poses that are nearer to each other are one place, as in Nav2
_SAVITZKY_GOLAY: Final = (-2.0, 3.0, 6.0, 7.0, 6.0, 3.0, -2.0)
"""Weights, in 21st parts, of seven points that are fitted by a cubic polynomial (Savitzky and Golay 1964, table I)."""
_LEAST_POINTS: Final = 11  # of a path that the filter changes, as in Nav2


@dataclass(frozen=True)
class Relaxation:
    """Settings of `relax`.

    Attributes:
        w_data: weight of the distance from the original point.
        w_smooth: weight of the distance from the middle of the neighbours.
        tolerance: change of a coordinate in an iteration at which the path is smooth [m].
        max_its: iterations at which the smoothing ends.
        refinements: repetitions with the smoothed path as original.
    """

    w_data: float
    w_smooth: float
    tolerance: float
    max_its: int
    refinements: int


def relax(points: Floats, grid: CostGrid | None, settings: Relaxation) -> Floats:
    """Return points that are moved towards the middle of their neighbours, shape (n, 2); both ends stay.

    Nav2's `SimpleSmoother` moves the points by w_data·(original - point) + w_smooth·(sum of neighbours - 2·point), one
    after the other, until the sum of the changes is below the tolerance. Here, all odd points move together, then all
    even ones, and the largest change counts; both have the same limit. The path before the first iteration that
    touches an obstacle is returned.
    """
    for _ in range(settings.refinements + 1):
        points, is_done = _relax(points, grid, settings)
        if not is_done:
            break
    return points


def _relax(original: Floats, grid: CostGrid | None, settings: Relaxation) -> tuple[Floats, bool]:
    """Return the points after one smoothing, and whether it has come to its end."""
    present, iteration = original, 1
    while True:
        batch, is_smooth = [present], False
        while len(batch) <= _BATCH and iteration < settings.max_its and not is_smooth:
            iteration += 1
            batch.append(_moved(batch[-1], original, settings))
            is_smooth = bool(np.abs(batch[-1] - batch[-2]).max() < settings.tolerance)
        if grid is not None and len(batch) > 1:
            blocked = grid.is_blocked(np.concatenate(batch[1:])).reshape(len(batch) - 1, -1).any(axis=1)
            if blocked.any():
                return batch[int(blocked.argmax())], False
        present = batch[-1]
        if is_smooth or iteration >= settings.max_its:
            return present, is_smooth


def _moved(points: Floats, original: Floats, settings: Relaxation) -> Floats:
    """Return the points after one iteration."""
    moved = points.copy()
    for first in (1, 2):
        here = moved[first:-1:2]
        neighbours = moved[first - 1 : -2 : 2] + moved[first + 1 :: 2]
        step = settings.w_data * (original[first:-1:2] - here) + settings.w_smooth * (neighbours - 2.0 * here)
        moved[first:-1:2] = here + step
    return moved


def filtered(points: Floats, repetitions: int) -> Floats:
    """Return points on which the Savitzky-Golay filter of seven points was applied, shape (n, 2); both ends stay."""
    if len(points) < _LEAST_POINTS:
        return points
    for _ in range(repetitions):
        wide = np.concatenate((points[:1], points[:1], points[:1], points, points[-1:], points[-1:], points[-1:]))
        total = np.zeros(points.shape)
        for index, weight in enumerate(_SAVITZKY_GOLAY):
            total = total + weight / 21.0 * wide[index : index + len(points)]
        total[0], total[-1] = points[0], points[-1]
        points = total
    return points


def directional_segments(poses: Floats) -> list[tuple[int, int]]:
    """Return first and last index of the parts of a path between reversals of the direction and turns on the spot.

    Args:
        poses: x, y [m] and yaw [rad] of each pose, shape (n, 3).
    """
    steps = np.diff(poses[:, :2], axis=0)
    if len(steps) < 2:
        return [(0, len(poses) - 1)]
    reverses = (steps[:-1] * steps[1:]).sum(axis=1) < 0.0
    is_still = (np.abs(steps[1:]) < _SAME_PLACE).all(axis=1)
    turns = np.array([abs(wrap_angle(turn)) > _SAME_PLACE for turn in np.diff(poses[1:, 2]).tolist()], bool)
    ends = [int(index) + 1 for index in np.flatnonzero(reverses | (is_still & turns))]
    marks = [0, *ends, len(poses) - 1]
    return list(itertools.pairwise(marks))


def facing_poses(points: Floats, last: float | None, is_reverse: bool = False) -> Floats:
    """Return points as poses that look at their next pose, shape (n, 3) [m, rad].

    Args:
        points: x and y [m], shape (n, 2).
        last: yaw of the last pose [rad]; None for the direction in which the path arrives.
        is_reverse: True for poses that look away from their next pose.
    """
    ahead = np.diff(points, axis=0)
    yaws = arctan2(ahead[:, 1], ahead[:, 0]).tolist()
    is_still = np.all(np.abs(ahead) < _SAME_PLACE, axis=1)
    for index in range(1, len(yaws)):  # poses at one place have one yaw
        if is_still[index]:
            yaws[index] = yaws[index - 1]
    if is_reverse:
        yaws = [wrap_angle(yaw + math.pi) for yaw in yaws]
    end = last if last is not None else yaws[-1] if yaws else 0.0
    return np.column_stack((points, [*yaws, end]))


def is_reversed(poses: Floats) -> bool:
    """Check whether a robot drives backwards along a path, shape (n, 3), as Nav2 does at its second pose."""
    if len(poses) < 3:
        return False
    x, y = (poses[2, :2] - poses[1, :2]).tolist()
    return abs(wrap_angle(float(poses[1, 2]) - math.atan2(y, x))) > math.pi / 2


def poses_of_result(result: object, last: float, method: str) -> Floats | None:
    """Return what a method of a planner or smoother has returned as poses, shape (n, 3) [m, rad]; None for no path.

    Args:
        result: result of the method, which may be in a class of a user; poses without yaw look at their next pose.
        last: yaw of the last pose, if the result has no yaw [rad].
        method: name of the method, for the message.

    Raises:
        ValueError: the result is something else.
    """
    try:
        poses = np.array([] if result is None else [tuple(pose) for pose in result], np.float64)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        poses = np.zeros((1, 0))
    if not len(poses):
        return None
    if poses.ndim != 2 or poses.shape[1] not in (2, 3) or not np.isfinite(poses).all():
        raise ValueError(f"{method} must return finite (x, y) or (x, y, yaw) for each pose of the path, or None")
    return poses if poses.shape[1] == 3 else facing_poses(poses, last)
