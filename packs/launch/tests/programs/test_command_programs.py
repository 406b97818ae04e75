"""Commands of `ros2` and ROS 1 in launch files run as programs, in simulated time."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import simkit
from simkit import Simulation

WORLD = (
    '<sdf version="1.9"><world name="w"><model name="box"><static>true</static><link name="l"/></model></world></sdf>'
)


@pytest.fixture
def sim() -> Iterator[Simulation]:
    with simkit.load(WORLD) as simulation:
        yield simulation


def test_topic_pub_once_waits_for_a_subscription(sim: Simulation) -> None:
    node = sim.add_node("command/ros2", args=["topic", "pub", "--once", "/number", "std_msgs/msg/Int32", "{data: 3}"])
    sim.run(0.5)
    assert not node.done
    subscription = sim.subscribe("/number")
    sim.run(0.5)
    assert [message.data for message in subscription.messages] == [3]
    assert (node.done, node.exit_code) == (True, 0)


def test_topic_pub_has_the_rate_of_simulated_time_and_sets_the_stamp(sim: Simulation) -> None:
    words = ["topic", "pub", "-r", "10", "/pose", "geometry_msgs/msg/PoseStamped", "{header: auto}", "-p", "0"]
    sim.add_node("command/ros2", args=words)
    subscription = sim.subscribe("/pose")
    sim.run(1.05)
    assert len(subscription.messages) in (10, 11)
    assert subscription.latest.header.stamp.sec == 1


def test_rostopic_pub_takes_values_in_the_order_of_the_fields(sim: Simulation) -> None:
    sim.add_node(
        "command/rostopic", args=["pub", "/cmd_vel", "geometry_msgs/Twist", "-r", "2", "--", "[1,0,0]", "[0,0,-2]"]
    )
    subscription = sim.subscribe("/cmd_vel")
    sim.run(1.0)
    assert (subscription.latest.linear.x, subscription.latest.angular.z) == (1.0, -2.0)


def test_service_call_prints_the_response(sim: Simulation) -> None:
    node = sim.add_node("command/ros2", args=["service", "call", "/pause_physics", "std_srvs/srv/Empty"])
    sim.run(0.2)
    assert "response:" in node.log
    assert node.exit_code == 0


def test_topic_echo_prints_a_message(sim: Simulation) -> None:
    node = sim.add_node("command/ros2", args=["topic", "echo", "--once", "/text", "std_msgs/msg/String"])
    sim.run(0.1)
    sim.publish("/text", {"data": "hello"})
    sim.run(0.1)
    assert node.log == ["data: hello", "---"]


def test_param_set_changes_a_parameter(sim: Simulation) -> None:
    parameter = sim.declare("speed", 1.0)
    sim.add_node("command/ros2", args=["param", "set", "/script", "speed", "2.5"])
    sim.run(0.2)
    assert parameter.value == 2.5


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        (["topic", "pub", "/x", "std_msgs/msg/Int32", "{data: many}"], 1, "SK-CLI-031"),
        (["topic", "pub", "/x", "std_msgs/msg/Nothing", "{}"], 1, "SK-CLI-032"),
        (["fly"], 2, "unknown command"),
        (["bag", "record", "-a"], 0, "use --record FILE"),
    ],
)
def test_mistakes_and_commands_without_effect_are_told(sim: Simulation, words: list[str], code: int, text: str) -> None:
    node = sim.add_node("command/ros2", args=words)
    sim.run(0.2)
    assert node.exit_code == code or node.error is not None
    assert text in "\n".join(node.log)
