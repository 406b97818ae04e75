"""Serialised messages with replaced numbers have the bytes of the complete messages."""

from __future__ import annotations

import numpy as np

from simkit import msgs
from simkit.msgs.cdr_template import CdrTemplate


def test_filled_templates_have_the_bytes_of_the_messages_with_these_numbers() -> None:
    constant = {"name": ["left", "right_wheel"], "position": [0.0, 0.0], "effort": [1.0, 2.0]}
    template = CdrTemplate(
        msgs.make("sensor_msgs/msg/JointState", header={"frame_id": "base"}, **constant),
        ("header.stamp.sec", "position[1]", "effort[0]"),
    )
    columns = {
        "header.stamp.sec": np.array([3, 4, 5]),
        "position[1]": np.array([0.1, -0.2, np.inf]),
        "effort[0]": np.array([7.0, 8.0, 9.0]),
    }
    for row, found in enumerate(template.fill(3, columns)):
        message = msgs.make("sensor_msgs/msg/JointState", header={"frame_id": "base"}, **constant)
        message.header.stamp.sec = int(columns["header.stamp.sec"][row])
        message.position[1], message.effort[0] = columns["position[1]"][row], columns["effort[0]"][row]
        assert found == msgs.serialize(message)


def test_a_template_finds_numbers_behind_texts_lists_and_nested_messages() -> None:
    transforms = [{"child_frame_id": "a"}, {"child_frame_id": "bcd", "transform": {"translation": {"x": 1.0}}}]
    field = "transforms[1].transform.rotation.w"
    template = CdrTemplate(msgs.make("tf2_msgs/msg/TFMessage", transforms=transforms), (field,))
    transforms[1]["transform"] = {"translation": {"x": 1.0}, "rotation": {"w": 0.5}}
    expected = msgs.serialize(msgs.make("tf2_msgs/msg/TFMessage", transforms=transforms))
    assert template.fill(1, {field: np.array([0.5])}) == [expected]


def test_a_packer_places_numbers_and_whole_arrays() -> None:
    fields = ("header.stamp.nanosec", "orientation.z", "angular_velocity_covariance", "linear_acceleration.x")
    pack = CdrTemplate(msgs.make("sensor_msgs/msg/Imu", header={"frame_id": "imu"}), fields).packer()
    expected = msgs.make(
        "sensor_msgs/msg/Imu",
        header={"frame_id": "imu", "stamp": {"nanosec": 7}},
        orientation={"z": 0.25},
        angular_velocity_covariance=np.arange(9.0),
        linear_acceleration={"x": -3.5},
    )
    assert pack(7, 0.25, np.arange(9.0).tobytes(), -3.5) == msgs.serialize(expected)


def test_whole_lists_of_numbers_are_replaced() -> None:
    fields = ("header.stamp.sec", "range_max", "ranges")
    constant = {"header": {"frame_id": "abcd"}, "ranges": [0.0] * 3, "intensities": [1.0, 2.0]}
    template = CdrTemplate(msgs.make("sensor_msgs/msg/LaserScan", **constant), fields)
    rows = np.array([[1.0, np.inf, 3.0], [0.1, 0.2, -0.3]])
    found = template.fill(2, dict(zip(fields, (np.array([5, 6]), np.array([7.0, 8.0]), rows), strict=True)))
    for number, row in enumerate(rows):
        changed = {"header": {"frame_id": "abcd", "stamp": {"sec": 5 + number}}, "range_max": 7.0 + number}
        message = msgs.make("sensor_msgs/msg/LaserScan", **{**constant, **changed, "ranges": row})
        assert found[number] == msgs.serialize(message)
        assert template.packer()(5 + number, 7.0 + number, message.ranges.tobytes()) == found[number]
