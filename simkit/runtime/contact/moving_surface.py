"""Surfaces that move while their body stays: conveyor belts and tracks.

Friction drives a contact with such a surface to the velocity of the surface, not to rest. MuJoCo has
`mjContact.surfacevel` for it. The velocity is set for each contact and not once for a geom, because a belt runs round
its collision. Its upper side moves ahead, its lower side moves back, and its ends move up and down. Many contacts are
processed on arrays, with the same bits as on plain numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from simkit.runtime.contact.friction_contacts import (
    AnyFrictionContacts,
    Floats,
    FrictionContactArrays,
    FrictionContacts,
    Ints,
    Numbers,
)

if TYPE_CHECKING:
    import mujoco

Point = tuple[float, float, float]

ZERO_VECTOR: Point = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class BeltMotion:
    """Present motion of a belt.

    Attributes:
        speed: speed [m/s]. A positive speed carries objects on top along x, where x, the axle and up are right-handed.
        centre: centre of the circle along which the belt moves objects [m], world frame; None for straight motion.
    """

    speed: float
    centre: Point | None = None


BeltMotions = Sequence[BeltMotion | None]
"""Present motions of several belts; None for a stopped belt."""


@dataclass(frozen=True, slots=True)
class Belt:
    """Moving surface in one compiled model.

    Attributes:
        geoms: ids of its geoms.
        body: body of the geoms.
        axle: unit vector of the belt's axle in the body's frame.
        now: function that returns the present motion; None while the belt is stopped. Every forward pass calls it, so
            that the motion is part of the plugin's state.
        friction: coefficients along and across the motion; None for those of the file.
    """

    geoms: tuple[int, ...]
    body: int
    axle: Point
    now: Callable[[], BeltMotion | None]
    friction: tuple[float, float] | None = None


class BeltContacts(NamedTuple):
    """Contacts with moving surfaces, k of them.

    Attributes:
        numbers: indices among the engine's contacts.
        places: indices among the contacts that were searched.
        directions: unit vectors of friction, world frame.
        velocities: velocity of the second geom's surface minus the first's [m/s], world frame.
    """

    numbers: list[int]
    places: list[int]
    directions: list[Point]
    velocities: list[Point]


class BeltContactArrays(NamedTuple):
    """Contacts with moving surfaces as arrays; see `BeltContacts`."""

    numbers: Ints
    places: Ints
    directions: Floats
    velocities: Floats


BeltFlow = BeltContacts | BeltContactArrays


class MovingSurfaces:
    """Belts of a compiled model.

    Attributes:
        concerns: True for each geom of a belt; the last item is for index -1, no geom.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model = model
        self._belts: list[Belt] = []
        self._owner = [-1] * (model.ngeom + 1)
        self.concerns = [False] * (model.ngeom + 1)
        self._owners: Ints = np.array(self._owner)
        self._flow: BeltFlow | None = None

    def add(self, belt: Belt) -> None:
        """Add a belt."""
        self.model.flg_surfacevel = True
        for geom in belt.geoms:
            self._owner[geom], self.concerns[geom] = len(self._belts), True
        self._belts.append(belt)
        self._owners = np.array(self._owner)

    @property
    def run(self) -> bool:
        """True if a belt is moving."""
        return any(belt.now() is not None for belt in self._belts)

    def runs(self) -> list[BeltMotion | None]:
        """Return the present motion of each belt."""
        return [belt.now() for belt in self._belts]

    # ------------------------------------------------------------------ contacts

    def look(self, data: mujoco.MjData, contacts: AnyFrictionContacts | None, runs: BeltMotions) -> BeltFlow | None:
        """Find the contacts with moving belts and store them for `carry`.

        Args:
            data: MuJoCo's data with positions.
            contacts: contacts that may be with belts.
            runs: motions of the belts.
        """
        if contacts is None or not any(runs):
            self._flow = None
        elif isinstance(contacts, FrictionContacts):
            self._flow = self._find(data, contacts, runs)
        else:
            self._flow = self._find_many(data, contacts, runs)
        return self._flow

    def _find_many(
        self, data: mujoco.MjData, contacts: FrictionContactArrays, runs: BeltMotions
    ) -> BeltContactArrays | None:
        axles = [
            ZERO_VECTOR if run is None else _world_axle(data, belt) for belt, run in zip(self._belts, runs, strict=True)
        ]
        points = data.contact.pos[contacts.numbers]
        places, directions, velocities = find_belt_contacts(
            self._owners[contacts.geoms], contacts.frames, points, runs, axles
        )
        return BeltContactArrays(contacts.numbers[places], places, directions, velocities) if places.size else None

    def _find(self, data: mujoco.MjData, contacts: FrictionContacts, runs: BeltMotions) -> BeltContacts | None:
        owner, flow = self._owner, BeltContacts([], [], [], [])
        axles: dict[int, Point] = {}
        known: dict[
            tuple[int, int, float, float, float], tuple[Point, Point]
        ] = {}  # all contacts of a flat object on a straight belt have one normal
        for place, (first, second) in enumerate(contacts.geoms):
            this, other = owner[first], owner[second]
            into = runs[other] if other >= 0 else None
            out = runs[this] if this >= 0 else None
            if into is None and out is None:
                continue
            nx, ny, nz = contacts.frames[place][:3]
            key = this, other, nx, ny, nz
            both = known.get(key)
            if both is None:
                belts = [(b, r, sign) for b, r, sign in ((other, into, 1.0), (this, out, -1.0)) if r is not None]
                is_bent = any(run.centre is not None for _, run, _ in belts)
                point = data.contact.pos[contacts.numbers[place]].tolist() if is_bent else ZERO_VECTOR
                both = self._motion(data, belts, (nx, ny, nz), point, axles)
                if not is_bent:
                    known[key] = both
            flow.numbers.append(contacts.numbers[place])
            flow.places.append(place)
            flow.directions.append(both[0])
            flow.velocities.append(both[1])
        return flow if flow.numbers else None

    def _motion(
        self,
        data: mujoco.MjData,
        belts: Sequence[tuple[int, BeltMotion, float]],
        normal: Point,
        place: Sequence[float],
        axles: dict[int, Point],
    ) -> tuple[Point, Point]:
        """Return the direction of friction and the velocity [m/s] at a contact with one or two belts.

        Args:
            data: MuJoCo's data.
            belts: numbers, motions and signs; the sign is 1 for a normal into the belt, -1 for a normal out of it.
            normal: unit normal of the contact.
            place: position of the contact [m].
            axles: known axles in the world frame, by belt.
        """
        direction, (vx, vy, vz) = ZERO_VECTOR, ZERO_VECTOR
        for belt, run, inwards in belts:
            if belt not in axles:
                axles[belt] = _world_axle(data, self._belts[belt])
            into = inwards * normal[0], inwards * normal[1], inwards * normal[2]
            direction = _unit(_cross(into, axles[belt]))
            if run.centre is not None:
                direction = _circular_direction(direction, into, place, run.centre)
            speed, (dx, dy, dz) = inwards * run.speed, direction
            vx, vy, vz = vx + speed * dx, vy + speed * dy, vz + speed * dz
        return direction, (vx, vy, vz)

    def carry(self, data: mujoco.MjData, frames: Sequence[Numbers] | Floats) -> None:
        """Set the surface velocity of the contacts that `look` found.

        Args:
            data: MuJoCo's data.
            frames: present frames of all searched contacts.
        """
        flow = self._flow
        if flow is None:
            return
        surface = data.contact.surfacevel
        if isinstance(flow, BeltContactArrays):
            those: slice | Ints = slice(None) if len(flow.places) == len(surface) else flow.numbers
            surface[those, :2] = along_tangents(np.asarray(frames)[flow.places], flow.velocities)
            return
        for number, place, (x, y, z) in zip(flow.numbers, flow.places, flow.velocities, strict=True):
            _, _, _, ax, ay, az, bx, by, bz = frames[place]
            surface[number, 0] = ax * x + ay * y + az * z
            surface[number, 1] = bx * x + by * y + bz * z


def _world_axle(data: mujoco.MjData, belt: Belt) -> Point:
    """Return the axle of a belt in the world frame."""
    a, b, c, d, e, f, g, h, i = data.xmat[belt.body].tolist()
    x, y, z = belt.axle
    return a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z


def _circular_direction(along: Point, normal: Point, place: Sequence[float], centre: Point) -> Point:
    """Return the direction of rotation about a centre that does not oppose the linear motion.

    The linear direction is returned if there is no rotation.
    """
    (x, y, z), (cx, cy, cz) = place, centre
    circle = _unit(_cross(normal, (x - cx, y - cy, z - cz)))
    if circle == ZERO_VECTOR:
        return along
    (rx, ry, rz), (ax, ay, az) = circle, along
    over = rx * ax + ry * ay + rz * az
    ahead = math.copysign(1.0, over) if over else 0.0
    return rx * ahead, ry * ahead, rz * ahead


def _cross(a: Point, b: Point) -> Point:
    (ax, ay, az), (bx, by, bz) = a, b
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


def _unit(vector: Point) -> Point:
    """Return the unit vector; zero for a vector of nearly no length."""
    x, y, z = vector
    length = math.sqrt(x * x + y * y + z * z)
    return (x / length, y / length, z / length) if length > MIN_SINE else ZERO_VECTOR


Bools = npt.NDArray[np.bool_]

MIN_SINE = 1e-6
"""Sine of the angle below which a normal is parallel to an axle."""


def find_belt_contacts(
    belts: Ints, frames: Floats, points: Floats, runs: BeltMotions, axles: Sequence[Point]
) -> tuple[Ints, Floats, Floats]:
    """Return the contacts with moving belts, their directions of friction, and their velocities.

    Args:
        belts: belt numbers on both sides, shape (k, 2); -1 for none.
        frames: normal (from the first side to the second) and tangents of each contact, shape (k, 9).
        points: positions [m], world frame, shape (k, 3).
        runs: motions of the belts.
        axles: axles of the belts, unit vectors in the world frame; any vector for a stopped belt.

    Returns:
        Indices (m,) among the contacts, directions (m, 3) and velocities [m/s] (m, 3) in the world frame.
    """
    does_run = np.array([run is not None for run in (*runs, None)])  # the last item is for index -1
    active: Bools = does_run[belts]
    places = (active[:, 0] | active[:, 1]).nonzero()[0]
    normals, axle = frames[places, :3], np.array(axles)
    speed = np.array([0.0 if run is None else run.speed for run in runs])
    bends = [run is not None and run.centre is not None for run in runs]
    is_bent = np.array(bends)
    centre = np.array([(0.0,) * 3 if run is None or run.centre is None else run.centre for run in runs])
    directions, velocities = np.zeros((2, places.size, 3))
    for side, inwards in ((1, 1.0), (0, -1.0)):
        those = active[places, side].nonzero()[0]
        if not those.size:
            continue
        belt, into = belts[places[those], side], inwards * normals[those]
        along = unit(cross(into, axle[belt]))
        if any(bends):
            bent = is_bent[belt].nonzero()[0]
            away = points[places[those[bent]]] - centre[belt[bent]]
            along[bent] = _circular_directions(along[bent], into[bent], away)
        directions[those] = along
        velocities[those] += (inwards * speed[belt])[:, None] * along
    return places, directions, velocities


def _circular_directions(along: Floats, normal: Floats, away: Floats) -> Floats:
    """Return the directions of rotation about centres that do not oppose the linear motions (k, 3).

    The linear direction is returned where there is no rotation.
    """
    circle = unit(cross(normal, away))
    over = dot(circle, along)
    ahead = np.where(over == 0.0, 0.0, np.copysign(1.0, over))
    is_none = (circle == 0.0).all(axis=1, keepdims=True)
    return np.where(is_none, along, circle * ahead[:, None])


def cross(a: Floats, b: Floats) -> Floats:
    """Return the cross products (k, 3)."""
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    return np.stack((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx), axis=1)


def dot(a: Floats, b: Floats) -> Floats:
    """Return the scalar products (k,)."""
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    products: Floats = ax * bx + ay * by + az * bz
    return products


def unit(vectors: Floats) -> Floats:
    """Return the unit vectors (k, 3); zero for vectors of nearly no length."""
    length = np.sqrt(dot(vectors, vectors))[:, None]
    return np.where(length > MIN_SINE, vectors / np.maximum(length, MIN_SINE), 0.0)


def along_tangents(frames: Floats, vectors: Floats) -> Floats:
    """Return the components (k, 2) of vectors (k, 3) along the tangents of frames (k, 9)."""
    return np.stack((dot(frames[:, 3:6], vectors), dot(frames[:, 6:], vectors)), axis=1)


def rotate_frames(frames: Floats, wanted: Floats, upright: float) -> tuple[Floats, Bools]:
    """Return contact frames (k, 9) whose first tangent follows a direction, and a mask of the rotated frames.

    Args:
        frames: present frames; a frame stays unchanged if its direction is perpendicular to the surface.
        wanted: directions in the world frame (k, 3).
        upright: least squared fraction of a direction that must lie along the surface.
    """
    normal = frames[:, :3]
    flat = wanted - dot(wanted, normal)[:, None] * normal
    square = dot(flat, flat)
    lies: Bools = square > upright * dot(wanted, wanted)
    first = flat / np.where(lies, np.sqrt(square), 1.0)[:, None]
    turned: Floats = np.hstack((normal, first, cross(normal, first)))
    return np.where(lies[:, None], turned, frames), lies


def rotate_surface_velocities(flows: Floats, before: Floats, after: Floats) -> Floats:
    """Convert surface velocities (k, 3) from the tangents of some frames (k, 9) to those of others."""
    over = flows[:, :1] * before[:, 3:6] + flows[:, 1:2] * before[:, 6:]
    return np.hstack((along_tangents(after, over), flows[:, 2:]))
