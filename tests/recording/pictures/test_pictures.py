"""Pictures: the whole subject is in the frame, and marks are drawn over the image."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import simkit
from simkit.errors import RenderError
from simkit.recording.pictures.camera import MARGIN, Camera, frame_points, line_of_sight
from simkit.recording.pictures.overlay import Marks, draw_overlay, length_text, scale_length
from simkit.recording.pictures.subject import find_subject
from simkit.recording.run_picture import DrivenPath, save_picture
from simkit.runtime.engine.snapshot import state_hash
from simkit.sensors.cameras.overview_image import render_view

MODEL = """<model name="{name}">{static}<pose>{pose}</pose><link name="l"><visual name="v"><geometry><box>
  <size>{size}</size></box></geometry></visual><collision name="c"><geometry><box><size>{size}</size></box></geometry>
  </collision></link></model>"""


def world(*models: tuple[str, str, str, bool]) -> str:
    """Return a world of boxes: name, position, size, static."""
    text = "".join(
        MODEL.format(name=n, pose=f"{p} 0 0 0", size=s, static="<static>true</static>" if fixed else "")
        for n, p, s, fixed in models
    )
    return f'<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>{text}</world></sdf>'


@pytest.mark.parametrize("size", [(1, 1, 1), (0.02, 0.02, 12), (40, 30, 0.1), (1e-3, 2e-3, 1e-3), (900, 700, 50)])
@pytest.mark.parametrize("elevation", [0.2, 0.9, 1.5])
def test_all_corners_of_a_box_are_between_the_margins(size: tuple[float, ...], elevation: float) -> None:
    half = np.array(np.meshgrid(*[(-s / 2, s / 2) for s in size])).reshape(3, -1).T
    corners = half + np.array((3.0, -2.0, 5.0))
    camera = frame_points(corners, line_of_sight(0.7, elevation), 1280, 800)
    pixels, depth = camera.project(corners)
    room = MARGIN * 800 - 1e-6
    assert (depth > 0.0).all()
    assert (pixels >= room).all() and (pixels[:, 0] <= 1280 - room).all() and (pixels[:, 1] <= 800 - room).all()
    spans = np.ptp(pixels, axis=0) / (1280 - 2 * room, 800 - 2 * room)
    assert spans.max() > 0.75 or min(size) <= 1e-3, "the box fills the picture"


def test_the_room_around_a_robot_is_shown_whole_and_a_landscape_is_not() -> None:
    robot = ("robot", "0 0 0.5", "1 1 1", False)
    near, far = ("wall", "0.7 0 0.5", "0.1 1 1", True), ("hill", "90 0 5", "10 10 10", True)
    with simkit.load(world(robot, near)) as sim:
        assert len(find_subject(sim, []).points) == 16
    with simkit.load(world(robot, near, far)) as sim:
        np.testing.assert_allclose(np.ptp(find_subject(sim, []).points, axis=0), (1, 1, 1))


def test_a_world_without_robots_is_framed_without_its_floor() -> None:
    with simkit.load(world(("floor", "0 0 0", "60 60 0.1", True), ("wall", "3 0 1", "0.1 4 2", True))) as sim:
        points = find_subject(sim, []).points
    np.testing.assert_allclose(np.ptp(points, axis=0), (0.1, 4, 2), atol=1e-9)


def test_a_scale_bar_has_a_round_length_that_fits() -> None:
    assert [scale_length(100.0, w) for w in (99.0, 100.0, 250.0, 700.0)] == pytest.approx([0.5, 1.0, 2.0, 5.0])
    assert [length_text(v) for v in (2000.0, 5.0, 0.2, 0.01, 0.005)] == ["2 km", "5 m", "20 cm", "1 cm", "5 mm"]
    camera = Camera(np.array((0.0, -10.0, 0.0)), np.zeros(3), 1280, 800)
    pixels, _ = camera.project(np.array(((-0.5, 0.0, 0.0), (0.5, 0.0, 0.0))))
    assert pixels[1, 0] - pixels[0, 0] == pytest.approx(camera.pixels_per_metre)


def test_marks_behind_an_object_are_faint_and_marks_before_it_are_opaque() -> None:
    camera = Camera(np.array((0.0, -10.0, 0.0)), np.zeros(3), 400, 250)
    image = np.full((250, 400, 3), 200, np.uint8)
    path = np.array(((-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    colours = []
    for surface in (12.0, 8.0):
        drawn = draw_overlay(image, np.full((250, 400), surface, np.float32), camera, Marks(paths={"robot": path}))
        colours.append(drawn[125, 200].astype(int))
    assert colours[0][2] - colours[0][0] > 150  # blue
    assert 20 < colours[1][2] - colours[1][0] < 100  # a third of it


def test_goals_belong_to_the_picture() -> None:
    with simkit.load(world(("robot", "0 0 0.5", "1 1 1", False))) as sim:
        driven = DrivenPath(sim)
        goals = sim.advertise("/goal_pose", "geometry_msgs/msg/PoseStamped")
        goals.publish({"header": {"frame_id": "map"}, "pose": {"position": {"x": 4.0, "y": 3.0}}})
        sim.run(0.1)
        np.testing.assert_allclose(driven.goals["/goal_pose"], (4, 3, 0))


def test_a_picture_changes_no_bit_of_the_run_and_shows_shadows(tmp_path: Path) -> None:
    sun = """<light name="sun" type="directional"><direction>0.5 0.3 -1</direction><cast_shadows>true</cast_shadows>
      </light>"""
    plane = """<model name="floor"><static>true</static><link name="l"><visual name="v"><geometry><plane>
      <size>20 20</size></plane></geometry></visual></link></model>"""
    text = world(("robot", "0 0 1", "0.5 0.5 0.5", False)).replace("<gravity>", sun + plane + "<gravity>")
    hashes = []
    for is_drawn in (False, True):
        with simkit.load(text) as sim:
            sim.model("robot").set_velocity((0.3, 0.0, 0.0), (0.0, 0.0, 0.5))
            sim.run(0.2)
            if is_drawn:
                try:
                    save_picture(sim, tmp_path / "out.png", render_view)
                except RenderError as error:
                    pytest.skip(f"{error}; apt install libegl1 libgl1-mesa-dri")
                images = [
                    render_view(
                        sim, 80, 60, eye=(0.0, -6.0, 6.0), target=(0.3, 0.3, 0.0), quality=quality, passes=passes
                    )
                    for quality, passes in (("fast", 1), ("gazebo", 1), ("gazebo", 8))
                ]
            sim.run(0.2)
            hashes.append(state_hash(sim))
    assert hashes[0] == hashes[1]
    plain, hard, soft = (np.unique(image[:, :, 1].reshape(-1), return_counts=True) for image in images)
    assert hard[0].min() < plain[0].min(), "shadows are darker than the ground"
    assert len(soft[0]) > len(hard[0]), "soft shadows have more shades"
    assert (tmp_path / "out.png").stat().st_size > 5000
    assert math.isfinite(float(images[2].mean()))
