"""Slip of wheels over the ground, from their contacts."""

from __future__ import annotations

import math

import pytest

import simkit
from simkit.runtime.contact.rim_slip import WheelSlip

GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="plane">
<geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link></model>"""


def cart(axis: str = "0 1 0", height: float = 0.1, mass: float = 10.0) -> str:
    """Return a base with four free wheels of the radius 0.1 m; x is ahead."""
    inertia = "<inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia>"
    parts = [f"<link name='base'><inertial><mass>{mass}</mass>{inertia}</inertial></link>"]
    for name, x, y in (("fl", 0.2, 0.2), ("fr", 0.2, -0.2), ("bl", -0.2, 0.2), ("br", -0.2, -0.2)):
        parts.append(
            f"<link name='{name}'><pose>{x} {y} 0 1.5707963 0 0</pose><inertial><mass>0.5</mass>{inertia}</inertial>"
            "<collision name='tread'><geometry><cylinder><radius>0.1</radius><length>0.02</length></cylinder>"
            "</geometry><surface><friction><ode><mu>0.5</mu><mu2>0.5</mu2></ode></friction></surface></collision></link>"
            f"<joint name='{name}_joint' type='continuous'><parent>base</parent><child>{name}</child>"
            f"<axis><xyz expressed_in='__model__'>{axis}</xyz></axis></joint>"
        )
    return f"<model name='cart'><pose>0 0 {height} 0 0 0</pose>{''.join(parts)}</model>"


def world(*models: str) -> str:
    return f"<sdf version='1.9'><world name='w'>{''.join(models)}</world></sdf>"


def slips(sim: simkit.Simulation) -> dict[str, WheelSlip]:
    return {wheel.joint.removeprefix("cart::"): wheel for wheel in sim.wheel_slips("cart")}


@pytest.fixture
def cart_on_ground() -> simkit.Simulation:
    sim = simkit.load(world(GROUND, cart()))
    sim.run(0.1)  # it settles
    return sim


def test_a_wheel_that_rolls_has_the_speeds_of_its_axle_and_no_slip(cart_on_ground: simkit.Simulation) -> None:
    sim = cart_on_ground
    sim.model("cart").set_velocity((0.4, 0.0, 0.0), (0.0, 0.0, 0.0))
    for name in ("fl", "fr", "bl", "br"):
        sim.joint(f"cart::{name}_joint").set_velocity(4.0)
    sim.run(0.1)
    for wheel in slips(sim).values():
        assert wheel.rim_speed == pytest.approx(0.4, rel=0.01)
        assert wheel.slip == pytest.approx(0.0, abs=1e-4)
        assert wheel.ratio == pytest.approx(0.0, abs=1e-3)
        assert wheel.radius == pytest.approx(0.1, abs=1e-4)
        assert (wheel.collision[6:8], wheel.ground) == (wheel.joint[6:8], "ground::l::plane")
    loads = sum(wheel.load for wheel in slips(sim).values())
    assert loads == pytest.approx(12.0 * 9.8, rel=0.01)  # the weight of base and wheels


def test_a_wheel_that_turns_on_the_spot_has_the_ratio_one(cart_on_ground: simkit.Simulation) -> None:
    sim = cart_on_ground
    sim.joint("cart::fl_joint").set_velocity(-4.0)
    wheel = slips(sim)["fl_joint"]
    assert wheel.rim_speed == pytest.approx(-0.4, rel=1e-3)
    assert wheel.axle_speed == pytest.approx(0.0, abs=1e-3)
    assert wheel.slip == pytest.approx(-0.4, rel=1e-3)
    assert wheel.ratio == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("speed", [0.4, -0.4])
def test_a_blocked_wheel_that_is_dragged_has_the_ratio_minus_one(
    cart_on_ground: simkit.Simulation, speed: float
) -> None:
    sim = cart_on_ground
    sim.model("cart").set_velocity((speed, 0.1, 0.0), (0.0, 0.0, 0.0))
    for name in ("fl", "fr", "bl", "br"):
        sim.joint(f"cart::{name}_joint").set_velocity(0.0)
    wheel = slips(sim)["fl_joint"]
    assert wheel.axle_speed == pytest.approx(speed, rel=1e-6)
    assert wheel.slip == pytest.approx(-speed, rel=1e-6)
    assert wheel.ratio == pytest.approx(-1.0)
    assert wheel.sideways == pytest.approx(0.1, rel=1e-6)  # along the axis of the joint, y


def test_the_sign_follows_the_axis_of_the_joint() -> None:
    with simkit.load(world(GROUND, cart(axis="0 -1 0"))) as sim:
        sim.run(0.1)
        sim.model("cart").set_velocity((0.4, 0.0, 0.0), (0.0, 0.0, 0.0))
        sim.joint("cart::fl_joint").set_velocity(-4.0)
        wheel = slips(sim)["fl_joint"]
        assert wheel.rim_speed == pytest.approx(-0.4, rel=1e-3)
        assert wheel.axle_speed == pytest.approx(-0.4, rel=1e-3)


def test_a_wheel_in_the_air_has_no_slip() -> None:
    with simkit.load(world(GROUND, cart(height=1.0))) as sim:
        wheel = slips(sim)["fl_joint"]
        assert (wheel.ground, wheel.load) == ("", 0.0)
        assert math.isnan(wheel.slip)
        assert math.isnan(wheel.ratio)


def test_a_propeller_is_no_wheel() -> None:
    with simkit.load(
        world(GROUND, cart(height=1.0).replace("1.5707963 0 0", "0 0 0").replace("0 1 0<", "0 0 1<"))
    ) as sim:
        assert slips(sim) == {}


def test_a_stopped_wheel_has_the_ratio_zero(cart_on_ground: simkit.Simulation) -> None:
    assert {wheel.ratio for wheel in slips(cart_on_ground).values()} == {0.0}


def test_reading_the_slip_changes_no_bit() -> None:
    states = []
    for reads in (False, True):
        with simkit.load(world(GROUND, cart())) as sim:
            sim.model("cart").set_velocity((0.4, 0.1, 0.0), (0.0, 0.0, 0.5))
            for _ in range(20):
                sim.step(5)
                if reads:
                    sim.wheel_slips()
                    sim.why()
            states.append((sim.mj_data.qpos.tobytes(), sim.mj_data.qvel.tobytes()))
    assert states[0] == states[1]
