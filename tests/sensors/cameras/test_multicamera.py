"""Several cameras in one sensor: one sample time; separate poses, intrinsics and noise; stereo geometry."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from sensor_worlds import box, colours, noise, sensor, world

import simkit
from simkit.sensors.cameras import image_messages

SCENE = "<scene><ambient>1 1 1 1</ambient><background>0 0 0 1</background></scene>"
BASELINE, DISTANCE = 0.12, 3.0
SPOT = box("spot", "3.05 0 1 0 0 0", "0.1 0.3 0.3", colour="1 0 0")
LEFT, RIGHT = f"0 {BASELINE / 2} 0 0 0 0", f"0 {-BASELINE / 2} 0 0 0 0"


def camera(name: str, pose: str = "0 0 0 0 0 0", more: str = "", *, width: int = 64, fmt: str = "R8G8B8") -> str:
    return f"""<camera name="{name}"><pose>{pose}</pose><horizontal_fov>1.2</horizontal_fov>
      <image><width>{width}</width><height>48</height><format>{fmt}</format></image>{more}</camera>"""


def scene(cameras: str, **more: Any) -> str:
    return world(sensor("multicamera", cameras, extra="<topic>rig</topic>"), others=SPOT, top=SCENE, **more)


def latest_messages(text: str, *topics: str) -> list[Any]:
    with simkit.load(text) as sim:
        subs = [sim.subscribe(t) for t in topics]
        sim.run(0.015)
        return [s.latest for s in subs]


def middle(message: Any) -> float:
    """Return the column [px] of the middle of all red pixels."""
    red = colours(message)[..., 0].sum(axis=0, dtype=float)
    return float(red @ (np.arange(message.width) + 0.5) / red.sum())


# ---------------------------------------------------------------------- stereo


def test_disparity_is_focal_length_times_baseline_over_depth() -> None:
    pair = camera("left", LEFT, width=320) + camera("right", RIGHT, width=320)
    left, right, info = latest_messages(scene(pair), "/rig/left/image", "/rig/right/image", "/rig/right/camera_info")
    disparity = middle(left) - middle(right)
    assert disparity == pytest.approx(info.p[0] * BASELINE / DISTANCE, abs=0.5)
    assert -info.p[3] / disparity == pytest.approx(DISTANCE, rel=0.06)


def test_only_the_right_cameras_p_contains_the_baseline() -> None:
    focal = 64 / (2 * math.tan(0.6))
    for names in (("left", "right"), ("front_right", "front_left")):  # whichever comes first
        poses = {name: LEFT if "left" in name else RIGHT for name in names}
        text = scene("".join(camera(name, pose) for name, pose in poses.items()))
        infos = dict(zip(names, latest_messages(text, *(f"/rig/{name}/camera_info" for name in names)), strict=True))
        for name, info in infos.items():
            expected = 0.0 if "left" in name else -focal * BASELINE
            assert info.p[3] == pytest.approx(expected, abs=1e-9)
            assert info.p[7] == 0


def test_p_of_a_camera_below_another_contains_ty() -> None:
    _, info = latest_messages(
        scene(camera("top") + camera("bottom", "0 0 -0.1 0 0 0")), "/rig/top/camera_info", "/rig/bottom/camera_info"
    )
    assert (info.p[3], info.p[7]) == pytest.approx((0, -0.1 * info.p[5]))


def test_a_projection_of_the_file_is_published_unchanged() -> None:
    lens = "<lens><projection><tx>-7</tx></projection></lens>"
    (info,) = latest_messages(scene(camera("left", LEFT) + camera("right", RIGHT, lens)), "/rig/right/camera_info")
    assert info.p[3] == -7


@pytest.mark.parametrize("pose", ["0 -0.1 0 0 0 0.1", "0.05 -0.1 0 0 0 0"])
def test_cameras_that_are_not_parallel_have_no_baseline_which_is_reported(pose: str) -> None:
    with simkit.load(scene(camera("left") + camera("right", pose))) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-124"] == ["note"]
        info = sim.subscribe("/rig/right/camera_info")
        sim.step()
        assert info.latest.p[3] == 0


# ---------------------------------------------------------------------- each camera its own


def test_all_images_are_of_one_instant() -> None:
    text = scene(camera("a") + camera("b") + camera("c"))
    topics = [f"/rig/{name}/{what}" for name in "abc" for what in ("image", "camera_info")]
    with simkit.load(text) as sim:
        subs = [sim.subscribe(t) for t in topics]
        sim.run(0.1)
        stamps = [[(m.header.stamp.sec, m.header.stamp.nanosec) for m in sub.messages] for sub in subs]
        assert len(stamps[0]) >= 10
        assert all(found == stamps[0] for found in stamps)


def test_cameras_have_their_own_size_lens_format_and_place() -> None:
    bent = "<distortion><k1>-0.1</k1></distortion><optical_frame_id>b_optical</optical_frame_id>"
    text = scene(
        camera("ahead")
        + camera("grey", width=32, fmt="L16")
        + camera("bent", more=bent)
        + camera("back", "0 0 0 0 0 3.14159")
    )
    names = ("ahead", "grey", "bent", "back")
    images = latest_messages(text, *(f"/rig/{name}/image" for name in names))
    infos = latest_messages(text, *(f"/rig/{name}/camera_info" for name in names))
    assert [(m.width, m.encoding) for m in images] == [(64, "rgb8"), (32, "mono16"), (64, "rgb8"), (64, "rgb8")]
    assert [m.width for m in infos] == [64, 32, 64, 64]
    assert [m.d[0] for m in infos] == pytest.approx([0, 0, -0.1, 0])
    assert [m.header.frame_id for m in images] == ["m::l::s", "m::l::s", "b_optical", "m::l::s"]
    assert colours(images[0])[24, 32, 0] > 200
    assert image_messages.pixels_of(images[1])[24, 16] > 0
    assert not colours(images[3])[..., 0].any()  # it looks the other way


def test_a_rig_sees_what_single_cameras_in_its_places_see() -> None:
    pose = "0.1 -0.2 0.05 0.1 0.05 0.15"
    rig = scene(camera("a") + camera("b", pose))
    alone = world(
        sensor("camera", camera("b"), pose=pose, extra="<topic>alone</topic>"),
        others=SPOT,
        top=SCENE,
    )
    (of_rig,), (of_one,) = latest_messages(rig, "/rig/b/image"), latest_messages(alone, "/alone")
    assert colours(of_one)[..., 0].any()
    np.testing.assert_array_equal(of_rig.data, of_one.data)


def test_noise_differs_from_camera_to_camera_and_from_image_to_image() -> None:
    noisy = noise(0.05)
    text = scene(camera("a", more=noisy) + camera("b", more=noisy) + camera("c"))
    with simkit.load(text.replace("0 0 0 1</background>", "0.5 0.5 0.5 1</background>"), seed=3) as sim:
        subs = [sim.subscribe(f"/rig/{name}/image") for name in "abc"]
        sim.run(0.03)
        (a, a_later), (b, _), (true, _) = ([colours(m).astype(int) for m in sub.messages[:2]] for sub in subs)
    first, second, later = ((found - true)[..., 1].ravel() for found in (a, b, a_later))
    assert first.std() == pytest.approx(0.05 * 255, rel=0.1)
    for other in (second, later):
        assert abs(np.corrcoef(first, other)[0, 1]) < 0.06  # 3 / sqrt(64·48) is 0.054


def test_latest_and_truth_are_the_first_cameras_image() -> None:
    text = scene(camera("a", more=noise(0.05)) + camera("b"))
    with simkit.load(text) as sim:
        sub = sim.subscribe("/rig/a/image")
        sim.run(0.015)
        rig = sim.sensor("m::l::s")
        assert rig.topic == "/rig/a/image"
        np.testing.assert_array_equal(rig.latest.data, sub.latest.data)
        assert (rig.truth.data != rig.latest.data).any()


# ---------------------------------------------------------------------- topics, triggers, files


def test_topics_without_a_plugin_are_below_the_sensors() -> None:
    text = world(sensor("multicamera", camera("left") + camera("right")))
    with simkit.load(text) as sim:
        base = "/world/w/model/m/link/l/sensor/s"
        found = {t.removeprefix(base) for t in sim.topics() if t.startswith(base)}
        assert found == {f"/{side}/{what}" for side in ("left", "right") for what in ("image", "camera_info")}


def test_one_trigger_for_all() -> None:
    with simkit.load(scene(camera("a", more="<triggered>true</triggered>") + camera("b"))) as sim:
        subs = [sim.subscribe(f"/rig/{name}/image") for name in "ab"]
        sim.run(0.05)
        assert not any(sub.messages for sub in subs)
        sim.publish("/rig/trigger", {"data": True})
        sim.run(0.05)
        assert [len(sub.messages) for sub in subs] == [1, 1]


def test_each_camera_that_saves_has_its_own_files(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    save = '<save enabled="true"><path>seen</path></save>'
    with simkit.load(scene(camera("a", more=save) + camera("b") + camera("c", more=save))) as sim:
        sim.step()
    assert sorted(p.name for p in (tmp_path / "seen").iterdir()) == ["m::l::s::a_0.png", "m::l::s::c_0.png"]


def test_cameras_without_a_name_are_numbered_and_a_name_is_given_once() -> None:
    unnamed = scene(camera("x").replace(' name="x"', "") + camera("y").replace(' name="y"', ""))
    with simkit.load(unnamed) as sim:
        assert {"/rig/camera_0/image", "/rig/camera_1/image"} <= set(sim.topics())
    with pytest.raises(simkit.LoadError, match="have the name 'x'"):
        simkit.load(scene(camera("x") + camera("x")))


def test_all_cameras_are_described() -> None:
    found = simkit.describe(scene(camera("left", LEFT) + camera("right", RIGHT, width=32)))
    (described,) = found["worlds"][0]["models"][0]["links"][0]["sensors"]
    assert described["camera"]["width"] == 64
    assert [(c["name"], c["width"]) for c in described["cameras"]] == [("left", 64), ("right", 32)]
    assert described["cameras"][1]["pose_sensor"][1] == -BASELINE / 2


def test_a_rig_is_the_same_after_reset_and_restore() -> None:
    text = scene(camera("left", LEFT, noise(0.05)) + camera("right", RIGHT, noise(0.05)))
    with simkit.load(text, seed=4) as sim:
        sub = sim.subscribe("/rig/right/image")
        sim.run(0.05)
        first, middle_ = [bytes(m.data) for m in sub.messages], sim.snapshot()
        sim.run(0.05)
        then = [bytes(m.data) for m in sub.messages[len(first) :]]
        count = len(sub.messages)
        sim.restore(middle_)
        sim.run(0.05)
        assert [bytes(m.data) for m in sub.messages[count:]] == then
        count = len(sub.messages)
        sim.reset()
        sim.run(0.05)
        assert [bytes(m.data) for m in sub.messages[count:]] == first


@pytest.mark.parametrize(
    ("left", "right", "element"),
    [
        ("<visibility_mask>1</visibility_mask>", "", "visibility_mask"),
        (
            "<triggered>1</triggered><trigger_topic>a</trigger_topic>",
            "<triggered>1</triggered><trigger_topic>b</trigger_topic>",
            "trigger_topic",
        ),
        ('<save enabled="1"><path>a</path></save>', '<save enabled="1"><path>b</path></save>', "path"),
    ],
)
def test_differing_options_shared_by_all_cameras_are_reported(left: str, right: str, element: str) -> None:
    with simkit.load(scene(camera("left", LEFT, left) + camera("right", RIGHT, right))) as sim:
        (found,) = sim.diagnostics
    assert found.code == "SK-SENSOR-125"
    assert f"<{element}>" in found.message
    with simkit.load(scene(camera("left", LEFT, left) + camera("right", RIGHT, left))) as sim:
        assert not sim.diagnostics
