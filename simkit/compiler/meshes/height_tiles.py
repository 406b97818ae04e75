"""Height fields for the parts of a large static surface that are regular grids, such as a terrain from heights.

A height field is exact and compiles without a hull. But the engine keeps at most 50 contacts between a height field
and another shape: a large box would sink into a fine grid. Therefore the grid is divided into tiles of 50 triangles. A
tile is solid down to a plane a little below its lowest point.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.compiler.meshes.convex_pieces import layer_depths
from simkit.linear_algebra import matmul
from simkit.loaders.meshes.mesh_part import Floats, Ints

_TRIANGLES_FROM: Final = 2000
"""Number of triangles on one side of a mesh from which a grid is searched for."""

_CELLS: Final = 5
"""Number of cells along each side of a tile: 5 · 5 · 2 triangles give at most 50 contacts."""

_LARGEST_RELIEF: Final = 0.06
"""Largest height of a tile, relative to the size of the mesh, because the tile fills the room below its surface."""

_LEAST_SLOPE: Final = 0.05
"""Least share of a unit normal along the direction of the heights."""

_SHIFT: Final = 1e-3
"""Largest distance of a corner from its place in the grid, relative to a cell."""

Mask = npt.NDArray[np.bool_]
_Block = tuple[int, int, int, int]
"""First cell along both axes, and numbers of cells."""


@dataclass(frozen=True, eq=False)
class HeightTile:
    """Height field.

    Attributes:
        origin: corner of the tile at its lowest height, in the frame of the mesh [m].
        axes: directions of columns, rows and heights, as columns of a rotation matrix.
        cell: length of a cell along columns and rows [m].
        heights: heights above the lowest point [m], shape (rows, columns).
        base: thickness below the lowest point [m].
    """

    origin: Floats
    axes: Floats
    cell: Floats
    heights: Floats
    base: float


def height_tiles(vertices: Floats, faces: Ints, corners: Floats, tolerance: float) -> tuple[list[HeightTile], Mask]:
    """Return tiles for triangles that form regular grids, and a mask of all other triangles.

    Args:
        vertices: vertices of the whole mesh [m], shape (n, 3).
        faces: vertex indices of the whole mesh, shape (m, 3).
        corners: corners of the triangles, counter-clockwise from outside [m], shape (n, 3, 3).
        tolerance: largest error of a cell that is divided along its other diagonal [m].
    """
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    size = float(np.ptp(corners.reshape(-1, 3), axis=0).max()) if len(corners) else 0.0
    tiles: list[HeightTile] = []
    is_left = np.ones(len(corners), bool)
    for axes in _directions():
        chosen = np.flatnonzero(is_left & (matmul(normals, axes[:, 2]) > _LEAST_SLOPE))
        if len(chosen) < _TRIANGLES_FROM:
            continue
        grid = _grid_of(matmul(corners[chosen], axes))
        if grid is None:
            continue
        inside = grid.triangles
        grid.set_rooms(*layer_depths(vertices, faces, corners[chosen[inside]], axes[:, 2]))
        for is_turned in (False, True):
            blocks = _blocks(grid, is_turned, size * _LARGEST_RELIEF, tolerance)
            curved = [block for block in blocks if not _is_flat(grid, block, tolerance)]
            # few patches cover a large plane, but many are needed around single flat tiles
            for i, j, m, n in curved if 2 * len(curved) < len(blocks) else blocks:
                tiles.append(_tile(grid, axes, is_turned, (i, j, m, n)))
                grid.is_free[i : i + m, j : j + n] = False
        is_left[chosen[inside]] = grid.is_free[grid.places[inside, 0], grid.places[inside, 1]]
    return tiles, is_left


def _directions() -> Iterator[Floats]:
    """Return right-handed axes whose third axis is +z, -z, +x, -x, +y, -y."""
    for k in (2, 0, 1):
        for sign in (1.0, -1.0):
            up, along = sign * np.eye(3)[k], np.eye(3)[(k + 1) % 3]
            yield np.column_stack([along, np.cross(up, along), up])


@dataclass(eq=False)
class _Grid:
    """Regular grid of heights.

    Attributes:
        start: position of the first corner along columns and rows [m].
        cell: length of a cell [m].
        heights: heights of the corners [m], shape (m + 1, n + 1).
        has_main: mask of the cells with both triangles of the diagonal from the first to the last corner.
        has_other: the same for the other diagonal.
        is_free: mask of the cells without a tile.
        triangles: mask of the triangles that belong to the grid.
        places: cell of each triangle, shape (k, 2).
        depths: thickness of the layer below each cell [m].
        rooms: distance from each cell to the next surface below it [m].
    """

    start: Floats
    cell: Floats
    heights: Floats
    has_main: Mask
    has_other: Mask
    is_free: Mask
    triangles: Mask
    places: Ints
    depths: Floats
    rooms: Floats

    def set_rooms(self, depths: Floats, rooms: Floats) -> None:
        """Set the least values of the triangles of each cell."""
        at = self.places[self.triangles]
        np.minimum.at(self.depths, (at[:, 0], at[:, 1]), depths)
        np.minimum.at(self.rooms, (at[:, 0], at[:, 1]), rooms)


def _grid_of(local: Floats) -> _Grid | None:
    """Return the grid of triangles; None if most of them do not fit one.

    Args:
        local: corners with heights as third coordinate [m], shape (k, 3, 3).
    """
    flat = local[:, :, :2]
    extents = np.ptp(flat, axis=1)
    cell = np.median(extents, axis=0)
    if not (cell > 0.0).all():
        return None
    fits = (np.abs(extents - cell) < _SHIFT * cell).all(axis=1)
    if fits.sum() < max(_TRIANGLES_FROM, 0.5 * len(fits)):
        return None
    start, end = flat[fits].min(axis=(0, 1)), flat[fits].max(axis=(0, 1))
    counts = np.rint((end - start) / cell).astype(int)
    cell = (end - start) / counts  # more exact than one extent in single precision
    if counts.prod() > 2 * len(fits):
        return None
    steps = (flat - start) / cell
    corners = np.rint(steps).astype(np.int32)
    fits &= (np.abs(steps - corners) < _SHIFT).all(axis=(1, 2))
    places = corners.min(axis=1)
    offsets = corners - places[:, None]
    codes = offsets[:, :, 0] + 2 * offsets[:, :, 1]
    fits &= (offsets <= 1).all(axis=(1, 2))
    fits &= (places >= 0).all(axis=1) & (places < counts).all(axis=1)
    heights = np.zeros(counts + 1)
    heights[corners[fits][..., 0], corners[fits][..., 1]] = local[fits][..., 2]
    known = heights[corners[..., 0].clip(0, counts[0]), corners[..., 1].clip(0, counts[1])]
    fits &= (np.abs(known - local[..., 2]) <= _SHIFT * cell.min()).all(axis=1)
    if fits.sum() < _TRIANGLES_FROM:
        return None
    missing = 6 - codes.sum(axis=1)  # number of the cell's corner that the triangle does not have
    has = np.zeros((4, *counts), bool)
    has[missing[fits].clip(0, 3), places[fits, 0], places[fits, 1]] = True
    main, other, free = has[1] & has[2], has[0] & has[3], np.ones(counts, bool)
    depths, rooms = np.full(counts, np.inf), np.full(counts, np.inf)
    return _Grid(start, cell, heights, main, other, free, fits, places, depths, rooms)


def _blocks(grid: _Grid, is_turned: bool, relief: float, tolerance: float) -> list[_Block]:
    """Return the first cell and the numbers of cells of each block that can be a tile.

    Args:
        grid: grid of the surface.
        is_turned: true for cells divided along the other diagonal.
        relief: largest height of a tile [m].
        tolerance: largest error of a cell that is divided along the wrong diagonal [m].
    """
    h = grid.heights
    twist = 0.5 * np.abs(h[:-1, :-1] + h[1:, 1:] - h[1:, :-1] - h[:-1, 1:])
    main, other = (grid.has_other, grid.has_main) if is_turned else (grid.has_main, grid.has_other)
    fits = grid.is_free & (main | (other & (twist <= tolerance)))
    blocks = []
    for i in range(0, fits.shape[0], _CELLS):
        for j in range(0, fits.shape[1], _CELLS):
            block = slice(i, i + _CELLS), slice(j, j + _CELLS)
            if not fits[block].all():
                continue
            m, n = fits[block].shape
            height = float(np.ptp(h[i : i + m + 1, j : j + n + 1]))
            if height <= relief and height + float(grid.depths[block].min()) <= float(grid.rooms[block].min()):
                blocks.append((i, j, m, n))
    return blocks


def _is_flat(grid: _Grid, block: _Block, tolerance: float) -> bool:
    """Check whether the heights of a block differ from a plane by less than a tolerance."""
    i, j, m, n = block
    h = grid.heights[i : i + m + 1, j : j + n + 1]
    plane = h[0, 0] + np.add.outer(
        np.linspace(0.0, h[-1, 0] - h[0, 0], m + 1), np.linspace(0.0, h[0, -1] - h[0, 0], n + 1)
    )
    return bool(np.abs(h - plane).max() < tolerance)


def _tile(grid: _Grid, axes: Floats, is_turned: bool, block: _Block) -> HeightTile:
    """Return the tile of a block. MuJoCo divides each cell from its first to its last corner."""
    i, j, m, n = block
    heights = grid.heights[i : i + m + 1, j : j + n + 1].T  # rows along the second axis
    u, v = grid.start + grid.cell * (i, j)
    low, cell, turned = float(heights.min()), grid.cell, axes
    if is_turned:  # by 90°: columns along the second axis, rows against the first
        u += m * float(cell[0])
        heights = heights.T[::-1]
        cell, turned = cell[::-1], np.column_stack([axes[:, 1], -axes[:, 0], axes[:, 2]])
    origin = matmul(axes, (u, v, low))
    base = float(grid.depths[i : i + m, j : j + n].min())
    return HeightTile(origin, turned, np.array(cell), np.ascontiguousarray(heights - low), base)
