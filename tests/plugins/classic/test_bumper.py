"""Bumper of Gazebo Classic."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import simkit
from simkit import msgs

G = 9.8
GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
</collision></link></model>"""


def plugin(content: str = "", name: str = "bumper") -> str:
    return f'<plugin name="{name}" filename="libgazebo_ros_bumper.so">{content}</plugin>'


def world(content: str, pose: str = "1 2 0.1 0 0 0", rate: float = 50, more: str = "", top: str = "") -> str:
    """A box of 2 kg with a contact sensor, whose centre of mass is 0.02 m off its middle."""
    moments = "".join(f"<{axis}>0.01</{axis}>" for axis in ("ixx", "iyy", "izz"))
    return f"""<sdf version="1.9"><world name="w">{top}{GROUND}{more}
    <model name="box"><pose>{pose}</pose><link name="body">
    <inertial><pose>0.02 0 0 0 0 0</pose><mass>2</mass><inertia>{moments}</inertia></inertial>
    <collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
    <sensor name="s" type="contact"><update_rate>{rate}</update_rate><contact><collision>c</collision></contact>
    {content}</sensor></link></model></world></sdf>"""


def xyz(message: Any) -> np.ndarray:
    return np.array((message.x, message.y, message.z))


@pytest.mark.parametrize(
    ("content", "topic"),
    [
        ("", "/bumper_states"),
        ("<ros><namespace>tb3</namespace></ros>", "/tb3/bumper_states"),
        ("<ros><remapping>bumper_states:=front/touch</remapping></ros>", "/front/touch"),
        ("<bumperTopicName>box_bumper</bumperTopicName><robotNamespace>r</robotNamespace>", "/r/box_bumper"),
    ],
)
def test_the_bumper_publishes_on_the_ros_topic(content: str, topic: str) -> None:
    with simkit.load(world(plugin(content))) as sim:
        assert sim.topics()[topic] == "gazebo_msgs/msg/ContactsState"
        assert not [t for t in sim.topics() if t.startswith("/world/") and t not in sim.communication.bus.aside]
        assert sim.sensor("box::body::s").topic == topic
        assert not [d for d in sim.diagnostics if d.severity != "note"]


def test_at_rest_the_total_wrench_is_the_weight_and_no_torque() -> None:
    with simkit.load(world(plugin())) as sim:
        sub = sim.subscribe("/bumper_states")
        sim.run(1.0)
        assert len(sub.messages) == 51
        message = sub.latest
        assert message.header.frame_id == "world"
        (state,) = message.states
        assert (state.collision1_name, state.collision2_name) == ("box::body::c", "ground::l::c")
        assert "my geom: [box::body::c]  other geom: [ground::l::c]" in state.info
        np.testing.assert_allclose(xyz(state.total_wrench.force), (0, 0, 2 * G), atol=1e-3)
        # about the centre of mass, where nothing turns what rests; about the middle it were 2 g · 0.02
        np.testing.assert_allclose(xyz(state.total_wrench.torque), 0, atol=1e-3)
        assert len(state.wrenches) == len(state.contact_positions) == len(state.contact_normals) == 4
        total = sum(xyz(w.force) for w in state.wrenches)
        np.testing.assert_allclose(xyz(state.total_wrench.force), total, atol=1e-12)
        corners = sorted((round(p.x, 2), round(p.y, 2)) for p in state.contact_positions)
        assert corners == [(0.9, 1.9), (0.9, 2.1), (1.1, 1.9), (1.1, 2.1)]


def test_an_empty_message_is_published_without_contacts() -> None:
    with simkit.load(world(plugin(), pose="0 0 5 0 0 0")) as sim:
        sub = sim.subscribe("/bumper_states")
        sim.run(0.1)
        assert [m.states for m in sub.messages] == [[]] * 6
        assert [msgs.stamp_ns(m.header.stamp) for m in sub.messages] == [10**6, *(k * 20_000_000 for k in range(1, 6))]


TURNED = (
    """<model name="mast"><static>true</static><pose>1 1 0 0 0 1.5707963267948966</pose><link name="eye"/></model>"""
)


@pytest.mark.parametrize("element", ["frame_name", "frameName"])
@pytest.mark.parametrize("frame", ["eye", "mast::eye", "/eye"])
def test_contacts_are_in_the_frame_of_the_named_link(frame: str, element: str) -> None:
    """The mast is turned to the left, so a point 1 m to the left in the world is ahead of the mast."""
    with simkit.load(world(plugin(f"<{element}>{frame}</{element}>"), more=TURNED)) as sim:
        sub = sim.subscribe("/bumper_states", keep=1)
        sim.run(0.5)
        for _ in range(100):
            sim.link("box::body").apply_wrench((3, 0, 0))
            sim.step()
        assert sub.latest.header.frame_id == frame.strip("/")
        (state,) = sub.latest.states
        middle = np.mean([xyz(p) for p in state.contact_positions], axis=0)
        np.testing.assert_allclose(middle, (1, 0, 0), atol=1e-3)
        # friction along the world's -x is along the mast's +y
        np.testing.assert_allclose(xyz(state.total_wrench.force), (0, 3, 2 * G), atol=0.05)
        # and it acts 0.1 m below the centre of mass: about the world's y, the mast's -x
        np.testing.assert_allclose(xyz(state.total_wrench.torque), (0, 0, 0), atol=0.02)
        np.testing.assert_allclose(xyz(state.contact_normals[0]), (0, 0, 1), atol=1e-6)


def test_the_sensors_own_link_is_preferred_and_its_frame_rotates() -> None:
    tower = TURNED.replace("eye", "body")
    with simkit.load(world(plugin("<frame_name>body</frame_name>"), "0 0 0.1 0 0 1.2", more=tower)) as sim:
        sub = sim.subscribe("/bumper_states", keep=1)
        sim.run(0.3)
        corners = sorted((round(p.x, 3), round(p.y, 3)) for p in sub.latest.states[0].contact_positions)
        assert corners == [(-0.1, -0.1), (-0.1, 0.1), (0.1, -0.1), (0.1, 0.1)]


def test_a_missing_frame_is_reported_and_used_once_it_exists() -> None:
    with simkit.load(world(plugin("<frame_name>eyes</frame_name>"))) as sim:
        (found,) = [d for d in sim.diagnostics if d.code == "SK-SENSOR-042"]
        assert found.severity == "warning"
        sub = sim.subscribe("/bumper_states", keep=1)
        sim.run(0.1)
        assert sub.latest.header.frame_id == "world"
        assert sub.latest.states[0].contact_positions[0].y > 1.8
        sim.spawn(f'<sdf version="1.9">{TURNED.replace("eye", "eyes")}</sdf>')
        sim.run(0.1)
        assert sub.latest.header.frame_id == "eyes"
        assert abs(sub.latest.states[0].contact_positions[0].y) < 0.2
        sim.remove("mast")
        sim.run(0.1)
        assert sub.latest.header.frame_id == "world"


def test_with_gazebo_quirks_only_the_header_has_the_frame() -> None:
    quirks = "<gazebo_quirks>true</gazebo_quirks>"
    with simkit.load(world(plugin("<frame_name>eye</frame_name>"), more=TURNED, top=quirks)) as sim:
        sub = sim.subscribe("/bumper_states")
        sim.run(0.1)
        assert len(sub.messages) == 6  # Classic keeps to the sensor's rate
        assert sub.latest.header.frame_id == "eye"
        assert sub.latest.states[0].contact_positions[0].y > 1.8


def test_on_another_sensor_it_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="needs a sensor of type contact; this sensor is 'imu'"):
        simkit.load(world(plugin()).replace('type="contact"', 'type="imu"'))


def test_a_message_survives_serialisation() -> None:
    with simkit.load(world(plugin())) as sim:
        sim.run(0.1)
        message = sim.sensor("box::body::s").latest
        again = msgs.deserialize(msgs.serialize(message), "gazebo_msgs/msg/ContactsState")
        assert again.states[0].total_wrench.force.z == message.states[0].total_wrench.force.z
        assert again.states[0].info == message.states[0].info
