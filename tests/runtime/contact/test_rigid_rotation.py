"""Bodies move without forces as in the theory of rigid bodies."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from simkit.linear_algebra import dot, norm
from simkit.runtime.contact.rigid_rotation import RigidRotation

SYMMETRIC, UNEQUAL, BALL = (1.0, 1.0, 2.0), (1.0, 1.5, 2.2), (2.0, 2.0, 2.0)
START = np.array([0.1, 0.2, 0.3, 0.5, 0.5, -0.5, 0.5])
VELOCITY = np.array([1.0, 2.0, 3.0, 10.0, 5.0, 50.0])


def body(moments: tuple[float, float, float], centre: str = "0 0 0", step: float = 1e-5) -> mujoco.MjModel:
    """Return a model of one free body without gravity, whose principal axes are not those of its frame."""
    x, y, z = moments
    return mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep="{step}" gravity="0 0 0" integrator="RK4"/>
    <worldbody><body><freejoint/><inertial pos="{centre}" quat="1 0.3 0.2 0.1" mass="1" diaginertia="{x} {y} {z}"/>
    </body></worldbody></mujoco>""")


def moved(model: mujoco.MjModel, steps: int, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates and velocities after some seconds without forces, in equal steps."""
    rotation, position, velocity = RigidRotation(model, 0), START.tolist(), VELOCITY.tolist()
    for _ in range(steps):
        position, velocity = rotation.moved(position, velocity, seconds / steps)
    return np.array(position), np.array(velocity)


@pytest.mark.parametrize("centre", ["0 0 0", "0.1 0.2 0.3"])
@pytest.mark.parametrize("moments", [SYMMETRIC, UNEQUAL, BALL])
def test_the_acceleration_without_forces_is_that_of_the_engine(
    moments: tuple[float, float, float], centre: str
) -> None:
    model = body(moments, centre)
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = START, VELOCITY
    mujoco.mj_forward(model, data)
    found = RigidRotation(model, 0).gyroscopic_acceleration(START[3:].tolist(), VELOCITY[3:].tolist())
    assert found == pytest.approx(data.qacc.tolist(), abs=1e-9)


@pytest.mark.parametrize("centre", ["0 0 0", "0.1 0.2 0.3"])
@pytest.mark.parametrize(("moments", "accuracy"), [(SYMMETRIC, 1e-12), (BALL, 1e-12), (UNEQUAL, 2.5e-3)])
def test_one_step_is_exact_for_two_equal_moments_and_otherwise_of_second_order(
    moments: tuple[float, float, float], accuracy: float, centre: str
) -> None:
    model = body(moments, centre)
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = START, VELOCITY
    mujoco.mj_step(model, data, 400)
    exact = np.concatenate([data.qpos, data.qvel])
    errors = [np.abs(np.concatenate(moved(model, steps, 0.004)) - exact).max() for steps in (1, 2, 4)]
    assert errors[0] < accuracy
    if moments == UNEQUAL:
        assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.02)
        assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.02)


@pytest.mark.parametrize("moments", [SYMMETRIC, UNEQUAL])
def test_the_angular_momentum_is_constant_and_the_energy_stays_near_its_first_value(
    moments: tuple[float, float, float],
) -> None:
    model = body(moments)
    rotation, position, velocity = RigidRotation(model, 0), START.tolist(), VELOCITY.tolist()
    axes = np.empty(9)
    momenta, energies = [], []
    for _ in range(2000):
        mujoco.mju_mulQuat(turn := np.empty(4), np.array(position[3:]), model.body_iquat[1])
        mujoco.mju_quat2Mat(axes, turn)
        mujoco.mju_rotVecQuat(local := np.empty(3), np.array(velocity[3:]), model.body_iquat[1] * (1, -1, -1, -1))
        momenta.append((axes.reshape(3, 3) * (moments * local)).sum(axis=1))
        energies.append(dot(moments * local, local) / 2)
        position, velocity = rotation.moved(position, velocity, 0.004)
    assert max(norm(momentum - momenta[0]) for momentum in momenta) < 1e-10 * norm(momenta[0])
    assert np.ptp(energies) < 1e-3 * energies[0]


def test_a_wheel_that_rolls_straight_ahead_has_no_gyroscopic_effect() -> None:
    model = mujoco.MjModel.from_xml_string("""<mujoco><worldbody><body><freejoint/><inertial pos="0 0 0" mass="1"
    diaginertia="1 1 2"/></body></worldbody></mujoco>""")
    rotation = RigidRotation(model, 0)
    assert list(rotation.gyroscopic_rate((0.0, 0.0, 30.0), (0.0, 0.0, 5.0))) == [0.0, 0.0, 0.0]
    assert norm(rotation.gyroscopic_rate((0.0, 0.0, 30.0), (0.0, 5.0, 0.0))) == pytest.approx(150.0)


def test_a_step_resolves_two_radians_of_nutation() -> None:
    rotation = RigidRotation(body(SYMMETRIC), 0)
    assert rotation.is_resolved((19.0, 0.0, 0.0), 0.05)
    assert not rotation.is_resolved((41.0, 41.0, 41.0), 0.05)
