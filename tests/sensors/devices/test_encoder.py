"""Joint encoders: counts, starts, velocities from counts, noise, joints of every kind."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from sensor_worlds import noise

import simkit

TURN = 2 * math.pi


def encoder(block: str = "", rate: float = 100, extra: str = "") -> str:
    return (
        f'<sensor name="e" type="custom" gz:type="encoder"><update_rate>{rate}</update_rate><topic>e</topic>{extra}'
        f"<simkit:encoder>{block}</simkit:encoder></sensor>"
    )


def world(inside: str, kind: str = "revolute", axis: str = "0 0 1", more: str = "", ends: str = "base load") -> str:
    parent, child = ends.split()
    axes = f"<axis><xyz>{axis}</xyz></axis>" if axis else ""
    return f"""<sdf version="1.9" xmlns:gz="g" xmlns:simkit="s"><world name="w"><gravity>0 0 0</gravity><model name="m">
<link name="base"><inertial><mass>1</mass></inertial></link><link name="load"><inertial><mass>1</mass></inertial></link>
<joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
<joint name="j" type="{kind}"><parent>{parent}</parent><child>{child}</child>{axes}{more}{inside}</joint>
</model></world></sdf>"""


def run(text: str, velocity: Any, seconds: float = 1.0, start: Any = None) -> tuple[list[Any], Any]:
    """Return the messages of a joint that starts with `velocity`, and the last message without noise."""
    with simkit.load(text) as sim:
        sub = sim.subscribe("/e")
        if start is not None:
            sim.joint("m::j").set_position(start)
        sim.joint("m::j").set_velocity(velocity)
        sim.run(seconds)
        return sub.messages, sim.sensor("m::j::e").truth


def test_a_position_is_the_nearest_count_and_the_truth_is_not_counted() -> None:
    messages, truth = run(world(encoder("<counts_per_revolution>100</counts_per_revolution>")), 0.7)
    assert len(messages) == 101
    assert messages[-1].name == ["j"]
    assert truth.position[0] == pytest.approx(0.7, abs=1e-6)
    assert truth.velocity[0] == pytest.approx(0.7, abs=1e-6)
    for message in messages:
        time = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
        assert message.position[0] == pytest.approx(TURN / 100 * math.floor(0.7 * time / (TURN / 100) + 0.5), abs=1e-9)


def test_the_error_of_counting_is_uniform_within_half_a_count() -> None:
    step = 0.01
    messages, _ = run(world(encoder(f"<resolution>{step}</resolution>", rate=1000)), 1.2345, 3.0)
    times = np.array([m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in messages])
    errors = np.array([m.position[0] for m in messages]) - 1.2345 * times
    assert np.abs(errors).max() <= step / 2 + 1e-6
    assert errors.std() == pytest.approx(step / math.sqrt(12), rel=0.02)
    assert errors.mean() == pytest.approx(0, abs=step / 50)


def test_a_velocity_from_counts_is_their_difference_over_the_window() -> None:
    """At 100 Hz, a count of 0.01 rad is 1 rad/s; with a window of ten samples, a count is 0.1 rad/s."""
    for window, unit in ((0.0, 1.0), (0.1, 0.1)):
        block = f"<resolution>0.01</resolution><velocity><window>{window}</window></velocity>"
        messages, _ = run(world(encoder(block)), 0.73)
        counts = np.array([m.position[0] for m in messages])
        told = np.array([m.velocity[0] for m in messages])
        back = round(window * 100) or 1
        # the first sample is that of the first step, off the grid
        first = back + 1
        np.testing.assert_allclose(told[first:], (counts[first:] - counts[1:-back]) / (back * 0.01), atol=1e-9)
        steps = told[first:] / unit
        np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)
        assert told[0] == 0.0
        # before the window is full, the velocity is computed from the first count
        assert told[1] == pytest.approx(counts[1] / 0.009)


def test_the_joint_s_own_velocity_has_a_resolution_and_noise_of_its_own() -> None:
    block = "<velocity><source>joint</source><resolution>0.25</resolution></velocity>"
    messages, _ = run(world(encoder(block)), 0.7)
    assert {m.velocity[0] for m in messages} == {0.75}
    assert messages[-1].position[0] == pytest.approx(0.7, abs=1e-6)
    block = f"<position>{noise(0.02)}</position><velocity><source>joint</source>{noise(0.1)}</velocity>"
    messages, truth = run(world(encoder(block, rate=1000)), 0.0, 2.0)
    assert np.std([m.position[0] for m in messages]) == pytest.approx(0.02, rel=0.1)
    assert np.std([m.velocity[0] for m in messages]) == pytest.approx(0.1, rel=0.1)
    assert (truth.position[0], truth.velocity[0]) == (0, 0)


def test_noise_comes_before_the_counts_and_shows_in_their_differences() -> None:
    block = f"<resolution>0.01</resolution><position>{noise(0.02)}</position>"
    messages, _ = run(world(encoder(block, rate=1000)), 0.0, 2.0)
    counts = np.array([m.position[0] for m in messages]) / 0.01
    np.testing.assert_allclose(counts, np.round(counts), atol=1e-9)
    assert counts.std() == pytest.approx(math.hypot(2, 1 / math.sqrt(12)), rel=0.1)
    told = np.array([m.velocity[0] for m in messages])
    np.testing.assert_allclose(told[1:], np.diff(counts) * 0.01 / 0.001, atol=1e-6)


def test_an_incremental_encoder_counts_from_the_position_at_load() -> None:
    block = "<absolute>false</absolute><resolution>0.01</resolution>"
    initial = world(encoder(block)).replace(
        "</model>",
        "</model><state world_name='w'><model name='m'><joint name='j'><angle axis='0'>1.0</angle></joint></model>"
        "</state>",
    )
    with simkit.load(initial) as sim:
        at_start = float(sim.joint("m::j").position)
        sim.joint("m::j").set_velocity(0.5)
        sim.run(1.0)
        assert sim.sensor("m::j::e").latest.position[0] == pytest.approx(0.5, abs=0.006)
        assert sim.sensor("m::j::e").truth.position[0] == pytest.approx(0.5, abs=1e-6)
        assert sim.joint("m::j").position == pytest.approx(at_start + 0.5)
        sim.reset()
        sim.run(0.1)
        assert sim.sensor("m::j::e").latest.position[0] == pytest.approx(0, abs=1e-9)
    messages, _ = run(world(encoder("<resolution>0.01</resolution>")), 0.0, 0.1, start=1.0)
    assert messages[-1].position[0] == pytest.approx(1.0)


KINDS = {
    "revolute": ("0 0 1", "", (0.3,)),
    "continuous": ("0 0 1", "", (0.3,)),
    "prismatic": ("0 0 1", "", (0.3,)),
    "screw": ("0 0 1", "<screw_thread_pitch>0.1</screw_thread_pitch>", (0.3,)),
    "universal": ("1 0 0", "<axis2><xyz>0 1 0</xyz></axis2>", (0.3, 0.2)),
    "revolute2": ("1 0 0", "<axis2><xyz>0 1 0</xyz></axis2>", (0.3, 0.2)),
    "ball": ("", "", (0.3, 0.2, 0.1)),
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("ends", ["base load", "load base"])
def test_every_axis_of_every_joint_is_counted(kind: str, ends: str) -> None:
    axis, more, velocity = KINDS[kind]
    text = world(encoder("<resolution>0.001</resolution>"), kind, axis, more, ends)
    with simkit.load(text) as sim:
        joint = sim.joint("m::j")
        joint.set_velocity(velocity if len(velocity) > 1 else velocity[0])
        sim.run(0.5)
        latest, truth = sim.sensor("m::j::e").latest, sim.sensor("m::j::e").truth
        names = ["j"] if len(velocity) == 1 else [f"j[{i}]" for i in range(len(velocity))]
        assert latest.name == names
        np.testing.assert_allclose(truth.position, np.atleast_1d(joint.position), atol=1e-9)
        np.testing.assert_allclose(truth.velocity, np.atleast_1d(joint.velocity), atol=1e-9)
        np.testing.assert_allclose(latest.position, truth.position, atol=0.0005 + 1e-9)
        np.testing.assert_allclose(latest.velocity, truth.velocity, atol=0.2)


def test_on_a_planar_joint_of_a_urdf_robot_it_counts_lengths_and_the_angle() -> None:
    inertial = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    text = f"""<robot name="m" xmlns:gz="g" xmlns:simkit="s"><link name="world"/><link name="l">{inertial}</link>
<joint name="j" type="planar"><parent link="world"/><child link="l"/><axis xyz="0 0 1"/></joint>
<gazebo reference="j">{encoder("<resolution>0.001</resolution>")}</gazebo></robot>"""
    with simkit.load(text) as sim:
        sim.joint("m::j").set_velocity((0.1, 0.2, 0.3))
        sim.run(0.5)
        np.testing.assert_allclose(sim.sensor("m::j::e").latest.position, (0.05, 0.1, 0.15), atol=2e-3)


@pytest.mark.parametrize("extra", ["", "<simkit:latency>0.05</simkit:latency>"])
def test_a_reading_that_is_computed_later_is_the_same(extra: str) -> None:
    """The reader, the time of reading and the latency do not change a reading."""
    block = f"<resolution>0.01</resolution><position>{noise(0.02)}</position><velocity><window>0.03</window></velocity>"
    text = world(encoder(block, extra=extra))
    with simkit.load(text) as heard, simkit.load(text) as unheard:
        sub = heard.subscribe("/e")
        for sim in (heard, unheard):
            sim.joint("m::j").set_velocity(2.0)
        heard.step(777)
        for count in (100, 377, 300):
            unheard.step(count)
            late = unheard.sensor("m::j::e").latest
        early = sub.latest
        assert (early.position[0], early.velocity[0]) == (late.position[0], late.velocity[0])
        before = unheard.snapshot()
        unheard.step(200)
        first = unheard.sensor("m::j::e").latest
        unheard.restore(before)
        unheard.step(200)
        again = unheard.sensor("m::j::e").latest
        assert (first.position[0], first.velocity[0]) == (again.position[0], again.velocity[0])


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (world(encoder("<resolution>1</resolution><counts_per_revolution>8</counts_per_revolution>")), "SK-PARAM-002"),
        (world(encoder("<resolution>-1</resolution>")), "SK-PARAM-002"),
        (world(encoder("<velocity><source>guess</source></velocity>")), "SK-PARAM-002"),
        (world(encoder("<counts_per_revolution>8</counts_per_revolution>"), "prismatic"), "SK-SENSOR-051"),
        (world(encoder(), "fixed", ""), "SK-SENSOR-051"),
    ],
)
def test_a_joint_that_an_encoder_cannot_measure_is_an_error(text: str, code: str) -> None:
    with pytest.raises(simkit.LoadError, match=code):
        simkit.load(text)


def test_an_unknown_element_of_an_encoder_is_reported_as_unused() -> None:
    with simkit.load(world(encoder("<resolutoin>0.1</resolutoin>"))) as sim:
        assert any(d.code == "SK-PARAM-003" and "resolutoin" in d.message for d in sim.diagnostics)
