"""Cases of `contact.py` in which bodies slide, roll, spin or are pushed, beside Coulomb's friction."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from contact_record import Floats, Record
from contact_scene import ALONG, GRAVITY, GROUND, LATERAL, Body, Case, Quantity, Shape, Table, Vector, Vehicle

WHEN = 0.98  # share of the time until a body stops or rolls in which it counts as sliding
LEAST_LOAD = 0.05  # share of the weight below which a step's normal force says nothing about friction
LONGEST = 3.0  # of an observed slide [s]
BESIDE = ("simkit", "MuJoCo's law", "PyBullet")

QUANTITIES = {
    "contact": Quantity("steps in contact", "%", 99.0, more=True, exact=100.0),
    "hop": Quantity("hop", "mm", 0.05),
    "way": Quantity("way, beyond v·dt/2", "%", 1.0),
    "force": Quantity("friction over μN", "%", 1.0),
    "direction": Quantity("direction of friction", "°", 1.0),
    "speed": Quantity("last speed", "%", 1.0),
    "gain": Quantity("energy gained", "%", 0.05),
}


@dataclass(frozen=True)
class Sliding:
    """The measure of a body that slides, with the analytic answer.

    Attributes:
        slips: time until the body stops or rolls without slip.
        way: length of the path, or the angle turned, until `way_time`; `deceleration` until then.
        speed: at the end of the observation.
        reference: body relative to which path and slip count; the ground by default.
        turns: whether the way is an angle.
        omitted: quantities that have no meaning here.
    """

    slips: float = math.inf
    way: float = math.nan
    way_time: float = math.nan
    deceleration: float = math.nan
    speed: float = math.nan
    reference: str = ""
    turns: bool = False
    omitted: tuple[str, ...] = ()

    def __call__(self, r: Record) -> dict[str, float]:
        found = {"contact": self._contact(r), "hop": _hop(r), "gain": _gain(r)}
        if not math.isnan(self.way):
            found["way"] = self._way_error(r)
        if not math.isnan(self.speed):
            found["speed"] = 100.0 * (float(np.linalg.norm(r.linear[-1, 0, :2])) / self.speed - 1.0)
        if not self.turns:
            found |= self._friction(r)
        return {key: value for key, value in found.items() if key not in self.omitted}

    def _contact(self, r: Record) -> float:
        return 100.0 * float(r.contact[r.times[1:] <= WHEN * self.slips].mean())

    def _relative(self, r: Record) -> tuple[Floats, Floats]:
        """Horizontal path and velocity of the first body relative to the reference."""
        path, speed = r.positions[:, 0, :2] - r.positions[0, 0, :2], r.linear[:, 0, :2]
        if self.reference:
            other = [body.name for body in r.case.moving].index(self.reference)
            path = path - (r.positions[:, other, :2] - r.positions[0, other, :2])
            speed = speed - r.linear[:, other, :2]
        return path, speed

    def _way_error(self, r: Record) -> float:
        """Error [%] beyond a dt/2 per second of slowing down by a, which is the integrator's."""
        if self.turns:
            spins = np.einsum("tj,tj->t", r.rotations[:, 0, :, 2], r.angular[:, 0])
            way = np.concatenate(((0.0,), np.cumsum(spins[1:]))) * r.case.timestep
        else:
            way = np.linalg.norm(self._relative(r)[0], axis=1)
        own = self.deceleration * self.way_time * r.case.timestep / 2
        return 100.0 * ((float(np.interp(self.way_time, r.times, way)) + own) / self.way - 1.0)

    def _friction(self, r: Record) -> dict[str, float]:
        """Friction beside the normal force and against the slip, in the steps that slide and carry weight."""
        gained = np.diff(r.linear[:, 0], axis=0) / r.case.timestep
        normal = gained[:, 2] + GRAVITY
        velocity = self._relative(r)[1]
        slip = (velocity[1:] + velocity[:-1]) / 2
        fast = np.linalg.norm(slip, axis=1) > 0.05 * np.linalg.norm(slip[0])
        chosen = (r.times[1:] <= WHEN * self.slips) & (normal > LEAST_LOAD * GRAVITY) & fast
        friction, normal, slip = gained[chosen, :2], normal[chosen], slip[chosen]
        if not normal.size:
            return {"force": math.nan, "direction": math.nan}
        share = float(np.median(np.linalg.norm(friction, axis=1) / (r.case.moving[0].mu * normal)))
        across = friction[:, 0] * slip[:, 1] - friction[:, 1] * slip[:, 0]
        angles = np.degrees(np.abs(np.arctan2(across, -(friction * slip).sum(1))))
        return {"force": 100.0 * (share - 1.0), "direction": float(np.percentile(angles, 95))}


def _hop(r: Record) -> float:
    return 1e3 * float((r.lowest - r.lowest[0]).max())


def _gain(r: Record) -> float:
    energy = r.energy
    return 100.0 * float((energy - np.minimum.accumulate(energy)).max() / energy[0])


def slide(name: str, row: str, bodies: tuple[Body, ...], mu: float, **options: object) -> Case:
    """A body that Coulomb friction brings to rest, or slows down for `LONGEST` seconds."""
    speed = math.hypot(*bodies[0].linear)
    slips = speed / (mu * GRAVITY)
    seen = min(slips, LONGEST)
    measure = Sliding(slips, speed * seen - mu * GRAVITY * seen**2 / 2, seen, mu * GRAVITY)
    duration = 1.03 * slips + 0.02 if slips < LONGEST else LONGEST
    fields: dict[str, object] = {"measure": measure, "duration": duration, "moves_for": slips}
    return Case(name, row, bodies=bodies, **(fields | options))  # type: ignore[arg-type]


def _roll(name: str, row: str, body: Body, share: float) -> Case:
    """A round body that slides until it rolls at `share` of its first speed."""
    speed = math.hypot(*body.linear)
    slips = (1 - share) * speed / (body.mu * GRAVITY)
    measure = Sliding(slips, speed=share * speed)
    return Case(name, row, measure, (body,), duration=1.1 * slips + 0.1, moves_for=slips)


def _box(name: str = "box", z: float = 0.05, **fields: object) -> Body:
    """A flat box of 0.4 by 0.4 by 0.1 m, 1 kg: up to mu 4 it does not tip over."""
    return Body(name, Shape("box", (0.2, 0.2, 0.05)), 1.0, (0.0, 0.0, z), **fields)  # type: ignore[arg-type]


def _sliding_boxes(step: float, quick: bool) -> Iterator[Case]:
    for speed in (1, 10) if quick else (1, 3, 10, 20):
        for mu in (0.5,) if quick else (0.05, 0.5, 1.0, 2.0):
            body = _box(mu=mu, linear=(float(speed), 0.0, 0.0))
            yield slide(f"box_{speed}mps_mu{mu:g}", f"box, {speed} m/s", (body,), mu).at_step(step)


def _sliding_shapes(step: float, quick: bool) -> Iterator[Case]:
    for speed in (1.0, 3.0, 10.0):
        body = _box(rpy=(0.0, 0.0, math.pi / 6), linear=(speed, 0.0, 0.0))
        yield slide(f"box_turned_{speed:g}mps", "box turned by 30°, 1 to 10 m/s", (body,), body.mu).at_step(step)

    def along(name: str, row: str, shape: Shape, height: float, rpy: Vector = (0.0, 0.0, 0.0)) -> Case:
        body = Body(name, shape, 1.0, (0.0, 0.0, height), rpy, linear=(3.0, 0.0, 0.0))
        return slide(f"{name}_slides", row, (body,), body.mu).at_step(step)

    yield along("mesh_box", "box as a mesh", Shape("mesh_box", (0.2, 0.2, 0.05)), 0.05)
    yield along("puck", "cylinder on its end", Shape("cylinder", (0.2, 0.05)), 0.05)
    yield along("log", "cylinder on its side, along its axis", Shape("cylinder", (0.1, 0.3)), 0.1, ALONG)
    yield along("capsule", "capsule along its axis", Shape("capsule", (0.1, 0.2)), 0.1, ALONG)

    def across(name: str, row: str, shape: Shape, share: float, rpy: Vector, mu: float = 0.5) -> Case:
        body = Body(name, shape, 1.0, (0.0, 0.0, shape.size[0]), rpy, mu=mu, linear=(3.0, 0.0, 0.0))
        return _roll(f"{name}_mu{mu:g}_rolls", f"{row} until it rolls", body, share).at_step(step)

    level = (0.0, 0.0, 0.0)
    for mu in (0.5, 2.0):
        yield across("sphere", "sphere", Shape("sphere", (0.1,)), 5 / 7, level, mu)
    yield across("log", "cylinder on its side", Shape("cylinder", (0.1, 0.3)), 2 / 3, LATERAL)
    yield across("coin", "cylinder on its rim", Shape("cylinder", (0.1, 0.005)), 2 / 3, LATERAL)
    yield across("ellipsoid", "ellipsoid", Shape("ellipsoid", (0.1, 0.2, 0.1)), 5 / 7, level)
    yield _spinning_plate().at_step(step)
    for case in _grounds_and_pairs():
        yield case.at_step(step)


def _spinning_plate() -> Case:
    """A square plate whose four corners carry it: its torque is mu N times half the diagonal."""
    half, mu, rate = 0.2, 0.5, 50.0
    shape = Shape("box", (half, half, 0.01))
    body = Body("plate", shape, 1.0, (0.0, 0.0, 0.01), mu=mu, angular=(0.0, 0.0, rate))
    deceleration = mu * GRAVITY * math.hypot(half, half) / shape.inertia[2]
    slips = rate / deceleration
    measure = Sliding(slips, rate * slips / 2, slips, deceleration, turns=True)
    return Case("plate_50radps", "plate that spins", measure, (body,), duration=1.03 * slips, moves_for=slips)


def _grounds_and_pairs() -> Iterator[Case]:
    fast = (3.0, 0.0, 0.0)
    yield slide("box_on_mesh", "box on a mesh", (_box(linear=fast),), 0.5, ground="mesh")
    yield slide("box_on_heightmap", "box on a height map", (_box(linear=fast),), 0.5, ground="heightmap")
    yield _box_on_plate()
    stack = tuple(_box(f"box_{i}", 0.05 + 0.1 * i, mu=0.6, linear=fast) for i in range(3))
    names = [GROUND, *(body.name for body in stack)]
    pairs = tuple(frozenset(two) for two in pairwise(names))
    slips = fast[0] / (0.3 * GRAVITY)
    measure = Sliding(slips, fast[0] * slips / 2, slips, 0.3 * GRAVITY, omitted=("force", "direction"))
    yield slide(
        "stack_slides", "stack of three boxes that slides", stack, 0.3, ground_mu=0.3, pairs=pairs, measure=measure
    )


def _box_on_plate() -> Case:
    """A box that overtakes a plate of 5 kg, itself moving without friction: momentum is kept."""
    mass, first, plate = 5.0, 4.0, 1.0
    below = Body("plate", Shape("box", (1.5, 1.0, 0.05)), mass, (1.0, 0.0, 0.05), linear=(plate, 0.0, 0.0))
    above = _box(z=0.15, linear=(first, 0.0, 0.0))
    deceleration = 0.5 * GRAVITY * (1 + 1 / mass)
    slips = (first - plate) / deceleration
    last = (first + mass * plate) / (1 + mass)
    return Case(
        "box_on_moving_plate",
        "box on another moving box",
        Sliding(slips, (first - plate) * slips / 2, slips, deceleration, last, reference="plate"),
        (above, below),
        ground_mu=0.0,
        pairs=(frozenset(("box", "plate")),),
        duration=1.03 * slips + 0.02,
        moves_for=slips,
    )


def _pushed_boxes(step: float, quick: bool) -> Iterator[Case]:
    def pushed(r: Record) -> dict[str, float]:
        speed = 2.0 * (6.0 - 0.5 * GRAVITY)
        error = 100.0 * (float(np.linalg.norm(r.linear[-1, 0, :2])) / speed - 1.0)
        return {"contact": 100.0 * float(r.contact.mean()), "hop": _hop(r), "speed": error}

    def held(r: Record) -> dict[str, float]:
        creep = 1e3 * float(np.linalg.norm(r.positions[-1, 0, :2] - r.positions[0, 0, :2]))
        return {"contact": 100.0 * float(r.contact.mean()), "hop": _hop(r), "creep": creep}

    measures: dict[float, Callable[[Record], dict[str, float]]] = {6.0: pushed, 4.8: held}
    for force, measure in measures.items():
        row = f"box pushed with {force:g} N" + (", holds" if measure is held else "")
        push = (force, 0.0, 0.0)
        yield Case(f"push_{force:g}N", row, measure, (_box(),), push=push, duration=2.0, timestep=step)


def _vehicles(step: float, quick: bool) -> Iterator[Case]:
    shapes = {
        "cylinder": Shape("cylinder", (0.1, 0.02)),
        "sphere": Shape("sphere", (0.1,)),
        "mesh": Shape("mesh_cylinder", (0.1, 0.02)),
    }
    chosen = [(kind, mass, 0.7) for kind in ("cylinder", "sphere") for mass in (10.0, 50.0)]
    chosen += [("mesh", 10.0, 0.7), ("cylinder", 10.0, 0.3), ("cylinder", 10.0, 1.0)]

    def turning(r: Record) -> dict[str, float]:
        vehicle, late = r.case.vehicle, r.times >= r.times[-1] - 2.0
        assert vehicle is not None
        rate = float(np.einsum("tj,tj->t", r.rotations[:, 0, :, 2], r.angular[:, 0])[late].mean())
        contact = 100.0 * float(r.contact.mean())
        return {"contact": contact, "hop": _hop(r), "yaw": rate / (vehicle.yaw_rate * vehicle.coulomb)}

    for kind, mass, mu in chosen:
        vehicle = Vehicle(shapes[kind], mass, mu)
        pairs = tuple(frozenset((GROUND, wheel)) for wheel in vehicle.wheels)
        name, row = f"skid_{kind}_{mass:g}kg_mu{mu:g}", f"skid steering, {kind} wheels"
        yield Case(name, row, turning, vehicle=vehicle, pairs=pairs, duration=3.0, timestep=step)


def _pushed_and_driven(step: float, quick: bool) -> Iterator[Case]:
    yield from _pushed_boxes(step, quick)
    yield from _vehicles(step, quick)


SLIDING_BOXES = Table(
    "sliding",
    "Boxes that slide",
    "A box of 1 kg slides on a plane until it stops, beside a = μ g. The worst of four coefficients of "
    "friction (0.05 to 2) and four steps (0.5 to 4 ms).",
    QUANTITIES,
    _sliding_boxes,
    steps=(0.0005, 0.001, 0.002, 0.004),
    engines=BESIDE,
    timed=True,
    headline=("hop", "way"),
)
SLIDING_SHAPES = Table(
    "sliding_shapes",
    "Other shapes and grounds",
    "The same with other shapes, on other grounds and on moving bodies, with a step of 1 ms.",
    QUANTITIES,
    _sliding_shapes,
    engines=BESIDE,
    timed=True,
    is_on_page=False,
)
PUSHED = Table(
    "pushed",
    "Boxes that are pushed, and skid steering",
    "A box of 1 kg, μ 0.5, is pushed for 2 s: with 6 N it moves, with 4.8 N it must not. Vehicles turn on "
    "the spot, beside W² / (W² + L²) of the commanded yaw rate (track W, wheelbase L).",
    {
        "contact": QUANTITIES["contact"],
        "hop": QUANTITIES["hop"],
        "speed": QUANTITIES["speed"],
        "creep": Quantity("creep in 2 s", "mm", 0.02),
        "yaw": Quantity("yaw rate over Coulomb's", "", 0.05, exact=1.0),
    },
    _pushed_and_driven,
    engines=BESIDE,
    timed=True,
    headline=("speed", "creep", "yaw"),
)
