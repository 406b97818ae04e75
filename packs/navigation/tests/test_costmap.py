"""Costmap: costs of the layers, services, and layers of users."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from navigation_worlds import WALL, place

import simkit
from simkit.errors import LoadError, PluginError
from simkit_navigation.plugins.costmaps.cost_grid import FREE, INSCRIBED, LETHAL, UNKNOWN, CostGrid, grid_of_message
from simkit_navigation.plugins.costmaps.footprint import read_footprint, round_footprint
from simkit_navigation.plugins.costmaps.obstacle_layer import shifted
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

COSTMAP = '<plugin filename="libsimkit_costmap_2d.so" name="global_costmap">{}</plugin>'
SCAN = {"angle_min": 0.0, "angle_increment": math.pi / 2, "range_min": 0.1, "range_max": 4.0}


def world(folder: Path, options: str, model: str = WALL, has_map: bool = True) -> Path:
    server = '<plugin filename="libsimkit_map_server.so" name="map_server"/>' if has_map else ""
    file = folder / "costmap.sdf"
    text = f'<sdf version="1.9"><world name="w">{model}{server}{COSTMAP.format(options)}</world></sdf>'
    file.write_text(text, "utf-8")
    return file


def costs(sim: simkit.Simulation) -> CostGrid:
    found = grid_of_message(sim.call("/global_costmap/get_costmap").map)
    assert found is not None
    return found


def scan(sim: simkit.Simulation, *ranges: float, frame: str = "base_footprint") -> None:
    header = {"frame_id": frame, "stamp": simkit.msgs.time(sim.time_ns)}
    publisher = sim.advertise("/scan", "sensor_msgs/msg/LaserScan")
    publisher.publish({"header": header, "ranges": np.array(ranges, np.float32), **SCAN})


def test_costs_decay_with_the_distance_from_the_map(tmp_path: Path) -> None:
    """The formula of Nav2: 252 exp(-k (d - r)) beyond the inscribed radius, 0 beyond the inflation radius."""
    options = "<robot_radius>0.2</robot_radius><inflation_layer><cost_scaling_factor>3</cost_scaling_factor>"
    with simkit.load(world(tmp_path, f"{options}<inflation_radius>0.45</inflation_radius></inflation_layer>")) as sim:
        published = sim.subscribe("/global_costmap/costmap", keep=1)
        place(sim)
        sim.run(0.5)
        grid = costs(sim)
        # the wall occupies the cells from x = 1.95 to 2.05; the distance between centres of cells counts
        assert grid.cost(2.02, 0.0) == grid.cost(1.97, 0.0) == LETHAL
        for cells in range(1, 5):
            assert grid.cost(1.97 - 0.05 * cells, 0.0) == INSCRIBED
        for cells in range(5, 10):
            expected = int(252 * math.exp(-3.0 * (0.05 * cells - 0.2)))
            assert grid.cost(1.975 - 0.05 * cells, 0.0) == pytest.approx(expected, abs=1)
        assert grid.cost(1.975 - 0.5, 0.0) == FREE
        assert grid.cost(50.0, 0.0) == UNKNOWN
        shown = np.asarray(published.latest.data).reshape(grid.cells.shape)
        assert set(np.unique(shown[grid.cells == LETHAL])) == {100}
        assert set(np.unique(shown[grid.cells == INSCRIBED])) == {99}
        assert shown.max() == 100 and shown[grid.cells == FREE].max() == 0


def test_a_beam_marks_its_end_and_clears_what_is_before_it(tmp_path: Path) -> None:
    options = "<resolution>0.05</resolution><origin_x>-2.5</origin_x><origin_y>-2.5</origin_y>"
    with simkit.load(world(tmp_path, f"{options}<plugins>obstacle_layer</plugins>", "", has_map=False)) as sim:
        place(sim)
        sim.run(0.1)
        scan(sim, 1.02, math.inf, math.inf, math.inf)
        sim.run(0.25)
        assert costs(sim).cost(1.02, 0.01) == LETHAL
        scan(sim, 2.02, 1.02, math.inf, 0.05)  # the last one is below the smallest range
        sim.run(0.25)
        grid = costs(sim)
        assert [grid.cost(1.02, 0.01), grid.cost(2.02, 0.01), grid.cost(0.01, 1.02)] == [FREE, LETHAL, LETHAL]
        assert (grid.cells == LETHAL).sum() == 2
        sim.call("/global_costmap/clear_entirely_global_costmap")
        assert (costs(sim).cells == LETHAL).sum() == 0
        scan(sim, 2.3, 2.6, 1.02, 1.02)  # the second one is beyond obstacle_max_range
        sim.run(0.25)
        assert (costs(sim).cells == LETHAL).sum() == 3


def test_obstacles_stay_in_place_while_the_window_moves(tmp_path: Path) -> None:
    options = "<resolution>0.05</resolution><rolling_window>true</rolling_window><plugins>obstacle_layer</plugins>"
    with simkit.load(world(tmp_path, options, "", has_map=False)) as sim:
        place(sim)
        sim.run(0.1)
        scan(sim, 1.02, math.inf, math.inf, math.inf)
        sim.run(0.2)
        before = costs(sim).origin
        place(sim, 0.33, -0.21)
        scan(sim, math.inf, math.inf, math.inf, math.inf)
        sim.run(0.25)
        grid = costs(sim)
        assert (grid.origin.x - before.x, grid.origin.y - before.y) == pytest.approx((0.3, -0.25))
        assert grid.cost(1.02, 0.01) == LETHAL
        assert (grid.cells == LETHAL).sum() == 1


@pytest.mark.parametrize(("up", "right"), [(0, 0), (1, 2), (-1, 3), (2, -2), (9, 0), (0, -9)])
def test_a_shifted_window_has_the_same_cells(up: int, right: int) -> None:
    cells = np.arange(1, 31, dtype=np.uint8).reshape(5, 6)
    wide = np.full((25, 26), UNKNOWN, np.uint8)
    wide[10:15, 10:16] = cells
    assert np.array_equal(shifted(cells, up, right), wide[10 + up : 15 + up, 10 + right : 16 + right])


LAYER = """
class Stripe:
    def on_initialize(self, node, params):
        self.cost = params.integer("cost", 7)

    def update_costs(self, grid, robot):
        row, column = grid.to_cell(robot.x, robot.y)
        grid.cells[row] = self.cost
"""


def test_a_layer_of_a_user_writes_costs(tmp_path: Path) -> None:
    (tmp_path / "layers.py").write_text(LAYER, "utf-8")
    options = "<plugins>stripe</plugins><stripe><plugin>layers.py:Stripe</plugin><cost>9</cost></stripe>"
    with simkit.load(world(tmp_path, options), plugin_paths=[tmp_path]) as sim:
        place(sim, 1.0, 2.0)
        sim.run(0.3)
        grid = costs(sim)
        assert [grid.cost(1.0, 2.0), grid.cost(4.0, 2.0), grid.cost(1.0, 2.3)] == [9, 9, FREE]
        assert not [d for d in sim.diagnostics if d.severity != "note"]


@pytest.mark.parametrize(
    ("options", "code", "problem"),
    [
        ("<plugins>a</plugins><a><plugin>layers.py:Strip</plugin></a>", "SK-PLUGIN-008", "has no class 'Strip'"),
        ("<plugins>a</plugins><a><plugin>gone.py:Stripe</plugin></a>", "SK-PLUGIN-001", "no file 'gone.py'"),
        ("<plugins>a</plugins>", "SK-PLUGIN-008", "found ''"),
        ("<plugins>a</plugins><a><plugin>layers.py:Empty</plugin></a>", "SK-PLUGIN-008", "no method 'update_costs'"),
        ("<footprint>[[0, 1], [1, 0]]</footprint>", "SK-PARAM-002", "with 3 corners or more"),
        ("<width>1e6</width>", "SK-PARAM-002", "cells; at most"),
    ],
)
def test_invalid_options_are_errors(tmp_path: Path, options: str, code: str, problem: str) -> None:
    (tmp_path / "layers.py").write_text(LAYER + "\n\nclass Empty:\n    pass\n", "utf-8")
    with pytest.raises(LoadError) as caught:
        simkit.load(world(tmp_path, options), plugin_paths=[tmp_path])
    (found,) = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert found.code == code and problem in found.message and found.line


def test_a_polygon_collides_where_its_edge_meets_an_obstacle() -> None:
    cells = np.zeros((40, 40), np.uint8)
    cells[20, 30] = LETHAL  # at (0.5, 0) to (0.55, 0.05)
    grid = CostGrid(cells, 0.05, PlanarPose(-1.0, -1.0, 0.0), "map")
    outline = read_footprint(simkit_node(), "[[0.3, 0.1], [0.3, -0.1], [-0.3, -0.1], [-0.3, 0.1]]", 1.0)
    assert (outline.inscribed_radius, outline.circumscribed_radius) == pytest.approx((0.1, math.hypot(0.3, 0.1)))
    assert outline.collides(grid, PlanarPose(0.22, 0.02, 0.0))
    assert not outline.collides(grid, PlanarPose(0.15, 0.02, 0.0))
    assert not outline.collides(grid, PlanarPose(0.22, 0.02, math.pi / 2))
    assert not round_footprint(0.1).collides(grid, PlanarPose(0.22, 0.02, 0.0))


def simkit_node() -> Any:
    class Node(simkit.WorldPlugin):
        def load(self, parent: Any, params: Any) -> None: ...

    return Node()


def test_a_map_without_a_frame_gives_no_costs(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path, "", has_map=False)) as sim:
        info = {"resolution": 0.1, "width": 2, "height": 1, "origin": {"orientation": {"w": 1.0}}}
        sim.advertise("/map", "nav_msgs/msg/OccupancyGrid").publish({"info": info, "data": np.zeros(2, np.int8)})
        sim.run(0.5)


def test_topics_of_another_type_are_reported_once(tmp_path: Path) -> None:
    layers = "<static_layer><map_topic>/clock</map_topic></static_layer>"
    layers += "<obstacle_layer><scan><topic>/parameter_events</topic></scan></obstacle_layer>"
    with simkit.load(world(tmp_path, layers)) as sim:
        sim.subscribe("/clock")
        sim.run(0.1)
        sim.advertise("/parameter_events", "rcl_interfaces/msg/ParameterEvent").publish({})
        sim.run(0.4)
        found = [d.message.partition(": ")[2] for d in sim.diagnostics if d.code == "SK-PLUGIN-041"]
    wrong = {
        "rcl_interfaces/msg/ParameterEvent on <scan.topic>": "sensor_msgs/msg/LaserScan",
        "rosgraph_msgs/msg/Clock on <map_topic>": "nav_msgs/msg/OccupancyGrid",
    }
    assert sorted(found) == [
        f"messages of the type {given} are ignored; expected {expected}" for given, expected in wrong.items()
    ]


def test_one_point_is_in_the_same_cell_as_among_many() -> None:
    grid = CostGrid(np.zeros((8, 13), np.uint8), 0.05, PlanarPose(-0.3, 1.7, 0.4), "map")
    points = grid.centres(*np.mgrid[-1.5:9:0.5, -1.5:14:0.5].reshape(2, -1))  # centres, edges and corners of cells
    for (x, y), *cell, is_inside in zip(points.tolist(), *grid.indices(points), strict=True):
        assert grid.to_cell(x, y) == (tuple(cell) if is_inside else None)
    assert grid.to_cell(math.nan, 0.0) is grid.to_cell(math.inf, 0.0) is None


def test_a_ray_ends_at_the_border_of_the_costmap(tmp_path: Path) -> None:
    """A range of 10¹² m is checked in the cells of the costmap only."""
    source = "<scan><inf_is_valid>true</inf_is_valid><raytrace_max_range>1e12</raytrace_max_range></scan>"
    layer = f"<obstacle_layer>{source}</obstacle_layer>"
    with simkit.load(world(tmp_path, f"<track_unknown_space>true</track_unknown_space>{layer}", has_map=False)) as sim:
        place(sim, 1.05, 1.05)
        scan(sim, math.inf)
        sim.run(0.3)
        assert (costs(sim).cells[10, 10:] == FREE).all()


@pytest.mark.parametrize("change", ["grid.cells * 1.0", "grid.cells[:3]", "None"])
def test_a_layer_must_keep_size_and_type_of_the_cells(tmp_path: Path, change: str) -> None:
    text = f"class Layer:\n    def update_costs(self, grid, robot):\n        grid.cells = {change}\n"
    (tmp_path / "layer.py").write_text(text, "utf-8")
    options = "<plugins>own</plugins><own><plugin>layer.py:Layer</plugin></own>"
    with simkit.load(world(tmp_path, options), plugin_paths=[tmp_path]) as sim:
        place(sim)
        with pytest.raises(PluginError, match="own: grid.cells must remain an array of uint8"):
            sim.run(0.5)


def test_a_footprint_with_a_number_that_is_too_large_is_reported(tmp_path: Path) -> None:
    corners = f"<footprint>[[1{'0' * 400}, 2], [3, 4], [5, 6]]</footprint>"
    with pytest.raises(LoadError, match="expected .* with 3 corners"):
        simkit.load(world(tmp_path, corners))


def test_a_steep_decay_does_not_overflow(tmp_path: Path) -> None:
    steep = "<cost_scaling_factor>1e5</cost_scaling_factor>"
    with np.errstate(over="raise"), simkit.load(world(tmp_path, f"<inflation_layer>{steep}</inflation_layer>")) as sim:
        place(sim)
        sim.run(0.5)
        assert set(np.unique(costs(sim).cells)) == {FREE, INSCRIBED, LETHAL}
