"""Fields of topics stand for numbers, or it is said why they do not."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from simkit import msgs
from simkit.errors import InputError
from simkit.recording.charts.fields import curves_of

TOPICS = {
    "/odom": "nav_msgs/msg/Odometry",
    "/odom/raw": "nav_msgs/msg/Odometry",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/joint_states": "sensor_msgs/msg/JointState",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/imu": "sensor_msgs/msg/Imu",
    "/cmd_vel": "geometry_msgs/msg/Twist",
    "/on": "std_msgs/msg/Bool",
    "/said": "std_msgs/msg/String",
    "/clock": "rosgraph_msgs/msg/Clock",
    "/depth": "sensor_msgs/msg/Image",
}


def curves(text: str) -> Any:
    return curves_of(text, TOPICS, lambda _: msgs.type_store(), "the test", lambda _, path: f"<{path}>")


def number(text: str, message: Any) -> float:
    (found,) = curves(text)
    return float(found.read(message))


def labels(text: str) -> list[str]:
    return [c.label for c in curves(text)]


def test_a_field_is_found_with_dots_or_slashes_and_without_the_first_slash() -> None:
    message = msgs.make("nav_msgs/msg/Odometry", pose={"pose": {"position": {"x": 1.5}}})
    for text in ("/odom.pose.pose.position.x", "/odom/pose/pose/position/x", "odom.pose.pose.position.x"):
        assert number(text, message) == 1.5
    assert labels("/odom/raw.pose.pose.position.x") == ["/odom/raw.pose.pose.position.x"]


def test_a_small_vector_expands_to_its_components() -> None:
    assert labels("/odom.pose.pose.position") == [f"/odom.pose.pose.position.{a}" for a in "xyz"]
    assert labels("/imu.linear_acceleration_covariance[0:2]") == [
        "/imu.linear_acceleration_covariance[0]",
        "/imu.linear_acceleration_covariance[1]",
    ]
    assert len(labels("/imu.orientation_covariance")) == 9
    assert labels("/on") == ["/on.data"]


def test_the_pixels_of_a_picture_are_depths_or_grey_values() -> None:
    depths = msgs.image_message(np.array([[1.5, np.inf], [2.5, 4.0]], np.float32), "32FC1")
    assert number("/depth.pixels.min", depths) == 1.5
    assert number("/depth.pixels[1][0]", depths) == 2.5
    assert math.isnan(number("/depth.pixels[2][0]", depths))
    colours = msgs.image_message(np.array([[[30, 60, 90]]], np.uint8), "rgb8")
    assert number("/depth.pixels.mean", colours) == 60.0
    with pytest.raises(InputError, match=r"pixels is an array of rows; give an item or a range, such as pixels\[0\]"):
        curves("/depth.pixels")
    with pytest.raises(InputError, match="did you mean 'pixels'"):
        curves("/depth.pixel")


@pytest.mark.parametrize(("angle", "value"), [("roll", 0.3), ("pitch", -0.7), ("yaw", 2.9)])
def test_a_quaternion_has_angles_about_fixed_axes(angle: str, value: float) -> None:
    r, p, y = 0.15, -0.35, 1.45  # half of each
    q = {
        "w": math.cos(r) * math.cos(p) * math.cos(y) + math.sin(r) * math.sin(p) * math.sin(y),
        "x": math.sin(r) * math.cos(p) * math.cos(y) - math.cos(r) * math.sin(p) * math.sin(y),
        "y": math.cos(r) * math.sin(p) * math.cos(y) + math.sin(r) * math.cos(p) * math.sin(y),
        "z": math.cos(r) * math.cos(p) * math.sin(y) - math.sin(r) * math.sin(p) * math.cos(y),
    }
    message = msgs.make("nav_msgs/msg/Odometry", pose={"pose": {"orientation": q}})
    assert number(f"/odom.pose.pose.orientation.{angle}", message) == pytest.approx(value, abs=1e-12)
    assert number(f"/odom.pose.pose.{angle}", message) == pytest.approx(value, abs=1e-12)
    assert curves(f"/odom.pose.pose.{angle}")[0].unit == "rad"


def test_items_have_numbers_or_names() -> None:
    joints = msgs.make("sensor_msgs/msg/JointState", name=["left", "right"], position=[1.0, 2.0])
    assert number("/joint_states.position[right]", joints) == 2.0
    assert number("/joint_states.position[-2]", joints) == 1.0
    assert math.isnan(number("/joint_states.position[middle]", joints))
    assert math.isnan(number("/joint_states.velocity[right]", joints))
    frames = msgs.make(
        "tf2_msgs/msg/TFMessage",
        transforms=[
            msgs.make(
                "geometry_msgs/msg/TransformStamped", child_frame_id="base", transform={"translation": {"x": 3.0}}
            )
        ],
    )
    assert number("/tf.transforms[base].transform.translation.x", frames) == 3.0
    assert math.isnan(number("/tf.transforms[arm].transform.translation.x", frames))


def test_arrays_have_minimum_maximum_and_mean_of_their_finite_items() -> None:
    scan = msgs.make("sensor_msgs/msg/LaserScan", ranges=[2.0, math.inf, 1.0])
    found = {name: number(f"/scan.ranges.{name}", scan) for name in ("min", "max", "mean", "length")}
    assert found == {"min": 1.0, "max": 2.0, "mean": 1.5, "length": 3.0}
    assert math.isnan(number("/scan.ranges.min", msgs.make("sensor_msgs/msg/LaserScan")))
    assert curves("/scan.ranges.min")[0].unit == "<ranges>" and curves("/scan.ranges[3]")[0].unit == "<ranges>"


def test_times_are_seconds_and_vectors_have_a_length() -> None:
    clock = msgs.make("rosgraph_msgs/msg/Clock", clock={"sec": 2, "nanosec": 500_000_000})
    assert number("/clock.clock", clock) == 2.5
    twist = msgs.make("geometry_msgs/msg/Twist", linear={"x": 3.0, "y": 4.0})
    assert number("/cmd_vel.linear.norm", twist) == 5.0


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        ("/odm.pose", "SK-CLI-030", "did you mean '/odom'"),
        ("/odom.pose.pose.positon.x", "SK-CLI-033", "did you mean 'position'"),
        ("/odom.pose.pose.position.x.y", "SK-CLI-033", "is a number and has no 'y'"),
        ("/odom.pose.pose.yaw.x", "SK-CLI-033", "is a number"),
        ("/odom.pose.pose[0]", "SK-CLI-033", "not an array"),
        ("/odom.pose.covariance[36]", "SK-CLI-033", "36 items"),
        ("/odom..", "SK-BAG-010", "its fields: "),
        ("/odom.pose.pose.position.[x", "SK-CLI-033", "is not a field path"),
        ("/odom.header.frame_id", "SK-BAG-010", "a text"),
        ("/odom", "SK-BAG-010", "its fields: "),
        ("/said.data", "SK-BAG-010", "a text"),
        ("/scan.ranges", "SK-BAG-010", "ranges[0:10]"),
        ("/scan.ranges[2:]", "SK-BAG-010", "has no end"),
        ("/scan.ranges[0:1000]", "SK-BAG-010", "the limit is 64"),
        ("/scan.ranges[front]", "SK-CLI-033", "have no names"),
        ("/tf.transforms[base]", "SK-BAG-010", "its fields: "),
        ("", "SK-CLI-030", "no topic '/'"),
    ],
)
def test_a_field_that_is_not_a_number_is_reported(text: str, code: str, words: str) -> None:
    with pytest.raises(InputError, match=code) as told:
        curves(text)
    assert words in str(told.value)
