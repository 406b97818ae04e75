"""Long chains without damping keep their energy; tops and tumbling bodies rotate as in theory."""

from __future__ import annotations

import copy
import math

import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import simkit
from simkit.runtime.engine.free_motion import FreeMotionIntegrator
from simkit.runtime.engine.physics_step import VELOCITY

MASS = 0.1  # [kg] of a link

BOX = "<geometry><box><size>{size}</size></box></geometry>"


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
    mujoco.mj_forward(model, data)
    if motion is None:
        mujoco.mj_implicit(model, data)
    else:
        motion.integrate(model, data, mujoco.mj_implicit)


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


def test_the_engine_integrates_a_single_pendulum() -> None:
    assert FreeMotionIntegrator.of(simkit.load(chain(1, 0.1)).mj_model) is None
    assert FreeMotionIntegrator.of(simkit.load(chain(2, 0.1)).mj_model) is not None


def energy(sim: simkit.Simulation) -> float:
    """Return the energy of a simulation [J]; its state stays."""
    model, data = sim.mj_model, copy.copy(sim.mj_data)
    mujoco.mj_fwdPosition(model, data)
    mujoco.mj_energyPos(model, data)
    mujoco.mj_energyVel(model, data)
    return float(data.energy.sum())


def energy_drift(world: str, depth: float, seconds: float = 2.0) -> float:
    """Return the largest change of a world's energy at any time, as a fraction of the energy `depth` [J]."""
    sim = simkit.load(world)
    start, worst = energy(sim), 0.0
    for _ in range(20):
        sim.run(seconds / 20)
        worst = max(worst, abs(energy(sim) - start))
    return worst / depth


@pytest.mark.parametrize("size", [0.001, 0.004])
@pytest.mark.parametrize("links", [2, 3, 5, 7])
def test_a_small_mechanism_without_damping_keeps_its_energy(links: int, size: float) -> None:
    depth = links * MASS * 9.8 * links * 0.25  # [J] between hanging and horizontal
    assert energy_drift(chain(links, 0.5, size), depth) < 1e-4


@pytest.mark.parametrize("size", [0.001, 0.004])
def test_a_universal_joint_without_damping_keeps_its_energy(size: float) -> None:
    joint = """<joint name="j" type="universal"><parent>world</parent><child>l</child><axis><xyz>1 0 0</xyz></axis>
    <axis2><xyz>0 1 0</xyz></axis2></joint>"""
    world = spinner((0.002, 0.003, 0.004), -0.3, 1.2, joint, 9.8, size)
    assert energy_drift(world, 0.3 * 9.8) < 1e-5


@pytest.mark.parametrize("size", [0.001, 0.004])
def test_a_mechanism_on_a_base_that_rests_on_the_ground_keeps_its_energy(size: float) -> None:
    base = f"""<link name="base"><pose>0 0 -0.5 0 0 0</pose><inertial><mass>10</mass><inertia><ixx>1</ixx><iyy>1</iyy>
    <izz>1</izz></inertia></inertial><collision name="c">{BOX.format(size="1 1 0.1")}</collision></link>"""
    ground = """<model name="g"><static>true</static><pose>0 0 19.45 0 0 0</pose><link name="l"><collision name="c">
    <geometry><plane/></geometry></collision></link></model>"""
    world = chain(2, 0.5, size, more=ground).replace("<parent>world<", "<parent>base<")
    world = world.replace('<link name="l0">', base + '<link name="l0">')
    assert energy_drift(world, 2 * MASS * 9.8 * 0.5) < 5e-3


@pytest.mark.parametrize("stiffness", [0.1, 2.0])
def test_springs_in_a_mechanism_keep_its_energy(stiffness: float) -> None:
    spring = f"<dynamics><spring_stiffness>{stiffness}</spring_stiffness></dynamics>"
    assert energy_drift(chain(3, 0.3, 0.002, spring), 3 * MASS * 9.8 * 0.45) < 1e-4


def test_a_limit_stops_a_mechanism_and_gives_it_no_energy() -> None:
    limit = "<limit><lower>-0.5</lower><upper>0.5</upper></limit>"
    sim = simkit.load(chain(3, 0.3, axis=limit))
    start = highest = energy(sim)
    for _ in range(200):
        sim.run(0.01)
        highest = max(highest, energy(sim))
        assert np.abs(sim.mj_data.qpos).max() < 0.54
    assert highest < start + 1e-3 * MASS * 9.8
    assert energy(sim) < start - 0.5 * MASS * 9.8 * 0.3  # the limits have braked it


def test_the_engine_integrates_a_mechanism_to_which_a_force_is_applied() -> None:
    """Buoyancy and springs of plugins are such forces; with an explicit method they would gain energy."""
    sim, plain = simkit.load(chain(2, 0.3)), simkit.load(chain(2, 0.3))
    motion = FreeMotionIntegrator.of(sim.mj_model)
    for data in (sim.mj_data, plain.mj_data):
        data.qfrc_applied[1] = 0.01
    for _ in range(100):
        step(sim.mj_model, sim.mj_data, motion)
        step(plain.mj_model, plain.mj_data, None)
    assert sim.mj_data.qpos.tolist() == plain.mj_data.qpos.tolist()


def test_a_mechanism_has_the_same_bits_in_one_run_in_parts_and_after_a_restore() -> None:
    whole, parts = simkit.load(chain(3, 0.3)), simkit.load(chain(3, 0.3))
    whole.run(0.5)
    parts.run(0.2003)
    snapshot = parts.snapshot()
    parts.run(0.1)
    parts.restore(snapshot)
    while parts.time < 0.4995:
        parts.step()
        assert parts.link("chain::l2").linear_acceleration is not None  # a reader completes the forward pass
    parts.run(0.5 - parts.time)
    assert parts.time == whole.time
    assert parts.mj_data.qpos.tolist() == whole.mj_data.qpos.tolist()
    assert parts.mj_data.qvel.tolist() == whole.mj_data.qvel.tolist()


# ------------------------------------------------------------------ spinning


def spinner(
    inertia: tuple[float, float, float], height: float, tilt: float, joint: str, gravity: float, step: float = 0.001
) -> str:
    """Return a world with one link of 1 kg, whose centre of mass is `height` [m] above its origin."""
    x, y, z = inertia
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 {-gravity}</gravity>
    <physics name="p" type="p"><max_step_size>{step}</max_step_size></physics><model name="m">
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


@pytest.mark.parametrize("spin", [10.0, 40.0])
@pytest.mark.parametrize("size", [0.001, 0.004])
def test_a_tumbling_body_with_collisions_keeps_its_energy_and_angular_momentum(size: float, spin: float) -> None:
    inertia = np.array([0.01, 0.02, 0.028])
    solid = f"<collision name='c'>{BOX.format(size='0.1 0.2 0.3')}</collision></link>"
    wall = f"""<model name="wall"><static>true</static><pose>0 0 -5 0 0 0</pose><link name="l"><collision name="c">
    {BOX.format(size="1 1 1")}</collision></link></model></world>"""
    world = spinner((0.01, 0.02, 0.028), 0.0, 0.0, "", 0.0, size)
    sim = simkit.load(world.replace("</link>", solid).replace("</world>", wall))
    sim.model("m").set_velocity((0, 0, 0), (0.1, spin, 0.1))
    start, momentum = energy(sim), inertia * (0.1, spin, 0.1)
    for _ in range(10):
        sim.run(0.2)
        assert energy(sim) == pytest.approx(start, rel=1e-5)
        axes = np.empty(9)
        mujoco.mju_quat2Mat(axes, sim.mj_data.qpos[3:7])
        now = axes.reshape(3, 3) @ (inertia * sim.mj_data.qvel[3:6])
        assert np.linalg.norm(now - momentum) < 1e-5 * np.linalg.norm(momentum)


def test_the_engine_integrates_slow_bodies_and_bodies_that_spin_steadily() -> None:
    world = spinner((0.01, 0.02, 0.028), 0.0, 0.0, "", 9.8)
    sim, plain = simkit.load(world), simkit.load(world)
    motion = FreeMotionIntegrator.of(sim.mj_model)
    for each in (sim, plain):
        each.mj_data.qvel[3:] = (0.5, 1.0, 0.9)
    for _ in range(100):
        step(sim.mj_model, sim.mj_data, motion)
        step(plain.mj_model, plain.mj_data, None)
    assert sim.mj_data.qpos.tolist() == plain.mj_data.qpos.tolist()
    assert FreeMotionIntegrator.of(simkit.load(spinner((0.01, 0.01, 0.01), 0.0, 0.0, "", 9.8)).mj_model) is None


@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast"])
def test_a_top_of_an_mjcf_file_precesses_with_each_integrator_of_first_order(integrator: str) -> None:
    """With Euler's method, the default of MJCF, the engine's top diverges after 0.6 s."""
    tilt, precession, spin = 0.6, 1.0, 200.0
    across, along, weight = 3e-4, 5e-5, 5e-5 * spin + (5e-5 - 3e-4) * math.cos(tilt)  # m g l for 1 rad/s
    text = f"""<mujoco><option timestep="0.002" gravity="0 0 -10" integrator="{integrator}"/><worldbody>
    <body name="top" pos="0 0 1" euler="0 {math.degrees(tilt)} 0"><joint type="ball"/><inertial mass="0.1"
    pos="0 0 {weight}" diaginertia="{across - 0.1 * weight**2} {across - 0.1 * weight**2} {along}"/></body>
    </worldbody></mujoco>"""
    sim = simkit.load(text)
    axis = np.array([-math.sin(tilt), 0.0, math.cos(tilt)])  # the vertical, in the frame of the top
    sim.mj_data.qvel[:] = precession * axis + (0.0, 0.0, spin)
    sim.engine.physics.changed(VELOCITY)
    sim.run(0.5)
    mujoco.mj_kinematics(sim.mj_model, sim.mj_data)
    x, y, z = sim.mj_data.xmat[1].reshape(3, 3)[:, 2]
    assert z == pytest.approx(math.cos(tilt), abs=1e-4)
    assert math.atan2(y, x) == pytest.approx(0.5 * precession, rel=1e-3)
