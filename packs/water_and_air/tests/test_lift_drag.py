"""Wings: lift, drag and moment at every angle, against the formulas of Gazebo's plugin."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit

RHO = 1.2041
MASS = 2.0


def world(parameters: str = "", plugin: str = "gz", wind: str = "0 0 0", com: str = "0 0 0", more: str = "") -> str:
    names = {
        "gz": 'filename="gz-sim-lift-drag-system" name="gz::sim::systems::LiftDrag"',
        "classic": 'filename="libLiftDragPlugin.so" name="wing"',
    }
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
    <wind><linear_velocity>{wind}</linear_velocity></wind>
    <model name="plane"><link name="wing"><inertial><pose>{com} 0 0 0</pose><mass>{MASS}</mass>
    <inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>{more}
    <plugin {names[plugin]}><link_name>wing</link_name>{parameters}</plugin></model></world></sdf>"""


WING = "<cla>4</cla><cda>0.3</cda><cma>0.2</cma><alpha_stall>0.3</alpha_stall><cla_stall>-2</cla_stall>" + (
    "<cda_stall>1.5</cda_stall><cma_stall>-0.5</cma_stall><area>0.4</area><a0>0.05</a0>"
)


def line(slope: float, beyond: float, alpha: float) -> float:
    stall = math.copysign(0.3, alpha)
    return slope * alpha if abs(alpha) <= 0.3 else slope * stall + beyond * (alpha - stall)


def line_of_one_sign(slope: float, beyond: float, alpha: float) -> float:
    """Return the same line, which keeps its sign beyond the stall."""
    found = line(slope, beyond, alpha)
    return found if abs(alpha) <= 0.3 or found * alpha > 0 else 0.0


def wrench(sim: simkit.Simulation, com: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Return force and torque of the next step, from their effect on a resting body with its mass at x = com."""
    link = sim.link("plane::wing")
    before = link.linear_velocity.copy(), link.angular_velocity.copy()
    sim.step()
    step = sim.timestep
    turning = (link.angular_velocity - before[1]) / step
    return MASS * ((link.linear_velocity - before[0]) / step + np.cross(turning, (com, 0, 0))), turning


@pytest.mark.parametrize("degrees", [-80, -45, -20, -18, -10, -3, -2.865, 0, 1, 10, 14, 15, 30, 60, 89])
def test_forces_at_every_angle_of_attack_with_stall(degrees: float) -> None:
    """A resting body in a wind has the same stream as a moving body."""
    angle, speed = math.radians(degrees), 12.0
    # it moves through the air ahead and, for a positive angle, downwards
    through = speed * np.array((math.cos(angle), 0, -math.sin(angle)))
    sim = simkit.load(world(WING, wind=" ".join(map(str, -through))))
    force, torque = wrench(sim)
    alpha, pressed = angle + 0.05, 0.5 * RHO * speed**2 * 0.4
    if alpha > math.pi / 2:
        alpha -= math.pi
    drag_way = -through / speed
    lift_way = np.array((math.sin(angle), 0, math.cos(angle)))
    lift, drag = line_of_one_sign(4, -2, alpha) * pressed, abs(line(0.3, 1.5, alpha)) * pressed
    assert force == pytest.approx(lift * lift_way + drag * drag_way, rel=1e-9, abs=1e-9 * pressed)
    # span is forward × upward = −y
    assert torque == pytest.approx((0, -line_of_one_sign(0.2, -0.5, alpha) * pressed, 0), rel=1e-9, abs=1e-9 * pressed)


@pytest.mark.parametrize("sweep", [0.0, 0.3, 1.0])
def test_a_stream_along_the_span_has_no_effect_and_sweep_reduces_the_forces(sweep: float) -> None:
    speed, angle = 10.0, 0.1
    ahead = speed * math.cos(sweep)
    through = np.array((ahead * math.cos(angle), speed * math.sin(sweep), -ahead * math.sin(angle)))
    sim = simkit.load(world("<cla>4</cla><cda>0</cda>", wind=" ".join(map(str, -through))))
    force, _ = wrench(sim)
    lift = 4 * angle * math.cos(sweep) ** 2 * 0.5 * RHO * ahead**2
    assert force == pytest.approx(lift * np.array((math.sin(angle), 0, math.cos(angle))), rel=1e-9, abs=1e-9)


def test_the_forces_depend_on_the_motion_of_the_centre_of_pressure() -> None:
    sim = simkit.load(world("<cda>0</cda><a0>0.1</a0><cla>3</cla><cp>0 2 0</cp>"))
    sim.link("plane::wing").set_velocity((5, 0, 0), (0, 0, -1.5))  # the tip at y = 2 is 3 m/s faster
    _, torque = wrench(sim)
    lift = 3 * 0.1 * 0.5 * RHO * 8.0**2
    # up at y = 2: a torque about +x
    assert torque[0] == pytest.approx(2 * lift, rel=1e-9)


def test_a_stream_from_behind_does_nothing_unless_the_wing_is_reversible() -> None:
    for is_reversible in (False, True):
        sim = simkit.load(world(f"<cla>4</cla><reversible>{int(is_reversible)}</reversible>", wind="10 0 1"))
        force, _ = wrench(sim)
        assert bool(np.any(force)) == is_reversible
    slow = simkit.load(world("<cla>4</cla>", wind="-0.009 0 0.001"))
    assert not np.any(wrench(slow)[0])


def test_a_body_of_revolution_lifts_towards_its_tilt() -> None:
    parameters = "<cla>2</cla><cda>0</cda><radial_symmetry>true</radial_symmetry>"
    for turn in (0.0, 1.0, 2.5):
        angle, speed = 0.2, 10.0
        across = np.array((0, math.sin(turn), math.cos(turn)))
        through = speed * (math.cos(angle) * np.array((1, 0, 0)) - math.sin(angle) * across)
        sim = simkit.load(world(parameters, wind=" ".join(map(str, -through))))
        force, _ = wrench(sim)
        way = math.sin(angle) * np.array((1, 0, 0)) + math.cos(angle) * across
        assert force == pytest.approx(2 * angle * 0.5 * RHO * 100 * way, rel=1e-8, abs=1e-6)
    straight = simkit.load(world("<cla>2</cla><cda>0.5</cda><radial_symmetry>1</radial_symmetry>", wind="-10 0 0"))
    assert wrench(straight)[0] == pytest.approx((0, 0, 0), abs=1e-9)


def test_a_control_joint_adds_to_lift_and_moment() -> None:
    flap = """<link name="flap"><inertial><mass>1e-6</mass>
    <inertia><ixx>1e-9</ixx><iyy>1e-9</iyy><izz>1e-9</izz></inertia></inertial></link>
    <joint name="hinge" type="revolute"><parent>wing</parent><child>flap</child>
    <axis><xyz>0 1 0</xyz></axis></joint>"""
    parameters = "<cla>0</cla><cda>0</cda><control_joint_name>hinge</control_joint_name><cm_delta>0.7</cm_delta>"
    parameters += "<control_joint_rad_to_cl>-3</control_joint_rad_to_cl>"
    sim = simkit.load(world(parameters, wind="-10 0 0", more=flap))
    sim.joint("plane::hinge").set_position(0.2)
    force, torque = wrench(sim)
    assert force[2] == pytest.approx(-3 * 0.2 * 0.5 * RHO * 100, rel=1e-4)
    assert torque[1] == pytest.approx(-0.7 * 0.2 * 0.5 * RHO * 100, rel=1e-4)


def test_classic_acts_at_the_centre_of_pressure_from_the_centre_of_mass_and_makes_no_moment() -> None:
    parameters = "<cla>4</cla><cda>0</cda><cma>1</cma><cp>-0.5 0 0</cp>"
    sim = simkit.load(world(parameters, "classic", wind="-10 0 1", com="0.3 0 0"))
    assert [d.code for d in sim.diagnostics if d.severity == "warning"] == ["SK-PLUGIN-111"]
    force, torque = wrench(sim, 0.3)
    assert torque[1] == pytest.approx(0.5 * force[2], rel=1e-9)
    assert force[2] > 0  # the wind comes from below; pushed up behind its centre, the nose goes down
    # in Gazebo the centre of pressure is relative to the link's origin
    sim = simkit.load(world("<cla>4</cla><cda>0</cda><cp>-0.5 0 0</cp>", wind="-10 0 1", com="0.3 0 0"))
    force, torque = wrench(sim, 0.3)
    assert torque[1] == pytest.approx(0.8 * force[2], rel=1e-9)


@pytest.mark.slow
def test_it_glides_at_the_ratio_of_lift_to_drag() -> None:
    """A level wing descends at the ratio of drag to lift once both balance its weight."""
    text = world("<area>1</area><a0>0.1</a0><cla>5</cla><cda>0.5</cda>").replace("<gravity>0 0 0", "<gravity>0 0 -9.8")
    sim = simkit.load(text)
    sim.link("plane::wing").set_velocity((8, 0, 0))
    sim.run(60)
    vx, _, vz = sim.link("plane::wing").linear_velocity
    # both coefficients are lines through zero: their ratio is 10 at any angle
    assert -vz / vx == pytest.approx(0.1, rel=0.02)
    alpha = 0.1 + math.atan2(-vz, vx)
    assert 5 * alpha * 0.5 * RHO * vx**2 == pytest.approx(MASS * 9.8, rel=0.03)


@pytest.mark.parametrize(
    "bad",
    [
        "<forward>0 0 0</forward>",
        "<forward>0 0 1</forward>",
        "<area>-1</area>",
        "<air_density>nan</air_density>",
        "<control_joint_name>rudder</control_joint_name>",
        "<alpha_stall>-0.1</alpha_stall>",
    ],
)
def test_invalid_values_are_errors(bad: str) -> None:
    with pytest.raises(simkit.LoadError):
        simkit.load(world(bad))


def test_a_missing_or_unknown_link_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="did you mean 'wing'"):
        simkit.load(world().replace("<link_name>wing", "<link_name>wimg"))
    with pytest.raises(simkit.LoadError, match="SK-PARAM-001"):
        simkit.load(world().replace("<link_name>wing</link_name>", ""))


def test_runs_after_a_restore_and_with_a_reader_have_the_same_bits() -> None:
    def flight(reads: bool) -> list[float]:
        sim = simkit.load(world(WING, wind="-8 1 1"))
        sim.step(50)
        snapshot = sim.snapshot()
        for _ in range(2):
            sim.restore(snapshot)
            for _ in range(100):
                sim.step()
                if reads:
                    _ = sim.link("plane::wing").linear_acceleration
        return [*sim.link("plane::wing").pose.position, *sim.link("plane::wing").pose.quaternion]

    assert flight(False) == flight(True)
