"""What the cameras of the waffle and the waffle_pi see in simkit's world: pillars before a wall, on the floor."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.pose import Pose
from simkit.sensors.cameras.image_messages import pixels_of


def seen(robot: str, monkeypatch: pytest.MonkeyPatch) -> tuple[Any, dict[str, Any], Pose]:
    """What is said on loading, the newest message of each of the camera's topics, and where it is."""
    monkeypatch.setenv("TURTLEBOT3_MODEL", robot)
    with simkit.load("turtlebot3_world") as sim:
        heard = {topic: sim.subscribe(topic, keep=1) for topic in sim.topics() if topic.startswith("/camera/")}
        sim.run(0.1)
        eye = next(
            sensor.pose for sensor in sim.contents.sensors.values() if sensor.kind in ("camera", "depth", "rgbd_camera")
        )
        return tuple(sim.diagnostics), {topic: readings.latest for topic, readings in heard.items()}, eye


@pytest.mark.parametrize(("robot", "hfov"), [("waffle", 1.02974), ("waffle_pi", 1.085595)])
def test_the_camera_sees_a_bright_room_with_things_in_it(
    robot: str, hfov: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    said, messages, _ = seen(robot, monkeypatch)
    assert not [d for d in said if d.severity == "error" or ("RENDER" in d.code and d.severity != "note")]
    picture = pixels_of(messages["/camera/image_raw"]).astype(int)
    assert picture.shape == (480, 640, 3)
    assert 60 < picture.mean() < 240  # neither night nor a blank sheet
    assert picture.std() > 15
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 20
    assert picture[-40:].std() < picture.std()  # the floor before the robot has less to it than the room
    assert messages["/camera/camera_info"].k[0] == pytest.approx(320 / math.tan(hfov / 2))
    assert messages["/camera/image_raw"].header.frame_id == "camera_rgb_optical_frame"


def test_the_depths_of_the_waffle_are_those_of_the_floor_and_of_what_stands_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    _, messages, eye = seen("waffle", monkeypatch)
    depths = pixels_of(messages["/camera/depth/image_raw"])
    finite = np.isfinite(depths)
    assert finite.mean() > 0.3
    assert depths[finite].min() > 0.1
    assert depths[finite].max() < 8.0  # the arena's far wall ends it
    k = messages["/camera/depth/camera_info"].k
    for row in range(300, 396, 5):
        z = float(np.median(depths[row, 280:360]))
        point = eye.transform((z, 0.0, -(row + 0.5 - k[5]) / k[4] * z))  # x forward, y left, z up
        assert point[2] == pytest.approx(0.0, abs=0.01), row  # on the floor


def test_the_cloud_of_the_waffle_lies_on_its_pixels(monkeypatch: pytest.MonkeyPatch) -> None:
    _, messages, _ = seen("waffle", monkeypatch)
    k, cloud = messages["/camera/depth/camera_info"].k, messages["/camera/points"]
    x, y, z = np.moveaxis(np.asarray(cloud.data).view(np.float32).reshape(480, 640, -1)[..., :3], 2, 0)
    seen_by = np.isfinite(z)
    np.testing.assert_array_equal(seen_by, np.isfinite(pixels_of(messages["/camera/depth/image_raw"])))
    rows, columns = np.nonzero(seen_by)
    np.testing.assert_allclose(k[0] * x[seen_by] / z[seen_by] + k[2], columns + 0.5, atol=0.01)
    np.testing.assert_allclose(k[4] * y[seen_by] / z[seen_by] + k[5], rows + 0.5, atol=0.01)
