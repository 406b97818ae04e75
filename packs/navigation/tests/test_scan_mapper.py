"""Mapping with an odometry that drifts: scans are matched, loops are closed, and the walls are where they are."""

from __future__ import annotations

import itertools
import math
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from simkit_navigation.plugins.maps.correlation_matcher import CorrelationMatcher, SearchRules
from simkit_navigation.plugins.maps.line_refinement import refine
from simkit_navigation.plugins.maps.pose_graph import Edge, information_of, optimised
from simkit_navigation.plugins.maps.pose_graph_file import PoseGraphFault, read_pose_graph, write_pose_graph
from simkit_navigation.plugins.maps.scan_mapper import MapperSettings, MapScan, ScanMapper
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

Floats = npt.NDArray[np.float64]

WALLS = np.array(  # x and y of both ends [m]: a room with a corner, a pillar and a niche
    [
        *((0, 0, 6, 0), (6, 0, 6, 4), (6, 4, 2, 4), (2, 4, 2, 3), (2, 3, 0, 3), (0, 3, 0, 0)),
        *((3.5, 1.5, 3.9, 1.5), (3.9, 1.5, 3.9, 1.9), (3.9, 1.9, 3.5, 1.9), (3.5, 1.9, 3.5, 1.5)),
    ],
    float,
)
ANGLES = np.linspace(-math.pi, math.pi, 240, endpoint=False)
SENSOR = PlanarPose(0.1, 0.0, 0.0)


def ranges(pose: PlanarPose, walls: Floats = WALLS) -> Floats:
    """Return the distances to the nearest wall from the sensor of a robot at a pose."""
    at = pose.compose(SENSOR)
    directions = np.column_stack((np.cos(ANGLES + at.yaw), np.sin(ANGLES + at.yaw)))
    begin, along = walls[:, :2] - (at.x, at.y), walls[:, 2:] - walls[:, :2]
    across = directions[:, 0, None] * along[:, 1] - directions[:, 1, None] * along[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = (begin[:, 0] * along[:, 1] - begin[:, 1] * along[:, 0]) / across
        share = (begin[:, 0] * directions[:, 1, None] - begin[:, 1] * directions[:, 0, None]) / across
    is_met = (reach > 0) & (share >= 0) & (share <= 1)
    nearest: Floats = np.where(is_met, reach, np.inf).min(axis=1)
    return nearest


def circle(steps: int) -> list[PlanarPose]:
    """Return poses on a way around the pillar."""
    turns = np.linspace(0.0, math.tau, steps)
    poses = [(3.7 + 1.6 * math.cos(t), 1.75 + 0.9 * math.sin(t), t + math.pi / 2) for t in turns.tolist()]
    return [PlanarPose(x, y, math.remainder(yaw, math.tau)) for x, y, yaw in poses]


def drive(
    truth: list[PlanarPose], settings: MapperSettings, walls: Floats = WALLS, drift: float = 0.06, turn: float = 0.012
) -> tuple[ScanMapper, Floats, float]:
    """Map walls from poses whose odometry is too long and turns too far.

    Returns:
        Mapper, the error of each pose in the map, and the error of the odometry at the end [m].
    """
    generator = np.random.default_rng(1)
    mapper = ScanMapper(settings)
    odometry, before = PlanarPose(0.0, 0.0, 0.0), truth[0]
    for pose in truth:
        moved, before = before.inverse().compose(pose), pose
        far = math.hypot(moved.x, moved.y) + abs(moved.yaw)
        moved = PlanarPose(moved.x * (1 + drift), moved.y * (1 + drift), moved.yaw + turn * (far > 0.01))
        odometry = odometry.compose(moved)
        guess = mapper.scans[-1].pose.compose(moved) if mapper.scans else odometry
        noise = generator.normal(0.0, 0.01, len(ANGLES))
        mapper.add_scan(MapScan(ranges(pose, walls) + noise, ANGLES, 8.0, SENSOR, odometry, guess))
    return mapper, errors(mapper, truth), distance(odometry, truth[0].inverse().compose(truth[-1]))


def distance(first: PlanarPose, second: PlanarPose) -> float:
    return math.hypot(first.x - second.x, first.y - second.y)


def errors(mapper: ScanMapper, truth: list[PlanarPose]) -> Floats:
    start = truth[0].inverse()
    return np.array([distance(s.pose, start.compose(t)) for s, t in zip(mapper.scans, truth, strict=True)])


@cache
def mapped(steps: int = 20) -> tuple[ScanMapper, Floats, float]:
    return drive(circle(steps), MapperSettings(max_laser_range=10.0), turn=0.036)


def test_the_pose_in_the_map_does_not_drift_with_the_odometry() -> None:
    _, error, drift = mapped()
    assert drift > 0.5
    assert error.max() < 0.02


def test_the_map_has_the_walls_where_they_are() -> None:
    mapper, _, _ = mapped()
    found = mapper.occupancy()
    rows, columns = np.nonzero(found.cells == 100)
    points = np.column_stack((columns, rows)) * found.resolution + found.origin.position[:2] + found.resolution / 2
    in_room = circle(20)[0].transform(points)
    begin, along = WALLS[:, :2], WALLS[:, 2:] - WALLS[:, :2]
    share = ((in_room[:, None] - begin) * along).sum(axis=2) / (along**2).sum(axis=1)
    nearest = begin + np.clip(share, 0, 1)[..., None] * along
    away = np.hypot(*np.moveaxis(in_room[:, None] - nearest, 2, 0)).min(axis=1)
    assert len(points) > 300
    assert (away < 0.05).mean() > 0.98
    assert (found.cells == 0).sum() * found.resolution**2 > 18.0  # m² of 22


def test_a_map_without_scans_is_empty() -> None:
    assert ScanMapper(MapperSettings()).occupancy().cells.size == 0


def test_rays_that_hit_nothing_make_free_space_and_no_walls() -> None:
    mapper, still = ScanMapper(MapperSettings(resolution=0.1)), PlanarPose(0.0, 0.0, 0.0)
    for _ in range(2):
        mapper.add_scan(MapScan(np.full(240, np.inf), ANGLES, 3.0, SENSOR, still, still))
    cells = mapper.occupancy().cells
    assert (cells == 0).sum() * 0.01 > 20.0 and not (cells == 100).any()
    mapper.add_scan(MapScan(np.full(240, np.nan), ANGLES, 3.0, SENSOR, still, still))
    assert (mapper.occupancy().cells == cells).all()


def test_two_runs_give_the_same_bits() -> None:
    first, second = mapped.__wrapped__(8)[0], mapped.__wrapped__(8)[0]
    assert [scan.pose for scan in first.scans] == [scan.pose for scan in second.scans]
    assert first.occupancy().cells.tobytes() == second.occupancy().cells.tobytes()


def test_invalid_rays_are_left_out() -> None:
    still, measured = PlanarPose(0.0, 0.0, 0.0), ranges(circle(4)[0])
    measured[:5], measured[5:9], angles = -1.0, np.nan, ANGLES.copy()
    angles[20:25] = np.nan
    mapper = ScanMapper(MapperSettings())
    for _ in range(2):
        mapper.add_scan(MapScan(measured, angles, math.inf, SENSOR, still, still))
    assert len(mapper.scans[0].points) == 240 - 14
    assert math.hypot(*mapper.scans[1].pose[:2]) < 1e-3 and (mapper.occupancy().cells == 100).sum() > 50


# ---------------------------------------------------------------------- matching


def points_from(pose: PlanarPose) -> Floats:
    reach = ranges(pose)
    return np.column_stack((np.cos(ANGLES) * reach, np.sin(ANGLES) * reach))


def test_a_scan_is_found_to_5_mm_from_a_guess_that_is_wrong_by_20_cm_and_15_degrees() -> None:
    here, guess = PlanarPose(3.0, 1.0, 0.5), PlanarPose(3.15, 0.87, 0.5 - math.radians(15))
    reference = here.compose(SENSOR).transform(points_from(here))
    matcher = CorrelationMatcher(0.5, 0.01, 0.1, SearchRules())
    found = matcher.match(guess.compose(SENSOR), points_from(here), reference)
    assert distance(found.pose, here.compose(SENSOR)) < 0.02 and found.response > 0.9
    fine = refine(found.pose, points_from(here), reference)
    assert distance(fine, here.compose(SENSOR)) < 0.005
    assert abs(fine.yaw - here.yaw) < math.radians(0.05)


def test_the_variance_along_a_corridor_is_larger_than_across() -> None:
    x = np.arange(-6.0, 6.0, 0.05)
    walls = np.concatenate([np.column_stack((x, np.full(len(x), y))) for y in (-1.0, 1.0)])
    scan = walls[np.abs(walls[:, 0]) < 3.0]
    found = CorrelationMatcher(0.5, 0.01, 0.1, SearchRules()).match(PlanarPose(0.1, 0.0, 0.0), scan, walls)
    xx, _, yy, _ = found.covariance
    assert xx > 10 * yy
    assert abs(found.pose.x - 0.1) < 0.02  # nothing tells more than the odometry


def test_a_scan_without_points_keeps_its_guess() -> None:
    guess, nothing = PlanarPose(1.0, 2.0, 0.3), np.zeros((0, 2))
    found = CorrelationMatcher(0.5, 0.01, 0.1, SearchRules()).match(guess, nothing, points_from(guess))
    assert found.pose == guess and found.response == 0.0
    assert refine(guess, nothing, points_from(guess)) == guess


# ---------------------------------------------------------------------- graph


def test_a_loop_spreads_the_error_over_all_edges_of_a_square() -> None:
    corner = PlanarPose(2.0, 0.0, math.pi / 2)
    measured = PlanarPose(2.1, 0.0, math.pi / 2 + 0.04)
    weight = information_of((0.01, 0.0, 0.01, 0.0025), 0.0)
    edges = [Edge(k, k + 1, measured, weight) for k in range(4)]
    poses = [PlanarPose(0.0, 0.0, 0.0)]
    for edge in edges:
        poses.append(poses[-1].compose(edge.pose))
    assert distance(poses[4], poses[0]) > 0.1
    strong = information_of((1e-6, 0.0, 1e-6, 1e-6), 0.0)
    found = optimised(poses, [*edges, Edge(4, 0, PlanarPose(0.0, 0.0, 0.0), strong, True)])
    assert found[0] == poses[0] and distance(found[4], found[0]) < 1e-3
    for first, second in itertools.pairwise(found):
        step = first.inverse().compose(second)
        assert math.isclose(step.yaw, math.pi / 2, abs_tol=1e-3)  # 0.04 rad too much at each corner was wrong
        assert math.isclose(step.x, corner.x + 0.1, abs_tol=0.02)


def test_a_covariance_turns_into_the_frame_of_a_node() -> None:
    xx, xy, yy, yaw = information_of((0.04, 0.0, 0.01, 0.5), math.pi / 2)
    assert math.isclose(xx, 100.0) and math.isclose(yy, 25.0) and abs(xy) < 1e-9 and yaw == 2.0


def ring() -> tuple[list[PlanarPose], Floats]:
    """Return poses once around a block of 4 m × 3 m in a room of 8 m × 7 m with a few boxes, and the walls."""
    boxes = ((0, 0, 8, 7), (2, 2, 6, 5), (3, 0, 3.4, 0.3), (7.6, 3, 8, 3.5), (5, 6.7, 5.8, 7), (0, 4, 0.3, 4.3))
    walls = [w for x, y, u, v in boxes for w in ((x, y, u, y), (u, y, u, v), (u, v, x, v), (x, v, x, y))]
    corners = [(1.0, 1.0), (7.0, 1.0), (7.0, 6.0), (1.0, 6.0)]
    poses = []
    for (x, y), (u, v) in zip(corners, corners[1:] + corners[:1], strict=True):
        yaw, steps = math.atan2(v - y, u - x), round(2 * math.hypot(u - x, v - y))
        poses += [PlanarPose(x + (u - x) * k / steps, y + (v - y) * k / steps, yaw) for k in range(steps)]
    return poses, np.array(walls, float)


@pytest.mark.parametrize("is_closing", [True, pytest.param(False, marks=pytest.mark.slow)])
def test_a_loop_is_closed_when_the_robot_comes_back(is_closing: bool) -> None:
    settings = MapperSettings(
        max_laser_range=2.5,
        link_scan_maximum_distance=0.3,
        loop_match_minimum_chain_size=5,
        do_loop_closing=is_closing,
    )
    truth, walls = ring()
    mapper, error, drift = drive(truth, settings, walls, drift=0.05, turn=0.03)
    assert drift > 1.0
    assert any(edge.is_loop for edge in mapper.edges) == is_closing == (mapper.loops > 0)
    assert error[-1] < 0.02 if is_closing else error[-1] > 0.08


def test_a_loop_that_contradicts_the_edges_is_refused() -> None:
    mapper = mapped.__wrapped__(8)[0]
    poses, edges = [scan.pose for scan in mapper.scans], len(mapper.edges)
    mapper._close_loop(0, 7, (1e-4, 0.0, 1e-4, 1e-4), mapper.scans[0].pose.compose(PlanarPose(9.0, 0.0, 0.0)))
    assert [scan.pose for scan in mapper.scans] == poses and len(mapper.edges) == edges and mapper.loops == 0


def test_the_map_is_drawn_anew_where_scans_have_moved() -> None:
    mapper = mapped.__wrapped__(8)[0]
    before = mapper.occupancy()
    shift = PlanarPose(1.0, 0.0, 0.0)
    for scan in mapper.scans:
        scan.pose = shift.compose(scan.pose)
    after = mapper.occupancy()
    moved = after.origin.position[0] - before.origin.position[0]
    assert math.isclose(moved, 1.0, abs_tol=0.051)
    assert abs(int((after.cells == 100).sum()) - int((before.cells == 100).sum())) < 30


# ---------------------------------------------------------------------- stored graphs


def test_a_stored_graph_gives_the_same_map_and_localises_a_scan(tmp_path: Path) -> None:
    mapper, _, _ = mapped()
    file = write_pose_graph(str(tmp_path / "room"), mapper.scans, mapper.edges)
    assert file == tmp_path / "room.posegraph" and (tmp_path / "room.data").is_file()
    restored = ScanMapper(mapper.settings)
    restored.restore(*read_pose_graph(str(file)))
    assert restored.occupancy().cells.tobytes() == mapper.occupancy().cells.tobytes()
    assert restored.edges == mapper.edges
    start, true = circle(20)[0], PlanarPose(2.2, 2.4, 1.0)
    expected = start.inverse().compose(true)
    guess = expected.compose(PlanarPose(0.6, -0.5, 0.3))
    found = restored.localise(MapScan(ranges(true), ANGLES, 8.0, SENSOR, PlanarPose(0, 0, 0), guess), is_far=True)
    assert distance(found, expected) < 0.02 and abs(found.yaw - expected.yaw) < math.radians(0.5)
    assert len(restored.scans) == len(mapper.scans)


@pytest.mark.parametrize(
    ("content", "text"),
    [
        (b"\x16\x00\x00\x00serialization::archive", "slam_toolbox in ROS"),
        (b"{}", "damaged"),
        (b'{"format": "simkit pose graph 9"}', "is not 'simkit pose graph 1'"),
        (b'{"format": "simkit pose graph 1", "scans": [{"rays": 5}], "edges": []}', "damaged"),
        (None, "cannot read"),
    ],
)
def test_a_file_that_is_no_pose_graph_is_told(tmp_path: Path, content: bytes | None, text: str) -> None:
    write_pose_graph(str(tmp_path / "map"), [], [])
    if content is None:
        (tmp_path / "map.posegraph").unlink()
    else:
        (tmp_path / "map.posegraph").write_bytes(content)
    with pytest.raises(PoseGraphFault, match=text):
        read_pose_graph(str(tmp_path / "map"))


def test_a_file_of_the_user_is_not_replaced(tmp_path: Path) -> None:
    (tmp_path / "map.data").write_text("my data")
    with pytest.raises(PoseGraphFault, match="choose another name"):
        write_pose_graph(str(tmp_path / "map"), [], [])
    assert (tmp_path / "map.data").read_text() == "my data"
