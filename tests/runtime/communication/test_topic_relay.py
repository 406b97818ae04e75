"""Relays between topics: what they pass on, when they read their source, and types that they convert."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import simkit
from simkit import Simulation, msgs
from simkit.errors import MessageError

TWIST = "geometry_msgs/msg/Twist"
STAMPED = "geometry_msgs/msg/TwistStamped"
SCAN = "sensor_msgs/msg/LaserScan"
WORLD = """<sdf version="1.9"><world name="w"><model name="post"><static>true</static><link name="l">
<sensor name="s" type="gpu_lidar"><topic>rays</topic><update_rate>10</update_rate><lidar><scan><horizontal>
<samples>4</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan>
<range><min>0.1</min><max>5</max></range></lidar></sensor></link></model></world></sdf>"""


@pytest.fixture
def sim() -> Iterator[Simulation]:
    with simkit.load(WORLD) as simulation:
        yield simulation


def twist(x: float) -> msgs.Twist:
    message: msgs.Twist = msgs.make(TWIST, linear={"x": x})
    return message


def test_a_relay_reads_its_source_only_while_its_target_has_subscribers(sim: Simulation) -> None:
    relay = sim.communication.relay("/rays", "/scan", SCAN)
    sim.run(0.5)
    assert relay.tap is None and not sim.communication.bus.wanted("/rays")
    scans = sim.subscribe("/scan")
    sim.run(0.5)
    assert len(scans.messages) == relay.count == 5
    scans.close()
    assert relay.tap is None


def test_a_relay_passes_the_same_message_on(sim: Simulation) -> None:
    sim.communication.relay("/rays", "/scan", SCAN)
    first, second = sim.subscribe("/rays"), sim.subscribe("/scan")
    sim.run(0.5)
    assert first.messages and all(a is b for a, b in zip(first.messages, second.messages, strict=True))


def test_a_kept_message_is_that_of_its_time_although_it_is_read_later(sim: Simulation) -> None:
    sim.communication.relay("/rays", "/scan", SCAN)
    scans = sim.subscribe("/scan")
    sim.run(0.25)
    sim.spawn('<sdf version="1.9"><model name="m"><static>true</static><link name="l"/></model></sdf>')
    sim.run(0.25)
    assert [message.header.stamp.nanosec // 100_000_000 for message in scans.messages] == list(range(6))


def test_two_relays_connect_both_directions_without_an_echo(sim: Simulation) -> None:
    for source, target in (("/a", "/b"), ("/b", "/a")):
        sim.communication.relay(source, target, TWIST)
    first, second = sim.subscribe("/a"), sim.subscribe("/b")
    sim.publish("/a", twist(1))
    sim.publish("/b", twist(2))
    assert [message.linear.x for message in first.messages] == [1, 2]
    assert [message.linear.x for message in second.messages] == [1, 2]
    first.close()
    second.close()
    assert all(relay.tap is None for relay in sim.communication.bus.relays)


def test_commands_reach_the_inputs_of_another_topic_in_the_same_step(sim: Simulation) -> None:
    received: list[tuple[int, float]] = []
    sim.communication.relay_inputs("/cmd_vel", "/model/m/cmd_vel", TWIST)
    assert sim.topics()["/cmd_vel"] == TWIST
    sim.listen("/model/m/cmd_vel", TWIST, lambda message: received.append((sim.tick, message.linear.x)))
    shown = sim.subscribe("/model/m/cmd_vel")
    sim.publish("/cmd_vel", {"linear": {"x": 0.5}})
    sim.step()
    assert received == [(0, 0.5)] and len(shown.messages) == 1


def test_inputs_take_a_further_type(sim: Simulation) -> None:
    received: list[float] = []
    sim.listen("/cmd_vel", TWIST, lambda message: received.append(message.linear.x))
    relay = sim.communication.relay_inputs("/cmd_vel", "/cmd_vel", STAMPED)
    sim.publish("/cmd_vel", msgs.make(STAMPED, twist=twist(3)))
    sim.step()
    relay.close()
    with pytest.raises(MessageError, match="needs geometry_msgs/msg/Twist"):
        sim.publish("/cmd_vel", msgs.make(STAMPED, twist=twist(4)))
    sim.publish("/cmd_vel", twist(5))
    sim.step()
    assert received == [3, 5]


def test_types_with_other_contents_are_named_and_a_topic_with_another_type_is_refused(sim: Simulation) -> None:
    relay = sim.communication.relay("/rays", "/imu", "sensor_msgs/msg/Imu")
    assert relay.fault() == SCAN
    assert sim.communication.relay("/later", "/scan", SCAN).fault() == "no source"
    with pytest.raises(MessageError, match="has type sensor_msgs/msg/LaserScan"):
        sim.communication.relay("/imu", "/rays", "sensor_msgs/msg/Imu")


def test_a_late_subscriber_gets_the_last_message_of_a_latched_source(sim: Simulation) -> None:
    out = sim.advertise("/map_name", "std_msgs/msg/String", latched=True)
    out.publish({"data": "hall"})
    sim.communication.relay("/map_name", "/name", "std_msgs/msg/String")
    assert sim.subscribe("/name").latest.data == "hall"
