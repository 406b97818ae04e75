"""Mapping: a scan is found in the map of the scans before it, although the odometry drifts."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import numpy.typing as npt

from simkit_navigation.plugins.maps.scan_mapper import ScanMapper
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


def ranges(pose: PlanarPose) -> Floats:
    """Return the distances to the nearest wall from the sensor of a robot at a pose."""
    at = pose.compose(SENSOR)
    directions = np.column_stack((np.cos(ANGLES + at.yaw), np.sin(ANGLES + at.yaw)))
    begin, along = WALLS[:, :2] - (at.x, at.y), WALLS[:, 2:] - WALLS[:, :2]
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


def inverse(pose: PlanarPose) -> PlanarPose:
    cosine, sine = math.cos(pose.yaw), math.sin(pose.yaw)
    return PlanarPose(-cosine * pose.x - sine * pose.y, sine * pose.x - cosine * pose.y, -pose.yaw)


@cache
def mapped(steps: int = 60, drift: float = 0.06, turn: float = 0.012) -> tuple[ScanMapper, float, float]:
    """Map a room from poses whose odometry is too long and turns too far.

    Returns:
        Mapper, and the largest errors of its poses and of the odometry alone [m].
    """
    generator = np.random.default_rng(1)
    mapper, truth = ScanMapper(0.05, 10.0), circle(steps)
    start = inverse(truth[0])
    odometry = PlanarPose(0.0, 0.0, 0.0)
    errors, drifts = [0.0], [0.0]
    for before, pose in zip([truth[0], *truth], truth, strict=False):
        moved = inverse(before).compose(pose)
        moved = PlanarPose(moved.x * (1 + drift), moved.y * (1 + drift), moved.yaw + turn * (pose is not truth[0]))
        odometry = odometry.compose(moved)
        predicted = mapper.pose.compose(moved)
        noise = generator.normal(0.0, 0.01, len(ANGLES))
        mapper.add_scan(predicted, SENSOR, ranges(pose) + noise, ANGLES, 8.0)
        true = start.compose(pose)
        errors.append(math.hypot(mapper.pose.x - true.x, mapper.pose.y - true.y))
        drifts.append(math.hypot(odometry.x - true.x, odometry.y - true.y))
    return mapper, max(errors), max(drifts)


def test_the_pose_in_the_map_does_not_drift_with_the_odometry() -> None:
    _, error, drift = mapped()
    assert drift > 0.5
    assert error < 0.05


def test_the_map_has_the_walls_where_they_are() -> None:
    mapper, _, _ = mapped()
    found = mapper.occupancy()
    rows, columns = np.nonzero(found.cells == 100)
    points = np.column_stack((columns, rows)) * found.resolution + found.origin.position[:2] + found.resolution / 2
    in_room = circle(60)[0].transform(points)
    begin, along = WALLS[:, :2], WALLS[:, 2:] - WALLS[:, :2]
    share = ((in_room[:, None] - begin) * along).sum(axis=2) / (along**2).sum(axis=1)
    nearest = begin + np.clip(share, 0, 1)[..., None] * along
    away = np.hypot(*np.moveaxis(in_room[:, None] - nearest, 2, 0)).min(axis=1)
    assert len(points) > 300
    assert np.quantile(away, 0.95) < 0.08
    assert (found.cells == 0).sum() * found.resolution**2 > 18.0  # m² of 22


def test_a_map_without_scans_is_empty() -> None:
    assert ScanMapper(0.05, 10.0).occupancy().cells.size == 0


def test_rays_that_hit_nothing_make_free_space_and_no_walls() -> None:
    mapper = ScanMapper(0.1, 3.0)
    for _ in range(2):
        mapper.add_scan(PlanarPose(0, 0, 0), SENSOR, np.full(240, np.inf), ANGLES, 3.0)
    cells = mapper.occupancy().cells
    assert (cells == 0).sum() * 0.01 > 20.0 and not (cells == 100).any()
    mapper.add_scan(PlanarPose(0, 0, 0), SENSOR, np.full(240, np.nan), ANGLES, 3.0)
    assert (mapper.occupancy().cells == cells).all()


def test_two_runs_give_the_same_bits() -> None:
    first, second = mapped.__wrapped__(12)[0], mapped.__wrapped__(12)[0]
    assert first.pose == second.pose
    assert first.occupancy().cells.tobytes() == second.occupancy().cells.tobytes()
