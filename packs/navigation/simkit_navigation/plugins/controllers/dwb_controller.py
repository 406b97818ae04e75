"""Controller that tries velocities and rates their trajectories, as Nav2's `nav2_dwb_controller`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from simkit import Params
from simkit_navigation.plugins.controllers.dwb_critics import CRITICS, DwbCritic, Situation
from simkit_navigation.plugins.controllers.dwb_options import DwbCriticOptions, DwbOptions
from simkit_navigation.plugins.controllers.local_path import distances_along
from simkit_navigation.plugins.controllers.velocity_samples import Speeds3, Trajectories, VelocitySampler
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.navigation.node_values import split_names
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

if TYPE_CHECKING:
    from simkit_navigation.plugins.controllers.controller_node import ControllerNode


class DwbController:
    """Drives with the velocity whose trajectory has the lowest sum of scores.

    The velocities are those that the robot reaches within the simulated time; the critics rate all of their
    trajectories together. The rules are those of `dwb_core/src/dwb_local_planner.cpp` (Jazzy).
    """

    needs_costmap = True
    topics = ("received_global_plan", "transformed_global_plan", "local_plan")

    def configure(self, node: ControllerNode, params: Params) -> None:
        """Read the parameters."""
        self._node, self._options = node, DwbOptions(params).read_all()
        self._sampler = VelocitySampler(self._options, 1.0 / node.controller_frequency)
        self._critics = self._make_critics(params)
        if not self._critics:
            params.error("SK-PARAM-002", "critics: there is none", f"the critics are {', '.join(sorted(CRITICS))}")
        self._path: Floats = np.zeros((0, 3))
        self._goal = PlanarPose(0.0, 0.0, 0.0)

    def _make_critics(self, params: Params) -> list[DwbCritic]:
        critics = []
        for name in split_names(self._options.critics):
            block = params.block(name)
            kind = block.text("class", name).replace("/", "::").rpartition("::")[2]
            cls = CRITICS.get(kind if "Critic" in kind else f"{kind}Critic")
            if cls is None:
                params.error(
                    "SK-PARAM-002", f"critics: found {kind!r}", f"the critics are {', '.join(sorted(CRITICS))}"
                )
                continue
            options = DwbCriticOptions(block).read_all()
            for shared in ("xy_goal_tolerance", "trans_stopped_velocity"):  # of the controller, as in Nav2
                if not block.has(shared):
                    vars(options)[shared] = getattr(self._options, shared)
            if cls.__name__ == "TwirlingCritic" and not block.has("scale"):
                vars(options)["scale"] = 0.0
            critics.append(cls(options))
        return critics

    def set_plan(self, path: Floats) -> None:
        """Follow another path: x, y [m] and yaw [rad] of each pose, shape (n, 3)."""
        self._path, self._goal = path, PlanarPose(*path[-1].tolist())
        for critic in self._critics:
            critic.reset()

    def set_speed_limit(self, limit: float, is_percentage: bool) -> None:
        """Reduce all speeds.

        Args:
            limit: largest speed [m/s], or percentage of it; 0 for no limit.
            is_percentage: True for a percentage.
        """
        most = 100.0 if is_percentage else self._options.max_speed_xy
        share = limit / most if limit and most > 0 else 1.0
        self._sampler.set_speed_limit(share if is_percentage else min(share, 1.0))

    def compute_velocity_commands(
        self, pose: PlanarPose, velocity: tuple[float, float], grid: CostGrid | None
    ) -> Speeds3 | None:
        """Return the speeds [m/s, m/s, rad/s] forward, to the left and of turning; None if no velocity is allowed."""
        if grid is None:
            return None
        near = self._near_part(pose, grid)
        if not len(near):
            return None
        to_cells, node = grid.origin.inverse(), self._node
        local = np.column_stack((to_cells.transform(near[:, :2]), near[:, 2] - grid.origin.yaw))
        speeds = velocity[0], node.lateral_speed, velocity[1]
        situation = Situation(
            to_cells.compose(pose),
            speeds,
            to_cells.compose(self._goal),
            local,
            grid,
            node.footprint,
            node.sim.time_ns,
        )
        samples = self._sampler.trajectories(situation.pose, speeds)
        best = self._best(situation, samples)
        command = (0.0, 0.0, 0.0) if best is None else tuple(samples.velocities[best].tolist())
        for critic in self._critics:
            critic.debrief(situation, command)
        node.publish_path("received_global_plan", self._path)
        node.publish_path("transformed_global_plan", near)
        if best is None:
            return None
        if node.wants_path("local_plan"):
            chosen = np.column_stack((samples.x[:, best], samples.y[:, best], samples.yaw[:, best]))
            chosen = chosen[: int(samples.counts[best]) + 1]
            placed = np.column_stack((grid.origin.transform(chosen[:, :2]), chosen[:, 2] + grid.origin.yaw))
            node.publish_path("local_plan", placed)
        return command

    def _best(self, situation: Situation, samples: Trajectories) -> int | None:
        """Return the index of the allowed trajectory with the lowest sum of scores; None without one."""
        count = len(samples.counts)
        total, allowed = np.zeros(count), np.ones(count, np.bool_)
        for critic in self._critics:
            critic.prepare(situation)
            factor = critic.factor(situation)
            if factor != 0.0 and count:
                scores, legal = critic.score(situation, samples)
                total += scores * factor
                allowed &= legal
        indices = np.flatnonzero(allowed)
        return int(indices[total[indices].argmin()]) if len(indices) else None

    def _near_part(self, pose: PlanarPose, grid: CostGrid) -> Floats:
        """Forget the poses that the robot has passed, and return those near the robot."""
        options, path = self._options, self._path
        reach = max(grid.cells.shape) * grid.resolution / 2
        forward = options.forward_prune_distance if options.forward_prune_distance >= 0.0 else math.inf
        start = min(reach, options.prune_distance) if options.prune_plan else reach
        end = min(reach, forward) if options.shorten_transformed_plan else reach
        squares = (path[:, 0] - pose.x) ** 2 + (path[:, 1] - pose.y) ** 2
        limit = int(np.searchsorted(distances_along(path), forward, side="right"))
        near = np.flatnonzero(squares[:limit] < start * start)
        begin = int(near[0]) if len(near) else limit
        far = np.flatnonzero(squares[begin:] > end * end)
        if options.prune_plan and begin < len(path):
            self._path = path[begin:]
        return path[begin : begin + int(far[0]) if len(far) else None]
