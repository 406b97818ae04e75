"""Messages as text: the forms that ROS 2's commands print, and parts of messages by their paths."""

from __future__ import annotations

import pytest

from simkit import msgs
from simkit.errors import MessageError
from simkit.msgs.message_text import Style, csv_of, field_text, part, plain, python_of, yaml_of

STATE = msgs.make("sensor_msgs/msg/JointState", name=["left", "right"], position=[1.0, -0.5], effort=[1e-5])


def test_yaml_keeps_the_order_of_fields_and_writes_numbers_as_yaml_does() -> None:
    assert yaml_of(STATE) == (
        "header:\n  stamp:\n    sec: 0\n    nanosec: 0\n  frame_id: ''\nname:\n- left\n- right\n"
        "position:\n- 1.0\n- -0.5\nvelocity: []\neffort:\n- 1.0e-05\n"
    )
    assert yaml_of(msgs.make("std_msgs/msg/Empty")) == "{}\n"
    assert yaml_of(msgs.make("std_msgs/msg/String", data="Füße: 2"), Style(flow=True)) == "{data: 'Füße: 2'}\n"


def test_python_is_that_of_rclpy() -> None:
    assert python_of(STATE) == (
        "sensor_msgs.msg.JointState(header=std_msgs.msg.Header(stamp=builtin_interfaces.msg.Time(sec=0, nanosec=0), "
        "frame_id=''), name=['left', 'right'], position=[1.0, -0.5], velocity=[], effort=[1e-05])"
    )
    fixed = python_of(msgs.make("geometry_msgs/msg/PoseWithCovariance"))
    assert "covariance=array([0., 0., 0.," in fixed
    assert python_of(msgs.make("std_srvs/srv/Trigger_Response", success=True)) == (
        "std_srvs.srv.Trigger_Response(success=True, message='')"
    )


def test_csv_is_flat() -> None:
    assert csv_of(STATE) == "0,0,,left,right,1.0,-0.5,1e-05"
    assert csv_of(STATE, Style(no_arr=True)).startswith("0,0,,<sequence type: string, length: 2>,")


def test_what_is_long_is_cut() -> None:
    scan = msgs.make("sensor_msgs/msg/LaserScan", ranges=[0.5] * 4, header={"frame_id": "base_scan"})
    short = plain(scan, Style(truncate=2))
    assert short["ranges"] == [0.5, 0.5, "..."] and short["header"]["frame_id"] == "ba..."
    assert plain(scan, Style(no_arr=True))["ranges"] == "<sequence type: float32, length: 4>"
    assert plain(scan, Style(no_str=True))["header"]["frame_id"] == "<string length: <9>>"


def test_a_part_is_found_by_its_path() -> None:
    tree = msgs.make("tf2_msgs/msg/TFMessage", transforms=[{"child_frame_id": "a"}, {"child_frame_id": "b"}])
    assert part(tree, "transforms[1].child_frame_id")[0] == "b"
    assert field_text(*part(STATE, "position")) == "array('d', [1.0, -0.5])"
    assert field_text(*part(STATE, "velocity")) == "array('d')"
    assert field_text(*part(STATE, "name")) == "['left', 'right']"
    assert field_text(*part(STATE, "position[0]")) == "1.0"
    assert list(part(STATE, "name[0:1]")[0]) == ["left"]


@pytest.mark.parametrize(
    ("path", "told"),
    [
        ("nam", "did you mean 'name'"),
        ("name[2]", "has 2 items"),
        ("header[0]", "is no array"),
        ("name.x", "is no message"),
        ("header.stamp.", ""),
        ("..", ""),
        ("name[", "no path of fields"),
    ],
)
def test_a_path_that_leads_nowhere_says_so(path: str, told: str) -> None:
    if not told:
        assert part(STATE, path)
        return
    with pytest.raises(MessageError, match=told.replace("[", r"\[")):
        part(STATE, path)
