"""Click in a camera's picture: the head turns the camera there."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit
from simkit.bridges.live.request_fields import RequestRefused
from simkit_view.view.camera_pointing import point_camera

CAMERA = "tiago_no_arm::head_front_camera_rgb_frame::head_front_camera_frame_sensor"


def test_a_click_turns_the_camera_until_the_clicked_point_is_in_the_middle() -> None:
    with simkit.load("tiago_no_arm", model_world="empty") as sim:
        camera = sim.contents.sensors[CAMERA]
        focal = camera.options.model.fx
        ray = np.array((1.0, -(0.75 - 0.5) * 640 / focal, -(0.7 - 0.5) * 480 / focal))  # right of the middle, below it
        point = camera.pose.transform(ray / np.linalg.norm(ray))
        goal = point_camera(sim, CAMERA, 0.75, 0.7)
        assert goal.action.name == "/head_controller/point_head_action"
        assert sim.run_until(lambda _: goal.is_done, timeout=5.0)
        sim.run(0.5)
        assert goal.status.name == "SUCCEEDED"
        way = camera.pose.inverse().transform(point)
        assert math.atan2(math.hypot(way[1], way[2]), way[0]) < math.radians(1.0)


def test_a_click_without_a_head_or_outside_the_picture_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with simkit.load("turtlebot3_waffle_pi") as sim:
        camera = next(name for name, each in sim.contents.sensors.items() if each.kind == "camera")
        with pytest.raises(RequestRefused, match="PointHead"):
            point_camera(sim, camera, 0.5, 0.5)
        with pytest.raises(RequestRefused, match="outside the picture"):
            point_camera(sim, camera, 1.5, 0.5)
        with pytest.raises(RequestRefused, match="no camera 'nothing'"):
            point_camera(sim, "nothing", 0.5, 0.5)
