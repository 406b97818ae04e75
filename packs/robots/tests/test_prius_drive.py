"""The car of car_demo: pedals, gear, brakes, steering, the hand brake and the timeout of commands."""

from __future__ import annotations

import math

import pytest
from plugin_worlds import GROUND, element, world

import simkit

TOPIC = "/prius"
SPHERE = "<collision name='c'><geometry><sphere><radius>0.3</radius></sphere></geometry></collision>"
SOLID = "<inertial><mass>{}</mass><inertia><ixx>{i}</ixx><iyy>{i}</iyy><izz>{i}</izz></inertia></inertial>"


def wheel(name: str, x: float, y: float, parent: str) -> str:
    """Return a wheel of 0.3 m radius on a link."""
    joint = f"""<joint name='{name}' type='continuous'><parent>{parent}</parent><child>{name}_link</child>
    <axis><xyz>0 1 0</xyz></axis></joint>"""
    return f"<link name='{name}_link'><pose>{x} {y} 0.3 0 0 0</pose>{SOLID.format(20, i=1)}{SPHERE}</link>{joint}"


def steered(name: str, x: float, y: float, z: float = 0.3, axis: str = "0 0 1") -> str:
    """Return a link that turns about an axis of the chassis."""
    return f"""<link name='{name}_link'><pose>{x} {y} {z} 0 0 0</pose>{SOLID.format(5, i=0.5)}</link>
    <joint name='{name}' type='revolute'><parent>chassis</parent><child>{name}_link</child>
    <axis><xyz>{axis}</xyz><limit><lower>-9</lower><upper>9</upper></limit></axis></joint>"""


def prius(**values: object) -> simkit.Simulation:
    """Load a car of 1 t with a wheel base of 2.6 m and a track of 1.5 m."""
    settings = {
        "chassis": "chassis", "front_left_wheel": "fl", "front_right_wheel": "fr", "back_left_wheel": "bl",
        "back_right_wheel": "br", "front_left_wheel_steering": "fls", "front_right_wheel_steering": "frs",
        "steering_wheel": "hand", "front_torque": 500, "back_torque": 0, "front_brake_torque": 1000,
        "back_brake_torque": 700, "max_speed": 38, "max_steer": 0.6458, "flwheel_steering_p_gain": 1e4,
        "frwheel_steering_p_gain": 1e4, "flwheel_steering_d_gain": 3e2, "frwheel_steering_d_gain": 3e2, **values,
    }  # fmt: skip
    parts = [
        f"<link name='chassis'><pose>0 0 0.5 0 0 0</pose>{SOLID.format(1000, i=600)}</link>",
        *(steered(f"f{s}s", 1.3, y) for s, y in (("l", 0.75), ("r", -0.75))),
        *(wheel(f"f{s}", 1.3, y, f"f{s}s_link") for s, y in (("l", 0.75), ("r", -0.75))),
        *(wheel(f"b{s}", -1.3, y, "chassis") for s, y in (("l", 0.75), ("r", -0.75))),
        steered("hand", 0.3, 0.3, 1.0),
    ]
    plugin = element("plugin", settings, "name='drive' filename='libPriusHybridPlugin.so'")
    return simkit.load(world(GROUND, f"<model name='prius'>{''.join(parts)}{plugin}</model>", step=0.002))


def drive(sim: simkit.Simulation, seconds: float, **command: float) -> simkit.Pose:
    """Send a command every 0.1 s for a time, and return the pose of the chassis."""
    for _ in range(round(seconds * 10)):
        sim.publish(TOPIC, command)
        sim.run(0.1)
    return sim.link("prius::chassis").pose


def test_the_throttle_accelerates_the_car_by_the_torques_of_its_wheels() -> None:
    with prius(chassis_aero_force_gain=0) as sim:
        drive(sim, 1.0)
        before = sim.link("prius::chassis").linear_velocity[0]
        drive(sim, 2.0, throttle=0.6, shift_gears=2)
        speed = sim.link("prius::chassis").linear_velocity[0] - before
    # two wheels of 0.6 * 500 N m at 0.3 m push 1095 kg and the inertia of 4 wheels of 1 kg m2
    assert speed == pytest.approx(2.0 * 2 * 300 / 0.3 / (1095 + 4 / 0.3**2), rel=0.03)


def test_the_hand_brake_holds_the_car_until_the_first_throttle_and_then_it_creeps() -> None:
    with prius() as sim:
        sim.run(1.0)
        start = sim.link("prius::chassis").pose.position[0]
        sim.run(1.0)
        assert sim.link("prius::chassis").pose.position[0] == pytest.approx(
            start, abs=5e-3
        )  # contacts creep by 1.6 mm/s
        drive(sim, 0.1, throttle=0.1, shift_gears=2)
        sim.run(4.0)
        assert 0.2 < sim.link("prius::chassis").linear_velocity[0] < 7 / 2.23694


def test_the_brake_stops_the_car_and_reverse_drives_it_back() -> None:
    with prius() as sim:
        drive(sim, 3.0, throttle=0.6, shift_gears=2)
        place = drive(sim, 3.0, brake=1.0)
        assert sim.link("prius::chassis").linear_velocity[0] == pytest.approx(0.0, abs=0.02)
        assert drive(sim, 2.0, throttle=0.5, shift_gears=3).position[0] < place.position[0] - 1.0
        sim.publish("/cmd_gear", {"data": 1})
        place = drive(sim, 1.0, brake=1.0)
        sim.run(2.0)  # neutral: no creeping
        assert sim.link("prius::chassis").linear_velocity[0] == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize("steer", [0.5, -0.5])
def test_the_car_turns_about_one_point_at_the_angle_of_the_steering_wheel(steer: float) -> None:
    with prius() as sim:
        drive(sim, 2.0, throttle=0.2, shift_gears=2)
        drive(sim, 2.0, throttle=0.1, steer=steer)
        yaw, place = sim.link("prius::chassis").pose.rpy[2], sim.link("prius::bl_link").pose.position
        drive(sim, 0.5, throttle=0.1, steer=steer)
        turned = sim.link("prius::chassis").pose.rpy[2] - yaw
        back = (sim.link("prius::bl_link").pose.position, sim.link("prius::br_link").pose.position)
        inner, outer = (
            sim.joint(f"prius::{name}").position for name in (("fls", "frs") if steer > 0 else ("frs", "fls"))
        )
        hand = sim.joint("prius::hand").position
    assert hand == pytest.approx(7.85 * steer, abs=0.05)
    angle = 0.6458 * abs(steer)  # the middle wheel: half of the largest angle
    radius = 2.6 / math.tan(angle)
    assert abs(inner) == pytest.approx(math.atan(2.6 / (radius - 0.75)), abs=0.01)
    assert abs(outer) == pytest.approx(math.atan(2.6 / (radius + 0.75)), abs=0.01)
    travelled = math.dist(back[0], place)
    of_left = radius - 0.75 if steer > 0 else radius + 0.75
    assert turned == pytest.approx(math.copysign(travelled / of_left, steer), rel=0.06)


def test_commands_end_after_their_timeout_and_a_snapshot_keeps_the_brakes() -> None:
    with prius() as sim:
        drive(sim, 1.0, throttle=0.5, shift_gears=2, steer=0.2)
        snapshot = sim.snapshot()
        sim.run(1.0)
        first = sim.link("prius::chassis").pose.position
        assert sim.joint("prius::hand").position == pytest.approx(0.0, abs=0.2)
        sim.restore(snapshot)
        sim.run(1.0)
        assert sim.link("prius::chassis").pose.position.tolist() == first.tolist()


def test_pedals_on_cmd_vel_drive_the_car_as_well() -> None:
    with prius() as sim:
        for _ in range(20):
            sim.publish("/cmd_vel", {"position": {"x": 0.4, "y": 2.0, "z": 0.0}})
            sim.run(0.1)
        assert sim.joint("prius::hand").position == pytest.approx(2.0, abs=0.05)
        assert sim.link("prius::chassis").pose.position[0] > 1.0


def test_a_car_without_collisions_of_its_wheels_is_an_error() -> None:
    with pytest.raises(simkit.InputError, match="SK-PLUGIN-003"):
        prius(front_left_wheel="nothing")
