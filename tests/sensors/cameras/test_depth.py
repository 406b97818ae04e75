"""Depth images: exactness, Gazebo's rule for the range, and agreement with K, colours, clouds and frames."""

from __future__ import annotations

import math
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt
import pytest
from depth_worlds import (
    CLASSIC,
    INTRINSICS,
    LENS,
    OPTICAL,
    TILT,
    WALL,
    camera,
    depth_of,
    first_messages,
    loaded,
    looks_at,
    points_of,
    scene,
    seen_at,
)
from sensor_worlds import box, cloud, colours, depths, noise, world

import simkit
from simkit.sensors.cameras.depth_range import clip_planes

# ---------------------------------------------------------------------- exactness


@pytest.mark.parametrize(
    ("near", "far", "distance"),
    [(0.1, 100, 3), (0.1, 100, 50), (0.01, 1000, 50), (1e-5, 1000, 90), (0.3, 3.3, 3), (0.1, 1e30, 500)],
)
def test_depth_is_exact_near_and_far_away_whatever_the_clip_planes(near: float, far: float, distance: float) -> None:
    clip = f"<near>{near}</near><far>{far}</far>"
    found = depth_of(scene(camera(clip=clip, width=8, height=6), box("w", f"{distance + 0.5} 0 1 0 0 0", "1 4e3 4e3")))
    seen = found[np.isfinite(found)]
    assert len(seen) >= 4
    np.testing.assert_allclose(seen, distance, rtol=4e-7)


def test_drawn_clip_planes_are_exact_and_clip_nothing_visible() -> None:
    for near, far in ((0.1, 100.0), (1e-6, 1e30), (0.3, 0.31), (0.05, 8.0), (5.0, 4321.1)):
        drawn_near, drawn_far = clip_planes(near, far)
        ratio = drawn_far / drawn_near
        assert near / 20 <= drawn_near <= near / 10
        assert ratio > 2**22 or far < drawn_far < 1.1 * far
        for wanted in (drawn_near, drawn_far):
            assert float(np.float32(wanted)) == wanted
        if ratio < 2**23:
            for total in (drawn_far + drawn_near, drawn_far - drawn_near):
                assert float(np.float32(total)) == total


NORMALS = {
    f"0 {TILT} 0": np.array((-math.cos(TILT), 0.0, math.sin(TILT))),
    f"0 0 {TILT}": np.array((-math.cos(TILT), -math.sin(TILT), 0.0)),
}


def tilted(turn: str) -> str:
    """Return a plate whose face contains the point 3 m in front of the camera."""
    x, y, z = np.array((3.0, 0.0, 1.0)) - 0.5 * NORMALS[turn]
    return box("plate", f"{x} {y} {z} {turn}", "1 30 30")


@pytest.mark.parametrize("lens", ["", LENS, INTRINSICS.format(20)], ids=["plain", "bent", "skewed"])
@pytest.mark.parametrize("turn", list(NORMALS), ids=["down", "aside"])
@pytest.mark.parametrize("quality", ["fast", "gazebo"])
def test_a_tilted_plane_reprojects_onto_a_plane_by_k_and_d(lens: str, turn: str, quality: str) -> None:
    """The error at 3 m is below 1 mm, and below 0.01 mm without distortion; multisampling does not affect depths."""
    look = f"<scene><quality>{quality}</quality></scene>"
    depth, info = first_messages(
        world(camera(lens, width=160, height=120), others=tilted(turn), top=look), "/c/depth_image", "/c/camera_info"
    )
    z = depths(depth)
    rows, columns = np.nonzero(np.isfinite(z))
    assert len(rows) > 0.9 * z.size
    straight = looks_at(np.stack((columns, rows), axis=-1) + 0.5, info)
    ahead = z[rows, columns].astype(float)
    points = np.stack((ahead, -straight[:, 0] * ahead, -straight[:, 1] * ahead), axis=-1)
    off = np.abs((points - (3, 0, 0)) @ NORMALS[turn])
    assert off.max() < (1e-3 if lens else 1e-5)


def test_a_surface_at_a_tenth_of_the_near_plane_is_too_near_and_a_nearer_housing_is_invisible() -> None:
    found = depth_of(scene(camera(), box("lid", "0.51 0 1 0 0 0", "1 9 9") + WALL))
    assert (found == -math.inf).all()
    found = depth_of(scene(camera(), box("housing", "0.503 0 1 0 0 0", "1 9 9") + WALL))
    np.testing.assert_allclose(found, 3.0, atol=1e-4)


# ---------------------------------------------------------------------- range


def test_far_is_a_distance_and_near_a_depth() -> None:
    """In gz-rendering, the far plane limits the distance from the camera, and the near plane limits the depth."""
    found = depth_of(scene(camera(clip="<near>0.1</near><far>3.2</far>"), WALL))
    beyond = found == math.inf
    assert beyond.any()
    f = 64 / (2 * math.tan(0.6))
    rows, columns = np.nonzero(beyond)
    distance = 3 * np.sqrt(1 + ((columns + 0.5 - 32) / f) ** 2 + ((rows + 0.5 - 24) / f) ** 2)
    assert distance.min() > 3.2
    assert np.count_nonzero(beyond) == np.count_nonzero(
        3 * np.hypot(np.hypot(1, (np.arange(64) + 0.5 - 32) / f), ((np.arange(48) + 0.5 - 24) / f)[:, None]) > 3.2
    )
    near = depth_of(scene(camera(clip="<near>2.99</near><far>9</far>"), WALL))
    assert np.isfinite(near).all()
    assert (depth_of(scene(camera(clip="<near>3.01</near><far>9</far>"), WALL)) == -math.inf).all()


@pytest.mark.parametrize(
    ("own", "expected"),
    [("<far>2.9</far>", math.inf), ("<near>3.1</near>", -math.inf), ("<near>0.2</near><far>3.1</far>", 3.0)],
)
def test_an_rgbd_cameras_own_clip_bounds_depths_along_the_axis(own: str, expected: float) -> None:
    """If `<depth_camera><clip>` sets only one end of the range, the other end is that of the camera's `<clip>`."""
    more = f"<depth_camera><clip>{own}</clip></depth_camera>"
    image, depth, points = first_messages(scene(camera(more), WALL), "/c/image", "/c/depth_image", "/c/points")
    np.testing.assert_allclose(depths(depth), expected, rtol=1e-6)
    assert colours(image)[..., 0].min() > 100
    np.testing.assert_allclose(cloud(points)["x"], expected, rtol=1e-6)


def test_a_depth_cameras_own_clip_counts_here_and_not_with_gazebos_quirks() -> None:
    more = "<depth_camera><clip><far>2</far></clip></depth_camera>"
    text = scene(camera(more, kind="depth_camera"), WALL)
    sim, (depth,) = loaded(text, "/c")
    assert (depths(depth) == math.inf).all()
    assert "SK-SENSOR-110" in {d.code for d in sim.diagnostics}
    (depth,) = first_messages(text.replace("<scene>", "<gazebo_quirks>true</gazebo_quirks><scene>"), "/c")
    np.testing.assert_allclose(depths(depth), 3.0, rtol=1e-6)


def test_a_range_that_ends_before_it_begins_and_an_unknown_output_are_reported() -> None:
    bad = "<depth_camera><output>normals</output><clip><near>3</near><far>2</far></clip></depth_camera>"
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(scene(camera(bad + "<disparity_noise><stddev>-1</stddev></disparity_noise>")))
    codes = [d.code for d in caught.value.diagnostics]
    assert codes.count("SK-PARAM-002") == 2
    assert {"SK-SENSOR-111", "SK-PARAM-001"} <= set(codes)  # without a baseline


# ---------------------------------------------------------------------- one geometry


def plates() -> tuple[str, npt.NDArray[Any]]:
    """Return four dark and bright plates that meet in one point of a tilted plane, and that point."""
    pivot, size = simkit.Pose.from_rpy(2.5, 0.25, 1.2, 0.3, 0.2, 0.5), 0.6
    parts = ""
    for number, (y, z) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        pose = pivot @ simkit.Pose((0.05, y * size / 2, z * size / 2))
        numbers = " ".join(str(v) for v in (*pose.position, *pose.rpy))
        colour = ("0.05 0.05 0.05", "1 1 1")[number % 2]
        parts += box(f"p{number}", numbers, f"0.1 {size} {size}", colour=colour)
    return parts, np.asarray(pivot.position) - (0, 0, 1)


@pytest.mark.parametrize(
    ("lens", "quality", "blur"),  # without smooth edges a corner is where its nearest pixels are
    [("", "fast", 0.4), ("", "gazebo", 0.1), (LENS, "fast", 0.4), (INTRINSICS.format(20), "fast", 0.4)],
    ids=["plain", "smooth", "bent", "skewed"],
)
def test_a_corner_in_the_colours_is_at_its_own_point_of_the_cloud(lens: str, quality: str, blur: float) -> None:
    others, corner = plates()
    look = f"<scene><ambient>1 1 1 1</ambient><quality>{quality}</quality></scene>"
    eye = camera(lens + OPTICAL, width=160, height=120)
    image, points, info = first_messages(world(eye, others=others, top=look), "/c/image", "/c/points", "/c/camera_info")
    optical = np.array((-corner[1], -corner[2], corner[0]))
    expected = seen_at(optical[None], info)[0]
    grey = cv2.cvtColor(colours(image), cv2.COLOR_RGB2GRAY)
    start = (expected + np.array((1.0, -1.7))).astype(np.float32)
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 50, 1e-3)
    found = cv2.cornerSubPix(grey, start.reshape(1, 1, 2).copy(), (5, 5), (-1, -1), stop).reshape(2) + 0.5
    np.testing.assert_allclose(found, expected, atol=blur)  # px
    # interpolate between the cloud's points around the corner
    own = cv2.remap(points_of(points), *(found - 0.5).astype(np.float32)[:, None, None], cv2.INTER_LINEAR)[0, 0]
    np.testing.assert_allclose(seen_at(own[None], info)[0], found, atol=0.05)
    np.testing.assert_allclose(own, optical, atol=blur * 3 / info.k[0])


# ---------------------------------------------------------------------- noise


def test_noise_comes_before_the_range_and_leaves_infinities() -> None:
    others = box("half", "3.5 2 1 0 0 0", "1 4 19")
    clip = "<near>2.98</near><far>100</far>"
    with simkit.load(scene(camera(noise(0.02), clip=clip, width=160, height=120), others)) as sim:
        sim.run(0.02)
        eye = sim.sensor("m::l::s")
        true, found = eye.true_depth, eye.depth
    assert (found[true == math.inf] == math.inf).all()
    hit = np.isfinite(true)
    np.testing.assert_allclose(true[hit], 3.0, rtol=1e-6)
    assert np.nanmin(found[np.isfinite(found)]) >= 2.98
    assert np.mean(found[hit] == -math.inf) == pytest.approx(0.1587, abs=0.02)  # one deviation below


def test_with_gazebos_quirks_noise_moves_points_equally_along_all_axes() -> None:
    for quirks in ("true", "false"):
        text = scene(camera(noise(0.02)), WALL, top=f"<gazebo_quirks>{quirks}</gazebo_quirks>")
        with simkit.load(text) as sim:
            sim.run(0.02)
            eye = sim.sensor("m::l::s")
            off = eye.points - eye.true_depth[..., None] * (points_along(eye))
            shift = off[..., 0]
            assert shift.std() == pytest.approx(0.02, rel=0.1)
            along = shift[..., None] * (np.ones(3) if quirks == "true" else points_along(eye))
            np.testing.assert_allclose(off, along, atol=2e-6)


def points_along(eye: Any) -> npt.NDArray[Any]:
    left, up = eye.options.model.rays()
    return np.stack(np.broadcast_arrays(np.float32(1), left, up[:, None]), axis=-1)


def disparity(more: str) -> str:
    return f"<disparity_noise><baseline>0.05</baseline>{more}</disparity_noise>"


def test_noise_of_disparities_grows_with_the_square_of_the_depth() -> None:
    f = 160 / (2 * math.tan(0.6))
    for distance in (1.5, 3.0):
        wall = box("w", f"{distance + 0.5} 0 1 0 0 0", "1 19 19")
        with simkit.load(scene(camera(disparity("<stddev>0.05</stddev>"), width=160, height=120), wall)) as sim:
            sim.run(0.02)
            eye = sim.sensor("m::l::s")
            np.testing.assert_allclose(eye.true_depth, distance, rtol=1e-6)
            inverse = f * 0.05 / eye.depth.astype(float)  # px
            assert inverse.std() == pytest.approx(0.05, rel=0.02)
            assert inverse.mean() == pytest.approx(f * 0.05 / distance, abs=0.002)
            assert eye.depth.std() == pytest.approx(distance**2 / (f * 0.05) * 0.05, rel=0.1)
            neighbours = np.corrcoef(eye.depth[:, 1:].ravel(), eye.depth[:, :-1].ravel())[0, 1]
            assert abs(neighbours) < 0.03


def test_disparities_come_in_steps_and_a_focal_length_of_their_own() -> None:
    more = disparity("<step>0.125</step><focal_length>400</focal_length>")
    slope = box("slope", f"4 0 1 0 {math.radians(60)} 0", "0.1 30 30")
    with simkit.load(scene(camera(more, width=160, height=120), slope)) as sim:
        sim.run(0.02)
        eye = sim.sensor("m::l::s")
        found, true = (d[np.isfinite(d)].astype(float) for d in (eye.depth, eye.true_depth))
    steps = 400 * 0.05 / found / 0.125
    np.testing.assert_allclose(steps, np.rint(steps), atol=1e-3)
    assert len(np.unique(np.rint(steps))) > 5
    np.testing.assert_allclose(steps, 400 * 0.05 / true / 0.125, atol=0.501)


def test_a_disparity_of_zero_is_infinitely_far() -> None:
    with simkit.load(scene(camera(disparity("<stddev>1</stddev>"), clip="<near>0.1</near><far>30</far>"), WALL)) as sim:
        sim.run(0.02)
        found = sim.sensor("m::l::s").depth
    assert 0.05 < np.mean(found == math.inf) < 0.5
    assert np.isfinite(found).any()


def test_a_preset_has_its_cameras_geometry_and_noise() -> None:
    eye = "<preset>D435</preset><update_rate>100</update_rate><topic>c</topic>"
    small = "<camera><image><width>106</width><height>60</height></image></camera>"
    with simkit.load(scene(f'<sensor name="s" type="rgbd_camera">{eye}{small}</sensor>', WALL)) as sim:
        info = sim.subscribe("/c/camera_info")
        sim.run(0.02)
        k = info.latest.k
        assert k[0] == pytest.approx(53 / math.tan(math.radians(87 / 2)), rel=1e-4)
        found = sim.sensor("m::l::s").depth
        # 0.08 px of that many pixels, by 50 mm
        seen = found[found > 0]  # the right camera does not see the left border, and the driver writes 0 there
        assert seen.std() == pytest.approx(9 / (k[0] * 0.05) * 0.08, rel=0.15)
    with simkit.load(scene(f'<sensor name="s" type="depth_camera">{eye}</sensor>')) as sim:
        model = sim.sensor("m::l::s").options.model
        assert (model.width, model.height, model.near, model.far) == (848, 480, 0.195, 10)


# ---------------------------------------------------------------------- what is drawn


def test_a_depth_camera_draws_colours_only_for_a_reader() -> None:
    for plugin, count in (("", 1), (CLASSIC.format(""), 1)):
        with simkit.load(scene(camera(kind="depth", plugin=plugin), WALL)) as sim:
            sim.run(0.02)
            shots = sim.sensor("m::l::s").shots()
            assert len(shots) == count
            assert shots[0].sharp == (not plugin)
            sensor_ = sim.sensor("m::l::s")
            np.testing.assert_allclose(sensor_.depth, 3.0, rtol=1e-6)


def test_transparent_objects_have_no_depth() -> None:
    pane = box("pane", "1.5 0 1 0 0 0", "0.1 9 9").replace("</material>", "</material><transparency>0.5</transparency>")
    for kind, topic in (("rgbd_camera", "/c/depth_image"), ("depth_camera", "/c")):
        (depth,) = first_messages(scene(camera(kind=kind), WALL + pane), topic)
        np.testing.assert_allclose(depths(depth), 3.0, rtol=1e-6)
