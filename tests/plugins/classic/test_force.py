"""Force on a link in Gazebo Classic."""

from __future__ import annotations

import math

import numpy as np
import pytest
from joint_worlds import codes, load

from simkit import LoadError

BODY = """<link name="body"><pose>0 0 0 0 0 1.5707963267948966</pose><inertial><pose>0.1 0 0 0 0 0</pose><mass>2</mass>
<inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.4</izz></inertia></inertial></link>"""


def push(content: str) -> str:
    return f'<plugin name="pusher" filename="libgazebo_ros_force.so">{content}</plugin>'


LINK = "<link_name>body</link_name>"


def test_the_force_acts_at_the_centre_of_mass_until_the_next_message() -> None:
    sim = load(BODY, push(f"{LINK}<ros><namespace>/lab</namespace><remapping>gazebo_ros_force:=push</remapping></ros>"))
    assert sim.topics()["/lab/push"] == "geometry_msgs/msg/Wrench"
    link = sim.link("m::body")
    sim.publish("/lab/push", {"force": {"x": 3.0}})
    sim.run(0.5)
    np.testing.assert_allclose(link.linear_velocity, [3.0 / 2.0 * 0.5, 0.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(link.angular_velocity, 0.0, atol=1e-9)
    sim.publish("/lab/push", {"torque": {"z": 0.8}})
    sim.run(0.5)
    assert link.angular_velocity[2] == pytest.approx(0.8 / 0.4 * 0.5, rel=1e-6)
    sim.publish("/lab/push", {})
    sim.run(0.5)
    assert link.angular_velocity[2] == pytest.approx(1.0, rel=1e-6)


def test_in_the_links_frame_the_force_rotates_with_the_link() -> None:
    sim = load(BODY, push(f"{LINK}<force_frame>link</force_frame>"))
    link = sim.link("m::body")
    sim.publish("/gazebo_ros_force", {"force": {"x": 3.0}})
    sim.run(0.5)  # its x is the world's y
    np.testing.assert_allclose(link.linear_velocity, [0.0, 0.75, 0.0], atol=1e-9)
    snapshot = sim.snapshot()
    sim.run(0.5)
    end = link.linear_velocity
    sim.restore(snapshot)
    sim.run(0.5)
    assert np.array_equal(link.linear_velocity, end)
    sim.reset()
    sim.run(0.5)
    assert not link.linear_velocity.any()


def test_the_spelling_of_ros_1_is_supported() -> None:
    content = "<robotNamespace>lab</robotNamespace><bodyName>body</bodyName><topicName>shove</topicName>"
    sim = load(BODY, push(content))
    sim.publish("/lab/shove", {"force": {"y": 4.0}})
    sim.run(0.5)
    np.testing.assert_allclose(sim.link("m::body").linear_velocity, [0.0, 1.0, 0.0], atol=1e-9)


def test_a_restore_brings_back_the_force() -> None:
    sim = load(BODY, push(LINK))
    sim.publish("/gazebo_ros_force", {"force": {"x": 2.0}})
    sim.run(0.1)
    snapshot = sim.snapshot()
    sim.publish("/gazebo_ros_force", {"force": {"x": -50.0}})
    sim.run(0.1)
    sim.restore(snapshot)
    sim.run(0.1)
    assert sim.link("m::body").linear_velocity[0] == pytest.approx(0.2, rel=1e-9)


def test_an_invalid_wrench_is_reported() -> None:
    with pytest.raises(LoadError, match="no link 'bodi'"):
        load(BODY, push("<link_name>bodi</link_name>"))
    with pytest.raises(LoadError, match="no link ''; it has: 'body'"):
        load(BODY, push("<link_name/>"))
    with pytest.raises(LoadError, match="needs <link_name>"):
        load(BODY, push(""))
    with pytest.raises(LoadError, match="needs <topicName>"):
        load(BODY, push("<bodyName>body</bodyName>"))
    with pytest.raises(LoadError, match="one of world, link"):
        load(BODY, push(f"{LINK}<force_frame>base</force_frame>"))
    sim = load(BODY, push(LINK))
    sim.publish("/gazebo_ros_force", {"force": {"x": math.nan}})
    sim.step(2)
    assert len(codes(sim.diagnostics, "SK-PLUGIN-041")) == 1


def test_a_reset_ends_two_forces_and_a_restore_brings_both_back() -> None:
    other = BODY.replace('name="body"', 'name="other"')
    sim = load(BODY, other, push("<link_name>other</link_name>") + push(f"{LINK}<ros><namespace>/a</namespace></ros>"))
    for topic in ("/gazebo_ros_force", "/a/gazebo_ros_force"):
        sim.publish(topic, {"force": {"x": 2.0}})
    sim.run(0.1)
    snapshot = sim.snapshot()
    sim.reset()
    sim.run(0.1)
    assert [sim.link(f"m::{n}").linear_velocity[0] for n in ("body", "other")] == [0.0, 0.0]
    sim.restore(snapshot)
    sim.run(0.1)
    speeds = [sim.link(f"m::{n}").linear_velocity[0] for n in ("body", "other")]
    assert speeds == pytest.approx([0.2, 0.2], rel=1e-9)


def test_a_new_model_with_the_name_of_a_pushed_one_is_not_pushed() -> None:
    sim = load(BODY, push(LINK))
    text = f'<sdf version="1.9"><model name="m">{BODY}{push(LINK)}</model></sdf>'
    sim.publish("/gazebo_ros_force", {"force": {"x": 2.0}})
    sim.run(0.1)
    snapshot = sim.snapshot()
    sim.remove("m")
    sim.spawn(text, name="m")
    sim.run(0.1)
    assert not sim.link("m::body").linear_velocity.any()
    sim.restore(snapshot)
    sim.run(0.1)
    assert sim.link("m::body").linear_velocity[0] == pytest.approx(0.2, rel=1e-9)
