"""Planner: paths on grids, error codes, planners of users."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from navigation_worlds import pose, world
from scipy.ndimage import distance_transform_edt

import simkit
from simkit import Params
from simkit.errors import PluginError
from simkit_navigation.plugins.costmaps.cost_grid import INSCRIBED, LETHAL, CostGrid
from simkit_navigation.plugins.maps.map_server import MapServer
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose
from simkit_navigation.plugins.planners.grid_planner import GridPlanner
from simkit_navigation.plugins.planners.planning_error import PlanningError


def planned(
    cells: Any, start: tuple[float, float], goal: tuple[float, float], **options: float
) -> np.ndarray[Any, Any]:
    planner = GridPlanner()
    planner.configure(None, Params.from_dict(options))  # type: ignore[arg-type]
    grid = CostGrid(np.asarray(cells, np.uint8), 0.1, PlanarPose(0.0, 0.0, 0.0), "map")
    try:
        path = planner.create_plan(grid, PlanarPose(*start, 0.0), PlanarPose(*goal, 0.0))
    except PlanningError:
        path = []
    return np.array(path).reshape(-1, 3)[:, :2]


def length(path: np.ndarray[Any, Any]) -> float:
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def test_a_path_on_a_free_grid_is_straight() -> None:
    path = planned(np.zeros((50, 50)), (0.55, 0.55), (4.05, 0.55))
    assert path[0].tolist() == [0.55, 0.55] and path[-1].tolist() == [4.05, 0.55]
    assert length(path) == pytest.approx(3.5, rel=1e-6)
    diagonal = planned(np.zeros((50, 50)), (0.55, 0.55), (4.05, 4.05))
    assert length(diagonal) == pytest.approx(3.5 * math.sqrt(2), rel=1e-6)


def test_a_path_goes_through_the_only_gap() -> None:
    cells = np.zeros((50, 50))
    cells[:, 25] = LETHAL
    cells[40:43, 25] = 0
    path = planned(cells, (1.05, 0.55), (4.05, 0.55))
    crossing = path[np.abs(path[:, 0] - 2.55) < 0.05]
    assert len(crossing) and (crossing[:, 1] > 4.0).all() and (crossing[:, 1] < 4.3).all()
    shortest = math.hypot(1.5, 3.5) * 2
    assert shortest < length(path) < 1.09 * shortest  # of eight directions, the detour is at most 8.2 %
    assert not len(planned(np.where(cells, LETHAL, INSCRIBED), (1.05, 0.55), (4.05, 0.55)))
    cells[40:43, 25] = INSCRIBED
    assert not len(planned(cells, (1.05, 0.55), (4.05, 0.55)))


def test_costs_keep_a_path_away() -> None:
    """A detour of 1.4 m is worth it, because the direct way crosses cells of five times the weight."""
    cells = np.zeros((50, 50))
    cells[0:30, 15:35] = 250
    assert planned(cells, (0.55, 2.05), (4.05, 2.05))[:, 1].max() > 2.95
    cells[0:30, 15:35] = 10
    assert planned(cells, (0.55, 2.05), (4.05, 2.05))[:, 1].max() < 2.15


def test_an_occupied_goal_is_replaced_within_the_tolerance() -> None:
    cells = np.zeros((50, 50))
    cells[18:23, 38:43] = LETHAL
    path = planned(cells, (0.55, 2.05), (4.05, 2.05), tolerance=0.5)
    assert math.hypot(*(path[-1] - (4.05, 2.05))) == pytest.approx(0.3, abs=1e-9)
    assert not len(planned(cells, (0.55, 2.05), (4.05, 2.05), tolerance=0.0))


def test_a_path_through_the_house_is_short_and_clear_of_walls() -> None:
    """All cells with a centre within 0.2 m of a wall are blocked; the way leads through the doors."""
    with simkit.load("turtlebot3_house", plugins=[MapServer()]) as sim:
        info, data = (found := sim.call("/MapServer/map").map).info, found.data
    is_wall = np.asarray(data).reshape(info.height, info.width) == 100
    distance = distance_transform_edt(~is_wall) * 0.05
    cells = np.where(is_wall, LETHAL, np.where(distance <= 0.2, INSCRIBED, 0)).astype(np.uint8)
    x, y = info.origin.position.x, info.origin.position.y
    planner = GridPlanner()
    planner.configure(None, Params.from_dict({}))  # type: ignore[arg-type]
    grid = CostGrid(cells, 0.05, PlanarPose(x, y, 0.0), "map")
    path = np.array(planner.create_plan(grid, PlanarPose(-2.0, -0.5, 0.0), PlanarPose(4.9, 2.9, 0.0)))[:, :2]
    assert path[0].tolist() == [-2.0, -0.5] and path[-1].tolist() == [4.9, 2.9]
    between = np.concatenate([path[:-1] + part * np.diff(path, axis=0) for part in (0.0, 0.25, 0.5, 0.75)])
    columns, rows = np.floor((between - (x, y)) / 0.05).astype(int).T
    assert distance[rows, columns].min() > 0.2 - 0.05  # a point between two centres may touch the corner of a cell
    assert np.hypot(*np.diff(path, axis=0).T).max() < 0.1
    straight = math.hypot(6.9, 3.4)
    assert straight < length(path) < 1.1 * straight


PLANNER = """
from simkit_navigation.plugins.planners.planning_error import PlanningError, Reason


class Straight:
    def create_plan(self, grid, start, goal):
        if goal.y < 0:
            raise PlanningError(Reason.GOAL_OCCUPIED, "no goals on that side")
        return [(start.x, start.y), (goal.x, goal.y)] if goal.x < 1.5 else []
"""


def test_a_planner_of_a_user_makes_the_path(tmp_path: Path) -> None:
    (tmp_path / "planner.py").write_text(PLANNER, "utf-8")
    options = "<planner_plugins>Mine GridBased</planner_plugins><Mine><plugin>planner.py:Straight</plugin></Mine>"
    options += "<GridBased><plugin>nav2_navfn_planner::NavfnPlanner</plugin></GridBased>"
    with simkit.load(world(tmp_path, planner=options), plugin_paths=[tmp_path]) as sim:
        plans = sim.subscribe("/plan", keep=9)
        sim.run(1.3)
        goals = [
            sim.send_goal("/compute_path_to_pose", {"goal": pose(x, 1.0, 0.5), "planner_id": planner})
            for x, planner in ((1.2, ""), (1.7, ""), (1.2, "GridBased"), (1.2, "None"), (99.0, ""))
        ]
        nowhere = sim.send_goal("/compute_path_to_pose", {"goal": pose(1.2, 1.0, frame="moon")})
        refused = sim.send_goal("/compute_path_to_pose", {"goal": pose(1.2, -1.0)})
        sim.step(2)
        assert (refused.result.error_code, refused.reason) == (206, "no goals on that side")
        assert [goal.status.name for goal in goals] == ["SUCCEEDED", "ABORTED", "SUCCEEDED", "ABORTED", "ABORTED"]
        assert [goal.result.error_code for goal in (*goals, nowhere)] == [0, 208, 0, 201, 204, 202]
        path = goals[0].result.path
        assert [(p.pose.position.x, p.pose.position.y) for p in path.poses[1:]] == [(1.2, 1.0)]
        assert path.poses[1].pose.orientation.z == pytest.approx(math.sin(0.25))
        assert path.poses[0].pose.orientation.z == pytest.approx(math.sin(math.atan2(1.0, 1.2) / 2), abs=1e-3)
        assert len(plans.messages) == 2
        assert sim.call("/is_path_valid", {"path": path}).is_valid
        through = {"header": {"frame_id": "map"}, "poses": [pose(1.0, 0.0), pose(2.0, 0.0)]}
        found = sim.call("/is_path_valid", {"path": through})
        assert (found.is_valid, list(found.invalid_pose_indices)) == (False, [1])


@pytest.mark.parametrize("result", ["5", "[(1, 2), (1, 2, 3)]", "[1, 2]", "'ab'", "[(float('nan'), 1)]"])
def test_the_error_names_what_a_planner_must_return(tmp_path: Path, result: str) -> None:
    text = f"class Planner:\n    def create_plan(self, grid, start, goal):\n        return {result}\n"
    (tmp_path / "planner.py").write_text(text, "utf-8")
    options = "<planner_plugins>Mine</planner_plugins><Mine><plugin>planner.py:Planner</plugin></Mine>"
    with simkit.load(world(tmp_path, planner=options), plugin_paths=[tmp_path]) as sim:
        sim.run(1.1)
        sim.send_goal("/compute_path_to_pose", {"goal": pose(0.5, 0.0)})
        with pytest.raises(PluginError, match="create_plan must return finite"):
            sim.step(3)
