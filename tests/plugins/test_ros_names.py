"""Topic names after namespace and remapping, as in a ROS node."""

from __future__ import annotations

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.ros_names import RosNames


def names(node: str = "driver", **ros: object) -> RosNames:
    return RosNames.from_params(Params.from_dict({"ros": ros}), node)


def test_without_a_ros_block_names_are_in_the_root_namespace() -> None:
    bare = RosNames.from_params(Params("plugin"), "driver")
    assert bare.topic("odom") == "/odom"
    assert bare.topic("/odom") == "/odom"
    assert bare.topic("~/out") == "/driver/out"


def test_a_namespace_comes_before_relative_and_private_names() -> None:
    for namespace in ("tb3", "/tb3", "/tb3/"):
        ros = names(namespace=namespace)
        assert ros.topic("odom") == "/tb3/odom"
        assert ros.topic("~/out") == "/tb3/driver/out"
        assert ros.topic("/tf") == "/tf"


def test_a_private_name_is_remapped_into_the_namespace() -> None:
    ros = names(namespace="/tb3", remapping="~/out:=imu")
    assert ros.topic("~/out") == "/tb3/imu"


def test_several_remappings_each_find_their_topic() -> None:
    ros = names(remapping=["cmd_vel:=/base/command", "odom:=wheel_odom"])
    assert ros.topic("cmd_vel") == "/base/command"
    assert ros.topic("odom") == "/wheel_odom"
    assert ros.topic("joint_states") == "/joint_states"


def test_arguments_remap_as_on_a_command_line() -> None:
    ros = names(argument=["--ros-args -r odom:=odometry", "__ns:=/left"])
    assert ros.topic("odom") == "/left/odometry"


def test_a_remapping_without_an_arrow_is_an_error() -> None:
    params = Params.from_dict({"ros": {"remapping": "odom=odometry"}})
    assert RosNames.from_params(params, "driver").topic("odom") == "/odom"
    assert [d.code for d in params.diagnostics] == ["SK-PARAM-002"]


def test_ros_1_plugins_have_only_a_namespace() -> None:
    ros = RosNames.from_params(Params.from_dict({"robotNamespace": "/r1"}), "driver")
    assert ros.topic("cmd_vel") == "/r1/cmd_vel"


def test_gz_topics_become_absolute_and_lose_bad_characters() -> None:
    assert valid_topic("cmd_vel") == "/cmd_vel"
    assert valid_topic("/model/my robot/cmd_vel") == "/model/my_robot/cmd_vel"
    assert valid_topic("/a@b~c") == "/abc"


def test_invalid_characters_of_a_topic_are_removed_and_reported() -> None:
    params = Params.from_dict({"ros": {"namespace": "/my robot"}})
    ros = RosNames.from_params(params, "driver")
    assert ros.topic("c/\u0661 raw") == "/my_robot/c/_raw"
    assert ros.topic("/a//b") == "/a/b"
    assert ros.topic("/scan") == "/scan"
    assert [d.code for d in params.diagnostics] == ["SK-PLUGIN-012"] * 2
    assert "'/my robot/c/\u0661 raw'" in next(iter(params.diagnostics)).message
