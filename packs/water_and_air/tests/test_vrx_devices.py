"""Acoustic pinger and shooter of balls of VRX."""

from __future__ import annotations

import math

import pytest

import simkit

PINGER = """<plugin filename="libAcousticPingerPlugin.so" name="vrx::AcousticPingerPlugin"><position>10 0 -5</position>
  <topic>/wamv/pinger/range_bearing</topic><set_position_topic>/wamv/pinger/set_pinger_position
  </set_position_topic><frame_id>pinger</frame_id><update_rate>10</update_rate>
  <range_noise><noise><type>gaussian</type><mean>0.0</mean><stddev>{noise}</stddev></noise></range_noise></plugin>"""
SHOOTER = """<plugin name="vrx::BallShooterPlugin" filename="libBallShooterPlugin.so"><projectile>
  <model_name>ball</model_name><link_name>link</link_name><frame>boat/launcher</frame><pose>0.5 0 0 0 0 0</pose>
  </projectile><num_shots>2</num_shots><shot_force>500</shot_force><topic>/boat/fire</topic></plugin>"""
BODY = "<inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"


def world(plugin: str, more: str = "") -> str:
    return f"""<sdf version="1.9"><world name="lake"><gravity>0 0 0</gravity>
      <physics name="p" type="ode"><max_step_size>0.004</max_step_size></physics>
      <model name="boat"><pose>0 0 1 0 0 1.5707963267948966</pose>
      <link name="boat/launcher">{BODY}</link>{plugin}</model>
      <model name="ball"><pose>5 5 5 0 0 0</pose><link name="link">{BODY}</link></model>{more}</world></sdf>"""


def test_a_pinger_is_measured_in_the_axes_of_the_boat_and_can_be_moved() -> None:
    with simkit.load(world(PINGER.format(noise=0))) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        measured = sim.subscribe("/wamv/pinger/range_bearing", keep=100)
        sim.run(1.0)
        last = {p.name: p.value.double_value for p in measured.messages[-1].params}
        assert last["range"] == pytest.approx(math.hypot(10, 6))
        assert last["bearing"] == pytest.approx(-math.pi / 2)
        assert last["elevation"] == pytest.approx(math.atan2(-6, 10))
        assert 9 <= len(measured.messages) <= 10
        sim.publish("/wamv/pinger/set_pinger_position", {"x": 0.0, "y": 3.0, "z": 1.0})
        sim.run(0.2)
        last = {p.name: p.value.double_value for p in measured.messages[-1].params}
        assert last == pytest.approx({"range": 3.0, "bearing": 0.0, "elevation": 0.0}, abs=1e-9)


def test_noise_of_a_pinger_follows_the_seed() -> None:
    def ranges(seed: int) -> list[float]:
        with simkit.load(world(PINGER.format(noise=0.5)), seed=seed) as sim:
            measured = sim.subscribe("/wamv/pinger/range_bearing", keep=1000)
            sim.run(20.0)
            return [next(p.value.double_value for p in m.params if p.name == "range") for m in measured.messages]

    first = ranges(1)
    assert first == ranges(1) != ranges(2)
    mean = math.fsum(first) / len(first)
    assert mean == pytest.approx(math.hypot(10, 6), abs=0.15)
    assert math.sqrt(math.fsum((r - mean) ** 2 for r in first) / len(first)) == pytest.approx(0.5, rel=0.2)


def test_a_ball_is_shot_along_the_launcher_as_often_as_there_are_shots() -> None:
    with simkit.load(world(SHOOTER)) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        ball = sim.link("ball::link")
        sim.run(0.1)
        assert ball.pose.position == pytest.approx([5, 5, 5], abs=1e-9)
        for _ in range(2):
            sim.publish("/boat/fire", {"data": True})
            sim.run(1.0)
            assert ball.linear_velocity == pytest.approx([0, 500 * 0.004, 0], abs=1e-6)  # force · step / mass
            assert ball.pose.position == pytest.approx([0, 0.5 + 2.0, 1.0], abs=0.02)
        sim.publish("/boat/fire", {"data": True})
        sim.run(1.0)
        assert ball.pose.position[1] == pytest.approx(0.5 + 4.0, abs=0.02)


def test_a_shooter_without_its_ball_reports_it_when_it_shoots() -> None:
    with simkit.load(world(SHOOTER.replace("<model_name>ball", "<model_name>bowl"))) as sim:
        sim.publish("/boat/fire", {"data": True})
        sim.run(0.1)
        assert any("bowl::link" in d.message for d in sim.diagnostics)
