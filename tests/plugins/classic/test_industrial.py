"""Conveyor belts and the contact vacuum gripper of industrial worlds."""

from __future__ import annotations

import math

import pytest

import simkit

BODY = "<inertial><mass>{m}</mass><inertia><ixx>{i}</ixx><iyy>{i}</iyy><izz>{i}</izz></inertia></inertial>"
BOX = '<collision name="c"><geometry><box><size>{}</size></box></geometry></collision>'
LIGHT, HEAVY = BODY.format(m=0.5, i=1e-3), BODY.format(m=100, i=10)
CRATE = f'<model name="crate"><pose>{{}}</pose><link name="l">{LIGHT}{BOX.format("0.1 0.1 0.1")}</link></model>'
IFRA = '<plugin name="belt" filename="libros2_conveyorbelt_plugin.so">{}</plugin>'
ARIAC = '<plugin name="belt" filename="libROSConveyorBeltPlugin.so">{}</plugin>'
SLIDE = """<joint name="belt_joint" type="prismatic"><parent>world</parent><child>belt</child><axis>
  <xyz>{}</xyz><limit><lower>0</lower><upper>0.01</upper></limit></axis></joint>"""


def world(*models: str) -> str:
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 -9.81</gravity><physics type="ode"><max_step_size>0.002
      </max_step_size></physics>{"".join(models)}</world></sdf>"""


def belt(plugin: str, axis: str = "0 1 0", pose: str = "0 0 0.5 0 0 0") -> str:
    link = f'<link name="belt">{HEAVY}{BOX.format("0.6 4 0.1")}</link>'
    return f'<model name="conveyor"><pose>{pose}</pose>{link}{SLIDE.format(axis)}{plugin}</model>'


def test_a_crate_on_a_belt_gets_the_speed_of_its_power() -> None:
    text = world(belt(IFRA.format("<max_velocity>0.8</max_velocity>")), CRATE.format("0 -1 0.6 0 0 0"))
    with simkit.load(text) as sim:
        states = sim.subscribe("/CONVEYORSTATE", keep=1)
        sim.run(0.5)
        crate = sim.model("crate")
        assert crate.pose.position[1] == pytest.approx(-1, abs=1e-3)
        assert sim.call("/CONVEYORPOWER", {"power": 25.0}).success
        sim.run(1.0)
        before = crate.pose.position[1]
        sim.run(2.0)
        assert crate.pose.position[1] - before == pytest.approx(0.8 * 0.25 * 2, rel=1e-3)
        assert (states.messages[-1].power, states.messages[-1].enabled) == (25.0, True)
        assert sim.joint("conveyor::belt_joint").position == pytest.approx(0, abs=1e-6)
        assert not sim.call("/CONVEYORPOWER", {"power": 120.0}).success
        assert sim.call("/CONVEYORPOWER", {"power": 0.0}).success
        sim.run(1.0)
        before = crate.pose.position[1]
        sim.run(1.0)
        assert crate.pose.position[1] == pytest.approx(before, abs=1e-3) and not states.messages[-1].enabled


@pytest.mark.parametrize(("axis", "turn"), [("1 0 0", 0.0), ("1 0 0", 2.0), ("-1 0 0", 0.0)])
def test_the_belt_moves_along_the_axis_of_its_joint(axis: str, turn: float) -> None:
    plugin = ARIAC.format("<power>100</power><max_velocity>0.3</max_velocity>")
    text = world(belt(plugin, axis, f"0 0 0.5 0 0 {turn}"), CRATE.format("0 0 0.6 0 0 0"))
    with simkit.load(text) as sim:
        sim.run(0.5)
        before = sim.model("crate").pose.position
        sim.run(0.5)
        sign = float(axis.split()[0])
        moved = (sim.model("crate").pose.position - before)[:2]
        assert moved == pytest.approx([sign * 0.15 * math.cos(turn), sign * 0.15 * math.sin(turn)], abs=2e-3)


def test_the_namespace_and_the_topics_of_an_ariac_belt() -> None:
    names = "<robot_namespace>/ariac</robot_namespace><state_topic>belt/state</state_topic>"
    with simkit.load(world(belt(ARIAC.format(names)))) as sim:
        states = sim.subscribe("/ariac/belt/state")
        assert sim.call("/ariac/conveyor/control", {"power": 50.0}).success
        sim.run(1.0)
        assert len(states.messages) == 10 and states.messages[-1].power == 50.0


def test_a_restored_belt_has_its_power_again() -> None:
    text = world(belt(IFRA.format("")), CRATE.format("0 -1 0.6 0 0 0"))
    with simkit.load(text) as sim:
        sim.call("/CONVEYORPOWER", {"power": 30.0})
        sim.run(0.5)
        snapshot = sim.snapshot()
        sim.run(0.5)
        first = sim.model("crate").pose.position[1]
        sim.call("/CONVEYORPOWER", {"power": 0.0})
        sim.restore(snapshot)
        sim.run(0.5)
        assert sim.model("crate").pose.position[1] == first
        sim.reset()
        sim.run(0.5)
        assert sim.model("crate").pose.position[1] == pytest.approx(-1, abs=1e-3)


@pytest.mark.parametrize(
    ("plugin", "axis"),
    [(IFRA.format("<joint_name>none</joint_name>"), "0 1 0"), (IFRA.format(""), "0 0 1"), (ARIAC.format(""), "0 0 -1")],
)
def test_a_belt_needs_its_joint(plugin: str, axis: str) -> None:
    with pytest.raises(simkit.InputError, match="SK-PLUGIN-003"):
        simkit.load(world(belt(plugin, axis)))


ARM = f"""<model name="arm"><link name="cup"><pose>0 0 0.2 0 0 0</pose>{LIGHT}{BOX.format("0.05 0.05 0.02")}</link>
  <joint name="lift" type="prismatic"><parent>world</parent><child>cup</child><axis><xyz>0 0 1</xyz></axis></joint>
  <plugin filename="gz-sim-joint-position-controller-system" name="gz::sim::systems::JointPositionController">
  <joint_name>lift</joint_name><p_gain>400</p_gain><d_gain>40</d_gain></plugin>
  <plugin name="vacuum" filename="libROSVacuumGripperPlugin.so"><suction_cup_link>cup</suction_cup_link>
  <grasp_check><attach_steps>2</attach_steps><detach_steps>5</detach_steps><min_contact_count>3</min_contact_count>
  </grasp_check></plugin></model>"""
GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
  </collision></link></model>"""


def move(sim: simkit.Simulation, height: float) -> None:
    sim.publish("/model/arm/joint/lift/0/cmd_pos", simkit.msgs.make("std_msgs/msg/Float64", data=height))


def test_a_vacuum_gripper_lifts_what_it_touches_until_it_is_off() -> None:
    with simkit.load(world(GROUND, ARM, CRATE.format("0 0 0.05 0 0 0"))) as sim:
        states = sim.subscribe("/gripper/state", keep=1)
        crate = sim.model("crate")
        assert sim.call("/gripper/control", {"enable": True}).success
        move(sim, -0.1)
        sim.run(2.0)
        assert states.messages[-1].enabled and states.messages[-1].attached
        move(sim, 0.2)
        sim.run(2.0)
        assert crate.pose.position[2] > 0.25
        snapshot = sim.snapshot()
        sim.call("/gripper/control", {"enable": False})
        sim.run(1.0)
        assert crate.pose.position[2] == pytest.approx(0.05, abs=2e-3) and not states.messages[-1].attached
        sim.restore(snapshot)
        sim.run(1.0)
        assert crate.pose.position[2] > 0.25 and states.messages[-1].attached


def test_a_gripper_that_is_off_or_touches_too_short_holds_nothing() -> None:
    with simkit.load(world(GROUND, ARM, CRATE.format("0 0 0.05 0 0 0"))) as sim:
        states = sim.subscribe("/gripper/state", keep=1)
        move(sim, -0.1)
        sim.run(1.0)
        sim.call("/gripper/control", {"enable": True})
        sim.run(0.15)
        assert not states.messages[-1].attached
        sim.run(0.3)
        assert states.messages[-1].attached


def test_a_gripper_needs_its_cup() -> None:
    with pytest.raises(simkit.InputError, match="SK-PLUGIN-003"):
        simkit.load(world(ARM.replace("<suction_cup_link>cup", "<suction_cup_link>none")))
