"""Correction of the normal references of contacts by the contact law, on arrays, for many contacts and pyramidal cones.

`simkit.runtime.contact.contact_correction` is the same law on plain numbers; the results have the same bits.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.runtime.contact.anderson_acceleration import IslandIterations
from simkit.runtime.contact.contact_conditions import (
    AT_LEAST,
    AT_MOST,
    CLOSING_SPEED,
    CREEP_LIMIT,
    EXACTLY,
    EXIT_SPEED,
    LIFT_FACTOR,
    MIN_PENETRATION,
    NO_FORCE,
    OPENING_SPEED,
    RECOVERY_ACCURACY,
    ContactConditions,
    hit_islands,
    islands_of,
    raise_tolerances,
    rebound,
    relaxation,
)
from simkit.runtime.contact.contact_correction import ContactCorrection, restore_islands

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.integer[Any]]

_PYRAMID: Final = mujoco.mjtCone.mjCONE_PYRAMIDAL


class ArrayContactCorrection:
    """Contacts under either cone, on arrays.

    Args:
        data: MuJoCo's data.
        is_pyramid: True for the pyramidal cone.
        places: rows of the friction, shape (k, most), or pairs of edges, shape (k, most, 2).
        mu: coefficients of these rows, shape (k, most); zero for missing rows and for contacts that do not slide.
        edges: rows that carry the normal, shape (k, n); missing rows repeat the first one.
        normals: references of the normals [m/s²], shape (k,), as in `ContactCorrection`.
        goals: requested accelerations [m/s²] or NaN, shape (k,), as in `ContactCorrection`.
        kinds: kinds of these requests, shape (k,), as in `ContactCorrection`.
        tolerances: tolerances of the references [m/s²], shape (k,), as in `ContactCorrection`.
        references: references of all rows, as in `ContactCorrection`.
        may_creep: True if no contact closes, opens, overlaps or slips fast.
        around: step and tolerance.
    """

    def __init__(
        self,
        data: mujoco.MjData,
        is_pyramid: bool,
        places: Ints,
        mu: Floats,
        edges: Ints,
        normals: Floats,
        goals: Floats,
        kinds: Ints,
        tolerances: Floats,
        references: Floats,
        may_creep: bool,
        around: ContactConditions,
    ) -> None:
        self._data, self._aref, self._softness, self._is_pyramid = data, data.efc_aref, data.efc_R, is_pyramid
        self._places, self._mu, self._edges, self._normals = places, mu, edges, normals
        self._goals, self._kinds, self._tolerances, self._references = goals, kinds, tolerances, references
        self._has_goal = ~np.isnan(goals)
        self._has_goals = bool(self._has_goal.any())
        self._engine, self.may_creep = self._aref.copy(), may_creep
        self._around = around
        self._tangents: Floats = normals
        self._before: Floats = normals
        self._requested: Floats = normals
        self._islands: list[int] = []
        self._iterations: IslandIterations | None = None

    def creeps(self, moves: Floats, forces: Floats | None = None) -> bool:
        """Check the contacts as `ContactCorrection.creeps` does."""
        required = self._engine if forces is None else self._engine - self._softness * forces
        lift = _squared_lift(required[self._places] - moves[self._places], self._mu, self._is_pyramid)
        return not (lift > self._tolerances * self._tolerances).any()

    def stop_slip(self) -> None:
        """Set the references as `ContactCorrection.stop_slip` does."""
        self._aref[:] = self._references

    def read_references(self) -> None:
        """Read the references that other rules have changed."""
        self._references = self._aref.copy()

    def guess(self, moves: Floats) -> None:
        """Set references as `ContactCorrection.guess` does."""
        self._aref[:] = self._references
        self._tangents, self._before = self._references[self._places], self._references[self._edges]
        size = _lift(self._tangents - moves[self._places], self._mu, self._is_pyramid)
        accelerations = self._along(moves)
        normals, largest = self._normals, np.abs(accelerations)
        if self._has_goals:
            impedance = self._data.efc_KBIP[self._edges[:, 0], 2]
            yields = (1.0 - impedance) / impedance * np.maximum(0.0, self._goals - accelerations)
            closes = self._has_goal & (self._kinds != AT_MOST)
            largest = np.where(closes, np.maximum(largest, self._goals), largest)
            normals = self._limited(yields)
        self._islands = islands_of(self._data, self._edges[:, 0].tolist())
        self._tolerances = np.array(raise_tolerances(self._tolerances.tolist(), self._islands, largest.tolist()))
        self._set_references(normals - size)

    def correct(self, moves: Floats, forces: Floats) -> bool:
        """Set references as `ContactCorrection.correct` does."""
        places, normals = self._places, self._normals
        residual = self._tangents - moves[places] - self._softness[places] * forces[places]
        if self._has_goals:
            normals = self._limited(self._along(self._softness * forces))
        is_open = (self._along(forces) <= 0.0) & (self._along(moves) >= normals)
        now = np.where(is_open, self._requested, normals - _lift(residual, self._mu, self._is_pyramid))
        wrong = (np.abs(now - self._requested) > self._tolerances).nonzero()[0].tolist()
        if not wrong:
            return True
        unsettled = dict.fromkeys(self._islands[place] for place in wrong)
        if self._iterations is None:
            now, islands = self._leave(unsettled, now), self._islands
            mus = self._mu[:, 0].tolist() if self._mu.shape[1] else [0.0] * len(islands)
            weights = relaxation(islands, self._goals.tolist(), mus)
            speeds = self._data.efc_vel[self._edges[:, :2]].mean(axis=1)
            self._iterations = IslandIterations(islands, weights, hit_islands(islands, speeds.tolist()))
        self._set_references(np.array(self._iterations.next(self._requested.tolist(), now.tolist(), unsettled)))
        return False

    def _leave(self, unsettled: dict[int, None], results: Floats) -> Floats:
        """Leave only some contacts as `ContactCorrection._leave` does."""
        remaining = [place for place, island in enumerate(self._islands) if island in unsettled]
        if len(remaining) < len(self._islands):
            self._islands = [self._islands[place] for place in remaining]
            self._places, self._edges, self._mu = self._places[remaining], self._edges[remaining], self._mu[remaining]
            self._normals, self._goals, self._kinds = (
                self._normals[remaining],
                self._goals[remaining],
                self._kinds[remaining],
            )
            self._tangents, self._before = self._tangents[remaining], self._before[remaining]
            self._tolerances, self._requested = self._tolerances[remaining], self._requested[remaining]
            self._has_goal, results = self._has_goal[remaining], results[remaining]
        return results

    def settle(self) -> None:
        """Choose references as `ContactCorrection.settle` does."""
        if self._iterations is not None:
            tolerances = self._tolerances.tolist()
            best, failed = self._iterations.settle(self._requested.tolist(), tolerances, self._around.tolerance)
            self._set_references(np.array(best))
            if failed:
                restore_islands(self._data, self._engine, failed)
                self._hold(failed)

    def _hold(self, islands: list[int]) -> None:
        """Set normal references as `ContactCorrection._hold` does."""
        bounded = self._has_goal & (self._kinds == AT_MOST) & np.isin(self._islands, islands)
        edges, before = self._edges[bounded], self._along(self._aref)[bounded]
        lift = _lift(self._aref[self._places[bounded]], self._mu[bounded], self._is_pyramid)
        limit = np.maximum(0.0, self._goals[bounded] - EXIT_SPEED / self._around.step)
        now = np.minimum(before, limit) - lift
        self._aref[edges] = self._aref[edges] + (now - before)[:, None] if self._is_pyramid else now[:, None]

    def restore(self) -> None:
        """Restore the previous references."""
        self._aref[:] = self._engine

    def _along(self, values: Floats) -> Floats:
        """Return the values of the normal rows, or the mean of the edges, shape (k,)."""
        chosen = values[self._edges]
        normal: Floats = chosen.mean(axis=1) if self._is_pyramid else chosen[:, 0]
        return normal

    def _limited(self, yields: Floats) -> Floats:
        """Return the normal references with requested accelerations, as `contact_correction._limited` does."""
        normals, wanted, kinds = self._normals, self._goals + yields, self._kinds
        limited = np.where(kinds == AT_MOST, np.minimum(normals, wanted), wanted)
        limited = np.where(kinds == AT_LEAST, np.maximum(normals, wanted), limited)
        return np.where(self._has_goal, limited, normals)

    def _set_references(self, normals: Floats) -> None:
        self._requested = normals
        changes = self._before + (normals - self._normals)[:, None]
        self._aref[self._edges] = changes if self._is_pyramid else normals[:, None]


def _squared_lift(residual: Floats, mu: Floats, is_pyramid: bool) -> Floats:
    """Return the squared lift of contacts for residuals along their friction rows or pairs of edges, shape (k,)."""
    if is_pyramid:
        apart = np.abs(residual[..., 0] - residual[..., 1]) / 2.0
        lift: Floats = np.where(mu > 0.0, apart, 0.0).max(axis=1, initial=0.0)
        return lift * lift
    total: Floats = np.zeros(len(mu))
    for component in (mu * residual).T:
        total += component * component
    return total


def _lift(residual: Floats, mu: Floats, is_pyramid: bool) -> Floats:
    """Return the lift of contacts [m/s²], shape (k,)."""
    lengths: Floats = np.sqrt(_squared_lift(residual, mu, is_pyramid))
    return lengths


class _Candidates(NamedTuple):
    """Contacts that may need a correction.

    Attributes:
        numbers: numbers of the contacts.
        there: True for friction rows that exist, shape (k, most).
        speed: speed along the normal [m/s].
        depth: penetration [m].
        lift: squared lift.
        Others: as in `ArrayContactCorrection`.
    """

    numbers: Ints
    there: npt.NDArray[np.bool_]
    places: Ints
    mu: Floats
    edges: Ints
    normals: Floats
    speed: Floats
    depth: Floats
    lift: Floats


def find_array_correction(
    model: mujoco.MjModel, data: mujoco.MjData, around: ContactConditions, residual: Floats | None = None
) -> ArrayContactCorrection | None:
    """Return the contacts to correct as `find_correction` does, for either cone."""
    is_pyramid = bool(model.opt.cone == _PYRAMID)
    candidates = _candidates(data, around, is_pyramid, residual)
    if candidates is None:
        return None
    _, there, places, mu, edges, normals, speed, depth, lift = candidates
    goals, kinds = _goals(data, around, candidates)
    stops = (speed < CLOSING_SPEED) | (lift > around.tolerance * around.tolerance)
    stops &= there.any(axis=1) & (goals != NO_FORCE)
    references = data.efc_aref.copy()
    which = stops.nonzero()[0]
    if which.size:  # a tangent with a damping of its own slips by its compliance
        damping = data.efc_KBIP[:, 1]
        normal, tangent = damping[edges[which, 0]], damping[edges[which, 0] + 1]
        which = which[(normal == tangent) & (normal >= around.least_damping)]
        share = 1.0 / (damping[edges[which, 0]] * around.step)
        if residual is None:
            lift[which] *= share * share
        inside = there[which]
        stopped = places[which][inside].reshape(-1)
        owner = np.repeat(np.arange(which.size), inside.sum(axis=1) * (2 if is_pyramid else 1))
        level = normals[which][owner] if is_pyramid else 0.0
        references[stopped] = level + share[owner] * (references[stopped] - level)
    tolerances: Floats = np.full(len(speed), around.tolerance)
    pressed = (depth > MIN_PENETRATION).nonzero()[0]
    if pressed.size:
        impedance = data.efc_KBIP[edges[pressed, 0], 2]
        bearable = LIFT_FACTOR * around.tolerance * (1.0 - impedance) / impedance
        tolerances[pressed] = np.minimum(around.tolerance, bearable)
    leaves = (kinds == AT_MOST) & (goals > NO_FORCE)
    tolerances[leaves] = np.maximum(tolerances[leaves], RECOVERY_ACCURACY * EXIT_SPEED / around.step)
    slides = lift > tolerances * tolerances
    chosen = (slides | ~np.isnan(goals)).nonzero()[0]
    if not chosen.size:
        return None
    slides = (slides | (speed >= CLOSING_SPEED)) & (goals != NO_FORCE)
    mu = np.where(slides[:, None], mu, 0.0)[chosen]
    fast = CREEP_LIMIT * CREEP_LIMIT * (around.tolerance * around.tolerance)
    may_creep = not (lift > fast).any() and bool(np.isnan(goals).all())
    rest = (edges[chosen], normals[chosen], goals[chosen], kinds[chosen], tolerances[chosen], references, may_creep)
    return ArrayContactCorrection(data, is_pyramid, places[chosen], mu, *rest, around)


def _candidates(
    data: mujoco.MjData, around: ContactConditions, is_pyramid: bool, residual: Floats | None
) -> _Candidates | None:
    """Return the contacts that slide, close, open or overlap, before the other conditions are checked."""
    contact, aref, velocity = data.contact, data.efc_aref, data.efc_vel
    rows, dims = contact.efc_address, contact.dim
    numbers = (rows >= 0).nonzero()[0]
    if not numbers.size:
        return None
    rows, dims = rows[numbers], dims[numbers]
    most = int(dims.max()) - 1
    there = np.arange(most) < (dims - 1)[:, None]
    mu = np.where(there, contact.friction[numbers, :most], 0.0)
    if is_pyramid:
        pairs = rows[:, None, None] + np.arange(2 * most).reshape(most, 2)
        places = np.where(there[..., None], pairs, rows[:, None, None])
        edges = places.reshape(len(rows), -1) if most else rows[:, None]
        normals, speed = aref[edges[:, :2]].mean(axis=1), velocity[edges[:, :2]].mean(axis=1)
    else:
        places, edges = np.where(there, rows[:, None] + 1 + np.arange(most), rows[:, None]), rows[:, None]
        normals, speed = aref[rows], velocity[rows]
    depth = -contact.dist[numbers]
    lift = _squared_lift((aref if residual is None else residual)[places], mu, is_pyramid)
    matters = (lift > around.tolerance * around.tolerance) | (speed < CLOSING_SPEED)
    matters |= (speed > OPENING_SPEED) | (depth > MIN_PENETRATION)
    if around.inner:
        matters |= np.isin(numbers, list(around.inner))
    if matters.all():
        return _Candidates(numbers, there, places, mu, edges, normals, speed, depth, lift)
    if not matters.any():
        return None
    every = (numbers, there, places, mu, edges, normals, speed, depth, lift)
    return _Candidates(*(each[matters] for each in every))


def _goals(data: mujoco.MjData, around: ContactConditions, candidates: _Candidates) -> tuple[Floats, Ints]:
    """Return the requested accelerations of contacts [m/s²] or NaN, and their kinds, each of shape (k,)."""
    contact, step, numbers, normals, speed = (
        data.contact,
        around.step,
        candidates.numbers,
        candidates.normals,
        candidates.speed,
    )
    closes, after = speed < CLOSING_SPEED, speed
    if around.closing is not None:
        geoms = np.array(around.closing)[contact.geom[numbers]]
        left = geoms[:, 0] + geoms[:, 1]
        after = np.where(closes & (speed < -left), speed + left, speed)
    wanted = np.maximum(0.0, (EXIT_SPEED - after) / step)
    is_late = closes & (normals <= wanted)
    is_fast = (normals > wanted) | (candidates.depth > around.deep)
    constants = contact.solref[numbers, 0]
    is_rigid = (constants > 0.0) & (constants <= around.softest)
    goals = np.where(np.where(is_late, candidates.depth >= 0.0, is_fast) & is_rigid, wanted, np.nan)
    goals = np.where(is_late & (goals == wanted), -after / step, goals)
    kinds = np.where(is_late, AT_LEAST, AT_MOST)
    if around.inner:
        goals = np.where(np.isin(numbers, list(around.inner)), NO_FORCE, goals)
        kinds = np.where(goals == NO_FORCE, AT_MOST, kinds)
    for index in (closes & (constants <= 0.0)).nonzero()[0].tolist():
        goals[index], kinds[index] = rebound(data, int(numbers[index]), float(speed[index]), around), EXACTLY
    return goals, kinds


AnyContactCorrection = ContactCorrection | ArrayContactCorrection
