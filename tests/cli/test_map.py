"""`simkit map`: the true occupancy map of a world."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

import simkit
from simkit.cli import app
from simkit.pose import Pose
from simkit.sensors.occupancy_map import OccupancyMap, make_map
from simkit_navigation.plugins.maps.map_server import read_map

BALL = (
    '<model name="ball"><pose>0.5 0 0.2 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial>{}</link></model>'
)


def solid(geometry: str, pose: str) -> str:
    return (
        f'<model name="m"><static>true</static><pose>{pose}</pose><link name="l"><collision name="c">'
        f"<geometry>{geometry}</geometry></collision></link></model>"
    )


def world(*models: str) -> str:
    return f'<sdf version="1.9"><world name="w">{"".join(models)}</world></sdf>'


def true_map(source: str | Path, height: float = 0.2, resolution: float = 0.05) -> OccupancyMap:
    with simkit.load(source) as sim:
        return make_map(sim.mj_model, sim.engine.physics.fresh(), height, resolution)


def area(found: OccupancyMap) -> float:
    return float((found.cells == 100).sum()) * found.resolution**2


def test_a_box_on_the_borders_of_cells_occupies_exactly_its_area() -> None:
    box = solid("<box><size>1 0.4 1</size></box>", "0.5 0.2 0 0 0 0")
    found = true_map(world(box))
    assert area(found) == pytest.approx(0.4, abs=1e-12)
    rows, columns = np.nonzero(found.cells == 100)
    assert columns.min() * 0.05 + found.origin.position[0] == pytest.approx(0.0, abs=1e-9)
    assert rows.min() * 0.05 + found.origin.position[1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("geometry", "pose", "expected"),
    [
        ("<cylinder><radius>0.5</radius><length>2</length></cylinder>", "0 0 0 0 0 0", np.pi / 4),
        ("<sphere><radius>0.5</radius></sphere>", "0 0 0.5 0 0 0", np.pi * (0.25 - 0.09)),
        ("<box><size>2 1 1</size></box>", "0.1 0.2 0 0 0 0.7", 2.0),
        ("<box><size>1 1 1</size></box>", "0 0 0.2 0.785398163 0 0", np.sqrt(2)),  # through two of its edges
        ("<cylinder><radius>0.3</radius><length>2</length></cylinder>", "0 0 0.2 1.570796327 0 0", 1.2),
    ],
)
def test_the_occupied_area_of_a_shape_is_that_of_its_slice(geometry: str, pose: str, expected: float) -> None:
    found = true_map(world(solid(geometry, pose)), resolution=0.005)
    outline = 6 * np.sqrt(expected) * 0.005  # cells that the outline crosses are occupied
    assert expected - 0.001 < area(found) < expected + outline


def test_a_wall_thinner_than_a_cell_has_no_hole() -> None:
    found = true_map(world(solid("<box><size>4 0.002 1</size></box>", "0 0 0 0 0 0.3")))
    is_free = (found.cells != 100).astype(np.uint8)
    cells = np.argwhere(found.cells == 100)
    assert len(np.unique(cells[:, 1])) == pytest.approx(4 * np.cos(0.3) / 0.05, abs=2)
    assert cv2.connectedComponents(1 - is_free, connectivity=4)[0] == 2  # background and one wall


def test_a_height_map_is_occupied_where_it_is_higher(tmp_path: Path) -> None:
    x, y = np.meshgrid(np.linspace(-1, 1, 65), np.linspace(-1, 1, 65))
    cv2.imwrite(str(tmp_path / "cone.png"), np.clip((1 - np.hypot(x, y)) * 255, 0, 255).astype(np.uint8))
    field = solid("<heightmap><uri>cone.png</uri><size>4 4 1</size></heightmap>", "0 0 0 0 0 0")
    (tmp_path / "cone.sdf").write_text(world(field), "utf-8")
    found = true_map(tmp_path / "cone.sdf", height=0.5)
    assert area(found) == pytest.approx(np.pi, abs=0.3)  # radius 1 m at half the height; one cell around it


def test_what_can_move_is_not_on_the_map() -> None:
    collision = '<collision name="c"><geometry><sphere><radius>0.3</radius></sphere></geometry></collision>'
    wall = solid("<box><size>1 0.4 1</size></box>", "0.5 2 0 0 0 0")
    assert area(true_map(world(wall, BALL.format(collision)))) == pytest.approx(0.4, abs=1e-12)


def test_the_end_of_each_ray_is_in_an_occupied_cell(tmp_path: Path) -> None:
    found = CliRunner().invoke(app, ["map", "turtlebot3_world", "-o", str(tmp_path / "map.yaml"), "--json"])
    assert found.exit_code == 0, found.output
    report = json.loads(found.stdout)
    about = yaml.safe_load((tmp_path / "map.yaml").read_text("utf-8"))
    image = cv2.imread(str(tmp_path / about["image"]), cv2.IMREAD_GRAYSCALE)
    assert image is not None and image.shape == (report["rows"], report["columns"])
    assert {int(pixel) for pixel in np.unique(image)} == {0, 205, 254}
    assert report["occupied"] + report["free"] + report["unknown"] == image.size
    with simkit.load("turtlebot3_world") as sim:
        sensor = sim.sensor("turtlebot3::base_scan::lds")
        sim.run(0.5)
        scan, pose = sensor.truth, sensor.pose
        ranges = np.asarray(scan.ranges)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        hits = [
            pose.transform((r * np.cos(a), r * np.sin(a), 0.0))[:2]
            for r, a in zip(ranges, angles, strict=True)
            if r < 9
        ]
    occupied = cv2.dilate((image[::-1] == 0).astype(np.uint8), np.ones((3, 3)))  # the lidar's height differs from 0.2 m
    columns, rows = np.floor((np.array(hits) - about["origin"][:2]) / about["resolution"]).astype(int).T
    assert len(hits) > 200
    assert occupied[rows, columns].all()


def test_free_cells_behind_walls_are_unknown_unless_everywhere_is_asked(tmp_path: Path) -> None:
    def counts(*options: str) -> dict[str, int]:
        found = CliRunner().invoke(app, ["map", "turtlebot3_world", "-o", str(tmp_path / "m"), "--json", *options])
        assert found.exit_code == 0, found.output
        return dict(json.loads(found.stdout))

    inside, outside, everywhere = counts(), counts("--start", "3.3,0"), counts("--everywhere")
    assert inside["free"] == outside["unknown"] and inside["unknown"] == outside["free"]
    assert everywhere["unknown"] == 0 and everywhere["free"] == inside["free"] + inside["unknown"]


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (["--height", "50"], "no collision of a static link crosses the height 50 m"),
        (["--resolution", "0.0001"], "at most 1e+08 are possible"),
        (["--start", "0.5,0.5,1"], "expected two numbers"),
        (["--start", "nan,1"], "expected two numbers"),
        (["--start", "1.1,0"], "the start (1.1, 0) is occupied or outside"),
        (["--start", "100,0"], "the start (100, 0) is occupied or outside"),
        (["--start", "0,0.5", "--everywhere"], "exclude each other"),
        (["--output", ".."], "is a folder"),
        (["--height", "inf"], "expected a finite number"),
    ],
)
def test_a_map_that_cannot_be_made_is_an_error_and_writes_nothing(
    tmp_path: Path, options: list[str], problem: str
) -> None:
    found = CliRunner().invoke(app, ["map", "turtlebot3_world", "-o", str(tmp_path / "m"), *options])
    assert found.exit_code == 2
    assert "SK-CLI-054" in found.stderr and problem in found.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_map_server_reads_the_cells_that_were_written(tmp_path: Path) -> None:
    cells = np.array([[100, 0, -1], [0, -1, 100]], np.int8)
    written = OccupancyMap(cells, 0.1, Pose((-1.0, 2.0, 0.0)))
    (tmp_path / "m.pgm").write_bytes(written.image())
    (tmp_path / "m.yaml").write_text(written.description("m.pgm"), "utf-8")
    found = read_map(tmp_path / "m.yaml")
    assert found.cells.tolist() == cells.tolist()
    np.testing.assert_allclose(found.origin.position, [-1.0, 2.0, 0.0])


@pytest.mark.parametrize(("tilt", "height", "expected"), [(0.0, 0.25, 0.0), (0.0, 0.15, 1.0), (0.5, 0.2, 0.5)])
def test_cells_below_a_plane_are_occupied(tilt: float, height: float, expected: float) -> None:
    plane = solid("<plane><normal>0 0 1</normal><size>9 9</size></plane>", f"0 0 0.2 0 {tilt} 0")
    post = solid("<box><size>0.1 0.1 9</size></box>", "0 0 0 0 0 0").replace('"m"', '"post"')
    found = true_map(world(plane, post), height)
    assert (found.cells == 100).mean() == pytest.approx(expected, abs=0.07)  # the post is 1 % of the map


def test_the_map_contains_the_robot_although_it_stands_far_from_the_collisions(tmp_path: Path) -> None:
    found = CliRunner().invoke(app, ["map", "turtlebot2_ball", "-o", str(tmp_path / "m"), "--json"])
    assert found.exit_code == 0, found.output
    assert "note: turtlebot2" not in found.stderr
    about = yaml.safe_load((tmp_path / "m.yaml").read_text("utf-8"))
    assert about["origin"][0] <= -0.4 and json.loads(found.stdout)["free"] > 0
