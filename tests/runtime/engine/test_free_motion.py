"""Long chains without damping keep their energy; tops and tumbling bodies rotate as in theory."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import simkit
from simkit.runtime.engine.free_motion import FreeMotionIntegrator

MASS = 0.1  # [kg] of a link


def chain(links: int, length: float, step: float = 0.001, axis: str = "", more: str = "") -> str:
    """Return a world with a chain that starts horizontally, with its first joint 20 m above the origin."""
    inertia = MASS * length**2 / 12
    text = ""
    for i in range(links):
        parent = f"l{i - 1}" if i else "world"
        text += f"""<link name="l{i}"><pose>{(i + 0.5) * length} 0 0 0 0 0</pose><inertial><mass>{MASS}</mass><inertia>
        <ixx>{inertia}</ixx><iyy>{inertia}</iyy><izz>{inertia}</izz></inertia></inertial></link>
        <joint name="j{i}" type="revolute"><parent>{parent}</parent><child>l{i}</child>
        <pose>{-length / 2} 0 0 0 0 0</pose><axis><xyz>0 1 0</xyz>{axis}</axis></joint>"""
    return f"""<sdf version="1.9"><world name="w"><physics name="p" type="p"><max_step_size>{step}</max_step_size>
    </physics><model name="chain"><pose>0 0 20 0 0 0</pose>{text}</model>{more}</world></sdf>"""


def step(model: mujoco.MjModel, data: mujoco.MjData, motion: FreeMotionIntegrator | None) -> None:
    """Make one step of the engine, corrected by the integrator of free motion."""
    if motion is not None:
        motion.prepare(data)
    mujoco.mj_step(model, data)
    if motion is not None:
        motion.correct(data)


@pytest.mark.slow
@pytest.mark.parametrize("length", [0.1, 0.5])
def test_a_falling_chain_of_fifty_links_keeps_its_energy(length: float) -> None:
    sim = simkit.load(chain(50, length))
    model, data = sim.mj_model, sim.mj_data
    motion = FreeMotionIntegrator.of(model)
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    mujoco.mj_forward(model, data)
    start = float(data.energy.sum())
    depth = 50 * MASS * 9.8 * 25 * length  # [J] between hanging and horizontal
    worst = 0.0
    for _ in range(10_000):
        step(model, data, motion)
        worst = max(worst, abs(float(data.energy.sum()) - start))
    assert not data.warning.number.any()
    assert worst < 0.01 * depth
    assert np.abs(data.qvel).max() < 1e4


def test_a_robot_beside_a_chain_keeps_its_bits() -> None:
    ball = """<model name="ball"><pose>5 0 0.5 0 0 0</pose><link name="l"><collision name="c"><geometry><sphere><radius>
    0.1</radius></sphere></geometry></collision></link></model><model name="ground"><static>true</static><link name="l">
    <collision name="c"><geometry><plane><normal>0 0 1</normal><size>9 9</size></plane></geometry></collision></link>
    </model>"""
    sim, plain = simkit.load(chain(10, 0.1, more=ball)), simkit.load(chain(10, 0.1, more=ball))
    motion = FreeMotionIntegrator.of(sim.mj_model)
    for _ in range(800):
        step(sim.mj_model, sim.mj_data, motion)
        step(plain.mj_model, plain.mj_data, None)
    assert sim.mj_data.qpos[10:].tolist() == plain.mj_data.qpos[10:].tolist()
    assert sim.mj_data.qpos[:10].tolist() != plain.mj_data.qpos[:10].tolist()
    options, own = sim.mj_model.opt, plain.mj_model.opt
    for name in ("timestep", "integrator", "disableflags", "enableflags"):
        assert getattr(options, name) == getattr(own, name), name


@pytest.mark.parametrize("kind", ["damping", "friction"])
def test_joints_with_damping_or_friction_do_not_form_a_free_chain(kind: str) -> None:
    axis = f"<dynamics><{kind}>0.01</{kind}></dynamics>"
    assert FreeMotionIntegrator.of(simkit.load(chain(20, 0.1, axis=axis)).mj_model) is None


def test_the_engine_integrates_a_chain_as_short_as_an_arm() -> None:
    assert FreeMotionIntegrator.of(simkit.load(chain(7, 0.1)).mj_model) is None
    assert FreeMotionIntegrator.of(simkit.load(chain(8, 0.1)).mj_model) is not None


# ------------------------------------------------------------------ spinning


def spinner(inertia: tuple[float, float, float], height: float, tilt: float, joint: str, gravity: float) -> str:
    """Return a world with one link of 1 kg, whose centre of mass is `height` [m] above its origin."""
    x, y, z = inertia
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 {-gravity}</gravity><model name="m">
    <pose>0 0 0 0 {tilt} 0</pose><link name="l"><inertial><pose>0 0 {height} 0 0 0</pose><mass>1</mass><inertia>
    <ixx>{x}</ixx><iyy>{y}</iyy><izz>{z}</izz></inertia></inertial></link>{joint}</model></world></sdf>"""


@pytest.mark.parametrize("spin", [200.0, 300.0, 400.0])
def test_a_top_precesses_at_the_theoretical_speed(spin: float) -> None:
    """Steady precession P of a heavy top: I cos(tilt) P² − I₃ spin P + m g h = 0."""
    tilt, height, across, along, gravity = 0.5, 0.1, 0.002, 0.002, 9.8
    joint = '<joint name="j" type="ball"><parent>world</parent><child>l</child></joint>'
    sim = simkit.load(spinner((across, across, along), height, tilt, joint, gravity))
    model, data, motion = sim.mj_model, sim.mj_data, FreeMotionIntegrator.of(sim.mj_model)
    linear = along * spin
    quadratic = (across + height**2 - along) * math.cos(tilt)
    # `spin` is that of the body frame, so the gyroscopic term is I₃ (spin + P cos(tilt))
    total = math.sqrt(linear**2 - 4.0 * quadratic * gravity * height)
    precession = (linear - total) / (2.0 * quadratic)
    data.qvel[:3] = (-precession * math.sin(tilt), 0.0, spin + precession * math.cos(tilt))
    turned, before = 0.0, 0.0
    for _ in range(3000):
        step(model, data, motion)
        mujoco.mj_kinematics(model, data)
        axis = data.xmat[1].reshape(3, 3)[:, 2]
        assert math.acos(axis[2]) == pytest.approx(tilt, abs=1e-3)
        heading = math.atan2(axis[1], axis[0])
        turned += math.remainder(heading - before, 2.0 * math.pi)
        before = heading
    assert turned / 3.0 == pytest.approx(precession, rel=1e-3)


def test_a_tennis_racket_flips_at_the_times_of_eulers_equations() -> None:
    inertia, start = np.array([0.01, 0.02, 0.028]), np.array([0.01, 10.0, 0.01])
    sim = simkit.load(spinner((0.01, 0.02, 0.028), 0.0, 0.0, "", 0.0))
    model, data, motion = sim.mj_model, sim.mj_data, FreeMotionIntegrator.of(sim.mj_model)
    data.qvel[3:] = start

    def euler(_time: float, w: np.ndarray) -> np.ndarray:
        return -np.cross(w, inertia * w) / inertia

    times = 0.001 * np.arange(1, 10_001)
    wanted = solve_ivp(euler, (0.0, 10.0), start, t_eval=times, rtol=1e-11, atol=1e-12).y.T
    found = np.empty_like(wanted)
    for one in found:
        step(model, data, motion)
        one[:] = data.qvel[3:]
    assert np.abs(found - wanted).max() < 0.01  # the body flips three times, between 10 and -10 rad/s
    energy, momentum = (inertia * found**2).sum(axis=1), np.linalg.norm(inertia * found, axis=1)
    assert np.ptp(energy) < 1e-5 * energy[0]
    assert np.ptp(momentum) < 1e-5 * momentum[0]


def test_the_engine_integrates_slow_bodies_and_bodies_with_collisions() -> None:
    world = spinner((0.01, 0.02, 0.028), 0.0, 0.0, "", 9.8)
    sim, plain = simkit.load(world), simkit.load(world)
    motion = FreeMotionIntegrator.of(sim.mj_model)
    for each in (sim, plain):
        each.mj_data.qvel[3:] = (1.0, 2.0, 3.0)
    for _ in range(100):
        step(sim.mj_model, sim.mj_data, motion)
        step(plain.mj_model, plain.mj_data, None)
    assert sim.mj_data.qpos.tolist() == plain.mj_data.qpos.tolist()
    solid = world.replace(
        "</link>", '<collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>'
    )
    assert FreeMotionIntegrator.of(simkit.load(solid).mj_model) is None
