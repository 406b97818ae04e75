"""`simkit.runtime.sliding` for many contacts: the same on arrays, with the same bits."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.integer[Any]]

BEYOND = 2.0
"""Times the deceleration that friction can make at most: so much is asked for."""

CALM = 0.5
"""Times mu·g: decelerations below it push nothing apart."""

SLIDES = 0.95
"""What slides, of the friction that there could be."""

MORE, TIMES = 4.0, 4
"""How much more is asked where it is not given, and how often."""

_AFTER_VELOCITIES = int(mujoco.mjtStage.mjSTAGE_VEL)


def solve_many(model: Any, data: Any, numbers: Ints) -> bool:
    """As `solve_sliding`, by its numbers."""
    rows = _Rows(model, data, numbers)
    wanted = rows.tangents(rows.before)
    size = _length(wanted)
    if not (size > CALM * rows.most * np.linalg.norm(model.opt.gravity)).any():
        return False
    rows.solve(0.0 * wanted)
    normal = rows.normal()
    limit = BEYOND * (rows.most * _yielding(model, data, numbers, normal) + rows.resistance(normal))
    trees = _trees(model, data, numbers).max(axis=1) + 1
    way = wanted / np.maximum(size, 1e-300)[:, None]
    for _ in range(TIMES):
        is_less = size > limit
        rows.solve(way * np.minimum(size, limit)[:, None])
        # what a body's contacts give together: one alone may be without load
        given = np.bincount(trees, weights=rows.rubbing(way), minlength=model.ntree + 1)[trees]
        could = np.bincount(trees, weights=rows.least * rows.normal(), minlength=model.ntree + 1)[trees]
        gives_way = is_less & (given < SLIDES * could)
        if not gives_way.any():
            break
        limit = np.where(gives_way, MORE * limit, limit)
    rows.restore()
    return True


class _Rows:
    """The rows of the tangents of some contacts, of either cone.

    Attributes:
        before: references as found, shape (k, 2), of a pyramid (k, 4).
        most, least: the larger and the smaller coefficient of friction of each contact, shape (k,).
    """

    def __init__(self, model: Any, data: Any, numbers: Ints) -> None:
        self._model, self._data = model, data
        self._is_pyramid = model.opt.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL
        self._first = data.contact.efc_address[numbers]
        self._rows = self._first[:, None] + (np.arange(4) if self._is_pyramid else np.arange(1, 3))
        self._friction = data.contact.friction[numbers, :2]
        one, other = self._friction.T
        self.most, self.least = np.maximum(one, other), np.minimum(one, other)
        self.before: Floats = data.efc_aref[self._rows]

    def tangents(self, values: Floats) -> Floats:
        """References along the two tangents (k, 2)."""
        return (values[:, ::2] - values[:, 1::2]) / 2 / self._friction if self._is_pyramid else values

    def solve(self, tangents: Floats) -> None:
        """Solves with these references along the tangents."""
        if self._is_pyramid:
            middle, swing = (self.before[:, :1] + self.before[:, 1:2]) / 2, self._friction * tangents
            tangents = np.stack((middle + swing, middle - swing), axis=2).reshape(-1, 4)
        self._data.efc_aref[self._rows] = tangents
        mujoco.mj_forwardSkip(self._model, self._data, _AFTER_VELOCITIES, 1)

    def restore(self) -> None:
        """Puts the references back."""
        self._data.efc_aref[self._rows] = self.before

    def normal(self) -> Floats:
        """Normal forces (k,) [N]."""
        forces: Floats = self._data.efc_force
        found: Floats = forces[self._rows].sum(axis=1) if self._is_pyramid else forces[self._first]
        return found

    def rubbing(self, way: Floats) -> Floats:
        """Forces of friction (k,) along some unit vectors (k, 2) [N]."""
        forces = self._data.efc_force[self._rows]
        if self._is_pyramid:
            forces = (forces[:, ::2] - forces[:, 1::2]) * self._friction
        found: Floats = (forces * way).sum(axis=1)
        return found

    def resistance(self, normal: Floats) -> Floats:
        """What the softness of friction takes of a reference at its largest force (k,) [m/s²]."""
        if self._is_pyramid:
            return np.zeros(len(normal))
        found: Floats = self.most * normal * self._data.efc_R[self._rows].max(axis=1)
        return found


def _length(vectors: Floats) -> Floats:
    x, y = vectors.T
    found: Floats = np.sqrt(x * x + y * y)
    return found


def _bodies(model: Any, data: Any, numbers: Ints) -> Ints:
    geoms = data.contact.geom[numbers]
    found: Ints = np.where(geoms >= 0, model.geom_bodyid[geoms], 0)
    return found


def _trees(model: Any, data: Any, numbers: Ints) -> Ints:
    """The trees of both bodies of each contact (k, 2); -1 for what does not move."""
    found: Ints = model.body_treeid[_bodies(model, data, numbers)]
    return found


def _yielding(model: Any, data: Any, numbers: Ints, normal: Floats) -> Floats:
    """How fast the two bodies of each contact would part under all their normal forces together (k,) [m/s²]."""
    bodies, trees = _bodies(model, data, numbers), _trees(model, data, numbers)
    pushed = np.zeros(numbers.size)
    for side in (0, 1):
        rows = (trees[:, side] >= 0).nonzero()[0]
        if rows.size:
            tree, body = trees[rows, side], bodies[rows, side]
            total = np.bincount(tree, weights=normal[rows], minlength=model.ntree)[tree]
            pushed[rows] += model.body_invweight0[body, 0] * total
    return pushed
