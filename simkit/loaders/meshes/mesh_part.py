"""Triangles of one material, limits of mesh files, parsing of numbers, and findings about files."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Any, Final
from weakref import WeakKeyDictionary

import numpy as np
import numpy.typing as npt

from simkit.diagnostics import Diagnostics, Severity, Where
from simkit.input_file import GIT_LFS_POINTER, GIT_LFS_TEXT

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Indices = npt.NDArray[np.int64]
Colour = tuple[float, float, float, float]


_joined_parts: WeakKeyDictionary[MeshPart, tuple[Floats, Ints]] = WeakKeyDictionary()
_areas: WeakKeyDictionary[MeshPart, dict[float, bool]] = WeakKeyDictionary()


class MeshFileError(Exception):
    """Error for a mesh file that cannot be used; the text is the reason."""


@dataclass(frozen=True, eq=False)
class MeshPart:
    """Triangles of one material.

    Attributes:
        name: name of the sub-mesh in the file.
        vertices: vertices [m], shape (n, 3).
        faces: vertex indices, shape (m, 3), counter-clockwise seen from outside.
        uv: texture coordinates, shape (n, 2), v upwards, or None.
        colour: RGBA from 0 to 1, or None if the file has none.
        texture: image rows from the top, shape (h, w, 3), uint8, or None.
        texture_digest: hash of the texture; empty if it is not known.
        specular: strength of reflection, from 0 to 1.
        emission: strength of emission, from 0 to 1.
        aliases: further names of the sub-mesh in its file.
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
    texture_digest: str = ""

    def scaled(self, scale: tuple[float, float, float]) -> MeshPart:
        """Return the part scaled along the axes; a mirroring scale reverses the faces."""
        mirrored = scale[0] * scale[1] * scale[2] < 0.0
        faces = np.ascontiguousarray(self.faces[:, ::-1]) if mirrored else self.faces
        return replace(self, vertices=self.vertices * np.asarray(scale, float), faces=faces)

    def moved(self, offset: Floats) -> MeshPart:
        """Return the part moved by an offset [m]."""
        return replace(self, vertices=self.vertices + offset)


def join_parts(parts: list[MeshPart]) -> tuple[Floats, Ints]:
    """Return vertices and faces of all parts as one mesh; equal vertices are merged, faces without area are dropped."""
    if len(parts) != 1:
        return _compute_joined(parts)
    if parts[0] not in _joined_parts:  # every load of a file returns the same part objects
        _joined_parts[parts[0]] = _compute_joined(parts)
        for values in _joined_parts[parts[0]]:
            values.flags.writeable = False
    return _joined_parts[parts[0]]


def _compute_joined(parts: list[MeshPart]) -> tuple[Floats, Ints]:
    if not parts:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int32)
    offsets = np.cumsum([0, *(len(p.vertices) for p in parts[:-1])])
    vertices = np.concatenate([p.vertices for p in parts])
    faces = np.concatenate([p.faces + o for p, o in zip(parts, offsets, strict=True)])
    size = float(np.ptp(vertices, axis=0).max()) if len(vertices) else 0.0
    grid: Indices = np.round(vertices / max(size * 1e-7, 1e-300)).astype(np.int64)
    first, inverse = _unique_rows(grid)
    vertices, faces = vertices[first], inverse[faces]
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return vertices, faces[area > (size * 1e-7) ** 2].astype(np.int32)


def _unique_rows(rows: Indices) -> tuple[Indices, Indices]:
    """Return the index of each distinct row, in sorted order of the rows, and for every row the position in that list.

    The result equals that of `np.unique(axis=0)` and takes a third of the time.
    """
    order = np.lexsort(rows.T[::-1])
    in_order = rows[order]
    is_new = np.ones(len(rows), bool)
    is_new[1:] = (in_order[1:] != in_order[:-1]).any(axis=1)
    inverse = np.empty(len(rows), np.intp)
    inverse[order] = np.cumsum(is_new) - 1
    return order[is_new], inverse


_FIRST_FACES = 64


def has_area(part: MeshPart, least: float) -> bool:
    """Check whether the triangles have more than `least` [m²] in total; usually the first triangles are enough."""
    known = _areas.setdefault(part, {})
    if least not in known:
        known[least] = _has_area(part, least)
    return known[least]


def _has_area(part: MeshPart, least: float) -> bool:
    for faces in (part.faces[:_FIRST_FACES], part.faces):
        corners = part.vertices[faces]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        if float(area.sum()) > least:
            return True
    return False


LARGEST_FILE: Final = 512 << 20
LARGEST_FACES: Final = 4_000_000
FARTHEST_VERTEX: Final = 1e9  # [m]; volumes of larger meshes exceed the engine's single precision
DEEPEST_NODE: Final = 64
MOST_NODES: Final = 20_000


def numbers_of(text: bytes | str, what: str) -> Floats:
    """Return the numbers in a text, separated by white space.

    Raises:
        MeshFileError: the text contains something else.
    """
    return np.asarray(_parse_numbers(text, float, what), float)


def integers_of(text: bytes | str, what: str) -> Indices:
    """Return the whole numbers in a text, separated by white space, int64.

    Raises:
        MeshFileError: the text contains something else.
    """
    numbers: Indices = _parse_numbers(text, np.int64, what)
    return numbers


def _parse_numbers(text: bytes | str, kind: npt.DTypeLike, what: str) -> npt.NDArray[Any]:
    if not text or text.isspace():
        return np.zeros(0, kind)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return np.fromstring(text, kind, sep=" ")
        except (ValueError, DeprecationWarning, OverflowError):
            pass
    try:
        return np.array(text.split(), dtype=kind)
    except (ValueError, OverflowError):
        raise MeshFileError(f"has a text in its {what} that is not a number") from None


def fan_triangles(counts: npt.ArrayLike) -> Indices:
    """Return the triangles of consecutive polygons, polygon by polygon.

    Args:
        counts: number of corners of each polygon, shape (p,).

    Returns:
        Indices in the list of all corners, shape (t, 3); each polygon becomes a fan around its first corner.
    """
    counts = np.asarray(counts, np.int64)
    start = np.concatenate([[0], np.cumsum(counts)[:-1]]) if len(counts) else counts
    triangles = np.maximum(counts - 2, 0)
    of = np.repeat(np.arange(len(counts)), triangles)
    k = np.arange(len(of)) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    return np.column_stack([start[of], start[of] + k + 1, start[of] + k + 2])


def unique_rows(rows: Indices) -> tuple[Indices, Ints]:
    """Return the distinct rows of an integer array in order of appearance, and the index in them for every row."""
    _, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return rows[first[order]], rank[np.asarray(inverse).reshape(-1)].astype(np.int32)


def check_is_fetched(content: bytes) -> None:
    """Raise MeshFileError if a file of a mesh or an image has only the pointer that Git LFS replaces by the content."""
    if content.startswith(GIT_LFS_POINTER):
        raise MeshFileError(f"is {GIT_LFS_TEXT}")


def report_once(
    diagnostics: Diagnostics, severity: Severity, code: str, message: str, where: Where, hint: str = ""
) -> None:
    """Record a finding about a file at its first use; further uses of the file are not reported."""
    if not any(d.code == code and d.message == message for d in diagnostics):
        diagnostics.add(severity, code, message, where, hint)
