"""Air speed: dynamic pressure along the tube, wind, lever arms."""

from __future__ import annotations

import math

import pytest
from sensor_worlds import noise, sensor, world

import simkit

WIND = "<wind><linear_velocity>-6 2 1</linear_velocity></wind>"
QUIRKS = "<gazebo_quirks>true</gazebo_quirks>"
LEVEL = "0 0 0 0 0 0"
CALM = "<gravity>0 0 0</gravity>"
DENSITY = 101325 * 28.9644 / (8314.32 * 288.15)  # [kg/m3] at sea level


def pitot(block: str = "", top: str = "", *, mounted: str = LEVEL, pose: str = LEVEL, static: bool = False) -> str:
    text = sensor("air_speed", f"<air_speed>{block}</air_speed>", rate=0, pose=mounted)
    return world(text, pose=pose, static=static, top=top)


def read(text: str, velocity: tuple[float, float, float] = (0, 0, 0), turn: float = 0.0) -> simkit.Simulation:
    sim = simkit.load(text)
    sim.model("m").set_velocity(velocity, (0, 0, turn))
    sim.step(1)
    return sim


@pytest.mark.parametrize("speed", [0.0, 3.0, 40.0, -12.0])
def test_it_is_half_rho_v_squared_with_the_sign_of_the_speed(speed: float) -> None:
    with read(pitot(top=CALM), (speed, 5.0, -2.0)) as sim:
        message = sim.sensor("m::l::s").latest
        assert message.diff_pressure == pytest.approx(0.5 * DENSITY * speed * abs(speed), rel=1e-6, abs=1e-12)
        assert message.temperature == pytest.approx(288.15, abs=1e-3)
        topic = "/world/w/model/m/link/l/sensor/s/air_speed"
        assert sim.topics()[topic] == "ros_gz_interfaces/msg/AirSpeed"


def test_it_looks_along_its_own_x() -> None:
    """The sensor has a yaw of 0.4 rad and moves along the world's y axis: the air speed is v·sin(0.4)."""
    with read(pitot(mounted="0 0 0 0 0 0.4", top=CALM), (0.0, 30.0, 0.0)) as sim:
        speed = 30 * math.sin(0.4)
        assert sim.sensor("m::l::s").latest.diff_pressure == pytest.approx(0.5 * DENSITY * speed**2, rel=1e-6)


def test_a_turning_wing_meets_more_air_at_its_tip() -> None:
    with read(pitot(mounted="0 -3 0 0 0 0", top=CALM), (10.0, 0.0, 0.0), 2.0) as sim:
        assert sim.sensor("m::l::s").latest.diff_pressure == pytest.approx(0.5 * DENSITY * 16**2, rel=1e-4)


def test_headwind_adds_and_gazebo_ignores_wind() -> None:
    with read(pitot(top=CALM + WIND), (10.0, 0.0, 0.0)) as sim:
        assert sim.sensor("m::l::s").latest.diff_pressure == pytest.approx(0.5 * DENSITY * 16**2, rel=1e-5)
    with read(pitot(top=CALM + WIND + QUIRKS), (10.0, 0.0, 0.0)) as sim:
        assert sim.sensor("m::l::s").latest.diff_pressure == pytest.approx(0.5 * DENSITY * 10**2, rel=1e-5)
    with simkit.load(pitot(top=WIND, static=True)) as sim:  # a mast
        sim.step(1)
        assert sim.sensor("m::l::s").latest.diff_pressure == pytest.approx(0.5 * DENSITY * 6**2, rel=1e-9)


def test_higher_up_the_air_is_thinner_and_colder() -> None:
    with read(pitot(pose="0 0 3000 0 0 0", top=CALM), (20.0, 0, 0)) as sim:
        message = sim.sensor("m::l::s").latest
        assert message.temperature == pytest.approx(268.659, abs=1e-3)  # the standard's table
        assert message.diff_pressure == pytest.approx(0.5 * 0.90925 * 400, rel=2e-5)


@pytest.mark.parametrize(("top", "factor"), [("", 1.0), (QUIRKS, 100.0)])
def test_noise_is_in_pascal_and_gazebos_in_hectopascal(top: str, factor: float) -> None:
    with simkit.load(pitot(f"<pressure>{noise(0.2)}</pressure>", top=top, static=True), seed=1) as sim:
        sub = sim.subscribe("/world/w/model/m/link/l/sensor/s/air_speed")
        sim.step(2000)
        values = [m.diff_pressure for m in sub.messages]
        assert math.sqrt(sum(v * v for v in values) / 2000) == pytest.approx(0.2 * factor, rel=0.06)
        assert sim.sensor("m::l::s").truth.diff_pressure == 0.0
