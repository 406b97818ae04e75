"""Processor time of a plan in the house and of an update of `amcl` with 500 particles and 360 rays.

python benchmarks/navigation.py [--rounds N]

The aims are 20 ms and 2 ms. A plan leads from one end of `turtlebot3_house` to the other.
"""

from __future__ import annotations

import statistics
import time

import localisation
import numpy as np
from measure import arguments

import simkit
from simkit.params import Params
from simkit_navigation.plugins.maps.map_server import MapServer
from simkit_navigation.plugins.navigation.cost_grid import LETHAL, CostGrid
from simkit_navigation.plugins.navigation.grid_planner import GridPlanner
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose


def house() -> CostGrid:
    """Return the costs of the walls of the house."""
    with simkit.load("turtlebot3_house", plugins=[MapServer()]) as sim:
        found = sim.call("/MapServer/map").map
    info, origin = found.info, found.info.origin.position
    cells = np.where(np.asarray(found.data).reshape(info.height, info.width) == 100, LETHAL, 0).astype(np.uint8)
    return CostGrid(cells, 0.05, PlanarPose(origin.x, origin.y, 0.0), "map")


def plan_times(rounds: int) -> list[float]:
    """Return the processor times of plans [s]."""
    grid, planner, taken = house(), GridPlanner(), []
    planner.configure(None, Params.from_dict({}))  # type: ignore[arg-type]
    for _ in range(rounds):
        begin = time.process_time()
        planner.create_plan(grid, PlanarPose(-2.0, -0.5, 0.0), PlanarPose(4.9, 2.9, 0.0))
        taken.append(time.process_time() - begin)
    return taken


def main() -> None:
    taken = plan_times(arguments(__doc__, rounds=9).rounds)
    print(
        f"a plan in the house: median {statistics.median(taken) * 1e3:.1f} ms, "
        f"least {min(taken) * 1e3:.1f} ms   aim <= 20 ms"
    )
    localisation.main()


if __name__ == "__main__":
    main()
