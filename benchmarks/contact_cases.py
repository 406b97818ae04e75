"""Cases of `contact.py` as data: bodies, ground, motion, and the analytic answer of each.

Lengths in m, masses in kg, times in s, angles in rad, forces in N, world frame unless said otherwise; z points up.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

GRAVITY = 9.8
GROUND = "ground"
LATERAL = (math.pi / 2, 0.0, 0.0)  # roll, pitch, yaw: turns a shape's axis from z to y
ALONG = (0.0, math.pi / 2, 0.0)  # turns a shape's axis from z to x

Vector = tuple[float, float, float]
Pair = frozenset[str]


@dataclass(frozen=True)
class Shape:
    """A collision shape about its own centre.

    Attributes:
        kind: "box", "mesh_box", "sphere", "cylinder", "mesh_cylinder", "capsule" or "ellipsoid".
        size: half lengths of a box or ellipsoid along x, y, z; a sphere's radius; radius and half length of a cylinder
            or of a capsule's straight part, whose axis is z.
    """

    kind: str
    size: tuple[float, ...]

    @property
    def inertia(self) -> Vector:
        """Moments of inertia about x, y and z for a mass of 1 kg [m²]."""
        if self.kind in {"box", "mesh_box", "ellipsoid"}:
            x, y, z = (length * length for length in self.size)
            share = 5.0 if self.kind == "ellipsoid" else 3.0
            return (y + z) / share, (x + z) / share, (x + y) / share
        radius = self.size[0]
        if self.kind == "sphere":
            return (0.4 * radius**2,) * 3
        half = self.size[1]
        if self.kind == "capsule":
            straight = half / (half + 2 / 3 * radius)  # share of the mass in the cylinder between the half balls
            ends = 0.4 * radius**2 + half**2 + 0.75 * radius * half
            across = straight * (radius**2 / 4 + half**2 / 3) + (1 - straight) * ends
            return across, across, straight * radius**2 / 2 + (1 - straight) * 0.4 * radius**2
        across = radius**2 / 4 + half**2 / 3
        return across, across, radius**2 / 2


@dataclass(frozen=True)
class Body:
    """A rigid body of uniform density that moves freely.

    Attributes:
        position, rpy: of its centre and axes at the start.
        mu: Coulomb's coefficient; of two surfaces that touch the smaller one counts.
        linear, angular: velocities given to it once it has settled.
    """

    name: str
    shape: Shape
    mass: float
    position: Vector
    rpy: Vector = (0.0, 0.0, 0.0)
    mu: float = 0.5
    linear: Vector = (0.0, 0.0, 0.0)
    angular: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Vehicle:
    """A chassis on four driven wheels, two on each side, asked to turn in place.

    Attributes:
        wheel: shape; its axis is z here and becomes the vehicle's y.
        mass: of all of it; each wheel has `wheel_mass`.
        track, wheelbase: distances between the wheels' centres along y and x.
        yaw_rate: asked of the drive.
    """

    wheel: Shape
    mass: float
    mu: float
    track: float = 0.5
    wheelbase: float = 0.4
    wheel_mass: float = 0.5
    yaw_rate: float = 1.0

    @property
    def radius(self) -> float:
        return self.wheel.size[0]

    @property
    def chassis(self) -> Body:
        shape = Shape("box", (0.25, 0.15, 0.04))
        return Body("chassis", shape, self.mass - 4 * self.wheel_mass, (0.0, 0.0, self.radius), mu=self.mu)

    @property
    def wheels(self) -> dict[str, tuple[float, float]]:
        """Position of each wheel's centre in the chassis, x and y; the left ones have an even number."""
        x, y = self.wheelbase / 2, self.track / 2
        return {"wheel_0": (x, y), "wheel_1": (x, -y), "wheel_2": (-x, y), "wheel_3": (-x, -y)}

    @property
    def coulomb(self) -> float:
        """Share of the asked yaw rate at which the friction of the four wheels balances."""
        return self.track**2 / (self.track**2 + self.wheelbase**2)


@dataclass(frozen=True)
class Case:
    """One motion with its analytic answer.

    Attributes:
        group: cases of one group share a row of the table, which shows the worst of them.
        asks: quantities of `contact_measures.MEASURES` to be found.
        bodies: way, force, direction and speed are the first one's; hops, energy and falls count all.
        duration: time observed after `settle` seconds at rest.
        ground: "plane", "mesh" or "heightmap"; `ground_mu` its coefficient.
        restitution: coefficient of every contact; None where bodies are to stay where they hit.
        push: constant force on the first body's centre while it is observed.
        pairs: contacts that a step must have to count as in contact; the first body's on the ground by default.
        slips: time until the first body stops or rolls without slip.
        reference: body relative to which path and slip of the first one count; the ground by default.
        way: length of the path until `way_time`, or the angle turned.
        way_time: when the path is compared; `way_deceleration` the deceleration until then.
        speed: at the end of the observation.
        stride: steps between two looks.
    """

    name: str
    group: str
    asks: tuple[str, ...]
    bodies: tuple[Body, ...] = ()
    vehicle: Vehicle | None = None
    timestep: float = 0.001
    settle: float = 0.3
    duration: float = 1.0
    ground: str = "plane"
    ground_mu: float = 5.0
    restitution: float | None = None
    push: Vector | None = None
    pairs: tuple[Pair, ...] = ()
    slips: float = math.inf
    reference: str = ""
    way: float = math.nan
    way_time: float = math.nan
    way_deceleration: float = math.nan
    speed: float = math.nan
    stride: int = 1

    @property
    def moving(self) -> tuple[Body, ...]:
        """Every body that moves freely, a vehicle's chassis included."""
        return (self.vehicle.chassis,) if self.vehicle else self.bodies

    @property
    def required(self) -> tuple[Pair, ...]:
        return self.pairs or (frozenset((GROUND, self.moving[0].name)),)


SLIDING = ("contact", "hop", "distance", "force", "direction", "gain")
LONGEST = 3.0  # of an observed slide


def slide(name: str, group: str, bodies: tuple[Body, ...], mu: float, **options: object) -> Case:
    """A body that Coulomb friction brings to rest, or slows down for `LONGEST` seconds."""
    speed = math.hypot(*bodies[0].linear)
    slips = speed / (mu * GRAVITY)
    observed = min(slips, LONGEST)
    fields: dict[str, object] = {
        "duration": 1.03 * slips + 0.02 if slips < LONGEST else LONGEST,
        "slips": slips,
        "way": speed * observed - mu * GRAVITY * observed**2 / 2,
        "way_time": observed,
        "way_deceleration": mu * GRAVITY,
    }
    return Case(name, group, SLIDING, bodies, **(fields | options))  # type: ignore[arg-type]


def roll(name: str, group: str, body: Body, share: float) -> Case:
    """A round body that slides until it rolls at `share` of its first speed."""
    speed = math.hypot(*body.linear)
    slips = (1 - share) * speed / (body.mu * GRAVITY)
    asks = ("contact", "hop", "force", "direction", "speed", "gain")
    return Case(name, group, asks, (body,), slips=slips, duration=1.1 * slips + 0.1, speed=share * speed)


def _box(name: str = "box", z: float = 0.05, **fields: object) -> Body:
    """A flat box of 0.4 by 0.4 by 0.1 m, 1 kg: up to mu 4 it does not tip over."""
    return Body(name, Shape("box", (0.2, 0.2, 0.05)), 1.0, (0.0, 0.0, z), **fields)  # type: ignore[arg-type]


def sliding_boxes() -> Iterator[Case]:
    for speed in (1, 3, 10, 20):
        for mu in (0.05, 0.5, 1.0, 2.0):
            for step in (0.0005, 0.001, 0.002, 0.004):
                name = f"box_{speed}mps_mu{mu:g}_{step * 1e3:g}ms"
                body = _box(mu=mu, linear=(float(speed), 0.0, 0.0))
                yield slide(name, f"box, {speed} m/s", (body,), mu, timestep=step)
    for turned_speed in (1.0, 3.0, 10.0):
        body = _box(rpy=(0.0, 0.0, math.pi / 6), linear=(turned_speed, 0.0, 0.0))
        yield slide(f"box_turned_{turned_speed:g}mps", "box turned by 30°, 1 to 10 m/s", (body,), body.mu)


def sliding_shapes() -> Iterator[Case]:
    def along(name: str, shape: Shape, height: float, rpy: Vector = (0.0, 0.0, 0.0)) -> Case:
        body = Body(name, shape, 1.0, (0.0, 0.0, height), rpy, linear=(3.0, 0.0, 0.0))
        return slide(f"{name}_slides", title[name], (body,), body.mu)

    title = {
        "mesh_box": "box as a mesh",
        "puck": "cylinder on its end",
        "log": "cylinder on its side, along its axis",
        "capsule": "capsule along its axis",
    }
    yield along("mesh_box", Shape("mesh_box", (0.2, 0.2, 0.05)), 0.05)
    yield along("puck", Shape("cylinder", (0.2, 0.05)), 0.05)
    yield along("log", Shape("cylinder", (0.1, 0.3)), 0.1, ALONG)
    yield along("capsule", Shape("capsule", (0.1, 0.2)), 0.1, ALONG)

    def across(name: str, title: str, shape: Shape, share: float, rpy: Vector, mu: float = 0.5) -> Case:
        body = Body(name, shape, 1.0, (0.0, 0.0, shape.size[0]), rpy, mu=mu, linear=(3.0, 0.0, 0.0))
        return roll(f"{name}_mu{mu:g}_rolls", title, body, share)

    level = (0.0, 0.0, 0.0)
    for mu in (0.5, 2.0):
        yield across("sphere", "sphere until it rolls", Shape("sphere", (0.1,)), 5 / 7, level, mu)
    yield across("log", "cylinder on its side until it rolls", Shape("cylinder", (0.1, 0.3)), 2 / 3, LATERAL)
    yield across("coin", "cylinder on its rim until it rolls", Shape("cylinder", (0.1, 0.005)), 2 / 3, LATERAL)
    yield across("ellipsoid", "ellipsoid until it rolls", Shape("ellipsoid", (0.1, 0.2, 0.1)), 5 / 7, level)


def spinning_plate() -> Iterator[Case]:
    """A square plate whose four corners carry it: its torque is mu N times half the diagonal."""
    half, mu, rate = 0.2, 0.5, 50.0
    shape = Shape("box", (half, half, 0.01))
    body = Body("plate", shape, 1.0, (0.0, 0.0, 0.01), mu=mu, angular=(0.0, 0.0, rate))
    deceleration = mu * GRAVITY * math.hypot(half, half) / shape.inertia[2]
    slips = rate / deceleration
    yield Case(
        "plate_50radps",
        "plate that spins",
        ("contact", "hop", "angle", "gain"),
        (body,),
        duration=1.03 * slips,
        slips=slips,
        way=rate * slips / 2,
        way_time=slips,
        way_deceleration=deceleration,
    )


def grounds_and_pairs() -> Iterator[Case]:
    fast = (3.0, 0.0, 0.0)
    yield slide("box_on_mesh", "box on a mesh", (_box(linear=fast),), 0.5, ground="mesh")
    yield slide("box_on_heightmap", "box on a height map", (_box(linear=fast),), 0.5, ground="heightmap")
    yield _box_on_plate()
    stack = tuple(_box(f"box_{i}", 0.05 + 0.1 * i, mu=0.6, linear=fast) for i in range(3))
    names = [GROUND, *(body.name for body in stack)]
    pairs = tuple(frozenset(two) for two in pairwise(names))
    case = slide("stack_slides", "stack of three boxes that slides", stack, 0.3, ground_mu=0.3, pairs=pairs)
    yield replace(case, asks=("contact", "hop", "distance", "gain"))


def _box_on_plate() -> Case:
    """A box that overtakes a plate of 5 kg, itself moving without friction: momentum is kept."""
    mass, first, plate = 5.0, 4.0, 1.0
    below = Body("plate", Shape("box", (1.5, 1.0, 0.05)), mass, (1.0, 0.0, 0.05), linear=(plate, 0.0, 0.0))
    above = _box(z=0.15, linear=(first, 0.0, 0.0))
    deceleration = 0.5 * GRAVITY * (1 + 1 / mass)
    slips = (first - plate) / deceleration
    asks = ("contact", "hop", "distance", "force", "direction", "speed", "gain")
    return Case(
        "box_on_moving_plate",
        "box on another moving box",
        asks,
        (above, below),
        ground_mu=0.0,
        pairs=(frozenset(("box", "plate")),),
        reference="plate",
        duration=1.03 * slips + 0.02,
        slips=slips,
        way=(first - plate) * slips / 2,
        way_time=slips,
        way_deceleration=deceleration,
        speed=(first + mass * plate) / (1 + mass),
    )


def pushed_boxes() -> Iterator[Case]:
    pushed, held = (6.0, 0.0, 0.0), (4.8, 0.0, 0.0)
    speed = 2.0 * (pushed[0] - 0.5 * GRAVITY)
    asks = ("contact", "hop", "speed")
    yield Case("push_6N", "box pushed with 6 N", asks, (_box(),), push=pushed, duration=2.0, speed=speed)
    asks = ("contact", "hop", "creep")
    yield Case("push_4.8N", "box pushed with 4.8 N, holds", asks, (_box(),), push=held, duration=2.0, speed=0.0)


def skidding_vehicles() -> Iterator[Case]:
    shapes = {
        "cylinder": Shape("cylinder", (0.1, 0.02)),
        "sphere": Shape("sphere", (0.1,)),
        "mesh": Shape("mesh_cylinder", (0.1, 0.02)),
    }
    chosen = [(kind, mass, 0.7) for kind in ("cylinder", "sphere") for mass in (10.0, 50.0)]
    chosen += [("mesh", 10.0, 0.7), ("cylinder", 10.0, 0.3), ("cylinder", 10.0, 1.0)]
    for kind, mass, mu in chosen:
        vehicle = Vehicle(shapes[kind], mass, mu)
        pairs = tuple(frozenset((GROUND, wheel)) for wheel in vehicle.wheels)
        name, group = f"skid_{kind}_{mass:g}kg_mu{mu:g}", f"skid steering, {kind} wheels"
        yield Case(name, group, ("contact", "hop", "yaw"), vehicle=vehicle, pairs=pairs, duration=3.0)


def impacts() -> Iterator[Case]:
    for share in (0.2, 0.5, 0.8, 1.0):
        speed = 3.0
        height = speed**2 / (2 * GRAVITY)
        ball = Body("ball", Shape("sphere", (0.1,)), 1.0, (0.0, 0.0, 0.1 + height))
        flights = sum(2 * speed / GRAVITY * share**i for i in range(1, 11))
        duration = speed / GRAVITY + flights + 0.2
        asks = ("restitution", "bounce_gain")
        group = f"ball with restitution {share:g}"
        yield Case(f"bounce_{share:g}", group, asks, (ball,), settle=0.0, duration=duration, restitution=share)
    for step in (0.001, 0.002):
        cube = Body("imu", Shape("box", (0.025,) * 3), 0.1, (0.0, 0.0, 0.1), linear=(0.0, 0.0, -5.5))
        name, group = f"drop_{step * 1e3:g}ms", "cube of 5 cm dropped at 5.5 m/s"
        yield Case(name, group, ("rebound", "rest"), (cube,), settle=0.0, duration=1.2, timestep=step)


def loads(longest: float) -> Iterator[Case]:
    cube = Shape("box", (0.05,) * 3)
    for mass in (1e2, 1e3, 1e4):
        light, heavy = (Body(n, cube, m, (0.0, 0.0, z)) for n, m, z in (("light", 1.0, 0.05), ("heavy", mass, 0.15)))
        group = f"cube of 1 kg under {mass:g} kg"
        yield Case(f"load_{mass:g}kg", group, ("sink",), (light, heavy), settle=0.0, duration=2.0, stride=10)
    tower = tuple(Body(f"cube_{i}", cube, 1e3 if i % 2 else 1.0, (0.0, 0.0, 0.05 + 0.1 * i)) for i in range(10))
    asks = ("stands", "sink")
    yield Case("tower", "ten cubes, 1 and 1000 kg", asks, tower, settle=0.0, duration=longest, stride=10)


def all_cases(longest: float = 10.0) -> list[Case]:
    """Every case in the order of the table.

    Args:
        longest: time for which the tower is watched.
    """
    makers = (sliding_boxes, sliding_shapes, spinning_plate, grounds_and_pairs, pushed_boxes, skidding_vehicles)
    return [case for make in (*makers, impacts) for case in make()] + list(loads(longest))
