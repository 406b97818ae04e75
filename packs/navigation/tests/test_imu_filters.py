"""Filters of IMUs: their orientation is the true one of a sensor that turns about a known axis."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.pose import quat_multiply
from simkit_navigation.orientation_filters import (
    ComplementaryFilter,
    MadgwickFilter,
    OrientationFilter,
    initial_orientation,
)

STEP = 0.01  # [s]
NORTH_FIELD = np.array([0.0, 2e-5, -4e-5])  # [T], in east, north, up


def turned(q: tuple[float, ...], vector: np.ndarray) -> np.ndarray:
    w, x, y, z = q
    return np.array(quat_multiply(quat_multiply((w, -x, -y, -z), (0.0, *vector)), (w, x, y, z))[1:])


def angle_between(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    return 2 * math.acos(min(1.0, abs(sum(x * y for x, y in zip(a, b, strict=True)))))


def error_after(filter_: OrientationFilter, bias: float, seconds: float, field: bool) -> float:
    """Return the error [rad] for a sensor that swings about a tilted axis."""
    axis = np.array([0.6, -0.64, 0.48])
    error = 0.0
    for k in range(round(seconds / STEP)):
        angle, rate = 0.8 * math.sin(k * STEP), 0.8 * math.cos(k * STEP)
        truth = (math.cos(angle / 2), *(axis * math.sin(angle / 2)))
        force = turned(truth, np.array([0.0, 0.0, 9.81]))
        found = filter_.update(axis * rate + bias, force, turned(truth, NORTH_FIELD) if field else None, STEP)
        error = angle_between(found, truth)
    return error


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.6, -0.64, 0.48), (0.0, 0.0, 1.0)])
@pytest.mark.parametrize("angle", [-3.0, -1.0, 0.0, 0.4, 2.5])
def test_the_first_orientation_is_that_of_the_vertical_and_of_north(axis: tuple[float, ...], angle: float) -> None:
    truth = (math.cos(angle / 2), *(value * math.sin(angle / 2) for value in axis))
    found = initial_orientation(turned(truth, np.array([0.0, 0.0, 9.81])), turned(truth, NORTH_FIELD))
    assert angle_between(found, truth) < 1e-6


@pytest.mark.parametrize("make", [lambda: MadgwickFilter(0.1), lambda: ComplementaryFilter(0.01, 0.01, 0.0)])
@pytest.mark.parametrize("bias", [0.0, 0.02])
def test_the_orientation_stays_near_the_truth_with_a_magnetic_field(make: object, bias: float) -> None:
    assert error_after(make(), bias, 60.0, field=True) < (0.02 if bias == 0.0 else 0.08)  # type: ignore[operator]


def test_without_corrections_a_bias_of_the_gyroscope_adds_up() -> None:
    assert error_after(MadgwickFilter(0.0), 0.02, 60.0, field=True) > 0.5


TALKER = """
import math, rclpy
from sensor_msgs.msg import Imu
rclpy.init()
node = rclpy.create_node("talker")
publisher = node.create_publisher(Imu, "imu/data_raw", 5)
def send():
    message = Imu()
    message.header.stamp, message.header.frame_id = node.get_clock().now().to_msg(), "imu_link"
    message.linear_acceleration.y, message.linear_acceleration.z = 9.81 * math.sin(0.3), 9.81 * math.cos(0.3)
    publisher.publish(message)
node.create_timer(0.02, send)
rclpy.spin(node)
"""


@pytest.mark.parametrize(
    "program", ["imu_filter_madgwick/imu_filter_madgwick_node", "imu_complementary_filter/complementary_filter_node"]
)
def test_the_nodes_publish_the_roll_of_a_sensor_at_rest(program: str, tmp_path: Path) -> None:
    (tmp_path / "talker.py").write_text(TALKER)
    with simkit.load("empty") as sim:
        sim.add_node(tmp_path / "talker.py")
        sim.add_node(program, params={"use_mag": False, "publish_tf": True})
        received: list[Any] = []
        transforms = sim.tf
        sim.subscribe("/imu/data", received.append)
        sim.run(1.0)
        sim.check_nodes()
        q = received[-1].orientation
        assert 2 * math.atan2(q.x, q.w) == pytest.approx(0.3, abs=5e-3)
        assert transforms.lookup("odom", "imu_link").quaternion[1] == pytest.approx(math.sin(0.15), abs=3e-3)
