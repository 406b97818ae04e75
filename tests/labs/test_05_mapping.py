"""Lab 5: how good the maps of the solution are, their files, the speed, and the picture of the README."""

from __future__ import annotations

import math
import runpy
import time
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import yaml

import simkit
from simkit import msgs

pytestmark = pytest.mark.labs

LAB = Path(__file__).parents[2] / "labs" / "05_mapping"
SERVER = (
    '<plugin filename="libsimkit_map_server.so" name="map_server"><yaml_filename>house.yaml</yaml_filename></plugin>'
)
OFF_COURSE, WALL, FREE, UNKNOWN = (60, 60, 220), (40, 40, 40), (255, 255, 255), (215, 215, 215)  # blue, green, red


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Drive through the house with the solution and save its map.

    Returns the folder of the files, the pose of the start, the speed (simulated time per processor time), and maps:
    that of the topic, of the service, of the truth, and one with the poses of the odometry.
    """
    folder = tmp_path_factory.mktemp("drive")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        with simkit.load(LAB / "house_drift.sdf", plugin_paths=[LAB / "solution", LAB]) as sim:
            start, began = sim.model("robot").pose, time.process_time()
            scans, odometry = sim.subscribe("/scan"), sim.subscribe("/odom")
            for command in yaml.safe_load((LAB / "house_drive.yaml").read_text("utf-8")):
                sim.run(command["at"] - sim.time)
                sim.publish(command["topic"], command["message"])
            sim.run(75.0 - sim.time)
            speed = sim.time / (time.process_time() - began)
            late = sim.subscribe("/map", keep=1)
            assert sim.call("/map_saver/save_map", {"map_topic": "map", "map_url": "house"}).result
            lidar = sim.tf.lookup("base_footprint", "base_scan")
            return {
                "folder": folder,
                "start": start,
                "speed": speed,
                "map": late.latest,
                "answer": sim.call("/dynamic_map").map,
                "truth": sim.call("/truth/map").map,
                "odometry": odometry_map(scans.messages[::3], odometry.messages, lidar, late.latest),
            }


def odometry_map(scans: list[Any], odometry: list[Any], lidar: simkit.Pose, like: Any) -> Any:
    """Return a map of scans at the poses of the odometry, with the size of another map."""
    grid = runpy.run_path(str(LAB / "solution" / "mapping.py"))["Grid"]()
    poses = {msgs.stamp_ns(message.header.stamp): msgs.pose(message.pose.pose) for message in odometry}
    stamps = np.array(list(poses))
    for scan in scans:
        pose = poses[int(stamps[np.abs(stamps - msgs.stamp_ns(scan.header.stamp)).argmin()])] @ lidar
        angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
        place = (*pose.position[:2].tolist(), float(pose.rpy[2]))
        grid.add_scan(place, angles, np.asarray(scan.ranges, float), scan.range_max)
    return msgs.make("nav_msgs/msg/OccupancyGrid", info=like.info, data=grid.values().reshape(-1))


def cells(message: Any) -> np.ndarray[Any, Any]:
    return np.asarray(message.data).reshape(message.info.height, message.info.width)


def distances(found: dict[str, Any]) -> np.ndarray[Any, Any]:
    """Return the true distance of each cell of the maps to the next collision of the house [m]."""
    grid, truth = found["map"].info, found["truth"].info
    marked = (cells(found["truth"]) != 100).astype(np.uint8)
    away = cv2.distanceTransform(marked, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) * truth.resolution
    rows, columns = np.indices((grid.height, grid.width))
    x, y = (
        first + (number + 0.5) * grid.resolution + found["start"].position[axis] - second
        for axis, (number, first, second) in enumerate(
            [
                (columns, grid.origin.position.x, truth.origin.position.x),
                (rows, grid.origin.position.y, truth.origin.position.y),
            ]
        )
    )
    column, row = (np.floor(value / truth.resolution).astype(int) for value in (x, y))
    inside = (column >= 0) & (column < truth.width) & (row >= 0) & (row < truth.height)
    return np.where(inside, away[row.clip(0, truth.height - 1), column.clip(0, truth.width - 1)], math.inf)


def test_occupied_cells_are_true_only_with_scan_matching(drive: dict[str, Any]) -> None:
    is_true = distances(drive) <= 0.05
    share = {name: is_true[cells(drive[name]) >= 65].mean() for name in ("map", "odometry")}
    assert share["map"] >= 0.95 and share["odometry"] < 0.6


def test_mapping_of_the_house_is_eight_times_as_fast_as_time(drive: dict[str, Any]) -> None:
    """Processor time is measured, because other tests run at the same time."""
    assert drive["speed"] >= 8.0


def test_the_map_is_latched_answered_saved_and_read_back(drive: dict[str, Any]) -> None:
    values = cells(drive["map"])
    assert np.array_equal(values, cells(drive["answer"]))
    world = drive["folder"] / "served.sdf"
    world.write_text(f'<sdf version="1.9"><world name="w">{SERVER}</world></sdf>', "utf-8")
    with simkit.load(world) as sim:
        served = sim.call("/map_server/map").map
    expected = np.select([values < 0, values <= 25, values >= 65], [-1, 0, 100], -1)
    assert np.array_equal(cells(served), expected)
    assert served.info.resolution == pytest.approx(0.05)
    assert (served.info.origin.position.x, served.info.origin.position.y) == (-10.0, -10.0)


def test_a_ray_changes_the_cells_on_its_way() -> None:
    """A ray of 1 m along x, and one without an echo along y; a cell that a ray hits stays occupied."""
    grid = runpy.run_path(str(LAB / "solution" / "mapping.py"))["Grid"]()
    grid.add_scan((0.02, 0.02, 0.0), np.array([0.0, math.pi / 2]), np.array([1.0, math.inf]), 3.0)
    occupied = np.argwhere(grid.log_odds > 0).tolist()
    assert occupied == [[200, 220]]
    free = np.argwhere(grid.log_odds < 0)
    assert free[free[:, 0] == 200][:, 1].tolist() == list(range(200, 219 + 1))
    assert free[free[:, 1] == 200][:, 0].max() >= 258


def test_the_picture_shows_both_maps(drive: dict[str, Any], tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    panels, is_wrong = [], distances(drive) > 0.05
    for name, title in (("odometry", "poses of the odometry"), ("map", "poses of the scan matching")):
        values = cells(drive[name])
        image = np.full((*values.shape, 3), UNKNOWN, np.uint8)
        image[(values >= 0) & (values <= 25)] = FREE
        image[(values >= 65) & ~is_wrong] = WALL
        image[(values >= 65) & is_wrong] = OFF_COURSE
        large = cv2.resize(image[95:320, 105:375][::-1], None, fx=2, fy=2, interpolation=cv2.INTER_NEAREST)
        cv2.putText(large, title, (10, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.6, WALL, 1, cv2.LINE_AA)
        panels.append(large)
    drawn = np.hstack([panels[0], np.full((len(panels[0]), 8, 3), 255, np.uint8), panels[1]])
    cv2.imwrite(str(tmp_path / "maps.png"), drawn)
    shown = cv2.imread(str(LAB / "maps.png"))
    assert shown is not None and shown.shape == drawn.shape, tmp_path / "maps.png"
    # another machine may round a few cells differently
    differs = (np.abs(shown.astype(int) - drawn) > 40).any(axis=2)
    assert differs.mean() < 0.01, tmp_path / "maps.png"
