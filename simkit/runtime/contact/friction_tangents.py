"""Tangents and friction coefficients of contacts, as their collisions specify them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from simkit.float_sum import float_sum
from simkit.runtime.contact.friction_contacts import (
    AnyFrictionContacts,
    Floats,
    FrictionContactArrays,
    FrictionContacts,
    Ints,
)
from simkit.runtime.contact.moving_surface import BeltFlow, rotate_frames, rotate_surface_velocities

Numbers = list[float]
Pair = tuple[float, float]
RowContact = tuple[int, int, int]
RowContacts = list[RowContact] | Ints
"""Contacts that have a friction row: index among the found contacts, number of the row, and the other geom.

An array of shape (k, 3) for `FrictionContactArrays`.
"""

# a direction whose squared fraction along a surface is smaller counts as perpendicular to the surface
_MIN_TANGENT_SHARE = 1e-2


@dataclass(slots=True)
class FrictionRow:
    """Friction of a collision; the first direction is `axis` in the frame of `body`.

    Attributes:
        mu: friction along and across the axis.
        slip: compliances along and across the axis [m/s/N].
        tree: kinematic tree of the collision.
        dof: degree of freedom of the wheel, whose rate multiplies its slips; -1 for none.
    """

    geoms: list[int]
    body: int
    axis: Numbers
    mu: Pair
    slip: Pair
    tree: int
    dof: int = -1


class FrictionTangents:
    """Tangents and coefficients of contacts in one compiled model.

    Args:
        model: MuJoCo's model.
        rows: friction of collisions.
        row_of: row number of each geom, -1 for none; the last item is for index -1, no geom.
        is_belt: True for each row of a surface that can move.
    """

    def __init__(
        self, model: mujoco.MjModel, rows: Sequence[FrictionRow], row_of: Sequence[int], is_belt: Sequence[bool]
    ) -> None:
        self._model, self._rows, self._row_of, self._is_belt = model, rows, row_of, is_belt
        self._rows_of: Ints = np.array(row_of)
        self._belts = np.array(is_belt, dtype=bool)
        self._bodies: Ints = np.array([row.body for row in rows], dtype=int)
        self._axes: Floats = np.array([row.axis for row in rows]).reshape(-1, 3)
        self._mus: Floats = np.array([row.mu for row in rows]).reshape(-1, 2)

    def find(self, contacts: AnyFrictionContacts) -> RowContacts:
        """Return the contacts that have a friction row."""
        if isinstance(contacts, FrictionContacts):
            return self._find(contacts)
        first, second = self._rows_of[contacts.geoms].T
        places = ((first >= 0) | (second >= 0)).nonzero()[0]
        first, second = first[places], second[places]
        other = contacts.geoms[places, np.where(first >= 0, 1, 0)]
        return np.stack((places, np.where(first >= 0, first, second), other), axis=1)

    def _find(self, contacts: FrictionContacts) -> list[RowContact]:
        row_of, places = self._row_of, []
        for place, (first, second) in enumerate(contacts.geoms):
            row = row_of[first]
            if row >= 0:
                places.append((place, row, second))
            elif (row := row_of[second]) >= 0:
                places.append((place, row, first))
        return places

    def turn(
        self, data: mujoco.MjData, contacts: AnyFrictionContacts, places: RowContacts, flow: BeltFlow | None
    ) -> None:
        """Rotate the tangents of contacts and set their coefficients; the frames in `contacts` are rotated as well.

        Args:
            data: MuJoCo's data with positions.
            contacts: contacts.
            places: contacts that have a friction row, from `find`.
            flow: contacts with moving surfaces.
        """
        if isinstance(contacts, FrictionContacts) and isinstance(places, list):
            self._turn(data, contacts, places, flow)
        elif isinstance(contacts, FrictionContactArrays) and not isinstance(places, list):
            self._turn_many(data, contacts, places, flow)

    def _turn(
        self, data: mujoco.MjData, contacts: FrictionContacts, places: list[RowContact], flow: BeltFlow | None
    ) -> None:
        """Rotate the tangents of contacts and set their coefficients; the frames in `contacts` are rotated as well."""
        contact, ground, least = data.contact, self._model.geom_friction, mujoco.mjMINMU
        which: Any = [contacts.numbers[place] for place, _, _ in places]
        if len(which) == data.ncon:
            which = slice(None)  # a view is faster
        flows = contact.surfacevel[which].tolist() if self._model.flg_surfacevel else None
        # a belt's friction is along its motion, not along its <fdir1>; a roller keeps its own direction on a belt
        along = {} if flow is None else dict(zip(flow.places, flow.directions, strict=True))
        turns: dict[int, Numbers] = {}
        frames, frictions = [], []
        for index, (place, row, other) in enumerate(places):
            friction_row, frame = self._rows[row], contacts.frames[place]
            axis: Sequence[float] | None = along.get(place) if self._is_belt[row] else None
            if axis is None:
                turn = turns.get(friction_row.body)
                if turn is None:
                    turn = turns[friction_row.body] = data.xmat[friction_row.body].tolist()
                axis = _rotate_vector(turn, friction_row.axis)
            turned = _rotate_frame(frame, axis)
            # the present friction may be smaller: a model under velocity control slides freely
            most = ground.item(other, 0) if other >= 0 else math.inf
            first, second = friction_row.mu
            if turned is frame:  # the direction is perpendicular to the surface: friction without a direction
                first = second = min(first, second)
            elif flows is not None:
                _rotate_surface_velocity(flows[index], frame, turned)
            contacts.frames[place] = turned
            frames.append(turned)
            frictions.append((first, second, most))
        contact.frame[which] = frames
        present = contact.friction[which].tolist()
        for each, (first, second, most) in zip(present, frictions, strict=True):
            most = min(each[0], each[1], most)
            each[0], each[1] = max(min(first, most), least), max(min(second, most), least)
        contact.friction[which] = present
        if flows is not None:
            contact.surfacevel[which] = flows

    def _turn_many(
        self, data: mujoco.MjData, touching: FrictionContactArrays, contacts: Ints, flow: BeltFlow | None
    ) -> None:
        """Rotate the tangents of many contacts on arrays, with the same bits as `_turn`."""
        contact, least = data.contact, mujoco.mjMINMU
        places, rows, others = contacts.T
        which: slice | Ints = slice(None) if len(places) == data.ncon else touching.numbers[places]
        frames = touching.frames[places]
        axes = _rotate_vectors(data.xmat[self._bodies], self._axes)[rows]
        if flow is not None:
            along: Floats = np.full((len(touching.numbers), 3), math.nan)
            along[flow.places] = flow.directions
            along = along[places]
            runs = self._belts[rows] & ~np.isnan(along[:, 0])
            axes[runs] = along[runs]
        after, lies = rotate_frames(frames, axes, _MIN_TANGENT_SHARE)
        mu = self._mus[rows]
        mu = np.where(lies[:, None], mu, np.minimum(mu[:, :1], mu[:, 1:]))
        if self._model.flg_surfacevel:
            flows = contact.surfacevel[which]
            contact.surfacevel[which] = np.where(lies[:, None], rotate_surface_velocities(flows, frames, after), flows)
        touching.frames[places] = contact.frame[which] = after
        present = contact.friction[which, :2]
        most = np.where(others >= 0, self._model.geom_friction[others, 0], math.inf)
        most = np.minimum(most, np.minimum(present[:, 0], present[:, 1]))
        contact.friction[which, :2] = np.maximum(np.minimum(mu, most[:, None]), least)


def _rotate_frame(frame: Numbers, direction: Sequence[float]) -> Numbers:
    """Return a contact frame (normal and two tangents, (9,)) whose first tangent follows a direction.

    The frame is returned unchanged if the direction is perpendicular to the surface.
    """
    nx, ny, nz = frame[:3]
    x, y, z = direction
    over = x * nx + y * ny + z * nz
    fx, fy, fz = x - over * nx, y - over * ny, z - over * nz
    square = fx * fx + fy * fy + fz * fz
    if square <= _MIN_TANGENT_SHARE * (x * x + y * y + z * z):
        return frame
    length = math.sqrt(square)
    fx, fy, fz = fx / length, fy / length, fz / length
    return [nx, ny, nz, fx, fy, fz, ny * fz - nz * fy, nz * fx - nx * fz, nx * fy - ny * fx]


def _rotate_surface_velocity(flow: Numbers, before: Numbers, after: Numbers) -> None:
    """Convert a surface velocity from the tangents of one frame to those of another, in place."""
    along, across = flow[:2]
    over = [along * a + across * b for a, b in zip(before[3:6], before[6:], strict=True)]
    flow[0] = float_sum(a * b for a, b in zip(over, after[3:6], strict=True))
    flow[1] = float_sum(a * b for a, b in zip(over, after[6:], strict=True))


def _rotate_vector(matrix: Numbers, vector: Numbers) -> Numbers:
    """Multiply a row-major matrix (9,) with a vector (3,)."""
    a, b, c, d, e, f, g, h, i = matrix
    x, y, z = vector
    return [a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z]


def _rotate_vectors(matrices: Floats, vectors: Floats) -> Floats:
    """Multiply row-major matrices (k, 9) with vectors (k, 3)."""
    a, b, c, d, e, f, g, h, i = matrices.T
    x, y, z = vectors.T
    return np.stack((a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z), axis=1)
