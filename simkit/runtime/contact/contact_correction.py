"""Correction of the normal references of contacts by the contact law, on plain numbers or arrays.

`ArrayContactCorrection` is the same law on arrays, with the same bits. Plain numbers are faster for up to about 60
contacts: an array of four numbers costs as much as one of four hundred.
"""

from __future__ import annotations

import math
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

Floats = npt.NDArray[np.float64]


CorrectedContact = tuple[int, list[float], float, float, bool, float]
"""Contact whose normal reference is corrected.

- Row of the normal.
- Friction coefficients; empty if the contact does not slide.
- Reference of the normal [m/s²].
- Requested acceleration along the normal [m/s²]; NaN keeps the reference.
- True for an exact rebound.
- Tolerance of the reference [m/s²].
"""


class ContactCorrection:
    """Contacts under the elliptic cone, on plain numbers.

    Args:
        data: MuJoCo's data.
        contacts: corrected contacts; see `CorrectedContact`.
        changed: other changed rows with their previous references.
    """

    def __init__(self, data: mujoco.MjData, contacts: list[CorrectedContact], changed: list[tuple[int, float]]) -> None:
        self._data, self._aref, self._contacts, self._changed = data, data.efc_aref, contacts, changed
        self._before: list[float] = []
        self._softness: list[float] = []
        self._requested: list[float] = []
        self._sequence: AndersonAcceleration | None = None

    def guess(self, moves: Floats) -> None:
        """Set references from an estimate of J a (Jacobian times acceleration), before any forces are known.

        Args:
            moves: estimate of J a, shape (nefc,).
        """
        accelerations, aref, requested = moves.tolist(), self._aref, self._requested
        self._before = before = aref.tolist()
        for row, mus, normal, goal, _, _ in self._contacts:
            if len(mus) == 2:  # unrolled for the usual two tangents: saves a third of the loop's time
                one = mus[0] * (before[row + 1] - accelerations[row + 1])
                other = mus[1] * (before[row + 2] - accelerations[row + 2])
                total = one * one + other * other
            else:
                total = 0.0
                for place, mu in enumerate(mus, row + 1):
                    one = mu * (before[place] - accelerations[place])
                    total += one * one
            now = (normal if goal != goal else goal) - math.sqrt(total)
            aref[row] = now
            requested.append(now)

    def correct(self, moves: Floats, forces: Floats) -> bool:
        """Set references from a solution; return True if they stay within the tolerances.

        Args:
            moves: J a of the solution, shape (nefc,).
            forces: constraint forces of the solution, shape (nefc,).
        """
        accelerations, force, before, softness = moves.tolist(), forces.tolist(), self._before, self._softness
        if not softness:
            self._softness = softness = self._data.efc_R.tolist()
        results, stays = [], True
        for (row, mus, normal, goal, rebounds, most), last in zip(self._contacts, self._requested, strict=True):
            if len(mus) == 2:
                place = row + 1
                one = mus[0] * (before[place] - accelerations[place] - softness[place] * force[place])
                place = row + 2
                other = mus[1] * (before[place] - accelerations[place] - softness[place] * force[place])
                total = one * one + other * other
            else:
                total = 0.0
                for place, mu in enumerate(mus, row + 1):
                    one = mu * (before[place] - accelerations[place] - softness[place] * force[place])
                    total += one * one
            if goal == goal:
                # a closing contact may get a larger reference, so that it stops; an opening contact only a smaller one
                wanted = goal + softness[row] * force[row]
                normal = wanted if rebounds else max(normal, wanted) if normal < goal else min(normal, wanted)
                most = max(most, CLOSING_ACCURACY * goal)
            now = normal - math.sqrt(total)
            results.append(now)
            if abs(now - last) > most:
                stays = False
        if not stays:
            if self._sequence is None:
                self._sequence = AndersonAcceleration()
            self._requested, aref = self._sequence.next(self._requested, results), self._aref
            for (row, _, _, _, _, _), now in zip(self._contacts, self._requested, strict=True):
                aref[row] = now
        return stays

    def settle(self) -> None:
        """Use the references with the smallest residual, or the engine's references if this residual is large."""
        if self._sequence is not None and not self._sequence.has_come_near(self._contacts[0][5]):
            self.restore()
        elif self._sequence is not None:
            for (row, _, _, _, _, _), best in zip(self._contacts, self._sequence.best, strict=True):
                self._aref[row] = best

    def restore(self) -> None:
        """Restore the previous references."""
        aref = self._aref
        for row, _, normal, _, _, _ in self._contacts:
            aref[row] = normal
        for row, reference in self._changed:
            aref[row] = reference


def find_correction(
    data: mujoco.MjData, around: ContactConditions, residual: Floats | None = None
) -> ContactCorrection | None:
    """Return the contacts that slide, close or open fast, or overlap; None if there are none.

    Args:
        data: MuJoCo's data with velocities up to date and an elliptic cone.
        around: step, gravity and tolerance.
        residual: aref - J a - R f of a solution, shape (nefc,), for contacts that only begin to slide. Without it, the
            velocity decides whether a contact slides.
    """
    contact, step, closing, inner = data.contact, around.step, around.closing, around.inner
    all_rows, dims, friction = contact.efc_address.tolist(), contact.dim.tolist(), contact.friction.tolist()
    aref, velocity = data.efc_aref.tolist(), data.efc_vel.tolist()
    slip: list[float] = aref if residual is None else residual.tolist()
    distance: list[float] = contact.dist.tolist()
    found: list[CorrectedContact] = []
    changed: list[tuple[int, float]] = []
    nothing, square = math.nan, around.tolerance * around.tolerance
    for number, row in enumerate(all_rows):
        if row < 0:
            continue
        if number in inner:
            found.append((row, [], aref[row], NO_FORCE, False, around.tolerance))
            continue
        dim, mus = dims[number], friction[number]
        if dim == 3:
            one, other = mus[0] * slip[row + 1], mus[1] * slip[row + 2]
            total = one * one + other * other
        else:
            total = 0.0
            for place in range(1, dim):
                one = mus[place - 1] * slip[row + place]
                total += one * one
        speed, depth = velocity[row], -distance[number]
        # neither closing nor opening: the most frequent case
        if CLOSING_SPEED <= speed <= OPENING_SPEED and depth <= MIN_PENETRATION:
            if total > square:
                found.append((row, mus[: dim - 1], aref[row], nothing, False, around.tolerance))
            continue
        normal, goal, after, rebounds = aref[row], nothing, speed, False
        closes, tolerance = speed < CLOSING_SPEED, around.tolerance
        if closes and closing is not None:  # a geom that is stopped before the surface still approaches it slowly
            first, second = contact.geom[number].tolist()
            left = closing[first] + closing[second]
            after = speed + left if speed < -left else speed
        if closes and normal < -after / step:
            wanted, is_wrong = -after / step, depth >= 0.0
        else:
            wanted = max(0.0, (EXIT_SPEED - after) / step)
            is_wrong = normal > wanted and (closes or speed > OPENING_SPEED or depth > DEEP_PENETRATION)
        if is_wrong or closes:
            constant = contact.solref.item(number, 0)
            if constant > 0.0:
                goal = wanted if is_wrong and constant <= around.softest else nothing
            elif closes:
                goal, slower = rebound(data, number, speed, around)
                if goal == goal:
                    rebounds = True
                    total *= slower * slower
                    for place in range(row + 1, row + dim):
                        changed.append((place, aref[place]))
                        data.efc_aref[place] = slower * aref[place]
        if depth > MIN_PENETRATION:  # the impedance of a deep contact is near 1: less lift opens it
            impedance = data.efc_KBIP.item(row, 2)
            tolerance = min(tolerance, LIFT_FACTOR * tolerance * (1.0 - impedance) / impedance)
        if total > tolerance * tolerance or (goal == goal and not closes):  # bodies slide as they separate
            found.append((row, mus[: dim - 1], normal, goal, rebounds, tolerance))
        elif goal == goal:
            found.append((row, [], normal, goal, rebounds, tolerance))
    return ContactCorrection(data, found, changed) if found else None


_PYRAMID: Final = mujoco.mjtCone.mjCONE_PYRAMIDAL

Ints = npt.NDArray[np.integer[Any]]


class ArrayContactCorrection:
    """Contacts under either cone, on arrays.

    Args:
        data: MuJoCo's data.
        is_pyramid: True for the pyramidal cone.
        rows: row of the normal of each contact, or the first of its edges, shape (k,).
        places: rows of the friction, shape (k, most), or pairs of edges, shape (k, most, 2).
        mu: coefficients of these rows, shape (k, most); zero for missing rows and for contacts that do not slide.
        edges: rows that carry the normal, shape (k, n); missing rows repeat the first one.
        normals: references of the normals [m/s²], shape (k,), as in `ContactCorrection`.
        goals: requested accelerations [m/s²] or NaN, shape (k,), as in `ContactCorrection`.
        rebounds: True for exact rebounds, shape (k,), as in `ContactCorrection`.
        tolerances: tolerances of the references [m/s²], shape (k,), as in `ContactCorrection`.
        changed: other changed rows with their previous references.
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
        self._requested: Floats = normals
        self._sequence = AndersonAcceleration()

    def guess(self, moves: Floats) -> None:
        """Set references as `ContactCorrection.guess` does."""
        self._tangents = self._aref[self._places]
        normals = np.where(self._has_goal, self._goals, self._normals)
        self._set_references(normals - _lift(self._tangents - moves[self._places], self._mu, self._is_pyramid))

    def correct(self, moves: Floats, forces: Floats) -> bool:
        """Set references as `ContactCorrection.correct` does."""
        places = self._places
        residual = self._tangents - moves[places] - self._compliance * forces[places]
        size = _lift(residual, self._mu, self._is_pyramid)
        normals, most = self._normals, self._tolerances
        if self._has_goal.any():
            yields = (self._softness[self._edges] * forces[self._edges]).mean(axis=1)
            wanted = self._goals + yields
            limited = np.where(normals < self._goals, np.maximum(normals, wanted), np.minimum(normals, wanted))
            normals = np.where(self._has_goal, np.where(self._rebounds, wanted, limited), normals)
            most = np.where(self._has_goal, np.maximum(most, CLOSING_ACCURACY * self._goals), most)
        now = normals - size
        if (np.abs(now - self._requested) <= most).all():
            return True
        now = np.array(self._sequence.next(self._requested.tolist(), now.tolist()))
        self._set_references(now)
        return False

    def settle(self) -> None:
        """Choose references as `ContactCorrection.settle` does."""
        if self._sequence.has_come_near(float(self._tolerances[0])):
            self._set_references(np.array(self._sequence.best))
        else:
            self.restore()

    def restore(self) -> None:
        """Restore the previous references."""
        self._aref[self._edges] = self._before
        for row, reference in self._changed:
            self._aref[row] = reference

    def _set_references(self, normals: Floats) -> None:
        self._requested = normals
        changes = self._before + (normals - self._normals)[:, None]
        self._aref[self._edges] = changes if self._is_pyramid else normals[:, None]


def _lift(residual: Floats, mu: Floats, is_pyramid: bool) -> Floats:
    """Return the lift of contacts for residuals along their friction rows or pairs of edges [m/s²], shape (k,)."""
    if is_pyramid:
        apart = np.abs(residual[..., 0] - residual[..., 1]) / 2.0
        found: Floats = np.where(mu > 0.0, apart, 0.0).max(axis=1, initial=0.0)
        return found
    total: Floats = np.zeros(len(mu))
    for one in (mu * residual).T:
        total += one * one
    lengths: Floats = np.sqrt(total)
    return lengths


AnyContactCorrection = ContactCorrection | ArrayContactCorrection


def find_array_correction(
    model: mujoco.MjModel, data: mujoco.MjData, around: ContactConditions, residual: Floats | None = None
) -> ArrayContactCorrection | None:
    """Return the contacts to correct as `find_correction` does, for either cone."""
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
        bearable = LIFT_FACTOR * around.tolerance * (1.0 - impedance) / impedance
        tolerances[pressed] = np.minimum(around.tolerance, bearable)
    slides: npt.NDArray[np.bool_] = _lift((aref if residual is None else residual)[places], mu, is_pyramid) > tolerances
    chosen = slides | ~np.isnan(goals)
    if not chosen.any():
        return None
    slides = (slides | ~closes) & (goals != NO_FORCE)
    mu = np.where(slides[:, None], mu, 0.0)[chosen]
    rest = (edges[chosen], normals[chosen], goals[chosen], bounces[chosen], tolerances[chosen], changed)
    return ArrayContactCorrection(data, is_pyramid, rows[chosen], places[chosen], mu, *rest)
