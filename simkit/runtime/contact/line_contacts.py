"""Exact contacts of lines and of corners on height fields, in place of the engine's contacts of these pairs.

`simkit.runtime.contact.line_geometry` computes the contacts, and `height_field_corners` those of corners on a height
field. They are a function of the poses alone. This module writes them over the engine's contacts of a pair, appends
missing ones, excludes surplus ones, and lets the engine build the constraints again.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.runtime.contact.height_field_corners import HeightFieldCorners
from simkit.runtime.contact.line_geometry import (
    PARALLEL,
    LineContact,
    Rod,
    Vector,
    is_near_edge,
    longest_coordinate,
    oblique_edge_contact,
    parallel_edge_contacts,
    rod_contacts,
)

_CYLINDER: Final = int(mujoco.mjtGeom.mjGEOM_CYLINDER)
_CAPSULE: Final = int(mujoco.mjtGeom.mjGEOM_CAPSULE)
_BOX: Final = int(mujoco.mjtGeom.mjGEOM_BOX)
_KINDS: Final = (_CYLINDER, _CAPSULE, _BOX)
_NO_ISLANDS: Final = int(mujoco.mjtDisableBit.mjDSBL_ISLAND)
_MOST_LISTS: Final = 64
_SLOW: Final = 1e-3  # [m/s]
_MARGIN: Final = 2.0  # a cylinder may become faster

Matrix = list[float]
Ints = npt.NDArray[np.intp]


class LinePair(NamedTuple):
    """Pair of geoms whose contacts may lie on a line.

    Attributes:
        first, other: places of the two geoms in the list of all such geoms.
        box: geom id of the second geom if it is a box, else -1.
        numbers: numbers of their contacts.
    """

    first: int
    other: int
    box: int
    numbers: list[int]


ExactContacts = tuple[list[int], list[LineContact]]
"""Numbers of the engine's contacts of a pair of geoms, and the exact contacts of this pair."""


class LineContacts:
    """Cylinders, capsules and boxes of one compiled model, on different kinematic trees.

    Args:
        model: MuJoCo's model.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._has_islands = not model.opt.disableflags & _NO_ISLANDS
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        self._kind: list[int] = [*np.where(collides, model.geom_type, -1).tolist(), -1]
        self._size: list[list[float]] = model.geom_size.tolist()
        self._shapes = [
            (size[0], size[1], kind == _CAPSULE) for size, kind in zip(self._size, self._kind, strict=False)
        ]  # radius, half the length, and whether there are hemispheres
        self._has_margins = bool(model.geom_margin.any() or model.pair_margin.any())
        self._known: dict[bytes, tuple[list[LinePair], Ints]] = {}
        self._tree: list[int] = [*model.body_treeid[model.geom_bodyid].tolist(), -1]
        trees = {kind: {t for t, k in zip(self._tree, self._kind, strict=True) if k == kind} for kind in _KINDS}
        rods = trees[_CYLINDER] | trees[_CAPSULE]
        # only bodies of different trees, because a robot with two wheels would need a search in every step
        self._has_edges = model.nflex == 0 and _differ(trees[_CYLINDER], trees[_BOX])
        self._has_lines = self._has_edges or (model.nflex == 0 and _differ(rods, rods))
        self._corners = HeightFieldCorners(model)
        self._has_corners = model.nflex == 0 and bool(self._corners)
        self._can_meet = self._has_lines or self._has_corners

    def __bool__(self) -> bool:
        return self._can_meet

    def may_touch(self, data: mujoco.MjData) -> bool:
        """Check whether a pair in contact may touch along a line or stand on corners, or be near an edge."""
        return self._has_corners or bool(self._pairs(data)[0])

    def correct(self, data: mujoco.MjData) -> bool:
        """Replace the engine's contacts of pairs that touch along a line or stand on corners.

        Args:
            data: MuJoCo's data with contacts, constraints and velocities.

        Returns:
            True if some contacts were replaced, now or in an earlier call for this state.
        """
        if not self._can_meet:
            return False
        exact: list[ExactContacts] = []
        if self._has_lines:
            pairs, ids = self._pairs(data)
            exact = self._exact_contacts(data, pairs, ids) if pairs else []
        if self._has_corners:
            exact += self._corners.exact_contacts(data)
        if not exact:
            return False
        if _replace(self._model, data, exact):
            mujoco.mj_makeConstraint(self._model, data)
            if self._has_islands:
                mujoco.mj_island(self._model, data)
            mujoco.mj_projectConstraint(self._model, data)
            mujoco.mj_referenceConstraint(self._model, data)
        return True

    def reaches_edge(self, data: mujoco.MjData, seconds: float) -> bool:
        """Check whether a cylinder on a box may reach an edge of it.

        Args:
            data: MuJoCo's data with contacts and velocities.
            seconds: time in which the cylinder may reach the edge.
        """
        if not self._has_edges:
            return False
        pairs, ids = self._pairs(data)
        for first, _, box, _ in pairs:
            if box >= 0:
                cylinder = int(ids[first])
                speed = self._speed(data, cylinder) + self._speed(data, box)
                if speed > _SLOW:
                    turn: Matrix = data.geom_xmat[cylinder].tolist()
                    rod = Rod(data.geom_xpos[cylinder].tolist(), (turn[2], turn[5], turn[8]), *self._shapes[cylinder])
                    rod = _in_frame(rod, data.geom_xpos[box].tolist(), data.geom_xmat[box].tolist())
                    if is_near_edge(rod, self._size[box], _MARGIN * speed * seconds):
                        return True
        return False

    def _speed(self, data: mujoco.MjData, geom: int) -> float:
        """Return the speed of the centre of a geom [m/s]."""
        model = self._model
        body = int(model.geom_bodyid[geom])
        x, y, z = (data.geom_xpos[geom] - data.subtree_com[model.body_rootid[body]]).tolist()
        a, b, c, u, v, w = data.cvel[body].tolist()
        u, v, w = u + b * z - c * y, v + c * x - a * z, w + a * y - b * x
        return math.sqrt(u * u + v * v + w * w)

    def _pairs(self, data: mujoco.MjData) -> tuple[list[LinePair], Ints]:
        """Return the pairs in contact that may touch along a line, and their geoms."""
        geoms = data.contact.geom
        content = geoms.tobytes()
        known = self._known.get(content)
        if known is None:
            if len(self._known) >= _MOST_LISTS:
                self._known.clear()
            known = self._known[content] = self._find_pairs(geoms.tolist())
        return known

    def _find_pairs(self, geoms: list[list[int]]) -> tuple[list[LinePair], Ints]:
        """Return the pairs of two rods, or of a cylinder and a box, and their geoms.

        Args:
            geoms: both geoms of each contact.
        """
        kind, tree, groups = self._kind, self._tree, dict[tuple[int, int], list[int]]()
        for number, (this, other) in enumerate(geoms):
            first, second = kind[this], kind[other]
            if tree[this] == tree[other]:
                continue
            is_rod = second in (_CYLINDER, _CAPSULE) and first in (_CYLINDER, _CAPSULE)
            if is_rod or (first == _CYLINDER and second == _BOX):
                groups.setdefault((this, other), []).append(number)
        ids = sorted({geom for pair in groups for geom in pair})
        place = {geom: number for number, geom in enumerate(ids)}
        return [
            LinePair(place[this], place[other], other if kind[other] == _BOX else -1, numbers)
            for (this, other), numbers in groups.items()
        ], np.array(ids, np.intp)

    def _exact_contacts(self, data: mujoco.MjData, pairs: list[LinePair], ids: Ints) -> list[ExactContacts]:
        """Return the exact contacts of each pair that touches along a line."""
        turns: list[Matrix] = data.geom_xmat.take(ids, 0).tolist()  # half the time of an index
        if not any(box >= 0 or _are_parallel(turns[first], turns[other]) for first, other, box, _ in pairs):
            return []
        centres: list[Vector] = data.geom_xpos.take(ids, 0).tolist()
        rods = [
            Rod(centre, (turn[2], turn[5], turn[8]), *shape)
            for centre, turn, shape in zip(centres, turns, [self._shapes[geom] for geom in ids.tolist()], strict=True)
        ]
        margins: list[float] = data.contact.includemargin.tolist() if self._has_margins else []
        contacts = []
        for first, other, box, numbers in pairs:
            if box >= 0:
                exact = self._edge(data, rods[first], self._size[box], centres[other], turns[other], numbers)
            elif len(numbers) == 2 and rods[first].has_balls and rods[other].has_balls:
                continue  # the engine reports both ends of capsules that are parallel up to rounding
            else:
                exact = rod_contacts(rods[first], rods[other])
            if exact:
                margin = margins[numbers[0]] if margins else 0.0
                touching = [point for point in exact if point[0] < margin]
                if touching:  # otherwise the engine's contacts stop bodies before they touch
                    contacts.append((numbers, touching))
        return contacts

    def _edge(
        self, data: mujoco.MjData, rod: Rod, sizes: list[float], centre: Vector, turn: Matrix, numbers: list[int]
    ) -> list[LineContact] | None:
        """Return the contacts of a cylinder with an edge of a box; None elsewhere on the box."""
        (p, q, r), local = centre, _in_frame(rod, centre, turn)
        k = longest_coordinate(local.axis)
        if abs(local.axis[k]) >= PARALLEL:
            contacts = parallel_edge_contacts(local, sizes, k)
        else:
            contact = data.contact
            x, y, z = contact.pos[numbers[0]].tolist()
            normals = [_turned_back(turn, (x, y, z)) for x, y, z, *_ in contact.frame[numbers].tolist()]
            crossing = oblique_edge_contact(local, sizes, _turned_back(turn, (x - p, y - q, z - r)), normals)
            k, contacts = (k, None) if crossing is None else (crossing[0], [crossing[1]])
        if contacts is None:
            return None
        a, b, c = turn[k], turn[3 + k], turn[6 + k]  # along the edge
        result: list[LineContact] = []
        for distance, place, normal in contacts:
            u, v, w = _turned(turn, place)
            x, y, z = _turned(turn, normal)
            tilt = x * a + y * b + z * c
            d, e, f = a - tilt * x, b - tilt * y, c - tilt * z
            size = math.sqrt(d * d + e * e + f * f)
            d, e, f = d / size, e / size, f / size
            frame = x, y, z, d, e, f, y * f - z * e, z * d - x * f, x * e - y * d
            result.append((distance, (p + u, q + v, r + w), frame))
        return result


def _are_parallel(first: Matrix, other: Matrix) -> bool:
    """Check whether the axes of two rods are nearly parallel."""
    return not -PARALLEL < first[2] * other[2] + first[5] * other[5] + first[8] * other[8] < PARALLEL


def _differ(some: set[int], others: set[int]) -> bool:
    """Check whether two different trees can be chosen, one from each set."""
    return any(contact != other for contact in some for other in others)


def _in_frame(rod: Rod, centre: Vector, turn: Matrix) -> Rod:
    """Return a rod in the frame of a box."""
    (x, y, z), axis, radius, half, has_balls = rod
    p, q, r = centre
    return Rod(_turned_back(turn, (x - p, y - q, z - r)), _turned_back(turn, axis), radius, half, has_balls)


def _turned(turn: Matrix, vector: Vector) -> Vector:
    a, b, c, d, e, f, g, h, i = turn
    x, y, z = vector
    return a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z


def _turned_back(turn: Matrix, vector: Vector) -> Vector:
    a, b, c, d, e, f, g, h, i = turn
    x, y, z = vector
    return a * x + d * y + g * z, b * x + e * y + h * z, c * x + f * y + i * z


def _replace(model: mujoco.MjModel, data: mujoco.MjData, exact_contacts: list[ExactContacts]) -> bool:
    """Write exact contacts over the engine's contacts; return False if they were already there."""
    contact: Any = data.contact
    distances: list[float] = contact.dist.tolist()
    excluded: list[int] = contact.exclude.tolist()
    places: list[int] = []
    values: list[LineContact] = []
    surplus: list[int] = []
    is_new = False
    for numbers, exact in exact_contacts:
        for number, geometry in zip(numbers, exact, strict=False):
            places.append(number)
            values.append(geometry)
            is_new = is_new or distances[number] != geometry[0]
        for geometry in exact[len(numbers) :]:
            is_new = True  # the call deletes the constraints, also if the engine's memory is full
            if not mujoco.mj_addContact(model, data, contact[numbers[0]]):
                places.append(len(distances))
                values.append(geometry)
                distances.append(geometry[0])
        for number in numbers[len(exact) :]:
            surplus.append(number)
            is_new = is_new or not excluded[number]
    if not is_new:
        return False
    contact = data.contact
    if surplus:
        contact.exclude[surplus], contact.efc_address[surplus] = 1, -1
    contact.dist[places] = [geometry[0] for geometry in values]
    contact.pos[places] = [geometry[1] for geometry in values]
    contact.frame[places] = [geometry[2] for geometry in values]
    if any(excluded):
        contact.exclude[places] = 0
    return True
