"""The Kinect of the TurtleBot 2 sees the ball where it lies, and a program drives to the ball by the camera alone."""

from __future__ import annotations

import math
from typing import Any

import cv2
import numpy as np
import pytest

import simkit

CAMERA = "turtlebot2::camera_rgb_frame::camera"
WIDTH, HEIGHT = 320, 240
SMALLER = [
    f"{CAMERA}.{setting}"
    for setting in ("update_rate=10", f"camera.image.width={WIDTH}", f"camera.image.height={HEIGHT}")
]
FOCAL = WIDTH / 2 / math.tan(math.radians(30))
RADIUS = 0.11  # of the ball [m]


def orange(image: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return rows and columns of the orange pixels."""
    colours = cv2.cvtColor(image.data.reshape(HEIGHT, WIDTH, 3), cv2.COLOR_BGR2HSV)
    return np.nonzero(cv2.inRange(colours, (5, 150, 80), (16, 255, 255)))


def distances(depth: Any) -> np.ndarray:
    return np.asarray(depth.data).view(np.float32).reshape(HEIGHT, WIDTH)


def test_the_ball_is_in_the_image_where_it_lies() -> None:
    """Colours, depths and points come from the colour lens, and have its optical frame."""
    with simkit.load("turtlebot2_ball", overrides=SMALLER) as sim:
        images, depths, clouds = (
            sim.subscribe(f"/camera/{name}", keep=1) for name in ("rgb/image_raw", "depth/image_raw", "depth/points")
        )
        sim.run(0.25)
        lens = sim.model("turtlebot2").link("camera_rgb_frame").pose
        ahead, left, above = (lens.inverse() @ sim.model("ball").pose).position
    rows, columns = orange(images.latest)
    assert columns.mean() + 0.5 == pytest.approx(WIDTH / 2 - FOCAL * left / ahead, abs=1.5)
    assert rows.mean() + 0.5 == pytest.approx(HEIGHT / 2 - FOCAL * above / ahead, abs=1.5)
    nearest = np.nanmin(distances(depths.latest)[rows, columns])
    assert nearest == pytest.approx(ahead - RADIUS, abs=0.002)  # depths are along the axis of the lens
    assert {m.latest.header.frame_id for m in (images, depths, clouds)} == {"camera_rgb_optical_frame"}


@pytest.mark.slow
def test_a_program_drives_to_the_ball() -> None:
    with simkit.load("turtlebot2_ball", overrides=SMALLER) as sim:
        images, depths = (sim.subscribe(f"/camera/{name}", keep=1) for name in ("rgb/image_raw", "depth/image_raw"))
        start = sim.model("ball").pose.position
        sim.run(0.2)
        for _ in range(90):
            rows, columns = orange(images.latest)
            distance = np.nanmedian(distances(depths.latest)[rows, columns])
            forward, turn = np.clip(0.8 * (distance - 0.6), -0.3, 0.3), 1.5 * (0.5 - columns.mean() / WIDTH)
            message = {"linear": {"x": float(forward)}, "angular": {"z": float(turn)}}
            sim.publish("/mobile_base/commands/velocity", message)
            sim.run(0.1)
        lens = sim.model("turtlebot2").link("camera_rgb_frame").pose
        x, y, _ = (lens.inverse() @ sim.model("ball").pose).position
        assert abs(math.atan2(y, x)) < math.radians(1)
        assert x == pytest.approx(0.6 + RADIUS * 0.75, abs=0.03)
        assert sim.model("ball").pose.position == pytest.approx(start, abs=1e-4)
