"""Wind on boats: force and torque by the coefficients, drift, gusts, topics."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit

MASS = 20.0
GZ = 'filename="libUSVWind.so" name="vrx::USVWind"'
CLASSIC = 'filename="libusv_gazebo_wind_plugin.so" name="wind"'


def world(names: str = GZ, parameters: str = "", target: str = "hull", yaw: float = 0.0) -> str:
    return f"""<sdf version="1.9"><world name="sea"><gravity>0 0 0</gravity>
      <physics name="p" type="ode"><max_step_size>0.01</max_step_size></physics>
      <plugin {names}><wind_obj><name>boat</name><link_name>{target}</link_name><coeff_vector>0.5 0.8 0.3</coeff_vector>
        </wind_obj><wind_direction>30</wind_direction><wind_mean_velocity>6</wind_mean_velocity>{parameters}</plugin>
      <model name="boat"><pose>0 0 0 0 0 {yaw}</pose><link name="hull"><inertial><mass>{MASS}</mass>
        <inertia><ixx>4</ixx><iyy>4</iyy><izz>4</izz></inertia></inertial></link></model></world></sdf>"""


@pytest.mark.parametrize("names", [GZ, CLASSIC])
@pytest.mark.parametrize("yaw", [0.0, 1.2])
def test_force_and_torque_follow_the_wind_in_the_axes_of_the_link(names: str, yaw: float) -> None:
    with simkit.load(world(names, yaw=yaw)) as sim:
        velocity = np.array((1.0, -0.5, 0))
        sim.model("boat").set_velocity(tuple(velocity), (0, 0, 0))
        sim.step()
        hull = sim.link("boat::hull")
        angle = math.radians(30)
        air = 6 * np.array((math.cos(angle), math.sin(angle), 0)) - velocity
        turn = np.array(((math.cos(yaw), -math.sin(yaw), 0), (math.sin(yaw), math.cos(yaw), 0), (0, 0, 1)))
        u, v, _ = turn.T @ air
        force = turn @ (0.5 * u * abs(u), 0.8 * v * abs(v), 0)
        np.testing.assert_allclose((hull.linear_velocity - velocity) * MASS / sim.timestep, force, atol=1e-9)
        assert hull.angular_velocity[2] * 4 / sim.timestep == pytest.approx(-2 * 0.3 * u * v)


def test_a_boat_drifts_to_the_speed_of_the_wind() -> None:
    text = world().replace("0.5 0.8 0.3", "5 5 0").replace("<wind_direction>30", "<wind_direction>0")
    with simkit.load(text) as sim:
        sim.run(10.0)  # dv/dt = c/m·(6 - v)²: 6 - v = 6/(1 + 6·c·t/m)
        assert sim.link("boat::hull").linear_velocity[0] == pytest.approx(6 - 6 / (1 + 6 * 5 * 10 / MASS), rel=2e-3)


@pytest.mark.slow  # slow: 8000 steps with a message each
def test_gusts_have_their_strength_and_time_constant_and_are_published() -> None:
    gusts = (
        "<var_wind_gain_constants>1.5</var_wind_gain_constants><var_wind_time_constants>0.2</var_wind_time_constants>"
    )
    topics = "<update_rate>100</update_rate><topic_wind_speed>/wind/speed</topic_wind_speed>"
    for names, kind in ((GZ, "Float32"), (CLASSIC, "Float64")):
        with simkit.load(world(names, gusts + topics, target="boat::hull")) as sim:
            speeds = sim.subscribe("/wind/speed", keep=9999)
            angles = sim.subscribe("/vrx/debug/wind/direction", keep=1)
            sim.run(40.0)
            values = np.array([message.data for message in speeds.messages])
            assert type(speeds.messages[-1]).__name__.endswith(kind)
            assert angles.messages[-1].data == pytest.approx(30)
            assert len(values) == pytest.approx(4000, abs=1)
            assert values.mean() == pytest.approx(6.0, abs=0.5)
            assert values.std() == pytest.approx(1.5, rel=0.2)
            centred = values - values.mean()
            lag = np.mean(centred[:-20] * centred[20:]) / np.mean(centred**2)
            assert lag == pytest.approx(math.exp(-1), abs=0.15)


def test_runs_with_a_seed_repeat_and_another_random_seed_differs() -> None:
    def end(seed: int, random_seed: int) -> float:
        gusts = f"<var_wind_gain_constants>2</var_wind_gain_constants><random_seed>{random_seed}</random_seed>"
        with simkit.load(world(parameters=gusts), seed=seed) as sim:
            sim.run(0.5)
            return float(sim.link("boat::hull").linear_velocity[0])

    assert end(1, 0) == end(1, 0)
    assert end(1, 0) != end(2, 0)
    assert end(1, 0) != end(1, 7)


def test_a_missing_link_is_reported() -> None:
    with simkit.load(world(target="deck")) as sim:
        assert "SK-PLUGIN-140" in {found.code for found in sim.diagnostics}
        sim.run(0.1)
