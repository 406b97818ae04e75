"""Cases of `contact.py` in which bodies turn: Euler's disc, coins, a top, turntables, log over an edge, pendulums."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from contact_record import Record
from contact_scene import GRAVITY, LATERAL, Body, Case, Found, Hinge, Quantity, Shape, Table, Vector

# Euler's disc


def disc(step: float) -> Case:
    """A thin disc in steady precession about its resting centre, its rim rolling on the ground.

    With the radius R, the half thickness h, the inclination a to the ground and the moments of inertia A across and C
    along the axis for 1 kg, the precession W about the vertical has

        W² = g R (R cos a - h sin a) / (sin a (A R cos a - C h sin a)),

    which is 4 g / (R sin a) for h = 0. The angular velocity is along the line from the centre to the contact, because
    both are at rest; friction is zero and the normal force is the weight.
    """
    radius, half, incline = 0.1, 0.002, math.radians(30)
    shape = Shape("cylinder", (radius, half))
    sine, cosine = math.sin(incline), math.cos(incline)
    across, _, along = shape.inertia
    arm = across * radius * cosine - along * half * sine
    precession = math.sqrt(GRAVITY * radius * (radius * cosine - half * sine) / (sine * arm))
    # pitch by a: the lowest rim is at +x
    rim: Vector = (radius * cosine - half * sine, 0.0, -radius * sine - half * cosine)
    turning = precession * sine / radius
    angular = (rim[0] * turning, 0.0, rim[2] * turning)
    body = Body("disc", shape, 0.5, (0.0, 0.0, -rim[2]), (0.0, incline, 0.0), 1.0, angular=angular)

    def energy(r: Record) -> Found:
        whole = r.energy + body.mass * GRAVITY * (body.position[2] - half)  # beside the disc that lies
        return {"energy": 100.0 * float(whole[-1] / whole[0] - 1.0)}

    look = max(1, round(0.01 / step))
    return Case("disc", "disc of 0.1 m, 30°", energy, (body,), settle=0.0, duration=4.0, stride=look, timestep=step)


def _disc(step: float, quick: bool) -> Iterator[Case]:
    yield disc(step)


# Coins and a top


def steady_precession(body: Shape, incline: float, spin: float) -> tuple[float, Vector]:
    """Return the slow precession [rad/s] of a coin or capsule that rolls without slip, and its contact point [m].

    The axis is inclined by `incline` to the vertical, towards x. The contact is at (x, 0, z) from the centre. It rests
    if the centre moves along y with -(P x + s k), k = x cos a - z sin a, for the precession P, the spin s and the
    inclination a. With the moments of inertia A across and C along the axis for 1 kg, the equations of momentum and
    angular momentum give

        sin a P (C s + (C - A) P cos a) = z P (P x + s k) - g x.
    """
    radius, half = body.size
    sine, cosine = math.sin(incline), math.cos(incline)
    if body.kind == "capsule":
        x, z = -half * sine, -half * cosine - radius
    else:
        x, z = radius * cosine - half * sine, -radius * sine - half * cosine
    across, _, along = body.inertia
    squared = sine * (along - across) * cosine - z * x
    linear = spin * (along * sine - z * (x * cosine - z * sine))
    root = math.copysign(math.sqrt(linear * linear - 4.0 * squared * GRAVITY * x), linear)
    return -2.0 * GRAVITY * x / (linear + root), (x, 0.0, z)


def precession(name: str, row: str, shape: Shape, incline: float, spin: float, step: float) -> Case:
    """A coin or a capsule in steady precession; friction may hold its contact."""
    speed, (x, _, z) = steady_precession(shape, incline, spin)
    sine, cosine = math.sin(incline), math.cos(incline)
    velocity = 0.0, -(speed * x + spin * (x * cosine - z * sine)), 0.0
    turning = spin * sine, 0.0, speed + spin * cosine
    body = Body(name, shape, 0.1, (0.0, 0.0, -z), (0.0, incline, 0.0), 1.0, velocity, turning)

    def errors(r: Record) -> Found:
        axis = r.rotations[:, 0, :, 2]
        turned = float(np.unwrap(np.arctan2(axis[:, 1], axis[:, 0]))[-1]) / float(r.times[-1])
        energy = r.energy
        return {"energy": 100.0 * float(energy[-1] / energy[0] - 1.0), "precession": 100.0 * (turned / speed - 1.0)}

    look = max(1, round(0.002 / step))
    return Case(name, row, errors, (body,), settle=0.0, duration=2.0, stride=look, timestep=step)


def _precessions(step: float, quick: bool) -> Iterator[Case]:
    coin, small = Shape("cylinder", (0.05, 0.002)), Shape("cylinder", (0.012, 0.001))
    capsule = Shape("capsule", (0.02, 0.03))
    yield precession("coin", "coin of 50 mm, 60°, 30 rad/s", coin, math.radians(60), 30.0, step)
    yield precession("small_coin", "coin of 12 mm, 70°, 100 rad/s", small, math.radians(70), 100.0, step)
    yield precession("capsule", "capsule on its end, 10°, 200 rad/s", capsule, math.radians(10), 200.0, step)


# Turntable


def turntable(step: float) -> Case:
    """A box that stands on a turntable of 1000 kg, at 2 rad/s: it needs a hundredth of the friction that it has."""
    rate, distance = 2.0, 0.3
    table = Body("table", Shape("cylinder", (0.5, 0.05)), 1000.0, (0.0, 0.0, 0.5))
    place = (distance, 0.0, 0.6)
    box = Body(
        "box", Shape("box", (0.05,) * 3), 1.0, place, linear=(0.0, rate * distance, 0.0), angular=(0.0, 0.0, rate)
    )

    def creep(r: Record) -> Found:
        offset = r.positions[:, 0] - r.positions[:, 1]
        in_table = np.einsum("tji,tj->ti", r.rotations[:, 1], offset)
        return {"creep": 1e3 * float(np.linalg.norm((in_table[-1] - in_table[0])[:2]))}

    hinge = Hinge("table", "", (0.0, 0.0, 0.5), (0.0, 0.0, 1.0), rate)
    look = max(1, round(0.01 / step))
    return Case(
        "turntable",
        "box at 0.3 m, 2 rad/s",
        creep,
        (box, table),
        hinges=(hinge,),
        ground="none",
        duration=5.0,
        stride=look,
        timestep=step,
    )


def _turntable(step: float, quick: bool) -> Iterator[Case]:
    yield turntable(step)


# Log over an edge

EDGE_RADIUS = 0.04


def over_the_edge(speed: float, mu: float, radius: float = EDGE_RADIUS) -> tuple[float, float]:
    """Return horizontal speed [m/s] and spin [rad/s] of a cylinder that rolled over the edge of a table.

    The cylinder turns about the edge, its centre by the angle a from the vertical. Without slip it accelerates with
    a'' = 2 g sin a / (3 R), with a friction of m g sin a / 3. It slips from the angle on at which this friction exceeds
    mu N. It leaves at N = 0.
    """
    step = 1e-5
    angle, rate, spin, slips = 0.0, speed / radius, speed / radius, False
    while True:
        normal = GRAVITY * math.cos(angle) - radius * rate * rate
        if normal <= 0.0:
            return radius * rate * math.cos(angle), spin
        pull = GRAVITY * math.sin(angle)
        slips = slips or pull / 3 > mu * normal
        friction = mu * normal if slips else pull / 3
        rate += step * (pull - friction) / radius
        spin = spin + step * 2 * friction / radius if slips else rate
        angle += step * rate


@dataclass(frozen=True)
class Edge:
    """The measure of a log that left an edge: its motion in free flight beside the reference.

    Attributes:
        speed, spin: reference [m/s, rad/s].
    """

    speed: float
    spin: float

    def __call__(self, r: Record) -> Found:
        speed, spin = float(r.linear[-1, 0, 0]), float(r.angular[-1, 0, 1])
        return {"speed": 100.0 * (speed / self.speed - 1.0), "spin": 100.0 * (spin / self.spin - 1.0)}


def _edges(step: float, quick: bool) -> Iterator[Case]:
    top, mu = 2.0, 0.5
    table = Body("bench", Shape("box", (0.5, 0.5, 0.05)), 1.0, (-0.5, 0.0, top - 0.05))
    for speed in (0.05, 0.2):
        place = (-0.03, 0.0, top + EDGE_RADIUS)
        log = Body(
            "log",
            Shape("cylinder", (EDGE_RADIUS, 0.15)),
            1.0,
            place,
            LATERAL,
            mu,
            (speed, 0.0, 0.0),
            (0.0, speed / EDGE_RADIUS, 0.0),
        )
        duration = 0.03 / speed + 0.6
        measure = Edge(*over_the_edge(speed, mu))
        yield Case(
            f"log_edge_{speed:g}mps",
            f"log at {speed:g} m/s",
            measure,
            (log,),
            blocks=(table,),
            settle=0.05,
            duration=duration,
            stride=max(1, round(0.01 / step)),
            ground="none",
            timestep=step,
        )


# Pendulums


def pendulum(links: int, step: float) -> Case:
    """Links of 0.2 m in a row, released horizontally; their axes are alternately across and, from three on, upright."""
    length = 0.2
    shape = Shape("box", (length / 2, 0.01, 0.01))
    bodies = tuple(Body(f"link_{i}", shape, 0.3, (length * (i + 0.5), 0.0, 2.0), touches=False) for i in range(links))
    hinges = tuple(
        Hinge(
            f"link_{i}",
            f"link_{i - 1}" if i else "",
            (length * i, 0.0, 2.0),
            (0.0, 0.0, 1.0) if links > 2 and i % 2 else (0.0, 1.0, 0.0),
        )
        for i in range(links)
    )
    whole = sum(body.mass * GRAVITY * body.position[0] for body in bodies)

    def drift(r: Record) -> Found:
        energy = r.energy
        return {"drift": 100.0 * float(np.abs(energy - energy[0]).max()) / whole}

    return Case(
        f"pendulum_{links}",
        f"{links} links" + (", axes across and upright" if links > 2 else ""),
        drift,
        bodies,
        hinges=hinges,
        ground="none",
        settle=0.0,
        duration=10.0,
        stride=max(1, round(0.004 / step)),
        timestep=step,
    )


def _pendulums(step: float, quick: bool) -> Iterator[Case]:
    for links in (2, 3, 7):
        yield pendulum(links, step)


DISC = Table(
    "disc",
    "Euler's disc",
    "A disc of 4 mm with a radius of 0.1 m rolls on its rim, inclined by 30°, μ 1. Change of its energy in 4 s [%].",
    {"energy": Quantity("change of energy", "%")},
    _disc,
    steps=(0.002, 0.001, 0.0005, 0.00025),
    quick_steps=(0.001,),
    by_step=True,
    is_on_page=False,
)
PRECESSIONS = Table(
    "precession",
    "Coins and a capsule that precess",
    "A coin rolls in a circle, and a capsule spins on its end like a top, μ 1. Change of the energy in 2 "
    "s [%] and error of the precession [%].",
    {"energy": Quantity("change of energy", "%"), "precession": Quantity("precession", "%")},
    _precessions,
    steps=(0.004, 0.002, 0.001, 0.0005, 0.00025),
    quick_steps=(0.001,),
    by_step=True,
)
TURNTABLE = Table(
    "turntable",
    "Box on a turntable",
    "A box of 0.1 m stands at 0.3 m from the axis of a turntable that turns at 2 rad/s, μ 0.5. Creep in 5 s [mm].",
    {"creep": Quantity("creep", "mm")},
    _turntable,
    steps=(0.004, 0.002, 0.001, 0.0005),
    quick_steps=(0.001,),
    engines=("simkit", "MuJoCo's law", "PyBullet"),
    by_step=True,
    is_on_page=False,
)
EDGES = Table(
    "edge",
    "Log over the edge of a table",
    "A cylinder with a radius of 40 mm rolls across the edge of a box, μ 0.5. Errors of its horizontal "
    "speed and of its spin in the fall [%].",
    {"speed": Quantity("speed", "%"), "spin": Quantity("spin", "%")},
    _edges,
    steps=(0.002, 0.001, 0.0005, 0.00025),
    quick_steps=(0.001,),
    by_step=True,
    is_on_page=False,
)
PENDULUMS = Table(
    "pendulums",
    "Pendulums",
    "Links of 0.2 m in a row are released horizontally. Greatest change of energy in 10 s [%].",
    {"drift": Quantity("change of energy", "%")},
    _pendulums,
    steps=(0.004, 0.002, 0.001, 0.0005),
    quick_steps=(0.001,),
    engines=("simkit", "MuJoCo's law", "PyBullet"),
    by_step=True,
)
