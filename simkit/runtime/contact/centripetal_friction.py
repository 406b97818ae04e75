"""Friction between bodies that rotate together: centripetal acceleration of an object in a gripper.

The rows of friction request J a = -b v, so that the slip v decays at the rate b. The slip also changes with the
Jacobian: dv/dt = J a + Jdot qvel. An object that a gripper carries on an arc of radius R needs the acceleration omega²
R towards the centre, which is exactly this second term. Without it, the object creeps outwards at omega² R / b until
friction compensates (1 mm/s for 1 rad/s at 0.5 m). Therefore the term is subtracted from the reference of the tangents.
The fraction b dt / 2 of it stays, because the integrator moves along the chord and not along the arc.

On bodies that roll on each other, the contact point travels over both surfaces and the term differs. Therefore only
bodies that rotate together are corrected, and only along the tangents.
"""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul
from simkit.runtime.contact.contact_conditions import ARRAY_THRESHOLD

_MIN_ANGULAR_VELOCITY: Final = 0.03
"""Least angular velocity for the correction [rad/s]: at 1 m it is 0.9 mm/s²."""

_MAX_RELATIVE_SHARE: Final = 0.2
"""Largest relative angular velocity of two bodies that rotate together, as a fraction of the slower one's.
"""

Point = tuple[float, float, float]


class CentripetalFriction:
    """Contacts between moving bodies of one compiled model.

    Args:
        model: MuJoCo's model.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._is_elliptic = model.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
        bodies = model.geom_bodyid
        moves = model.body_treeid[bodies] >= 0
        self._bodies = np.append(np.where(moves, bodies, -1), -1)  # the last item is for contacts without a geom
        self._trees = model.body_treeid
        self._body_of, self._tree_of = self._bodies.tolist(), self._trees.tolist()
        self._can_carry = model.ntree > 1 and self._is_elliptic
        self._jacobian = np.empty((3, model.nv))

    def find(self, data: mujoco.MjData) -> list[tuple[int, int, int]]:
        """Return the contacts between bodies of different models that rotate together: contact number and both bodies.

        Args:
            data: MuJoCo's data with velocities up to date.
        """
        contacts: list[tuple[int, int, int]] = []
        if not self._can_carry:
            return contacts
        if data.ncon > ARRAY_THRESHOLD:
            return self._find_many(data)
        body_of, tree_of = self._body_of, self._tree_of
        turns: dict[tuple[int, int], bool] = {}
        for number, (first, second) in enumerate(data.contact.geom.tolist()):
            pair = this, other = body_of[first], body_of[second]
            if this < 0 or other < 0 or tree_of[this] == tree_of[other]:
                continue
            together = turns.get(pair)
            if together is None:
                a, b, c = data.cvel[this, :3].tolist()
                d, e, f = data.cvel[other, :3].tolist()
                slower = min(a * a + b * b + c * c, d * d + e * e + f * f)
                u, v, w = a - d, b - e, c - f
                apart = u * u + v * v + w * w  # `**` would raise on overflow in a diverging world
                together = (
                    slower > _MIN_ANGULAR_VELOCITY * _MIN_ANGULAR_VELOCITY
                    and apart < _MAX_RELATIVE_SHARE * _MAX_RELATIVE_SHARE * slower
                )
                turns[pair] = together
            if together:
                contacts.append((number, this, other))
        return contacts

    def _find_many(self, data: mujoco.MjData) -> list[tuple[int, int, int]]:
        """Return the contacts as `find` does, on arrays: 15 instead of 50 µs for the 100 contacts of a heap."""
        this, other = self._bodies[data.contact.geom].T
        numbers = ((this >= 0) & (other >= 0)).nonzero()[0]
        if not numbers.size:
            return []
        this, other = this[numbers], other[numbers]
        x, y, z = data.cvel[:, :3].T
        squares = x * x + y * y + z * z
        slower = np.minimum(squares[this], squares[other])
        u, v, w = x[this] - x[other], y[this] - y[other], z[this] - z[other]
        together = slower > _MIN_ANGULAR_VELOCITY * _MIN_ANGULAR_VELOCITY
        together &= u * u + v * v + w * w < _MAX_RELATIVE_SHARE * _MAX_RELATIVE_SHARE * slower
        together &= self._trees[this] != self._trees[other]
        columns = numbers[together].tolist(), this[together].tolist(), other[together].tolist()
        return list(zip(*columns, strict=True))

    def correct(
        self, data: mujoco.MjData, carried: list[tuple[int, int, int]], engine: npt.NDArray[np.float64]
    ) -> list[tuple[int, float]]:
        """Subtract the centripetal term from the references of the tangents.

        All contacts of a pair of bodies use the term at the position of their first contact. Friction that stops the
        slip within the step has the damping 1 / step.

        Args:
            data: MuJoCo's data.
            carried: contacts from `find`.
            engine: references before the contact law changed them, shape (nefc,).

        Returns:
            Changed rows, each with its previous reference.
        """
        before: list[tuple[int, float]] = []
        contact, aref, damping = data.contact, data.efc_aref, data.efc_KBIP
        rows, dims, frames = contact.efc_address.tolist(), contact.dim.tolist(), contact.frame.tolist()
        half = float(self._model.opt.timestep) / 2.0
        known: dict[tuple[int, int], Point] = {}
        for number, this, other in carried:
            row = rows[number]
            if row < 0 or dims[number] < 3:
                continue
            bias = known.get((this, other))
            if bias is None:
                point = contact.pos[number]
                x, y, z = (self._bias(data, point, other) - self._bias(data, point, this)).tolist()
                bias = known[this, other] = x, y, z
            x, y, z = bias
            _, _, _, a, b, c, d, e, f = frames[number]
            stops = any(aref.item(place) != engine.item(place) for place in (row + 1, row + 2))
            share = 0.5 if stops else max(0.0, 1.0 - half * damping.item(row + 1, 1))
            for place, along in ((row + 1, a * x + b * y + c * z), (row + 2, d * x + e * y + f * z)):
                old = aref.item(place)
                before.append((place, old))
                aref[place] = old - share * along
        return before

    def _bias(self, data: mujoco.MjData, point: npt.NDArray[np.float64], body: int) -> npt.NDArray[np.float64]:
        """Return the velocity-dependent acceleration of a point of a body [m/s²], world frame."""
        mujoco.mj_jacDot(self._model, data, self._jacobian, None, point, body)
        bias: npt.NDArray[np.float64] = matmul(self._jacobian, data.qvel)
        return bias
