"""True rates, and nothing read that nobody asked for."""

from __future__ import annotations

from pathlib import Path

import pytest

import simkit
from simkit import msgs
from simkit.recording.bags.recorder import Recorder
from simkit.recording.topic_counts import TopicCounter

WORLD = """
<sdf version="1.9"><world name="w"><model name="m"><static>true</static><link name="l">
  <sensor name="imu" type="imu"><update_rate>30</update_rate><topic>imu</topic></sensor>
</link></model></world></sdf>
"""


def test_rates_are_in_simulated_time() -> None:
    with simkit.load(WORLD) as sim:
        counter = TopicCounter(sim)
        sim.run(2.0)
        rows = {row.topic: row for row in counter.rows}
        assert rows["/imu"].count == 61
        assert rows["/imu"].rate() == pytest.approx(30.0, rel=1e-3)
        sim.reset()
        sim.run(1.0)
        rows = {row.topic: row for row in counter.rows}
        assert rows["/imu"].count == 31
        assert rows["/imu"].rate() == pytest.approx(30.0, rel=1e-3)


def test_a_skipped_type_is_listed_and_not_read() -> None:
    with simkit.load(WORLD) as sim:
        counter = TopicCounter(sim, skip=["sensor_msgs/msg/Imu"])
        sim.run(1.0)
        row = next(row for row in counter.rows if row.topic == "/imu")
        assert not row.counted
        assert not sim.communication.bus.wanted("/imu")


def test_a_topic_that_is_advertised_later_is_counted_from_then_on() -> None:
    with simkit.load(WORLD) as sim:
        counter = TopicCounter(sim)
        sim.run(1.0)
        publisher = sim.communication.bus.advertise("/late", "std_msgs/msg/Float64")
        for _ in range(10):
            sim.run(0.1)
            publisher.publish(msgs.make("std_msgs/msg/Float64"))
        row = next(row for row in counter.rows if row.topic == "/late")
        assert row.rate() == pytest.approx(10.0, rel=1e-3)


def test_a_recorded_topic_is_counted_regardless_of_its_type(tmp_path: Path) -> None:
    with simkit.load(WORLD) as sim, Recorder(sim, tmp_path / "r.mcap", topics=["/im*"]) as recording:
        assert recording.records("/imu") and not recording.records("/clock")
        counter = TopicCounter(sim, ["sensor_msgs/msg/Imu", "rosgraph_msgs/msg/Clock"], recording.records)
        sim.run(1.0)
        counts = {row.topic: row.count for row in counter.rows if row.counted}
    assert counts["/imu"] == recording.message_count == 31
    assert "/clock" not in counts


def test_counting_does_not_make_messages() -> None:
    """So pictures can be drawn on another thread while they are counted and recorded."""
    with simkit.load(WORLD) as sim:
        TopicCounter(sim)
        made: list[int] = []
        publisher = sim.communication.bus.advertise("/later", "std_msgs/msg/Float64")
        publisher.publish_later(lambda: made.append(1))
        assert made == []


def test_a_sensor_is_counted_without_a_measurement() -> None:
    with simkit.load(WORLD) as sim:
        counter = TopicCounter(sim)
        assert not sim.communication.bus.wanted("/imu") and not sim.communication.bus.wanted("/clock")
        sim.sensor("m::l::imu").set_rate(20.0)
        sim.run(2.0)
        counts = {row.topic: (row.count, row.rate()) for row in counter.rows}
    assert counts["/imu"] == (41, pytest.approx(20.0, rel=1e-3))
    assert counts["/clock"] == (200, pytest.approx(100.0, rel=1e-3))


@pytest.mark.parametrize("start", [0.0, 0.51])
def test_the_counts_are_those_of_a_subscriber(start: float) -> None:
    with simkit.load(WORLD) as sim:
        sim.run(start)
        counter = TopicCounter(sim)
        heard = {topic: sim.subscribe(topic) for topic in ("/imu", "/clock")}
        times: dict[str, list[int]] = {"/imu": [], "/clock": []}
        for topic, seen in times.items():
            sim.subscribe(topic, lambda _, seen=seen: seen.append(sim.time_ns))
        sim.run(1.23)
        rows = {row.topic: row for row in counter.rows}
        for topic, seen in times.items():
            row = rows[topic]
            assert (row.count, row.second, row.last) == (len(heard[topic].messages), seen[1], seen[-1])


def test_messages_of_others_are_counted_on_the_topic_of_a_sensor() -> None:
    with simkit.load(WORLD) as sim:
        counter = TopicCounter(sim)
        sim.run(1.0)
        sim.publish("/imu", {})
        sim.run(1.0)
        publisher = sim.advertise("/imu", "sensor_msgs/msg/Imu")
        publisher.publish({})
        publisher.close()
        sim.publish("/imu", {})
        assert {row.topic: row.count for row in counter.rows}["/imu"] == 61 + 3


def test_the_count_of_a_removed_sensor_remains() -> None:
    with simkit.load(WORLD) as sim:
        counter = TopicCounter(sim)
        sim.run(1.0)
        sim.remove("m")
        sim.run(1.0)
        assert {row.topic: row.count for row in counter.rows}["/imu"] == 31


def test_a_sensor_that_may_leave_out_messages_is_read() -> None:
    lossy = WORLD.replace("<topic>", "<always_on>true</always_on><simkit:latency>0.05</simkit:latency><topic>")
    with simkit.load(lossy.replace("<sdf ", '<sdf xmlns:simkit="https://simkit.dev" ')) as sim:
        counter = TopicCounter(sim)
        assert sim.communication.bus.wanted("/imu")
        sim.run(1.0)
        assert {row.topic: row.count for row in counter.rows}["/imu"] == 29
