"""Height fields that sample a surface: heights, test points and the distances of the surface from the fields."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from simkit.compiler.meshes.box_overlaps import ragged
from simkit.compiler.meshes.height_tiles import HeightTile, Mask
from simkit.linear_algebra import matmul
from simkit.loaders.meshes.mesh_part import Floats, Indices

_INSIDE: Final = 1e-6
"""Rounding of barycentric coordinates."""


def sampled_heights(
    of: Indices, local: Floats, low: Floats, high: Floats, counts: Indices, snap: float
) -> tuple[Floats, Mask]:
    """Return the heights of surfaces on grids, one after the other, and a mask of the grids with one height everywhere.

    Args:
        of: number of the rectangle of each triangle.
        local: corners of the triangles along the axes of their rectangles [m], shape (n, 3, 3).
        low: least coordinates of the rectangles [m], shape (k, 3).
        high: largest coordinates, shape (k, 3).
        counts: numbers of points along both sides, shape (k, 2).
        snap: length [m] that counts as zero.
    """
    step = ((high - low)[:, :2] / (counts - 1))[of]
    start, last = low[of, :2], (counts - 1)[of]
    flat = local[:, :, :2]
    lowest, highest = (end(end(flat[:, 0], flat[:, 1]), flat[:, 2]) for end in (np.minimum, np.maximum))
    least = np.ceil((lowest - snap - start) / step).clip(0, last + 1).astype(np.int64)
    most = np.floor((highest + snap - start) / step).clip(-1, last).astype(np.int64)
    spans = np.maximum(most - least + 1, 0)
    at, place = ragged(spans.prod(axis=1))
    i, j = np.divmod(place, spans[at, 1])
    grid = np.column_stack([i, j]) + least[at]
    # the points on the border stay inside in spite of rounding
    points = (start[at] + grid * step[at]).clip(low[of[at], :2] + snap, high[of[at], :2] - snap)
    a = local[:, 0]
    b, c = local[:, 1] - a, local[:, 2] - a
    scale = 1.0 / (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])
    x, y = (points - a[at, :2]).T
    first, second = (x * c[at, 1] - y * c[at, 0]) * scale[at], (y * b[at, 0] - x * b[at, 1]) * scale[at]
    is_inside = (first >= -_INSIDE) & (second >= -_INSIDE) & (first + second <= 1.0 + _INSIDE)
    heights = (a[at, 2] + first * b[at, 2] + second * c[at, 2])[is_inside]
    starts = np.append(0, np.cumsum(counts.prod(axis=1)))
    node = (starts[of[at]] + grid[:, 0] * counts[of[at], 1] + grid[:, 1])[is_inside]
    least_of, most_of = np.full(starts[-1], np.inf), np.full(starts[-1], -np.inf)
    np.minimum.at(least_of, node, heights)
    np.maximum.at(most_of, node, heights)
    with np.errstate(invalid="ignore"):
        is_single = (most_of - least_of <= 20.0 * snap) & np.isfinite(most_of)
    return np.where(np.isfinite(most_of), most_of, 0.0), np.logical_and.reduceat(is_single, starts[:-1])


@dataclass(frozen=True, eq=False)
class SampledFields:
    """Height fields, sampled with half the length of their cells.

    Attributes:
        heights: sampled heights, one field after the other [m].
        first: number of the first height of each field.
        cells: numbers of cells along both sides, shape (n, 2).
        lengths: lengths of the cells [m], shape (n, 2).
    """

    heights: Floats
    first: Indices
    cells: Indices
    lengths: Floats

    def tile(self, k: int, axes: Floats, low: Floats, depth: float, shift: float) -> HeightTile:
        """Return one field as a tile, moved along its heights."""
        columns, rows = (2 * self.cells[k] + 1).tolist()
        fine = self.heights[self.first[k] : self.first[k] + columns * rows].reshape(columns, rows)
        heights = np.ascontiguousarray(fine[::2, ::2].T)
        least = float(heights.min())
        origin = matmul(axes, (low[0], low[1], least + shift))
        return HeightTile(origin, axes.copy(), self.lengths[k].copy(), heights - least, float(depth))


def surface_points(
    fields: SampledFields, of: Indices, local: Floats, low: Floats, high: Floats
) -> tuple[Indices, Floats]:
    """Return points of the surface, relative to the first corner of their rectangles, and the numbers of the fields.

    The points are the corners, the middles and the middles of edges of triangles, and the sampled points.
    """
    middles = local.mean(axis=1, keepdims=True)
    points = np.concatenate([local, 0.5 * (local + local[:, (1, 2, 0)]), middles], axis=1).reshape(-1, 3)
    at = np.repeat(of, 7)
    is_between = (points[:, :2] >= low[at, :2]) & (points[:, :2] <= high[at, :2])
    is_inside = is_between[:, 0] & is_between[:, 1]
    at, points = at[is_inside], points[is_inside]
    points[:, :2] -= low[at, :2]
    counts = 2 * fields.cells + 1
    here, place = ragged(counts.prod(axis=1))
    i, j = np.divmod(place, counts[here, 1])
    sampled = np.column_stack([0.5 * np.column_stack([i, j]) * fields.lengths[here], fields.heights])
    return np.concatenate([at, here]), np.concatenate([points, sampled])


def heights_above(fields: SampledFields, at: Indices, points: Floats) -> tuple[Floats, Floats]:
    """Return the heights of points above their fields [m], and the cosines of the fields' slopes."""
    cells, lengths = fields.cells[at], fields.lengths[at]
    steps = points[:, :2] / lengths
    places = np.minimum(steps.astype(np.int64), cells - 1)
    x, y = (steps - places).T
    row = 2 * cells[:, 1] + 1
    corner = fields.first[at] + 2 * places[:, 0] * row + 2 * places[:, 1]
    first, last = fields.heights[corner], fields.heights[corner + 2 * row + 2]
    # the engine divides each cell from its first to its last corner
    is_lower = x >= y
    middle = fields.heights[np.where(is_lower, corner + 2 * row, corner + 2)]
    along_x = np.where(is_lower, middle - first, last - middle)
    along_y = np.where(is_lower, last - middle, middle - first)
    above = points[:, 2] - first - along_x * x - along_y * y
    slopes = (along_x / lengths[:, 0]) ** 2 + (along_y / lengths[:, 1]) ** 2
    return above, 1.0 / np.sqrt(1.0 + slopes)
