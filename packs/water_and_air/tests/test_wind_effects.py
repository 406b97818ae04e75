"""Wind over time, and its forces on links."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit
from simkit import msgs
from simkit.extend import NEVER
from simkit_water_and_air.plugins.fluids.wind_effects import WindPluginBase

_NOW = "<time_for_rise>1e-6</time_for_rise>"
AT_ONCE = (
    f"<horizontal><magnitude>{_NOW}</magnitude><direction>{_NOW}</direction></horizontal><vertical>{_NOW}</vertical>"
)
BODY = """<model name="{name}"><pose>{x} 0 0 0 0 1</pose><link name="body"><enable_wind>{windy}</enable_wind><inertial>
<pose>0.1 0 0 0 0 0</pose><mass>2</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
</model>"""


def world(parameters: str = AT_ONCE, wind: str = "3 4 1", plugin: str = "gz", more: str = "") -> str:
    names = {
        "gz": 'filename="gz-sim-wind-effects-system" name="gz::sim::systems::WindEffects"',
        "classic": 'filename="libWindPlugin.so" name="wind"',
    }
    bodies = BODY.format(name="leaf", x=0, windy="true") + BODY.format(name="stone", x=9, windy="false")
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
    <wind><linear_velocity>{wind}</linear_velocity></wind>{bodies}{more}
    <plugin {names[plugin]}>{parameters}</plugin></world></sdf>"""


def speed(sim: simkit.Simulation, name: str = "leaf") -> np.ndarray:
    return sim.link(f"{name}::body").linear_velocity


@pytest.mark.parametrize("plugin", ["gz", "classic"])
def test_the_wind_accelerates_links_in_proportion_to_the_velocity_difference(plugin: str) -> None:
    """With F = m (wind − v) at each step, v after n steps is wind · (1 − (1 − dt)ⁿ), at the centre of mass."""
    sim = simkit.load(world(plugin=plugin))
    sim.step(500)
    assert speed(sim) == pytest.approx(np.array((3, 4, 1)) * (1 - 0.999**500), rel=1e-9)
    assert np.linalg.norm(sim.link("leaf::body").angular_velocity) < 1e-12
    assert not speed(sim, "stone").any()


def test_the_factor_of_the_force() -> None:
    sim = simkit.load(world(AT_ONCE + "<force_approximation_scaling_factor>0.5</force_approximation_scaling_factor>"))
    sim.step(100)
    assert speed(sim) == pytest.approx(np.array((3, 4, 1)) * (1 - 0.9995**100), rel=1e-9)


def test_with_gazebos_quirks_a_plain_factor_counts_squared() -> None:
    text = world(AT_ONCE + "<force_approximation_scaling_factor>0.5</force_approximation_scaling_factor>")
    text = text.replace("<gravity>", "<simkit:gazebo_quirks>true</simkit:gazebo_quirks><gravity>")
    sim = simkit.load(text.replace("<sdf ", '<sdf xmlns:simkit="https://simkit.dev/sdf" '))
    sim.step(100)
    assert speed(sim) == pytest.approx(np.array((3, 4, 1)) * (1 - 0.99975**100), rel=1e-9)


FIELD = """<force_approximation_scaling_factor><when xlt="-1">0.25</when>
<when xge="-1" xlt="4"><k>2</k><px>0 0 1 3</px><rz>0 1 0 0</rz></when></force_approximation_scaling_factor>"""


@pytest.mark.parametrize(("x", "factor"), [(-2, 0.25), (-1, 4.0), (3, 12.0), (4, 0.0)])
def test_a_field_of_factors(x: float, factor: float) -> None:
    """The factor is 2 (x + 3 + z²) between −1 and 4, 0.25 below and 0 above."""
    sim = simkit.load(world(AT_ONCE + FIELD, more=BODY.format(name="kite", x=x, windy="true")))
    sim.step()
    assert speed(sim, "kite") == pytest.approx(np.array((3, 4, 1)) * factor * 1e-3, rel=1e-9, abs=1e-15)


def test_it_rises_as_a_low_pass_filter() -> None:
    rise = """<horizontal><magnitude><time_for_rise>2</time_for_rise></magnitude></horizontal>
    <vertical><time_for_rise>0.5</time_for_rise></vertical>"""
    sim = simkit.load(world(rise))
    sim.step(1000)
    x, y, z = sim.engine.wind.at(sim.tick - 1)
    assert math.hypot(x, y) == pytest.approx(5 * (1 - (1 - 0.001 / 2) ** 1000), rel=1e-9)
    assert z == pytest.approx(1 - (1 - 0.001 / 0.5) ** 1000, rel=1e-9)
    assert math.atan2(y, x) == pytest.approx(math.atan2(4, 3))  # the heading is there from the start


def test_strength_and_heading_swing() -> None:
    swing = """<horizontal><magnitude><time_for_rise>1e-6</time_for_rise><sin><amplitude_percent>0.2</amplitude_percent>
    <period>0.4</period></sin></magnitude><direction><sin><amplitude>30</amplitude><period>0.2</period></sin></direction>
    </horizontal><vertical><time_for_rise>1e-6</time_for_rise></vertical>"""
    sim = simkit.load(world(swing, wind="0 2 0"))
    for tick in (49, 99, 149, 262):
        t = (tick + 1) * 0.001
        x, y, _ = sim.engine.wind.at(tick)
        assert math.hypot(x, y) == pytest.approx(2 * (1 + 0.2 * math.sin(2 * math.pi * t / 0.4)), rel=1e-9)
        turned = 90 + 30 * math.sin(2 * math.pi * t / 0.2)
        assert math.degrees(math.atan2(y, x)) == pytest.approx(turned, abs=1e-9)


def test_noise_has_its_deviation_and_is_the_same_for_all_readers() -> None:
    noise = """<horizontal><magnitude><time_for_rise>1e-6</time_for_rise><noise type="gaussian"><mean>0.5</mean>
    <stddev>0.2</stddev></noise></magnitude></horizontal><vertical><noise type="gaussian"><stddev>0.3</stddev></noise>
    <time_for_rise>1e-6</time_for_rise></vertical>"""
    sim = simkit.load(world(noise), seed=4)
    blown = np.array([sim.engine.wind.at(tick) for tick in range(4000)])
    strengths = np.hypot(blown[:, 0], blown[:, 1])
    assert strengths.mean() == pytest.approx(5.5, abs=4 * 0.2 / math.sqrt(4000))
    assert strengths.std() == pytest.approx(0.2, rel=0.05)
    assert blown[:, 2].std() == pytest.approx(0.3, rel=0.05)
    again = simkit.load(world(noise), seed=4)
    assert [again.engine.wind.at(tick) for tick in (17, 3, 3999)] == [tuple(blown[tick]) for tick in (17, 3, 3999)]
    assert simkit.load(world(noise), seed=5).engine.wind.at(17) != tuple(blown[17])


def test_commands_change_the_target() -> None:
    rise = "<horizontal><magnitude><time_for_rise>1</time_for_rise></magnitude></horizontal>"
    sim = simkit.load(world(rise, wind="2 0 0"))
    sim.step(1000)
    before = sim.engine.wind.at(sim.tick - 1)[0]
    sim.publish("/world/w/wind", {"linear_velocity": {"x": 0.0, "y": 6.0, "z": 0.0}, "enable_wind": True})
    sim.step(1000)
    x, y, _ = sim.engine.wind.at(sim.tick - 1)
    left = 0.999**1000
    assert math.hypot(x, y) == pytest.approx(6 + (before - 6) * left, rel=1e-9)
    assert math.degrees(math.atan2(y, x)) == pytest.approx(90 * (1 - left), rel=1e-9)
    answer = sim.call("/world/w/wind_info")
    assert (answer.wind.linear_velocity.y, answer.wind.enable_wind) == (6.0, True)
    assert answer.velocity.x == pytest.approx(x, rel=1e-2)


def test_a_wind_that_is_off_neither_pushes_nor_brakes() -> None:
    sim = simkit.load(world())
    sim.step(100)
    sim.publish(
        "/world/w/wind", {"linear_velocity": {"x": 3.0, "y": 4.0, "z": 1.0}}
    )  # a message without enable_wind switches the wind off, as in Gazebo
    sim.step(1)
    still = speed(sim)
    sim.step(100)
    assert (speed(sim) == still).all() and sim.engine.wind.at(sim.tick) == (0, 0, 0)
    sim.publish("/world/w/wind", msgs.type_of("geometry_msgs/msg/Vector3")(1.0, 0.0, 0.0))
    sim.step(1)
    assert speed(sim)[0] == pytest.approx(still[0] + (1 - still[0]) * 0.001, rel=1e-9)


def test_the_heading_turns_in_the_shorter_direction() -> None:
    turn = "<horizontal><direction><time_for_rise>1</time_for_rise></direction></horizontal>"
    sim = simkit.load(world(turn, wind="-1 0.1 0"))
    sim.step(10)
    sim.publish("/world/w/wind", {"linear_velocity": {"x": -1.0, "y": -0.1, "z": 0.0}, "enable_wind": True})
    sim.step(500)
    x, y, _ = sim.engine.wind.at(sim.tick)
    assert abs(math.degrees(math.atan2(y, -x))) < 6


def test_a_nan_command_is_ignored() -> None:
    sim = simkit.load(world())
    sim.publish("/world/w/wind", {"linear_velocity": {"x": math.nan, "y": 0.0, "z": 0.0}, "enable_wind": True})
    sim.step(10)
    assert [d.code for d in sim.diagnostics] == ["SK-PLUGIN-041"]
    assert sim.engine.wind.at(sim.tick)[0] == pytest.approx(3)


def test_spawned_links_are_pushed_and_without_links_there_is_no_callback() -> None:
    text = world().replace("<enable_wind>true", "<enable_wind>false")
    sim = simkit.load(text)
    assert [
        plugin.before_step_rate for plugin in sim.contents.plugins.values() if isinstance(plugin, WindPluginBase)
    ] == [NEVER]
    sim.step(100)
    sim.spawn(f'<sdf version="1.9">{BODY.format(name="late", x=3, windy="true")}</sdf>')
    sim.step(10)
    assert speed(sim, "late") == pytest.approx(np.array((3, 4, 1)) * (1 - 0.999**10), rel=1e-9)
    sim.remove("late")
    sim.step(10)


def test_reset_and_restore_include_the_wind() -> None:
    rise = """<horizontal><magnitude><time_for_rise>1</time_for_rise><noise type="gaussian"><stddev>0.5</stddev></noise>
    </magnitude></horizontal>"""
    sim = simkit.load(world(rise))
    sim.step(50)
    snapshot = sim.snapshot()
    sim.publish("/world/w/wind", {"linear_velocity": {"x": 0.0, "y": -9.0, "z": 0.0}, "enable_wind": True})
    sim.step(100)
    blown = speed(sim)
    sim.restore(snapshot)
    sim.step(100)
    calm = speed(sim)
    assert (calm != blown).any()
    sim.reset()
    sim.step(150)
    assert (speed(sim) == calm).all()


def test_an_air_speed_sensor_measures_the_gusts() -> None:
    sensor = """<model name="mast"><static>true</static><link name="top"><sensor name="pitot" type="air_speed">
    <update_rate>100</update_rate><air_speed/></sensor></link></model>"""
    rise = "<horizontal><magnitude><time_for_rise>1</time_for_rise></magnitude></horizontal>"
    sim = simkit.load(world(rise, wind="-10 0 0", more=sensor))
    readings = sim.subscribe("/world/w/model/mast/link/top/sensor/pitot/air_speed", keep=1)
    sim.step(500)
    blown = 10 * (1 - 0.999**500)
    assert readings.messages[-1].diff_pressure == pytest.approx(0.5 * 1.225 * blown**2, rel=1e-3)


@pytest.mark.parametrize(
    "bad",
    [
        "<horizontal><magnitude><time_for_rise>0</time_for_rise></magnitude></horizontal>",
        "<vertical><time_for_rise>-1</time_for_rise></vertical>",
        "<horizontal><direction><sin><period>0</period></sin></direction></horizontal>",
        "<force_approximation_scaling_factor>-1</force_approximation_scaling_factor>",
        "<force_approximation_scaling_factor><px>0 0 1 0</px></force_approximation_scaling_factor>",
        '<force_approximation_scaling_factor><when xge="0" xgt="1">1</when></force_approximation_scaling_factor>',
        '<force_approximation_scaling_factor><when xge="far">1</when></force_approximation_scaling_factor>',
        '<force_approximation_scaling_factor><when xge="0">strong</when></force_approximation_scaling_factor>',
        '<vertical><noise type="pink"/></vertical>',
    ],
)
def test_invalid_values_are_errors(bad: str) -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        simkit.load(world(bad))


def test_dynamic_bias_has_no_effect_and_is_reported() -> None:
    drift = """<vertical><noise type="gaussian"><stddev>0.1</stddev><dynamic_bias_stddev>1</dynamic_bias_stddev>
    <dynamic_bias_correlation_time>5</dynamic_bias_correlation_time></noise></vertical>"""
    assert [d.code for d in simkit.load(world(drift)).diagnostics] == ["SK-PLUGIN-111"] * 2


@pytest.mark.parametrize("first", ["gz", "classic"])
def test_the_first_of_two_wind_plugins_counts(first: str) -> None:
    other = '<plugin filename="gz-sim-wind-effects-system" name="gz::sim::systems::WindEffects"/>'
    text = world(plugin=first)
    both = text.replace("</plugin></world>", f"</plugin>{other}</world>")
    one, two = simkit.load(text), simkit.load(both)
    assert [d.code for d in two.diagnostics] == ["SK-PLUGIN-111"]
    for sim in (one, two):
        sim.publish("/world/w/wind", {"linear_velocity": {"x": 2.0}, "enable_wind": True})
        sim.step(100)
    assert speed(two).tolist() == speed(one).tolist()
    assert two.call("/world/w/wind_info").velocity.x == one.call("/world/w/wind_info").velocity.x


def test_many_links_get_the_same_forces_as_each_alone() -> None:
    """Few links are computed one by one, many with arrays."""
    field = """<force_approximation_scaling_factor><when xlt="0"><k>2</k><px>0 0 0 0.3</px><qy>0 1e-3 0 1</qy></when>
    <when xge="0" xle="400"><px>0 0 0 1</px><rz>0 0.01 0 1</rz></when></force_approximation_scaling_factor>"""
    more = "".join(BODY.format(name=f"l{n}", x=3 * n + 20, windy="true") for n in range(12))
    alone, together = (simkit.load(world(AT_ONCE + field, more=text)) for text in ("", more))
    for sim in (alone, together):
        sim.link("leaf::body").set_velocity(linear=(0.1, 0.2, 0.3), angular=(1.0, 2.0, 3.0))
        sim.step(100)
    assert speed(alone) == pytest.approx(speed(together), rel=1e-12)
