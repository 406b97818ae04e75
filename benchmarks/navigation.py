"""Processor time of plans in the house and of an update of `amcl` with 500 particles and 360 rays.

python benchmarks/navigation.py [--rounds N]

The aims are 20 ms and 2 ms. A plan leads from one end of `turtlebot3_house` to the other, on a costmap with the
inflation of `nav2_bringup`. The time of a smoother is that for the path of NavfnPlanner.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from functools import partial

import localisation
import numpy as np
from measure import arguments

import simkit
from simkit.params import Params
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.maps.map_server import MapServer
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose
from simkit_navigation.plugins.planners.planner_server import PLANNERS
from simkit_navigation.plugins.planners.smoother_server import SMOOTHERS

NAVFN = "nav2_navfn_planner::NavfnPlanner"
COSTMAP = """<sdf version="1.9"><model name="costmap"><static>true</static><link name="link"/>
<plugin filename="libsimkit_fake_localization.so" name="fake_localization"/>
<plugin filename="libsimkit_costmap_2d.so" name="global_costmap"><plugins>static_layer inflation_layer</plugins>
<robot_radius>0.22</robot_radius><inflation_layer><cost_scaling_factor>3</cost_scaling_factor>
<inflation_radius>0.7</inflation_radius></inflation_layer></plugin></model></sdf>"""


def house() -> CostGrid:
    """Return the costs around the walls of the house."""
    with simkit.load("turtlebot3_house", plugins=[MapServer()], spawn=[COSTMAP]) as sim:
        sim.run(1.3)
        grid: CostGrid = sim.plugins["costmap::global_costmap"].grid
        return grid


def times(rounds: int, work: Callable[[], object]) -> str:
    """Return the processor times of a function as text."""
    taken = []
    for _ in range(rounds):
        begin = time.process_time()
        work()
        taken.append(time.process_time() - begin)
    return f"median {statistics.median(taken) * 1e3:.1f} ms, least {min(taken) * 1e3:.1f} ms   aim <= 20 ms"


def main() -> None:
    rounds, grid, path = arguments(__doc__, rounds=9).rounds, house(), np.zeros((0, 3))
    start, goal = PlanarPose(-2.0, -0.5, 0.0), PlanarPose(4.9, 2.9, 0.0)
    for name, options in ((NAVFN, {}), (NAVFN, {"use_astar": "true"}), *((name, {}) for name in list(PLANNERS)[1:])):
        planner = PLANNERS[name]()
        planner.configure(None, Params.from_dict(options))  # type: ignore[arg-type]
        text = f"{name.rpartition('::')[2]}{' with use_astar' if options else ''}"
        print(f"a plan of {text}: {times(rounds, partial(planner.create_plan, grid, start, goal))}")
        if name == NAVFN:
            path = np.asarray(planner.create_plan(grid, start, goal))
    for name, kind in SMOOTHERS.items():
        smoother = kind()
        smoother.configure(None, Params.from_dict({}))  # type: ignore[arg-type]
        work = partial(smoother.smooth, path, grid)
        print(f"a path of {name.rpartition('::')[2]}: {times(rounds, work)}")
    localisation.main()


if __name__ == "__main__":
    main()
