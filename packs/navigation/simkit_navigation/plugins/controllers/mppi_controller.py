"""Controller that rates random variations of its commands, as Nav2's `nav2_mppi_controller`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params
from simkit.elementary_functions import exp
from simkit_navigation.plugins.controllers.local_path import LocalPath
from simkit_navigation.plugins.controllers.mppi_critics import CRITICS, Critic
from simkit_navigation.plugins.controllers.mppi_options import MppiOptions
from simkit_navigation.plugins.controllers.mppi_samples import (
    AXES,
    AxisLimits,
    Floats32,
    Noise,
    Samples,
    trajectories,
)
from simkit_navigation.plugins.controllers.sample_arithmetic import sum_over_samples
from simkit_navigation.plugins.controllers.sample_markers import trajectory_markers
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.navigation.node_values import split_names
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

if TYPE_CHECKING:
    from simkit_navigation.plugins.controllers.controller_node import ControllerNode

_SMOOTHING: Final = tuple(value / 231.0 for value in (-21, 14, 39, 54, 59, 54, 39, 14, -21))
"""Coefficients of the Savitzky-Golay filter of order 2 with 9 points."""
_LEAST_SMOOTHED: Final = 21  # shorter sequences are not smoothed
_HISTORY: Final = 4
_SLACK: Final = 1e-6  # [s] by which the control period may differ from the time step of the model


class MppiController:
    """Follows a path with the mean of many noisy control sequences, weighted by their costs (MPPI).

    Each cycle adds noise to the control sequence of the last cycle, predicts the trajectory of each sample, lets the
    critics rate them, and takes the mean of the samples with the weights exp(−cost / temperature). The formulas are
    those of `nav2_mppi_controller/src/optimizer.cpp` (Jazzy). The noise depends only on the seed of the simulation and
    on the number of the cycle.
    """

    needs_costmap = True
    topics = ("transformed_global_plan", "optimal_trajectory", "local_plan", "trajectories")

    def configure(self, node: ControllerNode, params: Params) -> None:
        """Read the parameters."""
        self._node, self._options = node, MppiOptions(params).read_all()
        options = self._options
        options.TrajectoryVisualizer.read_all()
        options.AckermannConstraints.read_all()
        self._critics = self._make_critics(params)
        period = 1.0 / node.controller_frequency
        self._shifts = abs(period - options.model_dt) < _SLACK
        if period > options.model_dt + _SLACK:
            params.error(
                "SK-PARAM-002",
                f"model_dt: found {options.model_dt:g} s, shorter than the control period of {period:g} s",
                "set model_dt to 1 / controller_frequency",
            )
        self._axes = AXES if options.motion_model == "Omni" else ("vx", "wz")
        deviations = {"vx": options.vx_std, "vy": options.vy_std, "wz": options.wz_std}
        self._deviations = {axis: deviations[axis] for axis in self._axes}
        shape = options.time_steps, options.batch_size
        self._noise = Noise(node.random(f"mppi {params.name}"), shape, self._deviations)
        self._draw = -1
        self._share = 1.0  # part of the largest speeds that the speed limit allows
        self._called_ns = 0
        self._path = LocalPath(np.zeros((1, 3)))
        self.reset()

    def _make_critics(self, params: Params) -> list[Critic]:
        critics = []
        for name in split_names(self._options.critics):
            critic = CRITICS.get(name)
            if critic is None:
                params.error(
                    "SK-PARAM-002", f"critics: found {name!r}", f"the critics are {', '.join(sorted(CRITICS))}"
                )
                continue
            critics.append(critic(params.block(name), self._options, self._node))
        return critics

    def set_plan(self, path: Floats) -> None:
        """Follow another path: x, y [m] and yaw [rad] of each pose, shape (n, 3)."""
        options = self._options
        self._path = LocalPath(
            path, options.enforce_path_inversion, options.inversion_xy_tolerance, options.inversion_yaw_tolerance
        )

    def set_speed_limit(self, limit: float, is_percentage: bool) -> None:
        """Reduce all speeds.

        Args:
            limit: largest forward speed [m/s], or percentage of it; 0 for no limit.
            is_percentage: True for a percentage.
        """
        most = 100.0 if is_percentage else self._options.vx_max
        self._share = limit / most if limit and most else 1.0

    def reset(self) -> None:
        """Forget the control sequence of the last cycle, and draw other noise."""
        steps = self._options.time_steps
        self._sequence: dict[str, Floats32] = {axis: np.zeros(steps, np.float32) for axis in self._axes}
        self._history: list[dict[str, float]] = [dict.fromkeys(self._axes, 0.0) for _ in range(_HISTORY)]
        self._last = dict.fromkeys(AXES, 0.0)
        self._draw += 1

    def compute_velocity_commands(
        self, pose: PlanarPose, velocity: tuple[float, float], grid: CostGrid | None
    ) -> tuple[float, float, float] | None:
        """Return the speeds [m/s, m/s, rad/s] forward, to the left and of turning; None if every sample collides."""
        if grid is None:
            return None
        options = self._options
        now = self._node.sim.time_ns
        if now - self._called_ns > options.reset_period * 1e9:
            self.reset()
        self._called_ns = now
        half = max(grid.cells.shape) * grid.resolution / 2
        search = options.max_robot_pose_search_dist
        near = self._path.advance(pose, half if search < 0 else search, options.prune_distance, grid)
        if not len(near):
            return None
        to_cells = grid.origin.inverse()
        path = np.column_stack((to_cells.transform(near[:, :2]), near[:, 2] - grid.origin.yaw)).astype(np.float32)
        robot, goal = to_cells.compose(pose), to_cells.compose(self._path.goal)
        speeds = dict(zip(AXES, (velocity[0], self._node.lateral_speed, velocity[1]), strict=True))
        if options.open_loop:
            speeds = self._last
        for _ in range(options.retry_attempt_limit + 1):
            samples = self._optimize(robot, goal, path, speeds, grid)
            if not samples.all_collide:
                break
            self.reset()
        else:
            return None
        self._smooth()
        step = 1 if self._shifts else 0
        command = {axis: float(values[step]) for axis, values in self._sequence.items()}
        self._last = {**self._last, **command}
        self._publish(samples, near, grid.origin)
        if self._shifts:
            for axis, values in self._sequence.items():
                self._sequence[axis] = np.append(values[1:], values[-1])
        return command["vx"], command.get("vy", 0.0), command["wz"]

    # ------------------------------------------------------------------ one cycle

    def _limits(self) -> dict[str, AxisLimits]:
        """Return the limits of each axis, reduced by the speed limit."""
        options, step = self._options, self._options.model_dt
        share = self._share

        def limits(low: float, high: float, brake: float, speed_up: float) -> AxisLimits:
            return AxisLimits(low * share, high * share, -abs(brake) * step, abs(speed_up) * step)

        return {
            "vx": limits(options.vx_min, options.vx_max, options.ax_min, options.ax_max),
            "vy": limits(-options.vy_max, options.vy_max, options.ay_min, options.ay_max),
            "wz": limits(-options.wz_max, options.wz_max, options.az_max, options.az_max),
        }

    def _optimize(
        self, robot: PlanarPose, goal: PlanarPose, path: Floats32, speeds: dict[str, float], grid: CostGrid
    ) -> Samples:
        """Replace the control sequence by the mean of the samples, unless they all collide; return the samples."""
        limits = self._limits()
        samples = self._sample(robot, goal, path, speeds, grid, limits)
        for iteration in range(self._options.iteration_count):
            if iteration:
                samples = self._sample(robot, goal, path, speeds, grid, limits)
            for critic in self._critics:
                if critic.options.enabled and not samples.all_collide:
                    critic.score(samples)
            self._update(samples, limits)
        return samples

    def _sample(
        self,
        robot: PlanarPose,
        goal: PlanarPose,
        path: Floats32,
        speeds: dict[str, float],
        grid: CostGrid,
        limits: dict[str, AxisLimits],
    ) -> Samples:
        options = self._options
        controls, reached = {}, {}
        for axis, noise in self._next_noise().items():
            controls[axis] = self._sequence[axis][:, None] + noise
            reached[axis] = limits[axis].reachable(controls[axis], speeds[axis])
        x, y, yaw, cos, sin = trajectories(reached, robot, options.model_dt, "vy" in reached)
        return Samples(
            model_dt=options.model_dt,
            motion_model=options.motion_model,
            speeds=reached,
            controls=controls,
            x=x,
            y=y,
            yaw=yaw,
            cos=cos,
            sin=sin,
            path=path,
            robot=robot,
            goal=goal,
            goal_tolerance=self._node.goal_tolerance,
            grid=grid,
            footprint=self._node.footprint,
            is_unknown_free=self._node.tracks_unknown_space,
            costs=np.zeros(options.batch_size, np.float32),
        )

    def _next_noise(self) -> dict[str, Floats32]:
        """Return the noise of this iteration; the same as in the last one unless `regenerate_noises` is set."""
        draw = self._draw
        if self._options.regenerate_noises:
            self._draw += 1
        return self._noise.values(self._node.sim.seed, draw)

    def _update(self, samples: Samples, limits: dict[str, AxisLimits]) -> None:
        """Replace the control sequence by the weighted mean of the controls."""
        options, costs = self._options, samples.costs
        for axis, controls in samples.controls.items():
            sequence = self._sequence[axis]
            product, total = np.empty_like(costs), np.zeros_like(costs)
            for present, row in zip(sequence, controls, strict=True):
                np.subtract(row, present, out=product)
                product *= present
                total += product
            costs += np.float32(options.gamma / self._deviations[axis] ** 2) * total
        weights = exp((costs - costs.min()).astype(np.float64) * (-1.0 / options.temperature)).astype(np.float32)
        weights /= sum_over_samples(weights)
        for axis, controls in samples.controls.items():
            self._sequence[axis] = sum_over_samples(controls * weights)
            limits[axis].clip_sequence(self._sequence[axis])
        if options.motion_model == "Ackermann":
            self._sequence["wz"] = _within_radius(self._sequence, options.AckermannConstraints.min_turning_r)

    def _smooth(self) -> None:
        """Smooth the control sequence with the last commands before it; keep this command for the next cycles."""
        if self._options.time_steps < _LEAST_SMOOTHED:
            return
        for axis, values in self._sequence.items():
            before = [past[axis] for past in self._history]
            padded = np.concatenate((before, values, np.repeat(values[-1], _HISTORY))).astype(np.float32)
            smooth = np.zeros_like(values)
            for offset, coefficient in enumerate(_SMOOTHING):
                smooth += np.float32(coefficient) * padded[offset : offset + len(values)]
            smooth[-1] = values[-1]
            self._sequence[axis] = smooth
        step = 1 if self._shifts else 0
        self._history = [*self._history[1:], {axis: float(values[step]) for axis, values in self._sequence.items()}]

    # ------------------------------------------------------------------ what RViz shows

    def _publish(self, samples: Samples, near: Floats, origin: PlanarPose) -> None:
        """Publish the near part of the path, the trajectory of the mean, and markers of the samples."""
        node, options = self._node, self._options
        node.publish_path("transformed_global_plan", near)
        wanted = node.wants_path("optimal_trajectory"), node.wants_path("local_plan")
        wants_markers = options.visualize and node.wants_markers("trajectories")
        if not (any(wanted) or wants_markers):
            return
        rows = {axis: values[:, None] for axis, values in self._sequence.items()}
        x, y, yaw, _, _ = trajectories(rows, samples.robot, options.model_dt, "vy" in rows)
        best = np.column_stack((x[:, 0], y[:, 0], yaw[:, 0])).astype(np.float64)
        placed = np.column_stack((origin.transform(best[:, :2]), best[:, 2] + origin.yaw))
        for topic in ("optimal_trajectory", "local_plan"):
            node.publish_path(topic, placed)
        if wants_markers:
            each = options.TrajectoryVisualizer
            places = [a[:: each.time_step, :: each.trajectory_step].astype(np.float64) for a in (samples.x, samples.y)]
            moved = origin.transform(np.column_stack([a.T.reshape(-1) for a in places]))
            node.publish_markers("trajectories", trajectory_markers(moved, places[0].shape[0], placed))


def _within_radius(sequence: dict[str, Floats32], radius: float) -> Floats32:
    """Return the turning rates of a car that cannot turn within a radius [m]."""
    forward, turning = np.abs(sequence["vx"]), sequence["wz"]
    is_tight = forward < np.abs(turning) * np.float32(radius)
    rates: Floats32 = np.where(is_tight, np.sign(turning) * forward / np.float32(radius), turning)
    return rates
