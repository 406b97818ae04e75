"""Contacts of free bodies that spin: the contact point moves over the body, and its velocity changes with it.

The rows of a contact request accelerations J a along the normal and the tangents. The velocities J v along them also
change with the Jacobian: d(J v)/dt = J a + Jdot v. On the rim of a tilted disc that rolls (Euler's disc), Jdot v is the
angular velocity times the velocity of the contact point, up to 4 g. Without this term, the rim slips by Jdot v / b at
any step, b being the damping of the contact, and the disc gains a quarter of its energy in 4 s. The term cannot be
taken from `mj_jacDot`, which moves the point with the material: a ball that rolls would get a term and has none.

Therefore this module finds the contacts to which the present velocities lead at the end of the step, on a second
`MjData`. Jdot v is then (J' v - J v) / dt, with the Jacobian J' of the end.

The integrator moves a body along the chord of its path. The mean velocity of a contact in the step that led here is w =
J v - (dt / 2) Jdot v. The reference -b w - k r - Jdot v lets w decay, so that the contact neither opens nor slips on
average. It differs from the engine's by (1 - b dt / 2) Jdot v. The contact law gets the velocity J v + (dt / 2) Jdot v
of the normal. It then stops a body so that the distance stays the same over the step.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from typing import Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import squared_length

MIN_ACCELERATION: Final = 0.05
"""Least acceleration of the surface of a body by its spin [m/s²] for the correction; a contact slips by 0.1 mm/s.

It is the size of the body times the angular velocity times its part across the axis of symmetry: a cylinder that rolls
straight ahead has no term.
"""

MAX_REFERENCE: Final = 100.0
"""Largest reference of the tangents [m/s²] for the correction: a contact that slips faster than 0.2 m/s slides."""

MAX_BODIES: Final = 8
"""Largest number of free bodies that turn at all: more of them make a heap, where some spin in nearly all steps.

A body that sleeps has no velocity. The data of a reader do not contain the sleep itself.
"""

MAX_CONTACTS: Final = 8
"""Largest number of corrected contacts."""

MAX_TURN: Final = 0.25
"""Largest travel of a contact point in a step, as a fraction of its distance from the body's origin.

A point that travels farther has jumped to another end of the body.
"""

MAX_SLIP: Final = 2.0
"""Largest reference of the tangents, as a multiple of the term, that comes from the term and not from sliding.

With a larger one, the tangents stay as they are, because the friction of a sliding contact is opposite to its slip,
also if the slip turns.
"""

MARGIN: Final = 1e-3
"""Distance [m] at the end of the step up to which a contact counts as the successor of one now."""

_SLEEP: Final = int(mujoco.mjtEnableBit.mjENBL_SLEEP)
_OVERRIDE: Final = int(mujoco.mjtEnableBit.mjENBL_OVERRIDE)
_FREE: Final = int(mujoco.mjtJoint.mjJNT_FREE)
_SPHERE: Final = int(mujoco.mjtGeom.mjGEOM_SPHERE)
_ROUND: Final = (int(mujoco.mjtGeom.mjGEOM_CYLINDER), int(mujoco.mjtGeom.mjGEOM_CAPSULE))
_ELLIPTIC: Final = mujoco.mjtCone.mjCONE_ELLIPTIC

Point = tuple[float, float, float]


class ContactPointTerm(NamedTuple):
    """Term Jdot v of one contact.

    Attributes:
        row: row of the normal.
        terms: terms along the normal and both tangents [m/s²].
    """

    row: int
    terms: Point


class _Motion(NamedTuple):
    """Motion of a free body at one time, in the world frame.

    Attributes:
        origin: position of the body's origin [m].
        velocity: velocity of the origin [m/s].
        spin: angular velocity [rad/s].
    """

    origin: Point
    velocity: Point
    spin: Point

    def at(self, point: Point) -> Point:
        """Return the velocity of the body at a point [m/s]."""
        (x, y, z), (a, b, c), (u, v, w) = point, self.origin, self.spin
        x, y, z = x - a, y - b, z - c
        p, q, r = self.velocity
        return p + v * z - w * y, q + w * x - u * z, r + u * y - v * x


_STATIC: Final = (_Motion((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),) * 2


class ContactPointCorrection:
    """Shifted references and velocities of the rows of contacts.

    Args:
        data: MuJoCo's data with velocities up to date.
        terms: terms of the contacts.
        step: length of a step [s].
    """

    def __init__(self, data: mujoco.MjData, terms: list[ContactPointTerm], step: float) -> None:
        self._aref, self._velocity = data.efc_aref, data.efc_vel
        self._before: list[tuple[int, float]] = []
        self._velocities: list[tuple[int, float]] = []
        self._tangents: list[tuple[int, float]] = []
        for row, (along_normal, across, along) in terms:
            rest = min(1.0, 0.5 * step * data.efc_KBIP.item(row, 1))
            velocity = self._velocity.item(row)
            self._velocities.append((row, velocity))
            self._velocity[row] = velocity + 0.5 * step * along_normal
            self._before.append((row, self._shift(row, (rest - 1.0) * along_normal)))
            slip = math.hypot(self._aref.item(row + 1), self._aref.item(row + 2))
            if slip <= MAX_SLIP * math.hypot(across, along):
                for place, term in ((row + 1, across), (row + 2, along)):
                    self._before.append((place, self._shift(place, rest * term)))
                    self._tangents.append((place, term))

    def shift_tangents(self) -> list[tuple[int, float]]:
        """Subtract the terms from the tangents, whose references are -b w until then; return the rows to restore.

        The contact law decides before this by -b w whether a contact slides.

        Returns:
            Rows with their previous references.
        """
        return [(row, self._shift(row, -term)) for row, term in self._tangents]

    def restore(self, *, keeps_references: bool) -> None:
        """Restore the velocities of the normals, and the references unless they are kept."""
        for row, velocity in self._velocities:
            self._velocity[row] = velocity
        if not keeps_references:
            for row, reference in self._before:
                self._aref[row] = reference

    def _shift(self, row: int, change: float) -> float:
        """Add to the reference of a row; return the previous one."""
        before: float = self._aref.item(row)
        self._aref[row] = before + change
        return before


class ContactPointMotion:
    """Contacts of the free bodies of one compiled model with each other and with static geoms.

    Args:
        model: MuJoCo's model.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._data: mujoco.MjData | None = None
        joints = np.flatnonzero(model.jnt_type == _FREE)
        trees = model.body_treeid[model.jnt_bodyid[joints]]
        alone = model.tree_dofnum[trees] == 6
        self._joints: dict[int, int] = dict(zip(trees[alone].tolist(), joints[alone].tolist(), strict=True))
        trees_of_geoms = model.body_treeid[model.geom_bodyid]
        self._tree_of = np.append(trees_of_geoms, -1)  # the last item is for contacts without a geom
        limits, axes = [], []
        for tree in self._joints:
            geoms = np.flatnonzero((trees_of_geoms == tree) & (model.geom_type != _SPHERE))
            reach = (np.linalg.norm(model.geom_pos[geoms], axis=1) + model.geom_rbound[geoms]).max(initial=0.0)
            limits.append(MIN_ACCELERATION / float(reach) if reach > 0.0 else math.inf)
            axes.append(_axis_of_symmetry(model, geoms))
        self._limits, self._trees = np.array(limits), np.array(list(self._joints), np.intp)
        self._axes = np.array(axes).T
        self._least = min(limits, default=math.inf)
        firsts = model.jnt_dofadr[list(self._joints.values())].astype(np.intp)
        self._spins = (firsts[:, None] + np.arange(3, 6)).reshape(-1)
        self._plain = list(zip(self._joints, (firsts + 3).tolist(), limits, axes, strict=True))

    @classmethod
    def of(cls, model: mujoco.MjModel) -> ContactPointMotion | None:
        """Return the contact points of a model; None if no free body can have the term."""
        if model.opt.cone != _ELLIPTIC or model.nflex or not (model.jnt_type == _FREE).any():
            return None
        found = cls(model)
        return found if found._least < math.inf else None

    def find(self, data: mujoco.MjData) -> list[int]:
        """Return the numbers of the contacts to correct.

        Args:
            data: MuJoCo's data with velocities up to date.
        """
        spinning = self._spinning(data) if data.ncon else None
        if spinning is None:
            return []
        trees, contact = self._tree_of[data.contact.geom], data.contact
        numbers = spinning[trees].any(axis=1).nonzero()[0].tolist()
        if len(numbers) > MAX_CONTACTS:
            return []
        free, rows, aref = self._joints.keys() | {-1}, contact.efc_address, data.efc_aref
        found = []
        for number in numbers:
            row = rows.item(number)
            if row < 0 or contact.dim[number] < 3 or not free.issuperset(trees[number].tolist()):
                continue
            if math.hypot(aref.item(row + 1), aref.item(row + 2)) <= MAX_REFERENCE:
                found.append(number)
        return found

    def _spinning(self, data: mujoco.MjData) -> npt.NDArray[np.bool_] | None:
        """Return a mask of the trees that spin fast, with False for static bodies at its end; None if there are none.

        Most worlds have few free bodies, and none that spins. Plain numbers then take half the time of arrays.
        """
        if len(self._plain) <= MAX_BODIES:
            velocities, fast = data.qvel.tolist(), []
            for tree, start, limit, (a, b, c) in self._plain:
                x, y, z = velocities[start : start + 3]
                square, along = x * x + y * y + z * z, x * a + y * b + z * c
                if square * (square - along * along) > limit * limit:
                    fast.append(tree)
        else:
            spins = data.qvel.take(self._spins)
            if squared_length(spins, self._least) <= self._least:
                return None
            (x, y, z), (a, b, c) = spins.reshape(-1, 3).T, self._axes
            square, along = x * x + y * y + z * z, x * a + y * b + z * c
            if np.count_nonzero(square) > MAX_BODIES:
                return None
            fast = self._trees[square * (square - along * along) > self._limits * self._limits].tolist()
        if not fast:
            return None
        found = np.zeros(self._model.ntree + 1, bool)
        found[fast] = True
        return found

    def correct(self, data: mujoco.MjData, carried: Collection[tuple[int, int, int]]) -> ContactPointCorrection | None:
        """Shift the normals of the contacts that need it; None if there are none.

        Args:
            data: MuJoCo's data with velocities up to date.
            carried: contacts of `CentripetalFriction.find`, which have a term already.
        """
        numbers = self.find(data)
        if not numbers:
            return None
        own = {number for number, _, _ in carried}
        numbers = [number for number in numbers if number not in own]
        terms = self._terms(data, numbers) if numbers else []
        return ContactPointCorrection(data, terms, float(self._model.opt.timestep)) if terms else None

    def _terms(self, data: mujoco.MjData, numbers: list[int]) -> list[ContactPointTerm]:
        """Return the terms of contacts that `find` returned; a contact without a successor has none.

        Args:
            data: MuJoCo's data with velocities up to date.
            numbers: numbers of the contacts.
        """
        step, contact, later = float(self._model.opt.timestep), data.contact, self._at_end_of_step(data)
        places, motions = later.contact.pos.tolist(), self._motions(data, later, numbers)
        rows, geoms = contact.efc_address.tolist(), contact.geom.tolist()
        candidates: dict[tuple[int, int], list[int]] = {}
        for number, (first, second) in enumerate(later.contact.geom.tolist()):
            candidates.setdefault((first, second), []).append(number)
        found = []
        for number in numbers:
            row, (first, second) = rows[number], geoms[number]
            same = candidates.get((first, second))
            bounces = contact.solref.item(number, 0) <= 0.0
            if contact.dist.item(number) > MARGIN or bounces or not same:
                continue
            place = contact.pos[number].tolist()
            nearest = min(same, key=lambda k: math.dist(places[k], place))
            one, other = (motions[tree] for tree in self._tree_of[[first, second]].tolist())
            radius = max(math.dist(place, motion[0].origin) for motion in (one, other) if motion is not _STATIC)
            if math.dist(places[nearest], place) > MAX_TURN * radius:
                continue
            same.remove(nearest)
            now = _difference(other[0].at(place), one[0].at(place))
            then = _difference(other[1].at(places[nearest]), one[1].at(places[nearest]))
            frame, normal = contact.frame[number].tolist(), later.contact.frame[nearest, :3].tolist()
            found.append(ContactPointTerm(row, _terms(frame, normal, now, then, step)))
        return found

    def _at_end_of_step(self, data: mujoco.MjData) -> mujoco.MjData:
        """Return data with the contacts that the present velocities lead to at the end of the step."""
        model, option = self._model, self._model.opt
        if self._data is None:
            self._data = mujoco.MjData(model)
        own, step = self._data, float(option.timestep)
        own.qpos[:] = data.qpos
        if model.nmocap:
            own.mocap_pos[:], own.mocap_quat[:] = data.mocap_pos, data.mocap_quat
        mujoco.mj_integratePos(model, own.qpos, data.qvel, step)
        enabled, margin = option.enableflags, option.o_margin
        # a body that sleeps may have been moved; a contact may open within the step
        option.enableflags, option.o_margin = (enabled & ~_SLEEP) | _OVERRIDE, MARGIN
        try:
            mujoco.mj_kinematics(model, own)
            mujoco.mj_comPos(model, own)
            mujoco.mj_collision(model, own)
        finally:
            option.enableflags, option.o_margin = enabled, margin
        return own

    def _motions(
        self, data: mujoco.MjData, later: mujoco.MjData, numbers: list[int]
    ) -> dict[int, tuple[_Motion, _Motion]]:
        """Return the motions of trees with the present velocities, at the places of both data; -1 is static."""
        model, found = self._model, {-1: _STATIC}
        for number in numbers:
            for tree in self._tree_of[data.contact.geom[number]].tolist():
                if tree in found:
                    continue
                joint = self._joints[tree]
                body, start = int(model.jnt_bodyid[joint]), int(model.jnt_dofadr[joint])
                a, b, c, x, y, z = data.qvel[start : start + 6].tolist()
                both = []
                for each in (data, later):
                    p, q, r, s, t, u, v, w, o = each.xmat[body].tolist()
                    spin = p * x + q * y + r * z, s * x + t * y + u * z, v * x + w * y + o * z
                    px, py, pz = each.xpos[body].tolist()
                    both.append(_Motion((px, py, pz), (a, b, c), spin))
                found[tree] = both[0], both[1]
        return found


def _axis_of_symmetry(model: mujoco.MjModel, geoms: npt.NDArray[np.intp]) -> list[float]:
    """Return the axis of a single cylinder or capsule in the frame of its body; zero for other geoms.

    Args:
        model: MuJoCo's model.
        geoms: numbers of the geoms of a body without its spheres.
    """
    if len(geoms) != 1 or model.geom_type[geoms[0]] not in _ROUND:
        return [0.0, 0.0, 0.0]
    axes = np.empty(9)
    mujoco.mju_quat2Mat(axes, model.geom_quat[geoms[0]])
    found: list[float] = axes[2::3].tolist()
    return found


def _difference(one: Point, other: Point) -> Point:
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]


def _dot(one: Sequence[float], other: Sequence[float]) -> float:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def _terms(frame: list[float], normal: list[float], now: Point, then: Point, step: float) -> Point:
    """Return the changes of the velocities along normal and tangents, per time [m/s²].

    Args:
        frame: normal and tangents now, shape (9,).
        normal: normal at the end of the step.
        now: relative velocity of both bodies at the contact now [m/s].
        then: relative velocity at the contact at the end of the step [m/s].
        step: length of the step [s].
    """
    opening = _dot(normal, then)
    x, y, z = then[0] - opening * normal[0], then[1] - opening * normal[1], then[2] - opening * normal[2]
    across, along = (_dot(axis, (x, y, z)) - _dot(axis, now) for axis in (frame[3:6], frame[6:]))
    return (opening - _dot(frame[:3], now)) / step, across / step, along / step
