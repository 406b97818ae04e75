"""Exact contacts of cylinders and capsules along lines, in place of the engine's contacts of these pairs.

`simkit.runtime.contact.line_geometry` computes the contacts. They are a function of the poses alone. This module writes
them over the engine's contacts of a pair, appends missing ones, excludes surplus ones, and lets the engine build the
constraints again.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import mujoco
import numpy as np

from simkit.runtime.contact.line_geometry import LineContact, Rod, Vector, edge_contacts, rod_contacts

_CYLINDER: Final = int(mujoco.mjtGeom.mjGEOM_CYLINDER)
_CAPSULE: Final = int(mujoco.mjtGeom.mjGEOM_CAPSULE)
_BOX: Final = int(mujoco.mjtGeom.mjGEOM_BOX)
_NO_ISLANDS: Final = int(mujoco.mjtDisableBit.mjDSBL_ISLAND)
_MOST_LISTS: Final = 64

Matrix = list[float]


class LinePair(NamedTuple):
    """Pair of geoms whose contacts may lie on a line.

    Attributes:
        one, other: places of the two geoms in the list of all such geoms.
        is_box: True if the second geom is a box.
        numbers: numbers of their contacts.
    """

    one: int
    other: int
    is_box: bool
    numbers: list[int]


class LineContacts:
    """Cylinders, capsules and boxes of one compiled model.

    Args:
        model: MuJoCo's model.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._has_islands = not model.opt.disableflags & _NO_ISLANDS
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        self._kind: list[int] = [*np.where(collides, model.geom_type, -1).tolist(), -1]
        self._size: list[list[float]] = model.geom_size.tolist()
        self._known: dict[bytes, tuple[list[LinePair], list[int]]] = {}
        rods = self._kind.count(_CYLINDER) + self._kind.count(_CAPSULE)
        has_edges = _CYLINDER in self._kind and _BOX in self._kind
        self._can_meet = model.nflex == 0 and (rods > 1 or has_edges)

    def __bool__(self) -> bool:
        return self._can_meet

    def correct(self, data: mujoco.MjData) -> bool:
        """Replace the engine's contacts of pairs that touch along a line.

        Args:
            data: MuJoCo's data with contacts, constraints and velocities.

        Returns:
            True if some contacts were replaced, now or in an earlier call for this state.
        """
        if not self._can_meet:
            return False
        geoms = data.contact.geom
        content = geoms.tobytes()
        known = self._known.get(content)
        if known is None:
            if len(self._known) >= _MOST_LISTS:
                self._known.clear()
            known = self._known[content] = self._find_pairs(geoms.tolist())
        pairs, ids = known
        if not pairs:
            return False
        found = self._exact_contacts(data, pairs, ids)
        if not found:
            return False
        if _replace(self._model, data, found):
            mujoco.mj_makeConstraint(self._model, data)
            if self._has_islands:
                mujoco.mj_island(self._model, data)
            mujoco.mj_projectConstraint(self._model, data)
            mujoco.mj_referenceConstraint(self._model, data)
        return True

    def _find_pairs(self, geoms: list[list[int]]) -> tuple[list[LinePair], list[int]]:
        """Return the pairs of two rods, or of a cylinder and a box, and their geoms.

        Args:
            geoms: both geoms of each contact.
        """
        kind, groups = self._kind, dict[tuple[int, int], list[int]]()
        for number, (one, other) in enumerate(geoms):
            first, second = kind[one], kind[other]
            is_rod = second in (_CYLINDER, _CAPSULE) and first in (_CYLINDER, _CAPSULE)
            if is_rod or (first == _CYLINDER and second == _BOX):
                groups.setdefault((one, other), []).append(number)
        ids = sorted({geom for pair in groups for geom in pair})
        place = {geom: number for number, geom in enumerate(ids)}
        return [
            LinePair(place[one], place[other], kind[other] == _BOX, numbers) for (one, other), numbers in groups.items()
        ], ids

    def _exact_contacts(
        self, data: mujoco.MjData, pairs: list[LinePair], ids: list[int]
    ) -> list[tuple[list[int], list[LineContact]]]:
        """Return the numbers of the engine's contacts and the exact contacts of each pair that touches along a line."""
        centres: list[Vector] = data.geom_xpos[ids].tolist()
        turns: list[Matrix] = data.geom_xmat[ids].tolist()
        rods = [self._rod(geom, centre, turn) for geom, centre, turn in zip(ids, centres, turns, strict=True)]
        found = []
        for one, other, is_box, numbers in pairs:
            if is_box:
                exact = self._edge(data, rods[one], ids[other], centres[other], turns[other], numbers)
            else:
                exact = rod_contacts(rods[one], rods[other])
            if exact is not None:
                found.append((numbers, exact))
        return found

    def _rod(self, geom: int, centre: Vector, turn: Matrix) -> Rod:
        radius, half, _ = self._size[geom]
        return Rod(centre, (turn[2], turn[5], turn[8]), radius, half, self._kind[geom] == _CAPSULE)

    def _edge(
        self, data: mujoco.MjData, rod: Rod, box: int, centre: Vector, turn: Matrix, numbers: list[int]
    ) -> list[LineContact] | None:
        """Return the contacts of a cylinder with an edge of a box; None elsewhere on the box."""
        p, q, r = centre
        (x, y, z), axis, radius, half, _ = rod
        a, b, c = self._size[box]
        local = _turned_back(turn, (x - p, y - q, z - r))
        contact = data.contact
        present = [
            LineContact(0.0, _turned_back(turn, (u - p, v - q, w - r)), _turned_back(turn, (d, e, f)))
            for (u, v, w), (d, e, f) in zip(
                contact.pos[numbers].tolist(), contact.frame[numbers, :3].tolist(), strict=True
            )
        ]
        exact = edge_contacts(Rod(local, _turned_back(turn, axis), radius, half, False), (a, b, c), present)
        if exact is None:
            return None
        result = []
        for distance, position, normal in exact:
            u, v, w = _turned(turn, position)
            result.append(LineContact(distance, (p + u, q + v, r + w), _turned(turn, normal)))
        return result


def _turned(turn: Matrix, vector: Vector) -> Vector:
    a, b, c, d, e, f, g, h, i = turn
    x, y, z = vector
    return a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z


def _turned_back(turn: Matrix, vector: Vector) -> Vector:
    a, b, c, d, e, f, g, h, i = turn
    x, y, z = vector
    return a * x + d * y + g * z, b * x + e * y + h * z, c * x + f * y + i * z


def _replace(model: mujoco.MjModel, data: mujoco.MjData, found: list[tuple[list[int], list[LineContact]]]) -> bool:
    """Write exact contacts over the engine's contacts; return False if they were already there."""
    contact: Any = data.contact
    distances, margins = contact.dist.tolist(), contact.includemargin.tolist()
    excluded, positions = contact.exclude.tolist(), contact.pos.tolist()
    places: list[int] = []
    values: list[LineContact] = []
    surplus: list[int] = []
    is_changed, total = False, data.ncon
    for numbers, exact in found:
        margin = margins[numbers[0]]
        exact = [one for one in exact if one.distance < margin]
        for number, one in zip(numbers, exact, strict=False):
            places.append(number)
            values.append(one)
            if distances[number] != one.distance or tuple(positions[number]) != one.position or excluded[number]:
                is_changed = True
        for one in exact[len(numbers) :]:
            if mujoco.mj_addContact(model, data, data.contact[numbers[0]]):
                break  # the engine's memory is full
            places.append(total)
            values.append(one)
            total += 1
            is_changed = True
        for number in numbers[len(exact) :]:
            surplus.append(number)
            is_changed = is_changed or not excluded[number]
    if not is_changed:
        return False
    contact = data.contact
    contact.exclude[surplus], contact.efc_address[surplus] = 1, -1
    if not places:
        return True
    contact.dist[places] = [one.distance for one in values]
    contact.pos[places] = [one.position for one in values]
    contact.frame[places] = [_frame(one.normal) for one in values]
    contact.exclude[places] = 0
    return True


def _frame(normal: Vector) -> list[float]:
    """Return a normal and two tangents of a contact."""
    x, y, z = normal
    if -0.5 < y < 0.5:  # as the engine does
        size = (1.0 - y * y) ** 0.5
        a, b, c = -x * y / size, size, -z * y / size
    else:
        size = (1.0 - z * z) ** 0.5
        a, b, c = -x * z / size, -y * z / size, size
    return [x, y, z, a, b, c, y * c - z * b, z * a - x * c, x * b - y * a]
