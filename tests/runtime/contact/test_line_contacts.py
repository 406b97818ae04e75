"""Cylinders and capsules that touch along a line: normals at edges, piles at rest, rolling over an edge."""

from __future__ import annotations

import math
import random

import mujoco
import numpy as np
import pytest

import simkit
from simkit.runtime.contact.line_contacts import LineContacts
from simkit.runtime.contact.line_geometry import LineContact, Rod, rod_contacts
from simkit.runtime.contact.speculative_contacts import SPECULATIVE_FLAG

RADIUS, LENGTH, G = 0.05, 0.4, 9.8


def friction(mu: float) -> str:
    return f"<surface><friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction></surface>"


def log(name: str, x: float, z: float, yaw: float = 0.0, shape: str = "cylinder", mu: float = 0.6, y: float = 0) -> str:
    """Return a log of 2 kg whose axis points along y."""
    across, along = 2.0 * (3 * RADIUS**2 + LENGTH**2) / 12, RADIUS**2
    pose = f"{x} {y} {z} {math.pi / 2} 0 {yaw}"
    return f"""<model name="{name}"><pose>{pose}</pose><link name="l"><inertial><mass>2</mass><inertia>
      <ixx>{across}</ixx><iyy>{across}</iyy><izz>{along}</izz></inertia></inertial><collision name="c">
      <geometry><{shape}><radius>{RADIUS}</radius><length>{LENGTH}</length></{shape}></geometry>{friction(mu)}
      </collision></link></model>"""


def box(name: str, pose: str, size: str, mu: float = 0.6) -> str:
    return f"""<model name="{name}"><static>true</static><pose>{pose} 0 0 0</pose><link name="l"><collision name="c">
      <geometry><box><size>{size}</size></box></geometry>{friction(mu)}</collision></link></model>"""


GROUND = f"""<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
  {friction(0.6)}</collision></link></model>"""


def world(*models: str, step: float = 0.001) -> str:
    return f"""<sdf version="1.9"><world name="w"><physics type="ode"><max_step_size>{step}</max_step_size></physics>
      {"".join(models)}</world></sdf>"""


def pyramid(rows: int, shape: str = "cylinder", seed: int | None = None) -> str:
    """Return a pyramid of logs between two stakes; with a seed, the logs are askew."""
    draw, models, wide = random.Random(seed), [GROUND], 2 * RADIUS + 1e-4
    for row in range(rows):
        for i in range(rows - row):
            yaw, y = (0.0, 0.0) if seed is None else (draw.uniform(-0.003, 0.003), draw.uniform(-0.01, 0.01))
            x, z = (i - (rows - row - 1) / 2) * wide, RADIUS + row * wide * math.sqrt(0.75)
            models.append(log(f"log_{row}_{i}", x, z, yaw, shape, y=y))
    side = rows * wide / 2 + 0.02 + 1e-4
    stakes = [box(f"stake_{x > 0}", f"{x} 0 0.1", "0.04 0.6 0.2") for x in (-side, side)]
    return world(*models, *stakes)


def speeds(sim: simkit.Simulation) -> tuple[float, float]:
    """Return the largest speed [m/s] and spin [rad/s] of the bodies."""
    velocities = np.abs(sim.mj_data.qvel.reshape(-1, 6))
    return float(velocities[:, :3].max()), float(velocities[:, 3:].max())


def has_contacts_of_the_engine(sim: simkit.Simulation) -> bool:
    """Compare the contacts with those of MuJoCo alone."""
    data, alone = sim.engine.physics.fresh(), mujoco.MjData(sim.mj_model)
    alone.qpos[:], alone.qvel[:] = data.qpos, data.qvel
    mujoco.mj_forward(sim.mj_model, alone)
    return np.array_equal(data.contact.pos, alone.contact.pos) and np.array_equal(
        data.contact.frame, alone.contact.frame
    )


def rolled_over_an_edge(speed: float, mu: float) -> tuple[float, float]:
    """Return the horizontal speed and the spin of a solid cylinder that has rolled off a table.

    It rolls about the edge without slip: r θ'' = 2/3 g sin θ, friction m g sin θ / 3. Once the friction exceeds μ N,
    with N = m (g cos θ - r θ'²), it slips. It leaves at N = 0.
    """
    angle, rate, spin, dt, slips = 0.0, speed / RADIUS, speed / RADIUS, 1e-5, False
    while (normal := G * math.cos(angle) - RADIUS * rate * rate) > 0.0:
        held = G * math.sin(angle) / 3
        slips = slips or held > mu * normal
        push = mu * normal if slips else held
        rate += (G * math.sin(angle) - push) / RADIUS * dt
        spin += 2 * push / RADIUS * dt
        angle += rate * dt
    return RADIUS * rate * math.cos(angle), spin


@pytest.mark.parametrize("yaw", [0.0, 0.002, 0.02])
@pytest.mark.parametrize("speed", [0.05, 0.2])
def test_a_log_that_rolls_off_a_table_leaves_with_the_speed_and_the_spin_of_theory(speed: float, yaw: float) -> None:
    table = box("table", "-1 0 0.5", "2 1 1", 1.0)
    with simkit.load(world(table, log("log", -0.003 - 0.2 * yaw, 1 + RADIUS, yaw, mu=1.0))) as sim:
        sim.model("log").set_velocity((speed, 0, 0), (0, speed / RADIUS, 0))
        while sim.mj_data.qpos[2] > 0.9 and sim.time < 2:
            sim.step(4)
        velocity = sim.mj_data.qvel
        forwards, spin = rolled_over_an_edge(speed, 1.0)
        assert velocity[0] == pytest.approx(forwards, rel=0.03)
        assert np.abs(velocity[3:]).max() == pytest.approx(spin, rel=0.035)  # a run at 4 ms differs by 4 % of it
        assert abs(velocity[1]) < 0.02 * forwards + 2 * yaw * forwards


@pytest.mark.parametrize("yaw", [0.0, 0.001, 0.02, 0.3, math.pi / 2])
@pytest.mark.parametrize("depth", [1e-4, 1e-3])
@pytest.mark.parametrize("degrees", [5, 20, 45, 70])
def test_the_normal_at_an_edge_points_at_the_axis_of_the_cylinder(degrees: float, depth: float, yaw: float) -> None:
    """The axis lies at the angle `degrees` from the vertical above the edge and is turned by `yaw` about the normal."""
    angle = math.radians(degrees)
    normal = np.array((math.sin(angle), 0.0, math.cos(angle)))
    across = np.array((math.cos(angle), 0.0, -math.sin(angle)))
    axis = math.cos(yaw) * np.array((0.0, 1.0, 0.0)) - math.sin(yaw) * across
    turn = np.empty(4)
    mujoco.mju_mat2Quat(turn, np.stack((np.cross(normal, axis), normal, axis), axis=1).reshape(-1))
    with simkit.load(world(box("table", "-1 0 -1", "2 2 2"), log("log", 0, 1))) as sim:
        x, _, z = normal * (RADIUS - depth)
        sim.model("log").set_pose(simkit.Pose((x, 0.0, z), tuple(turn)))
        contacts = sim.contacts("log")
        assert contacts
        for contact in contacts:
            sideways = abs(float(contact.position[1])) * math.tan(yaw) if yaw < 0.1 else 0.0  # of the axis, there
            assert abs(float(contact.normal @ normal)) > math.cos(math.radians(2.0) + sideways / RADIUS)
        if yaw < 0.01:
            places = sorted(float(contact.position[1]) for contact in contacts)
            assert (places[0], places[-1]) == pytest.approx((-LENGTH / 2, LENGTH / 2), abs=1e-3)


def test_two_parallel_logs_touch_at_both_ends_of_their_common_length() -> None:
    with simkit.load(world(log("a", 0, 1), log("b", 2 * RADIUS - 1e-4, 1, yaw=1e-5, y=0.1))) as sim:
        contacts = sim.contacts()
        assert sorted(float(c.position[1]) for c in contacts) == pytest.approx([0.1 - LENGTH / 2, LENGTH / 2], abs=1e-6)
        assert all(abs(c.normal[0]) > 0.999999 for c in contacts)
        found = sim.engine.physics.data.contact
        assert found.dist.min() == pytest.approx(-1e-4, abs=2e-6)


def test_the_distance_of_crossed_logs_is_that_of_their_axes() -> None:
    for angle in (1e-4, 0.005, 0.02, 0.03):
        other = Rod((2 * RADIUS - 1e-4, 0.0, 0.0), (0.0, math.cos(angle), math.sin(angle)), RADIUS, 0.2, False)
        contacts = rod_contacts(Rod((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), RADIUS, 0.2, False), other)
        assert contacts is not None
        nearest = min(contacts)
        assert nearest[0] == pytest.approx(-1e-4, abs=1.1e-6)
        for _, _, frame in contacts:
            rows = np.array(frame).reshape(3, 3)
            assert np.allclose(rows @ rows.T, np.eye(3), atol=1e-12)


def test_a_log_across_another_one_has_the_contacts_of_the_engine() -> None:
    with simkit.load(world(log("a", 0, 1), log("b", 0, 1 + 2 * RADIUS - 1e-4, yaw=0.5))) as sim:
        assert has_contacts_of_the_engine(sim)


@pytest.mark.parametrize(
    ("rows", "shape", "seed"),
    [
        (2, "cylinder", None),
        (3, "cylinder", None),
        (2, "capsule", 2),
        pytest.param(3, "capsule", 2, marks=pytest.mark.slow),
        *(pytest.param(3, "cylinder", seed, marks=pytest.mark.slow) for seed in range(5)),
    ],
)
def test_a_pyramid_of_logs_is_at_rest_within_two_seconds(rows: int, shape: str, seed: int | None) -> None:
    with simkit.load(pyramid(rows, shape, seed)) as sim:
        sim.run(2.0)
        assert speeds(sim)[0] < 2e-4


def test_a_pyramid_of_logs_falls_asleep() -> None:
    with simkit.load(pyramid(2, seed=1)) as sim:
        sim.run(4.0)
        assert (sim.mj_data.tree_asleep >= 0).all()


@pytest.mark.slow
@pytest.mark.parametrize("seed", [None, *range(5)])
def test_a_pyramid_of_ten_logs_comes_to_rest(seed: int | None) -> None:
    with simkit.load(pyramid(4, seed=seed)) as sim:
        sim.run(2.0)
        assert speeds(sim)[0] < 1e-3
        sim.run(6.0)
        assert speeds(sim)[0] < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
def test_a_heap_of_fifteen_logs_creeps_slowly(seed: int) -> None:
    """In most heaps the fastest log creeps by less than 0.1 mm/s; in a few, one slips down a wall at up to 0.3 mm/s."""
    draw = random.Random(seed)
    logs = [
        log(
            f"log_{i}",
            (i % 3 - 1) * 0.104 + draw.uniform(-0.002, 0.002),
            0.06 + i // 3 * 0.12,
            draw.uniform(-0.01, 0.01),
            y=draw.uniform(-0.02, 0.02),
        )
        for i in range(15)
    ]
    walls = [box(f"wall_{x > 0}", f"{x} 0 0.35", "0.04 0.6 0.7") for x in (-0.19, 0.19)]
    with simkit.load(world(GROUND, *walls, *logs)) as sim:
        sim.run(3.0)
        before = [model.pose.position.copy() for model in sim.models.values()]
        sim.run(1.0)
        after = [model.pose.position for model in sim.models.values()]
        assert max(np.linalg.norm(b - a) for a, b in zip(before, after, strict=True)) < 4e-4


@pytest.mark.parametrize(("speed", "ratio"), [(0.3, 0.287), (0.45, 0.697)])
def test_a_wheel_climbs_a_small_step_with_the_speed_of_an_inelastic_hit(speed: float, ratio: float) -> None:
    """A hit turns a solid wheel about the edge: v' = v (1 - 2 h / (3 r)), and then v''² = v'² - 4/3 g h."""
    height, radius = 0.005, 0.033
    theory = math.sqrt((speed * (1 - 2 * height / (3 * radius))) ** 2 - 4 / 3 * G * height)
    assert theory == pytest.approx(ratio * speed, rel=1e-2)
    wheel = log("wheel", -0.02, radius, mu=1.0).replace(f"<radius>{RADIUS}", f"<radius>{radius}")
    wheel = wheel.replace(f"<izz>{RADIUS**2}", f"<izz>{radius**2}")
    with simkit.load(world(GROUND.replace("0.6", "1.0"), box("step", "1 0 0", "2 1 0.01", 1.0), wheel)) as sim:
        sim.model("wheel").set_velocity((speed, 0, 0), (0, speed / radius, 0))
        sim.run(0.6)
        assert sim.mj_data.qpos[2] == pytest.approx(height + radius, abs=1e-4)
        assert sim.mj_data.qvel[0] == pytest.approx(theory, rel=0.1)


def test_a_cylinder_that_approaches_keeps_the_speculative_contacts_of_the_engine() -> None:
    with simkit.load(world(log("a", 0, 1), log("b", 2 * RADIUS + 0.01, 1))) as sim:
        sim.model("b").set_velocity((-80, 0, 0))
        data = sim.engine.physics.fresh()
        assert sim.mj_model.opt.enableflags & SPECULATIVE_FLAG
        assert data.ncon > 0
        assert has_contacts_of_the_engine(sim)


def test_a_log_without_a_partner_is_not_searched() -> None:
    with simkit.load(world(GROUND, log("a", 0, RADIUS))) as sim:
        assert not sim.engine.physics.law.lines
    with simkit.load(world(GROUND, log("a", 0, RADIUS), log("b", 1, RADIUS))) as sim:
        assert sim.engine.physics.law.lines


def test_the_contacts_of_a_stored_state_are_those_of_the_step() -> None:
    with simkit.load(pyramid(3, seed=2)) as sim:
        sim.run(0.2)
        physics = sim.engine.physics
        held = physics.hold()
        forces = physics.fresh_accelerations().efc_force.copy()
        contacts: list[LineContact] = [
            (float(c.dist), tuple(c.pos), tuple(c.frame)) for c in physics.data.contact if c.efc_address >= 0
        ]
        sim.run(0.1)
        data = physics.data_of(held)
        assert [(float(c.dist), tuple(c.pos), tuple(c.frame)) for c in data.contact if c.efc_address >= 0] == contacts
        assert np.array_equal(data.efc_force, forces)


@pytest.mark.parametrize("shape", ["cylinder", "capsule"])
@pytest.mark.parametrize(("spacing", "mu"), [(1.0, 0.1), (1.0, 0.6), (1.4, 0.1), (1.4, 0.6), (1.7, 0.1)])
def test_a_log_that_starts_too_deep_in_a_groove_comes_out_slowly(spacing: float, mu: float, shape: str) -> None:
    """The fixed logs are `spacing` radii from the middle. The normals are 30°, 44° and 58° from the vertical."""
    height = RADIUS * (1 + math.sqrt(4 - spacing**2))
    beds = [log(f"bed_{x > 0}", x, RADIUS, shape=shape, mu=mu) for x in (-spacing * RADIUS, spacing * RADIUS)]
    fixed = [bed.replace("<link", "<static>true</static><link", 1) for bed in beds]
    with simkit.load(world(*fixed, log("log", 0, height - 0.005, shape=shape, mu=mu))) as sim:
        fastest = 0.0
        for _ in range(150):
            sim.step()
            fastest = max(fastest, float(sim.mj_data.qvel[2]))
        assert fastest < 0.105  # 5 cm/s along the normals
        sim.run(0.1)
        assert sim.mj_data.qpos[2] == pytest.approx(height, abs=5e-5)


@pytest.mark.parametrize(
    ("shape", "spacing", "mu", "depth", "shift", "yaw", "step"),
    [
        ("capsule", 1.65, 0.43, 0.01, 0.001, 0.005, 0.004),
        ("cylinder", 0.91, 1.0, 0.01, 0.0, 0.0, 0.002),
        ("capsule", 1.57, 0.55, 0.01, 0.001, 0.03, 0.0005),
        ("capsule", 1.56, 0.68, 0.001, 0.0, 0.0, 0.002),
        ("capsule", 1.21, 0.99, 0.005, 0.0, 0.0, 0.001),
        ("cylinder", 1.44, 0.92, 0.01, 0.004, 0.03, 0.0005),
        ("cylinder", 1.76, 0.34, 0.01, 0.0, 0.0, 0.0005),
        ("cylinder", 1.21, 0.98, 0.01, 0.001, 0.0, 0.001),
        ("cylinder", 1.45, 0.8, 0.01, 0.0, 0.03, 0.001),
    ],
)
def test_a_log_that_starts_askew_and_too_deep_in_a_groove_is_not_thrown_out(
    shape: str, spacing: float, mu: float, depth: float, shift: float, yaw: float, step: float
) -> None:
    """With friction that nearly holds the log, repeated solutions step past the solution, farther each time."""
    height = RADIUS * (1 + math.sqrt(4 - spacing**2))
    beds = [log(f"bed_{x > 0}", x, RADIUS, shape=shape, mu=mu) for x in (-spacing * RADIUS, spacing * RADIUS)]
    fixed = [bed.replace("<link", "<static>true</static><link", 1) for bed in beds]
    top = log("log", shift, height - depth, yaw, shape, mu)
    with simkit.load(world(*fixed, top, step=step)) as sim:
        fastest = 0.0
        for _ in range(round(0.2 / step)):
            sim.step()
            fastest = max(fastest, float(np.linalg.norm(sim.mj_data.qvel[:3])))
        assert fastest < 0.2  # 5 cm/s along normals up to 62° from the vertical, and the fall of what is askew
        assert sim.mj_data.qpos[2] < height + 1e-3


PAIR = """<mujoco><option><flag multiccd="{flag}"/></option><worldbody>
  <body><freejoint/><geom type="cylinder" size="0.05 {half}" mass="1"/></body>
  <body><freejoint/><geom type="{shape}" size="{sizes}" mass="1"/></body></worldbody></mujoco>"""


def spun(axis: tuple[float, float, float], angle: float) -> np.ndarray:
    turn = np.empty(4)
    mujoco.mju_axisAngle2Quat(turn, np.array(axis), angle)
    return turn


@pytest.mark.parametrize("angle", [0.0, 1e-3, 0.03, 0.1, 0.5])
@pytest.mark.parametrize("shape", ["cylinder", "box"])
def test_the_deepest_contact_agrees_with_that_of_mujoco_without_multiccd(shape: str, angle: float) -> None:
    """MuJoCo's single contacts are exact; only the place of a contact on a line is arbitrary."""
    draw, compared = random.Random(1), 0
    for _ in range(40):
        half, other = draw.uniform(0.03, 0.3), draw.uniform(0.03, 0.3)
        sizes = f"0.05 {other}" if shape == "cylinder" else f"0.1 0.2 {other}"
        models = [
            mujoco.MjModel.from_xml_string(PAIR.format(flag=flag, half=half, shape=shape, sizes=sizes))
            for flag in ("enable", "disable")
        ]
        ours, exact = mujoco.MjData(models[0]), mujoco.MjData(models[1])
        side, shift = draw.uniform(0.1, 1.4), draw.uniform(-0.7, 0.7) * (half + other)
        normal = np.array((math.cos(side), math.sin(side), 0.0))
        corner = np.zeros(3) if shape == "cylinder" else np.array((0.1, 0.2, 0.0))
        reach = 0.05 + (0.05 if shape == "cylinder" else 0.0) - draw.choice((1e-5, 1e-4, 1e-3))
        ours.qpos[:3], ours.qpos[3:7] = corner + reach * normal + (0, 0, shift), spun(tuple(normal), angle)
        exact.qpos[:] = ours.qpos
        for model, data in zip(models, (ours, exact), strict=True):
            mujoco.mj_forward(model, data)
        if not (ours.ncon and exact.ncon):
            continue
        LineContacts(models[0]).correct(ours)
        deepest = min((c for c in ours.contact if not c.exclude), key=lambda c: c.dist)
        compared += 1
        assert deepest.dist == pytest.approx(exact.contact[0].dist, rel=0.03, abs=3e-6)
        assert deepest.frame[:3] @ exact.contact[0].frame[:3] > math.cos(math.radians(3.0))
    assert compared > 15
