"""A*, Smac 2-D and Theta* on grids, and paths through several poses."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from navigation_worlds import place, pose, world

import simkit
from simkit import Params
from simkit_navigation.plugins.costmaps.cost_grid import INSCRIBED, LETHAL, CostGrid
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose
from simkit_navigation.plugins.planners.grid_planner import GridPlanner
from simkit_navigation.plugins.planners.grid_search import search
from simkit_navigation.plugins.planners.planning_error import PlanningError, Reason
from simkit_navigation.plugins.planners.smac_planner_2d import SmacPlanner2D
from simkit_navigation.plugins.planners.theta_star_planner import ThetaStarPlanner

START, GOAL = PlanarPose(0.55, 0.55, 0.0), PlanarPose(4.05, 4.35, 1.0)


def gap() -> np.ndarray[Any, Any]:
    """Return a grid with a wall that has one gap."""
    cells = np.zeros((50, 50), np.uint8)
    cells[:, 25] = LETHAL
    cells[30:35, 25] = 0
    return cells


def configured(cls: Any, **options: float | str) -> Any:
    planner = cls()
    planner.configure(None, Params.from_dict(options))
    return planner


def plan(planner: Any, cells: Any, goal: PlanarPose = GOAL) -> np.ndarray[Any, Any]:
    grid = CostGrid(np.asarray(cells, np.uint8), 0.1, PlanarPose(0.0, 0.0, 0.0), "map")
    return np.array(planner.create_plan(grid, START, goal)).reshape(-1, 3)


def reason(planner: Any, cells: Any, goal: PlanarPose = GOAL) -> Reason:
    with pytest.raises(PlanningError) as error:
        plan(planner, cells, goal)
    return error.value.reason


def length(path: np.ndarray[Any, Any]) -> float:
    return float(np.hypot(*np.diff(path[:, :2], axis=0).T).sum())


@pytest.mark.parametrize("seed", range(4))
def test_a_star_finds_the_cost_of_dijkstra(seed: int) -> None:
    generator = np.random.default_rng(seed)
    weights = np.where(generator.random((40, 60)) < 0.25, math.inf, generator.integers(50, 200, (40, 60)))
    weights[1, 1] = weights[38, 57] = 50.0
    exact, guided = search(weights, (1, 1)), search(weights, (1, 1), (38, 57), 50.0)
    assert exact.reached[38, 57] == guided.reached[38, 57]
    if exact.reached[38, 57]:
        change = 50.0 * math.hypot(37, 56)  # the heuristic of the start, which A* subtracts
        assert guided.costs[38, 57] + change == pytest.approx(exact.costs[38, 57], rel=1e-9)
        assert guided.visited((38, 57)) < exact.visited((38, 57))


def test_use_astar_visits_fewer_cells_for_a_path_as_short() -> None:
    slow, fast = configured(GridPlanner), configured(GridPlanner, use_astar="true")
    cells = np.zeros((50, 50))
    assert length(plan(fast, cells)) == pytest.approx(length(plan(slow, cells)), rel=0.01)
    assert fast.visited_cells < slow.visited_cells / 3


@pytest.mark.parametrize("cls", [GridPlanner, SmacPlanner2D, ThetaStarPlanner])
def test_a_path_goes_through_the_gap_and_ends_with_the_yaw_that_is_asked_for(cls: Any) -> None:
    path = plan(configured(cls), gap())
    crossing = path[np.abs(path[:, 0] - 2.55) < 0.05]
    assert len(crossing) and (crossing[:, 1] > 3.0).all() and (crossing[:, 1] < 3.5).all()
    assert path[0, :2].tolist() == [0.55, 0.55] and path[-1].tolist() == [*GOAL]
    shortest = math.hypot(2.0, 2.45 + 0.05) + math.hypot(1.5, 1.3)  # by the lower corner of the gap
    assert length(path) < 1.09 * shortest
    last = plan(configured(cls, use_final_approach_orientation="true"), gap())
    x, y = (last[-1] - last[-2])[:2]
    assert last[-1, 2] == pytest.approx(math.atan2(y, x))


def test_theta_star_has_straight_lines_in_any_direction() -> None:
    path = plan(configured(ThetaStarPlanner), np.zeros((50, 50)))
    assert length(path) == pytest.approx(math.hypot(3.5, 3.8), rel=1e-9)
    assert np.ptp(path[:-1, 2]) < 1e-9
    around = configured(ThetaStarPlanner, w_traversal_cost=50.0)
    cells = np.zeros((50, 50))
    cells[15:35, 15:35] = 200
    rows, columns = (plan(around, cells)[:, 1::-1] / 0.1).astype(int).T
    assert (cells[rows, columns] == 200).sum() <= 1  # a line may touch a corner


def test_smac_pays_for_costs_by_cost_travel_multiplier() -> None:
    cells = np.zeros((50, 50))
    cells[20:50, 10:40] = 200
    goal = PlanarPose(0.55, 4.35, 0.0)
    cells[20:24, :10] = cells[20:24, 40:] = 200  # a band of 0.4 m crosses the grid
    direct = plan(configured(SmacPlanner2D, cost_travel_multiplier=0.0), cells, goal)
    assert length(direct) == pytest.approx(3.8, rel=1e-3) and direct[:, 0].min() > 0.54
    cells[20:24, :5] = 0
    aside = plan(configured(SmacPlanner2D, cost_travel_multiplier=5.0), cells, goal)
    assert aside[:, 0].min() < 0.48


def test_smac_ends_near_an_occupied_goal_within_the_tolerance() -> None:
    cells = np.zeros((50, 50))
    cells[41:46, 38:43] = INSCRIBED
    path = plan(configured(SmacPlanner2D, tolerance=0.5), cells)
    assert 0.2 < math.hypot(*(path[-1] - GOAL)[:2]) < 0.5
    assert reason(configured(SmacPlanner2D, tolerance=0.0), cells) is Reason.GOAL_OCCUPIED
    assert reason(configured(SmacPlanner2D), cells) is Reason.NO_VALID_PATH
    assert reason(configured(SmacPlanner2D, max_iterations=100), gap()) is Reason.TIMEOUT
    cells[3:9, 3:9] = LETHAL
    assert reason(configured(SmacPlanner2D), cells) is Reason.START_OCCUPIED


def test_smac_stops_on_approach_after_its_iterations() -> None:
    """The goal is behind a wall, 0.4 m from cells that are reached much earlier."""
    cells = np.zeros((50, 50))
    cells[41, 5:] = LETHAL
    goal = PlanarPose(4.05, 4.35, 0.0)
    options = {"tolerance": 0.5, "max_on_approach_iterations": 5}
    near = plan(configured(SmacPlanner2D, **options), cells, goal)
    assert near[-1, 1] < 4.1 and math.hypot(*(near[-1] - goal)[:2]) < 0.5
    exact = plan(configured(SmacPlanner2D, tolerance=0.5, max_on_approach_iterations=0), cells, goal)
    assert exact[-1].tolist() == [*goal]


def test_a_coarse_costmap_has_the_largest_cost_of_its_cells() -> None:
    """The gap of five cells is closed for cells of six, and open for those of two."""
    coarse = {"downsample_costmap": "true", "downsampling_factor": 2}
    path = plan(configured(SmacPlanner2D, **coarse), gap())
    assert path[-1].tolist() == [*GOAL] and len(path) < len(plan(configured(SmacPlanner2D), gap())) * 0.7
    coarse["downsampling_factor"] = 6
    assert reason(configured(SmacPlanner2D, **coarse), gap()) is Reason.NO_VALID_PATH


def test_goals_in_other_frames_and_through_several_poses(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path)) as sim:
        early = sim.send_goal("/compute_path_to_pose", {"goal": pose(1.0, 0.0)})
        sim.run(1.3)
        assert early.status.name == "SUCCEEDED"  # it has waited for the costmap
        place(sim, 0.5, 0.5, "shelf")
        sim.step(2)
        goals = [[pose(0.5, 0.0, frame="shelf"), pose(1.0, -1.0, 0.5)], [], [pose(0.0, 0.0, frame="moon")]]
        found = [sim.send_goal("/compute_path_through_poses", {"goals": one}) for one in goals]
        found.append(sim.send_goal("/compute_path_through_poses", {"goals": goals[0], "planner_id": "nobody"}))
        sim.step(2)
        assert [goal.result.error_code for goal in found] == [0, 309, 302, 301]
        assert "'moon'" in found[2].reason
        points = [(one.pose.position.x, one.pose.position.y) for one in found[0].result.path.poses]
        assert (1.0, 0.5) in points and points[-1] == (1.0, -1.0) and len(set(points)) == len(points)


def test_without_a_costmap_a_goal_ends_after_the_timeout() -> None:
    plugin = (
        '<plugin filename="libsimkit_planner_server.so" name="p"><costmap_update_timeout>0.5</costmap_update_timeout>'
    )
    with simkit.load(f'<sdf version="1.9"><world name="w">{plugin}</plugin></world></sdf>') as sim:
        goal = sim.send_goal("/compute_path_to_pose", {"goal": pose(1.0, 0.0)})
        sim.run(0.4)
        assert not goal.is_done
        sim.run(0.2)
        assert goal.result.error_code == 207 and goal.reason == "no costmap on /global_costmap/costmap_raw after 0.5 s"


def test_a_path_is_checked_from_the_robot_on(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path)) as sim:
        sim.run(1.3)
        path = {"header": {"frame_id": "map"}, "poses": [pose(x, 0.0) for x in (2.0, 1.0, 0.1, 1.0)]}
        assert sim.call("/is_path_valid", {"path": path}).is_valid  # the robot at 0 has left the wall behind
        path["poses"].append(pose(99.0, 0.0))
        assert list(sim.call("/is_path_valid", {"path": path}).invalid_pose_indices) == [4]
