"""Velocity servos on joints whose file states a damping and a friction."""

from __future__ import annotations

import pytest

import simkit

SPEED = 4.0  # [rad/s]


def wheel(dynamics: str, effort: float = 1e16) -> simkit.Simulation:
    """Light wheel, driven as one side of a differential drive whose base is fixed in the air."""
    inertial = "<inertial><mass>0.1</mass><inertia><ixx>2e-5</ixx><iyy>2e-5</iyy><izz>2e-5</izz></inertia></inertial>"
    parts = [
        f"""<link name="{side}"><pose>0 {y} 0 0 0 0</pose>{inertial}</link>
        <joint name="{side}_axle" type="revolute"><parent>base</parent><child>{side}</child><axis><xyz>0 1 0</xyz>
        <limit><effort>{effort}</effort></limit><dynamics>{dynamics}</dynamics></axis></joint>"""
        for side, y in (("left", 0.25), ("right", -0.25))
    ]
    return simkit.load(f"""<sdf version="1.9"><world name="w"><model name="m">
      <link name="base"/><joint name="fixed" type="fixed"><parent>world</parent><child>base</child></joint>
      {"".join(parts)}<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
      <left_joint>left_axle</left_joint><right_joint>right_axle</right_joint><wheel_separation>0.5</wheel_separation>
      <wheel_radius>0.1</wheel_radius><topic>/cmd_vel</topic></plugin></model></world></sdf>""")


def speed_after(sim: simkit.Simulation, duration: float, command: float = SPEED) -> float:
    sim.publish("/cmd_vel", {"linear": {"x": 0.1 * command}})
    sim.run(duration)
    return float(sim.joint("m::left_axle").velocity)


@pytest.mark.parametrize("dynamics", ["<damping>3</damping>", "<friction>0.5</friction>"])
@pytest.mark.parametrize("command", [SPEED, -SPEED])
def test_a_stated_load_does_not_delay_the_wheel(dynamics: str, command: float) -> None:
    """The time constant of the servo without a load is 2/3 of a step: after 10 ms nothing of the start is left."""
    with wheel(dynamics) as sim:
        assert speed_after(sim, 0.010, command) == pytest.approx(command, rel=2e-3)


def test_a_very_slow_wheel_gets_its_speed_too() -> None:
    """MuJoCo's friction is full only from 0.05 rad/s on, so the correction takes some of it back."""
    with wheel("<friction>0.5</friction>") as sim:
        assert speed_after(sim, 1.0, 0.01) == pytest.approx(0.01, rel=1e-2)


def test_the_effort_is_the_stated_load() -> None:
    with wheel("<damping>3</damping><friction>0.5</friction>") as sim:
        speed_after(sim, 0.5)
        assert float(sim.joint("m::left_axle").effort) == pytest.approx(3 * SPEED + 0.5, rel=1e-3)


def test_the_effort_limit_bounds_the_compensation() -> None:
    """The limit balances the damping at 2 rad/s: 3 · 2 N·m."""
    with wheel("<damping>3</damping>", effort=6.0) as sim:
        assert speed_after(sim, 0.5) == pytest.approx(2.0, rel=1e-3)
        assert speed_after(sim, 0.1, 1.0) == pytest.approx(1.0, rel=1e-2)  # no windup


def test_a_command_of_zero_stops_the_wheel() -> None:
    with wheel("<damping>0.1</damping><friction>0.5</friction>") as sim:
        speed_after(sim, 0.2)
        assert speed_after(sim, 0.05, 0.0) == pytest.approx(0.0, abs=1e-3)
        assert speed_after(sim, 0.2, 0.0) == pytest.approx(0.0, abs=1e-6)


def test_a_restored_run_repeats_bit_for_bit() -> None:
    with wheel("<damping>3</damping><friction>0.5</friction>") as sim:
        speed_after(sim, 0.055)
        snapshot = sim.snapshot()
        first = speed_after(sim, 0.1, -1.0)
        sim.restore(snapshot)
        assert speed_after(sim, 0.1, -1.0) == first
