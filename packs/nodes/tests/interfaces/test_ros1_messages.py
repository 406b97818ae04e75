"""Classes of ROS 1 messages behave in programs as those of genpy do."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from interface_tools import imports_of

from simkit import msgs
from simkit_nodes.interfaces import ROS1
from simkit_nodes.interfaces.ros1_message import SerializationError
from simkit_nodes.interfaces.ros1_time import Duration, Time


def new(type_name: str, *args: Any, **fields: Any) -> Any:
    return ROS1.message_class(type_name)(*args, **fields)


def sent(message: Any) -> Any:
    return ROS1.to_simkit(message._ros_type)(message)


def test_a_message_is_created_with_all_fields_or_with_keywords() -> None:
    point = new("geometry_msgs/msg/Point", 1, 2, 3)
    assert (point.x, point.y, point.z) == (1, 2, 3)
    assert new("geometry_msgs/msg/Point", y=2).x == 0.0
    with pytest.raises(TypeError, match="Invalid number of arguments"):
        new("geometry_msgs/msg/Point", 1, 2)
    with pytest.raises(TypeError, match="args OR keywords, not both"):
        new("geometry_msgs/msg/Point", 1, 2, 3, x=1)
    with pytest.raises(AttributeError, match="w is not an attribute of Point"):
        new("geometry_msgs/msg/Point", w=1)


def test_a_definition_has_no_default_values() -> None:
    assert new("geometry_msgs/msg/Quaternion").w == 0.0


def test_a_header_has_seq_and_a_stamp_that_computes() -> None:
    header = new("std_msgs/msg/Header")
    assert (header.seq, header.stamp, header.__slots__) == (0, Time(), ["seq", "stamp", "frame_id"])
    header.stamp = Time.from_sec(1.5) + Duration(2)
    assert header.stamp.to_sec() == 3.5
    assert sent(header).stamp == msgs.time(3_500_000_000)


def test_fields_have_the_names_of_ros_1() -> None:
    message = msgs.make("sensor_msgs/msg/CameraInfo", k=np.arange(9.0))
    info = ROS1.to_program("sensor_msgs/msg/CameraInfo")(message)
    assert info.K[8] == 8.0 and isinstance(info.K, tuple)
    assert sent(info).k[8] == 8.0


def test_numbers_arrive_as_tuples_and_octets_as_bytes() -> None:
    scan = ROS1.to_program("sensor_msgs/msg/LaserScan")(msgs.make("sensor_msgs/msg/LaserScan", ranges=[1.0, 2.0]))
    assert scan.ranges == (1.0, 2.0)
    image = ROS1.to_program("sensor_msgs/msg/Image")(msgs.make("sensor_msgs/msg/Image", data=[1, 2]))
    assert image.data == b"\x01\x02"


def test_values_of_other_types_are_converted_when_the_message_is_sent() -> None:
    twist = new("geometry_msgs/msg/Twist")
    twist.linear.x = 1
    twist.angular.z = np.float32(0.5)
    assert (sent(twist).linear.x, sent(twist).angular.z) == (1.0, 0.5)
    assert sent(new("sensor_msgs/msg/LaserScan", ranges=np.ones(3))).ranges.dtype == np.float32
    assert sent(new("sensor_msgs/msg/LaserScan", ranges=(1, 2))).ranges.tolist() == [1.0, 2.0]
    assert sent(new("sensor_msgs/msg/Image", data=[1, 2])).data.tolist() == [1, 2]
    assert sent(new("std_msgs/msg/Bool", 1)).data is True


@pytest.mark.parametrize(
    ("type_name", "field", "value", "text"),
    [
        ("geometry_msgs/msg/Vector3", "x", "1", "field x must be float type"),
        ("std_msgs/msg/Int8", "data", 1.5, "field data must be an integer type"),
        ("std_msgs/msg/UInt8", "data", 256, r"field data exceeds specified width \[uint8\]"),
        ("std_msgs/msg/String", "data", 5, "field data must be of type bytes or an ascii string"),
        ("geometry_msgs/msg/Twist", "linear", None, r"field linear must be of type \[geometry_msgs/Vector3\]"),
        ("std_msgs/msg/Header", "stamp", 1.0, "field stamp must be of type Time"),
        ("sensor_msgs/msg/LaserScan", "ranges", [None], r"field ranges\[\] must be float type"),
        ("sensor_msgs/msg/JointState", "name", [1], r"field name\[\] must be of type bytes or an ascii string"),
        ("sensor_msgs/msg/Imu", "orientation_covariance", [0.0], "pack expected 9 items for packing"),
        ("nav_msgs/msg/Path", "poses", [None], r"field poses\[\] must be of type \[geometry_msgs/PoseStamped\]"),
    ],
)
def test_a_value_that_does_not_match_its_field_is_refused_when_the_message_is_sent(
    type_name: str, field: str, value: object, text: str
) -> None:
    message = new(type_name)
    setattr(message, field, value)
    with pytest.raises(SerializationError, match=text):
        sent(message)


def test_an_error_in_a_nested_message_names_its_path() -> None:
    path = new("nav_msgs/msg/Path", poses=[new("geometry_msgs/msg/PoseStamped")])
    path.poses[0].pose.position.x = "1"
    with pytest.raises(SerializationError, match=r"field poses\[\].pose.position.x must be float type"):
        sent(path)


def test_a_message_prints_as_in_ros_1() -> None:
    stamped = new("geometry_msgs/msg/PointStamped")
    stamped.header.frame_id = "map"
    assert str(stamped).split("\n") == [
        "header: ",
        "  seq: 0",
        "  stamp: ",
        "    secs: 0",
        "    nsecs:         0",
        '  frame_id: "map"',
        "point: ",
        "  x: 0.0",
        "  y: 0.0",
        "  z: 0.0",
    ]
    assert str(new("std_msgs/msg/Float64MultiArray", data=[1.0])).endswith("data: [1.0]")


def test_messages_can_be_compared_copied_and_pickled() -> None:
    scan = new("sensor_msgs/msg/LaserScan", ranges=[1.0])
    assert scan == new("sensor_msgs/msg/LaserScan", ranges=(1.0,))
    assert scan != new("sensor_msgs/msg/LaserScan")
    assert copy.deepcopy(scan) == scan == pickle.loads(pickle.dumps(scan))


def test_a_service_has_two_classes_and_an_action_seven() -> None:
    with imports_of(ROS1):
        from actionlib_tutorials.msg import (  # type: ignore[import-not-found]
            FibonacciAction,
            FibonacciActionGoal,
            FibonacciGoal,
        )
        from std_srvs.srv import SetBool, SetBoolRequest, SetBoolResponse  # type: ignore[import-not-found]
    assert (SetBool._request_class, SetBool._response_class) == (SetBoolRequest, SetBoolResponse)
    assert SetBoolRequest(True).data is True and SetBoolResponse(success=True).message == ""
    assert type(FibonacciAction().action_goal) is FibonacciActionGoal
    assert FibonacciActionGoal(goal=FibonacciGoal(order=3)).goal.order == 3
    assert (FibonacciGoal._type, FibonacciAction._type) == (
        "actionlib_tutorials/FibonacciGoal",
        "actionlib_tutorials/FibonacciAction",
    )


def test_times_compute_as_in_ros_1() -> None:
    assert Time(5) - Time(3, 500_000_000) == Duration(1, 500_000_000)
    assert Duration(3) / Duration(2) == 1.5 and (Duration(3) * 0.5).to_sec() == 1.5
    assert Time(2) > Time(1) and Duration(-1, 0) < Duration(0) and not Duration(0)
    assert repr(Time(1, 5)) == "genpy.Time[1000000005]"
    assert {Time(1): "a"}[Time.from_sec(1.0)] == "a"
    with pytest.raises(TypeError, match="time values must be positive"):
        Time(-1)
    with pytest.raises(TypeError, match="cannot compare to non-Time"):
        assert Time(1) < Duration(2)
