"""Airship: hull forces against their formulas, added mass, drag in both directions, drift in the wind."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit
from simkit import Params
from simkit.extend import Inertial
from simkit.loaders.sdf.inertial import read_fluid_added_mass
from simkit.writers import sdf_elements

MASS, INERTIA, RHO, STEP = 5.0, (3.0, 6.0, 6.0), 1.225, 0.002
COEFFICIENTS = {"moment_inviscid_coeff": -1.2, "moment_viscous_coeff": 0.5, "force_inviscid_coeff": -0.3}
COEFFICIENTS |= {"force_viscous_coeff": 0.8, "eps_v": 1.5, "axial_drag_coeff": 0.06}
PLUGIN = 'filename="gz-sim-lighter_than_air_dynamics-system" name="gz::sim::systems::LighterThanAirDynamics"'


def world(added: str = "", wind: str = "0 0 0", **changes: float) -> str:
    xx, yy, zz = INERTIA
    values = "".join(f"<{name}>{value}</{name}>" for name, value in (COEFFICIENTS | changes).items())
    return f"""<sdf version="1.11"><world name="sky"><gravity>0 0 0</gravity>
      <physics name="p" type="ode"><max_step_size>{STEP}</max_step_size></physics>
      <wind><linear_velocity>{wind}</linear_velocity></wind><model name="airship"><link name="hull"><inertial>
      <mass>{MASS}</mass><inertia><ixx>{xx}</ixx><iyy>{yy}</iyy><izz>{zz}</izz></inertia>{added}</inertial></link>
      <plugin {PLUGIN}><link_name>hull</link_name>{values}</plugin></model></world></sdf>"""


def wrench(sim: simkit.Simulation, linear: tuple[float, ...], angular: tuple[float, ...]) -> np.ndarray:
    sim.model("airship").set_velocity(linear, angular)
    sim.step()
    hull, spin = sim.link("airship::hull"), np.array(angular)
    force = (hull.linear_velocity - linear) * MASS / STEP
    return np.concatenate((force, (hull.angular_velocity - spin) / STEP * INERTIA + np.cross(spin, spin * INERTIA)))


@pytest.mark.parametrize("linear", [(4.0, 0.0, 0.0), (3.0, 1.0, -0.5), (-2.0, 0.3, 0.8)])
@pytest.mark.parametrize("angular", [(0.0, 0.0, 0.0), (0.1, -0.2, 0.15)])
def test_the_forces_of_the_hull(linear: tuple[float, ...], angular: tuple[float, ...]) -> None:
    c = COEFFICIENTS
    end = np.array(linear) + np.cross(angular, (-c["eps_v"], 0, 0))
    across = math.hypot(end[1], end[2])
    angle, pressed = math.atan2(across, end[0]), 0.5 * RHO * float(end @ end)
    size = {
        kind: pressed
        * (-c[f"{kind}_inviscid_coeff"] * math.sin(2 * angle) + c[f"{kind}_viscous_coeff"] * math.sin(angle) ** 2)
        for kind in ("force", "moment")
    }
    y, z = (end[1] / across, end[2] / across) if across else (0.0, 0.0)
    slope = math.cos(math.atan2(linear[2], linear[0])) ** 2
    drag = -math.copysign(c["axial_drag_coeff"] * 0.5 * RHO * float(np.dot(linear, linear)) * slope, linear[0])
    expected = [drag, -size["force"] * y, -size["force"] * z, 0, size["moment"] * z, -size["moment"] * y]
    with simkit.load(world()) as sim:
        np.testing.assert_allclose(wrench(sim, linear, angular), expected, atol=2e-3)


def test_the_hull_accelerates_with_the_added_mass_of_its_link() -> None:
    added = "<fluid_added_mass><xx>1</xx><yy>20</yy><zz>20</zz><qq>4</qq></fluid_added_mass>"
    none = dict.fromkeys(COEFFICIENTS, 0.0)
    for axis, mass in enumerate((1.0, 20.0, 20.0)):
        with simkit.load(world(added, **none)) as sim:
            hull, speeds = sim.link("airship::hull"), []
            for _ in range(2):
                for _ in range(100):
                    hull.apply_wrench(tuple(2.0 * (axis == i) for i in range(3)), (0, 0, 0))
                    sim.step()
                speeds.append(float(hull.linear_velocity[axis]))
            assert (speeds[1] - speeds[0]) / (100 * STEP) == pytest.approx(2.0 / (MASS + mass), rel=1e-6)


def test_the_airship_drifts_with_the_wind() -> None:
    text = world("<fluid_added_mass><xx>2</xx></fluid_added_mass>", "3 0 0", axial_drag_coeff=4.0)
    with simkit.load(text) as sim:
        sim.run(5.0)
        gone = 0.5 * RHO * 4.0 * 3.0 * 5.0 / (MASS + 2.0)  # 3 - v = 3 / (1 + gone)
        assert sim.link("airship::hull").linear_velocity[0] == pytest.approx(3 - 3 / (1 + gone), rel=5e-3)


def test_the_writer_keeps_the_added_mass() -> None:
    values = tuple(float(i) for i in range(21))
    written = sdf_elements.inertial(Inertial(), values)
    assert written is not None
    link = Params("link", children=(written,))
    assert read_fluid_added_mass(link) == values


def test_every_coefficient_is_required() -> None:
    for name in COEFFICIENTS:
        with pytest.raises(simkit.LoadError, match="SK-PARAM-001"):
            simkit.load(world().replace(f"<{name}>{COEFFICIENTS[name]}</{name}>", ""))
