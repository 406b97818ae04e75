"""Drag and added mass with positive coefficients, limits of the effort, and the centre of mass."""

from __future__ import annotations

import math

import pytest

import simkit

MASS, INERTIA, STEP = 10.0, (1.0, 2.0, 3.0), 0.002
NONE = "".join(
    f"<{name}>0</{name}>"
    for name in ("xDotU", "yDotV", "zDotW", "kDotP", "mDotQ", "nDotR", "xU", "yV", "zW", "kP", "mQ", "nR")
)
PLUGIN = 'filename="libSimpleHydrodynamics.so" name="vrx::SimpleHydrodynamics"'


def world(coefficients: str, com: str = "0 0 0") -> str:
    xx, yy, zz = INERTIA
    return f"""<sdf version="1.9"><world name="sea"><gravity>0 0 0</gravity>
      <physics name="p" type="ode"><max_step_size>{STEP}</max_step_size></physics><model name="boat"><link name="hull">
      <inertial><pose>{com} 0 0 0</pose><mass>{MASS}</mass>
      <inertia><ixx>{xx}</ixx><iyy>{yy}</iyy><izz>{zz}</izz></inertia></inertial></link>
      <plugin {PLUGIN}><link_name>hull</link_name>{coefficients}</plugin></model></world></sdf>"""


def without(names: str) -> str:
    """Return zero for all coefficients except those that the text gives."""
    rest = NONE
    for name in ("xDotU", "yDotV", "nDotR", "xU", "yV", "nR", "zW"):
        if f"<{name}>" in names:
            rest = rest.replace(f"<{name}>0</{name}>", "")
    return rest + names


@pytest.mark.parametrize("added", [2.0, 80.0])
def test_a_boat_accelerates_with_its_mass_and_the_added_mass(added: float) -> None:
    with simkit.load(world(without(f"<xDotU>{added}</xDotU>"))) as sim:
        hull = sim.link("boat::hull")
        speeds = []
        for _ in range(2):
            for _ in range(100):
                hull.apply_wrench((5.0, 0, 0), (0, 0, 0))
                sim.step()
            speeds.append(float(hull.linear_velocity[0]))
        assert (speeds[1] - speeds[0]) / (100 * STEP) == pytest.approx(5.0 / (MASS + added), rel=1e-6)


def test_linear_and_quadratic_drag_slow_the_boat() -> None:
    with simkit.load(world(without("<xU>5</xU><yV>0</yV><yVV>5</yVV><nR>6</nR>"))) as sim:
        sim.model("boat").set_velocity((1.0, 0, 0), (0, 0, 0))
        sim.run(2.0)
        assert sim.link("boat::hull").linear_velocity[0] == pytest.approx(math.exp(-1.0), rel=2e-3)
        sim.model("boat").set_velocity((0, -1.0, 0), (0, 0, 0))
        sim.run(2.0)
        assert sim.link("boat::hull").linear_velocity[1] == pytest.approx(-1 / (1 + 5 * 2 / MASS), rel=2e-3)
        sim.model("boat").set_velocity((0, 0, 0), (0, 0, 0.5))
        sim.run(0.5)
        assert sim.link("boat::hull").angular_velocity[2] == pytest.approx(0.5 * math.exp(-1.0), rel=3e-3)


def test_the_defaults_are_those_of_vrx() -> None:
    with simkit.load(world("")) as sim:
        sim.model("boat").set_velocity((1.0, 0, 0), (0, 0, 0))
        sim.run(0.5)  # 20 N·s/m on 10 kg and 5 kg of water
        assert sim.link("boat::hull").linear_velocity[0] == pytest.approx(math.exp(-20 * 0.5 / 15), rel=0.01)


def test_the_effort_is_limited_and_acts_at_the_centre_of_mass() -> None:
    with simkit.load(world(without("<yV>500</yV><max_effort>30</max_effort>"), com="0.5 0 0")) as sim:
        sim.model("boat").set_velocity((0, 1.0, 0), (0, 0, 0))
        sim.step()
        hull = sim.link("boat::hull")
        assert (hull.linear_velocity[1] - 1.0) / STEP == pytest.approx(-30 / MASS, rel=1e-6)
        assert abs(hull.angular_velocity[2]) < 1e-9


def test_a_negative_drag_is_reported_with_its_place() -> None:
    with simkit.load(world("\n<xUU>-5</xUU><nR>0</nR>")) as sim:
        (found,) = [found for found in sim.diagnostics if found.severity == "warning"]
    assert (found.code, found.line) == ("SK-PLUGIN-118", 6)
    assert "<xUU>5</xUU>" in found.hint


def test_a_negative_added_mass_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        simkit.load(world("<xDotU>-5</xDotU>"))
