"""Map saver: files of published maps, as Nav2's `map_saver` writes them and `map_server` reads them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import simkit
from simkit import msgs
from simkit.errors import LoadError, MessageError

GRID = "nav_msgs/msg/OccupancyGrid"
VALUES = np.array([[0, 25, 26, 64], [65, 100, -1, 50]], np.int8)
READ = [[0, 0, -1, -1], [100, 100, -1, -1]]
SAVER = '<plugin filename="libsimkit_map_saver.so" name="map_saver">{}</plugin>'
SERVER = '<plugin filename="libsimkit_map_server.so" name="map_server"><yaml_filename>{}</yaml_filename></plugin>'


def world(*plugins: str) -> str:
    return f'<sdf version="1.9"><world name="w">{"".join(plugins)}</world></sdf>'


def message(values: np.ndarray[Any, Any] = VALUES) -> Any:
    origin = {"position": {"x": -1.5, "y": 2.0}, "orientation": {"z": np.sin(0.25), "w": np.cos(0.25)}}
    info = {"resolution": 0.1, "width": values.shape[1], "height": values.shape[0], "origin": origin}
    return msgs.make(GRID, header={"frame_id": "map"}, info=info, data=values.reshape(-1))


def save(folder: Path, monkeypatch: pytest.MonkeyPatch, **request: object) -> bool:
    """Publish a map, save it in a folder, and return the result of the service."""
    monkeypatch.chdir(folder)
    with simkit.load(world(SAVER.format(""))) as sim:
        sim.publish("/map", message())
        sim.step()
        return bool(sim.call("/map_saver/save_map", request).result)


def test_a_saved_map_is_read_back_by_the_map_server(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert save(tmp_path, monkeypatch, map_topic="map", map_url="house")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["house.pgm", "house.yaml"]
    file = tmp_path / "w.sdf"
    file.write_text(world(SERVER.format("house.yaml")), "utf-8")
    with simkit.load(file) as sim:
        found = sim.call("/map_server/map").map
    assert np.asarray(found.data).reshape(2, 4).tolist() == READ
    assert found.info.resolution == pytest.approx(0.1)
    origin = found.info.origin
    assert (origin.position.x, origin.position.y) == (-1.5, 2.0)
    assert origin.orientation.z == pytest.approx(np.sin(0.25))


@pytest.mark.parametrize(
    ("request_", "ending", "mode", "pixels"),
    [
        ({}, "pgm", "L", [[0, 0, 205, 205], [254, 254, 205, 205]]),  # the highest y is at the top
        ({"free_thresh": 0.3, "occupied_thresh": 0.5}, "pgm", "L", [[0, 0, 205, 0], [254, 254, 254, 0]]),
        ({"image_format": "bmp", "map_mode": "raw"}, "bmp", "L", [[65, 100, 255, 50], [0, 25, 26, 64]]),
        ({"image_format": "png"}, "png", "L", [[0, 0, 205, 205], [254, 254, 205, 205]]),
    ],
)
def test_pixels_have_the_values_of_their_mode(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    request_: dict[str, object],
    ending: str,
    mode: str,
    pixels: list[list[int]],
) -> None:
    assert save(tmp_path, monkeypatch, map_url="m", **request_)
    with Image.open(tmp_path / f"m.{ending}") as image:
        assert (image.mode, np.asarray(image).tolist()) == (mode, pixels)


def test_scaled_maps_are_png_files_with_transparent_unknown_cells(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert save(tmp_path, monkeypatch, map_url="m.yaml", map_mode="scale")
    with Image.open(tmp_path / "m.png") as image:
        pixels = np.asarray(image)
    assert pixels[..., 0].tolist() == [[89, 0, 0, 128], [255, 191, 189, 92]]
    assert pixels[..., 1].tolist() == [[255, 255, 0, 255], [255, 255, 255, 255]]


@pytest.mark.parametrize(
    ("request_", "problem"),
    [
        ({"map_url": "../m"}, "'../m' is not a file below the working folder"),
        ({"map_url": "/etc/m"}, "'/etc/m' is not a file below the working folder"),
        ({"map_url": "gone/m"}, "No such file"),
        ({"map_url": ".."}, "'..' is not a file below the working folder"),
        ({"map_mode": "colour"}, "map_mode 'colour' is not one of trinary, scale, raw"),
        ({"image_format": "jpg"}, "image_format 'jpg' is not one of pgm, png, bmp"),
        ({"free_thresh": 0.7}, "expected 0 < free_thresh < occupied_thresh <= 1, found 0.7 and 0.65"),
        ({"map_topic": "other"}, "no map has been published on '/other'"),
    ],
)
def test_a_map_that_cannot_be_saved_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request_: dict[str, object], problem: str
) -> None:
    monkeypatch.chdir(tmp_path)
    with simkit.load(world(SAVER.format(""))) as sim:
        log = sim.subscribe("/rosout")
        sim.publish("/map", message())
        sim.step()
        assert not sim.call("/map_saver/save_map", {"map_url": "m", **request_}).result
        sim.step()
        assert [problem in entry.msg for entry in log.messages if entry.level == 40] == [True]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"width": 5}, "the map has 8 cells; its size is 5 × 2"),
        ({"width": 0, "height": 0}, "the map has 8 cells; its size is 0 × 0"),
        ({"resolution": 0.0}, "resolution 0 and origin must be finite, the resolution above 0 [m]"),
        ({"resolution": np.nan}, "resolution nan and origin must be finite"),
        ({"origin": {"position": {"x": np.inf}}}, "and origin must be finite"),
    ],
)
def test_an_invalid_map_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, change: dict[str, Any], problem: str
) -> None:
    monkeypatch.chdir(tmp_path)
    info = {"resolution": 0.1, "width": 4, "height": 2, **change}
    with simkit.load(world(SAVER.format(""))) as sim:
        log = sim.subscribe("/rosout")
        sim.publish("/map", msgs.make(GRID, info=info, data=VALUES.reshape(-1)))
        sim.step()
        assert not sim.call("/map_saver/save_map", {"map_url": "m"}).result
        sim.step()
        assert [problem in entry.msg for entry in log.messages if entry.level == 40] == [True]
    assert list(tmp_path.iterdir()) == []


def test_an_origin_without_a_rotation_has_the_yaw_zero(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with simkit.load(world(SAVER.format(""))) as sim:
        sim.publish("/map", msgs.make(GRID, info={"resolution": 0.1, "width": 8, "height": 1}, data=VALUES.reshape(-1)))
        sim.step()
        assert sim.call("/map_saver/save_map", {"map_url": "m"}).result
    assert "origin: [0, 0, 0]\n" in (tmp_path / "m.yaml").read_text("utf-8")


def test_a_latched_map_of_another_topic_is_saved_and_replaces_the_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "m.pgm").write_bytes(b"P5 old")
    monkeypatch.chdir(tmp_path)
    box = """<model name="b"><static>true</static><link name="l"><collision name="c"><geometry><box>
        <size>1 1 1</size></box></geometry></collision></link></model>"""
    truth = '<plugin filename="libsimkit_map_server.so" name="truth"><topic_name>true_map</topic_name></plugin>'
    with simkit.load(world(box, truth, SAVER.format(""))) as sim:
        sim.step()
        assert sim.call("/map_saver/save_map", {"map_topic": "true_map", "map_url": "m"}).result
    with Image.open(tmp_path / "m.pgm") as image:
        assert (np.asarray(image) == 0).sum() == 400


def test_a_restored_run_saves_the_map_of_its_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with simkit.load(world(SAVER.format(""))) as sim:
        sim.publish("/map", message())
        sim.step()
        kept = sim.snapshot()
        sim.publish("/map", message(np.full((3, 3), 100, np.int8)))
        sim.step()
        sim.restore(kept)
        assert sim.call("/map_saver/save_map", {"map_url": "m"}).result
        sim.reset()
        assert not sim.call("/map_saver/save_map", {"map_url": "n"}).result
    assert sorted(path.name for path in tmp_path.iterdir()) == ["m.pgm", "m.yaml"]
    with Image.open(tmp_path / "m.pgm") as image:
        assert image.size == (4, 2)


def test_a_topic_of_another_type_is_reported() -> None:
    with simkit.load(world(SAVER.format("<map_topic>scan</map_topic>"))) as sim:
        sim.advertise("/scan", "sensor_msgs/msg/LaserScan").publish({})
        sim.step()
        assert [d.message.partition(": ")[2] for d in sim.diagnostics if d.code == "SK-PLUGIN-041"] == [
            f"messages of the type sensor_msgs/msg/LaserScan on <map_topic> are ignored; expected {GRID}"
        ]


def test_limits_in_the_wrong_order_are_an_error() -> None:
    options = "<free_thresh_default>0.7</free_thresh_default>"
    with pytest.raises(LoadError, match="SK-MAP-002"), simkit.load(world(SAVER.format(options))):
        pass


def test_a_name_with_characters_of_yaml_is_read_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert save(tmp_path, monkeypatch, map_url="my: map #1")
    (tmp_path / "w.sdf").write_text(world(SERVER.format("my: map #1.yaml")), "utf-8")
    with simkit.load(tmp_path / "w.sdf") as sim:
        assert np.asarray(sim.call("/map_server/map").map.data).reshape(2, 4).tolist() == READ


def test_a_link_in_the_folder_is_not_followed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder := tmp_path / "work").mkdir()
    (outside := tmp_path / "outside").write_text("kept", "utf-8")
    for name in ("map.pgm", ".map.pgm.part", ".map.yaml.part"):
        (folder / name).symlink_to(outside)
    assert save(folder, monkeypatch)
    assert outside.read_text("utf-8") == "kept" and not (folder / "map.pgm").is_symlink()


def test_a_name_that_is_no_text_of_unicode_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(MessageError):
        save(tmp_path, monkeypatch, map_url="a\ud800")


@pytest.mark.parametrize("name", ["notes.yaml", "notes.pgm"])
def test_a_file_that_is_no_map_is_not_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    (tmp_path / name).write_text("steps: [build]\n")
    assert not save(tmp_path, monkeypatch, map_url="notes")
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [(name, "steps: [build]\n")]
    (tmp_path / "notes.yaml").write_text("# of the ground floor\nresolution: 1\nimage: old.pgm\n")
    (tmp_path / "notes.pgm").write_bytes(b"P5 1 1 255 0")
    assert save(tmp_path, monkeypatch, map_url="notes")
