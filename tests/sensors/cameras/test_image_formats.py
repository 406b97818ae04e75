"""Content and time of a camera's messages: formats, triggers, saved images, topics, frames."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from sensor_worlds import box, sensor, world

import simkit
from simkit.sensors.cameras import image_messages
from simkit.sensors.cameras.saved_images import SAVE_PATH_VARIABLE, encode_png

SCENE = "<scene><ambient>1 1 1 1</ambient><background>0.2 0.4 0.6 1</background></scene>"
RED = box("red", "3.5 1.4 1 0 0 0", "1 2 9", colour="1 0 0")
GREEN = box("green", "3.5 -1.4 1 0 0 0", "1 2 9", colour="0 0.6 0")
WIDTH, HEIGHT = 64, 48


def camera(more: str = "", fmt: str = "", attributes: str = "") -> str:
    kind = f"<format>{fmt}</format>" if fmt else ""
    return (
        f"<camera{attributes}><horizontal_fov>1.2</horizontal_fov><image><width>{WIDTH}</width>"
        f"<height>{HEIGHT}</height>{kind}</image>{more}</camera>"
    )


def scene(sensors: str, **more: Any) -> str:
    return world(sensors, others=RED + GREEN, top=SCENE, **more)


def camera_world(block: str, kind: str = "camera", **more: Any) -> str:
    return scene(sensor(kind, block, extra="<topic>cam/image</topic>", **more))


def picture(fmt: str, kind: str = "camera") -> Any:
    with simkit.load(camera_world(camera(fmt=fmt), kind)) as sim:
        sim.run(0.02)
        return sim.sensor("m::l::s").latest


@pytest.fixture(scope="module")
def colours() -> np.ndarray:
    """Return the image with 8 bits of red, green and blue, shape (48, 64, 3)."""
    found = image_messages.pixels_of(picture("R8G8B8"))
    assert found.shape == (HEIGHT, WIDTH, 3)
    assert found[24, 16].argmax() == 0
    assert found[24, 48].argmax() == 1
    np.testing.assert_array_equal(found[24, 32], (51, 102, 153))
    return found


# ---------------------------------------------------------------------- formats


@pytest.mark.parametrize(
    ("names", "encoding", "step"),
    [
        (("R8G8B8", "RGB_INT8"), "rgb8", 3),
        (("B8G8R8", "BGR_INT8"), "bgr8", 3),
        (("L8", "L_INT8"), "mono8", 1),
        (("L16", "L_INT16", "L_UINT16"), "mono16", 2),
        (("RGBA_INT8",), "rgba8", 4),
        (("BGRA_INT8",), "bgra8", 4),
        (("R16G16B16", "RGB_INT16"), "rgb16", 6),
        (("BGR_INT16",), "bgr16", 6),
        (("R_FLOAT32",), "32FC1", 4),
        (("RGB_FLOAT32",), "32FC3", 12),
        (("BAYER_RGGB8",), "bayer_rggb8", 1),
        (("BAYER_BGGR8",), "bayer_bggr8", 1),
        (("BAYER_GBRG8",), "bayer_gbrg8", 1),
        (("BAYER_GRBG8",), "bayer_grbg8", 1),
    ],
)
def test_a_format_has_ross_encoding_and_step(names: tuple[str, ...], encoding: str, step: int) -> None:
    for name in names:
        message = picture(name)
        found = message.encoding, message.step, message.is_bigendian, message.width, message.height
        assert found == (encoding, step * WIDTH, 0, WIDTH, HEIGHT)
        assert len(message.data) == message.step * HEIGHT


def pixels(fmt: str) -> np.ndarray:
    return image_messages.pixels_of(picture(fmt))


def test_every_format_holds_the_same_image(colours: np.ndarray) -> None:
    bgr, wide = colours[..., ::-1], colours.astype(np.uint16) * 257
    np.testing.assert_array_equal(pixels("B8G8R8"), bgr)
    np.testing.assert_array_equal(pixels("RGBA_INT8")[..., :3], colours)
    assert (pixels("RGBA_INT8")[..., 3] == 255).all()
    np.testing.assert_array_equal(pixels("BGRA_INT8")[..., :3], bgr)
    np.testing.assert_array_equal(pixels("RGB_INT16"), wide)
    np.testing.assert_array_equal(pixels("BGR_INT16"), wide[..., ::-1])
    np.testing.assert_allclose(pixels("RGB_FLOAT32"), colours / 255, atol=1e-6)
    np.testing.assert_allclose(pixels("R_FLOAT32"), colours[..., 0] / 255, atol=1e-6)


def test_brightness_is_rec_601s_and_white_is_the_whole_range(colours: np.ndarray) -> None:
    expected = colours @ (0.299, 0.587, 0.114)
    np.testing.assert_allclose(pixels("L8"), expected, atol=1)
    np.testing.assert_array_equal(pixels("L16"), pixels("L8").astype(np.uint16) * 257)
    white = np.full((2, 2), 255, np.uint8)
    assert image_messages.pixels_of(image_messages.colour_message(None, white, "mono16")).max() == 65535


@pytest.mark.parametrize(
    ("fmt", "code"),  # OpenCV names a pattern by the second row's second and third pixel; cv_bridge has this table
    [
        ("BAYER_RGGB8", cv2.COLOR_BayerBG2RGB),
        ("BAYER_BGGR8", cv2.COLOR_BayerRG2RGB),
        ("BAYER_GBRG8", cv2.COLOR_BayerGR2RGB),
        ("BAYER_GRBG8", cv2.COLOR_BayerGB2RGB),
    ],
)
def test_a_bayer_image_demosaics_to_the_colours(fmt: str, code: int, colours: np.ndarray) -> None:
    found = cv2.cvtColor(pixels(fmt), code).astype(int)
    flat = np.ptp(cv2.blur(colours, (1, 1)).astype(int), axis=2) >= 0
    for shift in ((0, 3), (3, 0), (0, -3), (-3, 0)):  # away from edges
        flat &= (np.roll(colours, shift, (0, 1)) == colours).all(axis=2)
    flat[:3] = flat[-3:] = flat[:, :3] = flat[:, -3:] = False
    assert np.count_nonzero(flat) > 1000
    assert {tuple(c) for c in colours[flat].tolist()} >= {tuple(colours[24, x].tolist()) for x in (16, 32, 48)}
    np.testing.assert_allclose(found[flat], colours[flat], atol=1)


def test_noise_is_in_the_image_of_every_format() -> None:
    for fmt in ("L16", "BAYER_GRBG8", "R_FLOAT32"):
        text = camera_world(camera('<noise type="gaussian"><stddev>0.1</stddev></noise>', fmt))
        with simkit.load(text) as sim:
            sim.run(0.02)
            eye = sim.sensor("m::l::s")
            noisy, true = (image_messages.pixels_of(m).astype(float) for m in (eye.latest, eye.truth))
            assert np.count_nonzero(noisy != true) > 0.5 * true.size


def test_a_depth_cameras_float_format_is_of_its_depths() -> None:
    for kind in ("depth_camera", "rgbd_camera"):
        with simkit.load(camera_world(camera(fmt="R_FLOAT32"), kind)) as sim:
            assert not [d for d in sim.diagnostics if d.code.startswith(("SK-SENSOR", "SK-PARAM"))]
            assert sim.sensor("m::l::s").options.encoding == "rgb8"


@pytest.mark.parametrize("fmt", image_messages.WITHOUT_ENCODING)
def test_a_format_without_a_ros_encoding_is_reported_and_drawn_in_colours(fmt: str) -> None:
    with simkit.load(camera_world(camera(fmt=fmt))) as sim:
        (found,) = [d for d in sim.diagnostics if d.code == "SK-SENSOR-120"]
        assert fmt in found.message
        assert found.line
        sim.run(0.02)
        assert sim.sensor("m::l::s").latest.encoding == "rgb8"


def test_an_unknown_format_is_an_error_with_the_closest_and_all_there_are() -> None:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(camera_world(camera(fmt="R8G8B9")))
    (found,) = caught.value.diagnostics
    assert found.code == "SK-PARAM-002"
    assert "R8G8B9" in str(found)
    assert "BAYER_RGGB8" in str(found)
    assert "did you mean" in str(found).lower()


# ---------------------------------------------------------------------- triggers


def test_a_trigger_gives_one_image_at_the_next_due_time() -> None:
    with simkit.load(camera_world(camera("<triggered>true</triggered>"), rate=20)) as sim:
        assert sim.topics()["/cam/image/trigger"] == "std_msgs/msg/Bool"
        image, info = sim.subscribe("/cam/image"), sim.subscribe("/cam/camera_info")
        sim.run(0.2)
        assert not image.messages
        assert not info.messages
        sim.run(0.01)
        for _ in range(3):  # before the next due time, several messages request one image, as in Gazebo
            sim.publish("/cam/image/trigger", {"data": True})
        sim.run(0.3)
        assert [m.header.stamp.nanosec for m in image.messages] == [250_000_000]
        assert [m.header.stamp.nanosec for m in info.messages] == [250_000_000]


def test_the_trigger_topic_of_the_file() -> None:
    block = camera("<triggered>1</triggered><trigger_topic>go now</trigger_topic>")
    with simkit.load(camera_world(block)) as sim:
        image = sim.subscribe("/cam/image")
        sim.publish("/go_now", {"data": False})  # what it says does not matter
        sim.run(0.05)
        assert len(image.messages) == 1


def test_a_waiting_trigger_is_remembered_and_forgotten() -> None:
    with simkit.load(camera_world(camera("<triggered>true</triggered>"), rate=10)) as sim:
        image = sim.subscribe("/cam/image")
        sim.run(0.01)
        sim.publish("/cam/image/trigger", {"data": True})
        sim.run(0.05)
        before = sim.snapshot()
        sim.run(0.3)
        assert len(image.messages) == 1
        sim.restore(before)
        sim.run(0.3)
        assert len(image.messages) == 2
        sim.restore(before)
        sim.reset()
        sim.run(0.3)
        assert len(image.messages) == 2


def test_a_triggered_camera_follows_a_change_of_its_rate() -> None:
    with simkit.load(camera_world(camera("<triggered>true</triggered>"), rate=1)) as sim:
        image = sim.subscribe("/cam/image")
        sim.run(0.01)
        sim.publish("/cam/image/trigger", {"data": True})
        sim.run(0.1)
        assert not image.messages
        sim.sensor("m::l::s").set_rate(100)
        sim.run(0.1)
        assert len(image.messages) == 1


# ---------------------------------------------------------------------- saved pictures


@pytest.fixture
def save_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(SAVE_PATH_VARIABLE, raising=False)
    return tmp_path


def saving(path: str, fmt: str = "", kind: str = "camera", **more: Any) -> str:
    return camera_world(camera(f'<save enabled="true"><path>{path}</path></save>', fmt), kind, **more)


def test_each_image_is_saved_with_and_without_subscribers(save_folder: Path) -> None:
    with simkit.load(saving("seen/here", rate=50)) as sim:
        assert not (save_folder / "seen").exists()
        sim.run(0.081)  # at 1, 20, 40, 60 and 80 ms
        names = sorted(p.name for p in (save_folder / "seen/here").iterdir())
        assert names == [f"m::l::s_{i}.png" for i in range(5)]
        latest = image_messages.pixels_of(sim.sensor("m::l::s").latest)
        np.testing.assert_array_equal(read(save_folder / "seen/here/m::l::s_4.png")[..., ::-1], latest)
        sim.reset()
        sim.run(0.02)
        assert (save_folder / "seen/here/m::l::s_5.png").exists()


def read(path: Path) -> np.ndarray:
    found = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    assert found is not None
    return found


@pytest.mark.parametrize(("fmt", "dtype"), [("L16", np.uint16), ("BAYER_RGGB8", np.uint8), ("BGR_INT8", np.uint8)])
def test_a_saved_image_has_the_content_of_the_message(fmt: str, dtype: type, save_folder: Path) -> None:
    with simkit.load(saving("seen", fmt)) as sim:
        sim.run(0.01)
        found = read(save_folder / "seen/m::l::s_0.png")
        assert found.dtype == dtype
        np.testing.assert_array_equal(found, image_messages.pixels_of(sim.sensor("m::l::s").latest))


def test_depths_are_saved_as_shades(save_folder: Path) -> None:
    with simkit.load(saving("seen", kind="depth_camera")) as sim:
        sim.run(0.01)
    found = read(save_folder / "seen/m::l::s_0.png")
    assert found[24, 16] == round(255 * (1 - 3.0 / 100))
    assert found[24, 32] == 0  # nothing is there


@pytest.mark.parametrize("path", ["/somewhere/else", "../beside", "in/../../beside", "link/out", "a/../../../x"])
def test_a_world_writes_nowhere_else(path: str, save_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (save_folder / "work").mkdir()
    (save_folder / "elsewhere").mkdir()
    (save_folder / "work/link").symlink_to(save_folder / "elsewhere")
    monkeypatch.chdir(save_folder / "work")
    with simkit.load(saving(path)) as sim:
        (found,) = [d for d in sim.diagnostics if d.code == "SK-SENSOR-009"]
        assert SAVE_PATH_VARIABLE in str(found)
        sim.run(0.02)
    assert sorted(p.name for p in save_folder.rglob("*")) == ["elsewhere", "link", "work"]


def test_the_user_may_allow_another_folder(save_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (save_folder / "work").mkdir()
    (save_folder / "kept").mkdir()
    monkeypatch.chdir(save_folder / "work")
    monkeypatch.setenv(SAVE_PATH_VARIABLE, str(save_folder / "kept"))
    with simkit.load(saving(str(save_folder / "kept/today"))) as sim:
        sim.step()
    assert [p.name for p in (save_folder / "kept/today").iterdir()] == ["m::l::s_0.png"]


def test_a_write_error_is_reported_once_and_the_run_continues(save_folder: Path) -> None:
    (save_folder / "seen").write_text("a file where the folder should be")
    with simkit.load(saving("seen")) as sim:
        sim.run(0.1)
        assert len([d for d in sim.diagnostics if d.code == "SK-SENSOR-121"]) == 1
        assert sim.time == pytest.approx(0.1)
    assert [p.name for p in save_folder.iterdir()] == ["seen"]


def test_saving_needs_a_path_and_a_valid_boolean(save_folder: Path) -> None:
    for block in ('<save enabled="true"/>', '<save enabled="perhaps"><path>x</path></save>'):
        with pytest.raises(simkit.LoadError) as caught:
            simkit.load(camera_world(camera(block)))
        assert {d.code for d in caught.value.diagnostics} <= {"SK-PARAM-001", "SK-PARAM-002"}
    with simkit.load(camera_world(camera('<save enabled="false"><path>/x</path></save>'))) as sim:
        assert not [d for d in sim.diagnostics if d.code.startswith("SK-SENSOR")]
        sim.run(0.02)
    assert list(save_folder.iterdir()) == []


def test_every_encoding_becomes_a_png() -> None:
    colours = np.arange(4 * 6 * 3, dtype=np.uint8).reshape(4, 6, 3)
    for encoding in set(image_messages.ENCODINGS.values()):
        source = image_messages.grey(colours) if image_messages.is_grey(encoding) else colours
        data = encode_png(image_messages.colour_message(None, source, encoding))
        assert cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED).shape[:2] == (4, 6)


# ---------------------------------------------------------------------- topics and frames


def test_the_info_topic_is_the_images_sibling_or_the_files_topic() -> None:
    with simkit.load(scene(sensor("camera", camera(), extra="<topic>a/b/c</topic>"))) as sim:
        assert "/a/b/camera_info" in sim.topics()
    block = camera("<camera_info_topic>told/here</camera_info_topic>")
    with simkit.load(scene(sensor("camera", block, extra="<topic>/a b/c</topic>"))) as sim:
        assert {"/a_b/c", "/told/here"} <= set(sim.topics())
        assert "/a_b/camera_info" not in sim.topics()


def test_an_optical_frame_is_named_by_image_and_info() -> None:
    for more, expected in (("", "m::l::s"), ("<optical_frame_id>eye_optical</optical_frame_id>", "eye_optical")):
        with simkit.load(camera_world(camera(more))) as sim:
            image, info = sim.subscribe("/cam/image"), sim.subscribe("/cam/camera_info")
            sim.run(0.02)
            assert image.latest.header.frame_id == info.latest.header.frame_id == expected


def test_a_camera_block_has_a_name_and_a_pose() -> None:
    """`<pose>` of the camera is relative to the sensor, as in Gazebo Classic."""
    turned = camera("<pose>0 0 0 0 0 0.4</pose>", attributes=' name="eye"')
    with simkit.load(camera_world(turned)) as sim, simkit.load(camera_world(camera(), pose="0 0 0 0 0 0.4")) as same:
        assert not [d for d in sim.diagnostics if d.code.startswith("SK-PARAM")]
        assert sim.sensor("m::l::s").pose.rpy[2] == pytest.approx(0.4)
        sim.run(0.02)
        same.run(0.02)
        np.testing.assert_array_equal(sim.sensor("m::l::s").latest.data, same.sensor("m::l::s").latest.data)
