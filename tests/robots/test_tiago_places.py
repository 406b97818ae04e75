"""The worlds for TIAGo: an office with people, a table with objects, a box with a marker."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import simkit

ROOT = Path(__file__).resolve().parents[2]
OFFICE, TABLE, MARKER = "simple_office_with_people", "tiago_table", "tiago_aruco"


def maker(name: str) -> ModuleType:
    """A script beside the models, as a module."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(ROOT / "assets" / "office"))
        return importlib.import_module(name)


def test_the_files_are_what_their_scripts_write() -> None:
    office = maker("make_office")
    assert (ROOT / "assets/office/simple_office/model.sdf").read_text() == office.model_text()
    assert (ROOT / f"worlds/{OFFICE}.sdf").read_text() == office.world_text()
    for look, parts in office.looks_of(office.office()).items():
        mesh = ROOT / f"assets/office/simple_office/meshes/{look}.obj"
        assert mesh.read_text() == office.mesh_text(look, parts)
    tables = maker("make_tables")
    assert (ROOT / "assets/office/aruco_box/model.sdf").read_text() == tables.box_text()
    assert (ROOT / "assets/office/aruco_box/meshes/marker.obj").read_text() == tables.marker_mesh()


@pytest.mark.parametrize("name", [OFFICE, TABLE, MARKER])
def test_a_world_loads_by_its_name_without_a_warning(name: str) -> None:
    found = [d for d in simkit.check(name) if d.severity != "note"]
    assert not [d for d in found if "tiago" not in str(d.where)]


# ------------------------------------------------------------------ the office


@pytest.fixture(scope="module")
def office() -> Iterator[simkit.Simulation]:
    with simkit.load(OFFICE) as sim:
        yield sim


def people(sim: simkit.Simulation) -> list[str]:
    return [name for name, model in sim.engine.structure.models.items() if model.moved_by is not None]


def test_people_stand_sit_and_walk(office: simkit.Simulation) -> None:
    office.reset()
    before = {name: office.model(name).pose.position for name in people(office)}
    assert len(before) == 9
    office.run(10.0)
    moved = {n for n, p in before.items() if np.linalg.norm(office.model(n).pose.position - p) > 0.5}
    assert moved == {"walking_woman", "walking_man", "visitor"}


def test_nobody_walks_through_walls_or_furniture_or_through_the_middle_of_the_corridor(
    office: simkit.Simulation,
) -> None:
    """Seen from above: a circle of 0.2 m at the height of the hips meets nothing solid, nor a robot at the origin."""
    solid = []
    for link in office.engine.structure.models["office"].links:
        for collision in link.collisions:
            shape, pose = collision.geometry, collision.pose_link
            half = np.array(shape.size) / 2 if hasattr(shape, "size") else None  # a box
            radius = getattr(shape, "radius", None) or max(getattr(shape, "radii", (0, 0, 0))[:2], default=0.0)
            low = pose.position[2] - (half[2] if half is not None else getattr(shape, "length", 0.0) / 2)
            if low < 1.6:
                solid.append((pose, half, radius))
    for name in ("walking_woman", "walking_man", "visitor"):
        script: Any = office.engine.structure.models[name].moved_by.script
        for time in np.arange(0.0, script.length, 0.1):
            place = script.pose(time + 4.0).position * (1, 1, 0)
            assert np.hypot(*place[:2]) > 0.5, (name, time)
            for pose, half, radius in solid:
                local = pose.inverse().transform((place[0], place[1], pose.position[2]))
                gap = (
                    np.linalg.norm(np.maximum(np.abs(local[:2]) - half[:2], 0.0))
                    if half is not None
                    else np.linalg.norm(local[:2]) - radius
                )
                assert gap > 0.2, (name, time, place, pose.position)


def test_who_walks_looks_where_they_go_at_an_even_pace(office: simkit.Simulation) -> None:
    for name in ("walking_woman", "walking_man", "visitor"):
        (track,) = office.engine.structure.models[name].moved_by.script.tracks
        way = np.diff(track.poses[:, :2], axis=0)
        speed = np.linalg.norm(way, axis=1) / np.diff(track.times)
        assert speed.min() > 0.55
        assert speed.max() < 1.5
        w, z = track.poses[:-1, 3], track.poses[:-1, 6]
        looks = np.stack([w * w - z * z, 2 * w * z], axis=1)
        along = np.sum(looks * way, axis=1) / np.linalg.norm(way, axis=1)
        assert along.min() > np.cos(np.radians(35))
        np.testing.assert_allclose(track.poses[0, :2], track.poses[-1, :2], atol=1e-3)  # and round again


def test_a_robot_drives_through_the_corridor(office: simkit.Simulation) -> None:
    with simkit.load(OFFICE, spawn=["turtlebot3_waffle:0,0,0"]) as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 0.5}})
        sim.run(6.0)
        assert sim.model("turtlebot3_waffle").pose.position[0] > 2.4


# ------------------------------------------------------------------ the table


def test_things_on_the_table_stay_where_they_are() -> None:
    with simkit.load(TABLE) as sim:
        things = [t.name for t in maker("make_tables").THINGS]
        before = {name: sim.model(name).pose.position for name in things}
        masses = {name: sim.model(name).link("link").mass for name in things}
        sim.run(5.0)
        for name in things:
            assert np.linalg.norm(sim.model(name).pose.position - before[name]) < 1e-3, name
        assert min(masses.values()) < 0.05
        assert max(masses.values()) == 1.0
        assert masses["milk"] == 0.5


# ------------------------------------------------------------------ the marker


def test_opencv_finds_the_marker_where_it_is() -> None:
    import cv2

    with simkit.load(MARKER) as sim:
        pictures = sim.subscribe("/head_front_camera/rgb/image_raw")
        infos = sim.subscribe("/head_front_camera/rgb/camera_info")
        sim.run(1.0)
        picture, info = pictures.latest, infos.latest
        assert picture.encoding in ("bgr8", "rgb8")
        pixels = np.frombuffer(bytes(picture.data), np.uint8).reshape(picture.height, picture.width, 3)
        grey = cv2.cvtColor(pixels, cv2.COLOR_BGR2GRAY if picture.encoding == "bgr8" else cv2.COLOR_RGB2GRAY)
        dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_ARUCO_ORIGINAL)
        settings = cv2.aruco.DetectorParameters()
        settings.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
        corners, numbers, _ = cv2.aruco.ArucoDetector(dictionary, settings).detectMarkers(grey)
        tables = maker("make_tables")
        assert numbers is not None
        assert numbers.ravel().tolist() == [tables.MARKER_ID]
        half = tables.MARKER / 2
        square = np.array([[-half, half, 0], [half, half, 0], [half, -half, 0], [-half, -half, 0]])
        lens = np.array(info.k).reshape(3, 3)
        _, turn, place = cv2.solvePnP(
            square, corners[0].reshape(4, 2), lens, np.array(info.d), flags=cv2.SOLVEPNP_IPPE_SQUARE
        )
        camera = sim.model("tiago").link(picture.header.frame_id).pose
        marker = camera.inverse() @ sim.model("aruco_box").link("aruco_marker").pose
        assert np.linalg.norm(place.ravel() - marker.position) < 0.005
        between = np.asarray(marker.matrix)[:3, :3].T @ cv2.Rodrigues(turn)[0]
        assert np.degrees(np.arccos((np.trace(between) - 1) / 2)) < 1.0
