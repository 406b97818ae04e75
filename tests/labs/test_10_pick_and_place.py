"""Lab 10: the solution measures the marker wherever the block is; the picture of its README shows a whole run."""

from __future__ import annotations

import math
import runpy
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

import simkit
from simkit import msgs
from simkit.sensors.cameras.overview_image import render_view

pytestmark = pytest.mark.labs

LAB = Path(__file__).parents[2] / "labs" / "10_pick_and_place"
SOLUTION = LAB / "solution"
CAMERA_FRAME = "head_front_camera_rgb_optical_frame"
SIDE = 360  # [px], of each part of the picture
DIFFERENT = 1.0  # mean difference of two pictures, of 255: other graphics drivers smooth edges otherwise


def open_lab() -> Any:
    return simkit.load(LAB / "lab.sdf", plugin_paths=[SOLUTION, LAB])


def test_the_marker_is_measured_to_3_mm_and_1_degree_in_20_places() -> None:
    """Each picture is compared with the truth at its own time, because the torso moves."""
    find_marker = runpy.run_path(str(SOLUTION / "pick_and_place.py"))["find_marker"]
    random = np.random.default_rng(10)
    errors: list[tuple[float, float]] = []
    with open_lab() as sim:
        robot, block = sim.model("tiago"), sim.model("block")
        sim.run_until(lambda sim: sim.joint("tiago::torso_lift_joint").position > 0.19, timeout=6.0)
        info = sim.subscribe("/head_front_camera/rgb/camera_info", keep=1)

        def compare(message: Any) -> None:
            if info.latest is None:
                return
            seen = find_marker(msgs.image(message), np.array(info.latest.k).reshape(3, 3))
            error = block.link("marker").pose.inverse() @ robot.link(CAMERA_FRAME).pose @ seen
            errors.append((math.hypot(*error.position), 2 * math.acos(min(1.0, abs(error.quaternion[0])))))
            x, y, yaw = random.uniform((0.5, -0.2, -math.pi), (0.68, 0.2, math.pi))
            block.set_pose(robot.pose @ simkit.Pose.from_rpy(x, y, 0.75, 0, 0, yaw))

        sim.subscribe("/head_front_camera/rgb/image_raw", compare)
        sim.run_until(lambda _: len(errors) == 20, timeout=2.0)
    distance, angle = np.max(errors, axis=0)
    assert distance < 0.003
    assert math.degrees(angle) < 1.0


def test_the_picture_is_that_of_the_solution(tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    parts: list[Any] = []
    with open_lab() as sim:
        status = sim.subscribe("/pick_and_place/status", keep=1)
        robot = sim.model("tiago").pose
        eye, target = (robot.transform(at) for at in ((1.75, -1.35, 1.55), (0.45, -0.05, 0.88)))

        def draw() -> None:
            view = render_view(sim, SIDE, SIDE, eye=eye, target=target, vertical_fov=0.62, quality="gazebo", passes=4)
            parts.append(view[:, :, ::-1])

        seen = sim.subscribe("/aruco_single/pose", keep=1)
        sim.run_until(lambda sim: sim.joint("tiago::torso_lift_joint").position > 0.199, timeout=6.0)
        image = sim.subscribe("/head_front_camera/rgb/image_raw", keep=1)
        sim.run_until(lambda sim: seen.latest is not None, timeout=10.0)
        parts.append(marked(msgs.image(image.latest), sim, msgs.pose(seen.latest)))
        image.close()
        sim.run_until(lambda sim: sim.joint("tiago::gripper_right_finger_joint").position < 0.0355, timeout=20.0)
        draw()
        sim.run_until(lambda sim: status.latest.data == "pick done", timeout=20.0)
        draw()
        sim.run_until(lambda sim: status.latest.data == "place done", timeout=20.0)
        draw()
    picture = np.hstack(parts)
    cv2.imwrite(str(tmp_path / "pick_and_place.png"), picture)
    shown = cv2.imread(str(LAB / "pick_and_place.png"))
    assert shown is not None, tmp_path / "pick_and_place.png"
    difference = np.abs(shown.astype(float) - picture).mean() if shown.shape == picture.shape else math.inf
    assert difference < DIFFERENT, tmp_path / "pick_and_place.png"


def marked(pixels: Any, sim: simkit.Simulation, marker: simkit.Pose) -> Any:
    """Return the middle of the camera's picture with the axes of the marker."""
    pose = sim.tf.lookup(CAMERA_FRAME, "base_footprint") @ marker
    picture = np.ascontiguousarray(pixels[:, :, ::-1])
    focal = picture.shape[1] / 2 / math.tan(math.radians(63) / 2)
    matrix = np.array([[focal, 0, 320], [0, focal, 240], [0, 0, 1]])
    rotation, _ = cv2.Rodrigues(pose.matrix)
    cv2.drawFrameAxes(picture, matrix, np.zeros(4), rotation, pose.position, 0.06, 2)
    middle = (matrix @ pose.position)[:2] / pose.position[2]
    column, row = np.clip(middle, 140, (500, 340)).astype(int)
    return cv2.resize(picture[row - 140 : row + 140, column - 140 : column + 140], (SIDE, SIDE))
