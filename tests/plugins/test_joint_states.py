"""Joint state publishers: joints, their order, topic and rate."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from plugin_worlds import GROUND, classic_drive, rover, stamps, world

import simkit

CLASSIC = "<plugin name='states' filename='libgazebo_ros_joint_state_publisher.so'>{}</plugin>"
GZ = "<plugin name='gz::sim::systems::JointStatePublisher' filename='gz-sim-joint-state-publisher-system'>{}</plugin>"


def opened(plugin: str, inner: str) -> simkit.Simulation:
    return simkit.load(world(GROUND, rover(classic_drive() + plugin.format(inner))))


def received(sim: simkit.Simulation, topic: str, seconds: float) -> list[Any]:
    subscription = sim.subscribe(topic)
    sim.run(seconds)
    return list(subscription.messages)


def test_classic_publishes_the_listed_joints_in_their_order() -> None:
    inner = "<update_rate>20</update_rate><joint_name>right_wheel</joint_name><joint_name>left_wheel</joint_name>"
    with opened(CLASSIC, inner) as sim:
        sim.publish("/cmd_vel", {"angular": {"z": 0.5}})
        messages = received(sim, "/joint_states", 0.5)
        latest = messages[-1]
        joints = [sim.joint(f"rover::{name}") for name in latest.name]
        np.testing.assert_array_equal(stamps(messages), np.arange(1, 11) * 50_000_000)
        assert list(latest.name) == ["right_wheel", "left_wheel"]
        np.testing.assert_array_equal(latest.position, [j.position for j in joints])
        np.testing.assert_array_equal(latest.velocity, [j.velocity for j in joints])
        np.testing.assert_array_equal(latest.effort, [j.effort for j in joints])
    assert latest.position[0] > 0.1 > -0.1 > latest.position[1]


def test_classic_needs_a_joint() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-001.*joint_name"):
        opened(CLASSIC, "")


def test_an_unknown_joint_is_an_error_with_the_closest() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003(.|\n)*did you mean 'left_wheel'"):
        opened(CLASSIC, "<joint_name>left_wheal</joint_name>")


def test_gz_publishes_every_joint_at_every_step_on_the_worlds_topic() -> None:
    with opened(GZ, "") as sim:
        messages = received(sim, "/world/lab/model/rover/joint_state", 0.01)
    assert len(messages) == 10
    assert list(messages[0].name) == ["left_wheel", "right_wheel", "front_weld", "rear_weld"]
    assert messages[0].position[2] == 0.0


def test_gz_reads_joints_topic_and_rate_from_the_file() -> None:
    with opened(GZ, "<joint_name>left_wheel</joint_name><topic>joints</topic><update_rate>10</update_rate>") as sim:
        messages = received(sim, "/joints", 1.0)
    assert len(messages) == 10
    assert list(messages[0].name) == ["left_wheel"]


def test_a_ball_joint_gives_three_numbered_entries() -> None:
    ball = (
        "<link name='bob'><pose>0 0 0.5 0 0 0</pose><inertial><mass>0.1</mass></inertial></link>"
        "<joint name='hip' type='ball'><parent>base</parent><child>bob</child></joint>"
    )
    with simkit.load(world(GROUND, rover(GZ.format(""), extra=ball))) as sim:
        (message,) = received(sim, "/world/lab/model/rover/joint_state", 0.001)
    assert list(message.name)[-3:] == ["hip[0]", "hip[1]", "hip[2]"]
    assert len(message.position) == len(message.velocity) == len(message.effort) == len(message.name)


def test_gz_publishes_a_joint_listed_twice_only_once() -> None:
    twice = "<joint_name>left_wheel</joint_name><joint_name>right_wheel</joint_name><joint_name>left_wheel</joint_name>"
    with opened(GZ, twice) as sim:
        (message,) = received(sim, "/world/lab/model/rover/joint_state", 0.001)
        assert list(message.name) == ["left_wheel", "right_wheel"]
        (told,) = [d for d in sim.diagnostics if d.severity != "note"]
        assert (told.code, told.severity) == ("SK-PLUGIN-063", "warning")


def test_gz_on_a_nested_model_has_both_names_in_its_topic() -> None:
    """Check that an outer model publishes only its own joints, as in gz."""
    nested = (
        f"<model name='arm'>{GZ.format('')}<link name='upper'/><link name='lower'/><joint name='elbow' type='revolute'>"
        "<parent>upper</parent><child>lower</child><axis><xyz>0 0 1</xyz></axis></joint></model>"
        "<joint name='mount' type='fixed'><parent>base</parent><child>arm::upper</child></joint>"
    )
    with simkit.load(world(GROUND, rover(GZ.format("") + nested))) as sim:
        (inner,) = received(sim, "/world/lab/model/rover/model/arm/joint_state", 0.001)
        (outer,) = received(sim, "/world/lab/model/rover/joint_state", 0.001)
    assert list(inner.name) == ["elbow"]
    assert list(outer.name) == ["left_wheel", "right_wheel", "front_weld", "rear_weld", "mount"]


def test_classic_on_ros_1_lists_its_joints_with_commas() -> None:
    inner = (
        "<jointName>left_wheel, right_wheel</jointName><updateRate>10</updateRate><robotNamespace>/tb</robotNamespace>"
    )
    with opened(CLASSIC, inner) as sim:
        messages = received(sim, "/tb/joint_states", 1.0)
        assert not [d for d in sim.diagnostics if d.severity != "note"]
    assert len(messages) == 10
    assert list(messages[0].name) == ["left_wheel", "right_wheel"]


def test_classic_publishes_at_100_hz_by_default() -> None:
    with opened(CLASSIC, "<joint_name>left_wheel</joint_name>") as sim:
        assert len(received(sim, "/joint_states", 0.5)) == 50


@pytest.mark.parametrize("kind", [CLASSIC, GZ])
def test_a_negative_rate_is_an_error(kind: str) -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002.*-5"):
        opened(kind, "<joint_name>left_wheel</joint_name><update_rate>-5</update_rate>")
