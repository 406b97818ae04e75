"""Data of `contact.py`: shapes, bodies, hinges, cases and tables.

Lengths in m, masses in kg, times in s, angles in rad, forces in N, world frame unless said otherwise; z points up.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from contact_record import Record

GRAVITY = 9.8
GROUND = "ground"
LATERAL = (math.pi / 2, 0.0, 0.0)  # roll, pitch, yaw: turns a shape's axis from z to y
ALONG = (0.0, math.pi / 2, 0.0)  # turns a shape's axis from z to x

Vector = tuple[float, float, float]
Pair = frozenset[str]
Found = Mapping[str, float]  # by the key of the quantity


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
    """A rigid body of uniform density.

    Attributes:
        position, rpy: of its centre and axes at the start.
        mu: Coulomb's coefficient; of two surfaces that touch the smaller one counts.
        linear, angular: velocities given to it once it has settled, angular in the world's axes.
        gyration: moments of inertia for 1 kg [m²] where the density is not uniform.
        touches: False for a body without a collision shape.
    """

    name: str
    shape: Shape
    mass: float
    position: Vector
    rpy: Vector = (0.0, 0.0, 0.0)
    mu: float = 0.5
    linear: Vector = (0.0, 0.0, 0.0)
    angular: Vector = (0.0, 0.0, 0.0)
    gyration: Vector | None = None
    touches: bool = True

    @property
    def inertia(self) -> Vector:
        """Moments of inertia about the body's axes [kg m²]."""
        x, y, z = self.gyration or self.shape.inertia
        return self.mass * x, self.mass * y, self.mass * z


@dataclass(frozen=True)
class Hinge:
    """A joint without friction that turns `child` about an axis; the bodies that it joins have `rpy` zero.

    Attributes:
        parent: name of a body, or "" for the world.
        anchor: point of the axis at the start.
        rate: speed at the start [rad/s].
    """

    child: str
    parent: str
    anchor: Vector
    axis: Vector
    rate: float = 0.0


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
    """One motion and the measure that is taken of it.

    Attributes:
        row: cases of one row of the table are combined.
        measure: computes the quantities of the table from the recorded motion.
        bodies: those that move; blocks those that do not.
        duration: time observed after `settle` seconds at rest.
        ground: "plane", "mesh", "heightmap" or "none"; `ground_mu` its coefficient.
        restitution: coefficient of every contact; None where bodies are to stay where they hit.
        push: constant force on the first body's centre while it is observed.
        pairs: contacts that a step must have to count as in contact; the first body's on the ground by default.
        moves_for: time until the first body stops or rolls; no more steps than these are timed.
        stride: steps between two looks.
    """

    name: str
    row: str
    measure: Callable[[Record], Found]
    bodies: tuple[Body, ...] = ()
    blocks: tuple[Body, ...] = ()
    hinges: tuple[Hinge, ...] = ()
    vehicle: Vehicle | None = None
    timestep: float = 0.001
    settle: float = 0.3
    duration: float = 1.0
    gravity: float = GRAVITY
    ground: str = "plane"
    ground_mu: float = 5.0
    restitution: float | None = None
    push: Vector | None = None
    pairs: tuple[Pair, ...] = ()
    moves_for: float = math.inf
    stride: int = 1

    @property
    def moving(self) -> tuple[Body, ...]:
        """Every body whose state is recorded, a vehicle's chassis included."""
        return (self.vehicle.chassis,) if self.vehicle else self.bodies

    @property
    def required(self) -> tuple[Pair, ...]:
        return self.pairs or (frozenset((GROUND, self.moving[0].name)),)

    @property
    def friction(self) -> float:
        """Coefficient between the bodies, for engines that combine two coefficients in another way.

        Raises:
            ValueError: the bodies have several coefficients.
        """
        (mu,) = {body.mu for body in self.moving}
        return mu

    @property
    def hinged(self) -> tuple[Body, ...]:
        """Bodies at a hinge, parents before children."""
        by_name = {body.name: body for body in self.bodies}
        return tuple(by_name[hinge.child] for hinge in self.hinges)

    def at_step(self, step: float) -> Case:
        """The same case with another time step."""
        return replace(self, timestep=step)


@dataclass(frozen=True)
class Quantity:
    """One number of a table.

    Attributes:
        aim: largest error aimed at, or the smallest value where `more` is better; None where there is no aim.
        exact: value without any error.
        mean: whether a row shows the mean of its cases, and not the worst of them.
        beside: whether a cell also shows the ratio to the value of MuJoCo's law.
    """

    title: str
    unit: str = ""
    aim: float | None = None
    more: bool = False
    exact: float = 0.0
    mean: bool = False
    beside: bool = False

    def error(self, value: float) -> float:
        """Distance from the exact value, of an error only the harmful side."""
        return max(0.0, self.exact - value) if self.more else abs(value - self.exact)


@dataclass(frozen=True)
class Table:
    """Cases that are shown together.

    Attributes:
        text: what the rows are and what they are compared with, in Markdown.
        quantities: by the key that a measure gives.
        cases: makes the cases for a step; the second argument asks for a quick choice of them.
        steps: time steps [s]; `quick_steps` those of a quick run.
        engines: names of the engines that run them.
        by_step: a column for each step, instead of a column for each quantity.
        timed: whether the time of a step is measured as well, the engines in turn.
        headline: quantities that the page shows, of a table without `by_step`; without any, it shows all.
        is_on_page: whether the page has the table.
    """

    name: str
    title: str
    text: str
    quantities: Mapping[str, Quantity]
    cases: Callable[[float, bool], Iterator[Case]]
    steps: tuple[float, ...] = (0.001,)
    quick_steps: tuple[float, ...] = (0.001,)
    engines: tuple[str, ...] = ("simkit", "MuJoCo's law", "PyBullet", "Drake", "DART")
    by_step: bool = False
    timed: bool = False
    headline: tuple[str, ...] = ()
    is_on_page: bool = True
