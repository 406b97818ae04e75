"""Contacts whose normal reference the contact law corrects, on arrays; `contact_correction` on plain numbers."""

from __future__ import annotations

from typing import Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.runtime.contact.anderson_acceleration import AndersonAcceleration
from simkit.runtime.contact.contact_conditions import (
    CLOSING_ACCURACY,
    CLOSING_SPEED,
    DEEP_PENETRATION,
    EXIT_SPEED,
    LIFT_FACTOR,
    MIN_PENETRATION,
    NO_FORCE,
    OPENING_SPEED,
    ContactConditions,
    rebound,
)

_PYRAMID: Final = mujoco.mjtCone.mjCONE_PYRAMIDAL

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.integer[Any]]


class ArrayContactCorrection:
    """Contacts under either cone, on arrays.

    Args:
        data: of the engine.
        is_pyramid: whether the cone is one.
        rows: of each contact, the row of its normal, or the first of its edges, shape (k,).
        places: the rows of its friction, shape (k, most), or pairs of edges, shape (k, most, 2).
        mu: their coefficients, zero for rows that it has not or that do not slide, shape (k, most).
        edges: the rows that carry the normal, shape (k, n); rows that a contact has not repeat its first.
        normals, goals, rebounds, tolerances: as for `ContactCorrection`, shape (k,).
        changed: as for `ContactCorrection`.
    """

    def __init__(
        self,
        data: mujoco.MjData,
        is_pyramid: bool,
        rows: Ints,
        places: Ints,
        mu: Floats,
        edges: Ints,
        normals: Floats,
        goals: Floats,
        rebounds: npt.NDArray[np.bool_],
        tolerances: Floats,
        changed: list[tuple[int, float]],
    ) -> None:
        self._aref, self._softness, self._is_pyramid = data.efc_aref, data.efc_R, is_pyramid
        self._rows, self._places, self._mu, self._edges, self._normals = rows, places, mu, edges, normals
        self._goals, self._rebounds, self._tolerances, self._changed = goals, rebounds, tolerances, changed
        self._has_goal = ~np.isnan(goals)
        self._before: Floats = self._aref[edges]
        self._tangents: Floats = self._before
        self._compliance: Floats = self._softness[places]
        self._asked: Floats = normals
        self._sequence = AndersonAcceleration()

    def guess(self, moves: Floats) -> None:
        """As `FewContacts.guess`."""
        self._tangents = self._aref[self._places]
        normals = np.where(self._has_goal, self._goals, self._normals)
        self._ask(normals - self._size(self._tangents - moves[self._places]))

    def correct(self, moves: Floats, forces: Floats) -> bool:
        """As `FewContacts.correct`."""
        places = self._places
        size = self._size(self._tangents - moves[places] - self._compliance * forces[places])
        normals, most = self._normals, self._tolerances
        if self._has_goal.any():
            yields = (self._softness[self._edges] * forces[self._edges]).mean(axis=1)
            wanted = self._goals + yields
            limited = np.where(normals < self._goals, np.maximum(normals, wanted), np.minimum(normals, wanted))
            normals = np.where(self._has_goal, np.where(self._rebounds, wanted, limited), normals)
            most = np.where(self._has_goal, np.maximum(most, CLOSING_ACCURACY * self._goals), most)
        now = normals - size
        if (np.abs(now - self._asked) <= most).all():
            return True
        now = np.array(self._sequence.next(self._asked.tolist(), now.tolist()))
        self._ask(now)
        return False

    def settle(self) -> None:
        """As `FewContacts.settle`."""
        if self._sequence.has_come_near(float(self._tolerances[0])):
            self._ask(np.array(self._sequence.best))
        else:
            self.restore()

    def restore(self) -> None:
        """Put the references back as they were."""
        self._aref[self._edges] = self._before
        for row, reference in self._changed:
            self._aref[row] = reference

    def _ask(self, normals: Floats) -> None:
        self._asked = normals
        changes = self._before + (normals - self._normals)[:, None]
        self._aref[self._edges] = changes if self._is_pyramid else normals[:, None]

    def _size(self, residual: Floats) -> Floats:
        return _lift(residual, self._mu, self._is_pyramid)


def _lift(residual: Floats, mu: Floats, is_pyramid: bool) -> Floats:
    """Return by how much a contact is lifted for residuals along its friction rows or pairs of edges (k,) [m/s²]."""
    if is_pyramid:
        apart = np.abs(residual[..., 0] - residual[..., 1]) / 2.0
        found: Floats = np.where(mu > 0.0, apart, 0.0).max(axis=1, initial=0.0)
        return found
    total: Floats = np.zeros(len(mu))
    for one in (mu * residual).T:
        total += one * one
    lengths: Floats = np.sqrt(total)
    return lengths


def find_array_correction(
    model: mujoco.MjModel, data: mujoco.MjData, around: ContactConditions, residual: Floats | None = None
) -> ArrayContactCorrection | None:
    """As `find_correction`, for either cone."""
    contact, is_pyramid, step = data.contact, bool(model.opt.cone == _PYRAMID), around.step
    numbers = (contact.efc_address >= 0).nonzero()[0]
    if not numbers.size:
        return None
    which: slice | Ints = slice(None) if numbers.size == data.ncon else numbers
    rows, dims = contact.efc_address[which], contact.dim[which]
    most = int(dims.max()) - 1
    there = np.arange(most) < (dims - 1)[:, None]
    mu = np.where(there, contact.friction[which, :most], 0.0)
    if is_pyramid:
        pairs = rows[:, None, None] + np.arange(2 * most).reshape(most, 2)
        places = np.where(there[..., None], pairs, rows[:, None, None])
        edges = places.reshape(len(rows), -1) if most else rows[:, None]
    else:
        places, edges = np.where(there, rows[:, None] + 1 + np.arange(most), rows[:, None]), rows[:, None]
    aref, velocity = data.efc_aref, data.efc_vel
    pair = edges[:, :2] if is_pyramid else edges
    normals, speed = aref[pair], velocity[pair]
    normals, speed = (normals.mean(axis=1), speed.mean(axis=1)) if is_pyramid else (normals[:, 0], speed[:, 0])
    depth, closes = -contact.dist[which], speed < CLOSING_SPEED
    after = speed
    if around.closing is not None:
        geoms = np.array(around.closing)[contact.geom[which]]
        left = geoms[:, 0] + geoms[:, 1]
        after = np.where(closes & (speed < -left), speed + left, speed)
    is_late = closes & (normals < -after / step)
    wanted = np.where(is_late, -after / step, np.maximum(0.0, (EXIT_SPEED - after) / step))
    is_fast = (normals > wanted) & (closes | (speed > OPENING_SPEED) | (depth > DEEP_PENETRATION))
    constants = contact.solref[which, 0]
    is_rigid, bounces = (constants > 0.0) & (constants <= around.softest), constants <= 0.0
    goals = np.where(np.where(is_late, depth >= 0.0, is_fast) & is_rigid, wanted, np.nan)
    if around.inner:
        goals = np.where(np.isin(numbers, list(around.inner)), NO_FORCE, goals)
    changed: list[tuple[int, float]] = []
    for index in (closes & bounces).nonzero()[0].tolist():
        goals[index], slower = rebound(data, int(numbers[index]), float(speed[index]), around)
        if goals[index] == goals[index]:
            middle = normals[index] if is_pyramid else 0.0
            for row in places[index][there[index]].reshape(-1).tolist():
                changed.append((row, aref.item(row)))
                aref[row] = middle + slower * (aref[row] - middle)
    tolerances: Floats = np.full(len(rows), around.tolerance)
    pressed = (depth > MIN_PENETRATION).nonzero()[0]
    if pressed.size:
        impedance = data.efc_KBIP[rows[pressed], 2]
        tolerances[pressed] = np.minimum(
            around.tolerance, LIFT_FACTOR * around.tolerance * (1.0 - impedance) / impedance
        )
    slides: npt.NDArray[np.bool_] = _lift((aref if residual is None else residual)[places], mu, is_pyramid) > tolerances
    slides &= goals != NO_FORCE
    chosen = slides | ~np.isnan(goals)
    if not chosen.any():
        return None
    mu = np.where(slides[:, None], mu, 0.0)[chosen]
    rest = (edges[chosen], normals[chosen], goals[chosen], bounces[chosen], tolerances[chosen], changed)
    return ArrayContactCorrection(data, is_pyramid, rows[chosen], places[chosen], mu, *rest)
