"""Corners of drawn shapes, for the boxes around them."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.extend import Vector
from simkit.sensors.rays.embree_rays import heightmap_grid, mesh_triangles

Pairs = npt.NDArray[np.int32]

_ROUND: Final = 64  # corners of a circle, which gives a ball of 400 px an error of half a pixel
_ENDLESS: Final = 1000.0  # [m] size of an infinite plane
_KINDS = mujoco.mjtGeom

CUBE: Final = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
"""Corners of a cube with edges of 2, shape (8, 3); two corners whose numbers differ in one bit share an edge."""

CUBE_EDGES: Final = np.array([(i, i | bit) for i in range(8) for bit in (1, 2, 4) if not i & bit], np.int32)
"""Edges of the cube as pairs of corners, shape (12, 2)."""


@dataclass(frozen=True, slots=True, eq=False)
class Corners:
    """Corners of a shape in its geom's frame [m], shape (n, 3), and its edges as pairs of corners, shape (m, 2)."""

    points: Vector
    edges: Pairs


def geom_corners(model: mujoco.MjModel, geom: int) -> Corners:
    """Return the corners of a geom as it is drawn; a circle has 64 corners."""
    kind, size = int(model.geom_type[geom]), np.array(model.geom_size[geom])
    if kind in (_KINDS.mjGEOM_SPHERE, _KINDS.mjGEOM_ELLIPSOID):
        ball = _sphere()
        return Corners(ball.points * (size if kind == _KINDS.mjGEOM_ELLIPSOID else size[0]), ball.edges)
    if kind == _KINDS.mjGEOM_CAPSULE:
        ball = _sphere()
        ends = np.where(ball.points[:, 2:] >= 0, size[1], -size[1]) * (0.0, 0.0, 1.0)
        return Corners(ball.points * size[0] + ends, ball.edges)
    if kind == _KINDS.mjGEOM_CYLINDER:
        can = _cylinder()
        return Corners(can.points * (size[0], size[0], size[1]), can.edges)
    if kind == _KINDS.mjGEOM_PLANE:
        x, y = (float(s) if s > 0 else _ENDLESS for s in size[:2])
        square = np.array(((-x, -y, 0.0), (x, -y, 0.0), (x, y, 0.0), (-x, y, 0.0)))
        return Corners(square, np.array(((0, 1), (1, 2), (2, 3), (3, 0)), np.int32))
    if kind in (_KINDS.mjGEOM_MESH, _KINDS.mjGEOM_SDF):
        points, faces = mesh_triangles(model, int(model.geom_dataid[geom]))
        return Corners(points, _unique_edges(faces))
    if kind == _KINDS.mjGEOM_HFIELD:
        grid = heightmap_grid(model, int(model.geom_dataid[geom]))
        return Corners(grid.reshape(-1, 3), _grid_edges(*grid.shape[:2]))
    return Corners(CUBE * size, CUBE_EDGES)


def _grid_edges(rows: int, columns: int, is_closed: bool = False) -> Pairs:
    """Return the edges of a grid of corners along rows and columns; if closed, the end of a row joins its beginning."""
    numbers = np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)
    along = np.stack((numbers, np.roll(numbers, -1, axis=1)), axis=-1)
    if not is_closed:
        along = along[:, :-1]
    across = np.stack((numbers[:-1], numbers[1:]), axis=-1)
    return np.concatenate((along.reshape(-1, 2), across.reshape(-1, 2)))


def _unique_edges(faces: npt.NDArray[np.integer]) -> Pairs:
    """Return each edge of triangles (m, 3) once."""
    ends = np.sort(np.concatenate((faces[:, :2], faces[:, 1:], faces[:, ::2])), axis=1).astype(np.int32)
    edges: Pairs = np.unique(ends, axis=0)
    return edges


@functools.cache
def _circle() -> Vector:
    angles = np.arange(_ROUND) * (2 * np.pi / _ROUND)
    circle: Vector = np.stack((np.cos(angles), np.sin(angles)), axis=1)
    circle[np.abs(circle) < 1e-12] = 0.0
    return circle


@functools.cache
def _cylinder() -> Corners:
    ends = [np.column_stack((_circle(), np.full(_ROUND, z))) for z in (-1.0, 1.0)]
    return Corners(np.concatenate(ends), _grid_edges(2, _ROUND, is_closed=True))


@functools.cache
def _sphere() -> Corners:
    """Return a sphere of radius 1; its widest ring exists twice, for the two halves of a capsule."""
    heights = np.linspace(-np.pi / 2, np.pi / 2, _ROUND // 2 + 1)
    middle = len(heights) // 2
    heights = np.insert(heights, middle, heights[middle])
    widths, z = np.cos(heights), np.sin(heights)
    z[middle], z[middle + 1] = -1e-15, 0.0
    rings = [np.column_stack((_circle() * w, np.full(_ROUND, h))) for w, h in zip(widths, z, strict=True)]
    return Corners(np.concatenate(rings), _grid_edges(len(heights), _ROUND, is_closed=True))
