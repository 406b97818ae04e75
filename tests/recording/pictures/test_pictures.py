"""Pictures: the whole subject is in the frame, and marks are drawn over the image."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import trimesh

import simkit
from simkit.errors import RenderError
from simkit.pose import Pose
from simkit.recording import run_picture
from simkit.recording.pictures.camera import MARGIN, Camera, frame_points, line_of_sight
from simkit.recording.pictures.frames import Look, choose_camera
from simkit.recording.pictures.overlay import Colours, Marks, draw_overlay, length_text, scale_length
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
    sensor = '<sensor name="s" type="imu"/></link>'
    with simkit.load(world(robot, near, far).replace("</link>", sensor, 1)) as sim:
        np.testing.assert_allclose(np.ptp(find_subject(sim, []).points, axis=0), (1, 1, 1))


def test_objects_at_rest_without_a_robot_do_not_decide_the_frame() -> None:
    puck, hall = ("puck", "2 0 0", "0.04 0.04 0.02", False), ("wall", "6 0 0.5", "0.1 9 1", True)
    with simkit.load(world(puck, hall)) as sim:
        np.testing.assert_allclose(np.ptp(find_subject(sim, []).points, axis=0), (4.07, 9, 1.01))
        path = [("puck", np.array([(2.0, 0.0, 0.0), (2.1, 0.0, 0.0)]))]
        assert np.ptp(find_subject(sim, path).points, axis=0)[1] < 0.1, "what moves is the subject"


def test_a_world_without_robots_is_framed_without_its_floor() -> None:
    with simkit.load(world(("floor", "0 0 0", "60 60 0.1", True), ("wall", "3 0 1", "0.1 4 2", True))) as sim:
        points = find_subject(sim, []).points
    np.testing.assert_allclose(np.ptp(points, axis=0), (0.1, 4, 2), atol=1e-9)


GROUND = ("ground", "0 0 -0.05", "4 4 0.1", True)


def test_a_model_far_away_from_all_others_does_not_decide_the_frame() -> None:
    room = [GROUND, ("wall", "1 0 0.5", "0.1 1 1", True), ("robot", "0 0 0.5", "1 1 1", False)]
    with simkit.load(world(*room)) as sim:
        usual = find_subject(sim, [])
    for stray in (("book", "0 0 343582", "0.2 0.2 0.2", False), ("sign", "-9e4 0 0", "1 1 1", True)):
        with simkit.load(world(*room, stray)) as sim:
            subject = find_subject(sim, [])
        np.testing.assert_array_equal(subject.points, usual.points)
        assert subject.left_out == (stray[0],)
    assert usual.left_out == ()


def test_a_ball_that_rolled_away_does_not_decide_the_frame_of_a_robot() -> None:
    room = [("robot", "0 0 0.5", "1 1 1", False), ("wall", "1 0 0.5", "0.1 1 1", True)]
    sensor = '<sensor name="s" type="imu"/></link>'
    for place, left_out in (("9 0 0.1", ()), ("40 0 0.1", ("ball",))):
        text = world(*room, ("ball", place, "0.2 0.2 0.2", False)).replace("</link>", sensor, 1)
        with simkit.load(text) as sim:
            subject = find_subject(sim, [])
        assert subject.left_out == left_out
        assert subject.robots[:, 0].max() == pytest.approx(9.1 if not left_out else 0.5)


def test_an_object_beside_a_robot_without_shapes_is_framed() -> None:
    robot = """<model name="robot"><link name="a"/><link name="b"/><joint name="j" type="revolute"><parent>a</parent>
      <child>b</child><axis><xyz>0 0 1</xyz></axis></joint></model>"""
    text = world(("box", "1 0 0.5", "1 1 1", False)).replace("<gravity>", robot + "<gravity>")
    with simkit.load(text) as sim:
        subject = find_subject(sim, [])
    assert subject.left_out == () and subject.points[:, 0].max() >= 1.0


def test_the_box_of_a_mesh_has_the_axes_of_the_world(tmp_path: Path) -> None:
    """The engine's box of a triangular prism lies along its principal axes, at 45 degrees."""
    lines = [f"v {x} {y} {z}" for z in (0, 1) for x, y in ((0, 0), (2, 0), (2, 2))]
    lines += [f"f {face}" for face in ("1 3 2", "4 5 6", "1 2 5 4", "2 3 6 5", "3 1 4 6")]
    (tmp_path / "prism.obj").write_text("\n".join(lines), encoding="utf-8")
    box = "<box>\n  <size>1 1 1</size></box>"
    text = world(("prism", "0 0 0", "1 1 1", True)).replace(box, "<mesh><uri>prism.obj</uri></mesh>")
    (tmp_path / "w.sdf").write_text(text, encoding="utf-8")
    with simkit.load(tmp_path / "w.sdf") as sim:
        points = find_subject(sim, []).points
    np.testing.assert_allclose(np.ptp(points, axis=0), (2, 2, 1), atol=1e-6)


def test_a_model_that_fell_out_of_the_world_is_not_framed_and_neither_is_its_path() -> None:
    with simkit.load(world(GROUND, ("robot", "0 0 0.5", "1 1 1", False), ("cone", "1 1 0.5", "1 1 1", False))) as sim:
        usual = find_subject(sim, [])
        sim.model("cone").set_pose(Pose((1.0, 1.0, -490.0)))
        path = np.array(((1.0, 1.0, 0.5), (1.0, 1.0, -490.0)))
        subject = find_subject(sim, [("cone", path), ("robot", np.zeros((1, 3)))])
    assert subject.left_out == ("cone",)
    assert len(subject.robots) == len(usual.robots) - 8
    assert len(subject.traces) == 1 and subject.points[:, 2].min() >= -0.1


def test_the_path_of_a_fallen_model_without_shapes_is_not_framed() -> None:
    cone = """<model name="cone"><pose>0 0 -490 0 0 0</pose><link name="l"/></model>"""
    text = world(GROUND, ("wall", "1 0 0.5", "0.1 1 1", True)).replace("<gravity>", cone + "<gravity>")
    with simkit.load(text) as sim:
        subject = find_subject(sim, [("cone", np.array(((0.0, 0.0, 0.5), (0.0, 0.0, -490.0))))])
    assert subject.left_out == ("cone",) and not len(subject.traces)


def test_the_path_of_a_model_without_shapes_does_not_hide_the_room() -> None:
    with simkit.load(world(("wall", "3 0 1", "0.1 4 2", True))) as sim:
        points = find_subject(sim, [("ghost", np.array(((0.0, 0.0, 0.0), (0.0, 0.0, -0.2))))]).points
    np.testing.assert_allclose(np.ptp(points, axis=0), (3.05, 4, 2.2), atol=1e-9)


def test_a_flying_robot_is_not_left_out() -> None:
    models = [GROUND, ("post", "1 1 0.5", "0.1 0.1 1", True), ("wall", "1 0 0.5", "0.1 1 1", True)]
    with simkit.load(world(*models, ("drone", "0 0 120", "0.5 0.5 0.1", False))) as sim:
        subject = find_subject(sim, [])
    assert subject.left_out == () and subject.robots[:, 2].min() > 119.0


HOUSE = [
    ("floor", "0 0 -0.05", "6 6 0.1", True),
    ("north", "0 3 1", "6 0.1 2", True),
    ("south", "0 -3 1", "6 0.1 2", True),
    ("east", "3 0 1", "0.1 6 2", True),
    ("west", "-3 0 1", "0.1 6 2", True),
]
ROOF = ("roof", "0 0 2.05", "6.4 6.4 0.1", True)


def drawn_ceiling(*models: tuple[str, str, str, bool]) -> float:
    """Return the height above which a picture of a world of boxes is opened [m]."""
    with simkit.load(world(*models)) as sim:
        try:
            return choose_camera(sim, render_view, find_subject(sim, []), Look(quality="fast")).ceiling
        except RenderError as error:
            pytest.skip(f"{error}; apt install libegl1 libopengl0 libgl1-mesa-dri")


def test_a_roof_over_the_robots_is_not_drawn_and_the_same_house_without_a_roof_is_drawn_whole() -> None:
    robots = [("one", "-2 -2 0.2", "0.4 0.4 0.4", False), ("two", "2 2 0.2", "0.4 0.4 0.4", False)]
    assert drawn_ceiling(*HOUSE, *robots, ROOF) == pytest.approx(0.45)
    assert drawn_ceiling(*HOUSE, *robots) == math.inf


def test_a_roof_over_a_room_without_robots_is_not_drawn() -> None:
    shelves = [(f"shelf{n}", f"{n - 2} {n % 3 - 1} 0.2", "0.3 0.3 0.4", True) for n in range(5)]
    assert drawn_ceiling(*HOUSE, *shelves, ROOF) == pytest.approx(1.0, abs=0.1)
    assert drawn_ceiling(*HOUSE, *shelves) == math.inf


def test_a_house_of_one_mesh_is_cut_in_a_view_from_above(tmp_path: Path) -> None:
    hollow = trimesh.util.concatenate(
        [
            trimesh.creation.box(size, trimesh.transformations.translation_matrix([float(v) for v in place.split()]))
            for _, place, text, _ in [*HOUSE[1:], ROOF]
            for size in [[float(v) for v in text.split()]]
        ]
    )
    hollow.export(tmp_path / "house.stl")
    mesh = f"""<model name="house"><static>true</static><link name="l"><visual name="v"><geometry><mesh>
      <uri>{tmp_path}/house.stl</uri></mesh></geometry></visual></link></model>"""
    text = world(("one", "-2 -2 0.2", "0.4 0.4 0.4", False), ("two", "2 2 0.2", "0.4 0.4 0.4", False))
    with simkit.load(text.replace("<gravity>", mesh + "<gravity>"), resource_paths=[tmp_path]) as sim:
        try:
            camera = choose_camera(sim, render_view, find_subject(sim, []), Look(quality="fast"))
        except RenderError as error:
            pytest.skip(f"{error}; apt install libegl1 libopengl0 libgl1-mesa-dri")
    assert camera.ceiling == pytest.approx(0.45)
    np.testing.assert_allclose(camera.eye[:2], camera.target[:2], atol=0.05)


def test_the_title_of_a_picture_names_what_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    titles = []

    def keep_title(*arguments: object) -> Colours:
        marks = arguments[4]
        assert isinstance(marks, Marks)
        titles.append(marks.title)
        return np.zeros((8, 8, 3), np.uint8)

    monkeypatch.setattr(run_picture, "draw_frame", keep_title)
    room = [("wall", "1 0 0.5", "0.1 1 1", True), ("robot", "0 0 0.5", "1 1 1", False)]
    with simkit.load(world(GROUND, *room, ("book", "0 0 343582", "0.2 0.2 0.2", False))) as sim:
        save_picture(sim, tmp_path / "out.png", lambda sim, width, height, **_: np.zeros((height, width, 3), np.uint8))
    assert titles == ["w · t = 0.00 s · outside of the picture: book"]


@pytest.mark.parametrize("content", ["", "version https://git-lfs.github.com/spec/v1"], ids=["missing", "unreadable"])
def test_a_link_whose_visual_meshes_are_missing_or_unreadable_shows_its_collisions(
    tmp_path: Path, content: str
) -> None:
    file = tmp_path / "arm.dae"
    if content:
        file.write_text(content)
    visual = f"<visual name='v'><geometry><mesh><uri>{file}</uri></mesh></geometry></visual>"
    text = world(("robot", "0 0 0.5", "1 1 1", False))
    arm = f"""<link name="arm"><pose>0 0 1 0 0 0</pose>{visual}<collision name="c"><geometry><box>
      <size>1 1 1</size></box></geometry></collision></link>"""
    bare = arm.replace(visual, "").replace("arm", "bumper")
    for link, is_drawn in ((arm, True), (bare, False)):
        with simkit.load(text.replace("</model>", link + "</model>"), resource_paths=[tmp_path]) as sim:
            try:
                distances = np.full((60, 80), np.inf, np.float32)
                render_view(
                    sim, 80, 60, eye=np.array((0.0, -6.0, 1.5)), target=np.array((0.0, 0.0, 1.5)), distances=distances
                )
            except RenderError as error:
                pytest.skip(f"{error}; apt install libegl1 libopengl0 libgl1-mesa-dri")
            assert np.isfinite(distances[30, 40]) == is_drawn


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


@pytest.mark.slow
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
                    pytest.skip(f"{error}; apt install libegl1 libopengl0 libgl1-mesa-dri")
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


def test_long_scans_on_open_ground_do_not_make_the_robot_small_and_a_room_is_shown_whole() -> None:
    angles = np.linspace(-np.pi, np.pi, 90)
    ring = np.stack((np.cos(angles), np.sin(angles), np.zeros(90)), axis=1)
    far, near = ("robot", 30 * ring), ("robot", 4 * ring)
    robot, wall = ("robot", "0 0 0", "1 1 1", False), ("wall", "29 0 0", "0.2 60 2", True)
    for models, scans, width in (([robot], [far], 1.0), ([robot], [far, near], 8.0), ([robot, wall], [far], 60.0)):
        with simkit.load(world(*models)) as sim:
            points = find_subject(sim, [], scans=scans).points
        assert np.ptp(points, axis=0)[:2].max() == pytest.approx(width, rel=0.01)
