"""A disc that rolls on its rim gains no energy; an object on a turntable stays where it is."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest

import simkit
from simkit.linear_algebra import dot
from simkit.runtime.contact.contact_point_motion import ContactPointMotion

GRAVITY, MASS = 9.8, 1.0

PLANE, BLOCK = "<plane/>", "<box><size>5 5 1</size></box>"


def world(step: float, shape: str, inertia: tuple[float, float, float], ground: str = PLANE) -> str:
    """Return a world with one free body "m" of 1 kg on a ground whose surface is at the height 0."""
    height = 0.0 if ground == PLANE else -0.5
    friction = "<surface><friction><ode><mu>0.8</mu><mu2>0.8</mu2></ode></friction></surface>"
    return f"""<sdf version="1.9"><world name="w">
    <physics name="p" type="p"><max_step_size>{step}</max_step_size></physics>
    <model name="ground"><static>true</static><pose>0 0 {height} 0 0 0</pose><link name="l"><collision name="c">
    <geometry>{ground}</geometry>{friction}</collision></link></model>
    <model name="m"><pose>0 0 1 0 0 0</pose><link name="l"><inertial><mass>{MASS}</mass><inertia><ixx>{inertia[0]}</ixx>
    <iyy>{inertia[1]}</iyy><izz>{inertia[2]}</izz></inertia></inertial><collision name="c"><geometry>{shape}</geometry>
    {friction}</collision></link></model></world></sdf>"""


class Disc:
    """Disc that rolls on its rim around a centre at rest, the steady motion of Euler's disc.

    The torque of the normal force m g equals the change of the angular momentum, which precesses about the vertical.
    """

    def __init__(
        self, step: float, tilt: float, radius: float = 0.1, thickness: float = 0.01, ground: str = PLANE
    ) -> None:
        across, along = MASS * (3 * radius**2 + thickness**2) / 12, MASS * radius**2 / 2
        self.inertia = np.array([across, across, along])
        shape = f"<cylinder><radius>{radius}</radius><length>{thickness}</length></cylinder>"
        self.sim = simkit.load(world(step, shape, (across, across, along), ground))
        axis = np.array([0.0, -math.sin(tilt), math.cos(tilt)])
        rim = -radius * np.array([0.0, math.cos(tilt), math.sin(tilt)]) - thickness / 2 * axis
        upwards, spin = np.array([0.0, 0.0, 1.0]), rim / np.linalg.norm(rim)
        # the angular velocity is s times `spin`, the precession s times `ratio`
        turn = np.cross(upwards, axis)
        ratio = dot(np.cross(spin, axis), turn) / dot(turn, turn)
        change = np.cross(upwards, across * spin + (along - across) * axis * dot(axis, spin))
        speed = math.sqrt(dot(np.cross(rim, MASS * GRAVITY * upwards), change) / dot(change, change) / ratio)
        self.sim.model("m").set_pose(simkit.Pose.from_rpy(0.0, 0.0, -rim[2] - 5e-6, tilt, 0.0, 0.0))
        self.sim.model("m").set_velocity((0, 0, 0), tuple(speed * spin))

    def energy(self) -> float:
        """Return kinetic and potential energy [J]."""
        data = self.sim.mj_data
        spin = (self.inertia * data.qvel[3:] ** 2).sum()
        return float(MASS * (data.qvel[:3] ** 2).sum() / 2 + spin / 2 + MASS * GRAVITY * data.qpos[2])

    def tilt(self) -> float:
        """Return the angle between the disc and the ground [rad]."""
        axes = np.empty(9)
        mujoco.mju_quat2Mat(axes, self.sim.mj_data.qpos[3:])
        return math.acos(axes[8])

    def run(self, seconds: float) -> tuple[float, float]:
        """Run; return the last and the largest energy as a fraction of the first one, minus 1."""
        start, highest = self.energy(), 0.0
        for _ in range(20):
            self.sim.run(seconds / 20)
            highest = max(highest, self.energy() / start - 1.0)
        return self.energy() / start - 1.0, highest


@pytest.mark.parametrize("tilt", [0.2, 0.35, 0.8])
@pytest.mark.parametrize("step", [0.004, 0.001, 0.0005])
def test_eulers_disc_gains_no_energy_and_keeps_its_tilt(step: float, tilt: float) -> None:
    disc = Disc(step, tilt)
    end, highest = disc.run(1.0)
    assert highest < 1e-5
    assert -8.0 * step < end  # the engine damps a spin by an amount in proportion to the step
    assert disc.tilt() == pytest.approx(tilt, abs=0.002 + 2.0 * step)
    assert np.abs(disc.sim.mj_data.qpos[:2]).max() < 0.005  # the centre stays


def test_the_loss_of_eulers_disc_is_proportional_to_the_step() -> None:
    losses = [-Disc(step, 0.35).run(0.8)[0] for step in (0.002, 0.001, 0.0005)]
    assert losses[0] / losses[1] == pytest.approx(2.0, rel=0.1)
    assert losses[1] / losses[2] == pytest.approx(2.0, rel=0.1)


@pytest.mark.parametrize("step", [0.002, 0.0005])
def test_eulers_disc_gains_no_energy_on_a_block(step: float) -> None:
    disc = Disc(step, 0.35, ground=BLOCK)
    end, highest = disc.run(1.0)
    assert highest < 1e-5
    assert end > -8.0 * step
    assert disc.tilt() == pytest.approx(0.35, abs=0.01)


@pytest.mark.parametrize("step", [0.001, 0.0005])
def test_a_coin_gains_no_energy(step: float) -> None:
    disc = Disc(step, 0.5, radius=0.012, thickness=0.002)
    end, highest = disc.run(0.5)
    assert highest < 1e-5
    assert end > -60.0 * step  # 83 rad/s, and the loss grows with the square of the angular velocity


def test_the_rows_of_a_contact_are_those_of_the_engine_after_the_solution() -> None:
    disc = Disc(0.001, 0.35)
    disc.sim.run(0.1)
    data, model = disc.sim.engine.physics.fresh(), disc.sim.mj_model
    assert ContactPointMotion(model).find(data) == [0]
    plain = mujoco.MjData(model)
    size = mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_INTEGRATION)
    state = np.empty(size)
    mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_INTEGRATION)
    mujoco.mj_setState(model, plain, state, mujoco.mjtState.mjSTATE_INTEGRATION)
    mujoco.mj_forward(model, plain)
    assert data.efc_aref.tolist() == plain.efc_aref.tolist()
    assert data.efc_vel.tolist() == plain.efc_vel.tolist()
    assert data.qacc.tolist() != plain.qacc.tolist()


def test_a_disc_has_the_same_bits_in_one_run_in_parts_and_after_a_restore() -> None:
    whole, parts = Disc(0.001, 0.35).sim, Disc(0.001, 0.35).sim
    whole.run(0.3)
    parts.run(0.1003)
    snapshot = parts.snapshot()
    parts.run(0.05)
    parts.restore(snapshot)
    while parts.time < 0.2995:
        parts.step()
        parts.model("m").link("l").linear_acceleration  # noqa: B018 - a reader
    assert parts.time == whole.time
    assert parts.mj_data.qpos.tolist() == whole.mj_data.qpos.tolist()
    assert parts.mj_data.qvel.tolist() == whole.mj_data.qvel.tolist()


def test_balls_and_slow_bodies_keep_the_contacts_of_the_engine() -> None:
    ball = simkit.load(world(0.001, "<sphere><radius>0.1</radius></sphere>", (0.004, 0.004, 0.004)))
    ball.model("m").set_pose(simkit.Pose((0, 0, 0.1)))
    ball.model("m").set_velocity((1, 0, 0), (0, 10, 0))
    box = simkit.load(world(0.001, "<box><size>0.2 0.2 0.2</size></box>", (0.007, 0.007, 0.007)))
    box.model("m").set_pose(simkit.Pose((0, 0, 0.1)))
    box.model("m").set_velocity((0, 0, 0), (0, 0, 0.3))
    for sim in (ball, box):
        sim.run(0.01)
        assert sim.contacts("m")
        assert ContactPointMotion(sim.mj_model).find(sim.engine.physics.fresh()) == []


@pytest.mark.parametrize("step", [0.002, 0.001, 0.0005])
def test_a_box_on_a_turntable_stays_where_it_is(step: float) -> None:
    table = """<model name="table"><link name="l"><pose>0 0 0.475 0 0 0</pose><inertial><mass>1000</mass><inertia>
    <ixx>1000</ixx><iyy>1000</iyy><izz>1000</izz></inertia></inertial><collision name="c"><geometry><cylinder>
    <radius>0.6</radius><length>0.05</length></cylinder></geometry></collision></link><joint name="j" type="revolute">
    <parent>world</parent><child>l</child><axis><xyz>0 0 1</xyz></axis></joint></model></world>"""
    text = world(step, "<box><size>0.1 0.1 0.1</size></box>", (0.0017, 0.0017, 0.0017)).replace("</world>", table)
    sim, radius, spin = simkit.load(text), 0.34, 2.0
    sim.model("m").set_pose(simkit.Pose((radius, 0, 0.55)))
    sim.run(0.1)
    before = sim.model("m").pose.position
    sim.joint("table::j").set_velocity(spin)
    sim.model("m").set_velocity((-spin * before[1], spin * before[0], 0), (0, 0, spin))
    sim.run(2.0)
    angle, (x, y, _) = sim.joint("table::j").position, sim.model("m").pose.position
    now = math.cos(angle) * x + math.sin(angle) * y, math.cos(angle) * y - math.sin(angle) * x
    assert math.dist(now, before[:2]) < 3e-5  # without the centripetal term: 5 mm


@pytest.mark.parametrize(("count", "found"), [(8, 1), (9, 0)])
def test_a_heap_has_no_term_and_bodies_that_sleep_make_no_heap(count: int, found: int) -> None:
    extra = "".join(
        f'<model name="m{i}"><pose>{i + 2} 0 0.1 0 0 0</pose><link name="l"><collision name="c"><geometry><box><size>'
        "0.2 0.2 0.2</size></box></geometry></collision></link></model>"
        for i in range(12)
    )
    shape = "<cylinder><radius>0.1</radius><length>0.01</length></cylinder>"
    sim = simkit.load(world(0.001, shape, (0.0025, 0.0025, 0.005)).replace("</world>", extra + "</world>"))
    data = mujoco.MjData(sim.mj_model)
    data.qpos[2], data.qpos[3:7] = 0.039, (math.cos(0.2), math.sin(0.2), 0.0, 0.0)
    for place in range(count):
        data.qvel[6 * place + 5] = 1e-3
    data.qvel[3:6] = (0.0, 1.0, 0.5)
    mujoco.mj_forward(sim.mj_model, data)
    assert len(ContactPointMotion(sim.mj_model).find(data)) == found
