"""PAL's fingers: joints that follow one motor, each with its own factor."""

from __future__ import annotations

import math

import pytest
from joint_worlds import INERTIA, load, rotor

import simkit
from simkit.errors import LoadError

LIMITED = "<limit><lower>0</lower><upper>0.5</upper><effort>100</effort></limit>"


def virtual(joint: str, factor: float | str, gains: dict[str, float] | None = None) -> str:
    loop = "".join(f"<{name}>{value}</{name}>" for name, value in (gains or {}).items())
    block = "" if gains is None else f"<pid_gains>{loop}</pid_gains>"
    return f"<virtualJoint><name>{joint}</name><scale_factor>{factor}</scale_factor>{block}</virtualJoint>"


def finger(*joints: str, motor: str = "j_motor") -> str:
    content = f"<actuatedJoint>{motor}</actuatedJoint>{''.join(joints)}"
    return f'<plugin filename="libgazebo_underactuated_finger.so" name="finger">{content}</plugin>'


def positions(sim: simkit.Simulation, *joints: str) -> list[float]:
    return [float(sim.joint(f"m::j_{joint}").position) for joint in joints]


def turned(sim: simkit.Simulation, angle: float, seconds: float = 0.5) -> None:
    sim.joint("m::j_motor").set_position(angle)
    sim.run(seconds)


ROTORS = (rotor("motor"), rotor("a"), rotor("b", limit=LIMITED))


def test_each_joint_follows_the_motor_over_its_factor_within_its_limits() -> None:
    with load(*ROTORS, finger(virtual("j_a", -2.5), virtual("j_b", 3.0))) as sim:
        for angle, wanted in ((1.2, 0.4), (2.4, 0.5), (-0.6, 0.0), (0.3, 0.1)):
            turned(sim, angle)
            assert positions(sim, "a", "b") == pytest.approx([-angle / 2.5, wanted], abs=1e-4)


def test_a_motor_position_is_used_beyond_the_deadband() -> None:
    with load(*ROTORS, finger(virtual("j_a", 2.0))) as sim:
        turned(sim, 0.019)
        assert positions(sim, "a") == [0.0]
        turned(sim, 0.021)
        assert positions(sim, "a") == pytest.approx([0.0105], abs=1e-5)
        turned(sim, 0.04)  # 0.019 away from the one that counts
        assert positions(sim, "a") == pytest.approx([0.0105], abs=1e-5)


def test_a_finger_keeps_its_effort_limit() -> None:
    """Far from the target the acceleration is effort/inertia; the servo's armature adds to the inertia."""
    weak = rotor("a", limit="<limit><effort>0.01</effort></limit>")
    with load(rotor("motor"), weak, finger(virtual("j_a", 0.5))) as sim:
        turned(sim, 1.0, 1.0)
        assert positions(sim, "a")[0] == pytest.approx(0.5 * 0.01 / INERTIA, rel=0.03)


def test_a_proportional_gain_acts_like_a_spring() -> None:
    """θ = target · (1 − cos √(p/I) t)."""
    gains = {"p": 5.0, "i": 0.0, "d": 0.0, "i_max": 1.0, "i_min": -1.0}
    with load(*ROTORS, finger(virtual("j_a", 2.0, gains))) as sim:
        for seconds in (0.2, 0.3, 0.5):
            turned(sim, 0.8, seconds)
            expected = 0.4 * (1.0 - math.cos(math.sqrt(5.0 / INERTIA) * sim.time))
            assert positions(sim, "a")[0] == pytest.approx(expected, abs=0.01)


@pytest.mark.parametrize("step", [0.001, 0.002])
def test_the_integral_keeps_its_bound_for_every_step_length(step: float) -> None:
    """The effort is i · e · t up to i_max, so θ = ½ (i_max/I) (t − t₁)² plus the angle of the ramp to t₁."""
    gains = {"p": 0.0, "i": 10.0, "d": 0.0, "i_max": 0.02, "i_min": -0.02}
    with load(*ROTORS, finger(virtual("j_a", 0.01, gains)), step=step) as sim:  # 100 rad away: e hardly changes
        turned(sim, 1.0, 1.0)
        assert positions(sim, "a")[0] == pytest.approx(0.5 * 0.02 / INERTIA, rel=0.01)


def test_a_derivative_gain_damps_the_joint() -> None:
    """θ = ω I/d (1 − exp(−t d/I))."""
    gains = {"p": 0.0, "i": 0.0, "d": 2.0, "i_max": 1.0, "i_min": -1.0}
    with load(*ROTORS, finger(virtual("j_a", 2.0, gains))) as sim:
        sim.joint("m::j_a").set_velocity(1.5)
        for seconds in (0.1, 0.9):
            sim.run(seconds)
            ratio = INERTIA / 2.0
            assert positions(sim, "a")[0] == pytest.approx(1.5 * ratio * (1.0 - math.exp(-sim.time / ratio)), rel=0.01)


def test_an_incomplete_set_of_gains_is_reported_and_a_servo_is_used() -> None:
    with load(*ROTORS, finger(virtual("j_a", 2.0, {"p": 1.0, "i": 0.0, "d": 0.0}))) as sim:
        (message,) = (d.message for d in sim.diagnostics if d.code == "SK-PLUGIN-047")
        assert "<i_max>, <i_min>" in message
        turned(sim, 0.4)
        assert positions(sim, "a") == pytest.approx([0.2], abs=1e-4)


def test_all_errors_are_reported_in_one_pass() -> None:
    with pytest.raises(LoadError) as raised:
        load(*ROTORS, finger(virtual("j_c", 0), virtual("j_a", "much"), "<virtualJoint/>", motor="j_moter"))
    messages = " ".join(d.message for d in raised.value.diagnostics if d.severity == "error")
    for found in ("'j_moter'", "'j_c'", "<scale_factor> 0", "much</scale_factor>", "needs <name>"):
        assert found in messages
    with pytest.raises(LoadError, match="virtualJoint"):
        load(*ROTORS, finger())


def test_a_snapshot_and_a_spawn_do_not_change_the_motion() -> None:
    loop = {"p": 5.0, "i": 2.0, "d": 0.1, "i_max": 1.0, "i_min": -1.0}
    with load(*ROTORS, finger(virtual("j_a", 2.0), virtual("j_b", 3.0, loop))) as sim:
        turned(sim, 0.8, 0.1)
        snapshot = sim.snapshot()
        sim.run(0.3)
        ends = positions(sim, "motor", "a", "b")
        sim.restore(snapshot)
        sim.run(0.3)
        assert positions(sim, "motor", "a", "b") == ends
        sim.restore(snapshot)
        sim.spawn("<sdf version='1.9'><model name='x'><static>true</static><link name='l'/></model></sdf>")
        sim.run(0.3)
        assert positions(sim, "motor", "a", "b") == pytest.approx(ends, abs=1e-9)
        sim.reset()
        sim.run(0.1)
        assert positions(sim, "a") == [0.0]
