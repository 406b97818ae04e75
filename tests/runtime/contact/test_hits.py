"""Oblique hits: the velocity after a hit is that of a rigid impact with Coulomb's friction, at every time step."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import simkit

Floats = npt.NDArray[np.float64]

G = 9.8
SPEED = 4.0
STEPS = [0.004, 0.002, 0.001, 0.0005, 0.00025, 0.0001]
GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
<surface><friction><ode><mu>2</mu><mu2>2</mu2></ode></friction></surface></collision></link></model>"""


def box(x: float, y: float, z: float) -> tuple[str, tuple[float, ...]]:
    """Return the geometry of a box, and its moments of inertia for 1 kg."""
    shape = f"<box><size>{x} {y} {z}</size></box>"
    return shape, ((y * y + z * z) / 12, (x * x + z * z) / 12, (x * x + y * y) / 12)


BALL = "<sphere><radius>0.1</radius></sphere>", (0.004,) * 3
ROD = "<capsule><radius>0.02</radius><length>0.4</length></capsule>", (0.0133, 0.0133, 0.0002)
DISC = "<cylinder><radius>0.1</radius><length>0.1</length></cylinder>", (0.0033, 0.0033, 0.005)
ROLLER = "<cylinder><radius>0.1</radius><length>0.2</length></cylinder>", (0.0058, 0.0058, 0.005)
SHAPES: dict[str, tuple[tuple[str, tuple[float, ...]], str]] = {  # geometry and inertia, roll pitch yaw
    "ball": (BALL, "0 0 0"),
    "box on its face": (box(0.2, 0.2, 0.1), "0 0 0.3"),
    "box on a lateral edge": (box(0.2, 0.2, 0.2), "0.4 0 0"),
    "box on its rear edge": (box(0.2, 0.2, 0.2), "0 -0.4 0"),
    "box on its front edge": (box(0.2, 0.2, 0.2), "0 0.4 0"),
    "box on a corner": (box(0.2, 0.2, 0.2), "0.5 0.6 0.3"),
    "rod that leans forwards": (ROD, "0 0.785 0"),
    "rod that leans backwards": (ROD, "0 -0.785 0"),
    "cylinder on its rim": (DISC, "0.3 0.2 0"),
    "cylinder on its side": (ROLLER, "1.5707963 0 0"),
    "plate on a corner": (box(0.4, 0.4, 0.02), "0.2 0.1 0"),
}


def body(
    name: str, shape: str, inertia: tuple[float, ...], pose: str, mu: float, e: float = 0.0, mass: float = 1
) -> str:
    tensor = "".join(f"<{axis}>{mass * one}</{axis}>" for axis, one in zip(("ixx", "iyy", "izz"), inertia, strict=True))
    bounce = f"<bounce><restitution_coefficient>{e}</restitution_coefficient></bounce>" if e else ""
    return f"""<model name="{name}"><pose>{pose}</pose><link name="l"><inertial><mass>{mass}</mass><inertia>{tensor}
      </inertia></inertial><collision name="c"><geometry>{shape}</geometry><surface>{bounce}<friction><ode><mu>{mu}</mu>
      <mu2>{mu}</mu2></ode></friction></surface></collision></link></model>"""


def world(*models: str, step: float) -> str:
    return f"""<sdf version="1.9"><world name="w"><physics name="p" type="ode"><max_step_size>{step}</max_step_size>
      </physics>{GROUND}{"".join(models)}</world></sdf>"""


def rigid_impact(inverse: Floats, arms: list[Floats], velocity: Floats, mu: float, e: float) -> Floats:
    """Return the velocity of a body of 1 kg after an impact, shape (6,).

    Each contact point stops or rebounds with e, or opens. Its friction impulse stops the slip, or is mu times the
    normal impulse against the slip after the impact (Moreau 1988). The impulses are found by projection onto the cone.

    Args:
        inverse: inverse of the inertia, world frame, shape (3, 3).
        arms: positions of the contact points relative to the centre.
        velocity: linear and angular velocity before the impact, shape (6,).
        mu: friction coefficient.
        e: coefficient of restitution.
    """
    motions = [np.hstack((np.eye(3), [[0, z, -y], [-z, 0, x], [y, -x, 0]])) for x, y, z in arms]
    mobility = np.block([[np.eye(3), np.zeros((3, 3))], [np.zeros((3, 3)), inverse]])
    sizes = [1.0 / np.linalg.eigvalsh(motion @ mobility @ motion.T).max() for motion in motions]
    arrives = [min(0.0, float((motion @ velocity)[2])) for motion in motions]
    after, impulses = velocity.copy(), [np.zeros(3) for _ in arms]
    for _ in range(20000):
        most = 0.0
        for k, motion in enumerate(motions):
            slip = motion @ after
            slip[2] += e * arrives[k] + mu * math.hypot(slip[0], slip[1])
            now = _nearest_in_cone(impulses[k] - sizes[k] * slip, mu)
            after = after + mobility @ motion.T @ (now - impulses[k])
            most, impulses[k] = max(most, float(np.abs(now - impulses[k]).max())), now
        if most < 1e-10:
            break
    return after


def _nearest_in_cone(impulse: Floats, mu: float) -> Floats:
    """Return the nearest impulse with a friction of at most mu times the normal impulse."""
    along = math.hypot(impulse[0], impulse[1])
    if along <= mu * impulse[2]:
        return impulse
    if mu * along <= -impulse[2]:
        return np.zeros(3)
    normal = (impulse[2] + mu * along) / (1.0 + mu * mu)
    return np.array([*(impulse[:2] * mu * normal / along), normal])


class Hit:
    """First hit of a thrown body, in one step.

    Attributes:
        error: difference from the velocity after a rigid impact [m/s].
        gain: kinetic and potential energy gained by the step, relative to that before it.
        after: velocity of the body after the step [m/s].
    """

    def __init__(self, shape: str, mu: float, degrees: float, step: float, e: float = 0.0) -> None:
        (geometry, inertia), turn = SHAPES[shape]
        speed = SPEED * np.array([math.cos(math.radians(degrees)), 0.0, -math.sin(math.radians(degrees))])
        with simkit.load(world(body("b", geometry, inertia, f"0 0 1 {turn}", mu, e), step=step)) as sim:
            pose, physics = sim.model("b").pose, sim.engine.physics
            low, high = 0.0, 1.0  # height at which the body touches the ground
            for _ in range(30):
                middle = (low + high) / 2.0
                sim.model("b").set_pose(simkit.Pose((0, 0, middle), pose.quaternion))
                low, high = (middle, high) if self._touches(sim) else (low, middle)
            sim.model("b").set_pose(simkit.Pose((0, 0, high - 5.4 * speed[2] * step), pose.quaternion))
            sim.model("b").set_velocity(tuple(speed))
            while not self._touches(sim):
                sim.step()
            data = physics.fresh()
            arms = [one - data.xipos[-1] for one in data.contact.pos[data.contact.efc_address >= 0].copy()]
            turned = data.xmat[-1].reshape(3, 3).copy()
            inverse = turned @ np.diag(1.0 / np.array(inertia)) @ turned.T
            velocity, energy = self._velocity(sim), self._energy(sim, inertia)
            sim.step()
            found, falls = self._velocity(sim), np.array([0, 0, -G * step, 0, 0, 0])
            wanted = rigid_impact(inverse, arms, velocity + falls, mu, e)
            self.error, self.after = float(np.linalg.norm(found[:3] - wanted[:3])), found[:3]
            self.gain = self._energy(sim, inertia) / energy - 1.0

    def _touches(self, sim: Any) -> bool:
        data = sim.engine.physics.fresh()
        return bool((data.contact.efc_address >= 0).any()) and float(data.contact.dist.min()) < 0.0

    def _velocity(self, sim: Any) -> Floats:
        link = sim.link("b::l")
        return np.array([*link.linear_velocity, *link.angular_velocity])

    def _energy(self, sim: Any, inertia: tuple[float, ...]) -> float:
        velocity, data = self._velocity(sim), sim.engine.physics.fresh()
        spin = data.xmat[-1].reshape(3, 3).T @ velocity[3:]
        kinetic = velocity[:3] @ velocity[:3] + spin @ (np.array(inertia) * spin)
        return float(kinetic) / 2.0 + G * float(data.xipos[-1, 2])


@pytest.mark.parametrize("step", [0.004, 0.001, 0.0001])
@pytest.mark.parametrize("shape", SHAPES)
def test_a_body_leaves_an_oblique_hit_like_a_rigid_body_with_coulombs_friction(shape: str, step: float) -> None:
    for mu, degrees in ((0.3, 30.0), (1.0, 10.0), (0.6, 60.0)):
        hit = Hit(shape, mu, degrees, step)
        assert hit.error < 0.03 * SPEED
        assert hit.gain < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("shape", SHAPES)
def test_every_angle_and_friction_of_a_hit_follows_coulombs_law(shape: str, step: float) -> None:
    for mu in (0.1, 0.2, 0.4, 0.6, 0.8, 1.0):
        for degrees in (10.0, 25.0, 40.0, 55.0, 70.0, 80.0):
            for e in (0.0, 0.3, 0.6):
                hit = Hit(shape, mu, degrees, step, e)
                assert hit.error < 0.03 * SPEED, (mu, degrees, e)
                assert hit.gain < 1e-9, (mu, degrees, e)


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("mu", [0.2, 0.6])
def test_a_ball_without_bounce_is_slowed_by_friction_in_its_landing(mu: float, step: float) -> None:
    """The friction gives mu times the normal impulse, or makes the ball roll at 5/7 of its speed."""
    ball = body("b", *BALL, "0 0 0.1155 0 0 0", mu)
    with simkit.load(world(ball, step=step)) as sim:
        sim.model("b").set_velocity((3.0, 0.0, -3.0))
        sim.run(0.02)
        hit = math.sqrt(9.0 + 2.0 * G * 0.0155)
        left = 3.0 - mu * hit - mu * G * 0.015 if mu < 0.5 else 3.0 * 5.0 / 7.0
        assert sim.link("b::l").linear_velocity[0] == pytest.approx(left, rel=0.03)


@pytest.mark.parametrize("step", [0.002, 0.0005])
@pytest.mark.parametrize("shape", ["ball", "box on its rear edge", "rod that leans backwards"])
def test_a_small_restitution_changes_a_hit_as_little_as_none(shape: str, step: float) -> None:
    without, little = Hit(shape, 0.6, 45.0, step), Hit(shape, 0.6, 45.0, step, e=0.01)
    assert np.abs(without.after[:2] - little.after[:2]).max() < 0.03 * SPEED


def domino_speed(step: float, count: int) -> float:
    """Return the speed [m/s] of a wave of falling dominoes, behind the fifth."""
    width, height, pitch = 0.0075, 0.048, 0.0235
    shape, inertia = box(width, 0.024, height)
    row = (body(f"d{i}", shape, inertia, f"{i * pitch} 0 {height / 2} 0 0 0", 0.4, mass=0.008) for i in range(count))
    with simkit.load(world(*row, step=step)) as sim:
        sim.run(0.1)
        sim.model("d0").set_velocity((0.072, 0.0, 0.0), (0.0, 3.0, 0.0))
        times = []
        for name in ("d5", f"d{count - 1}"):
            assert sim.run_until(lambda s, name=name: s.model(name).pose.rpy[1] > 0.05, 1.0)
            times.append(sim.time)
        return pitch * (count - 6) / (times[1] - times[0])


def test_a_wave_of_dominoes_runs_equally_fast_at_each_step() -> None:
    assert domino_speed(0.0005, 12) == pytest.approx(domino_speed(0.002, 12), rel=0.03)


@pytest.mark.slow
def test_a_long_wave_of_dominoes_runs_equally_fast_at_each_step() -> None:
    speeds = [domino_speed(step, 24) for step in (0.002, 0.001, 0.0005, 0.00025)]
    assert max(speeds) / min(speeds) < 1.03


def dice_way(step: float) -> float:
    """Return the mean way [m] of twelve thrown dice until they rest."""
    shape, inertia = box(0.016, 0.016, 0.016)
    rng = np.random.default_rng(5)
    turns = rng.uniform(-3, 3, (12, 3))
    dice = (
        body(f"d{i}", shape, inertia, f"0 {0.5 * i} 0.1 {a} {b} {c}", 0.3, mass=0.005)
        for i, (a, b, c) in enumerate(turns)
    )
    with simkit.load(world(*dice, step=step)) as sim:
        for i in range(12):
            sim.model(f"d{i}").set_velocity((1.5 + rng.uniform(-0.3, 0.3), 0.0, -0.5), tuple(rng.uniform(-30, 30, 3)))
        sim.run(1.5)
        return float(np.mean([sim.model(f"d{i}").pose.position[0] for i in range(12)]))


@pytest.mark.slow
def test_thrown_dice_come_to_rest_equally_far_at_each_step() -> None:
    ways = [dice_way(step) for step in (0.002, 0.001, 0.0005, 0.00025)]
    assert max(ways) / min(ways) < 1.05
