"""Images, point clouds and poses of messages become arrays and numbers, and the other way round."""

from __future__ import annotations

import math
from typing import Any

import cv2
import numpy as np
import pytest

import simkit
from simkit import msgs
from simkit.errors import ArgumentTypeError, ArgumentValueError, MessageError
from simkit.sensors.cameras.image_messages import colour_message

HEAD = msgs.header(1_500_000_000, "eye")
RED, GREEN, BLUE, WHITE = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)
SQUARES = np.kron(
    np.array([[RED, GREEN], [BLUE, WHITE]], np.uint8), np.ones((4, 4, 1), np.uint8)
)  # 8 × 8 pixels, a colour in each quarter


@pytest.mark.parametrize("encoding", ["rgb8", "bgr8", "rgba8", "bgra8", "rgb16", "bgr16", "32FC3"])
def test_every_colour_encoding_of_a_camera_gives_red_green_blue(encoding: str) -> None:
    found = msgs.image(colour_message(HEAD, SQUARES, encoding))
    white = {"6": 65535, "3": 1.0}.get(encoding[-1], 255)
    assert found.shape == (8, 8, 4 if "a" in encoding else 3)
    assert found[0, 0, :3].tolist() == [white, 0, 0]
    assert found[7, 0, :3].tolist() == [0, 0, white]


@pytest.mark.parametrize("pattern", ["rggb", "bggr", "gbrg", "grbg"])
def test_a_bayer_image_has_its_colours_again(pattern: str) -> None:
    large = np.kron(SQUARES, np.ones((4, 4, 1), np.uint8))
    found = msgs.image(colour_message(HEAD, large, f"bayer_{pattern}8"))
    assert found.shape == (32, 32, 3)
    assert [found[y, x].tolist() for y, x in ((8, 8), (8, 24), (24, 8), (24, 24))] == [
        list(colour) for colour in (RED, GREEN, BLUE, WHITE)
    ]


@pytest.mark.parametrize(
    "encoding, values",
    [("mono8", np.uint8([[1, 2, 3]])), ("16UC1", np.uint16([[700, 0, 9]])), ("32FC1", np.float32([[0.5, np.inf, 2]]))],
)
def test_one_channel_is_an_array_of_two_dimensions(encoding: str, values: Any) -> None:
    message = msgs.image_message(values, encoding, HEAD)
    found = msgs.image(message)
    assert found.dtype == values.dtype and np.array_equal(found, values)
    assert message.header.frame_id == "eye" and message.step == values.nbytes
    found[:] = 0
    assert np.array_equal(msgs.image(message), values)  # the array is a copy
    assert np.array_equal(msgs.image(msgs.deserialize(msgs.serialize(message), "sensor_msgs/Image")), values)


def test_rows_with_padding_and_big_endian_numbers_are_read() -> None:
    rows = np.zeros((2, 6), np.uint8)
    rows[:, :4] = np.array([[1, 2], [300, 4]], ">u2").view(np.uint8)
    fields = {"height": 2, "width": 2, "encoding": "mono16", "is_bigendian": 1, "step": 6, "data": rows.ravel()}
    assert msgs.image(msgs.make("sensor_msgs/msg/Image", **fields)).tolist() == [[1, 2], [300, 4]]


def test_packed_yuv_is_converted() -> None:
    grey = np.full((2, 4, 2), 128, np.uint8)
    fields = {"height": 2, "width": 4, "encoding": "yuv422", "step": 8, "data": grey.ravel()}
    found = msgs.image(msgs.make("sensor_msgs/msg/Image", **fields))
    assert found.shape == (2, 4, 3) and int(np.ptp(found)) == 0


@pytest.mark.parametrize("ending, error", [("png", 0), ("jpeg", 12)])
def test_a_compressed_image_has_red_green_blue_too(ending: str, error: int) -> None:
    large = np.kron(SQUARES, np.ones((4, 4, 1), np.uint8))
    data = cv2.imencode(f".{ending}", large[:, :, ::-1])[1].ravel()
    message = msgs.make("sensor_msgs/msg/CompressedImage", format=f"rgb8; {ending} compressed bgr8", data=data)
    found = msgs.image(message).astype(int)
    assert np.abs(found[4:12, 4:12] - RED).max() <= error


def test_a_compressed_depth_image_has_metres() -> None:
    scale, offset = 100.0, -1.0
    inverse = np.uint16([[scale / 2.0 + offset, 0]])  # 2 m, and an unknown depth
    head = np.int32([0]).tobytes() + np.float32([scale, offset]).tobytes()
    data = np.frombuffer(head + cv2.imencode(".png", inverse)[1].tobytes(), np.uint8)
    message = msgs.make("sensor_msgs/msg/CompressedImage", format="32FC1; compressedDepth png", data=data)
    found = msgs.image(message)
    assert found.dtype == np.float32 and found[0, 0] == pytest.approx(2.0) and math.isnan(found[0, 1])


def test_the_points_of_a_cloud_are_fields_of_an_array() -> None:
    layout = {"names": ["x", "y", "i"], "formats": ["<f4", "<f4", "<u2"], "offsets": [0, 4, 10], "itemsize": 16}
    cloud = np.zeros(3, np.dtype(layout))
    cloud["x"], cloud["y"], cloud["i"] = [1, 2, np.nan], [4, 5, 6], [7, 8, 9]
    fields = [
        {"name": "x", "offset": 0, "datatype": 7, "count": 1},
        {"name": "y", "offset": 4, "datatype": 7, "count": 1},
        {"name": "i", "offset": 10, "datatype": 4, "count": 1},
    ]
    size = {"height": 1, "width": 3, "point_step": 16, "row_step": 48}
    message = msgs.make("sensor_msgs/msg/PointCloud2", **size, fields=fields, data=cloud.view(np.uint8))
    found = msgs.points(message)
    assert found.dtype.names == ("x", "y", "i") and found["i"].tolist() == [7, 8, 9]
    assert found["x"][:2].tolist() == [1.0, 2.0] and math.isnan(found["x"][2])
    fields[2]["count"] = 4_000_000_000
    with pytest.raises(ArgumentValueError, match="4000000000 values in a point of 16 bytes"):
        msgs.points(msgs.make("sensor_msgs/msg/PointCloud2", **size, fields=fields, data=cloud.view(np.uint8)))


POSE = simkit.Pose.from_rpy(1.0, 2.0, 3.0, 0.1, -0.2, 0.3)
PLANAR = simkit.Pose.from_rpy(1.0, 2.0, 0.0, 0.0, 0.0, 0.3)


@pytest.mark.parametrize(
    "type_name",
    [f"geometry_msgs/msg/{name}" for name in ("Pose", "PoseStamped", "PoseWithCovariance", "PoseWithCovarianceStamped",
                                              "Transform", "TransformStamped")] + ["nav_msgs/msg/Odometry"],
)  # fmt: skip
def test_a_pose_is_the_same_after_a_message_of_any_type(type_name: str) -> None:
    message = msgs.pose_message(POSE, type_name)
    assert msgs.type_name(message) == type_name
    assert msgs.pose(message) == POSE
    assert msgs.yaw(message) == pytest.approx(0.3)


def test_planar_poses_headers_and_child_frames() -> None:
    assert msgs.pose(msgs.pose_message(PLANAR, msgs.Pose2D)).rpy[2] == pytest.approx(0.3)
    stamped = msgs.pose_message(POSE, "geometry_msgs/msg/TransformStamped", HEAD, "robot")
    assert (stamped.header.frame_id, stamped.child_frame_id) == ("eye", "robot")
    with pytest.raises(MessageError, match="has no field 'header'"):
        msgs.pose_message(POSE, header=HEAD)


def test_a_message_without_fields_names_none() -> None:
    with pytest.raises(MessageError, match="std_msgs/msg/Empty has no field 'data'; its fields: none"):
        msgs.make("std_msgs/msg/Empty", data=1)


def test_yaw_takes_quaternions_of_any_length() -> None:
    half = math.radians(170) / 2
    rotation = msgs.make("geometry_msgs/msg/Quaternion", w=5 * math.cos(half), z=-5 * math.sin(half))
    assert msgs.yaw(rotation) == pytest.approx(math.radians(-170))
    assert msgs.yaw(POSE) == pytest.approx(0.3)


def test_a_stamp_is_the_time_of_the_simulation() -> None:
    with simkit.load("empty") as sim:
        sim.run(1.25)
        assert msgs.stamp_ns(msgs.stamp(sim)) == sim.time_ns == 1_250_000_000


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: msgs.image(HEAD), "the image must be a sensor_msgs/msg/Image or CompressedImage, got Header"),
        (lambda: msgs.points(None), "the point cloud must be a sensor_msgs/msg/PointCloud2, got None"),
        (lambda: msgs.pose(msgs.make("geometry_msgs/msg/Twist")), "must be a message with a pose"),
        (lambda: msgs.pose(msgs.type_of("geometry_msgs/msg/Pose")), "must be a message with a pose"),
        (lambda: msgs.yaw((1, 0, 0, 0)), "must be a quaternion message"),
        (lambda: msgs.pose_message(POSE, "geometry_msgs/msg/Twist"), "must be that of a message with a pose"),
        (lambda: msgs.pose_message((0, 0, 0)), "a pose is a simkit.Pose"),  # type: ignore[arg-type]
        (lambda: msgs.stamp(3), "a stamp needs a simulation, got int"),  # type: ignore[arg-type]
    ],
)
def test_a_wrong_kind_is_refused(call: Any, message: str) -> None:
    with pytest.raises(ArgumentTypeError, match=message):
        call()


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: msgs.image(msgs.make("sensor_msgs/msg/Image", encoding="rgb7")), "unknown encoding 'rgb7'"),
        (lambda: msgs.image(msgs.make("sensor_msgs/msg/Image", encoding="rgb8", height=9, width=9)), "has 0 bytes"),
        (lambda: msgs.image(msgs.make("sensor_msgs/msg/CompressedImage", format="png")), "'png' cannot be decoded"),
        (lambda: msgs.image_message(SQUARES, "mono8"), "of mono8 must be uint8 of shape"),
        (lambda: msgs.pose(msgs.make("geometry_msgs/msg/Pose", orientation={"w": 0})), "different from zero"),
        (lambda: msgs.pose(msgs.make("geometry_msgs/msg/Pose", position={"y": math.nan})), "3 finite numbers"),
    ],
)
def test_a_value_that_does_not_fit_is_refused(call: Any, message: str) -> None:
    with pytest.raises(ArgumentValueError, match=message):
        call()
