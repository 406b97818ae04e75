"""Classes of ROS 2 messages, services and actions behave in programs as those of rclpy do."""

from __future__ import annotations

import copy
import pickle
from array import array
from typing import Any

import numpy as np
import pytest
from interface_tools import imports_of

from simkit_nodes.interfaces import ROS2, type_name_of
from simkit_nodes.interfaces.slot_types import BasicType, NamespacedType, UnboundedSequence


def new(type_name: str, **fields: Any) -> Any:
    return ROS2.message_class(type_name)(**fields)


def test_a_message_is_created_with_keywords_and_defaults() -> None:
    point = new("geometry_msgs/msg/Point", y=2.0)
    assert (point.x, point.y, point.z) == (0.0, 2.0, 0.0)
    assert new("geometry_msgs/msg/Pose").orientation.w == 1.0
    assert repr(point) == "geometry_msgs.msg.Point(x=0.0, y=2.0, z=0.0)"


def test_positional_arguments_and_unknown_keywords_are_refused() -> None:
    with pytest.raises(TypeError, match="takes 1 positional argument but 2 were given"):
        ROS2.message_class("geometry_msgs/msg/Point")(1.0)
    with pytest.raises(AssertionError, match="Invalid arguments passed to constructor: a, w"):
        new("geometry_msgs/msg/Point", w=1.0, a=2)


def test_an_unknown_attribute_is_refused() -> None:
    with pytest.raises(AttributeError, match="'Twist' object has no attribute 'linear_x'"):
        new("geometry_msgs/msg/Twist").linear_x = 1.0


@pytest.mark.parametrize(
    ("type_name", "field", "value", "text"),
    [
        ("geometry_msgs/msg/Point", "x", 1, "The 'x' field must be of type 'float'"),
        ("geometry_msgs/msg/Point", "x", np.float32(1), "The 'x' field must be of type 'float'"),
        ("geometry_msgs/msg/Twist", "linear", None, "The 'linear' field must be a sub message of type 'Vector3'"),
        ("std_msgs/msg/Int8", "data", 128, r"The 'data' field must be an integer in \[-128, 127\]"),
        ("std_msgs/msg/UInt8", "data", -1, r"The 'data' field must be an unsigned integer in \[0, 255\]"),
        ("std_msgs/msg/String", "data", 5, "The 'data' field must be of type 'str'"),
        ("std_msgs/msg/Float32", "data", 1e39, r"The 'data' field must be a float in \[-3.402823466e\+38, "),
        ("std_msgs/msg/Byte", "data", 1, "The 'data' field must be of type 'bytes' or 'ByteString' with length 1"),
        ("sensor_msgs/msg/LaserScan", "ranges", [1], "a set or sequence and each value of type 'float' and each float"),
        (
            "sensor_msgs/msg/LaserScan",
            "ranges",
            np.zeros(3),
            "must be a set or sequence and each value of type 'float'",
        ),
        ("sensor_msgs/msg/LaserScan", "ranges", array("d", [1.0]), "must have the type code of 'f'"),
        ("sensor_msgs/msg/CameraInfo", "k", [0.0] * 8, "must be a set or sequence with length 9"),
        ("sensor_msgs/msg/CameraInfo", "k", np.zeros(8), "must have a size of 9"),
        ("sensor_msgs/msg/JointState", "name", "wheel", "must be a set or sequence and each value of type 'str'"),
    ],
)
def test_a_value_that_does_not_match_its_field_is_refused(type_name: str, field: str, value: object, text: str) -> None:
    with pytest.raises(AssertionError, match=text):
        setattr(new(type_name), field, value)


def test_sequences_of_numbers_are_arrays_and_other_sequences_are_lists() -> None:
    scan = new("sensor_msgs/msg/LaserScan", ranges=[1, 2.5])
    assert scan.ranges == array("f", [1.0, 2.5])
    scan.ranges.append(3.0)
    assert list(scan.ranges + scan.ranges[:1]) == [1.0, 2.5, 3.0, 1.0]
    assert bool(new("sensor_msgs/msg/LaserScan").ranges) is False
    assert new("sensor_msgs/msg/JointState").name == []
    assert isinstance(new("nav_msgs/msg/Odometry").pose.covariance, np.ndarray)
    assert new("std_msgs/msg/Byte").data == b"\x00"


def test_two_messages_share_no_list() -> None:
    first, second = new("sensor_msgs/msg/JointState"), new("sensor_msgs/msg/JointState")
    first.name.append("wheel")
    first.position.append(1.0)
    assert (second.name, len(second.position)) == ([], 0)


def test_constants_belong_to_the_class_and_to_each_message() -> None:
    marker = ROS2.message_class("visualization_msgs/msg/Marker")
    assert (marker.DELETE, marker().DELETE) == (2, 2)  # type: ignore[attr-defined]
    assert ROS2.message_class("diagnostic_msgs/msg/DiagnosticStatus").WARN == b"\x01"  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="has no setter"):
        marker.DELETE = 3  # type: ignore[attr-defined]


def test_a_default_of_the_definition_is_an_attribute_too() -> None:
    assert ROS2.message_class("geometry_msgs/msg/Quaternion").W__DEFAULT == 1.0  # type: ignore[attr-defined]


def test_messages_are_equal_if_all_fields_are() -> None:
    first, second = new("nav_msgs/msg/Odometry"), new("nav_msgs/msg/Odometry")
    assert first == second
    second.pose.covariance[35] = 1.0
    assert first != second
    assert first != new("geometry_msgs/msg/Pose")
    with pytest.raises(TypeError, match="unhashable"):
        hash(first)


def test_a_message_can_be_copied_and_pickled() -> None:
    odometry = new("nav_msgs/msg/Odometry", child_frame_id="base")
    odometry.pose.pose.position.x = 2.0
    deep = copy.deepcopy(odometry)
    assert deep == odometry
    deep.pose.pose.position.x = 3.0
    assert odometry.pose.pose.position.x == 2.0
    assert copy.copy(odometry).pose is odometry.pose
    restored = pickle.loads(pickle.dumps(odometry))
    assert restored == odometry and type(restored) is type(odometry)


def test_a_class_that_a_program_derives_is_copied_with_its_own_attributes() -> None:
    base: Any = ROS2.message_class("geometry_msgs/msg/Point")

    class Named(base):
        def __init__(self, name: str) -> None:
            super().__init__(x=1.0)
            self.name = name

    point = copy.deepcopy(Named("a"))
    assert (type(point), point.name, point.x) == (Named, "a", 1.0)


def test_the_types_of_fields_can_be_read() -> None:
    cls: Any = ROS2.message_class("sensor_msgs/msg/JointState")
    types = cls.get_fields_and_field_types()
    assert types["header"] == "std_msgs/Header" and types["position"] == "sequence<double>"
    assert cls.__slots__[:2] == ["_header", "_name"]
    assert cls.SLOT_TYPES[0] == NamespacedType(["std_msgs", "msg"], "Header")
    assert cls().SLOT_TYPES[2] == UnboundedSequence(BasicType("double"))


def test_a_service_has_a_request_and_a_response() -> None:
    with imports_of(ROS2):
        from example_interfaces.srv import AddTwoInts  # type: ignore[import-not-found]
    assert repr(AddTwoInts.Request(a=1)) == "example_interfaces.srv.AddTwoInts_Request(a=1, b=0)"
    assert AddTwoInts.Response().sum == 0
    assert AddTwoInts.Event().info.sequence_number == 0
    with pytest.raises(NotImplementedError, match="Service classes can not be instantiated"):
        AddTwoInts()
    assert type_name_of(AddTwoInts) == "example_interfaces/srv/AddTwoInts"


def test_an_action_has_its_parts_and_the_types_that_ros_derives() -> None:
    with imports_of(ROS2):
        from action_tutorials_interfaces.action import Fibonacci  # type: ignore[import-not-found]
    goal = Fibonacci.Goal(order=5)
    assert (goal.order, list(Fibonacci.Feedback().partial_sequence)) == (5, [])
    request = Fibonacci.Impl.SendGoalService.Request(goal=goal)
    assert request.goal.order == 5 and len(request.goal_id.uuid) == 16
    assert Fibonacci.Impl.GetResultService.Response().result == Fibonacci.Result()
    with pytest.raises(NotImplementedError, match="Action classes can not be instantiated"):
        Fibonacci()
