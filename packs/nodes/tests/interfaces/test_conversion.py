"""Messages of simkit and of programs are converted into each other, and share no memory."""

from __future__ import annotations

import math
from array import array
from typing import Any

import numpy as np
import pytest

from simkit import msgs
from simkit.msgs.message_types import message_type_names
from simkit_nodes.interfaces import ROS1, ROS2, MessageFlavour


def both_ways(type_name: str, flavour: MessageFlavour, message: msgs.Message) -> msgs.Message:
    return flavour.to_simkit(type_name)(flavour.to_program(type_name)(message))


@pytest.mark.slow
@pytest.mark.parametrize("flavour", [ROS2, ROS1], ids=["ROS 2", "ROS 1"])
def test_every_type_survives_the_way_to_a_program_and_back(flavour: MessageFlavour) -> None:
    for name in message_type_names():
        message = msgs.make(name)
        assert msgs.serialize(both_ways(name, flavour, message)) == msgs.serialize(message), name


def test_a_new_message_of_a_program_has_the_defaults_of_the_definition() -> None:
    for name in message_type_names():
        message = ROS2.to_simkit(name)(ROS2.message_class(name)())
        assert msgs.serialize(message) == msgs.serialize(msgs.make(name)), name


def scan() -> Any:
    return msgs.make(
        "sensor_msgs/msg/LaserScan",
        header={"stamp": {"sec": 3, "nanosec": 5}, "frame_id": "lidar"},
        angle_min=-0.1,
        ranges=[1.0, math.inf, 2.5],
    )


def test_a_program_gets_numbers_texts_and_arrays() -> None:
    message = ROS2.to_program("sensor_msgs/msg/LaserScan")(scan())
    assert (message.header.stamp.sec, message.header.stamp.nanosec, message.header.frame_id) == (3, 5, "lidar")
    assert message.ranges == array("f", [1.0, math.inf, 2.5])


def test_a_number_of_single_precision_is_rounded_as_on_its_way_through_ros() -> None:
    message = ROS2.to_program("sensor_msgs/msg/LaserScan")(scan())
    assert message.angle_min == float(np.float32(-0.1)) != -0.1
    message.angle_max = 0.1
    assert ROS2.to_simkit("sensor_msgs/msg/LaserScan")(message).angle_max == float(np.float32(0.1))


def test_a_change_of_a_programs_message_changes_no_other_message() -> None:
    original = scan()
    convert = ROS2.to_program("sensor_msgs/msg/LaserScan")
    first, second = convert(original), convert(original)
    first.ranges[0] = 9.0
    first.header.frame_id = "other"
    assert (original.ranges[0], second.ranges[0], second.header.frame_id) == (1.0, 1.0, "lidar")
    sent = ROS2.to_simkit("sensor_msgs/msg/LaserScan")(second)
    second.ranges[0] = 7.0
    assert sent.ranges[0] == 1.0


def test_a_covariance_is_copied_also_if_the_program_has_given_it_another_shape() -> None:
    odometry: Any = ROS2.message_class("nav_msgs/msg/Odometry")()
    odometry.pose.covariance = np.arange(36.0).reshape(6, 6)
    sent = ROS2.to_simkit("nav_msgs/msg/Odometry")(odometry)
    odometry.pose.covariance[0, 0] = 5.0
    np.testing.assert_array_equal(sent.pose.covariance, np.arange(36.0))


def test_arrays_that_are_no_block_of_memory_are_copied_too() -> None:
    message = scan()
    message.ranges = np.arange(6, dtype=np.float32)[::2]
    assert list(ROS2.to_program("sensor_msgs/msg/LaserScan")(message).ranges) == [0.0, 2.0, 4.0]


def test_an_object_that_a_program_appended_to_a_list_needs_the_attributes_of_the_items() -> None:
    marker: Any = ROS2.message_class("visualization_msgs/msg/Marker")()
    marker.points.append(ROS2.message_class("geometry_msgs/msg/Vector3")(x=2.0))
    assert ROS2.to_simkit("visualization_msgs/msg/Marker")(marker).points[0].x == 2.0
    path: Any = ROS2.message_class("nav_msgs/msg/Path")()
    path.poses.append(ROS2.message_class("geometry_msgs/msg/Pose")())
    with pytest.raises(AttributeError, match="'Pose' object has no attribute 'header'"):
        ROS2.to_simkit("nav_msgs/msg/Path")(path)
    joints: Any = ROS2.message_class("sensor_msgs/msg/JointState")()
    joints.name.append(1)
    with pytest.raises(TypeError, match="bad argument type for built-in operation"):
        ROS2.to_simkit("sensor_msgs/msg/JointState")(joints)


def test_a_sequence_that_a_program_has_made_longer_than_its_bound_is_refused() -> None:
    shape: Any = ROS2.message_class("shape_msgs/msg/SolidPrimitive")()
    shape.dimensions.extend([1.0] * 4)
    with pytest.raises(AssertionError, match="with length <= 3"):
        ROS2.to_simkit("shape_msgs/msg/SolidPrimitive")(shape)


def test_bytes_keep_their_value() -> None:
    message: Any = ROS2.message_class("std_msgs/msg/ByteMultiArray")(data=[b"\x01", b"\xff"])
    sent = ROS2.to_simkit("std_msgs/msg/ByteMultiArray")(message)
    assert sent.data.tolist() == [1, 255]
    assert ROS2.to_program("std_msgs/msg/ByteMultiArray")(sent).data == [b"\x01", b"\xff"]
    single: Any = ROS2.message_class("std_msgs/msg/Byte")(data=b"\xff")
    read = msgs.deserialize(msgs.serialize(ROS2.to_simkit("std_msgs/msg/Byte")(single)), "std_msgs/msg/Byte")
    assert ROS2.to_program("std_msgs/msg/Byte")(read).data == b"\xff"


def test_a_text_that_cannot_be_sent_is_an_error_of_the_program() -> None:
    with pytest.raises(UnicodeEncodeError):
        ROS2.to_simkit("std_msgs/msg/String")(ROS2.message_class("std_msgs/msg/String")(data="\ud800"))
