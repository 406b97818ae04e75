"""Smoothers of paths, and the action of their server."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from navigation_worlds import pose, world

import simkit
from simkit import Params
from simkit_navigation.plugins.costmaps.cost_grid import LETHAL, CostGrid
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose
from simkit_navigation.plugins.planners.path_smoothing import Relaxation, directional_segments, filtered, relax
from simkit_navigation.plugins.planners.smoothers import SavitzkyGolaySmoother, SimpleSmoother

SERVER = '<plugin filename="libsimkit_smoother_server.so" name="smoother_server">{}</plugin>'


def grid(*blocked: tuple[int, int]) -> CostGrid:
    cells = np.zeros((60, 60), np.uint8)
    for cell in blocked:
        cells[cell] = LETHAL
    return CostGrid(cells, 0.1, PlanarPose(-1.05, -1.05, 0.0), "map")


def corner() -> np.ndarray[Any, Any]:
    """Return a path along two sides of a square, with a step of 0.1 m."""
    ahead = [(0.1 * i, 0.0, 0.0) for i in range(20)]
    return np.array(ahead + [(2.0, 0.1 * i, math.pi / 2) for i in range(21)])


def smoothed(path: Any, cls: Any = SimpleSmoother, costs: CostGrid | None = None, **options: float | str) -> Any:
    smoother = cls()
    smoother.configure(None, Params.from_dict(options))
    return smoother.smooth(np.asarray(path), costs or grid())


def test_the_simple_smoother_ends_where_both_pulls_are_equal() -> None:
    """At the limit w_data·(original - point) + w_smooth·(second difference) is 0 at each inner point."""
    points = corner()[:, :2]
    found = relax(points, None, Relaxation(0.2, 0.3, 1e-10, 1000, 0))
    pull = 0.2 * (points - found)[1:-1] + 0.3 * (found[:-2] + found[2:] - 2 * found[1:-1])
    assert np.abs(pull).max() < 1e-9
    assert np.array_equal(found[[0, -1]], points[[0, -1]])
    assert np.hypot(*(found[20] - points[20])) > 0.04  # the corner is cut


def test_refinement_smooths_more_and_poses_look_ahead() -> None:
    once, thrice = smoothed(corner(), do_refinement="false"), smoothed(corner(), refinement_num=2)
    cut = [float(np.hypot(*(path[20, :2] - (2.0, 0.0)))) for path in (once, thrice)]
    assert cut[1] > 1.5 * cut[0] > 0.0
    for path in (once, thrice):
        ahead = np.diff(path[:, :2], axis=0)
        assert np.arctan2(ahead[:, 1], ahead[:, 0]) == pytest.approx(path[:-1, 2], abs=1e-9)
        assert path[-1].tolist() == corner()[-1].tolist()


def test_the_smoother_stops_before_it_touches_an_obstacle() -> None:
    """A cell inside of the corner is occupied, which the path crosses without obstacles."""
    free = smoothed(corner(), refinement_num=20)
    crossed = grid().to_cell(*free[20, :2])
    assert crossed is not None
    costs = grid(crossed)
    assert not costs.is_blocked(corner()[:, :2]).any()
    found = smoothed(corner(), costs=costs, refinement_num=20)
    assert not costs.is_blocked(found[:, :2]).any() and np.abs(found - corner()).max() > 0.03


def test_reversals_of_a_path_stay_unless_the_file_says_otherwise() -> None:
    there = [(0.1 * i, 0.0, 0.0) for i in range(11)]
    back = [(1.0 - 0.1 * i, 0.02 * i, 0.0) for i in range(1, 11)]
    path = np.array(there + back)
    assert directional_segments(path) == [(0, 10), (10, 20)]
    kept = smoothed(path)
    assert kept[10].tolist()[:2] == [1.0, 0.0]
    assert abs(kept[15, 2]) < 0.3  # the robot drives backwards there
    assert smoothed(path, enforce_path_inversion="false")[10, 0] < 0.95


def test_the_filter_keeps_a_cubic_curve_and_removes_noise() -> None:
    x = np.arange(30) * 0.1
    cubic = np.column_stack((x, 0.1 * x**3 - 0.2 * x**2))
    assert np.abs(filtered(cubic, 1) - cubic)[3:-3].max() < 1e-12
    noisy = np.column_stack((x, 0.01 * (-1.0) ** np.arange(30), np.zeros(30)))
    assert np.abs(smoothed(noisy, SavitzkyGolaySmoother)[6:-6, 1]).max() < 0.001
    few = noisy[:9]
    assert np.array_equal(smoothed(few, SavitzkyGolaySmoother), few)


OWN = """
class Halve:
    names = ("my_smoothers::Halve",)

    def smooth(self, path, grid):
        return path[::2, :2] if len(path) > 2 else None
"""


def request(*points: tuple[float, float, float], **more: object) -> dict[str, Any]:
    return {"path": {"header": {"frame_id": "map"}, "poses": [pose(*point) for point in points]}, **more}


def test_the_server_smooths_checks_and_names_its_errors(tmp_path: Path) -> None:
    (tmp_path / "own.py").write_text(OWN, "utf-8")
    options = "<smoother_plugins>simple own</smoother_plugins><own><plugin>my_smoothers/Halve</plugin></own>"
    options += "<simple><plugin>nav2_smoother::SimpleSmoother</plugin></simple>"
    file = world(tmp_path)
    file.write_text(file.read_text("utf-8").replace("</world>", f"{SERVER.format(options)}</world>"), "utf-8")
    with simkit.load(file, plugin_paths=[tmp_path]) as sim:
        paths = sim.subscribe("/plan_smoothed", keep=9)
        early = sim.send_goal("/smooth_path", request((0.0, 0.0, 0.0)))
        sim.run(1.3)
        free = [(0.1 * i, 0.0 if i < 5 else 0.1, 0.0) for i in range(10)]
        blocked = [(0.3 * i, 0.0, 0.0) for i in range(10)]
        wanted = [
            request(*free, check_for_collisions=True),
            request(*free, smoother_id="own"),
            request(*free, smoother_id="nobody"),
            request(),
            request((0.0, 0.0, 0.0), smoother_id="own"),
            request(*blocked, check_for_collisions=True),
            request(*blocked),
        ]
        goals = [sim.send_goal("/smooth_path", one) for one in wanted]
        sim.step(2)
        assert [goal.result.error_code for goal in (early, *goals)] == [500, 0, 0, 501, 505, 504, 503, 0]
        assert goals[0].result.was_completed and len(goals[0].result.path.poses) == 10
        assert len(goals[1].result.path.poses) == 5
        assert "x = 1.8" in goals[5].reason  # the wall begins at 1.95 m, the robot has a radius of 0.24 m
        assert len(paths.messages) == 4


def test_a_smoother_that_simkit_does_not_have_is_replaced_and_told(tmp_path: Path) -> None:
    options = (
        "<smoother_plugins>s</smoother_plugins><s><plugin>nav2_constrained_smoother/ConstrainedSmoother</plugin></s>"
    )
    text = f'<sdf version="1.9"><world name="w">{SERVER.format(options)}</world></sdf>'
    with simkit.load(text) as sim:
        (told,) = [item.message for item in sim.diagnostics if item.code == "SK-NAV-001"]
        assert "nav2_smoother::SimpleSmoother replaces nav2_constrained_smoother::ConstrainedSmoother" in told
