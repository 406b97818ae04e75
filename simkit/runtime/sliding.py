"""Forces of contacts that slide, without the lift that the engine's friction gives them.

Its friction cone is convex: what slides at speed v is pushed apart at about mu·v, and a crate that is put on a belt of
2 m/s hops by 1 to 5 cm. The lift grows with the deceleration that is asked of friction, v over two steps or so, which
is a hundred times what friction can make. So the forces are solved a first time with friction that only holds, which
gives the true normal forces; these say how much friction can make of it at all, and twice that is then asked. Where the
surfaces do not slide after all (what rolls or rocks gives way more easily than what slips) more is asked.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np

from simkit.runtime.sliding_many import BEYOND, CALM, MORE, SLIDES, TIMES, Ints, solve_many

Pair = tuple[float, float]

MANY = 64
"""For more contacts than this arrays are quicker than plain numbers; the bits are the same."""

_AFTER_VELOCITIES = int(mujoco.mjtStage.mjSTAGE_VEL)


def solve_sliding(model: Any, data: Any, numbers: Sequence[int] | Ints) -> bool:
    """Solves for the forces, from velocities that are known; leaves the references of constraints as it found them.

    Args:
        model, data: of the engine.
        numbers: of the contacts that may slide, which have tangents.

    Returns:
        Whether it was done: where none of them slides, the engine does as well by itself.
    """
    if len(numbers) > MANY:
        return solve_many(model, data, np.asarray(numbers))
    x, y, z = model.opt.gravity.tolist()
    calm = math.sqrt(x * x + y * y + z * z)
    rows = _Rows(model, data, list(map(int, numbers)))
    wanted = rows.tangents()
    size = [math.sqrt(a * a + b * b) for a, b in wanted]
    if not any(one > CALM * most * calm for one, most in zip(size, rows.most, strict=True)):
        return False
    rows.solve([(0.0, 0.0)] * len(size))
    rows.look_at_bodies()
    limit = rows.limits()
    way = [(a / most, b / most) for (a, b), one in zip(wanted, size, strict=True) if (most := max(one, 1e-300))]
    for _ in range(TIMES):
        asked = [min(one, most) for one, most in zip(size, limit, strict=True)]
        rows.solve([(a * one, b * one) for (a, b), one in zip(way, asked, strict=True)])
        given, could = rows.given(way)
        gives_way = [one > most and a < SLIDES * b for one, most, a, b in zip(size, limit, given, could, strict=True)]
        if not any(gives_way):
            break
        limit = [MORE * most if gives else most for most, gives in zip(limit, gives_way, strict=True)]
    rows.restore()
    return True


class _Rows:
    """The rows of the tangents of some contacts, of either cone; plain numbers, as most often there are few.

    Attributes:
        most, least: the larger and the smaller coefficient of friction of each contact.
    """

    def __init__(self, model: Any, data: Any, numbers: Sequence[int]) -> None:
        self._model, self._data, self._numbers = model, data, numbers
        contact = data.contact
        first, friction, aref = contact.efc_address.tolist(), contact.friction.tolist(), data.efc_aref.tolist()
        self._is_pyramid = model.opt.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL
        self._first: list[int] = [first[number] for number in numbers]
        self._friction: list[Pair] = [(friction[number][0], friction[number][1]) for number in numbers]
        self.most, self.least = [max(pair) for pair in self._friction], [min(pair) for pair in self._friction]
        before, count = (0, 4) if self._is_pyramid else (1, 3)
        self._before: list[list[float]] = [aref[row + before : row + count] for row in self._first]

    def tangents(self) -> list[Pair]:
        """References along the two tangents, as found."""
        if not self._is_pyramid:
            return [(a, b) for a, b in self._before]
        return [
            ((a - b) / 2 / one, (c - d) / 2 / other)
            for (a, b, c, d), (one, other) in zip(self._before, self._friction, strict=True)
        ]

    def solve(self, tangents: Sequence[Pair]) -> None:
        """Solves with these references along the tangents."""
        aref = self._data.efc_aref
        if self._is_pyramid:
            each = zip(self._first, self._before, self._friction, tangents, strict=True)
            for row, (a, b, _, _), (mu, mu2), (one, other) in each:
                middle, one, other = (a + b) / 2, mu * one, mu2 * other
                aref[row : row + 4] = (middle + one, middle - one, middle + other, middle - other)
        else:
            for row, (one, other) in zip(self._first, tangents, strict=True):
                aref[row + 1], aref[row + 2] = one, other
        mujoco.mj_forwardSkip(self._model, self._data, _AFTER_VELOCITIES, 1)
        self._forces: list[float] = self._data.efc_force.tolist()

    def restore(self) -> None:
        """Puts the references back."""
        aref, at = self._data.efc_aref, 0 if self._is_pyramid else 1
        for row, before in zip(self._first, self._before, strict=True):
            aref[row + at : row + at + len(before)] = before

    def look_at_bodies(self) -> None:
        """Notes which bodies and kinematic trees meet at each contact; -1 is the tree of what does not move."""
        body_of, tree_of = self._model.geom_bodyid, self._model.body_treeid
        geoms = self._data.contact.geom.tolist()
        pairs = [geoms[number] for number in self._numbers]
        body = {geom: int(body_of[geom]) if geom >= 0 else 0 for pair in pairs for geom in pair}
        tree = {one: int(tree_of[one]) for one in body.values()}
        self._bodies = [(body[one], body[other]) for one, other in pairs]
        self._trees = [(tree[one], tree[other]) for one, other in self._bodies]

    def _normal(self) -> list[float]:
        """Normal forces [N]."""
        forces = self._forces
        if self._is_pyramid:
            return [forces[row] + forces[row + 1] + forces[row + 2] + forces[row + 3] for row in self._first]
        return [forces[row] for row in self._first]

    def limits(self) -> list[float]:
        """Twice what friction can make of the normal forces at most, as references [m/s²].

        Its deceleration of the two bodies, under all their normal forces together, and what its own softness takes.
        """
        normal, weights = self._normal(), self._model.body_invweight0
        total: dict[tuple[int, int], float] = {}
        for side in (0, 1):
            for force, trees in zip(normal, self._trees, strict=True):
                total[side, trees[side]] = total.get((side, trees[side]), 0.0) + force
        found = []
        softness = self._data.efc_R.tolist() if not self._is_pyramid else []
        yields = {body: float(weights[body, 0]) for pair in self._bodies for body in pair}
        for most, force, row, bodies, trees in zip(
            self.most, normal, self._first, self._bodies, self._trees, strict=True
        ):
            parts = 0.0
            for side in (0, 1):
                if trees[side] >= 0:
                    parts += yields[bodies[side]] * total[side, trees[side]]
            taken = 0.0 if self._is_pyramid else most * force * max(softness[row + 1], softness[row + 2])
            found.append(BEYOND * (most * parts + taken))
        return found

    def given(self, way: Sequence[Pair]) -> tuple[list[float], list[float]]:
        """Friction along some unit vectors, and what there could be of it [N]; of all contacts of a body together.

        One contact alone may be without load.
        """
        forces, keys = self._forces, [max(trees) for trees in self._trees]
        rubs, holds = dict.fromkeys(keys, 0.0), dict.fromkeys(keys, 0.0)
        each = zip(keys, self._first, self._friction, self.least, self._normal(), way, strict=True)
        for key, row, (mu, mu2), least, normal, (x, y) in each:
            if self._is_pyramid:
                one, other = (forces[row] - forces[row + 1]) * mu, (forces[row + 2] - forces[row + 3]) * mu2
            else:
                one, other = forces[row + 1], forces[row + 2]
            rubs[key] += one * x + other * y
            holds[key] += least * normal
        return [rubs[key] for key in keys], [holds[key] for key in keys]
