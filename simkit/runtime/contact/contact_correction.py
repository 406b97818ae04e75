"""Contacts whose normal reference the contact law corrects, and the size of the correction, on plain numbers.

`contact_correction_arrays` has the same law on arrays, with the same bits. Plain numbers are faster for up to some 60
contacts: an array of four numbers costs as much as one of four hundred.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

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

if TYPE_CHECKING:
    import mujoco

Floats = npt.NDArray[np.float64]


class ContactCorrection:
    """Contacts under the elliptic cone, on plain numbers.

    Args:
        data: of the engine.
        contacts: of each the row of its normal, its coefficients of friction (none where it does not slide), the
            reference of the normal, the acceleration asked for along it [m/s²], NaN where the reference stays, whether
            it rebounds and gets just that, and the tolerance of its reference [m/s²].
        changed: other rows whose references are no longer as they were, with those.
    """

    def __init__(
        self,
        data: mujoco.MjData,
        contacts: list[tuple[int, list[float], float, float, bool, float]],
        changed: list[tuple[int, float]],
    ) -> None:
        self._data, self._aref, self._contacts, self._changed = data, data.efc_aref, contacts, changed
        self._before: list[float] = []
        self._softness: list[float] = []
        self._asked: list[float] = []
        self._sequence: AndersonAcceleration | None = None

    def guess(self, moves: Floats) -> None:
        """Set references by a guess of J a, shape (nefc,); of the forces nothing is known yet."""
        accelerations, aref, asked = moves.tolist(), self._aref, self._asked
        self._before = before = aref.tolist()
        for row, mus, normal, goal, _, _ in self._contacts:
            if len(mus) == 2:  # written out, as nearly all have two tangents: a third of the time of the loop
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
            asked.append(now)

    def correct(self, moves: Floats, forces: Floats) -> bool:
        """Set references by a solution, J a and forces of shape (nefc,); False where they differ from the last."""
        accelerations, force, before, softness = moves.tolist(), forces.tolist(), self._before, self._softness
        if not softness:
            self._softness = softness = self._data.efc_R.tolist()
        given, stays = [], True
        for (row, mus, normal, goal, rebounds, most), last in zip(self._contacts, self._asked, strict=True):
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
                # a contact that closes is stopped, also by more than its softness asks; one that opens gets no more
                wanted = goal + softness[row] * force[row]
                normal = wanted if rebounds else max(normal, wanted) if normal < goal else min(normal, wanted)
                most = max(most, CLOSING_ACCURACY * goal)
            now = normal - math.sqrt(total)
            given.append(now)
            if abs(now - last) > most:
                stays = False
        if not stays:
            if self._sequence is None:
                self._sequence = AndersonAcceleration()
            self._asked, aref = self._sequence.next(self._asked, given), self._aref
            for (row, _, _, _, _, _), now in zip(self._contacts, self._asked, strict=True):
                aref[row] = now
        return stays

    def settle(self) -> None:
        """Ask for what has missed the least; as the engine does where that was much."""
        if self._sequence is not None and not self._sequence.has_come_near(self._contacts[0][5]):
            self.restore()
        elif self._sequence is not None:
            for (row, _, _, _, _, _), best in zip(self._contacts, self._sequence.best, strict=True):
                self._aref[row] = best

    def restore(self) -> None:
        """Put the references back as they were."""
        aref = self._aref
        for row, _, normal, _, _, _ in self._contacts:
            aref[row] = normal
        for row, reference in self._changed:
            aref[row] = reference


def find_correction(
    data: mujoco.MjData, around: ContactConditions, residual: Floats | None = None
) -> ContactCorrection | None:
    """Return the contacts that slide, close or open fast, or overlap; None where there is none.

    Args:
        data: of the engine, with velocities up to date and an elliptic cone.
        around: step, gravity and tolerance.
        residual: aref - J a - R f of a solution, shape (nefc,), for contacts that only begin to slide; without it a
            contact slides by its velocity.
    """
    contact, step, closing, inner = data.contact, around.step, around.closing, around.inner
    all_rows, dims, friction = contact.efc_address.tolist(), contact.dim.tolist(), contact.friction.tolist()
    aref, velocity = data.efc_aref.tolist(), data.efc_vel.tolist()
    slip: list[float] = aref if residual is None else residual.tolist()
    distance: list[float] = contact.dist.tolist()
    found: list[tuple[int, list[float], float, float, bool, float]] = []
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
        if (
            CLOSING_SPEED <= speed <= OPENING_SPEED and depth <= MIN_PENETRATION
        ):  # it slides at most: most contacts, most of the time
            if total > square:
                found.append((row, mus[: dim - 1], aref[row], nothing, False, around.tolerance))
            continue
        normal, goal, after, rebounds = aref[row], nothing, speed, False
        closes, tolerance = speed < CLOSING_SPEED, around.tolerance
        if closes and closing is not None:  # what is stopped ahead of the surface goes on towards it, slowly
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
        if depth > MIN_PENETRATION:  # the impedance is near 1 there, and a contact is lost from less lift on
            impedance = data.efc_KBIP.item(row, 2)
            tolerance = min(tolerance, LIFT_FACTOR * tolerance * (1.0 - impedance) / impedance)
        if total > tolerance * tolerance:
            found.append((row, mus[: dim - 1], normal, goal, rebounds, tolerance))
        elif goal == goal:
            found.append((row, [], normal, goal, rebounds, tolerance))
    return ContactCorrection(data, found, changed) if found else None
