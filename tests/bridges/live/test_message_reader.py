"""Messages of clients are those that rosbags reads, of every type, and what is none is refused as rosbags does it."""

from __future__ import annotations

import random
import struct

import numpy as np
import pytest

from simkit import msgs
from simkit.bridges.live.message_reader import message_reader

FIXED = [
    "geometry_msgs/msg/Twist",
    "geometry_msgs/msg/Wrench",
    "geometry_msgs/msg/Vector3",
    "geometry_msgs/msg/Quaternion",
    "geometry_msgs/msg/Pose",
    "geometry_msgs/msg/Transform",
    "geometry_msgs/msg/Inertia",
    "builtin_interfaces/msg/Time",
    "std_msgs/msg/Bool",
    "std_msgs/msg/Byte",
    "std_msgs/msg/Char",
    "std_msgs/msg/Empty",
    "std_msgs/msg/Int8",
    "std_msgs/msg/UInt16",
    "std_msgs/msg/Int64",
    "std_msgs/msg/Float32",
    "std_msgs/msg/Float64",
    "rosgraph_msgs/msg/Clock",
    "sensor_msgs/msg/RegionOfInterest",
]
OTHERS = ["geometry_msgs/msg/TwistStamped", "std_msgs/msg/String", "geometry_msgs/msg/PoseWithCovariance"]


@pytest.mark.parametrize("is_little", [True, False])
@pytest.mark.parametrize("type_name", FIXED)
def test_the_reader_returns_the_same_numbers_as_rosbags(type_name: str, is_little: bool) -> None:
    store, source = msgs.type_store(), random.Random(type_name)
    size = len(msgs.serialize(msgs.make(type_name))) - 4
    for _ in range(20):
        data = bytes((0, is_little, 0, 0)) + source.randbytes(size) + bytes(source.randrange(4))
        read = message_reader(type_name)(b"before" + data, 6)
        usual = store.deserialize_cdr(data, type_name)
        assert type(read) is type(usual)
        assert repr(read) == repr(usual)  # of NaN too
        assert store.serialize_cdr(read, type_name) == store.serialize_cdr(usual, type_name)


@pytest.mark.parametrize("type_name", OTHERS)
def test_messages_of_variable_size_are_read(type_name: str) -> None:
    data = msgs.serialize(msgs.make(type_name))
    assert repr(message_reader(type_name)(b"1234" + data, 4)) == repr(msgs.deserialize(data, type_name))


@pytest.mark.parametrize("type_name", [*FIXED, *OTHERS])
def test_bytes_that_rosbags_rejects_are_rejected(type_name: str) -> None:
    store, whole = msgs.type_store(), msgs.serialize(msgs.make(type_name))
    for data in (whole[:-1], whole + bytes(4), b"\0\2" + whole[2:], b"\1\1" + whole[2:], whole[:3], b""):
        with pytest.raises(Exception) as usual:
            store.deserialize_cdr(data, type_name)
        with pytest.raises(type(usual.value)) as found:
            message_reader(type_name)(b"1234" + data, 4)
        assert str(found.value) == str(usual.value)


def test_nothing_is_shared_between_two_messages() -> None:
    data = msgs.serialize(msgs.make("geometry_msgs/msg/Twist", linear={"x": 1.0}))
    first, second = (message_reader("geometry_msgs/msg/Twist")(data, 0) for _ in range(2))
    first.linear.x = 2.0
    assert (second.linear.x, struct.unpack_from("<d", data, 4)[0], np.sign(first.linear.x)) == (1.0, 1.0, 1.0)
