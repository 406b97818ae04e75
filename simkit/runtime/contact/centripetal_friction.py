"""Friction between bodies that swing together: the centripetal acceleration of what a hand carries.

The rows of friction ask for J a = -b v: that the slip v dies away at the rate b. But the slip also changes with the
Jacobian: dv/dt = J a + Jdot qvel. What a hand swings round on an arc of radius R needs the acceleration omega² R
towards the centre, which is just that second term; left out, the object creeps outwards at omega² R / b until friction
notices (1 mm/s for 1 rad/s at 0.5 m). So the term is taken off the reference of the tangents. Of it the part
b dt / 2 is left: the integrator moves along the chord and not along the arc.

For bodies that roll on each other the point of contact travels over both surfaces and the term is another one, so only
bodies that turn together are corrected, and along the tangents only.
"""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.runtime.contact.contact_conditions import ARRAY_THRESHOLD

_MIN_ANGULAR_VELOCITY: Final = 0.03
"""Angular velocity [rad/s] from which the correction counts: at 1 m it is 0.9 mm/s²."""

_MAX_RELATIVE_SHARE: Final = 0.2
"""Angular velocity of one body relative to the other, as a share of its own, up to which they turn together."""

Point = tuple[float, float, float]


class CentripetalFriction:
    """Contacts between moving bodies of one compiled model.

    Args:
        model: of the engine.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._is_elliptic = model.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
        bodies = model.geom_bodyid
        moves = model.body_treeid[bodies] >= 0
        self._body_of: list[int] = [*np.where(moves, bodies, -1).tolist(), -1]
        self._moves = np.array([*moves.tolist(), False])
        self._tree_of: list[int] = model.body_treeid.tolist()
        self._can_carry = model.ntree > 1 and self._is_elliptic
        self._jacobian = np.empty((3, model.nv))

    def find(self, data: mujoco.MjData) -> list[tuple[int, int, int]]:
        """Return the contacts between bodies of different models that turn together: number and both bodies.

        Args:
            data: of the engine, with velocities up to date.
        """
        found: list[tuple[int, int, int]] = []
        if not self._can_carry:
            return found
        if data.ncon > ARRAY_THRESHOLD and not self._moves[data.contact.geom].all(axis=1).any():
            return found
        body_of, tree_of = self._body_of, self._tree_of
        turns: dict[tuple[int, int], bool] = {}
        for number, (first, second) in enumerate(data.contact.geom.tolist()):
            pair = one, other = body_of[first], body_of[second]
            if one < 0 or other < 0 or tree_of[one] == tree_of[other]:
                continue
            together = turns.get(pair)
            if together is None:
                a, b, c = data.cvel[one, :3].tolist()
                d, e, f = data.cvel[other, :3].tolist()
                own = min(a * a + b * b + c * c, d * d + e * e + f * f)
                u, v, w = a - d, b - e, c - f
                apart = u * u + v * v + w * w  # a power would raise where a world that diverges overflows
                together = (
                    own > _MIN_ANGULAR_VELOCITY * _MIN_ANGULAR_VELOCITY
                    and apart < _MAX_RELATIVE_SHARE * _MAX_RELATIVE_SHARE * own
                )
                turns[pair] = together
            if together:
                found.append((number, one, other))
        return found

    def correct(self, data: mujoco.MjData, carried: list[tuple[int, int, int]]) -> list[tuple[int, float]]:
        """Take the term off the references of the tangents; for each pair of bodies that of its first contact's place.

        Args:
            data: of the engine.
            carried: contacts, as `find` gives them.

        Returns:
            Rows and their references as they were.
        """
        before: list[tuple[int, float]] = []
        contact, aref, damping = data.contact, data.efc_aref, data.efc_KBIP
        rows, dims, frames = contact.efc_address.tolist(), contact.dim.tolist(), contact.frame.tolist()
        half = float(self._model.opt.timestep) / 2.0
        known: dict[tuple[int, int], Point] = {}
        for number, one, other in carried:
            row = rows[number]
            if row < 0 or dims[number] < 3:
                continue
            bias = known.get((one, other))
            if bias is None:
                point = contact.pos[number]
                x, y, z = (self._bias(data, point, other) - self._bias(data, point, one)).tolist()
                bias = known[one, other] = x, y, z
            x, y, z = bias
            _, _, _, a, b, c, d, e, f = frames[number]
            share = max(0.0, 1.0 - half * damping.item(row + 1, 1))
            for place, along in ((row + 1, a * x + b * y + c * z), (row + 2, d * x + e * y + f * z)):
                old = aref.item(place)
                before.append((place, old))
                aref[place] = old - share * along
        return before

    def _bias(self, data: mujoco.MjData, point: npt.NDArray[np.float64], body: int) -> npt.NDArray[np.float64]:
        """Return the acceleration of a point of a body [m/s²] that follows from velocities alone, world frame."""
        mujoco.mj_jacDot(self._model, data, self._jacobian, None, point, body)
        return self._jacobian @ data.qvel
