"""Images and point clouds in programs."""

from __future__ import annotations

import math
from array import array
from pathlib import Path

import cv2
import numpy as np
import pytest

import simkit
from simkit_nodes.image_encodings import encoding_of
from simkit_nodes.interfaces import ROS2
from simkit_nodes.message_arrays import (
    get_xyz_points,
    merge_rgb_fields,
    msgify,
    numpify,
    pointcloud2_to_array,
    split_rgb_field,
)
from simkit_nodes.ros_modules.cv_bridge import CvBridge, CvBridgeError
from simkit_nodes.ros_modules.cv_bridge.boost.cv_bridge_boost import cvtColor2
from simkit_nodes.ros_modules.laser_geometry import LaserProjection
from simkit_nodes.ros_modules.sensor_msgs_py import point_cloud2
from simkit_nodes.ros_modules.tf2_sensor_msgs import do_transform_cloud

Header = ROS2.message_class("std_msgs/msg/Header")
Image = ROS2.message_class("sensor_msgs/msg/Image")

COLORS = np.random.default_rng(3).integers(0, 256, (6, 8, 3), np.uint8)


@pytest.fixture
def bridge() -> CvBridge:
    return CvBridge()


# ---------------------------------------------------------------------- images


def test_an_image_is_the_same_after_its_way_through_a_message(bridge: CvBridge) -> None:
    header = Header(frame_id="camera")
    message = bridge.cv2_to_imgmsg(COLORS, "bgr8", header)
    assert (message.height, message.width, message.step, message.encoding) == (6, 8, 24, "bgr8")
    assert message.header == header
    assert isinstance(message.data, array)
    np.testing.assert_array_equal(bridge.imgmsg_to_cv2(message), COLORS)
    np.testing.assert_array_equal(bridge.imgmsg_to_cv2(message, "rgb8"), COLORS[..., ::-1])


@pytest.mark.parametrize("dtype", ["uint8", "int8", "uint16", "int16", "int32", "float32", "float64"])
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_every_type_of_opencv_has_an_encoding(bridge: CvBridge, dtype: str, channels: int) -> None:
    image = np.arange(5 * 7 * channels).reshape(5, 7, channels).astype(dtype)
    image = image[..., 0] if channels == 1 else image
    message = bridge.cv2_to_imgmsg(image)
    assert message.encoding == f"{bridge.numpy_type_to_cvtype[dtype]}C{channels}"
    back = bridge.imgmsg_to_cv2(message)
    assert back.dtype == dtype
    np.testing.assert_array_equal(back, image)


def test_without_conversion_the_array_shares_the_memory_of_the_message(bridge: CvBridge) -> None:
    message = bridge.cv2_to_imgmsg(COLORS, "bgr8")
    bridge.imgmsg_to_cv2(message)[0, 0] = 7
    assert list(message.data[:3]) == [7, 7, 7]
    copied = bridge.imgmsg_to_cv2(message, "bgr8")
    copied[0, 0] = 9
    assert message.data[0] == 7


def test_rows_may_have_padding_and_numbers_another_byte_order(bridge: CvBridge) -> None:
    message = Image(height=2, width=2, encoding="mono16", is_bigendian=1, step=6)
    message.data = array("B", [0, 1, 0, 2, 99, 99, 1, 0, 2, 0, 99, 99])
    np.testing.assert_array_equal(bridge.imgmsg_to_cv2(message), [[1, 2], [256, 512]])


@pytest.mark.parametrize(
    ("source", "target", "code"),
    [
        ("rgb8", "mono8", cv2.COLOR_RGB2GRAY),
        ("bgr8", "rgba8", cv2.COLOR_BGR2RGBA),
        ("bgr8", "bgra8", cv2.COLOR_BGR2BGRA),
    ],
)
def test_colours_are_converted_as_opencv_does(source: str, target: str, code: int) -> None:
    np.testing.assert_array_equal(cvtColor2(COLORS, source, target), cv2.cvtColor(COLORS, code))


@pytest.mark.parametrize("pattern", ["rggb", "bggr", "gbrg", "grbg"])
def test_a_bayer_image_of_one_colour_keeps_the_colour(pattern: str) -> None:
    values = {"r": 200, "g": 100, "b": 50}
    tile = np.array([[values[pattern[0]], values[pattern[1]]], [values[pattern[2]], values[pattern[3]]]], np.uint8)
    color = cvtColor2(np.tile(tile, (8, 8)), f"bayer_{pattern}8", "rgb8")
    assert color[8, 8].tolist() == [200, 100, 50]


def test_yuv_images_are_converted() -> None:
    grey = np.full((4, 4, 2), 128, np.uint8)
    for encoding in ("yuv422", "yuv422_yuy2"):
        assert cvtColor2(grey, encoding, "bgr8").shape == (4, 4, 3)
        assert abs(int(cvtColor2(grey, encoding, "mono8")[0, 0]) - 128) <= 2


def test_8_and_16_bits_are_scaled_and_other_numbers_are_not() -> None:
    grey = np.array([[0, 1, 255]], np.uint8)
    np.testing.assert_array_equal(cvtColor2(grey, "mono8", "mono16"), [[0, 257, 65535]])
    deep = np.array([[0, 128, 129, 65535]], np.uint16)
    np.testing.assert_array_equal(cvtColor2(deep, "mono16", "mono8"), [[0, 0, 1, 255]])
    np.testing.assert_array_equal(
        cvtColor2(np.array([[1.5, -3.0, 1e9]], np.float32), "32FC1", "16UC1"), [[2, 0, 65535]]
    )
    np.testing.assert_array_equal(cvtColor2(np.array([[1, 2]], np.uint16), "16UC1", "32FC1"), [[1.0, 2.0]])


@pytest.mark.parametrize(
    ("source", "target", "text"),
    [
        ("32FC1", "mono8", "[32FC1] is not a color format. but [mono8] is. The conversion does not make sense"),
        ("bgr8", "32FC1", "[bgr8] is a color format but [32FC1] is not so they must have the same OpenCV type"),
        ("8UC1", "8UC3", "[8UC1] and [8UC3] do not have the same number of channel"),
        ("bgr8", "bayer_rggb8", "Unsupported conversion from [bgr8] to [bayer_rggb8]"),
        ("bgr8", "color", "Unrecognized image encoding [color]"),
    ],
)
def test_conversions_without_meaning_are_errors_of_the_bridge(
    bridge: CvBridge, source: str, target: str, text: str
) -> None:
    known = encoding_of(source)
    shape = (4, 4) if known.channels == 1 else (4, 4, known.channels)
    message = bridge.cv2_to_imgmsg(np.zeros(shape, known.dtype), source)
    with pytest.raises(CvBridgeError) as caught:
        bridge.imgmsg_to_cv2(message, target)
    assert text in str(caught.value)


def test_an_array_of_another_type_than_its_encoding_is_an_error(bridge: CvBridge) -> None:
    with pytest.raises(CvBridgeError, match="encoding specified as mono8, but image has incompatible type 8UC3"):
        bridge.cv2_to_imgmsg(COLORS, "mono8")
    with pytest.raises(TypeError, match="Your input type is not a numpy array"):
        bridge.cv2_to_imgmsg([[1, 2]])
    with pytest.raises(CvBridgeError, match=r"Unrecognized image encoding \[nothing\]"):
        bridge.cv2_to_imgmsg(COLORS, "nothing")


def test_compressed_images(bridge: CvBridge) -> None:
    message = bridge.cv2_to_compressed_imgmsg(COLORS, "png")
    assert message.format == "png"
    np.testing.assert_array_equal(bridge.compressed_imgmsg_to_cv2(message), COLORS)
    np.testing.assert_array_equal(bridge.compressed_imgmsg_to_cv2(message, "rgb8"), COLORS[..., ::-1])


# ---------------------------------------------------------------------- point clouds

POINTS = [(1.0, 2.0, 3.0), (4.0, math.nan, 6.0), (7.0, 8.0, 9.0)]


def test_a_cloud_of_points_is_read_again() -> None:
    cloud = point_cloud2.create_cloud_xyz32(Header(frame_id="laser"), POINTS)
    assert (cloud.width, cloud.height, cloud.point_step, cloud.row_step) == (3, 1, 12, 36)
    points = point_cloud2.read_points(cloud)
    assert points.dtype.names == ("x", "y", "z")
    assert points["z"].tolist() == [3.0, 6.0, 9.0]
    assert point_cloud2.read_points(cloud, ["x"], skip_nans=True).tolist() == [(1.0,), (4.0,), (7.0,)]
    assert point_cloud2.read_points_numpy(cloud, skip_nans=True).tolist() == [[1.0, 2.0, 3.0], [7.0, 8.0, 9.0]]
    assert point_cloud2.read_points_list(cloud, ["x", "z"], uvs=[2])[0]._asdict() == {"x": 7.0, "z": 9.0}


def test_points_may_have_gaps_and_fields_of_several_numbers() -> None:
    field = point_cloud2.PointField
    fields = [
        field(name="x", offset=0, datatype=field.FLOAT32, count=1),
        field(name="id", offset=8, datatype=field.UINT16, count=2),
    ]
    cloud = point_cloud2.create_cloud(Header(), fields, [(0.5, 1, 2), (1.5, 3, 4)], point_step=16)
    points = point_cloud2.read_points(cloud)
    assert cloud.point_step == 16
    assert points["id_1"].tolist() == [2, 4]
    with pytest.raises(AssertionError, match="same datatype"):
        point_cloud2.read_points_numpy(cloud)


def test_a_cloud_may_have_rows() -> None:
    grid = np.arange(2 * 4 * 3, dtype=np.float32).reshape(2, 4, 3)
    cloud = point_cloud2.create_cloud_xyz32(Header(), grid)
    assert (cloud.width, cloud.height) == (2, 4)
    assert point_cloud2.read_points(cloud, reshape_organized_cloud=True).shape == (2, 4)


def test_another_message_is_no_cloud() -> None:
    with pytest.raises(AssertionError, match=r"Cloud is not a sensor_msgs.msg.PointCloud2"):
        point_cloud2.read_points(Header())


def test_a_cloud_in_another_frame_keeps_its_other_fields() -> None:
    field = point_cloud2.PointField
    fields = [field(name=n, offset=4 * i, datatype=field.FLOAT32, count=1) for i, n in enumerate(("x", "y", "z", "i"))]
    cloud = point_cloud2.create_cloud(Header(frame_id="laser"), fields, [(1.0, 0.0, 0.0, 5.0)])
    transform = ROS2.message_class("geometry_msgs/msg/TransformStamped")()
    transform.header.frame_id = "base"
    transform.transform.translation.x = 2.0
    transform.transform.rotation.z = transform.transform.rotation.w = 0.5**0.5
    moved = do_transform_cloud(cloud, transform)
    assert moved.header.frame_id == "base"
    np.testing.assert_allclose(point_cloud2.read_points_numpy(moved), [[2.0, 1.0, 0.0, 5.0]], atol=1e-6)


def test_a_scan_becomes_a_cloud_of_its_valid_points() -> None:
    scan = ROS2.message_class("sensor_msgs/msg/LaserScan")(
        angle_min=0.0, angle_increment=math.pi / 2, range_min=0.1, range_max=5.0, ranges=[1.0, 2.0, math.inf]
    )
    points = point_cloud2.read_points(LaserProjection().projectLaser(scan))
    assert points.dtype.names == ("x", "y", "z", "index")
    np.testing.assert_allclose(points["y"], [0.0, 2.0], atol=1e-6)
    assert points["index"].tolist() == [0, 1]


# ---------------------------------------------------------------------- ros2_numpy


def test_messages_become_arrays_and_messages_again() -> None:
    pose = ROS2.message_class("geometry_msgs/msg/Pose")()
    pose.position.x = 3.0
    pose.orientation.z = pose.orientation.w = 0.5**0.5
    back = msgify(type(pose), numpify(pose))
    assert back.position == pose.position
    assert back.orientation.z == pytest.approx(pose.orientation.z)
    image = msgify(Image, COLORS, encoding="rgb8")
    np.testing.assert_array_equal(numpify(image), COLORS)
    with pytest.raises(ValueError, match="Unable to convert message Header"):
        numpify(Header())


def test_colours_of_a_cloud_are_split_and_merged() -> None:
    columns = [
        ("x", np.float32),
        ("y", np.float32),
        ("z", np.float32),
        ("r", np.uint8),
        ("g", np.uint8),
        ("b", np.uint8),
    ]
    points = np.array([(1, 2, 3, 10, 20, 30), (4, 5, math.inf, 40, 50, 60)], columns)
    cloud = msgify(point_cloud2.PointCloud2, merge_rgb_fields(points))
    back = split_rgb_field(pointcloud2_to_array(cloud))
    assert back["g"].tolist() == [20, 50]
    assert not cloud.is_dense
    assert get_xyz_points(back).tolist() == [[1.0, 2.0, 3.0]]


def test_a_program_of_ros_1_gets_messages_of_ros_1(sim: simkit.Simulation, tmp_path: Path) -> None:
    file = tmp_path / "program.py"
    file.write_text(
        """
import numpy as np
import rospy
import ros_numpy
from cv_bridge import CvBridge
from sensor_msgs.msg import Image

message = CvBridge().cv2_to_imgmsg(np.full((2, 3), 7, np.uint8), "mono8")
print(isinstance(message, Image), type(message.data).__name__, message.header.seq)
print(CvBridge().imgmsg_to_cv2(message, "bgr8").tolist()[0][0])
image = ros_numpy.msgify(Image, np.zeros((1, 1), np.uint8), "mono8")
print(ros_numpy.numpify(message).tolist(), type(image.data).__name__)
"""
    )
    node = sim.add_node(file)
    sim.step(1)
    assert node.error is None, "\n".join(node.log)
    assert node.log == ["True bytes 0", "[7, 7, 7]", "[[7, 7, 7], [7, 7, 7]] bytes"]
