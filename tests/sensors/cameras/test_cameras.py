"""Cameras: geometry of colour and depth, formats, clouds, noise, lens, Classic's plugin."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from sensor_worlds import box, cloud, colours, depths, noise, sensor, world

import simkit
from simkit.sensors.cameras.camera_model import CameraModel
from simkit.sensors.cameras.depth_range import DepthRange
from simkit.sensors.cameras.overview_image import render_view

SCENE = "<scene><ambient>1 1 1 1</ambient><background>0.2 0.4 0.6 1</background></scene>"
BACKGROUND = (51, 102, 153)
WALL = box("wall", "3.5 0 1 0 0 0", "1 9 9", colour="1 0 0")


def camera(
    more: str = "", *, width: int = 64, height: int = 48, hfov: float = 1.2, clip: str = "<near>0.1</near><far>50</far>"
) -> str:
    return f"""<camera><horizontal_fov>{hfov}</horizontal_fov>
      <image><width>{width}</width><height>{height}</height></image>
      <clip>{clip}</clip>{more}</camera>"""


def scene(sensors: str, others: str = "", **more: Any) -> str:
    return world(sensors, others=others, top=SCENE, **more)


def first_messages(text: str, topics: tuple[str, ...]) -> list[Any]:
    """Return the first message of each topic."""
    with simkit.load(text) as sim:
        subs = [sim.subscribe(t) for t in topics]
        sim.run(0.02)
        return [s.messages[0] for s in subs]


def rgbd(more: str = "", extra: str = "<topic>cam</topic>", **optics: Any) -> str:
    return sensor("rgbd_camera", camera(more, **optics), extra=extra)


# ---------------------------------------------------------------------- geometry


def test_left_right_up_and_down_are_where_they_should_be() -> None:
    others = (
        box("left", "3 1 1 0 0 0", "0.2 0.4 0.4", colour="1 0 0")
        + box("right", "3 -1 1 0 0 0", "0.2 0.4 0.4", colour="0 1 0")
        + box("up", "3 0 1.7 0 0 0", "0.2 0.4 0.4", colour="0 0 1")
    )
    (image,) = first_messages(scene(sensor("camera", camera(), extra="<topic>c</topic>"), others), ("/c",))
    pixels = colours(image)
    f = 64 / (2 * math.tan(0.6))
    off, rise = round(1.0 / 2.9 * f), round(0.7 / 2.9 * f)
    assert pixels[24, 32 - off].argmax() == 0
    assert pixels[24, 32 + off].argmax() == 1
    assert pixels[24 - rise, 32].argmax() == 2
    np.testing.assert_array_equal(pixels[46, 32], BACKGROUND)


def test_the_first_image_is_not_black_and_the_background_is_the_scenes() -> None:
    (image,) = first_messages(scene(sensor("camera", camera(), extra="<topic>c</topic>")), ("/c",))
    np.testing.assert_array_equal(colours(image), np.broadcast_to(BACKGROUND, (48, 64, 3)))


def test_depth_is_along_the_optical_axis_to_a_tenth_of_a_millimetre() -> None:
    (message,) = first_messages(scene(rgbd(), WALL), ("/cam/depth_image",))
    np.testing.assert_allclose(depths(message), 3.0, atol=1e-4)


@pytest.mark.parametrize("far", [4.0, 100.0])
def test_depth_of_a_floor_follows_the_pixels(far: float) -> None:
    floor = box("floor", "0 0 -0.5 0 0 0", "400 400 1")
    (message,) = first_messages(scene(rgbd(clip=f"<near>0.1</near><far>{far}</far>"), floor), ("/cam/depth_image",))
    found = depths(message)
    f = 64 / (2 * math.tan(0.6))
    rows = np.arange(25, 48)
    expected = f / (rows + 0.5 - 24)  # 1 m above the floor
    distance = np.sqrt(expected**2 + 1 + (expected * (32 - 10.5) / f) ** 2)
    expected[distance > far] = math.inf
    np.testing.assert_allclose(found[25:, 10], expected, rtol=1e-4)
    assert (found[:24] == math.inf).all()


def test_too_near_is_minus_infinity_and_too_far_plus_infinity() -> None:
    others = box("near", "0.3 0 1 0 0 0", "0.1 0.1 0.1") + box("far", "8 -1 1 0 0 0", "1 2 2")
    (message,) = first_messages(scene(rgbd(clip="<near>0.5</near><far>5</far>"), others), ("/cam/depth_image",))
    found = depths(message)
    assert (found == -math.inf).any()
    assert set(np.unique(found)) == {-math.inf, math.inf}


def test_a_depth_cameras_own_clip_bounds_depths_alone() -> None:
    more = "<depth_camera><clip><near>0.2</near><far>2</far></clip></depth_camera>"
    image, depth = first_messages(scene(rgbd(more), WALL), ("/cam/image", "/cam/depth_image"))
    assert (depths(depth) == math.inf).all()
    assert colours(image)[24, 32].argmax() == 0


def test_the_cloud_lies_on_the_wall_and_has_its_colour() -> None:
    (message, info) = first_messages(
        scene(rgbd(), box("wall", "3.5 1 1 0 0 0", "1 2 9", colour="1 0 0")), ("/cam/points", "/cam/camera_info")
    )
    found = cloud(message)
    assert found.shape == (48, 64)
    assert message.header.frame_id == "m::l::s"
    hit = np.isfinite(found["x"])
    assert not message.is_dense
    np.testing.assert_allclose(found["x"][hit], 3.0, atol=1e-4)
    assert found["y"][hit].min() == pytest.approx(0.0, abs=0.1)
    fx, cx, cy = info.k[0], info.k[2], info.k[5]
    np.testing.assert_allclose(found["y"][10, 5], 3.0 * (cx - 5.5) / fx, atol=1e-4)
    np.testing.assert_allclose(found["z"][10, 5], 3.0 * (cy - 10.5) / fx, atol=1e-4)
    blue, green, red, _ = found["rgb"][10, 5].tobytes()
    assert red > 200
    assert blue == green < 50


def test_intrinsics_of_the_file_are_drawn_and_published() -> None:
    lens = "<lens><intrinsics><fx>100</fx><fy>80</fy><cx>20</cx><cy>30</cy></intrinsics></lens>"
    dot = box("dot", "5 0 1 0 0 0", "0.02 0.1 0.1")
    info, depth = first_messages(scene(rgbd(lens), dot), ("/cam/camera_info", "/cam/depth_image"))
    assert info.k.tolist() == [100, 0, 20, 0, 80, 30, 0, 0, 1]
    rows, columns = np.nonzero(np.isfinite(depths(depth)))
    assert (columns.mean() + 0.5, rows.mean() + 0.5) == pytest.approx((20, 30), abs=0.51)


def test_a_moving_cameras_image_is_of_the_state_at_its_stamp() -> None:
    falling = sensor(
        "depth_camera",
        camera(width=16, height=16),
        extra="<topic>d</topic>",
        pose="0 0 0 0 1.5707963267948966 0",
        rate=20,
    )
    with simkit.load(scene(falling, box("floor", "0 0 -0.5 0 0 0", "9 9 1"), static=False, pose="0 0 5 0 0 0")) as sim:
        sub = sim.subscribe("/d")
        sim.run(0.1)
        assert depths(sub.latest)[8, 8] == pytest.approx(sim.link("m::l").pose.position[2], abs=1e-4)


# ---------------------------------------------------------------------- messages


@pytest.mark.parametrize(
    ("given", "encoding", "step"),
    [
        ("R8G8B8", "rgb8", 192),
        ("B8G8R8", "bgr8", 192),
        ("L8", "mono8", 64),
        ("L16", "mono16", 128),
        ("BAYER_RGGB8", "bayer_rggb8", 64),
    ],
)
def test_formats(given: str, encoding: str, step: int) -> None:
    block = camera().replace("<image>", f"<image><format>{given}</format>")
    (image,) = first_messages(scene(sensor("camera", block, extra="<topic>c</topic>"), WALL), ("/c",))
    assert (image.encoding, image.step, image.is_bigendian, len(image.data)) == (encoding, step, 0, 48 * step)
    if encoding == "bgr8":
        assert colours(image)[24, 32].argmax() == 2
    if encoding == "mono8":
        assert colours(image)[24, 32] == pytest.approx(0.299 * 255, abs=2)
    if encoding == "bayer_rggb8":
        square = colours(image)[24:26, 32:34]
        assert square[0, 0] > 200 > 50 > square[0, 1]


def test_topics_of_every_kind() -> None:
    prefix = "/world/w/model/m/link/l/sensor/"
    sensors = "".join(sensor(kind, camera(), name=kind) for kind in ("camera", "rgbd_camera", "depth_camera"))
    with simkit.load(scene(sensors)) as sim:
        found = {t.removeprefix(prefix) for t in sim.topics() if t.startswith(prefix)}
    assert found == {
        "camera/image", "camera/camera_info",
        "rgbd_camera/image", "rgbd_camera/depth_image", "rgbd_camera/points", "rgbd_camera/camera_info",
        "depth_camera/depth_image", "depth_camera/depth_image/points", "depth_camera/camera_info",
    }  # fmt: skip


def test_camera_info_alone_draws_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    with simkit.load(scene(sensor("camera", camera(), extra="<topic>a/b</topic>"))) as sim:
        sub = sim.subscribe("/a/camera_info")
        monkeypatch.setattr(type(sim.sensor("m::l::s")), "make_reading", lambda *_: pytest.fail("drawn"))
        sim.run(0.02)
        assert sub.latest.width == 64


def test_reading_later_gives_the_same_image() -> None:
    text = scene(rgbd(noise(0.02)), WALL)
    with simkit.load(text) as early, simkit.load(text) as late:
        early.subscribe("/cam/image")
        early.run(0.02)
        late.run(0.02)
        a, b = early.sensor("m::l::s").latest, late.sensor("m::l::s").latest
        np.testing.assert_array_equal(a.data, b.data)
        assert a.header.stamp == b.header.stamp


def test_noise_is_on_the_image_and_not_on_its_truth() -> None:
    with simkit.load(scene(rgbd(noise(0.02), width=320, height=240), WALL)) as sim:
        sub = sim.subscribe("/cam/depth_image")
        sim.run(0.02)
        latest, truth = (colours(m).astype(int) for m in (sim.sensor("m::l::s").latest, sim.sensor("m::l::s").truth))
        difference = (
            (latest - truth)[..., 1][truth[..., 1] > 40] if truth[..., 1].max() > 40 else (latest - truth)[..., 0]
        )
        assert 0 < np.abs(difference).max() < 255 * 0.02 * 6
        assert (depths(sub.latest) - 3.0).std() == pytest.approx(0.02, rel=0.03)


def test_a_distorted_image_follows_browns_model() -> None:
    lens = "<distortion><k1>-0.2</k1><k2>0.03</k2><p1>0.001</p1></distortion>"
    spot = box("spot", "4.05 1 1.6 0 0 0", "0.1 0.06 0.06", colour="1 1 1")
    optics = {"width": 640, "height": 480}
    (straight,) = first_messages(scene(sensor("camera", camera(**optics), extra="<topic>c</topic>"), spot), ("/c",))
    bent, info = first_messages(
        scene(sensor("camera", camera(lens, **optics), extra="<topic>cam/c</topic>"), spot),
        ("/cam/c", "/cam/camera_info"),
    )
    np.testing.assert_allclose(info.d, (-0.2, 0.03, 0.001, 0, 0))

    def middle(message: Any) -> np.ndarray:
        rows, columns = np.nonzero(colours(message)[..., 0] > 150)
        return np.array((columns.mean(), rows.mean())) + 0.5

    f, centre = info.k[0], np.array((320.0, 240.0))
    x, y = (middle(straight) - centre) / f
    r2 = x * x + y * y
    radial = 1 - 0.2 * r2 + 0.03 * r2 * r2
    expected = centre + f * np.array((x * radial + 2 * 0.0 * x * y, y * radial + 0.001 * (r2 + 2 * y * y)))
    expected[0] += f * 2 * 0.001 * x * y
    np.testing.assert_allclose(middle(bent), expected, atol=0.3)
    assert colours(bent)[[0, 0, -1, -1], [0, -1, 0, -1]].min() > 0  # no black corners


def test_a_triggered_camera_takes_one_image_per_trigger() -> None:
    with simkit.load(scene(sensor("camera", camera("<triggered>true</triggered>"), extra="<topic>c</topic>"))) as sim:
        sub = sim.subscribe("/c")
        sim.run(0.05)
        assert not sub.messages
        sim.publish("/c/trigger", {"data": True})
        sim.run(0.05)
        assert len(sub.messages) == 1


# ---------------------------------------------------------------------- Classic


def test_classic_names_topics_below_the_cameras_name() -> None:
    plugin = '<plugin name="p" filename="libgazebo_ros_camera.so"><hack_baseline>0.07</hack_baseline></plugin>'
    with simkit.load(scene(sensor("camera", camera() + plugin, name="eye"))) as sim:
        image, info = sim.subscribe("/eye/image_raw"), sim.subscribe("/eye/camera_info")
        sim.run(0.02)
        assert image.latest.header.frame_id == "l"
        assert info.latest.p[3] == pytest.approx(-0.07 * info.latest.k[0])
        assert info.latest.header.stamp == image.latest.header.stamp


def test_classics_depth_camera_has_colour_depth_and_points() -> None:
    plugin = """<plugin name="p" filename="libgazebo_ros_camera.so"><ros><namespace>/r</namespace></ros>
      <camera_name>front</camera_name><min_depth>0.2</min_depth><max_depth>2</max_depth></plugin>"""
    with simkit.load(scene(sensor("depth", camera() + plugin), WALL)) as sim:
        depth = sim.subscribe("/r/front/depth/image_raw")
        names = {t.removeprefix("/r/front/") for t in sim.topics() if t.startswith("/r/front/")}
        assert names == {"image_raw", "camera_info", "depth/image_raw", "depth/camera_info", "points"}
        sim.run(0.02)
        assert (depths(depth.latest) == math.inf).all()


# ---------------------------------------------------------------------- life


def test_images_show_spawned_removed_and_restored_models() -> None:
    with simkit.load(scene(sensor("depth_camera", camera(width=8, height=8), extra="<topic>d</topic>"), WALL)) as sim:
        sub = sim.subscribe("/d")

        def middle() -> float:
            sim.run(0.02)
            return float(depths(sub.latest)[4, 4])

        assert middle() == pytest.approx(3.0, abs=1e-4)
        before = sim.snapshot()
        sim.spawn(f'<sdf version="1.9">{box("new", "2.5 0 1 0 0 0", "1 1 1")}</sdf>')
        assert middle() == pytest.approx(2.0, abs=1e-4)
        sim.model("new").set_pose(simkit.Pose((1.5, 0, 1)))
        assert middle() == pytest.approx(1.0, abs=1e-4)
        sim.restore(before)
        assert middle() == pytest.approx(3.0, abs=1e-4)


def test_two_simulations_and_two_sizes_side_by_side() -> None:
    both = sensor("camera", camera(), extra="<topic>a</topic>", name="a") + sensor(
        "camera", camera(width=200, height=150), extra="<topic>b</topic>", name="b"
    )
    with simkit.load(scene(both, WALL)) as one, simkit.load(scene(both)) as other:
        for sim in (one, other, one):
            sim.run(0.02)
            expected = 0 if sim is one else 2
            for name in ("a", "b"):
                assert colours(sim.sensor(f"m::l::{name}").latest)[20, 30].argmax() == expected


def test_a_view_from_outside_shows_the_scene() -> None:
    with simkit.load(scene("", WALL)) as sim:
        pixels = render_view(sim, 160, 120)
        assert pixels.shape == (120, 160, 3)
        assert (pixels[60, 80] != BACKGROUND).any()
        along = render_view(sim, 160, 120, eye=np.array((0.0, 0.0, 1.0)), target=np.array((3.0, 0.0, 1.0)))
        assert along[60, 80].argmax() == 0


def test_raw_depths_become_metres() -> None:
    model = CameraModel(2, 2, 1e6, 1e6, 1.0, 1.0, 2e-6, 0.005, 100.0)
    near, far = 0.01, 200.0
    z = np.array(((0.01, 1.0), (99.0, far)))
    raw = (near * (far - z) / (z * (far - near))).astype(np.float32)
    view = replace(model.view(), near=near, far=far)
    found = DepthRange(model, model.near, model.far).metres(raw, view, np.empty_like(raw))
    np.testing.assert_allclose(found[0], z[0], rtol=1e-5)
    assert found[1, 0] == pytest.approx(99.0, rel=1e-3)
    assert found[1, 1] == math.inf


def test_bad_optics_are_reported() -> None:
    bad = camera(width=5000, clip="<near>2</near><far>1</far>", hfov=4.0)
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(scene(sensor("camera", bad)))
    text = str(caught.value)
    assert "5000x48" in text
    assert "4096" in text
    assert len([d for d in caught.value.diagnostics if d.code == "SK-PARAM-002"]) == 3
