"""Known programs that publish topics again: topic_tools and twist_mux."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import pytest

import simkit
from simkit import Simulation

WORLD = '<sdf version="1.9"><world name="w"/></sdf>'
SOURCES = {
    "topics": {
        "navigation": {"topic": "nav_vel", "timeout": 0.5, "priority": 10},
        "joystick": {"topic": "joy_vel", "timeout": 0.5, "priority": 100},
    },
    "locks": {"pause": {"topic": "pause", "timeout": 0.0, "priority": 200}},
}


@pytest.fixture
def sim() -> Iterator[Simulation]:
    with simkit.load(WORLD) as simulation:
        yield simulation


def texts_after(sim: Simulation, topic: str, count: int = 12) -> list[str]:
    """Texts on a topic while numbers are published on /in, ten times a second."""
    publisher = sim.advertise("/in", "std_msgs/msg/String")
    subscription = sim.subscribe(topic)
    for number in range(count):
        sim.run(0.1)
        publisher.publish({"data": str(number)})
    sim.run(0.05)
    return [message.data for message in subscription.messages]


def test_relay_publishes_every_message_on_the_default_output(sim: Simulation) -> None:
    sim.add_node("topic_tools/relay", args=["/in"])
    assert texts_after(sim, "/in_relay")[-3:] == ["9", "10", "11"]


def test_parameters_name_the_topics_of_a_relay(sim: Simulation) -> None:
    sim.add_node("topic_tools/relay", name="r", params={"input_topic": "/in", "output_topic": "/out"})
    assert texts_after(sim, "/out")[-1] == "11"
    assert sim.topics()["/out"] == "std_msgs/msg/String"


def test_throttle_publishes_at_most_the_rate(sim: Simulation) -> None:
    sim.add_node("topic_tools/throttle", args=["messages", "/in", "2.0", "/out"])
    numbers = [int(text) for text in texts_after(sim, "/out", 40)]
    assert {later - earlier for earlier, later in pairwise(numbers)} == {5}


def test_drop_leaves_out_x_of_y_messages(sim: Simulation) -> None:
    sim.add_node("topic_tools/drop", args=["/in", "1", "2", "/out"])
    numbers = [int(text) for text in texts_after(sim, "/out", 20)]
    assert {later - earlier for earlier, later in pairwise(numbers)} == {2}


def test_delay_publishes_later(sim: Simulation) -> None:
    sim.add_node("topic_tools/delay", args=["/in", "0.5", "/out"])
    assert texts_after(sim, "/out", 12)[-1] == "6"


def test_mux_publishes_the_input_that_the_service_selects(sim: Simulation) -> None:
    sim.add_node("topic_tools/mux", args=["/out", "/other", "/in"])
    assert texts_after(sim, "/out") == []
    response = sim.call("/mux/select", {"topic": "/in"})
    assert (response.success, response.prev_topic) == (True, "/other")
    assert texts_after(sim, "/out")[-1] == "11"
    assert list(sim.call("/mux/list").topics) == ["/other", "/in"]


def commands(sim: Simulation, subscription: Any, seconds: float, *, joystick: bool = False) -> list[float]:
    """Speeds that twist_mux publishes while the navigation commands 1 m/s, and the joystick 2 m/s."""
    first = len(subscription.messages)
    for _ in range(round(seconds * 10)):
        sim.publish("/nav_vel", {"linear": {"x": 1.0}})
        if joystick:
            sim.publish("/joy_vel", {"linear": {"x": 2.0}})
        sim.run(0.1)
    return [message.linear.x for message in subscription.messages[first:]]


def test_the_source_with_the_highest_priority_wins_until_its_timeout(sim: Simulation) -> None:
    sim.add_node("twist_mux/twist_mux", params=SOURCES, remap={"cmd_vel_out": "/cmd_vel"})
    sim.run(0.1)
    subscription = sim.subscribe("/cmd_vel")
    assert set(commands(sim, subscription, 0.5)) == {1.0}
    assert set(commands(sim, subscription, 0.5, joystick=True)) == {1.0, 2.0}
    assert set(commands(sim, subscription, 0.3)) <= {2.0}
    assert commands(sim, subscription, 1.0)[-1] == 1.0


def test_a_lock_stops_sources_of_lower_priority(sim: Simulation) -> None:
    sim.add_node("twist_mux/twist_mux", params=SOURCES)
    sim.run(0.1)
    subscription = sim.subscribe("/cmd_vel_out")
    sim.publish("/pause", {"data": True})
    sim.run(0.1)
    assert commands(sim, subscription, 0.5) == []
    sim.publish("/pause", {"data": False})
    sim.run(0.1)
    assert commands(sim, subscription, 0.5)


def test_parameters_of_ros_1_name_the_sources_of_twist_mux(sim: Simulation) -> None:
    topics = [{"name": "navigation", "topic": "nav_vel", "timeout": 0.5, "priority": 10}]
    sim.set_ros_parameters({"/twist_mux/topics": topics})
    sim.add_node("twist_mux/twist_mux")
    sim.run(0.1)
    subscription = sim.subscribe("/cmd_vel_out")
    assert set(commands(sim, subscription, 0.5)) == {1.0}
