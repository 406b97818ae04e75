"""Segmentation cameras, compared with numbers of pixels computed by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from label_worlds import FOCAL, HEIGHT, WIDTH, bare, counts, cube, eye, label, labelled_model, labels, load, visual
from sensor_worlds import colours

from simkit.errors import LoadError
from simkit_special_cameras.sensors.segmentation_camera import label_colours

PLATE = "<box><size>0.01 1 0.5</size></box>"
PANOPTIC = "<segmentation_type>panoptic</segmentation_type>"


def map_of(models: str, block: str = "", **how: object) -> np.ndarray:
    with load("segmentation_camera", models, block, **how) as sim:
        sim.run(0.01)
        return labels(sim)


def pixels_of_plate(distance: float, width: float = 1.0, height: float = 0.5) -> int:
    """Return the number of pixels whose middle is inside the image of a plate perpendicular to the camera's axis."""
    across, down = width / 2 * FOCAL / distance, height / 2 * FOCAL / distance
    column, row = np.arange(WIDTH) + 0.5 - WIDTH / 2, np.arange(HEIGHT) + 0.5 - HEIGHT / 2
    return int((np.abs(column) < across).sum() * (np.abs(row) < down).sum())


# ---------------------------------------------------------------------- semantic


def test_a_labelled_plate_covers_the_pixels_that_it_should() -> None:
    found = counts(map_of(labelled_model("a", "2 0 0 0 0 0", visual(PLATE), 40)))
    seen = pixels_of_plate(1.995)
    assert found == {(40, 40, 40): seen, (0, 0, 0): WIDTH * HEIGHT - seen}


def test_an_object_without_a_label_is_background_and_hides_others() -> None:
    behind = labelled_model("a", "4 0 0 0 0 0", visual(PLATE), 40)
    assert (40, 40, 40) in counts(map_of(behind))
    assert counts(map_of(behind + labelled_model("b", "2 0 0 0 0 0", visual(PLATE)))) == {(0, 0, 0): WIDTH * HEIGHT}


def test_a_visual_and_the_rest_of_its_model_have_each_their_own_label() -> None:
    parts = visual(PLATE, "v", "0 1 0 0 0 0", label(7)) + visual(PLATE, "w", "0 -1 0 0 0 0")
    image = map_of(labelled_model("a", "3 0 0 0 0 0", parts, 8))[HEIGHT // 2, :, 0]
    assert image[WIDTH // 2 - 20] == 7
    assert image[WIDTH // 2 + 20] == 8
    assert image[WIDTH // 2] == 0


def test_transparent_objects_have_their_own_labels() -> None:
    glass = visual(PLATE, more="<transparency>0.6</transparency>")
    models = labelled_model("glass", "2 0 0 0 0 0", glass, 5) + labelled_model(
        "wall", "3 0 0 0 0 0", visual(cube(2)), 6
    )
    assert counts(map_of(models))[(5, 5, 5)] == pixels_of_plate(1.995)


@pytest.mark.parametrize("quality", ["fast", "gazebo"])
def test_labels_are_not_blended_at_edges(quality: str) -> None:
    top = f"<scene><quality>{quality}</quality></scene>"
    models = labelled_model("a", "3 0.3 0 0.3 0.4 0.5", visual(cube()), 200) + labelled_model(
        "b", "4 -0.5 0 0 0 0", visual(cube()), 100
    )
    found = counts(map_of(models, top=top))
    assert set(found) == {(0, 0, 0), (100, 100, 100), (200, 200, 200)}


def test_a_mesh_of_several_materials_and_a_round_object_have_one_label() -> None:
    ball = labelled_model("ball", "3 0 0 0 0 0", visual("<sphere><radius>0.5</radius></sphere>"), 9)
    seen = counts(map_of(ball))[(9, 9, 9)]
    radius = FOCAL * 0.5 / np.sqrt(9 - 0.25)  # of the circle in which a ball is seen
    assert seen == pytest.approx(np.pi * radius**2, rel=0.05)


def test_the_colour_of_a_label_is_gazebos() -> None:
    # Lehmer's numbers with the factor 16807 begin 16807, 282475249, 1622650073; 2147483645 // 256 = 8388607
    assert label_colours([1])[1] == (16806 // 8388607, 282475248 // 8388607, 1622650072 // 8388607) == (0, 33, 193)
    with load("segmentation", labelled_model("a", "2 0 0 0 0 0", visual(PLATE), 1)) as sim:
        coloured = sim.subscribe("/eye/colored_map")
        sim.run(0.01)
        assert counts(colours(coloured.messages[-1]))[(0, 33, 193)] == pixels_of_plate(1.995)


def test_no_two_numbers_have_one_colour() -> None:
    found = label_colours([*range(1, 256), *(65536 * 40 + i for i in range(1, 2000))])
    assert len(set(found.values())) == len(found)
    assert (0, 0, 0) not in found.values()


# ---------------------------------------------------------------------- panoptic


@pytest.mark.parametrize("kind", ["panoptic", "instance", "Panoptic"])
def test_objects_of_one_label_are_counted_in_reverse_alphabetical_order(kind: str) -> None:
    models = "".join(
        labelled_model(n, f"4 {y} 0 0 0 0", visual(PLATE), 12) for n, y in (("a", 1.5), ("b", 0), ("c", -1.5))
    )
    models += labelled_model("z", "4 0 1 0 0 0", visual(PLATE), 13)
    image = map_of(models, f"<segmentation_type>{kind}</segmentation_type>")
    row = image[HEIGHT // 2]
    assert [tuple(row[c]) for c in (10, 32, 54)] == [(3, 0, 12), (2, 0, 12), (1, 0, 12)]
    assert (1, 0, 13) in counts(image)
    assert set(counts(image)) == {(0, 0, 0), (1, 0, 12), (2, 0, 12), (3, 0, 12), (1, 0, 13)}


def test_the_number_of_an_object_has_two_bytes() -> None:
    hidden = "".join(labelled_model(f"n{i:03}", "-5 0 0 0 0 0", visual(PLATE), 3) for i in range(300))
    image = map_of(labelled_model("a", "2 0 0 0 0 0", visual(PLATE), 3) + hidden, PANOPTIC)
    assert (301 & 255, 301 >> 8, 3) in counts(image)


def test_a_model_of_several_links_is_one_object() -> None:
    links = "".join(f'<link name="l{i}"><pose>0 {i - 1} 0 0 0 0</pose>{visual(PLATE)}</link>' for i in range(3))
    model = f'<model name="a"><static>true</static><pose>4 0 0 0 0 0</pose>{links}{label(12)}</model>'
    assert set(counts(map_of(model, PANOPTIC))) == {(0, 0, 0), (1, 0, 12)}


def test_two_labels_of_one_model_are_counted_separately_unlike_in_gazebo() -> None:
    parts = visual(PLATE, "v", "0 1 0 0 0 0", label(7)) + visual(PLATE, "w", "0 -1 0 0 0 0", label(8))
    model = labelled_model("a", "3 0 0 0 0 0", parts)
    assert set(counts(map_of(model, PANOPTIC))) == {(0, 0, 0), (1, 0, 7), (1, 0, 8)}
    quirks = "<gazebo_quirks>true</gazebo_quirks>"
    assert set(counts(map_of(model, PANOPTIC, top=quirks))) == {(0, 0, 0), (0, 0, 7), (1, 0, 8)}


def test_a_colour_is_that_of_one_object() -> None:
    models = "".join(
        labelled_model(n, f"4 {y} 0 0 0 0", visual(PLATE), 12) for n, y in (("a", 1.5), ("b", 0), ("c", -1.5))
    )
    with load("segmentation", models, PANOPTIC) as sim:
        sim.run(0.01)
        reading = eye(sim)._true_reading()
        told, coloured = reading.labels.reshape(-1, 3), reading.coloured.reshape(-1, 3)
        pairs = np.unique(np.concatenate((told, coloured), axis=1), axis=0)
        assert len(pairs) == 4
        assert len(np.unique(pairs[:, 3:], axis=0)) == 4


# ---------------------------------------------------------------------- through a lens, and in time


def test_through_a_lens_labels_are_not_blended_and_the_plate_is_smaller() -> None:
    lens = "<distortion><k1>-0.3</k1><k2>0.05</k2></distortion>"
    plate = labelled_model("a", "1.2 0 0 0 0 0", visual(PLATE), 40)
    straight, bent = counts(map_of(plate)), counts(map_of(plate, lens))
    assert set(bent) == {(0, 0, 0), (40, 40, 40)}
    assert 0.6 < bent[(40, 40, 40)] / straight[(40, 40, 40)] < 0.97


def test_objects_are_at_their_poses_at_the_time_of_the_sample() -> None:
    falling = labelled_model(
        "a",
        "3 0 0 0 0 0",
        visual(cube(0.4)) + f'<collision name="c"><geometry>{cube(0.4)}</geometry></collision>',
        4,
        static=False,
    )
    with load("segmentation", falling) as sim:
        sim.run(0.001)
        first = np.flatnonzero((labels(sim)[..., 0] == 4).any(axis=1)).mean()
        sim.run(0.3)
        time = sim.time_ns / 1e9 // 0.1 * 0.1
        then = np.flatnonzero((labels(sim)[..., 0] == 4).any(axis=1)).mean()
        assert then - first == pytest.approx(FOCAL / 2.8 * 9.8 * time**2 / 2, abs=1.0)


def test_a_label_counts_from_when_it_was_changed() -> None:
    with load("segmentation", labelled_model("a", "2 0 0 0 0 0", visual(PLATE), 40)) as sim:
        sim.run(0.15)
        sim.contents.labels["a"] = 41
        assert (40, 40, 40) in counts(labels(sim)), "it was taken before"
        sim.run(0.1)
        assert (41, 41, 41) in counts(labels(sim))
        sim.contents.labels["a::l::v"] = 42
        sim.run(0.1)
        assert (42, 42, 42) in counts(labels(sim))
        sim.reset()
        sim.run(0.01)
        assert (40, 40, 40) in counts(labels(sim))


def test_an_unread_image_has_the_labels_of_its_time() -> None:
    with load("segmentation", labelled_model("a", "2 0 0 0 0 0", visual(PLATE), 40)) as sim:
        sim.run(0.15)
        sim.remove("a")
        assert counts(labels(sim))[(40, 40, 40)] == pixels_of_plate(1.995)
        sim.spawn(f'<sdf version="1.9">{labelled_model("b", "2 0 0 0 0 0", visual(PLATE), 50)}</sdf>')
        assert (40, 40, 40) in counts(labels(sim))
        sim.run(0.1)
        assert counts(labels(sim))[(50, 50, 50)] == pixels_of_plate(1.995)


def test_a_visibility_mask_hides_objects() -> None:
    flagged = visual(PLATE, more="<visibility_flags>2</visibility_flags>")
    models = labelled_model("a", "2 0 0 0 0 0", flagged, 40) + labelled_model("b", "3 0 0 0 0 0", visual(cube(3)), 50)
    assert set(counts(map_of(models, "<visibility_mask>1</visibility_mask>"))) == {(50, 50, 50)}


# ---------------------------------------------------------------------- topics and files


def test_its_topics_and_messages_are_gazebos() -> None:
    with load("segmentation", labelled_model("a", "2 0 0 0 0 0", visual(PLATE), 40)) as sim:
        topics = sim.topics()
        assert topics["/eye/labels_map"] == topics["/eye/colored_map"] == "sensor_msgs/msg/Image"
        assert topics["/eye/camera_info"] == "sensor_msgs/msg/CameraInfo"
        sim.run(0.01)
        message = eye(sim).latest
        assert (message.encoding, message.width, message.height, message.step) == ("rgb8", WIDTH, HEIGHT, 3 * WIDTH)
        assert message.header.frame_id == "m::l::s"


def test_without_a_topic_gazebos_default_applies() -> None:
    sensor = '<sensor name="s" type="segmentation"><camera/></sensor>'
    with bare(sensor) as sim:
        assert "/world/w/model/m/link/l/sensor/s/segmentation/labels_map" in sim.topics()


def test_an_older_file_has_the_type_in_the_sensor_itself() -> None:
    text = '<sensor name="s" type="segmentation"><segmentation_type>panoptic</segmentation_type><camera/></sensor>'
    with bare(text) as sim:
        assert sim.sensor("m::l::s").describe()["segmentation_type"] == "panoptic"
        assert not [d for d in sim.diagnostics if "segmentation_type" in d.message]


def test_an_unknown_type_is_an_error_that_lists_the_known_ones() -> None:
    with pytest.raises(LoadError, match=r"SK-PARAM-002.*expected one of semantic, instance, panoptic"):
        load("segmentation", "", "<segmentation_type>semantik</segmentation_type>")


def test_a_world_without_labels_is_reported() -> None:
    def severities(models: str) -> list[str]:
        with load("segmentation", models) as sim:
            return [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-132"]

    assert severities("") == ["warning"]
    assert severities(labelled_model("a", "2 0 0 0 0 0", visual(PLATE), 40)) == []


def test_samples_for_a_data_set_are_saved_as_gazebo_lays_them_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from PIL import Image

    monkeypatch.chdir(tmp_path)
    save = '<save enabled="true"><path>data</path></save>'
    for _ in range(2):  # the second run goes on counting
        with load("segmentation", labelled_model("a", "2 0 0 0 0 0", visual(PLATE), 40), save) as sim:
            sim.run(0.15)
    names = sorted(str(p.relative_to(tmp_path / "data")) for p in (tmp_path / "data").rglob("*.png"))
    parts = [("colored_maps", "colored"), ("images", "image"), ("labels_maps", "labels")]
    assert names == [f"{folder}/{stem}_{i:07d}.png" for folder, stem in parts for i in range(4)]
    with Image.open(tmp_path / "data/labels_maps/labels_0000003.png") as image:
        assert counts(np.asarray(image))[(40, 40, 40)] == pixels_of_plate(1.995)
