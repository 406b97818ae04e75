"""Velocity limits of joints that no plugin drives: impulses at the joints, which add no momentum and no energy."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

import simkit
from simkit.runtime.engine.velocity_limits import _impulses, limit_velocities

LINK = """<link name="{name}"><inertial><origin xyz="0.1 0.05 0"/><mass value="{mass}"/>
<inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
JOINT = """<joint name="{name}" type="continuous"><origin xyz="0.3 0 0"/><parent link="{parent}"/>
<child link="{child}"/><axis xyz="{axis}"/><limit effort="10" velocity="{limit}"/></joint>"""


def chain() -> str:
    """Return a robot of three links that is not fixed, whose joints have limits of 2 and 3 rad/s."""
    links = "".join(LINK.format(name=name, mass=mass) for name, mass in (("a", 2), ("b", 1), ("c", 0.5)))
    joints = JOINT.format(name="ab", parent="a", child="b", axis="0 0 1", limit=2)
    joints += JOINT.format(name="bc", parent="b", child="c", axis="0 1 0", limit=3)
    return f"<robot name='chain'>{links}{joints}</robot>"


def momentum_and_energy(sim: simkit.Simulation) -> tuple[list[float], float]:
    """Return linear and angular momentum [kg m/s, kg m²/s] and the kinetic energy [J]."""
    model, data = sim.mj_model, mujoco.MjData(sim.mj_model)
    data.qpos[:], data.qvel[:] = sim.mj_data.qpos, sim.mj_data.qvel
    mujoco.mj_forward(model, data)
    mujoco.mj_subtreeVel(model, data)
    mujoco.mj_energyVel(model, data)
    return [*data.subtree_linvel[0] * model.body_subtreemass[0], *data.subtree_angmom[0]], float(data.energy[1])


@pytest.mark.parametrize("velocities", [(6.0, 0.0), (6.0, -8.0), (2.5, 9.0), (-4.0, 3.5)])
def test_a_limit_keeps_the_momentum_of_a_free_robot_and_adds_no_energy(velocities: tuple[float, float]) -> None:
    with simkit.load(chain()) as sim:
        joints = [sim.joint(f"chain::{name}") for name in ("ab", "bc")]
        joints[1].set_position(0.7)
        for joint, velocity in zip(joints, velocities, strict=True):
            joint.set_velocity(velocity)
        before, energy = momentum_and_energy(sim)
        dofs = np.array([joint.mj_dofs[0] for joint in joints])
        limit_velocities(sim.engine.physics, dofs, np.array([2.0, 3.0]))
        after, left = momentum_and_energy(sim)
        found = [abs(float(joint.velocity)) for joint in joints]
    assert after == pytest.approx(before, abs=1e-12)
    assert left < energy
    assert found[0] <= 2.0 + 1e-9 and found[1] <= 3.0 + 1e-9


def test_a_joint_that_another_joint_slows_gets_no_impulse_of_its_own() -> None:
    # the first impulse changes the second velocity by -2, from 3.5 to 1.5, which is within its limit of 3
    response = np.array([[1.0, 0.5], [0.5, 1.0]])
    chosen, bounds, impulses = _impulses(np.array([6.0, 3.5]), np.array([2.0, 3.0]), response)
    assert (chosen.tolist(), bounds.tolist(), impulses.tolist()) == ([0], [2.0], [-4.0])


def test_a_joint_beyond_its_limit_after_the_impulse_of_another_joint_gets_one_too() -> None:
    response = np.array([[1.0, -0.5], [-0.5, 1.0]])
    chosen, bounds, impulses = _impulses(np.array([6.0, 2.0]), np.array([2.0, 3.0]), response)
    assert (chosen.tolist(), bounds.tolist()) == ([0, 1], [2.0, 3.0])
    assert np.array([6.0, 2.0]) + response @ impulses == pytest.approx([2.0, 3.0], abs=1e-12)


def test_a_free_robot_without_gravity_gains_no_energy_while_its_joints_are_limited() -> None:
    with simkit.load("<sdf version='1.9'><world name='w'><gravity>0 0 0</gravity></world></sdf>") as sim:
        model = sim.spawn(chain())
        sim.joint("chain::ab").set_velocity(6.0)
        model.set_velocity((0, 0, 0), (1.0, 2.0, 3.0))
        energies = []
        for _ in range(30):
            sim.run(0.1)
            energies.append(momentum_and_energy(sim)[1])
            assert abs(float(sim.joint("chain::ab").velocity)) < 2.5
    assert energies[-1] <= energies[0] * 1.001
