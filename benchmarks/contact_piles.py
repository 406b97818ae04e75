"""Cases of `contact.py` with many bodies: loads, dominoes, dice, logs and heaps."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from contact_record import Record
from contact_scene import LATERAL, Body, Case, Found, Quantity, Shape, Table, Vector

FALLEN = 0.05  # displacement of a cube of a tower that counts as a fall [m]
BESIDE = ("simkit", "MuJoCo's law", "PyBullet")
WITHOUT_DRAKE = (*BESIDE, "DART")  # a step of Drake's with twenty boxes takes 10 ms


def _sink(r: Record) -> Found:
    return {"sink": 1e3 * float(r.positions[0, -1, 2] - r.positions[-1, -1, 2])}


def _tower(r: Record) -> Found:
    moved = np.linalg.norm(r.positions - r.positions[0], axis=2).max(1)
    fallen = np.flatnonzero(~(moved < FALLEN))
    stands = float(r.times[fallen[0]]) if fallen.size else float(r.times[-1])
    return {**_sink(r), "stands": stands}


def _loads(step: float, quick: bool) -> Iterator[Case]:
    cube = Shape("box", (0.05,) * 3)
    for mass in (1e2, 1e3, 1e4):
        light, heavy = (Body(n, cube, m, (0.0, 0.0, z)) for n, m, z in (("light", 1.0, 0.05), ("heavy", mass, 0.15)))
        row = f"cube of 1 kg under {mass:g} kg"
        yield Case(f"load_{mass:g}kg", row, _sink, (light, heavy), settle=0.0, duration=2.0, stride=10, timestep=step)
    tower = tuple(Body(f"cube_{i}", cube, 1e3 if i % 2 else 1.0, (0.0, 0.0, 0.05 + 0.1 * i)) for i in range(10))
    row = "ten cubes, 1 and 1000 kg"
    yield Case("tower", row, _tower, tower, settle=0.0, duration=10.0, stride=10, timestep=step)


# Dominoes

DOMINO = Shape("box", (0.01, 0.025, 0.05))
PITCH = 0.05  # between two dominoes [m]
DOMINOES = 20
TILT = math.radians(10)  # at which a domino counts as hit


def _wave(r: Record) -> Found:
    """Speed of the wave between the eighth and the last but one domino."""
    upright = r.rotations[:, :, 2, 2]
    if (upright.min(axis=0)[:-1] > math.cos(TILT)).any():
        return {"speed": 0.0}
    times = [float(r.times[np.flatnonzero(upright[:, i] < math.cos(TILT))[0]]) for i in (7, DOMINOES - 2)]
    return {"speed": PITCH * (DOMINOES - 9) / (times[1] - times[0])}


def _dominoes(step: float, quick: bool) -> Iterator[Case]:
    for mu in (0.2, 0.4):
        stones = [Body(f"stone_{i}", DOMINO, 0.1, (PITCH * i, 0.0, DOMINO.size[2]), mu=mu) for i in range(DOMINOES)]
        rate = 5.0  # about the lower edge in front
        arm_x, arm_z = -DOMINO.size[0], DOMINO.size[2]
        linear = (rate * arm_z, 0.0, -rate * arm_x)
        first = Body("stone_0", DOMINO, 0.1, stones[0].position, mu=mu, linear=linear, angular=(0.0, rate, 0.0))
        bodies = (first, *stones[1:])
        yield Case(
            f"dominoes_mu{mu:g}", f"20 dominoes, μ {mu:g}", _wave, bodies, settle=0.1, timestep=step, duration=1.6
        )


# Dice

DIE = Shape("box", (0.01, 0.01, 0.01))


def _mean_way(r: Record) -> Found:
    ways = np.linalg.norm(r.positions[-1, :, :2] - r.positions[0, :, :2], axis=1)
    return {"way": float(ways.mean())}


def _dice(step: float, quick: bool) -> Iterator[Case]:
    draw = random.Random(1)
    dice = []
    for i in range(24):
        turn = (draw.uniform(-3, 3), draw.uniform(-1.5, 1.5), draw.uniform(-3, 3))
        linear = (draw.uniform(1.5, 2.5), 0.0, draw.uniform(-1.0, 0.0))
        angular = (draw.uniform(-20, 20), draw.uniform(-20, 20), draw.uniform(-20, 20))
        place = (0.0, 0.5 * i, draw.uniform(0.1, 0.2))
        dice.append(Body(f"die_{i}", DIE, 0.005, place, turn, 0.4, linear, angular))
    looks = max(1, round(0.01 / step))
    yield Case("dice", "24 dice, μ 0.4", _mean_way, tuple(dice), settle=0.0, duration=2.5, stride=looks, timestep=step)


# Logs and heaps


@dataclass(frozen=True)
class Pile:
    """The measure of a pile that falls and comes to rest.

    Attributes:
        falls: until when it falls [s]; 0 if it begins at rest.
        rests: from when on it is to be at rest [s].
    """

    falls: float
    rests: float

    def __call__(self, r: Record) -> Found:
        late = r.between(self.rests, r.times[-1])
        creep = np.linalg.norm(r.positions[-1] - r.positions[late][0], axis=1).max()
        found = {
            "rest_us": r.step_us(self.rests, r.times[-1]),
            "creep": 1e3 * float(creep) / (float(r.times[-1]) - self.rests),
        }
        if not math.isnan(r.engine.asleep()):
            found["asleep"] = r.engine.asleep()
        if self.falls:
            found["fall_us"] = r.step_us(0.0, self.falls)
        return found


def _pyramids(step: float, quick: bool) -> Iterator[Case]:
    radius, half = 0.05, 0.2
    for base in (2, 3, 4):
        places = [
            ((2 * i + row - base + 1) * radius, radius * (1 + row * math.sqrt(3)))
            for row in range(base)
            for i in range(base - row)
        ]
        logs = tuple(
            Body(f"log_{i}", Shape("cylinder", (radius, half)), 2.0, (x, 0.0, z), LATERAL, 0.6)
            for i, (x, z) in enumerate(places)
        )
        side = (base + 0.5) * radius  # half as thick as a log, and as high as its centre
        stops = tuple(
            Body(f"stop_{i}", Shape("box", (radius / 2, half, radius / 2)), 1.0, (x, 0.0, radius / 2), mu=0.6)
            for i, x in enumerate((-side, side))
        )
        row = " + ".join(str(base - i) for i in range(base)) + " logs"
        name = f"logs_{base}"
        yield Case(name, row, Pile(0.0, 2.0), logs, stops, settle=0.0, duration=4.0, stride=50, timestep=step)


def _random_turn(draw: random.Random) -> Vector:
    return draw.uniform(-math.pi, math.pi), draw.uniform(-1.5, 1.5), draw.uniform(-math.pi, math.pi)


def _tray(side: float) -> tuple[Body, ...]:
    """Four walls around a square, higher than any body falls."""
    wall, high = 0.05, 1.5
    along, across = Shape("box", (side + 2 * wall, wall, high)), Shape("box", (wall, side, high))
    return (
        Body("wall_0", along, 1.0, (0.0, side + wall, high)),
        Body("wall_1", along, 1.0, (0.0, -side - wall, high)),
        Body("wall_2", across, 1.0, (side + wall, 0.0, high)),
        Body("wall_3", across, 1.0, (-side - wall, 0.0, high)),
    )


HEAPS = {
    "boxes": (30, Shape("box", (0.04, 0.03, 0.02))),
    "capsules": (30, Shape("capsule", (0.02, 0.03))),
    "balls": (40, Shape("sphere", (0.03,))),
    "logs": (15, Shape("cylinder", (0.02, 0.08))),
}


def heap(kind: str, seed: int, step: float) -> Case:
    """Bodies of one shape that fall into a tray, from random places and in random attitudes."""
    count, shape = HEAPS[kind]
    draw = random.Random(seed)
    bodies = []
    for i in range(count):
        place = (draw.uniform(-0.1, 0.1), draw.uniform(-0.1, 0.1), 0.1 + 0.07 * (i // 2))
        place = (abs(place[0]) * (-1) ** i, place[1], place[2])
        bodies.append(Body(f"{kind}_{i}", shape, 0.2, place, _random_turn(draw), 0.5))
    row = f"{count} {kind}"
    return Case(
        f"heap_{kind}_{seed}",
        row,
        Pile(1.5, 4.0),
        tuple(bodies),
        blocks=_tray(0.2),
        settle=0.0,
        duration=5.0,
        stride=50,
        timestep=step,
    )


def _heaps(step: float, quick: bool) -> Iterator[Case]:
    for kind in HEAPS:
        for seed in range(1 if quick else 4):
            yield heap(kind, seed, step)


PILE_QUANTITIES = {
    "fall_us": Quantity("step while falling", "µs", mean=True, beside=True),
    "rest_us": Quantity("step at rest", "µs", mean=True, beside=True),
    "creep": Quantity("creep", "mm/s", 1.0, mean=True),
    "asleep": Quantity("asleep", "%", mean=True),
}
LOADS = Table(
    "loads",
    "Heavy loads",
    "A cube of 0.1 m and 1 kg carries another cube for 2 s; a tower of ten cubes, of 1 and 1000 kg in turn, is "
    "watched for 10 s.",
    {
        "sink": Quantity("sinks", "mm", 1.0),
        "stands": Quantity("stands for", "s", 10.0, more=True, exact=10.0),
    },
    _loads,
    engines=BESIDE,
    is_on_page=False,
)
DOMINO_WAVE = Table(
    "dominoes",
    "Dominoes",
    "Twenty stones of 20 × 50 × 100 mm at a distance of 50 mm from centre to centre. Speed of the wave [m/s].",
    {"speed": Quantity("speed", "m/s", mean=True)},
    _dominoes,
    engines=WITHOUT_DRAKE,
    steps=(0.002, 0.001, 0.0005, 0.00025),
    quick_steps=(0.001, 0.0005),
    by_step=True,
    is_on_page=False,
)
DICE = Table(
    "dice",
    "Dice",
    "Twenty-four dice of 20 mm are thrown at 1.5 to 2.5 m/s with a spin of up to 20 rad/s about each "
    "axis. Mean way until they rest [m].",
    {"way": Quantity("way", "m", mean=True)},
    _dice,
    engines=WITHOUT_DRAKE,
    steps=(0.002, 0.001, 0.0005, 0.00025),
    quick_steps=(0.001,),
    by_step=True,
    is_on_page=False,
)
PYRAMIDS = Table(
    "logs",
    "Pyramids of logs",
    "Cylinders with a radius of 50 mm, 0.4 m long, 2 kg, μ 0.6, are stacked between two low stops, and "
    "watched for 4 s with a step of 1 ms. The last 2 s are shown.",
    {key: PILE_QUANTITIES[key] for key in ("rest_us", "creep", "asleep")},
    _pyramids,
    engines=BESIDE,
    is_on_page=False,
)
FALLING_HEAPS = Table(
    "heaps",
    "Heaps",
    "Bodies of 0.2 kg fall into a tray of 0.4 × 0.4 m, with a step of 1 ms: means of four seeds, in the "
    "last second of five.",
    PILE_QUANTITIES,
    _heaps,
    engines=BESIDE,
    headline=("rest_us", "creep"),
)
