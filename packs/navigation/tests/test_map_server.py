"""Map server: maps of files and of the world, as Nav2's `map_server` publishes them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

import simkit
from simkit.errors import LoadError

WALL = """<model name="wall"><static>true</static><pose>0.5 0.2 0.5 0 0 0</pose><link name="l"><collision name="c">
  <geometry><box><size>1 0.4 1</size></box></geometry></collision></link></model>"""
YAML = "image: m.pgm\nresolution: 0.1\norigin: [-1, 2, 0.5]\noccupied_thresh: 0.65\nfree_thresh: 0.25\nnegate: 0\n"
SHADES = np.array([[0, 254, 205, 90], [60, 200, 127, 255]], np.uint8)


def world(tmp_path: Path, options: str = "", model: str = "") -> Path:
    plugin = f'<plugin filename="libsimkit_map_server.so" name="map_server">{options}</plugin>'
    file = tmp_path / "w.sdf"
    file.write_text(f'<sdf version="1.9"><world name="w">{model}{plugin}</world></sdf>', "utf-8")
    return file


def write_map(folder: Path, text: str = YAML, name: str = "m") -> None:
    (folder / f"{name}.yaml").write_text(text, "utf-8")
    cv2.imwrite(str(folder / f"{name}.pgm"), SHADES)


def grid(message: Any) -> list[list[int]]:
    return np.asarray(message.data).reshape(message.info.height, message.info.width).tolist()


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ("", [[100, 0, -1, 0], [100, 0, 0, -1]]),  # brightness 60 of 255 is occupied to 0.76; row 0 is the lowest one
        ("negate: 1\n", [[0, 100, -1, 100], [0, 100, 100, -1]]),
        ("mode: scale\n", [[100, 0, 63, 0], [100, 0, 0, 99]]),
        ("mode: raw\n", [[60, -1, -1, -1], [0, -1, -1, 90]]),
    ],
)
def test_cells_of_a_file_have_the_values_of_its_mode(tmp_path: Path, lines: str, expected: list[list[int]]) -> None:
    text = YAML.replace("negate: 0\n", "") if "negate" in lines else YAML
    write_map(tmp_path, text + lines)
    with simkit.load(world(tmp_path, "<yaml_filename>m.yaml</yaml_filename>")) as sim:
        found = sim.call("/map_server/map").map
        late = sim.subscribe("/map", keep=1)
        sim.step()
        assert grid(found) == grid(late.latest) == expected
        assert (found.header.frame_id, found.info.width, found.info.height) == ("map", 4, 2)
        assert found.info.resolution == pytest.approx(0.1)
        origin = found.info.origin
        assert (origin.position.x, origin.position.y) == pytest.approx((-1.0, 2.0))
        assert origin.orientation.z == pytest.approx(np.sin(0.25))


def test_without_a_file_the_map_is_the_true_one(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path, "<resolution>0.1</resolution><topic_name>truth</topic_name>", WALL)) as sim:
        found = sim.call("/map_server/map").map
        cells = np.array(grid(found))
        assert sim.topics()["/truth"] == "nav_msgs/msg/OccupancyGrid"
        assert (cells == 100).sum() == 40 and (cells == 0).sum() == cells.size - 40
        rows, columns = np.nonzero(cells == 100)
        assert columns.min() * 0.1 + found.info.origin.position.x == pytest.approx(0.0, abs=1e-6)
        assert rows.min() * 0.1 + found.info.origin.position.y == pytest.approx(0.0, abs=1e-6)


def test_the_frame_of_the_map_is_the_parent_of_the_world(tmp_path: Path) -> None:
    with simkit.load(world(tmp_path, "<publish_transform>true</publish_transform>", WALL)) as sim:
        sim.step()
        assert sim.tf.lookup("map", "world").position == pytest.approx((0, 0, 0))


def test_another_map_is_loaded_during_the_run_and_a_reset_brings_back_the_first(tmp_path: Path) -> None:
    write_map(tmp_path)
    write_map(tmp_path, YAML.replace("resolution: 0.1", "resolution: 0.2").replace("m.pgm", "n.pgm"), "n")
    with simkit.load(world(tmp_path, "<yaml_filename>m.yaml</yaml_filename>")) as sim:
        newest = sim.subscribe("/map", keep=1)
        kept = sim.snapshot()
        response = sim.call("/map_server/load_map", {"map_url": "n.yaml"})
        sim.step()
        assert (response.result, response.map.info.resolution) == (0, pytest.approx(0.2))
        assert newest.latest.info.resolution == pytest.approx(0.2)
        sim.restore(kept)
        assert sim.call("/map_server/map").map.info.resolution == pytest.approx(0.1)
        assert newest.latest.info.resolution == pytest.approx(0.1)
        sim.call("/map_server/load_map", {"map_url": "n.yaml"})
        sim.reset()
        assert sim.call("/map_server/map").map.info.resolution == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("url", "result"), [("none.yaml", 1), ("/etc/hostname", 1), ("bad.yaml", 3), ("noimage.yaml", 2)]
)
def test_a_map_that_cannot_be_loaded_leaves_the_present_one(tmp_path: Path, url: str, result: int) -> None:
    write_map(tmp_path)
    (tmp_path / "bad.yaml").write_text("image: [", "utf-8")
    (tmp_path / "noimage.yaml").write_text(YAML.replace("m.pgm", "w.sdf"), "utf-8")
    with simkit.load(world(tmp_path, "<yaml_filename>m.yaml</yaml_filename>")) as sim:
        assert sim.call("/map_server/load_map", {"map_url": url}).result == result
        assert sim.call("/map_server/map").map.info.resolution == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("image: m.pgm\n", "missing key 'resolution'; missing key 'origin'"),
        (YAML.replace("0.1", "-1"), "resolution: found -1; expected a number above 0 [m]"),
        (YAML.replace("[-1, 2, 0.5]", "[-1, .nan, 0]"), "origin: found"),
        (YAML + "mode: colour\n", "mode: found 'colour'; expected one of trinary, scale, raw"),
        (YAML.replace("0.65", "0.1"), "expected 0 <= free_thresh < occupied_thresh <= 1"),
        (YAML.replace("m.pgm", "../m.pgm"), "is outside of the map's folder"),
        (YAML.replace("m.pgm", "gone.pgm"), "cannot be read"),
        (YAML.replace("m.pgm", '"a\\0b"'), "expected the name of a file"),
        (YAML.replace("m.pgm", "null"), "expected the name of a file"),
        ("- 1\n", "expected the keys image, resolution and origin"),
    ],
)
def test_an_invalid_file_is_an_error_with_its_problem(tmp_path: Path, text: str, problem: str) -> None:
    write_map(tmp_path, text)
    with pytest.raises(LoadError) as error, simkit.load(world(tmp_path, "<yaml_filename>m.yaml</yaml_filename>")):
        pass
    assert "SK-MAP-001" in str(error.value) and problem in str(error.value)


def test_a_missing_file_and_an_empty_world_are_errors(tmp_path: Path) -> None:
    for options in ("<yaml_filename>gone.yaml</yaml_filename>", "<height>3</height>"):
        with pytest.raises(LoadError, match="SK-MAP-001"), simkit.load(world(tmp_path, options)):
            pass


def test_a_restore_publishes_its_map_also_after_as_many_other_maps(tmp_path: Path) -> None:
    write_map(tmp_path)
    write_map(tmp_path, YAML.replace("m.pgm", "n.pgm").replace("0.1", "0.2"), "n")
    write_map(tmp_path, YAML.replace("m.pgm", "o.pgm").replace("0.1", "0.4"), "o")
    with simkit.load(world(tmp_path, "<yaml_filename>m.yaml</yaml_filename>")) as sim:
        maps, first = sim.subscribe("/map", keep=1), sim.snapshot()
        sim.call("/map_server/load_map", {"map_url": "n.yaml"})
        second = sim.snapshot()
        sim.restore(first)
        sim.call("/map_server/load_map", {"map_url": "o.yaml"})
        sim.restore(second)
        assert sim.call("/map_server/map").map.info.resolution == pytest.approx(0.2)
        assert maps.latest.info.resolution == pytest.approx(0.2)
        assert sim.subscribe("/map", keep=1).latest.info.resolution == pytest.approx(0.2)
