"""Elevator of Gazebo Classic: one door, floors of equal height, floor numbers as text."""

from __future__ import annotations

import math

import pytest
from lift_worlds import bare
from plugin_worlds import world

import simkit

JOINTS = "<lift_joint>lift</lift_joint><door_joint>door</door_joint>"
TOPIC = "/gazebo/lab/elevator"


def plugin(parameters: str = "<floor_height>3</floor_height>", library: str = "ElevatorPlugin") -> str:
    return f'<plugin name="elevator" filename="lib{library}.so">{JOINTS}{parameters}</plugin>'


def load(*args: str, mass: float = 500.0, **options: str) -> simkit.Simulation:
    return simkit.load(world(bare(plugin(*args, **options), mass), step=0.004))


def test_the_cabin_approaches_the_floor_like_a_spring_and_damper() -> None:
    sim = load("<floor_height>3</floor_height><door_wait_time>1</door_wait_time>")
    lift, door = sim.joint("lift_1::lift"), sim.joint("lift_1::door")
    sim.run(8.0)
    sag = -500 * 9.8 / 1e5
    assert lift.position == pytest.approx(sag, abs=2e-3)
    sim.publish(TOPIC, {"data": "1"})
    sim.run(2.0)
    # heavily damped: the error goes with exp(-t p/d)
    assert lift.position == pytest.approx(3.0 + sag - 3.0 * math.exp(-2.0), abs=0.02)
    assert door.position == pytest.approx(0.0, abs=1e-3)
    sim.run(1.6)  # 0.15 m from the floor at about 3.4 s; from there on the door opens
    assert 0.0 < door.position < 0.2
    sim.run(1.5)
    assert door.position > 0.9


def test_the_door_closes_after_the_wait_and_the_cabin_returns_on_command() -> None:
    sim = load("<floor_height>2</floor_height><door_wait_time>2</door_wait_time>")
    lift, door = sim.joint("lift_1::lift"), sim.joint("lift_1::door")
    sim.publish(TOPIC, {"data": "2"})
    sim.run(20.0)
    assert lift.position == pytest.approx(4.0, abs=0.06)
    assert door.position == pytest.approx(0.0, abs=0.05)
    sim.publish(TOPIC, {"data": "-0 please"})  # as far as it is a number, as Gazebo reads it
    sim.run(20.0)
    assert lift.position == pytest.approx(0.0, abs=0.06)


def test_a_command_during_a_ride_is_ignored() -> None:
    sim = load()
    sim.publish(TOPIC, {"data": "1"})
    sim.run(0.1)
    sim.publish(TOPIC, {"data": "4"})
    sim.run(6.0)
    assert sim.joint("lift_1::lift").position == pytest.approx(3.0, abs=0.06)


def test_ros_names_and_bounds_apply_and_invalid_floors_are_reported() -> None:
    inner = "<ros><namespace>hotel</namespace></ros><floor_height>1</floor_height>"
    sim = load(f"{inner}<bottom_floor>-1</bottom_floor><top_floor>3</top_floor>", library="gazebo_ros_elevator")
    for text in ("attic", "4", "-2"):
        sim.publish("/hotel/elevator", {"data": text})
    sim.run(2.0)
    assert abs(sim.joint("lift_1::lift").position) < 0.06
    messages = [d.message for d in sim.diagnostics if d.code == "SK-PLUGIN-041"]
    assert [any(word in m for m in messages) for word in ("attic", "highest floor is 3", "lowest floor is -1")] == [
        True
    ] * 3
    sim.publish("/hotel/elevator", {"data": "3"})
    sim.run(6.0)
    assert sim.joint("lift_1::lift").position == pytest.approx(3.0, abs=0.06)


def test_a_light_cabin_is_held_and_a_spawn_does_not_drop_it() -> None:
    sim = load(mass=5.0)
    sim.publish(TOPIC, {"data": "1"})
    sim.run(6.0)
    sim.spawn("<sdf version='1.9'><model name='ball'><pose>5 0 9 0 0 0</pose><link name='l'/></model></sdf>")
    sim.run(0.5)
    assert sim.joint("lift_1::lift").position == pytest.approx(3.0, abs=0.02)


def test_reset_returns_to_the_ground_floor_and_restore_continues() -> None:
    sim = load("<floor_height>3</floor_height><door_wait_time>1</door_wait_time>")
    sim.publish(TOPIC, {"data": "1"})
    sim.run(2.0)
    snapshot = sim.snapshot()
    sim.run(3.0)
    door, lift = sim.joint("lift_1::door").position, sim.joint("lift_1::lift").position
    sim.reset()
    sim.run(3.0)
    assert abs(sim.joint("lift_1::lift").position) < 0.06
    sim.restore(snapshot)
    sim.run(3.0)
    assert (sim.joint("lift_1::door").position, sim.joint("lift_1::lift").position) == (door, lift)


def test_all_errors_are_reported_in_one_pass() -> None:
    with pytest.raises(simkit.InputError) as caught:
        simkit.load(world(bare(plugin("<door_wait_time>-1</door_wait_time>").replace(">door<", ">dor<"))))
    assert "door_wait_time" in str(caught.value)
    assert "'door'" in str(caught.value)
    assert "SK-PLUGIN-137" in [d.code for d in load("").diagnostics]
