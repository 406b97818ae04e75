"""Shapes in waves: draught, heave against the wave, drag, messages with wave parameters."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

import simkit

G, RHO, MASS, SIDE = 9.8, 1025.0, 4.1, 0.2
DRAUGHT = MASS / (RHO * SIDE**2)
PLUGIN = 'filename="libPolyhedraBuoyancyDrag.so" name="vrx::PolyhedraBuoyancyDrag"'
AMPLITUDE, PERIOD = 0.4, 5.0
SWELL = f"""<wavefield><size>1000 1000</size><cell_count>50 50</cell_count><wave><model>CWR</model><number>1</number>
  <amplitude>{AMPLITUDE}</amplitude><period>{PERIOD}</period><direction>1 0</direction><tau>0.5</tau>
  <steepness>0</steepness></wave></wavefield>"""
BOX = f"<box><size>{SIDE} {SIDE} {SIDE}</size></box>"


def world(parameters: str = "", shape: str = BOX, x: float = 0.0, z: float = 0.0, offset: str = "") -> str:
    return f"""<sdf version="1.9"><world name="sea"><gravity>0 0 {-G}</gravity>
      <physics name="p" type="ode"><max_step_size>0.005</max_step_size></physics>
      <model name="buoy"><pose>{x} 0 {z} 0 0 0</pose><link name="body"><inertial><mass>{MASS}</mass>
        <inertia><ixx>0.05</ixx><iyy>0.05</iyy><izz>0.05</izz></inertia></inertial></link>
      <plugin {PLUGIN}><fluid_density>{RHO}</fluid_density>{parameters}
        <buoyancy name="b"><link_name>body</link_name>{offset}<geometry>{shape}</geometry></buoyancy></plugin>
      </model></world></sdf>"""


def heights(sim: simkit.Simulation, time: float, count: int) -> np.ndarray:
    found = []
    for _ in range(count):
        sim.run(time / count)
        found.append(float(sim.link("buoy::body").pose.position[2]))
    return np.array(found)


@pytest.mark.parametrize("level", [0.0, 2.5])
def test_a_box_floats_at_the_draught_of_its_mass(level: float) -> None:
    with simkit.load(world(f"<linear_drag>20</linear_drag><fluid_level>{level}</fluid_level>", z=level)) as sim:
        sim.run(3.0)
        assert SIDE / 2 + level - sim.link("buoy::body").pose.position[2] == pytest.approx(DRAUGHT, abs=1e-6)


def test_other_shapes_float_by_their_volume() -> None:
    for shape, volume in (
        ("<sphere><radius>0.15</radius></sphere>", 4 / 3 * math.pi * 0.15**3),
        ("<cylinder><radius>0.1</radius><length>0.3</length></cylinder>", math.pi * 0.01 * 0.3),
    ):
        with simkit.load(world(shape=shape, z=-50.0)) as sim:
            sim.step()
            rise = sim.link("buoy::body").linear_velocity[2] / sim.timestep
            assert rise == pytest.approx(RHO * volume * G / MASS - G, rel=1e-9)


@pytest.mark.parametrize("x", [7.0])
def test_a_small_body_heaves_as_the_wave_and_the_equation_of_its_motion_say(x: float) -> None:
    # m z'' = k·(η - z) + c·(η' - z'); the response to a wave is (k + icω) / (k - mω² + icω)
    drag = 3.0
    frequency = 2 * math.pi / PERIOD
    share = DRAUGHT / SIDE  # of the volume under water, which scales the drag
    stiffness, damping = RHO * G * SIDE**2, drag * MASS * share
    factor = (stiffness + 1j * damping * frequency) / (stiffness - MASS * frequency**2 + 1j * damping * frequency)
    with simkit.load(world(SWELL + f"<linear_drag>{drag}</linear_drag>", x=x)) as sim:
        assert not [found for found in sim.diagnostics if found.severity != "note"]
        sim.run(10.0)
        count = 50
        found = heights(sim, PERIOD, count)
        times = 10.0 + PERIOD * np.arange(1, count + 1) / count
        found_wave = 2 / count * np.sum(found * np.exp(-1j * frequency * times))  # z = Re(found_wave · exp(iωt))
    wave = AMPLITUDE * cmath.exp(-1j * frequency**2 / G * x)  # a·cos(kx - ωt) = Re(wave · exp(iωt))
    assert abs(found_wave) == pytest.approx(abs(factor * wave), rel=5e-3)
    assert cmath.phase(found_wave / (factor * wave)) == pytest.approx(0, abs=0.01)
    assert float(np.mean(found)) == pytest.approx(SIDE / 2 - DRAUGHT, abs=2e-3)


def test_drag_slows_a_submerged_body_and_its_rotation() -> None:
    shape = f"<box><size>{SIDE} {SIDE} {2 * SIDE}</size></box>"
    length = (SIDE + SIDE + 2 * SIDE) / 3
    balanced = f"<fluid_density>{MASS / (2 * SIDE**3)}</fluid_density>"
    text = world("<linear_drag>2</linear_drag><angular_drag>0.3</angular_drag>", shape, z=-50.0)
    with simkit.load(text.replace(f"<fluid_density>{RHO}</fluid_density>", balanced)) as sim:
        sim.model("buoy").set_velocity((0.5, 0, 0), (0, 0, 1.0))
        sim.run(0.5)
        body = sim.link("buoy::body")
        assert body.linear_velocity[0] == pytest.approx(0.5 * math.exp(-2 * 0.5), rel=0.01)
        rate = MASS * 0.3 * length**2 / 0.05
        assert body.angular_velocity[2] == pytest.approx(math.exp(-rate * 0.5), rel=0.02)


def test_an_offset_shifts_the_shape_and_turns_the_body_upright() -> None:
    offset = "<pose>0 0 0.05 0 0 0</pose>"  # the volume is above the mass
    with simkit.load(
        world("<linear_drag>5</linear_drag><angular_drag>20</angular_drag>", z=-0.05, offset=offset)
    ) as sim:
        sim.model("buoy").set_pose(simkit.Pose.from_rpy(0, 0, -0.05, 0.4, 0, 0))
        sim.run(6.0)
        assert sim.link("buoy::body").pose.rpy[0] == pytest.approx(0, abs=0.01)


@pytest.mark.slow  # slow: 25 s of waves
def test_messages_change_the_waves() -> None:
    calm = "<wavefield><topic>sea/waves</topic><wave><gain>0</gain></wave></wavefield>"
    with simkit.load(world("<linear_drag>5</linear_drag>" + calm)) as sim:
        assert np.ptp(heights(sim, 5.0, 20)[10:]) < 1e-3
        values = {"model": {"type": 4, "string_value": "CWR"}, "number": {"type": 2, "integer_value": 1}}
        values |= {"amplitude": {"type": 3, "double_value": 0.3}, "tau": {"type": 3, "double_value": 0.1}}
        values |= {"direction": {"type": 8, "double_array_value": np.array([0.0, 1.0, 0.0])}, "size": {"type": 3}}
        sim.publish("/sea/waves", {"params": [{"name": name, "value": value} for name, value in values.items()]})
        sim.run(5.0)
        assert np.ptp(heights(sim, 5.0, 20)) == pytest.approx(0.6, rel=0.05)
        for name, value in (("number", {"type": 2, "integer_value": 0x7FFF}), ("colour", {"type": 3})):
            sim.publish("/sea/waves", {"params": [{"name": name, "value": value}]})
        sim.run(5.0)
        assert [found.code for found in sim.diagnostics].count("SK-PLUGIN-041") == 2
        assert np.ptp(heights(sim, 5.0, 20)) == pytest.approx(0.6, rel=0.05)


def test_runs_after_a_restore_have_the_same_bits() -> None:
    with simkit.load(world(SWELL)) as sim:
        sim.run(1.0)
        saved = sim.snapshot()
        ends = []
        for _ in range(2):
            sim.restore(saved)
            ends.append(heights(sim, 0.5, 5).tolist())
        assert ends[0] == ends[1]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (world(shape=""), "SK-PARAM-001"),
        (world(shape="<box><size>1 0 1</size></box>"), "SK-PARAM-002"),
        (world(shape="<sphere><radius>-1</radius></sphere>"), "SK-PARAM-002"),
        (world("<wavefield><wave><model>PMS</model><number>4</number></wave></wavefield>"), "SK-PARAM-002"),
        (world("<wavefield><wave><direction>0 0</direction></wave></wavefield>"), "SK-PARAM-002"),
    ],
)
def test_wrong_parameters_are_errors(text: str, code: str) -> None:
    with pytest.raises(simkit.LoadError, match=code):
        simkit.load(text)
