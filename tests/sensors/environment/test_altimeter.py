"""Altimeter: falling and rotating models, and a reference that a reset does not change."""

from __future__ import annotations

import math

import pytest
from sensor_worlds import noise, sensor, world

import simkit

FALLING = {"static": False, "pose": "1 2 30 0 0 0"}
TOPIC = "<topic>a</topic>"


def altimeter(block: str = "", pose: str = "0 0 0 0 0 0", rate: float = 100) -> str:
    return sensor("altimeter", f"<altimeter>{block}</altimeter>", extra=TOPIC, pose=pose, rate=rate)


def test_a_falling_body_reads_its_height_and_velocity() -> None:
    with simkit.load(world(altimeter(pose="0.1 0 0.25 0 0 0"), **FALLING)) as sim:
        sub = sim.subscribe("/a")
        sim.run(0.5)
        assert sim.topics()["/a"] == "ros_gz_interfaces/msg/Altimeter"
        for message in sub.messages:
            t = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
            # the engine's Euler steps of 1 ms are g·t·dt/2 ahead of the parabola
            assert message.vertical_position == pytest.approx(-4.9 * t * t, abs=4.9 * t * 1.01e-3)
            assert message.vertical_velocity == pytest.approx(-9.8 * t, abs=1e-9)
            assert message.vertical_reference == pytest.approx(30.25, abs=1e-12)


def test_on_a_turning_arm_the_altimeter_has_the_velocity_at_its_position() -> None:
    """The sensor is 0.5 m out on an arm that turns about y at 2 rad/s: height -0.5·sin, rate -0.5·2·cos."""
    with simkit.load(f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="m">
      <link name="base"><inertial><mass>1e6</mass><inertia><ixx>1e6</ixx><iyy>1e6</iyy><izz>1e6</izz></inertia>
      </inertial></link><link name="arm">{altimeter(pose="0.5 0 0 0 0 0", rate=0)}</link>
      <joint name="j" type="revolute"><parent>base</parent><child>arm</child><axis><xyz>0 1 0</xyz></axis></joint>
      </model></world></sdf>""") as sim:
        sim.joint("m::j").set_velocity(2.0)
        sub = sim.subscribe("/a")
        sim.step(700)
        angle, speed = sim.joint("m::j").position, sim.joint("m::j").velocity
        assert angle > 1.3
        assert sub.latest.vertical_position == pytest.approx(-0.5 * math.sin(angle), abs=1e-5)
        assert sub.latest.vertical_velocity == pytest.approx(-0.5 * speed * math.cos(angle), abs=1e-5)


def test_a_pose_that_is_set_a_reset_and_a_restore_leave_the_reference_alone() -> None:
    with simkit.load(world(altimeter(), **FALLING)) as sim:
        sim.model("m").set_pose(simkit.Pose((0, 0, 42)))
        sim.step(1)
        eye = sim.sensor("m::l::s")
        assert eye.latest.vertical_position == pytest.approx(12.0, abs=1e-4)
        before = sim.snapshot()
        sim.reset()
        sim.step(1)
        assert eye.latest.vertical_reference == 30.0
        assert eye.latest.vertical_position == pytest.approx(0.0, abs=1e-4)
        sim.restore(before)
        sim.run(0.02)
        assert eye.latest.vertical_reference == 30.0
        assert eye.latest.vertical_position == pytest.approx(12.0, abs=1e-2)


def test_a_spawned_altimeter_measures_from_its_spawn_height() -> None:
    model = f'<sdf version="1.9"><model name="d"><static>true</static><link name="l">{altimeter()}</link></model></sdf>'
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>') as sim:
        sim.step(10)
        sim.spawn(model, pose=simkit.Pose((0, 0, 7)))
        sim.run(0.1)
        assert sim.sensor("d::l::s").latest.vertical_reference == 7.0
        sim.model("d").set_pose(simkit.Pose((0, 0, 9)))
        sim.run(0.1)
        assert sim.sensor("d::l::s").latest.vertical_position == pytest.approx(2.0)
        assert sim.sensor("d::l::s").latest.vertical_velocity == 0.0
        sim.remove("d")
        assert "/a" not in sim.topics()
        sim.spawn(model, pose=simkit.Pose((0, 0, 1)))
        sim.run(0.1)
        assert sim.sensor("d::l::s").latest.vertical_reference == 1.0


def test_both_channels_have_noise_of_their_own() -> None:
    blocks = (
        f"<vertical_position>{noise(0.5)}</vertical_position>"
        f"<vertical_velocity>{noise(0.1, more='<bias_mean>3</bias_mean>')}</vertical_velocity>"
    )
    with simkit.load(world(altimeter(blocks, rate=0)), seed=5) as sim:
        sub = sim.subscribe("/a")
        sim.step(4000)
        heights = [m.vertical_position for m in sub.messages]
        rates = [m.vertical_velocity for m in sub.messages]
        assert sum(heights) / 4000 == pytest.approx(0.0, abs=0.03)
        assert math.sqrt(sum(h * h for h in heights) / 4000) == pytest.approx(0.5, rel=0.05)
        assert sum(rates) / 4000 == pytest.approx(3.0, abs=0.01)
        correlation = sum(h * (r - 3) for h, r in zip(heights, rates, strict=True)) / 4000 / 0.05
        assert abs(correlation) < 0.06
        assert sim.sensor("m::l::s").truth.vertical_position == 0.0
