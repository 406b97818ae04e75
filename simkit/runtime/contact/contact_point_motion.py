"""Contacts of free bodies that spin: the contact point moves over the body, and its velocity changes with it.

The rows of a contact request accelerations J a along the normal and the tangents. The velocities J v along them also
change with the Jacobian: d(J v)/dt = J a + Jdot v. On the rim of a tilted disc that rolls (Euler's disc), Jdot v is the
angular velocity times the velocity of the contact point, up to 4 g. Without this term, the rim slips by Jdot v / b at
any step, b being the damping of the contact, and the disc gains a quarter of its energy in 4 s. The term cannot be
taken from `mj_jacDot`, which moves the point with the material: a ball that rolls would get a term and has none.

Therefore this module moves the bodies without forces over a step (`RigidRotation`), on a second `MjData`, and finds the
contacts there. With their Jacobian J' and the velocities v' of the free motion, the velocity of a contact changes by

    D = (J' v' - J v) / dt

in addition to the effect of forces. The accelerations a of the engine contain the gyroscopic acceleration g, which is
part of the free motion. So the velocity at the end of the step is J v + dt (J (a - g) + D).

The integrator moves a body along the chord of its path. The mean velocity of a contact in the step that led here is w =
J v - (dt / 2) D. The reference -b w - k r - D + J g lets w decay, so that the contact neither opens nor slips on
average. It differs from the engine's by (1 - b dt / 2) D - J g. The contact law gets the velocity J v + (dt / 2) D of
the normal. It then stops a body so that the distance stays the same over the step.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Final, NamedTuple

import mujoco
import numpy as np

from simkit.runtime.contact.rigid_rotation import RigidRotation
from simkit.runtime.contact.spinning_bodies import SpinningBodies

MAX_REFERENCE: Final = 100.0
"""Largest reference of the tangents [m/s²] for the correction: a contact that slips faster than 0.2 m/s slides."""

MAX_CONTACTS: Final = 8
"""Largest number of corrected contacts."""

MAX_TURN: Final = 0.5
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
_ELLIPTIC: Final = mujoco.mjtCone.mjCONE_ELLIPTIC

Point = tuple[float, float, float]


class ContactPointTerm(NamedTuple):
    """Terms of one contact along the normal and both tangents.

    Attributes:
        row: row of the normal.
        changes: changes D of the velocities in free motion, per time [m/s²].
        gyroscopic: gyroscopic accelerations J g [m/s²].
    """

    row: int
    changes: Point
    gyroscopic: Point


class _Motion(NamedTuple):
    """Velocities or accelerations of a rigid body at one time, in the world frame.

    Attributes:
        origin: position of a point of the body [m].
        linear: velocity [m/s] or acceleration [m/s²] of this point.
        angular: angular velocity [rad/s] or acceleration [rad/s²].
    """

    origin: Point
    linear: Point
    angular: Point

    def at(self, point: Point) -> Point:
        """Return the velocity or acceleration of the body at a point."""
        (x, y, z), (a, b, c), (u, v, w) = point, self.origin, self.angular
        x, y, z = x - a, y - b, z - c
        p, q, r = self.linear
        return p + v * z - w * y, q + w * x - u * z, r + u * y - v * x


_AT_REST: Final = _Motion((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


class _FreeMotions(NamedTuple):
    """Motions of bodies without forces.

    Attributes:
        gyroscopic: accelerations, by body.
        ends: coordinates and velocities at the end of the step.
    """

    gyroscopic: dict[int, _Motion]
    ends: list[tuple[RigidRotation, list[float], list[float]]]


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
        for row, (along_normal, *along_tangents), (lift, *turning) in terms:
            rest = min(1.0, 0.5 * step * data.efc_KBIP.item(row, 1))
            velocity = self._velocity.item(row)
            self._velocities.append((row, velocity))
            self._velocity[row] = velocity + 0.5 * step * along_normal
            self._before.append((row, self._shift(row, (rest - 1.0) * along_normal + lift)))
            slip = math.hypot(self._aref.item(row + 1), self._aref.item(row + 2))
            if slip <= MAX_SLIP * math.hypot(*along_tangents):
                for place, (change, turn) in enumerate(zip(along_tangents, turning, strict=True), row + 1):
                    self._before.append((place, self._shift(place, rest * change)))
                    self._tangents.append((place, change - turn))

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
    """Contacts of the free bodies of one compiled model.

    Args:
        model: MuJoCo's model.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._data: mujoco.MjData | None = None
        self._spinning = SpinningBodies(model)
        trees = model.body_treeid
        self._body_of: list[int] = model.geom_bodyid.tolist()
        self._roots: list[int] = model.body_rootid.tolist()
        self._moves: list[bool] = (trees >= 0).tolist()
        self._is_free: list[bool] = np.isin(trees, list(self._spinning.joints)).tolist()
        self._tree_of = np.append(
            model.body_treeid[model.geom_bodyid], -1
        )  # the last item is for flexes without a geom
        single = np.bincount(trees[trees >= 0], minlength=model.ntree) == 1
        joints = [joint for tree, joint in self._spinning.joints.items() if single[tree]]
        self._rotations = {int(model.jnt_bodyid[joint]): RigidRotation(model, joint) for joint in joints}

    @classmethod
    def of(cls, model: mujoco.MjModel) -> ContactPointMotion | None:
        """Return the contact points of a model; None if no free body can have the term."""
        if model.opt.cone != _ELLIPTIC or model.nflex or not (model.jnt_type == _FREE).any():
            return None
        correction = cls(model)
        return correction if correction._spinning.can_spin else None

    def find(self, data: mujoco.MjData) -> list[int]:
        """Return the numbers of the contacts to correct.

        Args:
            data: MuJoCo's data with velocities up to date.
        """
        spinning = self._spinning.find(data) if data.ncon else None
        if spinning is None:
            return []
        trees, contact = self._tree_of[data.contact.geom], data.contact
        numbers = spinning[trees].any(axis=1).nonzero()[0].tolist()
        if len(numbers) > MAX_CONTACTS:
            return []
        rows, aref = contact.efc_address, data.efc_aref
        fast_contacts = []
        for number in numbers:
            row = rows.item(number)
            if row < 0 or contact.dim[number] < 3:
                continue
            if math.hypot(aref.item(row + 1), aref.item(row + 2)) <= MAX_REFERENCE:
                fast_contacts.append(number)
        return fast_contacts

    def correct(self, data: mujoco.MjData, carried: Collection[tuple[int, int, int]]) -> ContactPointCorrection | None:
        """Shift the normals of the contacts that need it; None if there are none.

        Args:
            data: MuJoCo's data with velocities up to date.
            carried: contacts of `CentripetalFriction.find`, which have a term already.
        """
        numbers = self.find(data)
        if not numbers:
            return None
        corrected = {number for number, _, _ in carried}
        numbers = [number for number in numbers if number not in corrected]
        terms = self._terms(data, numbers) if numbers else []
        return ContactPointCorrection(data, terms, float(self._model.opt.timestep)) if terms else None

    def _terms(self, data: mujoco.MjData, numbers: list[int]) -> list[ContactPointTerm]:
        """Return the terms of contacts that `find` returned; a contact without a successor has none.

        Args:
            data: MuJoCo's data with velocities up to date.
            numbers: numbers of the contacts.
        """
        step, contact, body_of = float(self._model.opt.timestep), data.contact, self._body_of
        geoms, rows = contact.geom.tolist(), contact.efc_address.tolist()
        places, frames, distances = contact.pos.tolist(), contact.frame.tolist(), contact.dist.tolist()
        bodies = dict.fromkeys(body_of[geom] for number in numbers for geom in geoms[number])
        now = {body: self._velocities(data, body) for body in bodies}
        motions = self._free_motions(data, bodies)
        end = self._at_end_of_step(data, motions)
        then = {body: self._velocities(end, body) for body in bodies}
        places_then, frames_then = end.contact.pos.tolist(), end.contact.frame.tolist()
        candidates: dict[tuple[int, int], list[int]] = {}
        for number, (first, second) in enumerate(end.contact.geom.tolist()):
            candidates.setdefault((first, second), []).append(number)
        terms = []
        for number in numbers:
            (first, second), place = geoms[number], places[number]
            this, other, same = body_of[first], body_of[second], candidates.get((first, second))
            if distances[number] > MARGIN or not same or contact.solref.item(number, 0) <= 0.0:  # open, or bouncing
                continue
            nearest = min(same, key=lambda k: math.dist(places_then[k], place))
            later = places_then[nearest]
            radius = max(math.dist(place, now[body].origin) for body in (this, other) if self._is_free[body])
            if math.dist(later, place) > MAX_TURN * radius:
                continue
            same.remove(nearest)
            before, after = _difference(now, this, other, place), _difference(then, this, other, later)
            changes = _changes(frames[number], frames_then[nearest], before, after, step)
            turning, frame = _difference(motions.gyroscopic, this, other, place), frames[number]
            gyroscopic = _dot(frame[:3], turning), _dot(frame[3:6], turning), _dot(frame[6:], turning)
            terms.append(ContactPointTerm(rows[number], changes, gyroscopic))
        return terms

    def _free_motions(self, data: mujoco.MjData, bodies: Iterable[int]) -> _FreeMotions:
        """Return the motion without forces of those bodies whose rotation a step resolves."""
        motions, step = _FreeMotions({}, []), float(self._model.opt.timestep)
        for body in bodies:
            rotation = self._rotations.get(body)
            if rotation is None:
                continue
            position, velocity = data.qpos[rotation.coordinates].tolist(), data.qvel[rotation.dofs].tolist()
            if rotation.is_resolved(velocity[3:], step):
                x, y, z, *turning = rotation.gyroscopic_acceleration(position[3:], velocity[3:])
                p, q, r = data.xpos[body].tolist()
                u, v, w = (_dot(row, turning) for row in data.xmat[body].reshape(3, 3).tolist())
                motions.gyroscopic[body] = _Motion((p, q, r), (x, y, z), (u, v, w))
                motions.ends.append((rotation, *rotation.moved(position, velocity, step)))
        return motions

    def _at_end_of_step(self, data: mujoco.MjData, motions: _FreeMotions) -> mujoco.MjData:
        """Return data with the contacts and velocities to which the motion without forces leads at the end of the step.

        Args:
            data: MuJoCo's data with velocities up to date.
            motions: motions of bodies that turn; all other velocities stay.
        """
        model, option = self._model, self._model.opt
        if self._data is None:
            self._data = mujoco.MjData(model)
        end = self._data
        end.qpos[:], end.qvel[:] = data.qpos, data.qvel
        if model.nmocap:
            end.mocap_pos[:], end.mocap_quat[:] = data.mocap_pos, data.mocap_quat
        mujoco.mj_integratePos(model, end.qpos, data.qvel, option.timestep)
        for rotation, position, velocity in motions.ends:
            end.qpos[rotation.coordinates], end.qvel[rotation.dofs] = position, velocity
        enabled, margin = option.enableflags, option.o_margin
        # a body that sleeps may have been moved; a contact may open within the step
        option.enableflags, option.o_margin = (enabled & ~_SLEEP) | _OVERRIDE, MARGIN
        try:
            mujoco.mj_kinematics(model, end)
            mujoco.mj_comPos(model, end)
            mujoco.mj_collision(model, end)
            mujoco.mj_comVel(model, end)
        finally:
            option.enableflags, option.o_margin = enabled, margin
        return end

    def _velocities(self, data: mujoco.MjData, body: int) -> _Motion:
        """Return the velocities of a body, about the centre of mass of its kinematic tree."""
        if not self._moves[body]:
            return _AT_REST
        u, v, w, x, y, z = data.cvel[body].tolist()
        a, b, c = data.subtree_com[self._roots[body]].tolist()
        return _Motion((a, b, c), (x, y, z), (u, v, w))


def _difference(motions: Mapping[int, _Motion], this: int, other: int, place: Point) -> Point:
    """Return the velocity or acceleration of a body relative to another one at a place."""
    (x, y, z), (u, v, w) = motions.get(this, _AT_REST).at(place), motions.get(other, _AT_REST).at(place)
    return u - x, v - y, w - z


def _dot(first: Sequence[float], other: Sequence[float]) -> float:
    return first[0] * other[0] + first[1] * other[1] + first[2] * other[2]


def _changes(frame: list[float], frame_then: list[float], now: Point, then: Point, step: float) -> Point:
    """Return the changes of the velocities along normal and tangents, per time [m/s²].

    Args:
        frame: normal and tangents now, shape (9,).
        frame_then: the same at the end of the step.
        now: relative velocity of both bodies at the contact now [m/s].
        then: relative velocity at the contact at the end of the step [m/s].
        step: length of the step [s].
    """
    normal = frame_then[:3]
    opening = _dot(normal, then)
    x, y, z = then[0] - opening * normal[0], then[1] - opening * normal[1], then[2] - opening * normal[2]
    across, along = (_dot(axis, (x, y, z)) - _dot(axis, now) for axis in (frame[3:6], frame[6:]))
    return (opening - _dot(frame[:3], now)) / step, across / step, along / step
