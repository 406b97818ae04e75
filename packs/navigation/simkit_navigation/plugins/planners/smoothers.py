"""Smoothers of paths, as those of Nav2's `nav2_smoother`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from simkit import Params
from simkit.extend import Options, boolean, integer, number
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.navigation.planar_pose import Floats
from simkit_navigation.plugins.planners.path_smoothing import (
    Relaxation,
    directional_segments,
    facing_poses,
    filtered,
    is_reversed,
    relax,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from simkit import Plugin

_LEAST_STEPS = 4  # of a part of a path that the simple smoother changes, as in Nav2
_LEAST_STEPS_OF_FILTER = 10


class Smoother(Protocol):
    """Smoother of paths; a class of a user needs only `smooth`."""

    def configure(self, node: Plugin, params: Params) -> None:
        """Read the parameters of the smoother; called once.

        Args:
            node: plugin of the smoother.
            params: block of parameters with the name of the smoother.
        """

    def smooth(self, path: Floats, grid: CostGrid) -> Floats | Sequence[Sequence[float]] | None:
        """Return the poses of the smoothed path: (x, y) or (x, y, yaw) [m, rad] for each pose; None if that fails.

        Args:
            path: x, y [m] and yaw [rad] of each pose, shape (n, 3).
            grid: costs in the frame of the path.
        """


class SimpleSmootherOptions(Options):
    """Options of `SimpleSmoother`."""

    tolerance: float = number(1e-10, "m", minimum=0)
    max_its: int = integer(1000, minimum=0)
    w_data: float = number(0.2, minimum=0)
    w_smooth: float = number(0.3, minimum=0)
    do_refinement: bool = boolean(True)
    refinement_num: int = integer(2, minimum=0)
    enforce_path_inversion: bool = boolean(True)


class SimpleSmoother:
    """Moves each pose towards the middle of its neighbours (`nav2_smoother::SimpleSmoother`).

    It smooths the parts between reversals of the direction one by one, unless `<enforce_path_inversion>` is false. It
    stops before the path touches an obstacle.
    """

    def configure(self, node: Plugin, params: Params) -> None:
        """Read the parameters."""
        options = SimpleSmootherOptions(params).read_all()
        refinements = options.refinement_num if options.do_refinement else 0
        self._keeps_inversions = options.enforce_path_inversion
        self._settings = Relaxation(options.w_data, options.w_smooth, options.tolerance, options.max_its, refinements)

    def smooth(self, path: Floats, grid: CostGrid) -> Floats:
        """Return the poses of the smoothed path, shape (n, 3) [m, rad]."""
        smooth = path.copy()
        for first, last in directional_segments(path) if self._keeps_inversions else [(0, len(path) - 1)]:
            if last - first >= _LEAST_STEPS:
                part = path[first : last + 1]
                points = relax(part[:, :2], grid, self._settings)
                smooth[first : last + 1] = facing_poses(points, float(part[-1, 2]), is_reversed(part))
        return smooth


class SavitzkyGolaySmootherOptions(Options):
    """Options of `SavitzkyGolaySmoother`."""

    do_refinement: bool = boolean(True)
    refinement_num: int = integer(2, minimum=0)
    enforce_path_inversion: bool = boolean(True)


class SavitzkyGolaySmoother:
    """Fits each seven poses by a cubic polynomial (`nav2_smoother::SavitzkyGolaySmoother`).

    It removes small noise, keeps the shape of the path, and looks at no obstacle, as in Nav2.
    """

    def configure(self, node: Plugin, params: Params) -> None:
        """Read the parameters."""
        options = SavitzkyGolaySmootherOptions(params).read_all()
        self._keeps_inversions = options.enforce_path_inversion
        self._repetitions = 1 + (options.refinement_num if options.do_refinement else 0)

    def smooth(self, path: Floats, grid: CostGrid) -> Floats:
        """Return the poses of the smoothed path, shape (n, 3) [m, rad]."""
        smooth = path.copy()
        for first, last in directional_segments(path) if self._keeps_inversions else [(0, len(path) - 1)]:
            if last - first >= _LEAST_STEPS_OF_FILTER:
                part = path[first : last + 1]
                points = filtered(part[:, :2], self._repetitions)
                smooth[first : last + 1] = facing_poses(points, float(part[-1, 2]), is_reversed(part))
        return smooth
