"""Messages: made from plain values, complete, written as ROS 2 writes them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from simkit import msgs
from simkit.errors import MessageError
from simkit.msgs.message_types import message_type_names
from simkit.msgs.shipped_interfaces import definition_files, definition_text

# Type hashes as published by the packages' own generated code (ROS 2 Jazzy and later).
PUBLISHED = {
    "builtin_interfaces/msg/Time": "b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197",
    "std_msgs/msg/Header": "f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01",
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "std_msgs/msg/UInt32": "a5c874829b752bc5fa190024b0ad76f578cc278271e855c7d02a818b3516fb4a",
    "geometry_msgs/msg/Vector3": "cc12fe83e4c02719f1ce8070bfd14aecd40f75a96696a67a2a1f37f7dbb0765d",
    "geometry_msgs/msg/Wrench": "018e8519d57c16adbe97c9fe1460ef21fec7e31bc541de3d653a35895677ce52",
    "ros_gz_interfaces/msg/Entity": "266a26f377057ebb0a1f08f7fb9dc435a841d9ec4fa3ab8fa0085e66e653504e",
    "ros_gz_interfaces/msg/JointWrench": "aa50610f0bc1a9f1f42a04e6d76da729968d0f91b62f48b2040c4dc866c02686",
    "ros_gz_interfaces/msg/Contact": "ba5acbac280b8650f9ad7caf995888ff8aca861742e0159d8d36efe8460d0db3",
    "ros_gz_interfaces/msg/Altimeter": "c1e452c867a0dd147e2a612d1f78e5da9675ae5ef75c0950ad1520f004101703",
    "ros_gz_interfaces/msg/Float32Array": "8114db062e00379eb805879d9440d10beb7000352ad92bdc4e1385d988bd6cd9",
    "gps_msgs/msg/GPSFix": "f4e11a63872a198f70300a3990f50b096ed822f2db2bb626f6cdcee5f0f92942",
    "vision_msgs/msg/ObjectHypothesisWithPose": "41c12344c0396c48b81df12467c192d99b2a0eb1463c5c37194e4223251c80bc",
    "vision_msgs/msg/Detection2DArray": "214274120007f4a683866481336b70310268cfa107aebe9d594a6acf75bda968",
    "vision_msgs/msg/Detection3DArray": "793f5eab9595ac1c0da07873cc859db42eae51f0ee76056db8562515d830e018",
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_a_type_has_the_hash_that_its_package_publishes(name: str) -> None:
    assert msgs.rihs(name) == "RIHS01_" + PUBLISHED[name]


@pytest.mark.slow
def test_every_type_can_be_made_written_and_read_back() -> None:
    for name in message_type_names():
        message = msgs.make(name)
        data = msgs.serialize(message)
        assert data[:4] == b"\x00\x01\x00\x00", name
        assert msgs.serialize(msgs.deserialize(data, name)) == data, name
        assert msgs.type_name(message) == name


def test_every_definition_file_is_of_a_known_kind_and_has_its_parts() -> None:
    for name, path in definition_files().items():
        package, kind, short = name.split("/")
        assert Path(path).parts[-3:] == (package, kind, f"{short}.{kind}")
        assert definition_text(name).count("---\n") == {"msg": 0, "srv": 1, "action": 2}[kind], name


def test_a_definition_is_read_on_first_use_of_its_type() -> None:
    code = """
import simkit.msgs as m
assert m.full_name("ros_gz_interfaces/Contacts") not in set(m.type_store().fielddefs)
m.make("ros_gz_interfaces/msg/Contacts")
registered = set(m.type_store().fielddefs)
assert {"ros_gz_interfaces/msg/Contacts", "ros_gz_interfaces/msg/Entity"} <= registered
assert "gazebo_msgs/msg/ModelState" not in registered
"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_fields_left_out_are_zero_and_an_orientation_is_no_rotation() -> None:
    imu = msgs.make("sensor_msgs/msg/Imu")
    assert (imu.orientation.x, imu.orientation.y, imu.orientation.z, imu.orientation.w) == (0.0, 0.0, 0.0, 1.0)
    assert imu.linear_acceleration.z == 0.0
    np.testing.assert_array_equal(imu.angular_velocity_covariance, np.zeros(9))
    assert msgs.make("nav_msgs/msg/Odometry").pose.pose.orientation.w == 1.0


def test_two_messages_share_no_array() -> None:
    first, second = msgs.make("sensor_msgs/msg/Imu"), msgs.make("sensor_msgs/msg/Imu")
    first.orientation_covariance[0] = -1.0
    assert second.orientation_covariance[0] == 0.0


def test_dicts_become_messages_and_lists_become_arrays_of_the_fields_type() -> None:
    scan = msgs.make("sensor_msgs/LaserScan", header={"frame_id": "laser"}, ranges=[1, float("inf")], angle_min=-1)
    assert scan.header.frame_id == "laser"
    assert scan.ranges.dtype == np.float32
    assert scan.ranges.tolist() == [1.0, float("inf")]
    path = msgs.make("nav_msgs/msg/Path", poses=[{"pose": {"position": {"x": 2}}}])
    assert path.poses[0].pose.position.x == 2.0


def test_a_message_object_is_used_unchanged() -> None:
    header = msgs.header(1_500_000_002, "odom")
    assert msgs.make("sensor_msgs/msg/Imu", header=header).header is header


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"linaer": {}}, "no field 'linaer'; did you mean 'linear'?"),
        ({"linear": {"X": 1}}, "did you mean 'x'?"),
        ({"linear": {"x": "fast"}}, "found 'fast'; expected a number"),
        ({"linear": 3}, "expected a geometry_msgs/msg/Vector3 or a dict"),
        ({"linear": {"x": None}}, "found None"),
    ],
)
def test_a_mismatched_value_is_reported(fields: dict[str, object], reason: str) -> None:
    with pytest.raises(MessageError) as error:
        msgs.make("geometry_msgs/msg/Twist", **fields)
    assert reason in str(error.value)


@pytest.mark.parametrize(
    ("name", "fields"),
    [
        ("std_msgs/msg/UInt8", {"data": 256}),
        ("std_msgs/msg/Int32", {"data": 1.5}),
        ("std_msgs/msg/Bool", {"data": 1}),
        ("std_msgs/msg/String", {"data": 7}),
        ("sensor_msgs/msg/Imu", {"orientation_covariance": [0.0] * 8}),
        ("sensor_msgs/msg/LaserScan", {"ranges": ["a"]}),
        ("sensor_msgs/msg/JointState", {"name": "wheel"}),
    ],
)
def test_a_value_of_the_wrong_kind_or_size_is_refused(name: str, fields: dict[str, object]) -> None:
    with pytest.raises(MessageError):
        msgs.make(name, **fields)


def test_an_unknown_type_names_the_closest() -> None:
    with pytest.raises(MessageError, match="did you mean 'sensor_msgs/msg/LaserScan'"):
        msgs.type_of("sensor_msgs/msg/LaserScn")


def test_a_dict_becomes_a_message_of_the_first_matching_type() -> None:
    types = ["geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"]
    assert msgs.type_name(msgs.from_dict(types, {"angular": {"z": 1}})) == types[0]
    assert msgs.type_name(msgs.from_dict(types, {"twist": {"angular": {"z": 1}}})) == types[1]
    with pytest.raises(MessageError, match="also tried: geometry_msgs/msg/TwistStamped"):
        msgs.from_dict(types, {"speed": 1})


@pytest.mark.parametrize("ns", [0, 1, 999_999_999, 1_000_000_000, 3_600_000_000_001])
def test_times_are_exact(ns: int) -> None:
    assert msgs.stamp_ns(msgs.time(ns)) == ns
    assert msgs.stamp_ns(msgs.duration(ns)) == ns
    assert msgs.stamp_ns(msgs.header(ns, "").stamp) == ns


def test_the_definition_contains_the_types_of_its_fields() -> None:
    text = msgs.definition("ros_gz_interfaces/msg/Contacts")
    assert text.startswith("std_msgs/Header header\nros_gz_interfaces/Contact[] contacts\n")
    assert "MSG: ros_gz_interfaces/Entity" in text
    assert "uint8 COLLISION=5" in text


def test_an_object_that_is_not_a_message_is_refused() -> None:
    with pytest.raises(MessageError, match="dict is not a message"):
        msgs.type_name({})


def test_a_message_with_a_broken_field_is_an_error_of_the_message() -> None:
    twist = msgs.make("geometry_msgs/msg/Twist")
    twist.linear.x = "fast"
    with pytest.raises(MessageError, match="geometry_msgs/msg/Twist cannot be serialised"):
        msgs.serialize(twist)


def test_importing_the_messages_does_not_import_the_type_store() -> None:
    code = "import sys, simkit.msgs; print('rosbags' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "False\n"


@pytest.mark.parametrize("kind", [1, None, {}, ("std_msgs/msg/Bool",)])
def test_a_type_that_is_not_a_text_is_an_error_of_simkit_and_a_type_error(kind: object) -> None:
    with pytest.raises(MessageError, match="the type of a message must be a text") as raised:
        msgs.make(kind)  # type: ignore[arg-type]
    assert isinstance(raised.value, TypeError)
