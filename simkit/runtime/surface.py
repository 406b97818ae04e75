"""Surfaces that run while what they belong to stays where it is: conveyor belts and tracks.

A contact with such a surface is held not at rest but at the surface's velocity, up to friction. MuJoCo carries that in
`mjContact.surfacevel`. It is set here for each contact and not once for a geom, since a belt runs round its collision:
what its upper side carries ahead, its lower side carries back, and its ends carry up and down.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.runtime.sliding import solve_sliding

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.integer[Any]]
Point = tuple[float, float, float]

_AFTER_VELOCITIES = int(mujoco.mjtStage.mjSTAGE_VEL)
_FLAT = 1e-6  # sine of an angle below which a normal stands along an axle


@dataclass(frozen=True, slots=True)
class Run:
    """How a belt runs now.

    Attributes:
        speed: [m/s]; a positive one carries what lies on top along x, where x, the axle and up are right-handed.
        centre: of the circle, in the world, that its contacts are carried along [m]; None where it runs straight.
    """

    speed: float
    centre: Point | None = None


@dataclass(frozen=True, slots=True)
class Belt:
    """A surface that can run, in one compiled model.

    Attributes:
        geoms: ids of its geoms.
        body: that they move with.
        axle: unit vector in the body's frame that the belt runs round.
        now: asked in every forward pass, so that it is part of its plugin's state; None while it stands still.
        friction: coefficients along and across its way; None where they are those of the file.
    """

    geoms: tuple[int, ...]
    body: int
    axle: Point
    now: Callable[[], Run | None]
    friction: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Flow:
    """The contacts with running surfaces, k of them.

    Attributes:
        numbers: among the contacts, shape (k,).
        directions: of friction, unit vectors in the world, shape (k, 3).
        velocities: of the second geom's surface less the first's [m/s], world, shape (k, 3).
    """

    numbers: Ints
    directions: Floats
    velocities: Floats


class Surfaces:
    """The belts of a compiled model."""

    def __init__(self, model: Any) -> None:
        self.model = model
        self._belts: list[Belt] = []
        self._owner: Ints = np.full(model.ngeom + 1, -1)  # the last for -1: no geom
        self._flow: Flow | None = None
        self._flow_of: Any = None

    def add(self, belt: Belt) -> None:
        """A belt more."""
        self.model.flg_surfacevel = True
        self._owner[list(belt.geoms)] = len(self._belts)
        self._belts.append(belt)
        self._bodies = np.array([one.body for one in self._belts])
        self._axles = np.array([one.axle for one in self._belts], float)

    @property
    def run(self) -> bool:
        """Whether one of them runs."""
        return any(belt.now() is not None for belt in self._belts)

    def runs(self) -> list[Run | None]:
        """How each of them runs now."""
        return [belt.now() for belt in self._belts]

    # ------------------------------------------------------------------ contacts

    def look(self, data: Any, runs: list[Run | None] | None = None) -> Flow | None:
        """Finds the contacts with belts that run, of data with positions; also for `carry` and `solve`.

        Args:
            data: of the engine.
            runs: how belts run, unless it is as they do now.
        """
        self._flow_of = data
        self._flow = self._found(data, self.runs() if runs is None else runs) if self._belts and data.ncon else None
        return self._flow

    def _found(self, data: Any, runs: Sequence[Run | None]) -> Flow | None:
        if not any(runs):
            return None
        contact = data.contact
        owners = self._owner[contact.geom]
        speeds = np.array([0.0 if run is None else run.speed for run in runs])
        is_ours = owners >= 0
        if None in runs:
            is_ours &= np.array([run is not None for run in runs])[owners]
        numbers = (is_ours.any(axis=1) & (contact.efc_address >= 0) & (contact.dim > 1)).nonzero()[0]
        if not numbers.size:
            return None
        flow = Flow(numbers, np.zeros((numbers.size, 3)), np.zeros((numbers.size, 3)))
        normals, places = contact.frame[numbers, :3], contact.pos[numbers]
        for side, inwards in ((1, 1.0), (0, -1.0)):
            rows = is_ours[numbers, side].nonzero()[0]
            if rows.size:
                belts = owners[numbers[rows], side]
                normal = inwards * normals[rows]
                along = self._along(data, normal, places[rows], belts, runs)
                flow.directions[rows] = along
                flow.velocities[rows] += inwards * speeds[belts][:, None] * along
        return flow

    def _along(self, data: Any, normal: Floats, places: Floats, belts: Ints, runs: Sequence[Run | None]) -> Floats:
        """Which way the belt runs at a contact: unit vectors (k, 3), zero on the flanks.

        Args:
            data: of the engine.
            normal: into the belt, shape (k, 3).
            places: of the contacts, shape (k, 3).
            belts: their numbers, shape (k,).
            runs: of all belts.
        """
        turns = data.xmat[self._bodies[belts]].reshape(-1, 3, 3)
        axles = (turns * self._axles[belts][:, None, :]).sum(axis=2)
        along = _unit(_cross(normal, axles))
        bent: dict[Point, list[int]] = {}  # the tracks of a vehicle have one centre
        for row, number in enumerate(belts.tolist()):
            run = runs[number]
            if run is not None and run.centre is not None:
                bent.setdefault(run.centre, []).append(row)
        for centre, those in bent.items():
            rows = np.array(those)
            circle = _unit(_cross(normal[rows], places[rows] - centre))
            ahead = np.sign((circle * along[rows]).sum(axis=1))
            is_round = (circle != 0.0).any(axis=1)
            along[rows[is_round]] = circle[is_round] * ahead[is_round, None]
        return along

    def carry(self, data: Any) -> None:
        """Gives the contacts found by `look` their surface velocity, in the tangents that they have now."""
        flow = self._flow
        if flow is not None:
            contact, numbers = data.contact, flow.numbers
            tangents = contact.frame[numbers].reshape(-1, 3, 3)[:, 1:]
            contact.surfacevel[numbers, :2] = (tangents * flow.velocities[:, None, :]).sum(axis=2)

    def solve(self, data: Any) -> None:
        """The rest of a forward pass, from velocities that are known; leaves the references of constraints as found."""
        flow = self._flow if data is self._flow_of else self.look(data)
        if flow is None or not solve_sliding(self.model, data, flow.numbers):
            mujoco.mj_forwardSkip(self.model, data, _AFTER_VELOCITIES, 1)


def _cross(a: Floats, b: Floats) -> Floats:
    """Products of vectors (k, 3); `np.cross` takes ten times as long for a few."""
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    return np.array((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)).T


def _unit(vectors: Floats) -> Floats:
    """Vectors (k, 3) of length 1; zero for those that have nearly none."""
    length = np.sqrt((vectors * vectors).sum(axis=1, keepdims=True))
    return np.where(length > _FLAT, vectors / np.maximum(length, _FLAT), 0.0)
