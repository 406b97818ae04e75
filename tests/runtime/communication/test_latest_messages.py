"""The newest message of a subscription belongs to the state that a reset or a restore brings back."""

from __future__ import annotations

import pickle
from collections.abc import Iterator
from typing import Any

import pytest

import simkit

WORLD = """<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
  <model name="m"><link name="l"><inertial><mass>1</mass></inertial>
  <sensor name="imu" type="imu"><topic>imu</topic><update_rate>100</update_rate></sensor>
  </link></model></world></sdf>"""


@pytest.fixture
def sim() -> Iterator[simkit.Simulation]:
    with simkit.load(WORLD) as made:
        yield made


def stamp(message: Any) -> float:
    return message.header.stamp.sec + message.header.stamp.nanosec * 1e-9


@pytest.mark.parametrize("keep", [None, 1])
@pytest.mark.parametrize("is_read", [False, True], ids=["not read before", "read before"])
def test_after_a_reset_there_is_no_newest_message(sim: simkit.Simulation, keep: int | None, is_read: bool) -> None:
    readings = sim.subscribe("/imu", keep=keep)
    sim.run(0.5)
    if is_read:
        assert stamp(readings.latest) == pytest.approx(0.5)
    sim.reset()
    assert readings.latest is None
    sim.run(0.02)
    assert stamp(readings.latest) == pytest.approx(0.02)


@pytest.mark.parametrize("keep", [None, 1])
def test_a_restore_brings_the_newest_message_of_the_snapshot_back(sim: simkit.Simulation, keep: int | None) -> None:
    readings = sim.subscribe("/imu", keep=keep)
    sim.run(0.1)
    before = sim.snapshot()
    sim.run(0.4)
    later = sim.snapshot()
    sim.restore(before)
    assert stamp(readings.latest) == pytest.approx(0.1)
    sim.restore(later)
    assert stamp(readings.latest) == pytest.approx(0.5)
    sim.run(0.01)
    assert stamp(readings.latest) == pytest.approx(0.51)


def test_a_subscription_that_is_newer_than_the_snapshot_has_no_newest_message_after_the_restore(
    sim: simkit.Simulation,
) -> None:
    before = sim.snapshot()
    readings = sim.subscribe("/imu")
    sim.run(0.1)
    sim.restore(before)
    assert readings.latest is None


def test_all_received_messages_stay_in_the_list(sim: simkit.Simulation) -> None:
    readings = sim.subscribe("/imu")
    sim.run(0.03)
    before = [stamp(message) for message in readings.messages]
    sim.reset()
    sim.run(0.02)
    assert before == pytest.approx([0.001, 0.01, 0.02, 0.03])
    assert [stamp(message) for message in readings.messages] == [*before, *before[:3]]


def test_a_message_that_is_published_again_after_the_reset_is_the_newest_one(sim: simkit.Simulation) -> None:
    publisher, received = sim.advertise("/x", "std_msgs/msg/Float64"), sim.subscribe("/x")
    message = simkit.msgs.make("std_msgs/msg/Float64", data=4.0)
    publisher.publish(message)
    sim.reset()
    assert received.latest is None
    publisher.publish(message)
    assert received.latest is message
    assert received.messages == [message, message]


def test_a_latched_topic_still_has_its_message_after_a_reset(sim: simkit.Simulation) -> None:
    publisher, received = sim.advertise("/x", "std_msgs/msg/Float64", latched=True), sim.subscribe("/x")
    publisher.publish({"data": 4.0})
    sim.reset()
    assert received.latest.data == 4.0


def test_a_restored_snapshot_of_another_process_has_no_newest_messages(sim: simkit.Simulation) -> None:
    readings = sim.subscribe("/imu")
    sim.run(0.1)
    portable = pickle.loads(pickle.dumps(sim.snapshot()))
    sim.restore(portable)
    assert readings.latest is None
    sim.run(0.01)
    assert stamp(readings.latest) == pytest.approx(0.11)


def test_a_snapshot_does_not_change_the_messages_that_follow(sim: simkit.Simulation) -> None:
    readings = sim.subscribe("/imu", keep=2)
    sim.run(0.055)
    sim.snapshot()
    sim.run(0.015)
    assert [stamp(message) for message in readings.messages] == pytest.approx([0.06, 0.07])
