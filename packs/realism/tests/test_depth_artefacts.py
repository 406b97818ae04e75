"""Depth cameras have the errors and holes of their artefacts, measured back on small worlds."""

from __future__ import annotations

import math
import pickle
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import simkit
from simkit import msgs

WIDTH, HEIGHT, FOV = 160, 120, 1.2
FOCAL = WIDTH / (2 * math.tan(FOV / 2))  # [px]
Depths = npt.NDArray[np.float32]


def box(name: str, pose: str, size: str, colour: str = "1 1 1", more: str = "") -> str:
    return f"""<model name="{name}"><static>true</static><pose>{pose}</pose><link name="l"><visual name="v">
      <geometry><box><size>{size}</size></box></geometry>{more}
      <material><ambient>{colour} 1</ambient><diffuse>{colour} 1</diffuse></material></visual></link></model>"""


WALL = box("wall", "2.5 0 0 0 0 0", "1 40 40")
"""Wall whose surface is 2 m before the camera."""


def world(artefact: str, others: str = WALL, kind: str = "depth_camera", camera: str = "", far: float = 20) -> str:
    return f"""<sdf version="1.9" xmlns:simkit="simkit"><world name="w">
      <scene><ambient>1 1 1 1</ambient><background>0 0 0 1</background></scene>
      <model name="m"><static>true</static><link name="l"><sensor name="s" type="{kind}"><update_rate>10</update_rate>
      <topic>c</topic>{artefact}<camera><horizontal_fov>{FOV}</horizontal_fov>
      <image><width>{WIDTH}</width><height>{HEIGHT}</height></image>
      <clip><near>0.1</near><far>{far}</far></clip>{camera}</camera></sensor></link></model>{others}</world></sdf>"""


def seen(text: str, count: int = 1, seed: int = 0, **how: Any) -> tuple[Depths, Depths]:
    """Return the depths of some samples, shape (count, h, w), and the true depths of the last."""
    with simkit.load(text, seed=seed, **how) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        sensor, found = sim.sensor("m::l::s"), []
        for i in range(count):
            sim.run(0.1 if i else 0.05)
            found.append(sensor.depth.copy())
        return np.stack(found), sensor.true_depth.copy()


def share_lost(depths: Depths) -> float:
    return float(np.isinf(depths).mean())


# ---------------------------------------------------------------------- errors


@pytest.mark.parametrize("distance", [0.7, 2.0, 3.6])
def test_the_scale_and_the_noise_of_the_x3_follow_its_power_law(distance: float) -> None:
    law = "<scale>-0.012</scale><stddev>0.002</stddev><coefficient>0.0019</coefficient><exponent>2.36</exponent>"
    wall = box("wall", f"{distance + 0.5} 0 0 0 0 0", "1 40 40")
    (depths,), truth = seen(world(f"<simkit:depth_error>{law}</simkit:depth_error>", wall))
    reported = 0.988 * distance
    assert np.abs(truth - distance).max() < 1e-5
    sigma = max(0.002, 0.0019 * reported**2.36)
    assert depths.mean() == pytest.approx(reported, abs=4 * sigma / math.sqrt(depths.size))
    assert depths.std() == pytest.approx(sigma, rel=4 / math.sqrt(2 * depths.size))


def test_measured_points_give_the_noise_at_and_between_them() -> None:
    points = "<point>1 0.002</point><point>4 0.032</point>"  # a slope of 2 between them
    (depths,), _ = seen(world(f"<simkit:depth_error>{points}</simkit:depth_error>"))
    assert depths.std() == pytest.approx(0.008, rel=0.03)


def test_noise_is_correlated_over_its_window_and_not_beyond() -> None:
    noise = "<stddev>0.01</stddev><correlation_length>5</correlation_length>"
    depths, truth = seen(world(f"<simkit:depth_error>{noise}</simkit:depth_error>"), 4)
    error = depths - truth
    assert error.std() == pytest.approx(0.01, rel=0.06)
    for lag in range(8):
        product = error[:, :, lag:] * error[:, :, : WIDTH - lag]
        # windows of 5 pixels that are `lag` pixels apart share (5 - lag)/5 of their area
        assert product.mean() / error.var() == pytest.approx(max(0.0, 1 - lag / 5), abs=0.05)


def test_noise_grows_with_the_angle_of_incidence() -> None:
    tilted = box("wall", f"2 0 0 0 0 {math.radians(60)}", "0.001 40 40")
    noise = "<stddev>0.001</stddev><incidence_exponent>1</incidence_exponent>"
    depths, truth = seen(world(f"<simkit:depth_error>{noise}</simkit:depth_error>", tilted, far=100), 20)
    middle = np.s_[HEIGHT // 2 - 10 : HEIGHT // 2 + 10, WIDTH // 2 - 2 : WIDTH // 2 + 2]
    column = depths[:, *middle] - truth[middle]
    assert column.std() == pytest.approx(0.001 / math.cos(math.radians(60)), rel=0.04)


def test_noise_of_a_surface_without_texture_is_larger() -> None:
    noise = "<simkit:depth_error><stddev>0.001</stddev><contrast>0.1</contrast></simkit:depth_error>"
    checks = "".join(box(f"t{i}", f"1.999 {-2 + i * 0.03} 0 0 0 0", "0.002 0.015 1", "0 0 0") for i in range(66))
    (depths,), truth = seen(world(noise, WALL + checks))
    error = depths - truth
    plain, textured = error[5:20, 100:150], error[HEIGHT // 2 - 10 : HEIGHT // 2 + 10, 90:150]
    assert textured.std() == pytest.approx(0.001, rel=0.1)
    assert plain.std() == pytest.approx(0.1 * 255 * 0.001, rel=0.1)  # a contrast of less than 1 counts as 1


def test_a_quantised_disparity_rounds_the_depths_with_their_noise() -> None:
    step = "<simkit:disparity_noise><step>0.125</step><baseline>0.05</baseline></simkit:disparity_noise>"
    (depths,), _ = seen(world("<simkit:depth_error><stddev>0.05</stddev></simkit:depth_error>", camera=step))
    disparities = FOCAL * 0.05 / depths / 0.125
    assert np.abs(disparities - np.rint(disparities)).max() < 1e-3
    assert len(np.unique(depths)) < 30


# ---------------------------------------------------------------------- two eyes


@pytest.mark.parametrize("side", [1, -1])
def test_the_occlusion_shadow_has_the_width_of_the_difference_of_disparities(side: int) -> None:
    near = box("near", "1.05 0 0 0 0 0", "0.1 0.4 40")
    text = world(f"<simkit:occlusion_shadow><baseline>{0.1 * side}</baseline></simkit:occlusion_shadow>", WALL + near)
    (depths,), truth = seen(text)
    row, lost = truth[HEIGHT // 2], np.isinf(depths[HEIGHT // 2])
    columns = np.flatnonzero(row < 1.5)
    expected = FOCAL * 0.1 * (1 / 1.0 - 1 / 2.0)
    left, right = lost[columns[0] - 20 : columns[0]].sum(), lost[columns[-1] + 1 : columns[-1] + 21].sum()
    shadow, other = (left, right) if side > 0 else (right, left)
    assert shadow == pytest.approx(expected, abs=1.0)
    assert other == 0
    # the columns at the edge that the second eye does not see
    band = lost[:20].sum() if side > 0 else lost[-20:].sum()
    assert band == pytest.approx(FOCAL * 0.1 / 2, abs=1.0)
    assert not lost[columns].any()


# ---------------------------------------------------------------------- time of flight


def test_flying_pixels_are_between_both_surfaces_and_only_at_the_edge() -> None:
    near = box("near", "1.05 0 0 0 0 0", "0.1 0.4 40")
    (depths,), truth = seen(world("<simkit:flying_pixels><width>2</width></simkit:flying_pixels>", WALL + near))
    changed = depths != truth
    row = truth[HEIGHT // 2]
    edges = np.flatnonzero(np.diff(row)) + 0.5
    assert len(edges) == 2
    distances = np.abs(np.arange(WIDTH)[:, None] - edges).min(axis=1)
    assert (changed == (distances < 2)[None]).all()
    mixed = depths[changed]
    assert 1.0 < mixed.min() < 1.05
    assert 1.95 < mixed.max() < 2.0
    assert mixed.mean() == pytest.approx(1.5, abs=4 * 0.289 / math.sqrt(mixed.size))


def test_a_share_of_the_edge_pixels_flies() -> None:
    near = box("near", "1.05 0 0 0 0 0", "0.1 0.4 40")
    flying = "<simkit:flying_pixels><probability>0.3</probability></simkit:flying_pixels>"
    depths, truth = seen(world(flying, WALL + near), 5)
    at_edge = np.count_nonzero(np.diff(truth[0])) * 2 * HEIGHT
    share = np.count_nonzero(depths != truth) / (5 * at_edge)
    assert share == pytest.approx(0.3, abs=4 * math.sqrt(0.3 * 0.7 / (5 * at_edge)))


def test_a_concave_corner_is_rounded_by_the_mean_of_its_neighbours() -> None:
    walls = box("a", f"3 0 0 0 0 {math.pi / 4}", "0.001 6 40") + box("b", f"3 0 0 0 0 {-math.pi / 4}", "0.001 6 40")
    radius, strength = 6, 0.5
    artefact = f"<simkit:multipath><radius>{radius}</radius><strength>{strength}</strength></simkit:multipath>"
    (depths,), truth = seen(world(artefact, walls, far=100))
    row, error = truth[HEIGHT // 2], (depths - truth)[HEIGHT // 2]
    corner = int(np.argmax(row))
    inverse = 1 / row.astype(np.float64)
    mean = inverse[corner - radius : corner + radius + 1].mean()
    expected = strength * row[corner] ** 2 * (mean - inverse[corner])
    assert 0.01 < expected < 0.1
    assert error[corner] == pytest.approx(expected, rel=1e-3)
    assert np.abs(error[corner - 40 : corner - 2 * radius]).max() < 1e-5  # planes stay as they are


def test_distances_beyond_the_unambiguous_range_begin_again() -> None:
    (depths,), truth = seen(world("<simkit:phase_wrap><range>2.1</range></simkit:phase_wrap>"))
    x = (np.arange(WIDTH) + 0.5 - WIDTH / 2) / FOCAL
    y = (np.arange(HEIGHT)[:, None] + 0.5 - HEIGHT / 2) / FOCAL
    stretch = np.sqrt(1 + x**2 + y**2)
    expected = np.where(truth * stretch < 2.1, truth, (truth * stretch - 2.1) / stretch)
    expected[expected < 0.1] = -np.inf  # nearer than the range
    is_far_from_the_limit = np.abs(expected - 0.1) > 1e-4
    np.testing.assert_allclose(depths[is_far_from_the_limit], expected[is_far_from_the_limit], atol=1e-5)


# ---------------------------------------------------------------------- holes


def holes(content: str) -> str:
    return f"<simkit:depth_holes>{content}</simkit:depth_holes>"


def test_a_share_of_the_pixels_has_no_return_and_the_truth_has_all() -> None:
    depths, truth = seen(world(holes("<probability>0.2</probability>")), 5)
    assert share_lost(depths) == pytest.approx(0.2, abs=4 * math.sqrt(0.16 / depths.size))
    assert np.isfinite(truth).all()
    assert (depths[np.isfinite(depths)] == truth[0, 0]).all()


def test_holes_have_the_size_of_their_window() -> None:
    depths, _ = seen(world(holes("<probability>0.2</probability><correlation_length>9</correlation_length>")), 10)
    lost = np.isinf(depths)
    assert lost.mean() == pytest.approx(0.2, abs=0.02)
    # two normal numbers with the correlation 8/9 are both in the lowest fifth in 14.7 % of all pairs
    assert lost[:, :, 1:][lost[:, :, :-1]].mean() == pytest.approx(0.147 / 0.2, abs=0.03)
    assert lost[:, :, 12:][lost[:, :, :-12]].mean() == pytest.approx(0.2, abs=0.04)


def test_holes_stay_for_their_correlation_time() -> None:
    text = world(holes("<probability>0.3</probability><correlation_time>1</correlation_time>"))
    depths, _ = seen(text, 30)  # 10 samples a second
    lost = np.isinf(depths)
    after = [lost[lag:][lost[:-lag]].mean() for lag in (1, 5, 20)]
    assert lost.mean() == pytest.approx(0.3, abs=0.01)
    assert after[0] > 0.85
    assert 0.4 < after[1] < 0.75
    assert after[2] == pytest.approx(0.3, abs=0.02)


def test_each_cell_of_a_map_has_its_share_of_returns() -> None:
    rows = [[0.0, 0.25, 1.0, 0.5], [1.0, 0.75, 0.9, 0.1]]
    text = "".join(f"<row>{' '.join(map(str, row))}</row>" for row in rows)
    depths, _ = seen(world(holes(f"<map>{text}</map>")), 5)
    valid = np.isfinite(depths).reshape(5, 2, HEIGHT // 2, 4, WIDTH // 4).mean(axis=(0, 2, 4))
    np.testing.assert_allclose(valid, rows, atol=4 * 0.5 / math.sqrt(5 * HEIGHT * WIDTH / 8))


def test_the_border_is_empty_and_the_corners_are_empty_more_often_than_the_middle() -> None:
    depths, _ = seen(world(holes("<border>10 4 2 6</border><vignetting>0.8</vignetting>")), 20)
    lost = np.isinf(depths)
    assert lost[:, :, :10].all() and lost[:, :, -4:].all() and lost[:, :2].all() and lost[:, -6:].all()
    assert lost[:, 50:70, 70:90].mean() < 0.001
    x, y = np.meshgrid((np.arange(WIDTH) + 0.5) * 2 / WIDTH - 1, (np.arange(HEIGHT) + 0.5) * 2 / HEIGHT - 1)
    expected = 0.8 * ((x * x + y * y) / 2) ** 2
    inside = np.s_[2:-6, 10:-4]
    assert lost[:, *inside].mean() == pytest.approx(expected[inside].mean(), abs=0.005)


def test_surfaces_at_a_steep_angle_have_no_return() -> None:
    floor = box("floor", "0 0 -0.3 0 0 0", "40 40 0.001")
    text = world(holes("<incidence><start>1.2</start><end>1.2</end></incidence>"), WALL + floor)
    (depths,), truth = seen(text)
    lost = np.isinf(depths)
    down = (np.arange(HEIGHT) + 0.5 - HEIGHT / 2) / FOCAL
    x = (np.arange(WIDTH) + 0.5 - WIDTH / 2) / FOCAL
    is_floor = truth < 1.999
    # the floor's normal is vertical, so the cosine of the angle is the vertical part of the ray
    cosines = np.abs(down[:, None]) / np.sqrt(1 + x**2 + down[:, None] ** 2)
    expected = is_floor & (cosines <= math.cos(1.2))
    # beside the edge of wall and floor the gradient is that of either
    assert np.count_nonzero(lost != expected) <= 2 * WIDTH
    assert expected.sum() > 1000


def test_the_wedge_sweeps_over_the_image_below_its_start() -> None:
    wedge = "<wedge><start>0.6</start><end>0.363</end><direction>0.785398</direction></wedge>"
    shares = {}
    for distance in (0.7, 0.45):
        wall = box("wall", f"{distance + 0.5} 0 0 0 0 0", "1 40 40")
        (depths,), _ = seen(world(holes(wedge), wall))
        shares[distance] = np.isinf(depths)
    assert not shares[0.7].any()
    # at 0.45 m the line is half way from the lower left corner to the upper right one
    position = (1 / 0.45 - 1 / 0.6) / (1 / 0.363 - 1 / 0.6)
    u, v = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    expected = (u + HEIGHT - v) / (WIDTH + HEIGHT) < position
    assert np.count_nonzero(shares[0.45] != expected) < 3
    assert shares[0.45][-1, 0] and not shares[0.45][0, -1]


def test_dark_surfaces_have_no_return() -> None:
    patch = box("patch", "1.99 0.5 0 0 0 0", "0.02 1 40", "0.05 0.05 0.05")
    (depths,), _ = seen(world(holes("<brightness><start>0.2</start><end>0.1</end></brightness>"), WALL + patch))
    lost = np.isinf(depths)
    assert lost[:, 25:70].all()
    assert not lost[:, 90:].any()


def test_named_surfaces_and_dull_materials_have_no_return() -> None:
    paint = "<simkit:reflectivity>0.02</simkit:reflectivity>"
    patch = box("patch", "1.9 0.5 0 0 0 0", "0.02 0.4 40", more=paint)
    floor = box("floor", "0 0 -0.5 0 0 0", "40 40 0.001")
    reasons = "<surface><name>floor</name></surface><reflectivity><start>0.1</start><end>0.05</end></reflectivity>"
    (depths,), truth = seen(world(holes(reasons), WALL + patch + floor))
    lost = np.isinf(depths)
    np.testing.assert_array_equal(lost, truth < 1.999)
    assert 0.1 < lost.mean() < 0.9


X3 = """<simkit:depth_error><scale>-0.011858</scale><stddev>0.002</stddev><coefficient>0.0019</coefficient>
  <exponent>2.36</exponent></simkit:depth_error>
<simkit:depth_holes><probability>0.05</probability><correlation_length>5</correlation_length><border>0 21 0 0</border>
  <incidence><start>1.05</start><end>1.13</end></incidence>
  <wedge><start>0.6</start><end>0.363</end><direction>0.785</direction></wedge></simkit:depth_holes>"""


@pytest.mark.parametrize(("reported", "published"), [(0.45, 0.354), (0.63, 0.611), (1.12, 0.57), (3.6, 0.48)])
def test_the_x3_sees_as_many_pixels_of_a_wall_as_its_owners_measured(reported: float, published: float) -> None:
    """The camera is 0.109 m above a floor that never returns, before a wall (AIRclub-UdeSA/physical_rosmaster)."""
    wall = box("wall", f"{reported * 1.012 + 0.5} 0 1 0 0 0", "1 20 9") + box("floor", "0 0 -0.159 0 0 0", "30 30 0.1")
    text = world(X3, wall, far=8).replace(f"<horizontal_fov>{FOV}<", "<horizontal_fov>1.06406<")
    text = text.replace(f"<width>{WIDTH}<", "<width>320<").replace(f"<height>{HEIGHT}<", "<height>240<")
    depths, _ = seen(text, 3)
    assert np.isfinite(depths).mean() == pytest.approx(published, abs=0.05)
    assert np.median(depths[np.isfinite(depths)]) == pytest.approx(reported, abs=0.002)


def test_a_lens_with_distortion_has_the_same_angles_and_shadows() -> None:
    lens = "<distortion><k1>-0.15</k1><k2>0.03</k2></distortion>"
    floor = box("floor", "0 0 -0.3 0 0 0", "40 40 0.001")
    artefacts = holes("<incidence><start>1.2</start><end>1.2</end></incidence>")
    (depths,), truth = seen(world(artefacts, WALL + floor, camera=lens))
    is_floor, lost = truth < 1.99, np.isinf(depths)
    assert not lost[~is_floor].any()
    column = slice(WIDTH // 2 - 5, WIDTH // 2 + 5)
    down = 0.3 / truth[:, column]  # slope of the ray to the floor
    expected = is_floor[:, column] & (down / np.sqrt(1 + down**2) <= math.cos(1.2))
    assert np.count_nonzero(lost[:, column] != expected) <= 20


# ---------------------------------------------------------------------- messages and repetition

ALL = (
    "<simkit:depth_error><scale>0.02</scale><stddev>0.01</stddev><correlation_length>3</correlation_length>"
    "</simkit:depth_error>" + holes("<probability>0.3</probability><correlation_time>0.5</correlation_time>")
    + "<simkit:occlusion_shadow><baseline>0.1</baseline></simkit:occlusion_shadow><simkit:flying_pixels/>"
    "<simkit:multipath/><simkit:phase_wrap><range>7</range></simkit:phase_wrap>"
)  # fmt: skip


@pytest.mark.parametrize("quality", ["", "<simkit:quality>high</simkit:quality>"])
@pytest.mark.parametrize("kind", ["depth_camera", "rgbd_camera"])
def test_surfaces_are_known_in_software_at_every_quality(kind: str, quality: str) -> None:
    patch = box("patch", "1.9 0.5 0 0 0 0", "0.02 0.4 40")
    reasons = "<surface><name>patch::l</name></surface><brightness><start>0.2</start><end>0.1</end></brightness>"
    text = world(holes(reasons), WALL + patch, kind).replace("<background>", quality + "<background>")
    (depths,), truth = seen(text, renderer="software")
    np.testing.assert_array_equal(np.isinf(depths), truth < 1.95)


def test_colours_and_depths_of_one_camera_have_their_own_artefacts() -> None:
    with simkit.load(world(ALL + "<simkit:vignetting/>", kind="rgbd_camera")) as sim:
        image, depths = sim.subscribe("c/image"), sim.subscribe("c/depth_image")
        sim.run(0.05)
        colours = msgs.image(image.latest)
        assert colours[0, 0, 0] < colours[HEIGHT // 2, WIDTH // 2, 0] == 255
        assert 0.2 < share_lost(msgs.image(depths.latest)) < 0.6


@pytest.mark.parametrize(("name", "value"), [("nan", math.nan), ("zero", 0.0), ("inf", math.inf)])
def test_lost_pixels_have_the_value_of_the_driver_in_images_and_clouds(name: str, value: float) -> None:
    text = world(ALL + f"<simkit:lost_depth><value>{name}</value></simkit:lost_depth>", kind="rgbd_camera")
    with simkit.load(text) as sim:
        image, cloud = sim.subscribe("c/depth_image"), sim.subscribe("c/points")
        sim.run(0.05)
        depths = msgs.image(image.latest)
        points = msgs.points(cloud.latest)
        lost = ~np.isfinite(depths) if value != 0 else depths == 0
        assert 0.2 < lost.mean() < 0.6
        np.testing.assert_array_equal(depths[lost], np.float32(value))
        np.testing.assert_array_equal(np.asarray(points["x"]).reshape(HEIGHT, WIDTH), depths)
        assert np.isfinite(points["y"]).reshape(HEIGHT, WIDTH)[~lost].all()
        assert bool(cloud.latest.is_dense) == (value == 0)
        assert np.isfinite(msgs.image(sim.sensor("m::l::s").truth)).all()


def test_a_depth_camera_gives_black_points_where_there_is_no_depth() -> None:
    text = world(ALL + "<simkit:lost_depth><value>nan</value></simkit:lost_depth>")
    with simkit.load(text) as sim:
        cloud = sim.subscribe("c/points")
        sim.run(0.05)
        raw = np.frombuffer(bytes(cloud.latest.data), np.uint8).reshape(HEIGHT * WIDTH, -1)
        lost = np.isnan(sim.sensor("m::l::s").depth).ravel()
        assert not raw[lost, 16:19].any()


def test_the_bits_repeat_after_a_reset_and_a_restored_snapshot_and_depend_on_the_seed() -> None:
    with simkit.load(world(ALL), seed=4) as sim:
        sensor = sim.sensor("m::l::s")
        sim.run(0.55)
        first = sensor.depth.tobytes()
        held = sim.snapshot()
        sim.run(0.3)
        later = sensor.depth.tobytes()
        sim.restore(held)
        assert sensor.depth.tobytes() == first
        sim.run(0.3)
        assert sensor.depth.tobytes() == later
        sim.restore(pickle.loads(pickle.dumps(held)))
        assert sensor.depth.tobytes() == first
        sim.reset()
        sim.run(0.85)
        assert sensor.depth.tobytes() == later
        sim.reset(seed=5)
        sim.run(0.85)
        assert sensor.depth.tobytes() != later


def test_the_bits_are_the_same_with_and_without_a_subscriber() -> None:
    found = []
    for is_read in (True, False):
        with simkit.load(world(ALL)) as sim:
            subscription = sim.subscribe("c") if is_read else None
            sim.run(0.65)
            found.append(sim.sensor("m::l::s").depth.tobytes())
            assert subscription is None or len(subscription.messages) == 7
    assert found[0] == found[1]


def test_a_colour_image_alone_computes_no_depths(monkeypatch: pytest.MonkeyPatch) -> None:
    from simkit_realism.artefacts.depth_error import DepthError

    with simkit.load(world(ALL, kind="rgbd_camera")) as sim:
        changed = []
        original = DepthError.change
        monkeypatch.setattr(DepthError, "change", lambda *args, **how: changed.append(1) or original(*args, **how))
        image = sim.subscribe("c/image")
        sim.run(0.35)
        assert len(image.messages) == 4
        assert not changed
        assert sim.sensor("m::l::s").depth is not None
        assert changed


# ---------------------------------------------------------------------- mistakes


@pytest.mark.parametrize(
    ("artefact", "code"),
    [
        ("<simkit:depth_error><point>2 0.1</point><point>1 0.2</point></simkit:depth_error>", "SK-SENSOR-225"),
        (holes("<map><row>1 0.5</row><row>1</row></map>"), "SK-SENSOR-226"),
        (holes("<wedge><start>0.3</start><end>0.6</end></wedge>"), "SK-SENSOR-227"),
        ("<simkit:occlusion_shadow/>", "SK-PARAM-001"),
        (holes("<probability>1.5</probability>"), "SK-PARAM-002"),
        ("<simkit:lost_depth><value>none</value></simkit:lost_depth>", "SK-PARAM-002"),
    ],
)
def test_a_mistake_is_an_error_with_its_line(artefact: str, code: str) -> None:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world(artefact))
    (found,) = caught.value.diagnostics
    assert (found.code, found.line > 0) == (code, True)


def test_a_surface_that_does_not_exist_is_a_warning() -> None:
    with simkit.load(world(holes("<surface><name>flor</name></surface>"))) as sim:
        (found,) = (d for d in sim.diagnostics if d.severity == "warning")
        assert found.code == "SK-SENSOR-228"


def test_a_law_beside_measured_points_is_a_warning() -> None:
    text = "<simkit:depth_error><point>1 0.01</point><stddev>0.1</stddev></simkit:depth_error>"
    with simkit.load(world(text)) as sim:
        assert [d.code for d in sim.diagnostics if d.severity == "warning"] == ["SK-SENSOR-229"]


def test_an_unknown_option_is_a_warning() -> None:
    with simkit.load(world(holes("<probabilty>0.1</probabilty>"))) as sim:
        assert any("probabilty" in d.message for d in sim.diagnostics)
