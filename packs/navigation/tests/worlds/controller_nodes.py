"""Node of a controller without a simulation, and costmaps, for tests of controllers."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from simkit.runtime.engine.random_streams import RandomStreams
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.costmaps.footprint import round_footprint
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose


def controller_node(radius: float = 0.2, **changes: Any) -> Any:
    """Return an object with the attributes of the plugin that a controller uses; it publishes nothing."""

    def nothing(*_: object) -> None:
        """Ignore what a controller publishes."""

    values = {
        "sim": SimpleNamespace(time_ns=0, seed=0),
        "controller_frequency": 20.0,
        "footprint": round_footprint(radius),
        "is_at_goal_position": False,
        "goal_tolerance": 0.25,
        "lateral_speed": 0.0,
        "tracks_unknown_space": False,
        "cost_scaling_factor": 3.0,
        "inflation_radius": 0.7,
        "publish_path": nothing,
        "publish_point": nothing,
        "publish_markers": nothing,
        "wants_path": lambda _: False,
        "wants_markers": lambda _: False,
        "find_class": lambda _name, wanted, _block, known: known.get(wanted.replace("/", "::")),
    }
    node = SimpleNamespace(**{**values, **changes})
    streams = RandomStreams(node.sim.seed)
    node.random = lambda channel, width=1: streams.stream("controller", channel, width)
    return node


def empty_grid(side: float = 3.0, resolution: float = 0.05) -> CostGrid:
    """Return a costmap without obstacles whose centre is the origin."""
    count = round(side / resolution)
    return CostGrid(np.zeros((count, count), np.uint8), resolution, PlanarPose(-side / 2, -side / 2, 0.0), "map")


def straight_path(length: float = 3.0, step: float = 0.05) -> Any:
    """Return the poses of a straight path along x from the origin."""
    x = np.arange(round(length / step) + 1) * step
    return np.column_stack((x, np.zeros_like(x), np.zeros_like(x)))
