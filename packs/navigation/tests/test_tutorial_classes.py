"""Classes of Nav2's tutorials, and classes of users under the names of C++ that a file gives."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
import pytest
from navigation_worlds import place, pose, run_until_done, world

import simkit
from simkit.errors import LoadError
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.costmaps.update_window import Bounds, Window, window_of
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

LINE = """<planner_plugins>GridBased</planner_plugins><GridBased><plugin>nav2_straightline_planner/StraightLine</plugin>
  <interpolation_resolution>0.25</interpolation_resolution></GridBased>"""
PURSUIT = """<FollowPath><plugin>nav2_pure_pursuit_controller::PurePursuitController</plugin><lookahead_dist>0.3
  </lookahead_dist><desired_linear_vel>0.2</desired_linear_vel><max_angular_vel>1.0</max_angular_vel>
  <transform_tolerance>1.0</transform_tolerance></FollowPath>"""
COSTMAP = """<sdf version="1.9"><world name="w"><plugin filename="libsimkit_costmap_2d.so" name="local_costmap">
  <resolution>0.1</resolution><width>3</width><height>2</height>{}</plugin></world></sdf>"""


@pytest.mark.slow  # a drive of 1 m
def test_a_robot_drives_with_the_planner_and_the_controller_of_the_tutorials(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path, planner=LINE, controller=PURSUIT)) as sim:
        plans = sim.subscribe("/plan", keep=1)
        sim.run(1.3)
        goal = sim.send_goal("/navigate_to_pose", {"pose": pose(1.0, 0.3)})
        sim.run(0.2)
        places = [one.pose.position for one in plans.latest.poses]
        gaps = [math.hypot(b.x - a.x, b.y - a.y) for a, b in itertools.pairwise(places)]
        assert (
            len(places) == 5 and gaps == pytest.approx([gaps[0]] * 4) and gaps[0] == pytest.approx(1.044 / 4, abs=0.01)
        )
        run_until_done(sim, goal, 20.0)
        end = sim.model("turtlebot3").pose.position
        assert math.hypot(end[0] - 1.0, end[1] - 0.3) < 0.08
        assert not [item for item in sim.diagnostics if item.code == "SK-PARAM-003"]


GRADIENT = """<plugins>a b</plugins><a><plugin>nav2_gradient_costmap_plugin/GradientLayer</plugin></a>
  <b><plugin>nav2_gradient_costmap_plugin::GradientLayer</plugin><enabled>false</enabled></b>"""


def test_the_gradient_layer_writes_its_steps_into_each_row() -> None:
    with simkit.load(COSTMAP.format(GRADIENT)) as sim:
        place(sim)
        sim.run(0.5)
        cells = sim.plugins["local_costmap"].grid.cells
        expected = [254 - 10 * (column % 22) for column in range(30)]
        assert cells.tolist() == [expected] * 20


OWN = """
class Line:
    names = ("nav2_straightline_planner::StraightLine",)

    def configure(self, node, params):
        self.bow = params.number("bow", 0.0)

    def create_plan(self, grid, start, goal):
        return [(start.x, start.y), (1.0, self.bow), (goal.x, goal.y)]


class Corner:
    names = "my_layers::Corner"

    def on_initialize(self, node, params):
        self.cost = params.integer("cost", 100)

    def update_bounds(self, robot, bounds):
        bounds.include_point(robot.x, robot.y)
        bounds.include_point(robot.x + 0.45, robot.y + 0.25)

    def update_costs(self, grid, window):
        grid.cells[window.rows, window.columns] = self.cost
        grid.cells[-1, -1] = 77
"""


def test_a_class_of_a_user_comes_before_the_one_of_simkit_under_the_name_in_the_file(tmp_path: Path) -> None:
    (tmp_path / "own.py").write_text(OWN, "utf-8")
    options = LINE.replace("</GridBased>", "<bow>0.4</bow></GridBased>")
    with simkit.load(world(tmp_path, planner=options), plugin_paths=[tmp_path]) as sim:
        sim.run(1.3)
        goal = sim.send_goal("/compute_path_to_pose", {"goal": pose(1.5, 0.0)})
        sim.step(2)
        assert [one.pose.position.y for one in goal.result.path.poses] == [pytest.approx(0.0, abs=1e-3), 0.4, 0.0]


def test_a_layer_writes_only_into_the_window_that_it_declares(tmp_path: Path) -> None:
    """Both instances have the window of 5 × 3 cells at the robot; the disabled one does nothing."""
    (tmp_path / "own.py").write_text(OWN, "utf-8")
    block = "<{0}><plugin>my_layers/Corner</plugin><cost>{1}</cost><enabled>{2}</enabled></{0}>"
    blocks = block.format("a", 50, "true") + block.format("b", 90, "false")
    with simkit.load(COSTMAP.format(f"<plugins>a b</plugins>{blocks}"), plugin_paths=[tmp_path]) as sim:
        place(sim, 1.02, 0.52)
        sim.run(0.5)
        cells = sim.plugins["local_costmap"].grid.cells
        assert (cells[5:8, 10:15] == 50).all() and cells.sum() == 15 * 50
        place(sim, 2.02, 1.02)
        sim.run(0.5)
        cells = sim.plugins["local_costmap"].grid.cells
        assert (cells[5:8, 10:15] == 50).all()  # outside of the window, the costs stay as they were
        assert (cells[10:13, 20:25] == 50).all() and cells.sum() == 2 * 15 * 50


def test_a_name_that_nothing_has_is_an_error_that_says_how_to_give_it(tmp_path: Path) -> None:
    with pytest.raises(LoadError, match=r'names = \("nowhere::Planner",\)'):
        simkit.load(world(tmp_path, planner=LINE.replace("nav2_straightline_planner/StraightLine", "nowhere/Planner")))


def test_a_window_contains_all_cells_that_its_bounds_touch() -> None:
    grid = CostGrid(np.zeros((20, 30), np.uint8), 0.1, PlanarPose(-1.0, -1.0, 0.0), "map")
    bounds = Bounds()
    assert window_of(grid, bounds) == Window(0, 0, 0, 0)
    bounds.include(Bounds(-0.95, -0.75, -0.72, -0.68))
    assert window_of(grid, bounds) == Window(0, 2, 3, 4)
    bounds.include_everything()
    assert window_of(grid, bounds) == Window(0, 0, 30, 20)
    assert window_of(grid, Bounds(50.0, 50.0, 51.0, 51.0)) == Window(30, 20, 30, 20)
    assert window_of(grid, Bounds(math.nan, 0.0, 1.0, 1.0)) == Window(0, 0, 0, 0)
