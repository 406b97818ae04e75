"""Controller: pure pursuit, goals, lack of progress, controllers of users."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from controller_nodes import controller_node
from navigation_worlds import DRIVE, WALL, pose, run_until_done, world

import simkit
from simkit import Params
from simkit.errors import LoadError
from simkit_navigation.plugins.controllers.pure_pursuit import PurePursuit
from simkit_navigation.plugins.costmaps.cost_grid import INSCRIBED, CostGrid
from simkit_navigation.plugins.costmaps.footprint import round_footprint
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose


def pursuit(path: Any, **options: float | str) -> PurePursuit:
    found = PurePursuit()
    found.configure(controller_node(), Params.from_dict(options))
    found.set_plan(np.array(path, np.float64))
    return found


@pytest.mark.parametrize("aside", [0.0, 0.1, -0.2, 0.3])
def test_the_robot_drives_on_the_arc_through_the_lookahead_point(aside: float) -> None:
    path = [(x, aside, 0.0) for x in np.linspace(0.0, 3.0, 61)]
    found = pursuit(path, use_regulated_linear_velocity_scaling="false").compute_velocity_commands(
        PlanarPose(0.0, 0.0, 0.0), (0.0, 0.0), None
    )
    assert found is not None
    assert found[0] == 0.5
    assert found[1] == pytest.approx(0.5 * 2 * aside / 0.6**2, abs=1e-9)  # curvature 2 y / L²


def test_the_robot_turns_on_the_spot_to_a_path_behind_it_and_stops_for_an_obstacle() -> None:
    controller = pursuit([(-x, 0.05, 0.0) for x in np.linspace(0.0, 2.0, 41)])
    found = controller.compute_velocity_commands(PlanarPose(0.0, 0.0, 0.0), (0.0, 0.0), None)
    assert found == (0.0, pytest.approx(3.2 / 20))  # by the largest angular acceleration
    controller = pursuit([(x, 0.0, 0.0) for x in np.linspace(0.0, 2.0, 41)])
    cells = np.zeros((80, 80), np.uint8)
    grid = CostGrid(cells, 0.05, PlanarPose(-2.0, -2.0, 0.0), "map")
    assert controller.compute_velocity_commands(PlanarPose(0.0, 0.0, 0.0), (0.5, 0.0), grid) == (0.5, 0.0)
    cells[39:42, 48] = INSCRIBED  # in 0.4 m, and the robot reaches 0.5 m in the allowed second
    assert controller.compute_velocity_commands(PlanarPose(0.0, 0.0, 0.0), (0.5, 0.0), grid) is None


def test_an_arc_is_checked_once_around_however_long_the_time_is() -> None:
    """An obstacle on the other side of the circle of 0.5 m is found; one beside it is not."""
    cells = np.zeros((80, 80), np.uint8)
    grid = CostGrid(cells, 0.05, PlanarPose(-2.0, -2.0, 0.0), "map")
    begin, outline = PlanarPose(0.0, 0.0, 0.0), round_footprint(0.2)
    for speeds in ((0.5, 1.0), (1e9, 2e9), (1e-9, 2e-9)):
        cells[:] = 0
        cells[30:50, 20] = INSCRIBED
        assert not outline.collides_ahead(grid, begin, speeds, 1e12)
        cells[60, 40] = INSCRIBED  # at (0.0, 1.0)
        assert outline.collides_ahead(grid, begin, speeds, 1e12)
    assert not outline.collides_ahead(grid, begin, (0.0, 0.0), 1e12)


def path(*points: tuple[float, float, float]) -> dict[str, Any]:
    return {"path": {"header": {"frame_id": "map"}, "poses": [pose(*point) for point in points]}}


def test_a_path_is_followed_to_its_end_and_its_yaw(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path)) as sim:
        sim.run(0.5)
        feedback: list[Any] = []
        line = [(0.02 * i, 0.1 * math.sin(0.06 * i), 0.0) for i in range(50)]
        goal = sim.send_goal("/follow_path", path(*line, (1.0, 0.0, 1.0)), on_feedback=feedback.append)
        run_until_done(sim, goal)
        assert goal.status.name == "SUCCEEDED"
        sim.run(0.5)
        found = sim.model("turtlebot3").pose
        assert math.hypot(found.position[0] - 1.0, found.position[1]) < 0.06
        assert abs(found.rpy[2] - 1.0) < 0.05
        distances = [one.distance_to_goal for one in feedback]
        assert distances[0] > 0.95 and distances[-1] < 0.06 and feedback[20].speed == pytest.approx(0.26, abs=0.02)
        empty = sim.send_goal("/follow_path", path())
        unknown = sim.send_goal("/follow_path", {**path((1.0, 0.0, 0.0)), "controller_id": "X"})
        sim.step(2)
        assert [one.result.error_code for one in (empty, unknown)] == [103, 101]


def test_an_obstacle_and_a_lack_of_progress_abort(tmp_path: Path) -> None:
    wall = WALL.replace("<pose>2 ", "<pose>1 ")
    checker = "<progress_checker><movement_time_allowance>3</movement_time_allowance></progress_checker>"
    with simkit.load(world(tmp_path, models=wall, controller=DRIVE + checker)) as sim:
        sim.run(0.5)
        goal = sim.send_goal("/follow_path", path(*((0.1 * i, 0.0, 0.0) for i in range(20))))
        run_until_done(sim, goal)
        assert (goal.status.name, goal.result.error_code) == ("ABORTED", 106)
        assert goal.result.error_msg == goal.reason != ""
        sim.run(1.0)
        place = sim.model("turtlebot3").pose.position[0]
        assert 0.3 < place < 0.95 - 0.24  # it has stopped in front of the wall
        assert sim.link("turtlebot3::base_footprint").linear_velocity[0] == pytest.approx(0.0, abs=0.01)
    blind = DRIVE.replace("</F", "<use_collision_detection>false</use_collision_detection></F")
    with simkit.load(world(tmp_path, models=wall, controller=blind + checker)) as sim:
        sim.run(0.5)
        goal = sim.send_goal("/follow_path", path(*((0.1 * i, 0.0, 0.0) for i in range(20))))
        run_until_done(sim, goal)
        assert (goal.status.name, goal.result.error_code) == ("ABORTED", 105)


CONTROLLER = """
class Creep:
    def configure(self, node, params):
        self.speed = params.number("speed")

    def set_plan(self, path):
        self.end = path[-1]

    def compute_velocity_commands(self, pose, velocity, grid):
        return (self.speed, 0.0) if grid is not None else None
"""


def test_a_controller_of_a_user_drives(tmp_path: Path) -> None:
    (tmp_path / "creep.py").write_text(CONTROLLER, "utf-8")
    options = "<controller_plugins>C</controller_plugins><C><plugin>creep.py:Creep</plugin><speed>0.1</speed></C>"
    with simkit.load(world(tmp_path, controller=options), plugin_paths=[tmp_path]) as sim:
        sim.run(0.5)
        goal = sim.send_goal("/follow_path", path((0.0, 0.0, 0.0), (0.4, 0.0, 0.0)))
        run_until_done(sim, goal)
        assert goal.status.name == "SUCCEEDED"
        assert sim.model("turtlebot3").pose.position[0] == pytest.approx(0.36, abs=0.02)


def test_a_controller_without_set_plan_is_an_error_of_the_load(tmp_path: Path) -> None:
    (tmp_path / "own.py").write_text("class Own:\n    def compute_velocity_commands(self, *_): ...\n", "utf-8")
    options = "<controller_plugins>Own</controller_plugins><Own><plugin>own.py:Own</plugin></Own>"
    with pytest.raises(LoadError, match="has no method 'set_plan'"):
        simkit.load(world(tmp_path, controller=options), plugin_paths=[tmp_path])
