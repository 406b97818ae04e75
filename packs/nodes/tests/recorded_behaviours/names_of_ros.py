"""Names: expansion, remapping, `--ros-args`, and the errors of invalid names."""

import json

import rclpy
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from std_msgs.msg import String


def error_of(function):
    try:
        function()
    except Exception as error:
        return "|".join([type(error).__name__, *str(error).split("\n")])
    return "none"


def main():
    arguments = [
        "p",
        "--ros-args",
        "-r",
        "n:a:=c",
        "-r",
        "chat:=/x/y",
        "-r",
        "n:__ns:=/foo",
        "-r",
        "talker:__node:=speaker",
    ]
    rclpy.init(args=[*arguments, "-r", "rosservice://only_service:=s", "-r", "__ns:=/bar", "--log-level", "debug"])
    node = Node("n")
    other = Node("talker")
    own = Node("own", cli_args=["-r", "__node:=mine", "-r", "__ns:=/own", "-r", "a:=a2"])
    plain = Node("plain", use_global_arguments=False)
    names = ["a", "chat", "/foo/chat", "~/p", "~", "/b", "{node}/x", "{ns}/x", "only_service"]
    result = {
        "resolved": {
            name: [node.resolve_topic_name(name), node.resolve_topic_name(name, only_expand=True)] for name in names
        },
        "service": node.resolve_service_name("only_service"),
        "names": [node.get_name(), node.get_namespace(), node.get_fully_qualified_name(), node.get_logger().name],
        "other": [other.get_fully_qualified_name(), other.resolve_topic_name("a")],
        "own_arguments": [own.get_fully_qualified_name(), own.resolve_topic_name("a")],
        "without_global": [plain.get_fully_qualified_name(), plain.resolve_topic_name("a")],
    }
    publisher = node.create_publisher(String, "a", 1)
    result["topic"] = [publisher.topic, publisher.topic_name]
    result["no_ros_args"] = remove_ros_args(["a", "--ros-args", "-r", "a:=b", "--", "c"])
    result["errors"] = [
        error_of(function)
        for function in (
            lambda: Node("a b", use_global_arguments=False),
            lambda: Node("a", namespace="/a//b", use_global_arguments=False),
            lambda: node.create_publisher(String, "a b", 1),
            lambda: node.create_publisher(String, "a/", 1),
            lambda: node.create_publisher(String, "a", -1),
            lambda: node.create_publisher(String, "a", "x"),
            lambda: node.create_subscription(String, "a", lambda: 0, 1),
            lambda: node.create_subscription(String, "a", None, 1),
            lambda: node.create_rate(0),
            rclpy.init,
            lambda: node.create_service(__import__("std_srvs.srv").srv.Trigger, "1a", print),
        )
    ]
    rclpy.shutdown()
    result["arguments"] = [
        error_of(lambda words=words: rclpy.init(args=["p", "--ros-args", *words])).split("|")[0]
        for words in (
            ["--foo"],
            ["a:=b"],
            ["-r", "x"],
            ["-r"],
            ["-p", "x"],
            ["-p", "x:="],
            ["-p", "a-b:=1"],
            ["-p", "1a:=1"],
            ["-p", "a..b:=1"],
            ["--log-level", "bla"],
        )
    ]
    print(json.dumps(result))


if __name__ == "__main__":
    main()
