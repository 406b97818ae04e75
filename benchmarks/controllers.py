"""Processor time of a cycle of the MPPI and DWB controllers, and its ratio to the time of one array operation.

python benchmarks/controllers.py [--rounds N]

The aim is 15 ms for 1,000 samples of 56 steps. The ratio compares machines: it is the number of sums of two such
arrays that take the time of a cycle.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
from measure import arguments

from simkit.params import Params
from simkit.runtime.engine.random_streams import RandomStreams
from simkit_navigation.plugins.controllers.dwb_controller import DwbController
from simkit_navigation.plugins.controllers.mppi_controller import MppiController
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.costmaps.footprint import round_footprint
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

MPPI = {
    "critics": "ConstraintCritic CostCritic GoalCritic GoalAngleCritic PathAlignCritic PathFollowCritic "
    "PathAngleCritic PreferForwardCritic",
    "regenerate_noises": "true",
    "prune_distance": 1.7,
}
DWB = {
    "critics": "RotateToGoal Oscillation BaseObstacle GoalAlign PathAlign PathDist GoalDist",
    "max_vel_x": 0.26,
    "max_speed_xy": 0.26,
    "max_vel_theta": 1.0,
    "linear_granularity": 0.05,
    "acc_lim_x": 2.5,
    "decel_lim_x": -2.5,
    "acc_lim_theta": 3.2,
    "decel_lim_theta": -3.2,
}


def node() -> Any:
    """Return an object with the attributes of the plugin that a controller uses."""

    def nothing(*_: object) -> bool:
        return False

    streams = RandomStreams(0)
    return SimpleNamespace(
        sim=SimpleNamespace(time_ns=0, seed=0),
        controller_frequency=20.0,
        footprint=round_footprint(0.22),
        is_at_goal_position=False,
        goal_tolerance=0.25,
        lateral_speed=0.0,
        tracks_unknown_space=False,
        cost_scaling_factor=3.0,
        inflation_radius=0.7,
        random=lambda channel, width=1: streams.stream("benchmark", channel, width),
        wants_path=nothing,
        wants_markers=nothing,
        publish_path=nothing,
        publish_point=nothing,
        publish_markers=nothing,
    )


def cycle_times(controller: Any, rounds: int) -> list[float]:
    """Return the processor times of cycles beside a wall [s]."""
    along = np.arange(121) * 0.05
    controller.set_plan(np.column_stack((along, np.zeros_like(along), np.zeros_like(along))))
    grid = CostGrid(np.zeros((60, 60), np.uint8), 0.05, PlanarPose(-1.5, -1.5, 0.0), "map")
    grid.cells[45:] = 100
    return times(lambda: controller.compute_velocity_commands(PlanarPose(0.0, 0.05, 0.0), (0.2, 0.0), grid), rounds)


def times(work: Callable[[], object], rounds: int) -> list[float]:
    """Return the processor times of calls [s]."""
    taken = []
    for _ in range(rounds):
        begin = time.process_time()
        work()
        taken.append(time.process_time() - begin)
    return taken


def main() -> None:
    """Print the times."""
    rounds = arguments(__doc__, rounds=40).rounds
    for samples in (1000, 2000):
        mppi = MppiController()
        mppi.configure(node(), Params.from_dict({**MPPI, "batch_size": samples}))
        median = statistics.median(cycle_times(mppi, rounds))
        one, other = np.ones((56, samples), np.float32), np.ones((56, samples), np.float32)
        unit = statistics.median(times(lambda one=one, other=other: [one + other for _ in range(50)], rounds)) / 50
        print(f"MPPI, {samples} samples of 56 steps: median {median * 1e3:.1f} ms, {median / unit:.0f} array sums")
    dwb = DwbController()
    dwb.configure(node(), Params.from_dict(DWB))
    print(f"DWB, 20 x 20 velocities: median {statistics.median(cycle_times(dwb, rounds)) * 1e3:.1f} ms")
    print("aim <= 15 ms for 1000 samples")


if __name__ == "__main__":
    main()
