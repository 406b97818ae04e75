"""Measures of `contact.py`: one motion is recorded, and each quantity is computed from it and its analytic answer.

Forces are not asked of the engines: friction and normal force are what changed a body's velocity in a step. Energies
take the height half way through the step, which makes the engines' integrator exact in free flight; what a soft contact
stores is not counted, so a landing returns some of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from contact_cases import GRAVITY, Case, Shape
from contact_engines import DivergedError, Engine

Floats = npt.NDArray[np.float64]
WHEN = 0.98  # share of the time until a body stops or rolls in which it counts as sliding
LEAST_LOAD = 0.05  # share of the weight below which a step's normal force says nothing about friction
BOUNCES = 10
SLOWEST_BOUNCE = 0.1  # speed after a bounce below which it is not counted [m/s]
STILL = 0.01  # speed of a body at rest [m/s]
FALLEN = 0.05  # displacement of a cube of a tower that counts as a fall [m]


@dataclass(frozen=True)
class Record:
    """A case's motion in one engine; the first of t + 1 looks is the state at the start.

    Attributes:
        times: [s], shape (t + 1,).
        positions, linear: of the n bodies, shape (t + 1, n, 3).
        rotations: body to world, shape (t + 1, n, 3, 3).
        rates: angular velocity in the body's axes, shape (t + 1, n, 3).
        contact: whether the required pairs pressed on each other in each step, shape (t,).
    """

    case: Case
    times: Floats
    positions: Floats
    rotations: Floats
    linear: Floats
    rates: Floats
    contact: npt.NDArray[np.bool_]

    @property
    def lowest(self) -> Floats:
        """Height of each body's lowest point, shape (t + 1, n)."""
        extents = [extent(body.shape, self.rotations[:, i, 2]) for i, body in enumerate(self.case.moving)]
        return self.positions[..., 2] - np.stack(extents, axis=1)

    @property
    def energy(self) -> Floats:
        """Kinetic and potential energy of all bodies [J], less the potential energy at the start."""
        masses = np.array([body.mass for body in self.case.moving])
        inertias = masses[:, None] * np.array([body.shape.inertia for body in self.case.moving])
        height = self.positions[..., 2] - self.positions[0, :, 2] - self.linear[..., 2] * self.case.timestep / 2
        moving = masses * (self.linear**2).sum(2) + (inertias * self.rates**2).sum(2)
        energy: Floats = (moving / 2 + masses * GRAVITY * height).sum(1)
        return energy

    @property
    def relative(self) -> tuple[Floats, Floats]:
        """Horizontal path and velocity of the first body relative to the reference."""
        path, speed = self.positions[:, 0, :2] - self.positions[0, 0, :2], self.linear[:, 0, :2]
        if self.case.reference:
            other = [body.name for body in self.case.moving].index(self.case.reference)
            path = path - (self.positions[:, other, :2] - self.positions[0, other, :2])
            speed = speed - self.linear[:, other, :2]
        return path, speed


def extent(shape: Shape, down: Floats) -> Floats:
    """Return how far a shape reaches from its centre along directions that are given in its axes, shape (t, 3)."""
    size, down = shape.size, np.abs(down)
    if shape.kind in {"box", "mesh_box"}:
        flat: Floats = down @ np.array(size)
        return flat
    if shape.kind == "ellipsoid":
        oval: Floats = np.linalg.norm(down * size, axis=1)
        return oval
    if shape.kind == "sphere":
        return np.full(len(down), size[0])
    if shape.kind == "capsule":
        return size[0] + size[1] * down[:, 2]
    reach: Floats = size[0] * np.hypot(down[:, 0], down[:, 1]) + size[1] * down[:, 2]
    return reach


def record(engine: Engine, case: Case) -> Record:
    """Settle, start and observe a case in one engine."""
    engine.settle(round(case.settle / case.timestep))
    engine.start()
    required = set(case.required)
    looks = max(1, round(case.duration / case.timestep / case.stride))
    states, contact = [engine.state()], np.zeros(looks, bool)
    for look in range(looks):
        engine.advance(case.stride)
        contact[look] = required <= engine.pressed()
        states.append(engine.state())
    if engine.has_diverged():
        raise DivergedError(case.name)
    all_states: Floats = np.stack(states)
    rotations = _matrices(all_states[..., 3:7])
    rates = all_states[..., 10:13]
    if not engine.local_rates:
        rates = np.einsum("tnji,tnj->tni", rotations, rates)
    times: Floats = np.arange(looks + 1) * (case.timestep * case.stride)
    return Record(case, times, all_states[..., :3], rotations, all_states[..., 7:10], rates, contact)


def _matrices(quaternions: Floats) -> Floats:
    """Rotation matrices, shape (..., 3, 3), of quaternions w, x, y, z."""
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _contact(r: Record) -> float:
    sliding = r.times[1:] <= WHEN * r.case.slips
    return 100.0 * float(r.contact[sliding].mean())


def _hop(r: Record) -> float:
    return 1e3 * float((r.lowest - r.lowest[0]).max())


def _beside_integrator(r: Record, found: float) -> float:
    """Error of a way [%] beyond a dt/2 per second of slowing down by a, which is the integrator's."""
    case = r.case
    own = case.way_deceleration * case.way_time * case.timestep / 2
    return 100.0 * ((found + own) / case.way - 1.0)


def integrator_share(case: Case) -> float:
    """Error of the way [%] that the engines' integrator makes by itself."""
    return -100.0 * case.way_deceleration * case.way_time * case.timestep / 2 / case.way


def _distance(r: Record) -> float:
    way = np.linalg.norm(r.relative[0], axis=1)
    return _beside_integrator(r, float(np.interp(r.case.way_time, r.times, way)))


def _angle(r: Record) -> float:
    rates = np.einsum("tj,tj->t", r.rotations[:, 0, 2], r.rates[:, 0])
    turned = np.concatenate(((0.0,), np.cumsum(rates[1:]))) * r.case.timestep
    return _beside_integrator(r, float(np.interp(r.case.way_time, r.times, turned)))


def _friction(r: Record) -> tuple[Floats, Floats, Floats]:
    """Friction and normal force by mass, and the velocity of slip, in the steps that slide and carry weight."""
    gained = np.diff(r.linear[:, 0], axis=0) / r.case.timestep
    normal = gained[:, 2] + GRAVITY
    velocity = r.relative[1]
    slip = (velocity[1:] + velocity[:-1]) / 2
    fast = np.linalg.norm(slip, axis=1) > 0.05 * np.linalg.norm(slip[0])
    chosen = (r.times[1:] <= WHEN * r.case.slips) & (normal > LEAST_LOAD * GRAVITY) & fast
    return gained[chosen, :2], normal[chosen], slip[chosen]


def _force(r: Record) -> float:
    friction, normal, _ = _friction(r)
    if not normal.size:
        return math.nan
    mu = r.case.moving[0].mu
    return 100.0 * (float(np.median(np.linalg.norm(friction, axis=1) / (mu * normal))) - 1.0)


def _direction(r: Record) -> float:
    friction, _, slip = _friction(r)
    if not len(slip):
        return math.nan
    across = friction[:, 0] * slip[:, 1] - friction[:, 1] * slip[:, 0]
    angles = np.degrees(np.abs(np.arctan2(across, -(friction * slip).sum(1))))
    return float(np.percentile(angles, 95))


def _speed(r: Record) -> float:
    return 100.0 * (float(np.linalg.norm(r.linear[-1, 0, :2])) / r.case.speed - 1.0)


def _creep(r: Record) -> float:
    return 1e3 * float(np.linalg.norm(r.positions[-1, 0, :2] - r.positions[0, 0, :2]))


def _gain(r: Record) -> float:
    energy = r.energy
    return 100.0 * float((energy - np.minimum.accumulate(energy)).max() / energy[0])


def _yaw(r: Record) -> float:
    assert r.case.vehicle is not None
    late = r.times >= r.times[-1] - 2.0
    rate = float(np.einsum("tj,tj->t", r.rotations[:, 0, 2], r.rates[:, 0])[late].mean())
    return rate / (r.case.vehicle.yaw_rate * r.case.vehicle.coulomb)


def flights(r: Record) -> list[float]:
    """Speeds at which the ball would pass the ground level, one of each flight between two contacts [m/s]."""
    height = r.lowest[:, 0] - r.linear[:, 0, 2] * r.case.timestep / 2
    energy = r.linear[:, 0, 2] ** 2 / 2 + GRAVITY * height
    aloft = np.concatenate(((True,), ~r.contact))
    edges = np.flatnonzero(np.diff(np.concatenate(((False,), aloft, (False,))).astype(int)))
    runs = [(a, b) for a, b in zip(edges[::2], edges[1::2], strict=True) if b - a > 2]
    return [math.sqrt(max(0.0, 2.0 * float(np.median(energy[a:b])))) for a, b in runs]


def _bounces(r: Record) -> Floats:
    speeds = flights(r)[: BOUNCES + 1]
    wanted = r.case.restitution or 0.0
    pairs = [(a, b) for a, b in pairwise(speeds) if a * wanted > SLOWEST_BOUNCE]
    return np.array([b / a for a, b in pairs])


def _restitution(r: Record) -> float:
    found = _bounces(r)
    if not found.size:
        return -100.0
    errors = 100.0 * (found / (r.case.restitution or 1.0) - 1.0)
    return float(errors[np.abs(errors).argmax()])


def _bounce_gain(r: Record) -> float:
    """Greatest rise of energy by a bounce [%]."""
    return max(0.0, 100.0 * float((_bounces(r) ** 2).max(initial=0.0) - 1.0))


def _rebound(r: Record) -> float:
    first = int(r.contact.argmax())
    return 100.0 * float(r.linear[first:, 0, 2].max()) / abs(r.case.bodies[0].linear[2])


def _rest(r: Record) -> float:
    moves = np.flatnonzero(np.linalg.norm(r.linear[:, 0], axis=1) > STILL)
    return float(r.times[moves[-1]] - r.times[int(r.contact.argmax())])


def _sink(r: Record) -> float:
    return 1e3 * float(r.positions[0, -1, 2] - r.positions[-1, -1, 2])


def _stands(r: Record) -> float:
    moved = np.linalg.norm(r.positions - r.positions[0], axis=2).max(1)
    fallen = np.flatnonzero(~(moved < FALLEN))
    return float(r.times[fallen[0]]) if fallen.size else float(r.times[-1])


@dataclass(frozen=True)
class Measure:
    """One quantity.

    Attributes:
        aim: largest absolute value aimed at, or the smallest value where `more` is better.
        exact: value without any error.
    """

    title: str
    unit: str
    aim: float
    find: Callable[[Record], float]
    more: bool = False
    exact: float = 0.0

    def error(self, value: float) -> float:
        """Distance from the exact value, of an error only the harmful side."""
        return max(0.0, self.exact - value) if self.more else abs(value - self.exact)

    @property
    def allowed(self) -> float:
        """Error aimed at."""
        return self.exact - self.aim if self.more else self.aim


MEASURES = {
    "contact": Measure("steps in contact", "%", 99.0, _contact, more=True, exact=100.0),
    "hop": Measure("hop", "mm", 0.05, _hop),
    "distance": Measure("distance, beyond v·dt/2", "%", 1.0, _distance),
    "angle": Measure("angle turned, beyond ω·dt/2", "%", 1.0, _angle),
    "force": Measure("friction over μN", "%", 1.0, _force),
    "direction": Measure("direction of friction", "°", 1.0, _direction),
    "gain": Measure("energy gained", "%", 0.05, _gain),
    "speed": Measure("last speed", "%", 1.0, _speed),
    "creep": Measure("creep in 2 s", "mm", 0.02, _creep),
    "yaw": Measure("yaw rate over Coulomb's", "", 0.05, _yaw, exact=1.0),
    "restitution": Measure("worst of ten bounces", "%", 2.0, _restitution),
    "bounce_gain": Measure("energy gained by a bounce", "%", 0.05, _bounce_gain),
    "rebound": Measure("rebound", "%", 1.0, _rebound),
    "rest": Measure("time to rest", "s", 0.16, _rest),
    "sink": Measure("sinks", "mm", 1.0, _sink),
    "stands": Measure("stands for", "s", 10.0, _stands, more=True, exact=10.0),
}
