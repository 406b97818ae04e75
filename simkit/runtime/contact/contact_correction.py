"""Correction of the normal references of contacts by the contact law, on plain numbers.

`ArrayContactCorrection` is the same law on arrays, with the same bits. Plain numbers are faster for up to about 60
contacts: an array of four numbers costs as much as one of four hundred.
"""

from __future__ import annotations

import math

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
    HIT_ACCURACY,
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

Floats = npt.NDArray[np.float64]

CorrectedContact = tuple[int, list[float], float, float, int]
"""Contact whose normal reference is corrected.

- Row of the normal.
- Friction coefficients; empty if the contact does not slide.
- Reference of the normal [m/s²].
- Requested acceleration along the normal [m/s²]; NaN keeps the reference.
- Kind of this request: `EXACTLY`, `AT_LEAST` or `AT_MOST`.
"""


class ContactCorrection:
    """Contacts under the elliptic cone, on plain numbers.

    Args:
        data: MuJoCo's data.
        contacts: corrected contacts; see `CorrectedContact`.
        tolerances: tolerances of their references [m/s²].
        before: references of the engine, of all rows.
        references: the same, but the friction of sliding and closing contacts stops their slip within the step.
        may_creep: True if no contact closes, opens, overlaps or slips fast.
        around: step and tolerance.
    """

    _softness: list[float] | None = None
    _iterations: IslandIterations | None = None

    def __init__(
        self,
        data: mujoco.MjData,
        contacts: list[CorrectedContact],
        tolerances: list[float],
        before: list[float],
        references: list[float],
        may_creep: bool,
        around: ContactConditions,
    ) -> None:
        self._data, self._aref, self._contacts, self._tolerances = data, data.efc_aref, contacts, tolerances
        self.may_creep, self._around = may_creep, around
        self._before, self._references, self._engine = before, references, self._aref.copy()

    def creeps(self, moves: Floats, forces: Floats | None = None) -> bool:
        """Check whether friction may give what the velocities of all contacts require, as under a wheel that creeps.

        Args:
            moves: J a (Jacobian times acceleration) of the previous step or of the engine's solution, shape (nefc,).
            forces: constraint forces of the solution, shape (nefc,).
        """
        aref, accelerations = self._before, moves.tolist()
        if forces is not None:
            yields = (self._data.efc_R * forces).tolist()
            aref = [reference - change for reference, change in zip(aref, yields, strict=True)]
        for (row, mus, _, _, _), tolerance in zip(self._contacts, self._tolerances, strict=True):
            if len(mus) == 2:
                first = mus[0] * (aref[row + 1] - accelerations[row + 1])
                other = mus[1] * (aref[row + 2] - accelerations[row + 2])
                total = first * first + other * other
            else:
                total = 0.0
                for place, mu in enumerate(mus, row + 1):
                    first = mu * (aref[place] - accelerations[place])
                    total += first * first
            if total > tolerance * tolerance:
                return False
        return True

    def stop_slip(self) -> None:
        """Set the references of the tangents, so that other rules can change them; `read_references` must follow."""
        self._aref[:] = self._references

    def read_references(self) -> None:
        """Read the references that other rules have changed."""
        self._references = self._aref.tolist()

    def guess(self, moves: Floats) -> None:
        """Set references from an estimate of J a (Jacobian times acceleration), before any forces are known.

        Args:
            moves: estimate of J a, shape (nefc,).
        """
        accelerations, before = moves.tolist(), self._references
        after, requested, largest = before.copy(), [], []
        contacts, data = self._contacts, self._data
        for row, mus, normal, goal, kind in contacts:
            if len(mus) == 2:  # unrolled for the usual two tangents: saves a third of the loop's time
                first = mus[0] * (before[row + 1] - accelerations[row + 1])
                other = mus[1] * (before[row + 2] - accelerations[row + 2])
                total = first * first + other * other
            else:
                total = 0.0
                for place, mu in enumerate(mus, row + 1):
                    first = mu * (before[place] - accelerations[place])
                    total += first * first
            acceleration = accelerations[row]
            most = abs(acceleration)
            if goal == goal:  # not NaN
                # R f of a contact that reaches the goal: R is (1 - d) / d times the inverse inertia along the normal,
                # with the impedance d, and the force gives the acceleration that is missing
                impedance = data.efc_KBIP.item(row, 2)
                yields = (1.0 - impedance) / impedance * max(0.0, goal - acceleration)
                if kind != AT_MOST:  # it closes
                    most = max(most, goal)
                normal = _limited(normal, goal + yields, kind)
            # under the elliptic cone a sliding contact opens by its coefficients times its slip; the reference is
            # smaller by this amount, so that it stays closed
            after[row] = now = normal - math.sqrt(total)
            requested.append(now)
            largest.append(most)
        self._aref[:], self._requested = after, requested
        tolerances = self._tolerances
        # `raise_tolerances` would change nothing
        if data.nisland < 2 and HIT_ACCURACY * max(largest) <= min(tolerances):
            self._islands = [0] * len(largest)
        else:
            self._islands = islands_of(data, [contact[0] for contact in contacts])
            self._tolerances = raise_tolerances(tolerances, self._islands, largest)

    def correct(self, moves: Floats, forces: Floats) -> bool:
        """Set references from a solution; return True if they stay within the tolerances.

        Args:
            moves: J a of the solution, shape (nefc,).
            forces: constraint forces of the solution, shape (nefc,).
        """
        accelerations, force, before = moves.tolist(), forces.tolist(), self._references
        softness = self._softness
        if softness is None:  # read once: the iterations of a step change the references only
            self._softness = softness = self._data.efc_R.tolist()
        results: list[float] = []
        wrong: list[int] = []
        for (row, mus, normal, goal, kind), last, most in zip(
            self._contacts, self._requested, self._tolerances, strict=True
        ):
            if goal == goal:
                normal = _limited(normal, goal + softness[row] * force[row], kind)
            if force[row] <= 0.0 and accelerations[row] >= normal:
                results.append(last)  # open, and open with every smaller reference
                continue
            if len(mus) == 2:
                place = row + 1
                component = mus[0] * (before[place] - accelerations[place] - softness[place] * force[place])
                place = row + 2
                other = mus[1] * (before[place] - accelerations[place] - softness[place] * force[place])
                total = component * component + other * other
            else:
                total = 0.0
                for place, mu in enumerate(mus, row + 1):
                    component = mu * (before[place] - accelerations[place] - softness[place] * force[place])
                    total += component * component
            now = normal - math.sqrt(total)
            results.append(now)
            if abs(now - last) > most:
                wrong.append(len(results) - 1)
        if not wrong:
            return True
        unsettled = dict.fromkeys(self._islands[place] for place in wrong)
        if self._iterations is None:
            results = self._leave(unsettled, results)
            goals = [contact[3] for contact in self._contacts]
            first = [contact[1][0] if contact[1] else 0.0 for contact in self._contacts]
            # only a correction that does not settle at once pays for the iterations
            weights = relaxation(self._islands, goals, first)
            hits = hit_islands(self._islands, self._data.efc_vel[[contact[0] for contact in self._contacts]].tolist())
            self._iterations = IslandIterations(self._islands, weights, hits)
        self._set_references(self._iterations.next(self._requested, results, unsettled))
        return False

    def _leave(self, unsettled: dict[int, None], results: list[float]) -> list[float]:
        """Leave only the contacts of islands that have not converged, and return their results."""
        remaining = [place for place, island in enumerate(self._islands) if island in unsettled]
        if len(remaining) < len(self._islands):
            self._contacts = [self._contacts[place] for place in remaining]
            self._requested = [self._requested[place] for place in remaining]
            self._tolerances = [self._tolerances[place] for place in remaining]
            self._islands = [self._islands[place] for place in remaining]
            results = [results[place] for place in remaining]
        return results

    def settle(self) -> None:
        """Use the references with the smallest residual, or the engine's references if this residual is large.

        In a narrow groove, the engine's references would push overlapping bodies out at metres per second, because they
        open a sliding contact by its coefficient times its slip. There such bodies do not separate in this step.
        """
        if self._iterations is not None:
            best, failed = self._iterations.settle(self._requested, self._tolerances, self._around.tolerance)
            self._set_references(best)
            if failed:
                restore_islands(self._data, self._engine, failed)
                self._hold(failed)

    def _hold(self, islands: list[int]) -> None:
        """Set normal references so that overlapping bodies of some islands do not separate in this step."""
        aref, exits = self._aref.tolist(), EXIT_SPEED / self._around.step
        for (row, mus, _, goal, kind), island in zip(self._contacts, self._islands, strict=True):
            if kind == AT_MOST and goal == goal and island in islands:
                total = 0.0
                for place, mu in enumerate(mus, row + 1):
                    component = mu * aref[place]
                    total += component * component
                self._aref[row] = min(aref[row], max(0.0, goal - exits)) - math.sqrt(total)

    def restore(self) -> None:
        """Restore the previous references."""
        self._aref[:] = self._engine

    def _set_references(self, normals: list[float]) -> None:
        self._requested, aref = normals, self._aref
        for (row, _, _, _, _), now in zip(self._contacts, normals, strict=True):
            aref[row] = now


def restore_islands(data: mujoco.MjData, references: Floats, islands: list[int]) -> None:
    """Restore the references of all rows of some islands."""
    if data.nisland < 2:
        data.efc_aref[:] = references
    else:
        rows = np.isin(data.efc_island, islands)
        data.efc_aref[rows] = references[rows]


def _limited(normal: float, wanted: float, kind: int) -> float:
    """Return the reference of a contact with a requested acceleration.

    Args:
        normal: reference of the engine [m/s²].
        wanted: requested acceleration plus the part that the softness of the contact takes [m/s²].
        kind: kind of the request.
    """
    if kind == AT_LEAST:
        return max(normal, wanted)
    return min(normal, wanted) if kind == AT_MOST else wanted


def _request(
    data: mujoco.MjData, around: ContactConditions, number: int, row: int, normal: float, speed: float
) -> tuple[float, int, float]:
    """Return the requested acceleration of a contact that closes, opens or overlaps.

    Args:
        data: MuJoCo's data.
        around: conditions of the correction.
        number: number of the contact.
        row: row of its normal.
        normal: reference of this row [m/s²].
        speed: speed along the normal [m/s].

    Returns:
        Acceleration [m/s²] or NaN, kind of the request, and tolerance of the reference [m/s²].
    """
    contact, step, closing = data.contact, around.step, around.closing
    depth, closes, after = -contact.dist.item(number), speed < CLOSING_SPEED, speed
    goal, kind, tolerance = math.nan, AT_MOST, around.tolerance
    if closes and closing is not None:  # a geom that is stopped before the surface still approaches it slowly
        first, second = contact.geom[number].tolist()
        left = closing[first] + closing[second]
        after = speed + left if speed < -left else speed
    wanted = max(0.0, (EXIT_SPEED - after) / step)
    if closes and normal <= wanted:
        wanted, is_wrong, kind = -after / step, depth >= 0.0, AT_LEAST
    else:
        is_wrong = normal > wanted or depth > around.deep
    constant = contact.solref.item(number, 0) if closes or is_wrong else 0.0
    if constant > 0.0:
        goal = wanted if is_wrong and constant <= around.softest else math.nan
    elif closes:
        goal, kind = rebound(data, number, speed, around), EXACTLY
    if depth > MIN_PENETRATION:  # the impedance of a deep contact is near 1: less lift opens it
        impedance = data.efc_KBIP.item(row, 2)
        tolerance = min(tolerance, LIFT_FACTOR * tolerance * (1.0 - impedance) / impedance)
    if goal == goal and kind == AT_MOST:
        tolerance = max(tolerance, RECOVERY_ACCURACY * EXIT_SPEED / step)
    return goal, kind, tolerance


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
    contact, step, inner = data.contact, around.step, around.inner
    all_rows, dims, friction = contact.efc_address.tolist(), contact.dim.tolist(), contact.friction.tolist()
    aref, velocity = data.efc_aref.tolist(), data.efc_vel.tolist()
    slip: list[float] = aref if residual is None else residual.tolist()
    distance: list[float] = contact.dist.tolist()
    corrected: list[CorrectedContact] = []
    tolerances: list[float] = []
    references = aref.copy()
    nothing, square, least = math.nan, around.tolerance * around.tolerance, around.least_damping
    damping: list[float] | None = None
    fast, may_creep = CREEP_LIMIT * CREEP_LIMIT * square, True
    last, share = math.nan, 1.0
    for number, row in enumerate(all_rows):
        if row < 0:
            continue
        if number in inner:
            corrected.append((row, [], aref[row], NO_FORCE, AT_MOST))
            tolerances.append(around.tolerance)
            may_creep = False
            continue
        dim, mus = dims[number], friction[number]
        if dim == 3:
            component, other = mus[0] * slip[row + 1], mus[1] * slip[row + 2]
            total = component * component + other * other
        else:
            total = 0.0
            for place in range(1, dim):
                component = mus[place - 1] * slip[row + place]
                total += component * component
        speed = velocity[row]
        is_quiet = CLOSING_SPEED <= speed <= OPENING_SPEED and -distance[number] <= MIN_PENETRATION
        if is_quiet and total <= square:  # the most frequent case
            continue
        if damping is None:
            damping = data.efc_KBIP[:, 1].tolist()
        # a tangent with a damping of its own slips by its compliance
        rate = damping[row]
        if (total > square or speed < CLOSING_SPEED) and rate >= least and dim > 1 and rate == damping[row + 1]:
            if rate != last:
                last, share = rate, 1.0 / (rate * step)
            if residual is None:
                total *= share * share
            # the engine's references let slip decay over its time constant; 1 / (rate · step) ends it within the step
            references[row + 1] *= share
            references[row + 2] *= share
            if dim > 3:
                for place in range(row + 3, row + dim):
                    references[place] *= share
        goal, kind, tolerance = nothing, AT_MOST, around.tolerance
        if not is_quiet:
            goal, kind, tolerance = _request(data, around, number, row, aref[row], speed)
        if total > fast or goal == goal:
            may_creep = False
        slides = total > tolerance * tolerance
        if slides or goal == goal:
            if not slides and speed < CLOSING_SPEED:
                mus = []  # bodies that separate begin to slide, bodies that close do not
            corrected.append((row, mus[: dim - 1], aref[row], goal, kind))
            tolerances.append(tolerance)
    return ContactCorrection(data, corrected, tolerances, aref, references, may_creep, around) if corrected else None
