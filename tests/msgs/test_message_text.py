"""Messages as text: the forms that ROS 2's commands print, and parts of messages by their paths."""

from __future__ import annotations

import pytest

from simkit import msgs
from simkit.errors import MessageError
from simkit.msgs.message_text import (
    TextStyle,
    field_at_path,
    field_text,
    message_to_csv,
    message_to_dict,
    message_to_yaml,
    to_python,
)

STATE = msgs.make("sensor_msgs/msg/JointState", name=["left", "right"], position=[1.0, -0.5], effort=[1e-5])


def test_yaml_keeps_the_order_of_fields_and_writes_numbers_as_yaml_does() -> None:
    assert message_to_yaml(STATE) == (
        "header:\n  stamp:\n    sec: 0\n    nanosec: 0\n  frame_id: ''\nname:\n- left\n- right\n"
        "position:\n- 1.0\n- -0.5\nvelocity: []\neffort:\n- 1.0e-05\n"
    )
    assert message_to_yaml(msgs.make("std_msgs/msg/Empty")) == "{}\n"
    assert (
        message_to_yaml(msgs.make("std_msgs/msg/String", data="Füße: 2"), TextStyle(flow=True)) == "{data: 'Füße: 2'}\n"
    )


def test_the_python_format_equals_rclpys() -> None:
    assert to_python(STATE) == (
        "sensor_msgs.msg.JointState(header=std_msgs.msg.Header(stamp=builtin_interfaces.msg.Time(sec=0, nanosec=0), "
        "frame_id=''), name=['left', 'right'], position=[1.0, -0.5], velocity=[], effort=[1e-05])"
    )
    fixed = to_python(msgs.make("geometry_msgs/msg/PoseWithCovariance"))
    assert "covariance=array([0., 0., 0.," in fixed
    assert to_python(msgs.make("std_srvs/srv/Trigger_Response", success=True)) == (
        "std_srvs.srv.Trigger_Response(success=True, message='')"
    )


def test_csv_has_all_nested_values_on_one_line() -> None:
    assert message_to_csv(STATE) == "0,0,,left,right,1.0,-0.5,1e-05"
    assert message_to_csv(STATE, TextStyle(no_arr=True)).startswith("0,0,,<sequence type: string, length: 2>,")


def test_long_arrays_and_strings_are_truncated() -> None:
    scan = msgs.make("sensor_msgs/msg/LaserScan", ranges=[0.5] * 4, header={"frame_id": "base_scan"})
    short = message_to_dict(scan, TextStyle(truncate=2))
    assert short["ranges"] == [0.5, 0.5, "..."] and short["header"]["frame_id"] == "ba..."
    assert message_to_dict(scan, TextStyle(no_arr=True))["ranges"] == "<sequence type: float32, length: 4>"
    assert message_to_dict(scan, TextStyle(no_str=True))["header"]["frame_id"] == "<string length: <9>>"


def test_a_field_is_found_by_its_path() -> None:
    tree = msgs.make("tf2_msgs/msg/TFMessage", transforms=[{"child_frame_id": "a"}, {"child_frame_id": "b"}])
    assert field_at_path(tree, "transforms[1].child_frame_id")[0] == "b"
    assert field_text(*field_at_path(STATE, "position")) == "array('d', [1.0, -0.5])"
    assert field_text(*field_at_path(STATE, "velocity")) == "array('d')"
    assert field_text(*field_at_path(STATE, "name")) == "['left', 'right']"
    assert field_text(*field_at_path(STATE, "position[0]")) == "1.0"
    assert list(field_at_path(STATE, "name[0:1]")[0]) == ["left"]


@pytest.mark.parametrize(
    ("path", "told"),
    [
        ("nam", "did you mean 'name'"),
        ("name[2]", "has 2 items"),
        ("header[0]", "is not an array"),
        ("name.x", "is not a message"),
        ("header.stamp.", ""),
        ("..", ""),
        ("name[", "is not a field path"),
    ],
)
def test_an_invalid_path_is_reported(path: str, told: str) -> None:
    if not told:
        assert field_at_path(STATE, path)
        return
    with pytest.raises(MessageError, match=told.replace("[", r"\[")):
        field_at_path(STATE, path)
