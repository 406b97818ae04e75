"""Contacts that slip with the force on them.

A row of friction obeys R f = aref - a, with aref = -B v. ODE's slip is v' = -c f of the velocity after the step, so
R = c/dt and B = 1/dt. Under MuJoCo's elliptic cone R of the two tangents is tied (R·mu² is one number), so for two
compliances one R is chosen and B is R/c for each: at a constant force both slip exactly, and after a change of it they
get there at ODE's pace as long as R is not small beside the inverse of the mass that is pushed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Numbers = list[float]
Soft = tuple[int, int, Numbers]
"""A contact, the kinematic tree that slips, and its compliances along its two tangents [m/s/N]."""

_STIFF = 4.0  # times what contacts yield: an R beside which they do not count
_LEAST = 0.02  # of the larger of two compliances: so much both have, so that the softer one is not sluggish


class Softness:
    """Makes contacts of one compiled model soft, once its constraints are made."""

    def __init__(self, model: Any) -> None:
        self.model = model

    def soften(self, data: Any, soft: Sequence[Soft]) -> None:
        """Makes the friction of elliptic contacts soft."""
        yields = self._yields(data, soft)
        step, contact = float(self.model.opt.timestep), data.contact
        for number, tree, slip in soft:
            first = int(contact.efc_address[number])
            friction = contact.friction[number, : int(contact.dim[number]) - 1].copy()
            by_friction = (friction[0] / friction) ** 2
            # by more it would overshoot, where there is next to no compliance
            base, most = float(data.efc_R[first + 1]), [1.0 / step, 1.0 / step]
            if _is_even(slip, friction):
                base = max(base, slip[0] / step)
            else:
                both = yields[tree]
                base = max(base, _shared_resistance(slip, by_friction[:2].tolist(), both, step))
                most = [(y + base * float(by)) / (y * step) for y, by in zip(both, by_friction, strict=False)]
            resistance = base * by_friction
            rows = slice(first + 1, first + 1 + len(friction))
            data.efc_R[rows], data.efc_D[rows] = resistance, 1.0 / resistance
            contact.mu[number] = friction[0] * math.sqrt(base / float(data.efc_R[first]))
            for tangent, one in enumerate(slip):
                damping = float(resistance[tangent]) / one if one > 0.0 else math.inf
                data.efc_KBIP[first + 1 + tangent, 1] = min(damping, most[tangent])

    def _yields(self, data: Any, soft: Sequence[Soft]) -> dict[int, Numbers]:
        """How much all contacts of a tree yield to forces along their two tangents at most, summed [1/kg].

        Only of contacts whose two tangents differ. A sum of diagonal elements is no less than any eigenvalue.
        """
        found: dict[int, Numbers] = {}
        model = self.model
        unit, along, solved = np.zeros(data.nefc), np.zeros(model.nv), np.zeros((1, model.nv))
        for number, tree, slip in soft:
            if _is_even(slip, data.contact.friction[number]):
                continue
            both = found.setdefault(tree, [1e-12, 1e-12])
            for tangent in range(2):
                place = int(data.contact.efc_address[number]) + 1 + tangent
                unit[place] = 1.0
                mujoco.mj_mulJacTVec(model, data, along, unit)
                mujoco.mj_solveM(model, data, solved, along[None])
                unit[place] = 0.0
                both[tangent] += float(along @ solved[0])
        return found

    def soften_pyramid(self, data: Any, number: int, slip: Numbers) -> None:
        """Takes of the damping of a pyramid's edges what is too much along each tangent.

        Their R holds up the load as well and stays, so it takes longer until they slip as they are to.
        """
        first, friction = int(data.contact.efc_address[number]), data.contact.friction[number]
        for tangent, one in enumerate(slip):
            edge = first + 2 * tangent
            damping = float(data.efc_KBIP[edge, 1])
            resistance = float(data.efc_R[edge]) / (2.0 * float(friction[tangent]) ** 2)
            excess = max(0.0, damping - resistance / one) if one > 0.0 else 0.0
            apart = (data.efc_vel[edge] - data.efc_vel[edge + 1]) / 2.0
            data.efc_aref[edge] += excess * apart
            data.efc_aref[edge + 1] -= excess * apart


def _is_even(slip: Numbers, friction: Floats) -> bool:
    """Whether a contact is the same along both tangents."""
    return slip[0] == slip[1] and bool(friction[0] == friction[1])


def _shared_resistance(slip: Numbers, by_friction: Numbers, yields: Numbers, step: float) -> float:
    """R of the first tangent, where the second has `by_friction` as much of it and the two slip differently.

    The larger it is beside what the contacts yield, S, the sooner the softer one slips as it is to. But the stiffer one
    slips with S dt R / (S + R) at least, as damping by more than that would overshoot; that is not to be more than its
    own compliance, or a fiftieth of the other's.
    """
    wanted = [one / step / by for one, by in zip(slip, by_friction, strict=True)]
    softer = int(wanted[1] > wanted[0])
    stiffer = 1 - softer
    least = max(slip[stiffer], _LEAST * slip[softer])
    room = yields[stiffer] * step - least
    exact = least * yields[stiffer] / room / by_friction[stiffer] if room > 0.0 else math.inf
    soft_enough = min(wanted[softer], _STIFF * yields[softer] / by_friction[softer], exact)
    return max(min(wanted), soft_enough)
