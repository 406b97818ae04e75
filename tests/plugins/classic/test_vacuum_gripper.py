"""Vacuum gripper: grasping, carrying and releasing."""

from __future__ import annotations

import numpy as np
import pytest
from plugin_worlds import GROUND, world

import simkit

SWITCH = "/arm/switch"


def inertial(mass: float) -> str:
    i = 0.01 * mass
    return f"<inertial><mass>{mass}</mass><inertia><ixx>{i}</ixx><iyy>{i}</iyy><izz>{i}</izz></inertia></inertial>"


CONTROLLER = """<plugin filename="gz-sim-joint-position-controller-system"
  name="gz::sim::systems::JointPositionController"><joint_name>slide</joint_name>
  <use_velocity_commands>true</use_velocity_commands><cmd_max>0.5</cmd_max></plugin>"""


def crane(plugin: str = "", driven: bool = True) -> str:
    """A cup on a vertical slide, driven to a height; its origin is 0.1 m over the ground at -0.9 m."""
    own = "<ros><namespace>arm</namespace></ros><link_name>cup</link_name><max_distance>0.12</max_distance>"
    inside = plugin or own
    return f"""<model name="crane"><pose>0 0 1 0 0 0</pose><link name="rail"/><link name="cup">{inertial(2)}</link>
    <joint name="slide" type="prismatic"><parent>rail</parent><child>cup</child><axis><xyz>0 0 1</xyz></axis></joint>
    <joint name="base" type="fixed"><parent>world</parent><child>rail</child></joint>
    {CONTROLLER if driven else ""}
    <plugin name="vacuum" filename="libgazebo_ros_vacuum_gripper.so">{inside}</plugin></model>"""


def box(name: str = "box", x: float = 0.0, mass: float = 3.0, more: str = "") -> str:
    return f"""<model name="{name}"><pose>{x} 0 0.05 0 0 0</pose>{more}<link name="l">{inertial(mass)}<collision
    name="c"><geometry><box><size>0.1 0.1 0.1</size></box></geometry></collision></link></model>"""


def reach_down(sim: simkit.Simulation, depth: float = -0.84) -> None:
    sim.publish("/model/crane/joint/slide/0/cmd_pos", {"data": depth})
    sim.run(2.2)


def lift(sim: simkit.Simulation) -> None:
    sim.publish("/model/crane/joint/slide/0/cmd_pos", {"data": 0.0})
    sim.run(2.5)


def load(*parts: str) -> simkit.Simulation:
    return simkit.load(world(GROUND, *(parts or (crane(), box())), step=0.002))


def test_a_near_link_is_lifted_held_and_dropped() -> None:
    sim = load()
    grasping = sim.subscribe("/arm/grasping")
    reach_down(sim)
    assert sim.call(SWITCH, {"data": True}).success
    sim.run(0.05)
    gap = sim.model("crane").link("cup").pose.position - sim.model("box").pose.position
    lift(sim)
    now = sim.model("crane").link("cup").pose.position - sim.model("box").pose.position
    assert now == pytest.approx(gap, abs=1e-3)
    assert sim.model("box").pose.position[2] == pytest.approx(0.89, abs=5e-3)
    assert sim.call(SWITCH, {"data": False}).success
    height = float(sim.model("box").pose.position[2])
    sim.run(0.2)
    assert height - sim.model("box").pose.position[2] == pytest.approx(9.8 * 0.02, rel=0.03)
    changes = [b.data for a, b in zip(grasping.messages, grasping.messages[1:], strict=False) if a.data != b.data]
    assert changes == [True, False]


def test_the_arm_carries_the_weight_of_the_load() -> None:
    spring = """<axis><xyz>0 0 1</xyz><dynamics><damping>60</damping><spring_stiffness>1000</spring_stiffness>
      </dynamics></axis>"""
    sim = load(crane(driven=False).replace("<axis><xyz>0 0 1</xyz></axis>", spring))
    sim.spawn(f"<sdf version='1.9'>{box('load').replace('0.05 0 0 0', '0.95 0 0 0')}</sdf>")
    sim.call(SWITCH, {"data": True})
    sim.run(2.0)
    # the cup's 2 kg and the load's 3 kg on a spring of 1000 N/m
    assert sim.joint("crane::slide").position == pytest.approx(-(2 + 3) * 9.8 / 1000, rel=2e-3)


def test_a_link_that_comes_near_is_grasped_and_a_far_one_is_not() -> None:
    sim = load(crane(), box(), box("far", x=0.15))
    sim.call(SWITCH, {"data": True})
    reach_down(sim)
    lift(sim)
    assert sim.model("box").pose.position[2] > 0.8
    assert sim.model("far").pose.position[2] == pytest.approx(0.05, abs=1e-3)


def test_the_robot_itself_static_and_exempt_models_are_not_held() -> None:
    exempt = "<ros><namespace>arm</namespace></ros><link_name>cup</link_name><max_distance>5</max_distance>"
    still = box("post", x=0.4, more="<static>true</static>")
    sim = load(crane(f"{exempt}<fixed>box</fixed>"), box(), still)
    sim.call(SWITCH, {"data": True})
    sim.run(0.1)
    grasping = sim.subscribe("/arm/grasping")
    reach_down(sim, -0.5)
    assert sim.joint("crane::slide").position == pytest.approx(-0.5, abs=1e-3)
    assert grasping.messages
    assert not any(m.data for m in grasping.messages)


def test_switching_twice_in_the_same_way_is_reported() -> None:
    sim = load()
    assert not sim.call(SWITCH, {"data": False}).success
    assert sim.call(SWITCH, {"data": True}).success
    answer = sim.call(SWITCH, {"data": True})
    assert (answer.success, answer.message) == (False, "it is on already")


def test_in_ros_1_the_gripper_has_two_services_and_a_topic() -> None:
    inside = """<robotNamespace>arm</robotNamespace><bodyName>cup</bodyName><topicName>grip</topicName>
      <maxDistance>0.12</maxDistance><maxForce>20</maxForce>"""
    sim = load(crane(inside), box())
    assert "SK-PLUGIN-138" in [d.code for d in sim.diagnostics]
    grasping = sim.subscribe("/arm/grip")
    reach_down(sim)
    sim.call("/arm/on", {})
    lift(sim)
    assert sim.model("box").pose.position[2] > 0.8
    assert grasping.messages[-1].data
    sim.call("/arm/off", {})
    sim.run(0.5)
    assert sim.model("box").pose.position[2] < 0.5


@pytest.mark.slow
def test_remove_spawn_reset_and_restore_keep_the_grasp_consistent() -> None:
    sim = load()
    reach_down(sim)
    sim.call(SWITCH, {"data": True})
    sim.run(0.1)
    snapshot = sim.snapshot()
    lift(sim)
    lifted = sim.model("box").pose.position.copy()
    sim.remove("box")
    grasping = sim.subscribe("/arm/grasping")
    sim.run(0.1)
    assert not grasping.messages[-1].data
    reach_down(sim)
    sim.spawn(f"<sdf version='1.9'>{box()}</sdf>")
    lift(sim)
    assert sim.model("box").pose.position[2] > 0.8
    sim.restore(snapshot)
    lift(sim)
    np.testing.assert_allclose(sim.model("box").pose.position, lifted, atol=1e-9)
    sim.reset()
    reach_down(sim)
    lift(sim)
    assert sim.model("box").pose.position[2] == pytest.approx(0.05, abs=1e-3)


def test_a_missing_link_is_an_error_that_lists_the_links() -> None:
    with pytest.raises(simkit.InputError, match="did you mean 'cup'"):
        load(crane("<link_name>cap</link_name>"))
    with pytest.raises(simkit.InputError, match="link_name"):
        load(crane("<max_distance>1</max_distance>"))


def test_grippers_with_one_service_are_switched_together() -> None:
    cups = "".join(
        f"""<plugin name="vacuum_{link}" filename="libgazebo_ros_vacuum_gripper.so">
        <ros><namespace>arm</namespace></ros><link_name>{link}</link_name><max_distance>0.12</max_distance></plugin>"""
        for link in ("left", "right")
    )
    links = "".join(
        f"""<link name="{link}"><pose>{x} 0 0.1 0 0 0</pose>{inertial(1)}</link><joint name="{link}_mount" type="fixed">
        <parent>world</parent><child>{link}</child></joint>"""
        for link, x in (("left", 0), ("right", 1))
    )
    sim = load(f'<model name="bar">{links}{cups}</model>', box("a", 0.0), box("b", 1.0))
    assert sim.call(SWITCH, {"data": True}).success
    sim.run(0.1)
    cups_there = [plugin for plugin in sim.engine.structure.all_plugins() if hasattr(plugin, "holds")]
    held = {link for plugin in cups_there for link in plugin.holds}
    assert held == {"a::l", "b::l"}
    assert not sim.call(SWITCH, {"data": True}).success
    assert sim.call(SWITCH, {"data": False}).success
    sim.run(0.1)
    assert not any(plugin.holds for plugin in cups_there)
