"""Bounding box cameras, compared with boxes computed by hand."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from label_worlds import FOCAL, HEIGHT, WIDTH, cube, edges, eye, label, labelled_model, load, visual
from sensor_worlds import colours

from simkit import Pose
from simkit.errors import LoadError

PLATE = "<box><size>0.01 1 0.5</size></box>"
QUIRKS = "<gazebo_quirks>true</gazebo_quirks>"
VISIBLE, FULL, SPACE = ("2d", "full_2d", "3d")


def boxes(models: str, kind: str, block: str = "", **how: Any) -> list[tuple[str, int, Any]]:
    """Return (model, label, bbox) of each detected object."""
    with load("boundingbox_camera", models, f"<box_type>{kind}</box_type>{block}", **how) as sim:
        sim.run(0.01)
        return [(d.id, int(d.results[0].hypothesis.class_id), d.bbox) for d in eye(sim).latest.detections]


def flat(models: str, kind: str, block: str = "", **how: Any) -> dict[tuple[str, int], tuple[float, ...]]:
    return {(model, number): edges(box) for model, number, box in boxes(models, kind, block, **how)}


def plate_at(distance: float, y: float = 0.0, z: float = 0.0, wide: float = 1.0, high: float = 0.5) -> np.ndarray:
    """Return the left, top, right and bottom edge [px] of a plate perpendicular to the camera's axis."""
    scale = FOCAL / distance
    return np.array(
        (
            WIDTH / 2 - (y + wide / 2) * scale,
            HEIGHT / 2 - (z + high / 2) * scale,
            WIDTH / 2 - (y - wide / 2) * scale,
            HEIGHT / 2 - (z - high / 2) * scale,
        )
    )


def centre_of(box: Any) -> np.ndarray:
    p = box.center.position
    return np.array((p.x, p.y, p.z))


def size(box: Any) -> np.ndarray:
    return np.array((box.size.x, box.size.y, box.size.z))


def turn(box: Any) -> Pose:
    q = box.center.orientation
    return Pose((0, 0, 0), (q.w, q.x, q.y, q.z))


# ---------------------------------------------------------------------- in the picture


@pytest.mark.parametrize("name", ["2d", "visible_2d", "visible_box_2d", "full_2d", "full_box_2d"])
def test_a_box_is_around_the_visible_part_of_a_plate(name: str) -> None:
    found = flat(labelled_model("a", "3 0.2 -0.1 0 0 0", visual(PLATE), 7), name)
    assert set(found) == {("a", 7)}
    bound = 0.51 if "full" not in name else 0.05
    np.testing.assert_allclose(found["a", 7], plate_at(2.995, 0.2, -0.1), atol=bound)


def test_a_visible_box_covers_its_pixels_and_gazebos_ends_at_the_number_of_the_last() -> None:
    plate = labelled_model("a", "3 0.2 -0.1 0 0 0", visual(PLATE), 7)
    own, gazebos = flat(plate, VISIBLE)["a", 7], flat(plate, VISIBLE, top=QUIRKS)["a", 7]
    np.testing.assert_array_equal(np.subtract(own, gazebos), (0, 0, 1, 1))


def test_a_half_hidden_object_has_a_smaller_visible_box_and_the_same_full_box() -> None:
    models = labelled_model("a", "4 0 0 0 0 0", visual(PLATE), 7) + labelled_model(
        "wall", "2 -1 0 0 0 0", visual(cube(2))
    )
    seen, full = flat(models, VISIBLE)["a", 7], flat(models, FULL)["a", 7]
    np.testing.assert_allclose(full, plate_at(3.995), atol=0.05)
    assert seen[0] == pytest.approx(full[0], abs=0.51)
    assert seen[2] == pytest.approx(WIDTH / 2, abs=0.51)


@pytest.mark.parametrize("kind", [VISIBLE, FULL, SPACE])
def test_hidden_outside_and_unlabelled_objects_have_no_box(kind: str) -> None:
    models = (
        labelled_model("hidden", "6 0 0 0 0 0", visual(PLATE), 1)
        + labelled_model("wall", "3 0 0 0 0 0", visual(cube(2)))
        + labelled_model("behind", "-3 0 0 0 0 0", visual(cube()), 2)
        + labelled_model("beside", "3 9 0 0 0 0", visual(cube()), 3)
        + labelled_model("far", "200 0 60 0 0 0", visual(cube(20)), 4)
    )
    assert boxes(models, kind) == []


def test_a_full_box_ends_at_the_edges_of_the_image() -> None:
    # it reaches beyond the left edge, and a wall beyond both
    side = flat(labelled_model("a", "2 1 0 0 0 0", visual(PLATE), 7), FULL)["a", 7]
    np.testing.assert_allclose(side, np.maximum(plate_at(1.995, 1), 0), atol=0.1)
    wall = labelled_model("wall", "2 0 0 0 0 0", visual("<box><size>0.01 9 0.5</size></box>"), 8)
    np.testing.assert_allclose(
        flat(wall, FULL)["wall", 8], (0, plate_at(1.995)[1], WIDTH, plate_at(1.995)[3]), atol=0.05
    )
    assert flat(wall, FULL, top=QUIRKS) == {}, "Gazebo has none for what leaves the picture on both sides"


def test_a_box_that_extends_behind_the_camera_is_cut_at_the_near_plane() -> None:
    # a floor from 5 m behind to 5 m ahead, 1 m below: its far edge is the upper one of its box
    floor = labelled_model("floor", "0 0 -1 0 0 0", visual("<box><size>10 2 0.02</size></box>"), 5)
    found = flat(floor, FULL)["floor", 5]
    expected = (0, HEIGHT / 2 + 0.99 * FOCAL / 5, WIDTH, HEIGHT)
    np.testing.assert_allclose(found, expected, atol=0.05)
    seen = flat(floor, VISIBLE)["floor", 5]
    np.testing.assert_allclose((seen[1], seen[3]), (expected[1], expected[3]), atol=0.51)


SHAPES = {
    "ball": "<sphere><radius>0.4</radius></sphere>",
    "can": "<cylinder><radius>0.3</radius><length>0.8</length></cylinder>",
    "pill": "<capsule><radius>0.2</radius><length>0.5</length></capsule>",
    "egg": "<ellipsoid><radii>0.2 0.4 0.3</radii></ellipsoid>",
    "cone": "<cone><radius>0.3</radius><length>0.8</length></cone>",
    "box": "<box><size>0.3 0.5 0.8</size></box>",
}


@pytest.mark.parametrize("shape", SHAPES)
def test_both_boxes_of_an_unhidden_object_are_equal(shape: str) -> None:
    models = labelled_model("a", "3 0.2 0.1 0.4 0.5 0.6", visual(SHAPES[shape]), 7)
    image = {"size": (320, 240)}
    np.testing.assert_allclose(flat(models, VISIBLE, **image)["a", 7], flat(models, FULL, **image)["a", 7], atol=1.0)


def test_a_ball_has_the_box_of_its_cone() -> None:
    # 0.4 m at (3, 0.5): edges at the angle of the middle plus and minus asin(r/d)
    found = flat(labelled_model("a", "3 0.5 0 0 0 0", visual(SHAPES["ball"]), 7), FULL, size=(640, 480))["a", 7]
    focal = FOCAL * 10
    middle, half = np.arctan2(0.5, 3), np.arcsin(0.4 / np.hypot(0.5, 3))
    expected = 320 - focal * np.tan(middle + half), 320 - focal * np.tan(middle - half)
    np.testing.assert_allclose((found[0], found[2]), expected, atol=0.3)


def test_a_model_of_several_links_has_one_box_and_two_labels_have_two() -> None:
    parts = "".join(f'<link name="l{i}"><pose>0 {i - 0.5} 0 0 0 0</pose>{visual(PLATE)}</link>' for i in range(2))
    whole = f'<model name="a"><static>true</static><pose>4 0 0 0 0 0</pose>{parts}{label(7)}</model>'
    for kind in (VISIBLE, FULL):
        found = flat(whole, kind)
        np.testing.assert_allclose(found["a", 7], plate_at(3.995, wide=2), atol=0.51)
    visuals = visual(PLATE, "v", "0 1 0 0 0 0", label(7)) + visual(PLATE, "w", "0 -1 0 0 0 0")
    model = labelled_model("b", "5 0 0 0 0 0", visuals, 8)
    assert set(flat(model, VISIBLE)) == {("b", 7), ("b", 8)}
    assert set(flat(model, VISIBLE, top=QUIRKS)) == {("b", 7)}, "one for the model, with its first label"
    np.testing.assert_allclose(flat(model, FULL, top=QUIRKS)["b", 7], plate_at(4.995, wide=3), atol=0.51)


def test_boxes_are_in_reverse_alphabetical_order_as_in_gazebo() -> None:
    models = "".join(
        labelled_model(n, f"5 {y} 0 0 0 0", visual(PLATE), 7) for n, y in (("a", 1.5), ("c", -1.5), ("b", 0))
    )
    assert [name for name, _, _ in boxes(models, VISIBLE)] == ["c", "b", "a"]


def test_the_label_255_has_a_box_except_with_gazebos_quirks() -> None:
    models = labelled_model("a", "3 0 0 0 0 0", visual(PLATE), 255) + labelled_model(
        "b", "3 0 0.6 0 0 0", visual(PLATE), 0
    )
    assert set(flat(models, VISIBLE)) == {("a", 255), ("b", 0)}
    assert set(flat(models, VISIBLE, top=QUIRKS)) == {("b", 0)}


def test_through_a_lens_boxes_are_around_what_the_lens_shows() -> None:
    lens = "<distortion><k1>-0.25</k1><k2>0.05</k2><p1>0.002</p1></distortion>"
    models = labelled_model("a", "1.5 0.3 0 0 0.3 0.4", visual(cube(0.8)), 7) + labelled_model(
        "b", "4 -1 -1 0 0 0", visual(cube()), 8
    )
    image = {"size": (320, 240)}
    seen, full = flat(models, VISIBLE, lens, **image), flat(models, FULL, lens, **image)
    for key, box in seen.items():
        np.testing.assert_allclose(box, full[key], atol=1.5)
    assert np.abs(np.subtract(seen["a", 7], flat(models, VISIBLE, **image)["a", 7])).max() > 5


def test_a_moving_object_is_at_its_pose_at_the_time_of_the_image() -> None:
    ball = labelled_model(
        "a",
        "3 0 0.4 0 0 0",
        visual(PLATE) + f'<collision name="c"><geometry>{PLATE}</geometry></collision>',
        7,
        static=False,
    )
    with load("boundingbox", ball, "<box_type>full_2d</box_type>") as sim:
        sim.run(0.35)
        time = 0.3
        found = edges(eye(sim).latest.detections[0].bbox)
        np.testing.assert_allclose(found, plate_at(2.995, z=0.4 - 9.8 * time**2 / 2), atol=0.2)


# ---------------------------------------------------------------------- in space


def test_a_box_in_space_is_the_objects_own_in_the_frame_of_the_sensor() -> None:
    stands = Pose.from_rpy(3, 0.4, -0.2, 0.3, 0.2, 0.5)
    models = labelled_model("a", "3 0.4 -0.2 0.3 0.2 0.5", visual("<box><size>0.3 0.5 0.8</size></box>"), 7)
    looks = Pose.from_rpy(0.1, 0.2, 0.3, 0.1, -0.05, 0.2)
    ((_, _, box),) = boxes(models, SPACE, pose="0.1 0.2 0.3 0.1 -0.05 0.2")
    seen = looks.inverse() @ stands
    np.testing.assert_allclose(centre_of(box), seen.position, atol=1e-6)
    np.testing.assert_allclose(turn(box).matrix, seen.matrix, atol=1e-6)
    np.testing.assert_allclose(size(box), (0.3, 0.5, 0.8), atol=1e-6)


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        ("ball", (0.8, 0.8, 0.8)),
        ("can", (0.6, 0.6, 0.8)),
        ("pill", (0.4, 0.4, 0.9)),
        ("egg", (0.4, 0.8, 0.6)),
        ("cone", (0.6, 0.6, 0.8)),
    ],
)
def test_a_box_in_space_has_the_size_of_the_shape(shape: str, expected: tuple[float, float, float]) -> None:
    ((_, _, box),) = boxes(
        labelled_model("a", "3 0 0 0.4 0.5 0.6", visual(SHAPES[shape], pose="0 0.1 0 0 0 0.3"), 7), SPACE
    )
    np.testing.assert_allclose(size(box), expected, atol=1e-3)
    at = Pose.from_rpy(3, 0, 0, 0.4, 0.5, 0.6) @ Pose.from_rpy(0, 0.1, 0, 0, 0, 0.3)
    np.testing.assert_allclose(centre_of(box), at.position, atol=1e-3)
    np.testing.assert_allclose(turn(box).matrix, at.matrix, atol=1e-6)


def test_of_several_visuals_the_box_has_the_axes_of_their_model() -> None:
    parts = visual(cube(0.2), "v", "0 0.4 0 0 0 0.7") + visual(
        "<box><size>0.2 0.2 0.6</size></box>", "w", "0 -0.4 0 0 0 0"
    )
    ((_, _, box),) = boxes(labelled_model("a", "3 0 0 0 0 0.5", parts, 7), SPACE)
    half = 0.1 * (np.cos(0.7) + np.sin(0.7))  # of the turned cube
    wide = 0.4 + half + 0.5
    np.testing.assert_allclose(size(box), (2 * half, wide, 0.6), atol=1e-6)
    np.testing.assert_allclose(turn(box).matrix, Pose.from_rpy(0, 0, 0, 0, 0, 0.5).matrix, atol=1e-9)
    middle = Pose.from_rpy(3, 0, 0, 0, 0, 0.5).transform((0, (0.4 + half - 0.5) / 2, 0))
    np.testing.assert_allclose(centre_of(box), middle, atol=1e-6)


def test_with_gazebos_quirks_boxes_in_space_have_the_axes_of_its_renderer() -> None:
    one = labelled_model("a", "3 0.5 0.2 0 0 0", visual("<box><size>0.3 0.5 0.8</size></box>"), 7)
    ((_, _, box),) = boxes(one, SPACE, top=QUIRKS)
    np.testing.assert_allclose(centre_of(box), (-0.5, 0.2, -3), atol=1e-6)  # right, up, backward
    np.testing.assert_allclose(turn(box).rotate((0, 0, 1)), (0, 1, 0), atol=1e-9)
    two = labelled_model(
        "a", "3 0 0 0 0 0.5", visual(cube(0.2), "v", "0 0.4 0 0 0 0") + visual(cube(0.2), "w", "0 -0.4 0 0 0 0"), 7
    )
    ((_, _, box),) = boxes(two, SPACE, top=QUIRKS)
    assert sorted(size(box)) == pytest.approx([0.2, 0.2, 1.0], abs=1e-6), "along its principal axes"


# ---------------------------------------------------------------------- messages and files


def test_its_topics_and_messages_are_those_of_the_bridge() -> None:
    models = labelled_model("a", "3 0 0 0 0 0", visual(PLATE), 7)
    with load("boundingbox", models) as sim:
        topics = sim.topics()
        assert topics["/eye"] == "vision_msgs/msg/Detection2DArray"
        assert topics["/eye_image"] == "sensor_msgs/msg/Image"
        assert topics["/camera_info"] == "sensor_msgs/msg/CameraInfo"
        sim.run(0.01)
        message = eye(sim).latest
        (one,) = message.detections
        assert one.header == message.header
        assert message.header.frame_id == "m::l::s"
        assert one.results[0].hypothesis.class_id == "7"
        assert one.results[0].hypothesis.score == 1.0
        assert one.id == "a"
    with load("boundingbox", models, "<box_type>3d</box_type>") as sim:
        assert sim.topics()["/eye"] == "vision_msgs/msg/Detection3DArray"


@pytest.mark.parametrize("kind", [VISIBLE, FULL, SPACE])
def test_the_boxes_are_drawn_in_green_into_a_separate_image(kind: str) -> None:
    models = labelled_model("a", "3 0 0 0 0 0", visual(PLATE), 7)
    with load("boundingbox", models, f"<box_type>{kind}</box_type>") as sim:
        images = sim.subscribe("/eye_image")
        sim.run(0.01)
        image = colours(images.messages[-1])
        rows, columns = np.nonzero((image == (0, 255, 0)).all(axis=2))
        drawn = columns.min(), rows.min(), columns.max() + 1, rows.max() + 1
        np.testing.assert_allclose(drawn, plate_at(2.995), atol=1.01)
        assert not (eye(sim)._true_reading().colours == (0, 255, 0)).all(axis=2).any()


def test_an_unknown_type_is_an_error_with_the_known_ones() -> None:
    with pytest.raises(LoadError, match=r"SK-PARAM-002.*expected one of 2d, visible_2d.*full_2d.*3d"):
        load("boundingbox", "", "<box_type>4d</box_type>")


def test_samples_for_a_data_set_are_saved_as_gazebo_lays_them_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    models = labelled_model("a", "3 0.5 0 0 0 0.25", visual(PLATE), 7)
    for kind in (FULL, SPACE):
        save = f'<box_type>{kind}</box_type><save enabled="true"><path>data</path></save>'
        with load("boundingbox", models, save) as sim:
            sim.run(0.01)
    assert (tmp_path / "data/images/image_0000001.png").is_file()
    (row,) = csv.DictReader((tmp_path / "data/boxes/boxes_0000000.csv").read_text().splitlines())
    assert list(row) == ["label", "x_center", "y_center", "width", "height"]
    (row,) = csv.DictReader((tmp_path / "data/boxes/boxes_0000001.csv").read_text().splitlines())
    assert list(row) == ["label", "x", "y", "z", "w", "h", "l", "roll", "pitch", "yaw"]
    assert [float(row[k]) for k in ("label", "x", "y", "w", "h", "l", "yaw")] == [7, 3, 0.5, 0.01, 1, 0.5, 0.25]
