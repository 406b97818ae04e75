"""Point clouds of depth cameras, and their frames."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from depth_worlds import CLASSIC, OPTICAL, WALL, camera, first_messages, loaded, points_of, scene
from sensor_worlds import box, cloud, depths, noise

import simkit

# ---------------------------------------------------------------------- clouds


def test_a_cloud_is_laid_out_as_gazebos() -> None:
    half = box("half", "3.5 2 1 0 0 0", "1 4 9", colour="1 0 0")
    (message,) = first_messages(scene(camera(), half), "/c/points")
    assert [(f.name, f.offset, f.datatype, f.count) for f in message.fields] == [
        ("x", 0, 7, 1), ("y", 4, 7, 1), ("z", 8, 7, 1), ("rgb", 16, 7, 1),
    ]  # fmt: skip
    assert (message.height, message.width, message.point_step, message.row_step) == (48, 64, 24, 64 * 24)
    assert not message.is_dense
    data = np.asarray(message.data).reshape(48, 64, 24)
    assert not data[..., 12:16].any()
    assert not data[..., 19:].any()
    blue, green, red = data[24, 5, 16:19]
    assert red > 200 > 50 > max(blue, green)
    points = points_of(message)
    assert np.isfinite(points[:, :31]).all()
    assert (points[:, 33:] == math.inf).all()
    (whole,) = first_messages(scene(camera(), WALL), "/c/points")
    assert whole.is_dense


def test_a_depth_cameras_cloud_is_bright_near_and_black_far() -> None:
    others = box("near", "1.5 0.5 1 0 0 0", "1 1 9") + box("far", "4.5 -2 1 0 0 0", "1 4 9")
    (message,) = first_messages(scene(camera(kind="depth_camera"), others), "/c/points")
    found = cloud(message)
    shades = np.ascontiguousarray(found["rgb"]).view(np.uint8).reshape(48, 64, 4)[..., 0]
    assert shades[24, 50] == 0
    assert shades[24, 20] == pytest.approx(255 * (1 - 1 / 4), abs=1)
    assert (shades[found["x"] == math.inf] == 0).all()


def test_points_as_an_array_are_the_messages() -> None:
    with simkit.load(scene(camera(noise(0.02) + OPTICAL), WALL)) as sim:
        eye, sub = sim.sensor("m::l::s"), sim.subscribe("/c/points")
        depth = sim.subscribe("/c/depth_image")
        assert eye.depth is eye.true_depth is eye.points is None
        sim.run(0.02)
        np.testing.assert_array_equal(eye.points, points_of(sub.latest))
        np.testing.assert_array_equal(eye.depth, depths(depth.latest))
        np.testing.assert_allclose(eye.true_depth, 3.0, rtol=1e-6)
        with pytest.raises(ValueError, match="read-only"):
            eye.depth[0] = 0
        kept = eye.points.copy()
        sim.run(0.05)
        assert (eye.points != kept).any()


# ---------------------------------------------------------------------- frames


def transforms(sim: Any) -> dict[str, tuple[str, simkit.Pose]]:
    """Return the parent frame and the pose of each child frame on `/tf_static`."""
    sub = sim.subscribe("/tf_static")
    sim.step()
    found = {}
    for t in sub.latest.transforms if sub.latest else ():
        p, q = t.transform.translation, t.transform.rotation
        found[t.child_frame_id] = t.header.frame_id, simkit.Pose((p.x, p.y, p.z), (q.w, q.x, q.y, q.z))
    return found


@pytest.mark.parametrize("static", [True, False])
def test_an_optical_frame_is_in_headers_axes_and_tf(static: bool) -> None:
    where = "0.1 0.2 0.3 0 0.1 0.2"
    body = "" if static else "<inertial><mass>1</mass></inertial><gravity>false</gravity>"
    how: dict[str, Any] = {"static": static, "body": body, "pose": "0 0 1 0 0 0"}
    with (
        simkit.load(scene(camera(OPTICAL, pose=where), WALL, **how)) as sim,
        simkit.load(scene(camera(pose=where), WALL, **how)) as plain,
    ):
        names = ("image", "camera_info", "depth_image", "points")
        subs, plain_points = {n: sim.subscribe(f"/c/{n}") for n in names}, plain.subscribe("/c/points")
        sim.run(0.02)
        plain.run(0.02)
        assert {n: s.latest.header.frame_id for n, s in subs.items()} == dict.fromkeys(names, "eye")
        assert plain_points.latest.header.frame_id == "m::l::s"
        frames = transforms(sim)
        assert set(frames) == {"eye", "m::l::s"}
        assert set(transforms(plain)) == {"m::l::s"}
        parent, turned = frames["eye"]
        assert parent == "m::l::s"
        np.testing.assert_allclose(turned.rpy, (-math.pi / 2, 0, -math.pi / 2), atol=1e-12)
        link, pose = frames["m::l::s"]
        assert link == "l"
        np.testing.assert_allclose((*pose.position, *pose.rpy), [float(v) for v in where.split()], atol=1e-12)
        ahead = points_of(subs["points"].latest).reshape(-1, 3)
        assert (ahead[:, 2] > 2).all()
        np.testing.assert_allclose(ahead @ turned.matrix.T, points_of(plain_points.latest).reshape(-1, 3), atol=1e-6)
        # through tf the points are on the wall
        in_link = ahead @ (pose @ turned).matrix.T + pose.position
        np.testing.assert_allclose(in_link[:, 0], 3.0, atol=1e-5)


def test_an_optical_frame_that_is_a_link_has_its_transform_already() -> None:
    link = (
        '<link name="eye"><pose relative_to="l">0 0 0 -1.5707963 0 -1.5707963</pose></link>'
        '<joint name="j" type="fixed"><parent>l</parent><child>eye</child></joint>'
    )
    body = "<inertial><mass>1</mass></inertial>"
    text = scene(camera(OPTICAL), WALL, static=False, body=body).replace("</link></model>", f"</link>{link}</model>", 1)
    with simkit.load(text) as sim:
        frames = transforms(sim)
    assert set(frames) == {"eye", "m::l::s"}
    assert frames["eye"][0] == "l"


def test_a_sensor_frame_that_is_another_link_carries_the_optical_one_from_there() -> None:
    link = (
        '<link name="mount"><pose relative_to="l">0 0 0.5 0 0 0</pose></link>'
        '<joint name="j" type="fixed"><parent>l</parent><child>mount</child></joint>'
    )
    body = "<inertial><mass>1</mass></inertial>"
    extra = "<topic>c</topic><gz_frame_id>mount</gz_frame_id>"
    text = scene(camera(OPTICAL, extra=extra, pose="0 0 0.7 0 0 0"), static=False, body=body)
    with simkit.load(text.replace("</link></model>", f"</link>{link}</model>", 1)) as sim:
        parent, pose = transforms(sim)["eye"]
    assert parent == "mount"
    np.testing.assert_allclose(pose.position, (0, 0, 0.2), atol=1e-9)


def test_a_static_model_takes_no_frame_from_a_robot() -> None:
    robot = """<model name="robot"><link name="l"><inertial><mass>1</mass></inertial></link>
      <link name="k"><inertial><mass>1</mass></inertial></link>
      <joint name="j" type="fixed"><parent>l</parent><child>k</child></joint></model>"""
    with simkit.load(scene(camera(), robot)) as sim:
        frames = transforms(sim)
    assert frames["k"][0] == "l"
    assert frames["m::l::s"][0] == "m/l"


def test_with_gazebos_quirks_an_optical_frame_is_ignored() -> None:
    text = scene(camera(OPTICAL), WALL, top="<gazebo_quirks>true</gazebo_quirks>")
    (points,) = first_messages(text, "/c/points")
    assert points.header.frame_id == "m::l::s"
    np.testing.assert_allclose(cloud(points)["x"], 3.0, rtol=1e-6)


def test_classics_cloud_is_in_optical_axes_whatever_the_frame() -> None:
    text = scene(camera(kind="depth", plugin=CLASSIC.format("")), WALL)
    sim, (points,) = loaded(text, "/s/points")
    assert points.header.frame_id == "l"
    assert points.point_step == 32
    np.testing.assert_allclose(cloud(points)["z"], 3.0, rtol=1e-6)
    assert cloud(points)["x"][0, 0] < 0 > cloud(points)["y"][0, 0]  # left and above
    assert np.asarray(points.data).reshape(48, 64, 32)[24, 32, 18] > 200  # the picture's red
    assert "SK-SENSOR-112" in {d.code for d in sim.diagnostics}


def test_classics_cloud_in_the_frame_of_an_optical_link_is_not_reported() -> None:
    link = (
        '<link name="eye"><pose relative_to="l">0 0 0 -1.5707963 0 -1.5707963</pose></link>'
        '<joint name="j" type="fixed"><parent>l</parent><child>eye</child></joint>'
    )
    plugin = CLASSIC.format("<frame_name>eye</frame_name>")
    text = scene(camera(kind="depth", plugin=plugin), WALL).replace("</link></model>", f"</link>{link}</model>", 1)
    sim, (points,) = loaded(text, "/s/points")
    assert points.header.frame_id == "eye"
    assert "SK-SENSOR-112" not in {d.code for d in sim.diagnostics}


NEWEST = "<topic>c</topic><points_frame_id>cloud</points_frame_id>"


@pytest.mark.parametrize("kind", ["rgbd_camera", "depth_camera"])
@pytest.mark.parametrize(("more", "ahead"), [("", 0), ("<gz:use_ros_convention>true</gz:use_ros_convention>", 2)])
def test_a_cloud_may_have_a_frame_of_its_own_and_axes_of_ros(kind: str, more: str, ahead: int) -> None:
    with simkit.load(scene(camera(OPTICAL + more, kind=kind, extra=NEWEST), WALL)) as sim:
        heard = {topic: sim.subscribe(topic) for topic in sim.topics() if f"{topic}/".startswith("/c/")}
        sim.run(0.02)
        frames = {topic: sub.latest.header.frame_id for topic, sub in heard.items() if sub.latest}
        parent, pose = transforms(sim)["cloud"]
        eye = sim.sensor("m::l::s")
        np.testing.assert_allclose(eye.points[..., ahead], 3.0, rtol=1e-6)
    assert {topic: frame for topic, frame in frames.items() if frame != "eye"} == {"/c/points": "cloud"}
    assert parent == "m::l::s"
    np.testing.assert_allclose(pose.matrix.T @ (1, 0, 0), np.eye(3)[ahead], atol=1e-12)  # ahead, in the cloud's axes
    assert {d.code for d in sim.diagnostics} <= {"SK-RENDER-015"}  # without OpenGL


def test_axes_of_ros_are_for_a_frame_that_the_file_turns_itself() -> None:
    extra = "<topic>c</topic><gz_frame_id>turned</gz_frame_id>"
    (points,) = first_messages(
        scene(camera("<gz:use_ros_convention>1</gz:use_ros_convention>", extra=extra), WALL), "/c/points"
    )
    assert points.header.frame_id == "turned"
    np.testing.assert_allclose(cloud(points)["z"], 3.0, rtol=1e-6)
    assert cloud(points)["x"][0, 0] < 0 > cloud(points)["y"][0, 0]  # left and above
