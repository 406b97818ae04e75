"""Cameras and angles in programs: `image_geometry` and `angles`."""

from __future__ import annotations

import math

import numpy as np
import pytest

from simkit_nodes.interfaces import ROS1, ROS2
from simkit_nodes.ros_modules import angles
from simkit_nodes.ros_modules.image_geometry import PinholeCameraModel, StereoCameraModel

NUMBERS = {
    "k": [500.0, 0.0, 320.0, 0.0, 500.0, 240.0, 0.0, 0.0, 1.0],
    "r": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
    "p": [500.0, 0.0, 320.0, 0.0, 0.0, 500.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    "d": [0.0, 0.0, 0.0, 0.0, 0.0],
}


def camera_info(shift: float = 0.0) -> object:
    info = ROS2.message_class("sensor_msgs/msg/CameraInfo")(width=640, height=480, **NUMBERS)
    info.header.frame_id = "optical"
    info.p[3] = shift
    return info


def test_a_camera_projects_points_to_pixels_and_pixels_to_rays() -> None:
    camera = PinholeCameraModel()
    camera.fromCameraInfo(camera_info())
    assert camera.project3dToPixel((0.2, -0.1, 2.0)) == pytest.approx((370.0, 215.0))
    ray = camera.projectPixelTo3dRay((370.0, 215.0))
    assert np.array(ray) / ray[2] == pytest.approx((0.1, -0.05, 1.0))
    assert camera.tfFrame() == "optical"
    assert camera.fovX() == pytest.approx(2 * math.atan(320 / 500))
    assert camera.rectifyPoint((100.0, 50.0)) == pytest.approx((100.0, 50.0))
    assert isinstance(camera.K, np.matrix)  # programs multiply it with `*`


def test_the_names_of_ros_1_are_those_of_ros_1() -> None:
    info = ROS1.message_class("sensor_msgs/msg/CameraInfo")(width=640, height=480)
    for name, values in NUMBERS.items():
        setattr(info, name.upper(), values)
    camera = PinholeCameraModel()
    camera.fromCameraInfo(info)
    assert (camera.fx(), camera.cx()) == (500.0, 320.0)


def test_two_cameras_give_the_distance_of_a_point() -> None:
    cameras = StereoCameraModel()
    cameras.fromCameraInfo(camera_info(), camera_info(shift=-50.0))
    (left, v), (right, _) = cameras.project3dToPixel((0.2, -0.1, 2.0))
    assert cameras.projectPixelTo3d((left, v), left - right) == pytest.approx((0.2, -0.1, 2.0))
    assert cameras.getZ(left - right) == pytest.approx(2.0)
    assert cameras.getDisparity(2.0) == pytest.approx(left - right)


def test_angles_are_normalized() -> None:
    assert angles.normalize_angle(3 * math.pi / 2) == pytest.approx(-math.pi / 2)
    assert angles.normalize_angle_positive(-math.pi / 2) == pytest.approx(3 * math.pi / 2)
    assert angles.shortest_angular_distance(3.0, -3.0) == pytest.approx(math.tau - 6.0)
    assert angles.two_pi_complement(0.5) == pytest.approx(0.5 - math.tau)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ((-0.5, 0.5, -0.25, 0.25), (False, 1.0)),
        ((-0.5, 0.5, 0.25, -0.25), (True, 1.0 - math.tau)),
        ((0.2, -0.2, -0.25, 0.25), (True, -0.4)),
        ((0.2, 2.0, -0.25, 0.25), (False, 1.8)),
    ],
)
def test_rotations_stay_between_limits(
    arguments: tuple[float, float, float, float], expected: tuple[bool, float]
) -> None:
    is_possible, rotation = angles.shortest_angular_distance_with_limits(*arguments)
    assert is_possible is expected[0]
    assert abs(rotation) == pytest.approx(abs(expected[1]))


def test_limits_may_be_wider_than_a_turn() -> None:
    wide = angles.shortest_angular_distance_with_large_limits
    assert wide(0.0, 10.5 * math.pi, -math.tau, math.tau) == (True, pytest.approx(0.5 * math.pi))
    assert wide(0.0, 10.5 * math.pi, -math.tau, 0.1 * math.pi) == (True, pytest.approx(-1.5 * math.pi))
    assert wide(10.5 * math.pi, 0.0, -math.tau, math.tau)[0] is False
