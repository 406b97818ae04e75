"""Height fields for curved parts of a large static surface that form no regular grid, such as a pipe or a rock.

A tile samples the surface below a rectangle, seen along the mean normal of a patch. It compiles without a hull, and one
tile replaces the many convex pieces of a concave patch. A tile is used only where the surface has one layer without
holes below the whole rectangle, and where nothing else lies in the solid below the surface. All patches of one size are
computed together, because calls of NumPy for a few triangles are slow.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from simkit.compiler.meshes.box_overlaps import all_of_three, overlaps
from simkit.compiler.meshes.connected_triangles import part_numbers
from simkit.compiler.meshes.height_tiles import HeightTile, Mask
from simkit.compiler.meshes.sampled_fields import SampledFields, heights_above, sampled_heights, surface_points
from simkit.linear_algebra import matmul
from simkit.loaders.meshes.mesh_part import Floats, Indices, Ints
from simkit.matrix_decompositions import eigh

_CELLS: Final = 25
"""Largest number of cells of a tile; the engine keeps at most 50 contacts with a height field, one per triangle."""

_LONGEST: Final = 12
"""Largest number of cells along one side of a tile."""

_FEWEST: Final = 3
"""Least number of triangles of a patch that is divided."""

_ROUNDS: Final = 24
"""Largest number of divisions of a patch."""

_LEAST_SLOPE: Final = 0.35
"""Least share of the unit normals of a patch along the direction of the heights."""

_LEAST_SLOPE_AROUND: Final = 0.2
"""The same for the triangles beside the patch below the same rectangle."""

_ABOVE: Final = 0.25
"""Height above and below a patch in which other triangles are known, relative to its largest extent."""

_OPEN_LAYERS: Final = 2.0
"""Largest height of a tile of an open surface, whose back bodies can reach, relative to the layer below the surface."""

_WIDEST: Final = 8.0
"""Largest extent of a patch, relative to the median of all patches that are computed together."""

_BLOCK: Final = 30_000
"""Number of triangles of the patches that are computed together, which limits the memory."""


class CurvedTiles(NamedTuple):
    """Tiles of the curved parts of a mesh.

    Attributes:
        tiles: height fields.
        is_left: mask of the triangles without a tile.
        error: largest distance between a tile and the surface [m].
    """

    tiles: list[HeightTile]
    is_left: Mask
    error: float


def curved_tiles(
    vertices: Floats, faces: Ints, chosen: Indices, depths: Floats, groups: Indices, tolerance: float
) -> CurvedTiles:
    """Return tiles that cover curved triangles.

    Args:
        vertices: vertices of the whole mesh [m], shape (n, 3).
        faces: vertex indices of the whole mesh, shape (m, 3).
        chosen: numbers of the curved triangles, which have an area, shape (k,).
        depths: thickness of the layer below each of them [m], shape (k,).
        groups: numbers of connected areas of one side of the mesh, shape (k,).
        tolerance: largest distance between a tile and the surface [m].
    """
    surface = _surface_of(vertices, faces)
    depth = np.full(len(faces), np.inf)
    depth[chosen] = depths
    is_left = np.zeros(len(faces), bool)
    is_left[chosen] = True
    tiles: list[HeightTile] = []
    largest, members, labels = 0.0, chosen, groups
    for _ in range(_ROUNDS):
        if not len(members):
            break
        order = np.argsort(labels, kind="stable")
        members, labels = members[order], labels[order]
        patches = _patches_of(surface, members, labels, depth)
        for block in _promising(patches, tolerance):
            for tile, error in _fitted_tiles(surface, patches, block, tolerance, is_left):
                tiles.append(tile)
                largest = max(largest, error)
        keep = is_left[members] & (patches.counts > _FEWEST)[patches.of_member]
        sides = patches.side[keep]
        members, labels = members[keep], 2 * patches.of_member[keep] + sides
    return CurvedTiles(tiles, is_left[chosen], largest)


@dataclass(frozen=True, eq=False)
class _Surface:
    """Triangles of a whole mesh.

    Attributes:
        corners: corners [m], shape (n, 3, 3).
        centres: centres [m], shape (n, 3).
        radii: largest distances of the corners from the centres [m], shape (n,).
        low: least coordinates of each triangle [m], shape (n, 3).
        high: largest coordinates, shape (n, 3).
        normals: normals with the areas as lengths [m²], shape (n, 3).
        units: unit normals, shape (n, 3).
        edges: numbers of the edges, shape (n, 3).
        is_closed: mask of the triangles of closed connected parts.
        snap: length [m] that counts as zero.
    """

    corners: Floats
    centres: Floats
    radii: Floats
    low: Floats
    high: Floats
    normals: Floats
    units: Floats
    edges: Indices
    is_closed: Mask
    snap: float


def _surface_of(vertices: Floats, faces: Ints) -> _Surface:
    corners = vertices[faces]
    normals = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    units = normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    points = len(vertices)
    ends = faces[:, ((0, 1), (1, 2), (2, 0))].astype(np.int64)
    keys = ends.min(axis=2) * points + ends.max(axis=2)
    _, numbers, counts = np.unique(keys, return_inverse=True, return_counts=True)
    edges = numbers.reshape(-1, 3).astype(np.int64)
    part = part_numbers(faces)
    is_open = np.zeros(points, bool)
    is_open[part[(counts[edges] != 2).any(axis=1)]] = True
    low, high, centres = corners.min(axis=1), corners.max(axis=1), corners.mean(axis=1)
    radii = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
    snap = 1e-6 * float((high.max(axis=0) - low.min(axis=0)).max())
    return _Surface(corners, centres, radii, low, high, normals, units, edges, ~is_open[part], snap)


@dataclass(frozen=True, eq=False)
class _Patches:
    """Patches of triangles that can become tiles.

    Attributes:
        of_member: number of the patch of each triangle.
        side: side of the plane that divides the patch on which each triangle lies, 0 or 1.
        counts: numbers of triangles.
        axes: directions of columns, rows and heights, as columns of rotation matrices, shape (n, 3, 3).
        low: least coordinates along the axes [m], shape (n, 3).
        high: largest coordinates, shape (n, 3).
        slopes: least share of the unit normals along the direction of the heights.
        cells: numbers of cells of a tile along both sides, shape (n, 2).
        expected: error of a tile if the surface bends evenly [m].
        depths: thickness of the layer below the surface [m].
    """

    of_member: Indices
    side: Indices
    counts: Indices
    axes: Floats
    low: Floats
    high: Floats
    slopes: Floats
    cells: Indices
    expected: Floats
    depths: Floats


def _promising(patches: _Patches, tolerance: float) -> list[Indices]:
    """Return the numbers of the patches that may become tiles, in blocks that are computed together."""
    chosen = np.flatnonzero((patches.slopes > _LEAST_SLOPE) & (patches.expected <= tolerance))
    if not len(chosen):
        return []
    extents = (patches.high - patches.low)[chosen].max(axis=1)
    chosen = chosen[extents <= _WIDEST * np.median(extents)]
    block = np.cumsum(patches.counts[chosen]) // _BLOCK
    return np.split(chosen, np.flatnonzero(np.diff(block)) + 1)


def _patches_of(surface: _Surface, members: Indices, labels: Indices, depths: Floats) -> _Patches:
    """Return the patches of triangles in the order of their labels.

    Args:
        surface: whole mesh.
        members: numbers of the triangles, shape (n,).
        labels: number of the patch of each triangle in ascending order; numbers may be missing.
        depths: thickness of the layer below each triangle of the mesh [m].
    """
    starts = np.append(0, np.flatnonzero(np.diff(labels)) + 1)
    counts = np.diff(np.append(starts, len(labels)))
    of = np.repeat(np.arange(len(starts)), counts)
    normals, units = surface.normals[members], surface.units[members]
    up = np.add.reduceat(normals, starts)
    up /= np.maximum(np.linalg.norm(up, axis=1), 1e-300)[:, None]
    across = units - np.einsum("ij,ij->i", units, up[of])[:, None] * up[of]
    areas = np.linalg.norm(normals, axis=1)
    bends = np.add.reduceat((across * areas[:, None])[:, :, None] * across[:, None], starts)
    along = eigh(bends)[1][:, :, 2]
    along = along - np.einsum("ij,ij->i", along, up)[:, None] * up
    along /= np.maximum(np.linalg.norm(along, axis=1), 1e-300)[:, None]
    axes = np.stack([along, np.cross(up, along), up], axis=2)
    local = matmul(surface.corners[members], axes[of])
    low = np.minimum.reduceat(local.min(axis=1), starts)
    high = np.maximum.reduceat(local.max(axis=1), starts)
    slopes = np.einsum("ij,ijk->ik", units, axes[of])
    bend = np.maximum.reduceat(slopes[:, :2], starts) - np.minimum.reduceat(slopes[:, :2], starts)
    extents = (high - low)[:, :2]
    weights = extents * np.maximum(bend, 1e-3)
    ratio = np.sqrt(_CELLS * np.sqrt(weights[:, 0] / np.maximum(weights[:, 1], 1e-300)))
    columns = np.rint(ratio).clip(1, _LONGEST).astype(np.int64)
    cells = np.column_stack([columns, (_CELLS // columns).clip(1, _LONGEST)])
    # the sag of an arc is an eighth of its length times the turn of its normal; half of it is on each side of a tile
    expected = (extents * bend / (16.0 * cells**2)).sum(axis=1)
    cut = (extents * bend + 1e-3 * extents).argmax(axis=1)
    middles = np.take_along_axis(local.mean(axis=1), cut[of][:, None], axis=1)[:, 0]
    half = 0.5 * (np.minimum.reduceat(middles, starts) + np.maximum.reduceat(middles, starts))
    side = (middles > half[of]).astype(np.int64)
    depth = np.minimum.reduceat(depths[members], starts)
    least = np.minimum.reduceat(slopes[:, 2], starts)
    return _Patches(of, side, counts, axes, low, high, least, cells, expected, depth)


def _fitted_tiles(
    surface: _Surface, patches: _Patches, chosen: Indices, tolerance: float, is_left: Mask
) -> list[tuple[HeightTile, float]]:
    """Return the tiles that fit, with their errors [m], and remove their triangles from the mask `is_left`."""
    axes, depths, cells = patches.axes[chosen], patches.depths[chosen], patches.cells[chosen]
    low, high = patches.low[chosen].copy(), patches.high[chosen].copy()
    snap = surface.snap
    is_good = (high - low)[:, :2].min(axis=1) > 100.0 * snap
    margin = _ABOVE * (high - low).max(axis=1) + depths
    low[:, 2] -= margin
    high[:, 2] += margin
    middle, half = np.einsum("ijk,ik->ij", axes, 0.5 * (low + high)), 0.5 * (high - low)
    reach = np.einsum("ijk,ik->ij", np.abs(axes), half)
    of, triangles = overlaps(middle - reach, middle + reach, surface.low, surface.high)
    centres = np.einsum("ijk,ij->ik", axes[of], surface.centres[triangles] - middle[of])
    is_close = all_of_three(np.abs(centres) <= half[of] + surface.radii[triangles, None])
    of, triangles = of[is_close], triangles[is_close]
    local = matmul(surface.corners[triangles], axes[of])
    lowest, highest = (end(end(local[:, 0], local[:, 1]), local[:, 2]) for end in (np.minimum, np.maximum))
    is_inside = all_of_three((lowest < high[of] - snap) & (highest > low[of] + snap))
    is_top = is_inside & (np.einsum("ij,ij->i", surface.units[triangles], axes[of, :, 2]) > _LEAST_SLOPE_AROUND)
    other_of, other_low, other_high = (a[is_inside & ~is_top] for a in (of, lowest[:, 2], highest[:, 2]))
    of, triangles, local, lowest, highest = (a[is_top] for a in (of, triangles, local, lowest, highest))
    is_good &= ~_has_border(surface, of, triangles, local, low, high)
    heights, is_sampled = sampled_heights(of, local, low, high, 2 * cells + 1, snap)
    is_good &= is_sampled
    first = np.append(0, np.cumsum((2 * cells + 1).prod(axis=1)))
    lowest_of, highest_of = (end.reduceat(heights, first[:-1]) for end in (np.minimum, np.maximum))
    bottom = lowest_of - depths
    is_good &= (bottom >= low[:, 2]) & (highest_of <= high[:, 2])
    is_open = np.zeros(len(chosen), bool)
    is_open[of[~surface.is_closed[triangles]]] = True
    is_good &= ~is_open | (highest_of - bottom <= (1.0 + _OPEN_LAYERS) * depths)
    is_in_solid = (other_high > bottom[other_of]) & (other_low < highest_of[other_of] - snap)
    is_good[other_of[is_in_solid]] = False
    fields = SampledFields(heights, first[:-1], cells, (high - low)[:, :2] / cells)
    at, points = surface_points(fields, of, local, low, high)
    is_wanted = is_good[at]
    at, points = at[is_wanted], points[is_wanted]
    above, cosines = heights_above(fields, at, points)
    ends = np.full((2, len(chosen)), -np.inf)
    np.maximum.at(ends[0], at, above)
    np.maximum.at(ends[1], at, -above)
    shift = np.zeros(len(chosen))
    shift[is_good] = 0.5 * (ends[0, is_good] - ends[1, is_good])
    errors = np.zeros(len(chosen))
    np.maximum.at(errors, at, np.abs(above - shift[at]) * cosines)
    is_good &= errors <= tolerance
    is_between = (lowest[:, :2] >= low[of, :2] - snap) & (highest[:, :2] <= high[of, :2] + snap)
    is_covered = is_good[of] & is_between[:, 0] & is_between[:, 1]
    is_left[triangles[is_covered]] = False
    return [
        (fields.tile(k, axes[k], low[k], depths[k], shift[k]), float(errors[k]))
        for k in np.flatnonzero(is_good).tolist()
    ]


def _has_border(surface: _Surface, of: Indices, triangles: Indices, local: Floats, low: Floats, high: Floats) -> Mask:
    """Return a mask of the rectangles that are crossed by an edge that only one of their triangles has."""
    edges = surface.edges[triangles].reshape(-1) + np.repeat(of, 3) * (int(surface.edges.max()) + 1)
    _, first, counts = np.unique(edges, return_index=True, return_counts=True)
    triangle, side = np.divmod(first[counts == 1], 3)
    start, end = local[triangle, side, :2], local[triangle, (side + 1) % 3, :2]
    here = of[triangle]
    inner_low, inner_high = low[here, :2] + 10.0 * surface.snap, high[here, :2] - 10.0 * surface.snap
    along = end - start
    along = np.where(np.abs(along) < 1e-12, 1e-12, along)
    enter, leave = (inner_low - start) / along, (inner_high - start) / along
    crossing = np.minimum(enter, leave).max(axis=1).clip(0.0) < np.maximum(enter, leave).min(axis=1).clip(None, 1.0)
    result = np.zeros(len(low), bool)
    result[here[crossing]] = True
    return result
