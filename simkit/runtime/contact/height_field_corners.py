"""Contacts of boxes with height fields, one for each corner below the ground.

MuJoCo gives each prism of a height field one contact with a geom. A box that is smaller than a cell would stand on one
point, which jumps from corner to corner: it tips over, and falls through the ground beside the border of two cells. The
contacts of this module are a function of the poses alone.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.runtime.contact.height_field_contacts import CellGround, HeightFieldContacts
from simkit.runtime.contact.line_geometry import LineContact

_BOX: Final = int(mujoco.mjtGeom.mjGEOM_BOX)

_NEAR: Final = 0.05
"""Share of a box's size within which an engine's contact is that of a corner."""

_MOST_LISTS: Final = 64
_SIGNS: Final = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])

Floats = npt.NDArray[np.float64]
ExactContacts = tuple[list[int], list[LineContact]]


class _Group(NamedTuple):
    """Boxes that touch one height field.

    Attributes:
        field: geom id of the height field.
        boxes: geom ids of the boxes, shape (k,).
        corners: corners in the frames of the boxes [m], shape (k, 8, 3).
        numbers: numbers of the contacts of each box.
    """

    field: int
    boxes: npt.NDArray[np.intp]
    corners: Floats
    numbers: list[list[int]]


class HeightFieldCorners:
    """Boxes of one compiled model that may touch a height field.

    Args:
        model: MuJoCo's model.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model, self._fields = model, HeightFieldContacts(model)
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        self._kind: list[int] = [*np.where(collides, model.geom_type, -1).tolist(), -1]
        self._can_meet = bool(self._fields) and _BOX in self._kind
        self._known: dict[bytes, list[_Group]] = {}

    def __bool__(self) -> bool:
        return self._can_meet

    def exact_contacts(self, data: mujoco.MjData) -> list[ExactContacts]:
        """Return the contacts of each box with corners below the ground: those corners, and what touches elsewhere."""
        geoms = data.contact.geom
        content = geoms.tobytes()
        groups = self._known.get(content)
        if groups is None:
            if len(self._known) >= _MOST_LISTS:
                self._known.clear()
            groups = self._known[content] = self._find_groups(geoms.tolist())
        if not groups:
            return []
        return [pair for group in groups for pair in self._pairs(data, group)]

    def _find_groups(self, geoms: list[list[int]]) -> list[_Group]:
        """Return the boxes in contact with height fields.

        Args:
            geoms: both geoms of each contact; the engine sorts them by type, and a height field has the lowest.
        """
        numbers: dict[int, dict[int, list[int]]] = {}
        for number, (first, second) in enumerate(geoms):
            if first in self._fields and self._kind[second] == _BOX:
                numbers.setdefault(first, {}).setdefault(second, []).append(number)
        groups = []
        for field, of_box in numbers.items():
            ids = np.array(list(of_box), np.intp)
            groups.append(_Group(field, ids, self._model.geom_size[ids][:, None] * _SIGNS, list(of_box.values())))
        return groups

    def _pairs(self, data: mujoco.MjData, group: _Group) -> list[ExactContacts]:
        """Return the contacts of the boxes of a group."""
        turn, at = data.geom_xmat[group.field].reshape(3, 3), data.geom_xpos[group.field]
        turns = data.geom_xmat[group.boxes].reshape(-1, 1, 3, 3)
        places = data.geom_xpos[group.boxes][:, None] + _turned(turns, group.corners)
        depths, normals = self._depths(group.field, _turned(turn.T, places - at))
        normals = _turned(turn, normals)
        below = depths > 0.0
        contact = data.contact
        pairs: list[ExactContacts] = []
        for i in np.flatnonzero(np.logical_or.reduce(below, axis=1)).tolist():
            chosen = np.flatnonzero(below[i])
            depth, normal = depths[i, chosen], normals[i, chosen]
            spots = places[i, chosen] + normal * (0.5 * depth)[:, None]
            exact: list[Any] = [
                (-d, tuple(spot), _frame(*n))
                for d, spot, n in zip(depth.tolist(), spots.tolist(), normal.tolist(), strict=True)
            ]
            near = _NEAR * float(np.abs(group.corners[i]).max())
            for number in group.numbers[i]:
                spot = contact.pos[number]
                if contact.exclude[number] or np.abs(spots - spot).max(axis=1).min() <= near:
                    continue
                if not self._fields.is_inner(data, number, group.field, 1.0):
                    frame = contact.frame[number].tolist()
                    exact.append((float(contact.dist[number]), tuple(spot.tolist()), tuple(frame)))
            pairs.append((group.numbers[i], exact))
        return pairs

    def _depths(self, field: int, points: Floats) -> tuple[Floats, Floats]:
        """Return the depths of points below the ground and the normals there; negative depths elsewhere.

        Args:
            field: geom id of the height field.
            points: positions in the frame of the height field [m], shape (k, n, 3).
        """
        number = int(self._model.geom_dataid[field])
        ground, base = CellGround.at(self._model, number, points), float(self._model.hfield_size[number, 3])
        (first_x, first_y), (other_x, other_y) = ground.slopes
        slope_x, slope_y = np.where(ground.is_first, first_x, other_x), np.where(ground.is_first, first_y, other_y)
        size = np.sqrt(slope_x * slope_x + slope_y * slope_y + 1.0)
        normals = np.stack((-slope_x / size, -slope_y / size, 1.0 / size), axis=-1)
        is_inside = ground.is_inside & (points[..., 2] > -base)
        return np.where(is_inside, (ground.level - points[..., 2]) / size, -1.0), normals


def _turned(turn: Floats, vectors: Floats) -> Floats:
    """Return rotated vectors; sums in a fixed order, so that every processor computes the same bits."""
    x, y, z = vectors[..., 0, None], vectors[..., 1, None], vectors[..., 2, None]
    return np.asarray(turn[..., 0] * x + turn[..., 1] * y + turn[..., 2] * z)


def _frame(x: float, y: float, z: float) -> tuple[float, ...]:
    """Return the axes of a contact with this normal, as rows."""
    size = float(np.sqrt(y * y + z * z))
    if size < 1e-6:
        return x, y, z, 0.0, 1.0, 0.0, -z, 0.0, x
    d, e, f = size, -x * y / size, -x * z / size
    return x, y, z, d, e, f, y * f - z * e, z * d - x * f, x * e - y * d
