"""Cases of `contact.py` in which a body hits the ground: oblique hits, bounces and drops."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from contact_engines import quaternion
from contact_record import Floats, Record, matrices
from contact_scene import GRAVITY, LATERAL, Body, Case, Quantity, Shape, Table, Vector
from scipy.spatial.transform import Rotation

from simkit.linear_algebra import matmul

SPEED = 4.0  # of the centre before an oblique hit [m/s]
WATCHED = 0.05  # time observed after an oblique hit [s]
STOPPED = 0.02  # share of the closing speed below which a contact no longer closes
BOUNCES = 10
SLOWEST_BOUNCE = 0.1  # speed after a bounce below which it is not counted [m/s]
STILL = 0.01  # speed of a body at rest [m/s]

Motion = tuple[float, float, float]  # velocities along x and z, angular velocity about y


class UndecidedHitError(Exception):
    """The slip reverses during the hit, so that laws of impact differ."""


def rigid_hit(before: Motion, arm: tuple[float, float], gyration: float, mu: float, bounce: float = 0.0) -> Motion:
    """Return the motion after a plane hit of a rigid body on rigid ground with Coulomb friction.

    The impulses per mass are p_n along z and p_t along x. The contact's velocity along z becomes -e times the one
    before. If |p_t| <= mu p_n can stop the slip, the slip is zero afterwards; else p_t = -mu p_n against the slip.

    Args:
        before: velocities of the centre along x and z [m/s], angular velocity about y [rad/s].
        arm: contact point from the centre, along x and z [m].
        gyration: moment of inertia about y for 1 kg [m²].
        mu: coefficient of friction.
        bounce: coefficient of restitution e.

    Raises:
        UndecidedHitError: the slip would reverse.
    """
    vx, vz, w = before
    rx, rz = arm
    slip, closing = vx + w * rz, vz - w * rx
    tangent, normal, mixed = 1 + rz * rz / gyration, 1 + rx * rx / gyration, -rx * rz / gyration
    # change of slip = tangent p_t + mixed p_n; change of closing = mixed p_t + normal p_n
    wanted = -(1 + bounce) * closing
    determinant = tangent * normal - mixed * mixed
    pt = (-slip * normal - wanted * mixed) / determinant
    pn = (wanted * tangent + slip * mixed) / determinant
    if abs(pt) > mu * pn:
        side = math.copysign(1.0, slip)
        pn = wanted / (normal - mixed * mu * side)
        pt = -mu * side * pn
        if pn < 0 or (slip + tangent * pt + mixed * pn) * side < 0:
            raise UndecidedHitError
    return vx + pt, vz + pn, w + (rz * pt - rx * pn) / gyration


@dataclass(frozen=True)
class Hit:
    """The measure of an oblique hit: the first motion after it in which the contact no longer closes.

    Attributes:
        after: motion after the hit.
        gyration: moment of inertia about y for 1 kg [m²].
        closing: speed at which the contact closes before it [m/s].
        bounces: whether the body leaves the ground.
    """

    after: Motion
    gyration: float
    closing: float
    bounces: bool

    def __call__(self, r: Record) -> dict[str, float]:
        vertical = r.linear[:, 0, 2] + _lowest_rise(r)
        touched = np.maximum.accumulate(r.linear[:, 0] != r.linear[0, 0]).any(1)
        stopped = vertical > (0.0 if self.bounces else -STOPPED * self.closing)
        if self.bounces:
            stopped &= r.lowest[:, 0] > 0.0
        looks = np.flatnonzero(touched & stopped)
        look = int(looks[0]) if looks.size else -1
        found = (*r.linear[look, 0, [0, 2]].tolist(), float(r.angular[look, 0, 1]))
        weights = (1.0, 1.0, self.gyration)
        off = sum(w * (a - b) ** 2 for w, a, b in zip(weights, found, self.after, strict=True))
        return {"error": 100.0 * math.sqrt(off) / SPEED}


def _lowest_rise(r: Record) -> Floats:
    """Velocity of the body's lowest point along z relative to its centre [m/s], shape (t + 1,)."""
    arms = np.stack([_arm(r.case.bodies[0].shape, turn) for turn in r.rotations[:, 0]])
    rise: Floats = -r.angular[:, 0, 1] * arms[:, 0]
    return rise


def _arm(shape: Shape, turn: Floats) -> tuple[float, float]:
    """Lowest point of a turned shape from its centre, along x and z; the middle one of several [m]."""
    down = -turn[2]  # in the shape's axes
    if shape.kind == "box":
        sides = np.where(np.abs(down) < 1e-6, 0.0, np.sign(down))
        local = sides * shape.size
    elif shape.kind == "sphere":
        local = down * shape.size[0]
    else:
        radius, half = shape.size
        end = 0.0 if abs(down[2]) < 1e-6 else math.copysign(half, down[2])
        if shape.kind == "capsule":
            local = down * radius + (0.0, 0.0, end)
        else:
            across = math.hypot(down[0], down[1])
            round_part = down[:2] * (radius / across) if across > 1e-6 else np.zeros(2)
            local = np.array((*round_part, end))
    world = matmul(turn, local)
    return float(world[0]), float(world[2])


@dataclass(frozen=True)
class _Thrown:
    """A shape with its attitude at a hit; `flat` if a face stays on the ground."""

    row: str
    shape: Shape
    rpy: Vector = (0.0, 0.0, 0.0)
    flat: bool = False
    restitution: float | None = None


_CUBE = Shape("box", (0.05, 0.05, 0.05))
_CORNER = tuple(Rotation.from_euler("zy", (45, 40), degrees=True).as_euler("xyz").tolist())  # a corner at y = 0
THROWN = {
    "ball": _Thrown("ball", Shape("sphere", (0.1,))),
    "box_face": _Thrown("box on a face", Shape("box", (0.1, 0.1, 0.05)), flat=True),
    "box_edge": _Thrown("box on an edge, 20°", _CUBE, (0.0, math.radians(20), 0.0)),
    "box_corner": _Thrown("box on a corner, 40°", _CUBE, _CORNER),
    "rod": _Thrown("rod on its end, 45°", Shape("capsule", (0.01, 0.2)), (0.0, math.pi / 4, 0.0)),
    "cylinder": _Thrown("cylinder on its side", Shape("cylinder", (0.05, 0.1)), LATERAL),
    "rim": _Thrown("cylinder on its rim, 25°", Shape("cylinder", (0.05, 0.1)), (0.0, math.radians(25), 0.0)),
    "plate": _Thrown("plate on its face", Shape("box", (0.15, 0.15, 0.01)), flat=True),
    "ball_e0.01": _Thrown("ball, e = 0.01", Shape("sphere", (0.1,)), restitution=0.01),
    "ball_e0.5": _Thrown("ball, e = 0.5", Shape("sphere", (0.1,)), restitution=0.5),
}


def hit(name: str, thrown: _Thrown, mu: float, angle: float, step: float) -> Case:
    """One oblique hit without gravity; the first contact comes in the middle of a step.

    Raises:
        UndecidedHitError: there is no single reference.
    """
    vx, vz = SPEED * math.cos(math.radians(angle)), -SPEED * math.sin(math.radians(angle))
    bounce = thrown.restitution or 0.0
    turn = _turn_of(thrown)
    arm = _arm(thrown.shape, turn)
    about_y = float((turn[1] ** 2 * thrown.shape.inertia).sum())
    if thrown.flat:  # both ends of the face carry, and the body does not turn: a centre below which it is hit
        after = (*rigid_hit((vx, vz, 0.0), (0.0, 0.0), about_y, mu, bounce)[:2], 0.0)
    else:
        after = rigid_hit((vx, vz, 0.0), arm, about_y, mu, bounce)
    gap = -2.5 * step * vz
    body = Body("body", thrown.shape, 1.0, (0.0, 0.0, -arm[1] + gap), thrown.rpy, mu, (vx, 0.0, vz))
    return Case(
        f"hit_{name}_mu{mu:g}_{angle:g}deg",
        thrown.row,
        Hit(after, about_y, -vz, bounces=bounce > 0),
        (body,),
        timestep=step,
        settle=0.0,
        duration=WATCHED + 3 * step,
        gravity=0.0,
        restitution=thrown.restitution,
    )


def _turn_of(thrown: _Thrown) -> Floats:
    return matrices(np.array(quaternion(thrown.rpy)))


def _hits(step: float, quick: bool) -> Iterator[Case]:
    for name, thrown in THROWN.items():
        for mu in (0.3,) if quick else (0.1, 0.3, 0.6, 1.0):
            for angle in (45.0,) if quick else (10.0, 30.0, 45.0, 60.0, 80.0):
                try:
                    yield hit(name, thrown, mu, angle, step)
                except UndecidedHitError:
                    continue


def flights(r: Record) -> list[float]:
    """Speeds at which the ball would pass the ground level, one of each flight between two contacts [m/s]."""
    height = r.lowest[:, 0] - r.linear[:, 0, 2] * r.case.timestep / 2
    energy = r.linear[:, 0, 2] ** 2 / 2 + GRAVITY * height
    aloft = np.concatenate(((True,), ~r.contact))
    edges = np.flatnonzero(np.diff(np.concatenate(((False,), aloft, (False,))).astype(int)))
    runs = [(a, b) for a, b in zip(edges[::2], edges[1::2], strict=True) if b - a > 2]
    return [math.sqrt(max(0.0, 2.0 * float(np.median(energy[a:b])))) for a, b in runs]


def _bouncing(r: Record) -> dict[str, float]:
    wanted = r.case.restitution or 0.0
    speeds = flights(r)[: BOUNCES + 1]
    found = np.array([b / a for a, b in pairwise(speeds) if a * wanted > SLOWEST_BOUNCE])
    errors = 100.0 * (found / wanted - 1.0)
    worst = float(errors[np.abs(errors).argmax()]) if found.size else -100.0
    return {"restitution": worst, "bounce_gain": max(0.0, 100.0 * float((found**2).max(initial=0.0) - 1.0))}


def _dropped(r: Record) -> dict[str, float]:
    first = int(r.contact.argmax())
    moves = np.flatnonzero(r.speeds[:, 0] > STILL)
    rebound = 100.0 * float(r.linear[first:, 0, 2].max()) / abs(r.case.bodies[0].linear[2])
    return {"rebound": rebound, "rest": float(r.times[moves[-1]] - r.times[first])}


def _bounces(step: float, quick: bool) -> Iterator[Case]:
    for share in (0.5,) if quick else (0.2, 0.5, 0.8, 1.0):
        speed = 3.0
        ball = Body("ball", Shape("sphere", (0.1,)), 1.0, (0.0, 0.0, 0.1 + speed**2 / (2 * GRAVITY)))
        duration = speed / GRAVITY + sum(2 * speed / GRAVITY * share**i for i in range(1, 11)) + 0.2
        row = f"ball with restitution {share:g}"
        yield Case(
            f"bounce_{share:g}",
            row,
            _bouncing,
            (ball,),
            settle=0.0,
            duration=duration,
            restitution=share,
            timestep=step,
        )
    cube = Body("imu", Shape("box", (0.025,) * 3), 0.1, (0.0, 0.0, 0.1), linear=(0.0, 0.0, -5.5))
    for drop_step in (step, 2 * step):
        name, row = f"drop_{drop_step * 1e3:g}ms", "cube of 5 cm dropped at 5.5 m/s"
        yield Case(name, row, _dropped, (cube,), settle=0.0, duration=1.2, timestep=drop_step)


Measure = Callable[[Record], dict[str, float]]

HITS = Table(
    "hits",
    "Oblique hits",
    "A body without spin hits a plane at 4 m/s, without gravity. Error of the motion after the hit [%], "
    "beside a rigid body with Coulomb's friction: the worst of four coefficients of friction (0.1 to 1) "
    "and five angles to the ground (10° to 80°). Without e in the row, e is 0. Hits in which the slip "
    "would reverse are left out.",
    {"error": Quantity("error", "%", 3.0)},
    _hits,
    steps=(0.004, 0.002, 0.001, 0.0005, 0.00025, 0.0001),
    quick_steps=(0.004, 0.001, 0.00025),
    by_step=True,
)
BOUNCES_AND_DROPS = Table(
    "bounces",
    "Bounces and drops",
    "A ball falls from 0.46 m and bounces ten times. A cube of 0.1 kg hits the ground at 5.5 m/s, at 1 and 2 ms.",
    {
        "restitution": Quantity("worst of ten bounces", "%", 2.0),
        "bounce_gain": Quantity("energy gained by a bounce", "%", 0.05),
        "rebound": Quantity("rebound", "%", 1.0),
        "rest": Quantity("time to rest", "s", 0.16),
    },
    _bounces,
    engines=("simkit", "MuJoCo's law", "PyBullet"),
    headline=("restitution", "bounce_gain", "rebound", "rest"),
)
