"""Triangles of one material."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Colour = tuple[float, float, float, float]


_alone: WeakKeyDictionary[MeshPart, tuple[Floats, Ints]] = WeakKeyDictionary()
_areas: WeakKeyDictionary[MeshPart, dict[float, bool]] = WeakKeyDictionary()


class MeshFileError(Exception):
    """A mesh file that cannot be used; the text says why."""


@dataclass(frozen=True, eq=False)
class MeshPart:
    """Triangles of one material.

    Attributes:
        name: of the sub-mesh in the file.
        vertices: shape (n, 3) [m].
        faces: shape (m, 3), counter-clockwise seen from outside.
        uv: shape (n, 2), v upwards, or None.
        colour: RGBA from 0 to 1, or None where the file gives none.
        texture: image rows from the top, shape (h, w, 3), uint8, or None.
        specular, emission: how strongly it mirrors and glows, from 0 to 1.
        aliases: further names that the sub-mesh goes by in its file.
    """

    name: str
    vertices: Floats
    faces: Ints
    uv: Floats | None = None
    colour: Colour | None = None
    texture: npt.NDArray[np.uint8] | None = None
    specular: float = 0.0
    emission: float = 0.0
    aliases: tuple[str, ...] = ()

    def scaled(self, scale: tuple[float, float, float]) -> MeshPart:
        """Stretched along the axes; a mirroring scale turns the faces over again."""
        mirrored = scale[0] * scale[1] * scale[2] < 0.0
        faces = np.ascontiguousarray(self.faces[:, ::-1]) if mirrored else self.faces
        return replace(self, vertices=self.vertices * np.asarray(scale, float), faces=faces)

    def moved(self, offset: Floats) -> MeshPart:
        return replace(self, vertices=self.vertices + offset)


def joined(parts: list[MeshPart]) -> tuple[Floats, Ints]:
    """Vertices and faces of all parts as one mesh; equal vertices are one, faces without area are left out."""
    if len(parts) != 1:
        return _joined(parts)
    if parts[0] not in _alone:  # a part of the cache comes again with every load
        _alone[parts[0]] = _joined(parts)
        for values in _alone[parts[0]]:
            values.flags.writeable = False
    return _alone[parts[0]]


def _joined(parts: list[MeshPart]) -> tuple[Floats, Ints]:
    if not parts:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int32)
    offsets = np.cumsum([0, *(len(p.vertices) for p in parts[:-1])])
    vertices = np.concatenate([p.vertices for p in parts])
    faces = np.concatenate([p.faces + o for p, o in zip(parts, offsets, strict=True)])
    size = float(np.ptp(vertices, axis=0).max()) if len(vertices) else 0.0
    grid: Any = np.round(vertices / max(size * 1e-7, 1e-300)).astype(np.int64)
    first, inverse = _unique_rows(grid)
    vertices, faces = vertices[first], inverse[faces]
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return vertices, faces[area > (size * 1e-7) ** 2].astype(np.int32)


def _unique_rows(rows: Any) -> tuple[Any, Any]:
    """Where each different row stands first, in the order of the rows, and for every row which one it is.

    What `np.unique(axis=0)` gives, in a third of its time.
    """
    order = np.lexsort(rows.T[::-1])
    in_order = rows[order]
    is_new = np.ones(len(rows), bool)
    is_new[1:] = (in_order[1:] != in_order[:-1]).any(axis=1)
    inverse = np.empty(len(rows), np.intp)
    inverse[order] = np.cumsum(is_new) - 1
    return order[is_new], inverse


_SOME = 64


def has_area(part: MeshPart, least: float) -> bool:
    """Whether the triangles have more than `least` [m²] in all; the first few nearly always do."""
    known = _areas.setdefault(part, {})
    if least not in known:
        known[least] = _has_area(part, least)
    return known[least]


def _has_area(part: MeshPart, least: float) -> bool:
    for faces in (part.faces[:_SOME], part.faces):
        corners = part.vertices[faces]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        if float(area.sum()) > least:
            return True
    return False
