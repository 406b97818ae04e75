"""Zoom of cameras: commands, speed of the lens, images, depths and `CameraInfo`."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit

COMMAND = "/model/m/sensor/eye/zoom/cmd_zoom"
DISTANCE, WIDTH = 5.0, 160
RED = "<material><ambient>1 0 0 1</ambient><diffuse>1 0 0 1</diffuse></material>"


def world(zoom: str = "", kind: str = "camera", hfov: float = 2.0, more: str = "", top: str = "") -> str:
    """Return a world with a red cube of 1 m, whose face is 4.5 m in front of a camera."""
    return f"""<sdf version="1.9" xmlns:simkit="https://simkit.invalid"><world name="w">{top}
<physics name="p" type="ode"><max_step_size>0.01</max_step_size></physics>
<light name="sun" type="directional"><direction>1 0.3 -1</direction></light>
<model name="m"><static>true</static><link name="l"><sensor name="eye" type="{kind}"><update_rate>10</update_rate>
<topic>eye</topic><camera name="left"><horizontal_fov>{hfov}</horizontal_fov>
<image><width>{WIDTH}</width><height>120</height></image>{more}</camera>
<plugin filename="CameraZoomPlugin" name="CameraZoomPlugin">{zoom}</plugin></sensor></link></model>
<model name="cube"><static>true</static><pose>{DISTANCE} 0 0 0 0 0</pose><link name="l"><visual name="v">
<geometry><box><size>1 1 1</size></box></geometry>{RED}</visual></link></model></world></sdf>"""


def red_pixels(sim: simkit.Simulation) -> int:
    pixels = simkit.msgs.image(sim.sensor("m::l::eye").latest)
    return int(np.count_nonzero((pixels[..., 0] > 60) & (pixels[..., 1] < 40)))


def focal_length(hfov: float) -> float:
    return WIDTH / 2 / math.tan(hfov / 2)


def test_a_command_divides_the_opening_angle_at_once_without_a_slew_rate() -> None:
    with simkit.load(world()) as sim:
        info = sim.subscribe("/camera_info", keep=1)
        sim.run(0.2)
        assert info.latest.k[0] == pytest.approx(focal_length(2.0))
        wide = red_pixels(sim)
        sim.publish(COMMAND, {"data": 4.0})
        sim.run(0.2)
        assert info.latest.k[0] == pytest.approx(focal_length(0.5))
        assert info.latest.p[0] == pytest.approx(focal_length(0.5))
        near = red_pixels(sim)
        # the face of the cube is a square of f/4.5 m pixels
        assert wide == pytest.approx((focal_length(2.0) / 4.5) ** 2, rel=0.15)
        assert near == pytest.approx((focal_length(0.5) / 4.5) ** 2, rel=0.05)


@pytest.mark.parametrize(("command", "angle"), [(100.0, 0.2), (0.1, 2.0), (-3.0, 2.0), (math.inf, 0.2)])
def test_a_command_stays_within_1_and_max_zoom(command: float, angle: float) -> None:
    with simkit.load(world()) as sim:
        sim.publish(COMMAND, {"data": command})
        sim.run(0.2)
        assert sim.sensor("m::l::eye").options.model.hfov == pytest.approx(angle)


def test_a_nan_is_ignored_with_a_warning() -> None:
    with simkit.load(world()) as sim:
        sim.publish(COMMAND, {"data": math.nan})
        sim.run(0.1)
        assert sim.sensor("m::l::eye").zoom == 1.0
        assert any(d.code == "SK-PLUGIN-041" for d in sim.diagnostics)


def test_the_focal_length_changes_with_the_slew_rate() -> None:
    with simkit.load(world("<slew_rate>0.5</slew_rate>")) as sim:
        sim.publish(COMMAND, {"data": 8.0})
        sim.run(1.0)
        # each step of 0.01 s makes the focal length 1.005 times as long
        assert sim.sensor("m::l::eye").zoom == pytest.approx(1.005**100, rel=0.006)
        sim.run(4.2)
        assert sim.sensor("m::l::eye").options.model.hfov == pytest.approx(0.25)
        sim.publish(COMMAND, {"data": 1.0})
        sim.run(6.0)
        assert sim.sensor("m::l::eye").zoom == 1.0


def test_the_slew_rate_is_relative_to_the_focal_length_of_the_lens() -> None:
    lens = "<lens><custom_function><f>2</f></custom_function></lens>"
    with simkit.load(world("<slew_rate>0.5</slew_rate><max_zoom>20</max_zoom>", more=lens)) as sim:
        sim.publish(COMMAND, {"data": 20.0})
        sim.run(1.0)
        assert sim.sensor("m::l::eye").zoom == pytest.approx(1.0025**100, rel=0.003)


def test_a_topic_replaces_the_default_one() -> None:
    with simkit.load(world("<topic>gimbal/zoom</topic>")) as sim:
        sim.publish("/gimbal/zoom", {"data": 2.0})
        sim.run(0.1)
        assert sim.sensor("m::l::eye").options.model.hfov == pytest.approx(1.0)


@pytest.mark.parametrize("kind", ["depth_camera", "rgbd_camera"])
def test_the_points_of_a_zoomed_depth_camera_keep_their_places(kind: str) -> None:
    with simkit.load(world(kind=kind)) as sim:
        clouds = sim.subscribe("/eye/points", keep=1)
        sim.publish(COMMAND, {"data": 3.0})
        sim.run(0.2)
        points = simkit.msgs.points(clouds.latest)
        face = points[np.isfinite(points["x"])]
        assert face["x"] == pytest.approx(np.full(len(face), 4.5), abs=0.01)
        assert [face["y"].max(), face["z"].max()] == pytest.approx([0.5, 0.5], abs=0.05)


@pytest.mark.parametrize(
    ("kind", "info"),
    [
        ("multicamera", "/eye/left/camera_info"),
        ("thermal_camera", "/camera_info"),
        ("segmentation_camera", "/eye/camera_info"),
        ("boundingbox_camera", "/camera_info"),
    ],
)
def test_other_pinhole_cameras_zoom_too(kind: str, info: str) -> None:
    with simkit.load(world(kind=kind)) as sim:
        messages = sim.subscribe(info, keep=1)
        sim.publish(COMMAND, {"data": 4.0})
        sim.run(0.2)
        assert messages.latest.k[0] == pytest.approx(focal_length(0.5))
        sim.reset()
        sim.run(0.2)
        assert messages.latest.k[0] == focal_length(2.0)


def test_a_wide_angle_camera_has_no_zoom() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003.*without a wide lens"):
        simkit.load(world(kind="wide_angle_camera"))


def test_reset_and_restore_return_to_the_zoom_of_their_time() -> None:
    with simkit.load(world("<slew_rate>0.5</slew_rate>")) as sim:
        sim.publish(COMMAND, {"data": 8.0})
        sim.run(0.5)
        snapshot, zoom = sim.snapshot(), sim.sensor("m::l::eye").zoom
        image = sim.sensor("m::l::eye").latest.data.copy()
        sim.run(0.5)
        later, later_image = sim.sensor("m::l::eye").zoom, sim.sensor("m::l::eye").latest.data.copy()
        sim.reset()
        assert sim.sensor("m::l::eye").zoom == 1.0
        sim.restore(snapshot)
        assert sim.sensor("m::l::eye").zoom == zoom
        np.testing.assert_array_equal(sim.sensor("m::l::eye").latest.data, image)
        sim.run(0.5)
        assert sim.sensor("m::l::eye").zoom == later
        np.testing.assert_array_equal(sim.sensor("m::l::eye").latest.data, later_image)


def test_an_image_that_is_read_later_has_the_optics_of_its_time() -> None:
    with simkit.load(world()) as sim, simkit.load(world()) as read_at_once:
        images = sim.subscribe("/eye")
        infos = sim.subscribe("/camera_info")
        seen = read_at_once.subscribe("/eye")
        for run in (sim, read_at_once):
            run.run(0.1)
        first = seen.latest.data.copy()
        for run in (sim, read_at_once):
            run.publish(COMMAND, {"data": 4.0})
            run.run(0.2)
        np.testing.assert_array_equal(images.messages[0].data, first)
        assert [m.k[0] for m in infos.messages[-2:]] == pytest.approx([focal_length(0.5)] * 2)
        assert infos.messages[0].k[0] == pytest.approx(focal_length(2.0))


def test_with_gazebos_quirks_zoom_1_is_2_radians() -> None:
    quirks = "<simkit:gazebo_quirks>true</simkit:gazebo_quirks>"
    with simkit.load(world(hfov=1.0, top=quirks)) as sim:
        sim.run(0.1)
        assert sim.sensor("m::l::eye").options.model.hfov == pytest.approx(2.0)
