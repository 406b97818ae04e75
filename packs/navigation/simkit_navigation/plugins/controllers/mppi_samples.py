"""Samples of the MPPI controller: noisy controls, the speeds that the robot reaches, and the trajectories.

All arrays have the type float32 and the shape (steps, samples), so that one step of all samples is contiguous. The
formulas are those of `nav2_mppi_controller` (Jazzy): `src/optimizer.cpp`, `src/noise_generator.cpp`,
`include/…/motion_models.hpp`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from simkit.extend import SharedByCopies
from simkit_navigation.plugins.controllers.footprint_costs import costs_of_cells
from simkit_navigation.plugins.controllers.sample_arithmetic import cosine, sine
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.costmaps.footprint import Footprint
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

Floats32 = npt.NDArray[np.float32]

AXES: Final = ("vx", "vy", "wz")
"""Names of the components of a control."""


@dataclass
class AxisLimits:
    """Limits of one component of the speed.

    Attributes:
        low, high: bounds of the control [m/s or rad/s].
        brake: largest change in one step that reduces a positive speed, negative.
        speed_up: largest change in one step that increases a positive speed.
    """

    low: float
    high: float
    brake: float
    speed_up: float

    def reachable(self, controls: Floats32, first: float) -> Floats32:
        """Return the speeds that follow from controls, which are clipped to what the robot reaches in one step.

        Args:
            controls: wanted speeds, shape (steps, samples); changed in place.
            first: present speed.
        """
        speeds = np.empty_like(controls)
        speeds[0] = first
        is_symmetric = self.brake == -self.speed_up
        brake, speed_up = np.float32(self.brake), np.float32(self.speed_up)
        least, most = np.empty_like(controls[0]), np.empty_like(controls[0])
        for step in range(1, len(controls)):
            last, control = speeds[step - 1], controls[step - 1]
            if is_symmetric:
                np.add(last, brake, out=least)
                np.add(last, speed_up, out=most)
            else:
                is_forward = last > 0
                np.add(last, np.where(is_forward, brake, -speed_up), out=least)
                np.add(last, np.where(is_forward, speed_up, -brake), out=most)
            np.maximum(control, least, out=control)
            np.minimum(control, most, out=control)
            speeds[step] = control
        return speeds

    def clip_sequence(self, controls: Floats32) -> None:
        """Clip one sequence of controls to the bounds and to the largest changes between its steps, in place."""
        np.clip(controls, self.low, self.high, out=controls)
        values = controls.tolist()
        for step in range(1, len(values)):
            last = values[step - 1]
            least, most = (self.brake, self.speed_up) if last > 0 else (-self.speed_up, -self.brake)
            values[step] = min(max(values[step], last + least), last + most)
        controls[:] = values


class Noise(SharedByCopies):
    """Random changes of the controls, which depend only on the seed and on the number of the draw.

    A snapshot shares the object, because the same numbers can be drawn again.

    Args:
        stream: random stream.
        shape: number of steps and of samples.
        deviations: standard deviation of each axis.
    """

    def __init__(self, stream: Any, shape: tuple[int, int], deviations: dict[str, float]) -> None:
        self._stream, self._shape, self._deviations = stream, shape, deviations
        self._drawn: tuple[int, int] | None = None
        self._values: dict[str, Floats32] = {}

    def values(self, seed: int, draw: int) -> dict[str, Floats32]:
        """Return the changes of a draw by axis, shape (steps, samples).

        Args:
            seed: seed of the simulation.
            draw: number of the draw.
        """
        if self._drawn != (seed, draw):
            generator = self._stream.generator(draw)
            for axis, deviation in self._deviations.items():
                self._values[axis] = generator.standard_normal(self._shape, np.float32)
                self._values[axis] *= np.float32(deviation)
            self._drawn = seed, draw
        return self._values


@dataclass
class Samples:
    """Samples of one iteration, with all that the critics need.

    The frame is that of the cells of the costmap: its origin is the corner of row 0 and column 0.

    Attributes:
        model_dt: time of a step [s].
        motion_model: name of the motion model.
        speeds: speeds that the robot reaches, by axis.
        controls: controls that lead to them, by axis.
        x, y, yaw: trajectories [m, rad].
        path: x, y [m] and yaw [rad] of the near part of the path, shape (n, 3).
        robot: pose of the robot.
        goal: last pose of the whole path.
        goal_tolerance: distance at which the goal is reached [m].
        grid: costs.
        footprint: outline of the robot.
        is_unknown_free: True if unknown cells, and those outside of the costmap, are no obstacles.
        costs: sum of the costs of each sample.
        all_collide: True if every sample collides, so that no more critics are asked.
    """

    model_dt: float
    motion_model: str
    speeds: dict[str, Floats32]
    controls: dict[str, Floats32]
    x: Floats32
    y: Floats32
    yaw: Floats32
    cos: Floats32
    sin: Floats32
    path: Floats32
    robot: PlanarPose
    goal: PlanarPose
    goal_tolerance: float
    grid: CostGrid
    footprint: Footprint
    is_unknown_free: bool
    costs: Floats32
    all_collide: bool = False
    _furthest: int | None = field(default=None, repr=False)
    _is_free: npt.NDArray[np.bool_] | None = field(default=None, repr=False)

    @property
    def is_holonomic(self) -> bool:
        """True if the robot moves sideways."""
        return self.motion_model == "Omni"

    def is_near_goal(self, distance: float) -> bool:
        """Check whether the robot is nearer to the goal than a distance [m]."""
        return (self.goal.x - self.robot.x) ** 2 + (self.goal.y - self.robot.y) ** 2 < distance * distance

    @property
    def furthest(self) -> int:
        """Index of the furthest path pose that is the nearest one to the end of a sample.

        Nav2 goes through the samples in their order and searches from the best index so far on.
        """
        if self._furthest is None:
            across = self.path[:, 0, None] - self.x[-1]
            along = self.path[:, 1, None] - self.y[-1]
            squares = across * across + along * along
            furthest = begin = 0
            while begin < squares.shape[1]:
                nearest = squares[furthest:, begin:].argmin(axis=0)
                beyond = np.flatnonzero(nearest)
                if not len(beyond):
                    break
                furthest, begin = furthest + int(nearest[beyond[0]]), begin + int(beyond[0]) + 1
            self._furthest = furthest
        return self._furthest

    @property
    def is_free(self) -> npt.NDArray[np.bool_]:
        """Path poses without an obstacle, all but the last one."""
        if self._is_free is None:
            grid, path = self.grid, self.path[:-1]
            costs = costs_of_cells(grid.cells, grid.resolution, path[:, 0], path[:, 1])
            columns, rows = path[:, 0] / grid.resolution, path[:, 1] / grid.resolution
            height, width = grid.cells.shape
            inside = (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
            self._is_free = inside & ((costs < 253) | ((costs == 255) & self.is_unknown_free))
        return self._is_free


def trajectories(
    speeds: dict[str, Floats32], robot: PlanarPose, model_dt: float, is_holonomic: bool
) -> tuple[Floats32, Floats32, Floats32, Floats32, Floats32]:
    """Return x, y [m] and yaw [rad] of the samples, and cosine and sine of the yaw.

    The pose of a step begins with the heading of the step before.
    """
    yaw = speeds["wz"] * np.float32(model_dt)
    yaw[0] += np.float32(robot.yaw)
    _accumulate(yaw)
    cos, sin = cosine(yaw), sine(yaw)
    before_cos, before_sin = np.empty_like(cos), np.empty_like(sin)
    first = np.array((robot.yaw,))
    before_cos[0], before_sin[0] = cosine(first)[0], sine(first)[0]
    before_cos[1:], before_sin[1:] = cos[:-1], sin[:-1]
    forward = speeds["vx"] * np.float32(model_dt)
    x, y = forward * before_cos, forward * before_sin
    if is_holonomic:
        aside = speeds["vy"] * np.float32(model_dt)
        before_sin *= aside
        before_cos *= aside
        x -= before_sin
        y += before_cos
    x[0] += np.float32(robot.x)
    y[0] += np.float32(robot.y)
    _accumulate(x)
    _accumulate(y)
    return x, y, yaw, cos, sin


def _accumulate(values: Floats32) -> None:
    """Add to each row all rows before it."""
    for step in range(1, len(values)):
        np.add(values[step], values[step - 1], out=values[step])
