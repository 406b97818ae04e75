"""Added mass, Coriolis forces, damping and currents, against Fossen's equations."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit

MASS, INERTIA = 10.0, (1.0, 2.0, 3.0)
STEP = 0.002


def world(coefficients: str, com: str = "0 0 0") -> str:
    xx, yy, zz = INERTIA
    return f"""<sdf version="1.9"><world name="sea"><gravity>0 0 0</gravity>
      <physics name="p" type="ode"><max_step_size>{STEP}</max_step_size></physics><model name="sub"><link name="hull">
      <inertial><pose>{com} 0 0 0</pose><mass>{MASS}</mass>
      <inertia><ixx>{xx}</ixx><iyy>{yy}</iyy><izz>{zz}</izz></inertia>
      </inertial></link><plugin filename="gz-sim-hydrodynamics-system" name="gz::sim::systems::Hydrodynamics">
      <link_name>hull</link_name>{coefficients}</plugin></model></world></sdf>"""


def push(
    sim: simkit.Simulation, time: float, force: tuple[float, ...] = (0, 0, 0), torque: tuple[float, ...] = (0, 0, 0)
) -> None:
    hull = sim.link("sub::hull")
    for _ in range(round(time / sim.timestep)):
        hull.apply_wrench(force, torque)
        sim.step()


@pytest.mark.parametrize("added", [2.0, 10.0, 80.0])
@pytest.mark.parametrize(("axis", "name"), [(0, "xDotU"), (1, "yDotV"), (2, "zDotW")])
def test_a_body_accelerates_with_its_mass_and_the_added_mass(axis: int, name: str, added: float) -> None:
    with simkit.load(world(f"<{name}>-{added}</{name}>")) as sim:
        force = tuple(5.0 * (i == axis) for i in range(3))
        push(sim, 0.1, force)
        before = sim.link("sub::hull").linear_velocity[axis]
        push(sim, 1.0, force)
        gained = sim.link("sub::hull").linear_velocity[axis] - before
        assert gained == pytest.approx(5.0 / (MASS + added), rel=1e-6)


@pytest.mark.parametrize(("axis", "name"), [(0, "kDotP"), (1, "mDotQ"), (2, "nDotR")])
def test_a_body_turns_with_its_inertia_and_the_added_inertia(axis: int, name: str) -> None:
    with simkit.load(world(f"<{name}>-4</{name}>")) as sim:
        torque = tuple(0.5 * (i == axis) for i in range(3))
        push(sim, 0.1, torque=torque)
        before = sim.link("sub::hull").angular_velocity[axis]
        push(sim, 1.0, torque=torque)
        gained = sim.link("sub::hull").angular_velocity[axis] - before
        assert gained == pytest.approx(0.5 / (INERTIA[axis] + 4), rel=1e-6)


def test_linear_damping_slows_a_body_exponentially() -> None:
    with simkit.load(world("<xU>-5</xU>")) as sim:
        sim.link("sub::hull").set_velocity((1, 0, 0))
        sim.run(2.0)
        assert sim.link("sub::hull").linear_velocity[0] == pytest.approx(math.exp(-5 * 2 / MASS), rel=1e-3)


def test_quadratic_damping_slows_a_body_in_both_directions() -> None:
    for speed in (1.0, -1.0):
        with simkit.load(world("<xUabsU>-5</xUabsU>")) as sim:
            sim.link("sub::hull").set_velocity((speed, 0, 0))
            sim.run(2.0)
            assert sim.link("sub::hull").linear_velocity[0] == pytest.approx(speed / (1 + 5 * 2 / MASS), rel=1e-3)


def test_a_term_of_two_axes_couples_them() -> None:
    with simkit.load(world("<nV>-2</nV><yR>0.5</yR><zUW>3</zUW>")) as sim:
        sim.link("sub::hull").set_velocity((0.5, 0.4, 0.2), (0, 0, 0.3))
        sim.step()
        linear, angular = sim.link("sub::hull").linear_velocity, sim.link("sub::hull").angular_velocity
        assert (linear[1] - 0.4) / STEP == pytest.approx(0.5 * 0.3 / MASS, rel=1e-6)
        assert (linear[2] - 0.2) / STEP == pytest.approx(3 * 0.5 * 0.2 / MASS, rel=1e-6)
        assert (angular[2] - 0.3) / STEP == pytest.approx(-2 * 0.4 / INERTIA[2], rel=1e-3)


def test_a_drifting_body_turns_across_the_stream() -> None:
    # Munk's moment: N = -(m22 - m11) u v
    with simkit.load(world("<xDotU>-2</xDotU><yDotV>-8</yDotV>")) as sim:
        sim.link("sub::hull").set_velocity((1.0, 0.5, 0))
        sim.step()
        assert sim.link("sub::hull").angular_velocity[2] / STEP == pytest.approx(-(8 - 2) * 0.5 / INERTIA[2], rel=1e-6)


def test_coriolis_forces_do_no_work_and_can_be_disabled() -> None:
    names = "<xDotU>-2</xDotU><yDotV>-8</yDotV><zDotW>-5</zDotW><kDotP>-1</kDotP><mDotQ>-2</mDotQ><nDotR>-4</nDotR>"
    turning = (0.3, -0.2, 0.5)

    def wrench(more: str) -> np.ndarray:
        with simkit.load(world(names + "<disable_added_mass>true</disable_added_mass>" + more)) as sim:
            hull = sim.link("sub::hull")
            hull.set_velocity((1.0, 0.5, -0.4), turning)
            sim.step()
            forces = (hull.linear_velocity - (1.0, 0.5, -0.4)) * MASS / STEP
            return np.concatenate((forces, (hull.angular_velocity - turning) * INERTIA / STEP))

    free = wrench("<disable_coriolis>true</disable_coriolis>")  # gyroscopic terms of the rigid body
    water = wrench("") - free
    assert np.abs(free[:3]).max() < 1e-9
    assert np.linalg.norm(water) > 1
    assert water @ np.array([1.0, 0.5, -0.4, *turning]) == pytest.approx(0, abs=0.01)


@pytest.mark.slow
def test_a_current_takes_a_body_along() -> None:
    with simkit.load(world("<xU>-50</xU><yV>-50</yV><default_current>0.4 0 0</default_current>")) as sim:
        sim.run(5.0)
        assert sim.link("sub::hull").linear_velocity == pytest.approx([0.4, 0, 0], abs=1e-6)
        sim.publish("/ocean_current", {"x": 0.0, "y": -0.3, "z": 0.0})
        sim.run(5.0)
        assert sim.link("sub::hull").linear_velocity == pytest.approx([0, -0.3, 0], abs=1e-6)
    with simkit.load(world("<yV>-50</yV><namespace>sub</namespace>")) as sim:
        sim.publish("/model/sub/ocean_current", {"x": 0.0, "y": 0.2, "z": 0.0})
        sim.run(5.0)
        assert sim.link("sub::hull").linear_velocity == pytest.approx([0, 0.2, 0], abs=1e-6)


def test_forces_act_at_the_origin_of_the_link() -> None:
    with simkit.load(world("<yV>-1</yV>", com="0.5 0 0")) as sim:
        sim.link("sub::hull").set_velocity((0, 1, 0))
        sim.step()
        assert sim.link("sub::hull").angular_velocity[2] / STEP == pytest.approx(-0.5 * -1 / INERTIA[2], rel=1e-3)


def test_a_drag_without_abs_is_read_as_before_gazebo_8_with_a_warning() -> None:
    for speed in (1.0, -1.0):
        with simkit.load(world("<xUU>-5</xUU>")) as sim:
            assert [found.code for found in sim.diagnostics if found.severity == "warning"] == ["SK-PLUGIN-117"]
            sim.link("sub::hull").set_velocity((speed, 0, 0))
            sim.run(2.0)
            assert sim.link("sub::hull").linear_velocity[0] == pytest.approx(speed / 2, rel=1e-3)


@pytest.mark.parametrize("name", ["xDotU", "nDotR", "yV", "zWabsW"])
def test_a_coefficient_with_the_wrong_sign_is_reported_with_its_place(name: str) -> None:
    with simkit.load(world(f"<zDotW>-2</zDotW><yR>3</yR><nVabsR>2</nVabsR>\n<{name}>5</{name}>")) as sim:
        (found,) = [found for found in sim.diagnostics if found.code == "SK-PLUGIN-118"]
    assert found.severity == "warning"
    assert f"<{name}>5</{name}> is positive" in found.message
    assert f"<{name}>-5</{name}>" in found.hint
    assert found.line == 7  # of the text


def test_an_unknown_link_is_an_error() -> None:
    with pytest.raises(simkit.InputError, match="SK-PLUGIN-003"):
        simkit.load(world("").replace("<link_name>hull", "<link_name>bow"))
