"""VRX's boat of Gazebo Classic: waves, hulls, thrusters and floating boxes."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit
from simkit_water_and_air.plugins.fluids.hull_points import segment_area

MASS, LENGTH, RADIUS, RHO, G = 180.0, 4.9, 0.213, 997.7735, 9.8
SEA = """<model name="{name}"><static>true</static><link name="l"/><plugin name="waves"
  filename="libWavefieldModelPlugin.so"><static>false</static><update_rate>30</update_rate><size>1000 1000</size>
  <cell_count>50 50</cell_count><wave><number>1</number><amplitude>{amplitude}</amplitude><period>{period}</period>
  <direction>1 0</direction><steepness>0</steepness></wave></plugin></model>"""
THRUSTER = """<thruster><linkName>{name}_engine</linkName><propJointName>{name}_spin</propJointName>
  <cmdTopic>{name}_cmd</cmdTopic><angleTopic>{name}_angle</angleTopic><maxCmd>1.0</maxCmd>
  <maxForceFwd>250.0</maxForceFwd><maxForceRev>-100.0</maxForceRev><maxAngle>1.0</maxAngle>{more}</thruster>"""
DYNAMICS = f"""<plugin name="dynamics" filename="libusv_gazebo_dynamics_plugin.so"><bodyName>hull</bodyName>
  <waterLevel>0.2</waterLevel><xDotU>0</xDotU><yDotV>0</yDotV><nDotR>0</nDotR><xU>100</xU><xUU>150</xUU><yV>100</yV>
  <zW>500</zW><kP>300</kP><mQ>900</mQ><nR>800</nR><hullRadius>{RADIUS}</hullRadius><boatWidth>2</boatWidth>
  <boatLength>{LENGTH}</boatLength><length_n>4</length_n></plugin>"""


def world(mapping: str = "", timeout: float = 0.0, sea: str = "") -> str:
    engines = "".join(
        f"""<link name="{name}_engine"><pose>-2 {y} 0 0 0 0</pose><inertial><mass>0.1</mass>
        <inertia><ixx>1e-2</ixx><iyy>1e-2</iyy><izz>1e-2</izz></inertia></inertial></link>
        <joint name="{name}_mount" type="fixed"><parent>hull</parent><child>{name}_engine</child></joint>
        <link name="{name}_propeller"><pose>-2.3 {y} 0 0 0 0</pose><inertial><mass>0.1</mass>
        <inertia><ixx>1e-2</ixx><iyy>1e-2</iyy><izz>1e-2</izz></inertia></inertial></link>
        <joint name="{name}_spin" type="continuous"><parent>{name}_engine</parent><child>{name}_propeller</child>
          <axis><xyz>1 0 0</xyz><dynamics><damping>0.5</damping></dynamics></axis></joint>"""
        for name, y in (("left", 1.0), ("right", -1.0))
    )
    thrusters = "".join(THRUSTER.format(name=name, more=mapping) for name in ("left", "right"))
    return f"""<sdf version="1.6"><world name="sea"><gravity>0 0 {-G}</gravity>{sea}
      <physics name="p" type="ode"><max_step_size>0.008</max_step_size></physics>
      <model name="wamv"><pose>0 0 0.3 0 0 0</pose><link name="hull"><inertial><mass>{MASS - 0.4}</mass>
        <inertia><ixx>120</ixx><iyy>393</iyy><izz>446</izz></inertia></inertial></link>{engines}{DYNAMICS}
      <plugin name="thrust" filename="libusv_gazebo_thrust_plugin.so"><robotNamespace>wamv</robotNamespace>
        <cmdTimeout>{timeout}</cmdTimeout>{thrusters}</plugin></model></world></sdf>"""


def command(sim: simkit.Simulation, left: float, right: float, kind: str = "cmd") -> None:
    sim.publish(f"/wamv/left_{kind}", {"data": left})
    sim.publish(f"/wamv/right_{kind}", {"data": right})


def test_the_boat_floats_drives_and_turns_with_the_angle_of_its_engines() -> None:
    with simkit.load(world()) as sim:
        sim.run(6.0)
        hull = sim.link("wamv::hull")
        depth = 0.2 - float(hull.pose.position[2])
        assert 2 * RHO * LENGTH * segment_area(RADIUS, depth) == pytest.approx(MASS, rel=5e-3)
        states = sim.subscribe("/wamv/joint_states", keep=1)
        command(sim, 1.0, 1.0)
        sim.run(8.0)
        speed = (-100 + math.sqrt(100**2 + 4 * 150 * 500)) / 300  # 150·u² + 100·u = 500
        assert np.hypot(*hull.linear_velocity[:2]) == pytest.approx(speed, rel=0.01)
        assert states.messages[-1].name == ["left_spin", "right_spin"]
        assert states.messages[-1].velocity.tolist() == pytest.approx([4.0, 4.0], rel=0.02)  # 2 N·m / damping
        command(sim, -0.3, -0.3, "angle")
        sim.run(5.0)
        # both engines push to starboard at the stern, 2 m behind the middle; the bow turns to port
        assert hull.angular_velocity[2] == pytest.approx(500 * math.sin(0.3) * 2 / 800, rel=0.15)


def test_commands_are_scaled_limited_and_time_out() -> None:
    with simkit.load(world(timeout=0.5)) as sim:
        sim.run(1.0)
        command(sim, -5.0, -5.0)
        before = float(sim.link("wamv::hull").linear_velocity[0])
        sim.run(0.04)
        assert (sim.link("wamv::hull").linear_velocity[0] - before) / 0.04 == pytest.approx(-200 / MASS, rel=0.05)
        sim.run(0.5)
        speed = abs(float(sim.link("wamv::hull").linear_velocity[0]))
        sim.run(1.0)
        assert abs(float(sim.link("wamv::hull").linear_velocity[0])) < 0.75 * speed  # no thrust after 0.5 s
        command(sim, math.inf, 0.0)
        sim.run(0.1)
        assert "SK-PLUGIN-041" in {found.code for found in sim.diagnostics}


def test_the_second_mapping_is_the_logistic_function_of_a_measured_engine() -> None:
    with simkit.load(world("<mappingType>1</mappingType>")) as sim:
        sim.run(1.0)
        for value, (a, k, b, nu, c, m) in (
            (0.6, (0.01, 59.82, 5.0, 0.38, 0.56, 0.28)),
            (-0.6, (-199.13, -0.09, 8.84, 5.34, 0.99, -0.57)),
        ):
            force = a + (k - a) / (c + math.exp(-b * (value - m))) ** (1 / nu)
            command(sim, value, value)
            sim.model("wamv").set_velocity((0, 0, 0), (0, 0, 0))
            sim.step()
            gained = float(sim.link("wamv::hull").linear_velocity[0]) / sim.timestep
            assert gained == pytest.approx(2 * max(force, -100.0) / MASS, rel=0.01)


def test_the_boat_follows_the_waves_of_the_ocean_model() -> None:
    with simkit.load(world(sea=SEA.format(name="ocean", amplitude=0.2, period=8.0))) as sim:
        assert not [found for found in sim.diagnostics if found.severity != "note"]
        sim.run(12.0)
        heights = []
        for _ in range(20):
            sim.run(0.4)
            heights.append(float(sim.link("wamv::hull").pose.position[2]))
        assert np.ptp(heights) / 2 == pytest.approx(0.2, rel=0.1)


def test_a_box_heaves_and_its_drag_limits_its_rise() -> None:
    density, area, height, mass = 1000.0, 0.04, 0.5, 10.0
    text = f"""<sdf version="1.6"><world name="sea"><gravity>0 0 {-G}</gravity>
      <physics name="p" type="ode"><max_step_size>0.01</max_step_size></physics>
      <model name="buoy"><link name="body"><inertial><mass>{mass}</mass>
      <inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
      <plugin name="b" filename="libbuoyancy_gazebo_plugin.so"><fluid_density>{density}</fluid_density>
        <fluid_level>1</fluid_level><fluid_drag>100</fluid_drag><wave_model>ocean</wave_model><link><name>body</name>
        <center_of_volume>0 0 0</center_of_volume><area>{area}</area><height>{height}</height></link></plugin></model>
      {{sea}}</world></sdf>"""
    with simkit.load(text.format(sea="")) as sim:
        sim.model("buoy").set_pose(simkit.Pose.from_rpy(0, 0, -8, 0, 0, 0))
        sim.run(2.0)
        lift = density * area * height * G - mass * G
        assert sim.link("buoy::body").linear_velocity[2] == pytest.approx(math.sqrt(lift / 100), rel=1e-3)
        sim.run(20.0)
        assert sim.link("buoy::body").pose.position[2] == pytest.approx(
            1 + height / 2 - mass / (density * area), abs=0.02
        )
    with simkit.load(text.format(sea=SEA.format(name="ocean", amplitude=0.3, period=6.0))) as sim:
        sim.run(9.0)
        heights = []
        for _ in range(20):
            sim.run(0.3)
            heights.append(float(sim.link("buoy::body").pose.position[2]))
        assert np.ptp(heights) / 2 == pytest.approx(0.3, rel=0.1)


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("<length_n>4</length_n>", "", "SK-PARAM-001"),
        ("<bodyName>hull", "<bodyName>hul", "SK-PLUGIN-003"),
        ("<linkName>left_engine", "<linkName>left", "SK-PLUGIN-003"),
        ("<propJointName>left_spin", "<propJointName>spin", "SK-PLUGIN-003"),
        ("<cmdTopic>left_cmd</cmdTopic>", "", "SK-PARAM-001"),
    ],
)
def test_wrong_parameters_are_errors(old: str, new: str, code: str) -> None:
    with pytest.raises(simkit.LoadError, match=code):
        simkit.load(world().replace(old, new))


def test_runs_after_a_restore_have_the_same_bits() -> None:
    with simkit.load(world(sea=SEA.format(name="ocean", amplitude=0.2, period=3.0))) as sim:
        command(sim, 1.0, 0.3)
        sim.run(1.0)
        saved = sim.snapshot()
        ends = []
        for _ in range(2):
            sim.restore(saved)
            sim.run(1.0)
            ends.append([*sim.link("wamv::hull").pose.position, *sim.link("wamv::hull").pose.quaternion])
        assert ends[0] == ends[1]
