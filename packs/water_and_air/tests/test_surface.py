"""Catamaran of VRX's kind: draught of half cylinders, waves by messages, and a turn by thrust."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit
from simkit_water_and_air.plugins.fluids.hull_points import segment_area

G, RHO, MASS, LENGTH, RADIUS = 9.8, 997.7735, 180.0, 4.9, 0.213
SURFACE = 'filename="libSurface.so" name="vrx::Surface"'
PARAMETERS = "/vrx/wavefield/parameters"
# numbers of the WAM-V of VRX; the drags are those of its dynamics plugin
DRAG = """<plugin filename="libSimpleHydrodynamics.so" name="vrx::SimpleHydrodynamics"><link_name>hull</link_name>
  <xDotU>0</xDotU><yDotV>0</yDotV><nDotR>0</nDotR><xU>51.3</xU><xUU>72.4</xUU><yV>40</yV><zW>500</zW><kP>100</kP>
  <mQ>100</mQ><nR>400</nR></plugin>"""
WAVES = f"""<plugin filename="libPublisherPlugin.so" name="vrx::PublisherPlugin">
  <message type="gz.msgs.Param" topic="{PARAMETERS}" every="2.0">
    params {{ key: "direction" value {{ type: VECTOR3D vector3d_value {{ x: 1.0 y: 0.0 }} }} }}
    params {{ key: "model" value {{ type: STRING string_value: "CWR" }} }}
    params {{ key: "number" value {{ type: INT32 int_value: 1 }} }}
    params {{ key: "amplitude" value {{ type: DOUBLE double_value: 0.2 }} }}
    params {{ key: "period" value {{ type: DOUBLE double_value: 6.0 }} }}
    params {{ key: "tau" value {{ type: DOUBLE double_value: 0.5 }} }}
    params {{ key: "steepness" value {{ type: DOUBLE double_value: 0 }} }}
  </message></plugin>"""


def hull(side: float) -> str:
    return f"""<plugin {SURFACE}><link_name>hull</link_name><hull_length>{LENGTH}</hull_length>
      <hull_radius>{RADIUS}</hull_radius><points><point>1.5 {side} 0</point><point>-1.5 {side} 0</point></points>
      <wavefield><topic>{PARAMETERS}</topic><wave><gain>0</gain></wave></wavefield></plugin>"""


def world(more: str = "", top: str = "", load: str = "0 0 0") -> str:
    thrusters = "".join(
        f"""<link name="{name}"><pose>-2 {y} 0 0 0 0</pose><inertial><mass>0.1</mass>
          <inertia><ixx>1e-3</ixx><iyy>1e-3</iyy><izz>1e-3</izz></inertia></inertial></link>
        <joint name="{name}_joint" type="continuous"><parent>hull</parent><child>{name}</child>
          <axis><xyz>1 0 0</xyz></axis></joint>
        <plugin filename="gz-sim-thruster-system" name="gz::sim::systems::Thruster">
          <joint_name>{name}_joint</joint_name><velocity_control>true</velocity_control><propeller_diameter>0.2</propeller_diameter>
          <thrust_coefficient>0.004</thrust_coefficient></plugin>"""
        for name, y in (("left", 1.0), ("right", -1.0))
    )
    return f"""<sdf version="1.9"><world name="sea"><gravity>0 0 {-G}</gravity>
      <physics name="p" type="ode"><max_step_size>0.008</max_step_size></physics>{top}
      <model name="wamv"><pose>0 0 0.1 0 0 0</pose><link name="hull"><inertial><pose>{load} 0 0 0</pose>
        <mass>{MASS}</mass><inertia><ixx>120</ixx><iyy>393</iyy><izz>446</izz></inertia></inertial></link>
      {thrusters}{hull(1.03)}{hull(-1.03)}{DRAG}{more}</model></world></sdf>"""


def draught() -> float:
    """Return the depth of the hulls at which they displace the mass of the boat, by bisection."""
    low, high = 0.0, RADIUS
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if 2 * RHO * LENGTH * segment_area(RADIUS, middle) < MASS + 0.2 else (low, middle)
    return low


def test_a_segment_of_a_circle_has_its_area() -> None:
    assert segment_area(2.0, 2.0) == pytest.approx(math.pi * 2)
    assert segment_area(2.0, 0.0) == 0.0
    heights = np.linspace(-2, -2 + 0.7, 20001)
    area = np.trapezoid(2 * np.sqrt(4 - heights**2), heights)
    assert segment_area(2.0, 0.7) == pytest.approx(float(area), rel=1e-5)


def test_the_boat_floats_level_at_its_draught_and_heels_towards_a_load() -> None:
    with simkit.load(world()) as sim:
        sim.run(8.0)
        assert -sim.link("wamv::hull").pose.position[2] == pytest.approx(draught(), abs=1e-3)
        assert np.abs(sim.link("wamv::hull").pose.rpy).max() < 1e-3
    with simkit.load(world(load="0 0.1 0")) as sim:
        sim.run(8.0)
        roll = sim.link("wamv::hull").pose.rpy[0]
        width = 2 * math.sqrt(2 * RADIUS * draught() - draught() ** 2)  # of a hull at the surface
        stiffness = 2 * RHO * G * LENGTH * width * 1.03**2  # torque for each radian of heel
        assert -roll == pytest.approx(MASS * G * 0.1 / stiffness, rel=0.1)


def test_published_parameters_of_the_waves_move_the_boat() -> None:
    with simkit.load(world(top=WAVES)) as sim:
        sim.run(12.0)
        heights, pitches = [], []
        for _ in range(30):
            sim.run(0.2)
            pose = sim.link("wamv::hull").pose
            heights.append(float(pose.position[2]))
            pitches.append(float(pose.rpy[1]))
        wavenumber = (2 * math.pi / 6) ** 2 / 9.8
        # the points are at ±1.5 m: their mean height has the amplitude a·cos(k·1.5 m)
        assert np.ptp(heights) / 2 == pytest.approx(0.2 * math.cos(1.5 * wavenumber), rel=0.1)
        # far below the resonance of pitch, the boat follows the slope a·k of the wave
        assert np.ptp(pitches) / 2 == pytest.approx(0.2 * wavenumber, rel=0.25)


@pytest.mark.slow
def test_a_direction_may_be_an_angle_in_messages_and_files() -> None:
    vector = "type: VECTOR3D vector3d_value { x: 1.0 y: 0.0 }"
    angles, turned = [], WAVES.replace(vector, "type: VECTOR3D vector3d_value { x: 0.6 y: 0.8 }")
    angle = WAVES.replace(vector, "type: DOUBLE double_value: 0.9272952180016122")  # atan2(0.8, 0.6)
    block = "<model>CWR</model><number>1</number><amplitude>0.2</amplitude><period>6</period><tau>0.5</tau>"
    in_file = [
        world().replace("<gain>0</gain>", f"{block}<direction>{way}</direction>")
        for way in ("3 4", "0.9272952180016122")
    ]
    for text in (world(top=turned), world(top=angle), *in_file):
        with simkit.load(text) as sim:
            sim.run(7.5)  # a quarter of a period after a crest
            angles.append(sim.link("wamv::hull").pose.rpy.tolist())
            assert "SK-PLUGIN-041" not in {found.code for found in sim.diagnostics}
    assert abs(angles[0][0]) > 0.01  # the waves come from the side, too
    for other in angles[1:]:
        assert other == pytest.approx(angles[0], abs=1e-6)


def test_a_direction_that_is_not_finite_is_ignored_and_one_of_words_is_an_error() -> None:
    with simkit.load(world()) as sim:
        value = {"type": 3, "double_value": math.nan}
        sim.publish(PARAMETERS, {"params": [{"name": "direction", "value": value}]})
        sim.run(0.1)
        assert "SK-PLUGIN-041" in {found.code for found in sim.diagnostics}
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        simkit.load(world().replace("<gain>0</gain>", "<direction>north</direction>"))


def test_it_drives_at_the_speed_of_its_drag_and_turns_by_different_thrusts() -> None:
    with simkit.load(world()) as sim:
        for name in ("left", "right"):
            sim.publish(f"/model/wamv/joint/{name}_joint/cmd_thrust", {"data": 100.0})
        sim.run(5.0)
        speed = (-51.3 + math.sqrt(51.3**2 + 4 * 72.4 * 200)) / (2 * 72.4)  # 72.4·u² + 51.3·u = 200
        assert sim.link("wamv::hull").linear_velocity[0] == pytest.approx(speed, rel=5e-3)
        sim.publish("/model/wamv/joint/left_joint/cmd_thrust", {"data": -100.0})
        sim.run(6.0)
        assert sim.link("wamv::hull").angular_velocity[2] == pytest.approx(200 / 400, rel=5e-3)


def test_a_hull_without_points_is_reported() -> None:
    text = world().replace("<points><point>1.5 1.03 0</point><point>-1.5 1.03 0</point></points>", "")
    with simkit.load(text) as sim:
        assert [found.code for found in sim.diagnostics] == ["SK-PLUGIN-139"]


def test_wrong_parameters_are_errors() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003"):
        simkit.load(
            world().replace("<link_name>hull</link_name><hull_length>", "<link_name>hul</link_name><hull_length>")
        )
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        simkit.load(world().replace("<point>1.5 1.03 0</point>", "<point>1.5 1.03</point>"))


def test_runs_after_a_restore_have_the_same_bits() -> None:
    with simkit.load(world(top=WAVES)) as sim:
        sim.run(1.0)
        saved = sim.snapshot()
        ends = []
        for _ in range(2):
            sim.restore(saved)
            sim.run(1.5)
            ends.append([*sim.link("wamv::hull").pose.position, *sim.link("wamv::hull").pose.quaternion])
        assert ends[0] == ends[1]
