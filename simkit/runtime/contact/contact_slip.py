"""Contacts that slip in proportion to their force.

A row of friction obeys R f = aref - a, with aref = -B v. ODE's slip is v' = -c f for the velocity after the step, so R
= c/dt and B = 1/dt. Under MuJoCo's elliptic cone, R of the two tangents is coupled (R·mu² is one number). For two
different compliances, one R is chosen, and B is R/c for each tangent. At a constant force both tangents slip exactly.
After a change of the force they converge as fast as in ODE, unless R is small compared with the inverse of the pushed
mass.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import mujoco
import numpy as np

from simkit.linear_algebra import matmul

Numbers = list[float]
Pair = tuple[float, float]
SlippingContact = tuple[int, int, Pair]
"""Contact number, number of the slipping kinematic tree, and compliances along the two tangents [m/s/N]."""

_STIFF_FACTOR = 4.0  # an R of this many inverse masses of the contacts dominates their motion
# least compliance as a fraction of the larger of two, so that the softer tangent does not react slowly
_MIN_COMPLIANCE_SHARE = 0.02


class ContactSlip:
    """Function object that makes contacts of one compiled model soft, after its constraints are made."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model = model

    def soften(self, data: mujoco.MjData, soft: Sequence[SlippingContact]) -> None:
        """Make the friction of elliptic contacts soft."""
        contact, step = data.contact, float(self.model.opt.timestep)
        firsts, dims, frictions = contact.efc_address.tolist(), contact.dim.tolist(), contact.friction.tolist()
        inverse_masses = self._inverse_masses(
            data, [entry for entry in soft if not _is_isotropic(entry[2], frictions[entry[0]])], firsts
        )
        all_r, all_d, terms, mus = data.efc_R, data.efc_D, data.efc_KBIP, contact.mu
        for number, tree, slip in soft:
            first, friction = firsts[number], frictions[number][: dims[number] - 1]
            by_friction = [(by := friction[0] / entry) * by for entry in friction]
            normal, base = all_r.item(first), all_r.item(first + 1)
            # more damping would overshoot with almost no compliance
            most = [1.0 / step, 1.0 / step]
            if _is_isotropic(slip, friction):
                base = max(base, slip[0] / step)
            else:
                both = inverse_masses[tree]
                base = max(base, _shared_resistance(slip, by_friction, both, step))
                most = [(y + base * by) / (y * step) for y, by in zip(both, by_friction[:2], strict=True)]
            resistance = [base * by for by in by_friction]
            for row, entry in enumerate(resistance, first + 1):
                all_r[row], all_d[row] = entry, 1.0 / entry
            mus[number] = friction[0] * math.sqrt(base / normal)
            for tangent, entry in enumerate(slip):
                damping = resistance[tangent] / entry if entry > 0.0 else math.inf
                terms[first + 1 + tangent, 1] = min(damping, most[tangent])

    def _inverse_masses(
        self, data: mujoco.MjData, soft: Sequence[SlippingContact], firsts: list[int]
    ) -> dict[int, Numbers]:
        """Return upper bounds for the inverse mass of each tree's contacts along their two tangents [1/kg].

        The bound is a sum of diagonal elements, which is at least as large as any eigenvalue.
        """
        by_tree: dict[int, Numbers] = {}
        if not soft:
            return by_tree
        model = self.model
        places = [firsts[number] + 1 + tangent for number, _, _ in soft for tangent in (0, 1)]
        unit, along = np.zeros(data.nefc), np.zeros((len(places), model.nv))
        for row, place in zip(along, places, strict=True):
            unit[place] = 1.0
            mujoco.mj_mulJacTVec(model, data, row, unit)
            unit[place] = 0.0
        solved = np.empty_like(along)
        mujoco.mj_solveM(model, data, solved, along)
        responses = [float(matmul(directions, other)) for directions, other in zip(along, solved, strict=True)]
        for index, (_, tree, _) in enumerate(soft):
            both = by_tree.setdefault(tree, [1e-12, 1e-12])
            both[0] += responses[2 * index]
            both[1] += responses[2 * index + 1]
        return by_tree

    def soften_pyramid(self, data: mujoco.MjData, number: int, slip: Pair) -> None:
        """Reduce the damping of a pyramid's edges where it is too large along a tangent.

        R of the edges also carries the load and stays, so that the contacts reach their slip later.
        """
        contact, velocity, aref = data.contact, data.efc_vel, data.efc_aref
        first, friction = int(contact.efc_address[number]), contact.friction[number].tolist()
        for tangent, speed in enumerate(slip):
            edge = first + 2 * tangent
            damping, resistance = float(data.efc_KBIP[edge, 1]), float(data.efc_R[edge])
            resistance /= 2.0 * (friction[tangent] * friction[tangent])
            excess = max(0.0, damping - resistance / speed) if speed > 0.0 else 0.0
            apart = (velocity.item(edge) - velocity.item(edge + 1)) / 2.0
            aref[edge] += excess * apart
            aref[edge + 1] -= excess * apart


def _is_isotropic(slip: Pair, friction: Sequence[float]) -> bool:
    """Check whether a contact is equal along both tangents."""
    return slip[0] == slip[1] and friction[0] == friction[1]


def _shared_resistance(slip: Pair, by_friction: Numbers, inverse_masses: Numbers, step: float) -> float:
    """Return R of the first tangent for two tangents with different slip.

    A larger R, compared with the inverse mass S of the contacts, lets the softer tangent reach its slip sooner. The
    stiffer tangent slips with at least S dt R / (S + R), because more damping would overshoot. This slip must not
    exceed its own compliance, or a fiftieth of the other tangent's compliance.

    Args:
        slip: compliances of both tangents [m/s/N].
        by_friction: R of each tangent relative to the first one.
        inverse_masses: inverse masses along the tangents [1/kg].
        step: length of a step [s].
    """
    wanted = [speed / step / by for speed, by in zip(slip, by_friction[:2], strict=True)]
    softer = int(wanted[1] > wanted[0])
    stiffer = 1 - softer
    least = max(slip[stiffer], _MIN_COMPLIANCE_SHARE * slip[softer])
    room = inverse_masses[stiffer] * step - least
    exact = least * inverse_masses[stiffer] / room / by_friction[stiffer] if room > 0.0 else math.inf
    soft_enough = min(wanted[softer], _STIFF_FACTOR * inverse_masses[softer] / by_friction[softer], exact)
    return max(min(wanted), soft_enough)
