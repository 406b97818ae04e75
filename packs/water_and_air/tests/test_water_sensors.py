"""Anemometer, wind and sheets of asv_sim, and the Doppler velocity log of gz."""

from __future__ import annotations

import math

import pytest

import simkit
from simkit_water_and_air.sensors.dvl_options import read_dvl

WIND = """<plugin filename="asv_sim2-wind-system" name="gz::sim::systems::Wind"><topic>/wind</topic></plugin>
  <plugin filename="asv_sim2-anemometer-system" name="gz::sim::systems::Anemometer"/>"""


def boat(sensor: str = "", more: str = "", turn: float = 0.0) -> str:
    return f"""<sdf version="1.9" xmlns:gz="http://gazebosim.org/schema"><world name="sea"><gravity>0 0 0</gravity>
      <physics name="p" type="ode"><max_step_size>0.01</max_step_size></physics>
      <wind><linear_velocity>0 -10 0</linear_velocity></wind>{more}
      <model name="boat"><pose>0 0 10 0 0 {turn}</pose><link name="hull"><inertial><mass>10</mass>
      <inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>{sensor}</link></model></world></sdf>"""


ANEMOMETER = """<sensor name="anemometer" type="custom" gz:type="anemometer"><update_rate>10</update_rate>
  <topic>anemometer</topic><gz:anemometer><noise type="gaussian"><stddev>{}</stddev></noise></gz:anemometer></sensor>"""


def test_the_anemometer_measures_the_apparent_wind_in_its_frame() -> None:
    with simkit.load(boat(ANEMOMETER.format(0), WIND, turn=math.pi / 2)) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        wind = sim.subscribe("/anemometer", keep=1)
        sim.link("boat::hull").set_velocity((3.0, 0.0, 0.0))
        sim.run(0.5)
        last = wind.messages[-1].vector
        assert (last.x, last.y, last.z) == pytest.approx((-10.0, 3.0, 0.0), abs=1e-6)
        sim.publish("/wind", {"x": 5.0})
        sim.run(0.5)
        last = wind.messages[-1].vector
        assert (last.x, last.y, last.z) == pytest.approx((0.0, -2.0, 0.0), abs=1e-6)


def test_noise_of_the_anemometer_follows_the_seed() -> None:
    def readings(seed: int) -> list[float]:
        with simkit.load(boat(ANEMOMETER.format(0.5)), seed=seed) as sim:
            wind = sim.subscribe("/anemometer", keep=100)
            sim.run(5.0)
            return [m.vector.y for m in wind.messages]

    first = readings(1)
    assert first == readings(1) != readings(2)
    assert sum(first) / len(first) == pytest.approx(-10.0, abs=0.3)


SAIL = """<sdf version="1.9"><world name="sea"><gravity>0 0 0</gravity>
  <physics name="p" type="ode"><max_step_size>0.005</max_step_size></physics><model name="boat">
  <link name="hull"><inertial><mass>1000</mass><inertia><ixx>1e3</ixx><iyy>1e3</iyy><izz>1e3</izz></inertia></inertial>
  </link><link name="boom">
  <inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
  </link>
  <joint name="rig" type="revolute"><parent>hull</parent><child>boom</child><axis><xyz>0 0 1</xyz>
    <limit><lower>-1.5</lower><upper>1.5</upper></limit><dynamics><damping>5</damping></dynamics></axis></joint>
  <plugin filename="asv_sim2-sail-position-controller-system" name="gz::sim::systems::SailPositionController">
    <joint_name>rig</joint_name><topic>/rig/cmd_pos</topic><p_gain>20</p_gain><i_gain>0</i_gain><d_gain>0</d_gain>
  </plugin></model></world></sdf>"""


def test_a_sheet_pulls_a_sail_in_and_never_pushes_it_out() -> None:
    with simkit.load(SAIL) as sim:
        rig = sim.joint("boat::rig")
        rig.set_position(1.0)
        sim.publish("/rig/cmd_pos", {"data": 0.4})
        sim.run(3.0)
        assert rig.position == pytest.approx(0.4, abs=0.02)
        sim.publish("/rig/cmd_pos", {"data": 1.2})
        sim.run(3.0)
        assert rig.position == pytest.approx(0.4, abs=0.02)


BEAMS = "".join(
    f'<beam id="{i}"><aperture>3</aperture><rotation>{r}</rotation><tilt>25</tilt></beam>'
    for i, r in enumerate((-135, 135, 45, -45))
)
DVL = """<sensor name="dvl" type="custom" gz:type="dvl"><update_rate>8</update_rate><topic>/dvl/velocity</topic>
  <gz:dvl><type>phased_array</type><arrangement degrees="true">{beams}</arrangement><tracking>
  <bottom_mode><when>best</when><noise type="gaussian"><stddev>{noise}</stddev></noise></bottom_mode>
  <water_mass_mode><when>best</when><water_velocity><x>0.2</x><y>0</y><z>0</z></water_velocity>
  <boundaries><near>3</near><far>6</far></boundaries><noise type="gaussian"><stddev>0.015</stddev></noise>
  </water_mass_mode></tracking><maximum_range>{reach}</maximum_range><minimum_range>0.3</minimum_range>
  <reference_frame>0 0 0 0 0 1.5707963267948966</reference_frame></gz:dvl></sensor>"""
FLOOR = """<model name="floor"><static>true</static><link name="l"><collision name="c"><geometry><plane>
  <normal>0 0 1</normal><size>100 100</size></plane></geometry></collision></link></model>"""


def test_a_log_measures_its_velocity_over_the_bottom_in_its_frame() -> None:
    with simkit.load(boat(DVL.format(beams=BEAMS, noise=0, reach=80), FLOOR)) as sim:
        log = sim.subscribe("/dvl/velocity", keep=1)
        sim.link("boat::hull").set_velocity((0.6, 0.0, -0.1))
        sim.run(1.0)
        last = log.messages[-1]
        velocity = last.velocity.twist.linear
        assert last.target.type == "DVL_TARGET_BOTTOM"
        assert (velocity.x, velocity.y, velocity.z) == pytest.approx((0.0, -0.6, -0.1), abs=1e-6)
        height = float(sim.link("boat::hull").pose.position[2])
        nearest = height / math.cos(math.radians(25 - 1.5))  # the near edge of the cone
        assert [beam.range for beam in last.beams] == pytest.approx([nearest] * 4, rel=5e-3)
        assert all(beam.locked for beam in last.beams)


def test_a_log_without_a_bottom_measures_its_velocity_through_the_water() -> None:
    with simkit.load(boat(DVL.format(beams=BEAMS, noise=0.005, reach=8), FLOOR), seed=3) as sim:
        log = sim.subscribe("/dvl/velocity", keep=200)
        sim.link("boat::hull").set_velocity((0.6, 0.0, 0.0))
        sim.run(20.0)
        assert {m.target.type for m in log.messages} == {"DVL_TARGET_WATER_MASS"}
        speeds = [m.velocity.twist.linear.y for m in log.messages]
        assert sum(speeds) / len(speeds) == pytest.approx(-0.4, abs=0.01)
        assert max(speeds) - min(speeds) > 0.01


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("phased_array", "phased"),
        ("<tilt>25", "<tilt>90"),
        ("<far>6<", "<far>90<"),
        ("<when>best", "<when>worst"),
        ("<maximum_range>80", "<maximum_range>0.05"),
    ],
)
def test_an_invalid_value_of_a_log_is_an_error(before: str, after: str) -> None:
    text = boat(DVL.format(beams=BEAMS, noise=0, reach=80).replace(before, after, 1))
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        simkit.load(text, strict=True)


def test_all_values_of_a_log_are_read() -> None:
    beams = [{"rotation": 1.0, "tilt": 0.5}, {"id": 7, "aperture": 0.1}, {}]
    log = read_dvl(simkit.Params.from_dict({"dvl": {"arrangement": {"beam": beams}, "tracking": {"bottom_mode": {}}}}))
    assert [b.id for b in log.beams] == [0, 7, 2]
    assert (log.beams[0].rotation, log.beams[0].aperture) == (1.0, pytest.approx(math.pi / 2))
    assert log.modes["bottom_mode"].when == "always"
    assert (log.type, log.range, log.layer) == ("piston", (0.1, 100.0), (20.0, 80.0, 5))
