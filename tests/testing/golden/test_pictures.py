"""Pictures: reduction, tile hashes and comparison."""

from __future__ import annotations

from dataclasses import replace
from typing import Any
from zlib import crc32

import numpy as np
import pytest
from made_up import IMAGE, OTHER_MACHINE, hashed, record, stream, times

from simkit.run_spec import Tolerance
from simkit.testing.golden.compare.difference import Verdict
from simkit.testing.golden.compare.pictures import structural_similarity
from simkit.testing.golden.compare.runs import compare
from simkit.testing.golden.report.difference_plot import image_figure
from simkit.testing.run_record.message_recorder import TILE, shrink, tile_hashes
from simkit.testing.run_record.record import Pictures, Stream


def scene(shift: int = 0, brighter: int = 0, *, width: int = 160, height: int = 96) -> Any:
    """Return a picture of a dark room with a bright box."""
    y, x = np.mgrid[0:height, 0:width]
    image = np.stack([60 + x // 4, 50 + y // 3, np.full_like(x, 80)], axis=-1)
    image[30:60, 40 + shift : 80 + shift] = (220, 120, 40)
    return np.clip(image + brighter, 0, 255).astype(np.uint8)


def camera(images: list[Any], encoding: str = "rgb8") -> Stream:
    pictures = Pictures(
        np.stack([shrink(image, 64) for image in images]),
        images[0].shape[:2],
        encoding,
        np.stack([tile_hashes(image) for image in images]),
    )
    return stream("/camera", IMAGE, times(len(images), 10.0), {}, pictures=pictures)


def words(golden: Stream, run: Stream, **more: Any) -> list[str]:
    return [d.words for d in compare(record(golden), record(run, **more)).differences]


def test_reduced_pixels_are_means_of_their_area() -> None:
    image = np.arange(24 * 16, dtype=np.uint8).reshape(16, 24, 1)
    small = shrink(image, 6)
    assert small.shape == (4, 6, 1) and small.dtype == np.uint8
    assert small[0, 0, 0] == round(float(image[:4, :4].mean()) + 1e-9)
    assert shrink(image, 24) is image
    assert shrink(scene(width=161, height=97), 64).shape == (39, 64, 3)


def test_reduced_depths_are_means_of_finite_depths() -> None:
    depth = np.full((8, 8, 1), 2.0, np.float32)
    depth[0, 0] = np.inf
    depth[4:, 4:] = np.inf
    small = shrink(depth, 2)
    assert small[0, 0, 0] == 2.0 and small[1, 1, 0] == np.inf and small.dtype == np.float32


def test_a_pixel_changes_only_the_hash_of_its_tile() -> None:
    image = scene()
    other = image.copy()
    other[40, 70, 1] += 1
    changed = tile_hashes(image) != tile_hashes(other)
    assert changed.shape == (-(-96 // TILE), -(-160 // TILE))
    assert np.argwhere(changed).tolist() == [[1, 2]]


def test_similarity_is_one_for_equal_pictures_and_decreases_with_the_difference() -> None:
    image = scene()
    assert structural_similarity(image, image) == pytest.approx(1.0, abs=1e-12)
    assert 1.0 > structural_similarity(image, scene(2)) > structural_similarity(image, scene(10)) > 0.0
    flat = np.full((64, 64), 100, np.uint8)
    # two flat pictures: only the luminance term is left, (2 a b + c) / (a² + b² + c) with c = (0.01 * 255)²
    expected = (2 * 100 * 120 + 6.5025) / (100**2 + 120**2 + 6.5025)
    assert structural_similarity(flat, flat + 20) == pytest.approx(expected, abs=1e-9)


def test_a_changed_part_of_a_picture_has_position_and_time() -> None:
    (said,) = words(camera([scene()] * 10), camera([scene()] * 4 + [scene(3)] * 6))
    assert said.startswith("/camera: 4 of 15 tiles changed (x 32 to 96, y 0 to 64 px) by ")
    assert "from t = 0.40 s" in said and "similarity 0.9" in said


def test_a_brighter_picture_is_described_as_brighter() -> None:
    (said,) = words(camera([scene()] * 3), camera([scene(brighter=9)] * 3))
    assert (
        said == "/camera: the whole picture changed by 9 of 255 on average, brighter, similarity 0.993, from t = 0.00 s"
    )


def test_a_change_not_visible_in_the_reduced_picture_is_a_difference_on_the_same_machine() -> None:
    other = scene()
    other[90, 150] += 1
    golden, run = camera([scene()] * 3), camera([scene(), scene(), other])
    (found,) = compare(record(golden), record(run)).differences
    assert found.kind == "picture" and found.index == 2
    assert "1 of 15 tiles changed" in found.words and "not visible in the reduced picture" in found.words


def test_pictures_of_another_renderer_are_compared_by_mean_and_similarity() -> None:
    rng = np.random.default_rng(0)
    noisy = np.clip(scene() + rng.integers(-3, 4, scene().shape), 0, 255).astype(np.uint8)
    machine = {**OTHER_MACHINE, "renderer": "another"}
    golden = camera([scene()] * 3)
    close = compare(record(golden), record(camera([noisy] * 3), machine=machine))
    assert close.passed and "within a mean difference of 2 of 255" in close.notes[0]
    assert words(golden, camera([scene(4)] * 3), machine=machine)  # the box moved by 2.5 % of the width
    assert words(golden, camera([scene(brighter=5)] * 3), machine=machine)
    loose = (Tolerance("/camera", image=20.0, ssim=0.5),)
    assert not words(golden, camera([scene(4)] * 3), machine=machine, tolerances=loose)


def test_another_renderer_alone_makes_pictures_tolerant_and_leaves_numbers_exact() -> None:
    rng = np.random.default_rng(0)
    noisy = np.clip(scene() + rng.integers(-1, 2, scene().shape), 0, 255).astype(np.uint8)
    number = stream("/n", "std_msgs/msg/Float64", times(3, 10.0), {"data": np.zeros(3)})
    other = stream("/n", "std_msgs/msg/Float64", times(3, 10.0), {"data": np.full(3, 1e-9)})
    machine = dict(record().fingerprint)
    golden = record(camera([scene()] * 3), number, machine={**machine, "renderer": "a"})
    run = record(camera([noisy] * 3), other, machine={**machine, "renderer": "b"})
    found = compare(golden, run)
    assert found.tier == "exact" and found.machine == {"renderer": ("a", "b")}
    assert [d.topic for d in found.differences] == ["/n"]


def test_depths_are_compared_as_lengths() -> None:
    depth = np.full((48, 64, 1), 2.0, np.float32)
    off, hit = depth.copy(), depth.copy()
    off[:, 32:] += 0.012
    hit[:, :8] = np.inf
    golden = camera([depth] * 3, "32FC1")
    (said,) = words(golden, camera([depth, off, off], "32FC1"))
    assert said == "/camera: 1536 of 3072 pixels +12 mm from t = 0.10 s"
    (said,) = words(golden, camera([hit] * 3, "32FC1"))
    assert said == "/camera: 384 of 3072 pixels became infinite from t = 0.00 s"


def test_a_changed_size_or_encoding_is_reported_instead_of_pixels() -> None:
    golden = camera([scene()] * 2)
    assert words(golden, camera([scene(width=200)] * 2)) == ["/camera: 160 × 96 px became 200 × 96 px"]
    assert words(golden, camera([scene(1)] * 2, "bgr8")) == ["/camera: encoding rgb8 became bgr8"]


def strided(images: list[Any], every: int) -> Stream:
    """Return a camera stream that stores every second, fourth, … picture and the hashes of all pictures."""
    found = camera(images)
    assert found.pictures is not None
    kept = np.arange(0, len(images), every)
    hashes = np.array([crc32(image.tobytes()) for image in images], np.uint32)
    found.pictures = replace(found.pictures.at(kept), hashes=hashes)
    return hashed(found)


def test_runs_that_stored_different_pictures_are_compared_by_message() -> None:
    golden = strided([scene(i) for i in range(40)], 2)
    run = strided([scene(i + 3 * (i >= 21)) for i in range(40)], 4)
    (found,) = compare(record(golden), record(run)).differences
    # 24 is the first message that both runs stored; 6 · 30 of 96 · 160 pixels differ
    assert "from t = 2.40 s" in found.words and "in " not in found.words.partition("from")[2].partition(";")[0]
    assert found.words.endswith("; the first picture that differs, at t = 2.10 s, is not stored")
    assert found.index == 21 and found.time == pytest.approx(2.1)
    assert image_figure(Verdict("g", record(golden), record(run), compare(record(golden), record(run))), found)
    machine = {**OTHER_MACHINE, "renderer": "another"}
    (found,) = compare(record(golden), record(run, machine=machine)).differences
    assert found.index == 24 and "not kept" not in found.words


def test_a_different_picture_that_is_not_stored_is_found_by_its_hash() -> None:
    images = [scene(i) for i in range(40)]
    other = [*images[:9], scene(30), *images[10:]]
    (found,) = compare(record(strided(images, 2)), record(strided(other, 2))).differences
    assert found.words == "/camera: pictures differ from t = 0.90 s, in 1 of 40, but in no stored picture"
    assert found.kind == "picture" and found.index == 9


def test_differences_of_depths_have_the_times_of_their_messages() -> None:
    depth = np.full((48, 64, 1), 2.0, np.float32)
    golden = strided([depth] * 40, 2)
    run = strided([depth] * 20 + [depth + np.float32(0.012)] * 20, 4)
    (found,) = compare(record(golden), record(run)).differences
    assert found.words == "/camera: all 3072 pixels +12 mm from t = 2.00 s" and found.index == 20
