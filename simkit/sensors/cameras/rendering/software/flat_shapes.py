"""Triangles of planes and lines, which depend on the camera."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from simkit.sensors.cameras.rendering.software.frame import Frame
from simkit.sensors.cameras.rendering.software.shape_meshes import LINE
from simkit.sensors.cameras.rendering.software.shape_table import ShapeTable
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, Integers, cross, dot, rotate, unit

_LAMP_SQUARES: Final = 32  # divisions of an edge of a plane below a lamp


def plane_points(
    table: ShapeTable, row: int, frame: Frame, squares: int, lamps: Sequence[Array] = ()
) -> tuple[Floats, Floats, Integers]:
    """Return the corners, normals and faces of a plane, divided into squares that are smallest below the camera.

    Args:
        table: shapes of the scene.
        row: row of the plane in the table.
        frame: frame of the image.
        squares: number of divisions of each edge.
        lamps: positions of lamps relative to the frame's origin [m], below which the squares are small, too.
    """
    rotation = table.rotations[row].astype(np.float64)
    position = table.positions[row].astype(np.float64) - frame.origin
    feet = [rotate((place - position)[None], rotation.T)[0] for place in (frame.eye, *lamps)]
    steps = [np.linspace(-1.0, 1.0, count + 1) for count in (squares, *(_LAMP_SQUARES for _ in lamps))]
    edges = []
    for axis in (0, 1):
        half = float(table.sizes[row, axis])
        lines = []
        for foot, step in zip(feet, steps, strict=True):
            centre, reach = float(foot[axis]), 1.5 * frame.view.far
            if half > 0.0:
                centre = min(max(centre, -half), half)
                reach = max(half - centre, half + centre)
            lines.append(centre + step * step * step * reach)
        coordinates = np.unique(np.concatenate(lines))
        edges.append(np.unique(np.clip(coordinates, -half, half)) if half > 0.0 else coordinates)
    along, across = (values.ravel() for values in np.meshgrid(*edges, indexing="ij"))
    local = np.stack((along, across, np.zeros_like(along)), axis=-1)
    points = (rotate(local, rotation) + position).astype(np.float32)
    normals = np.tile(table.rotations[row][:, 2], (len(points), 1))
    rows, columns = len(edges[0]), len(edges[1])
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel().astype(np.int32)
    faces = np.concatenate(
        (
            np.column_stack((first, first + columns, first + columns + 1)),
            np.column_stack((first, first + columns + 1, first + 1)),
        )
    )
    return points, normals, np.ascontiguousarray(faces, np.int32)


def line_points(table: ShapeTable, row: int, frame: Frame) -> tuple[Floats, Floats, Integers]:
    """Return the corners, normals and faces of a line or of the edges of a box, as strips that face the camera."""
    size = table.sizes[row].astype(np.float64)
    if int(table.kinds[row]) == LINE:
        ends, width = np.array((((0.0, 0.0, 0.0), (0.0, 0.0, size[2])),)), float(size[0])
    else:
        ends, width = _box_edges() * size, 1.5
    position = table.positions[row].astype(np.float64) - frame.origin
    rotation = table.rotations[row].astype(np.float64)
    a, b = (rotate(ends[:, k], rotation) + position for k in (0, 1))
    a, b = _in_front(frame, a, b)
    strips = []
    for near, other in ((a, b), (b, a)):
        sight = near - frame.eye
        side = unit(cross(other - near, sight)) if near is a else unit(cross(near - other, sight))
        depth = np.maximum(dot(sight, frame.ahead), frame.view.near)
        half = 0.5 * max(width, 1.0) * depth / frame.pixels_per_tangent
        strips += [near - half[:, None] * side, near + half[:, None] * side]
    points = np.stack(strips, axis=1).reshape(-1, 3).astype(np.float32)
    base = 4 * np.arange(len(a), dtype=np.int32)[:, None]
    # both directions, because a strip has no front
    halves = ((0, 1, 3), (0, 3, 2), (0, 3, 1), (0, 2, 3))
    faces = np.concatenate([base + np.array(corners, np.int32) for corners in halves])
    return points, np.zeros_like(points), faces


def _in_front(frame: Frame, a: Array, b: Array) -> tuple[Array, Array]:
    """Return lines cut at the near plane; a line behind the camera becomes a point."""
    depths = [dot(end - frame.eye, frame.ahead) - 1.01 * frame.view.near for end in (a, b)]
    cut = []
    for end, other, depth, other_depth in ((a, b, *depths), (b, a, *depths[::-1])):
        share = np.where(depth < 0.0, -depth / np.where(other_depth > depth, other_depth - depth, 1.0), 0.0)
        cut.append(end + np.minimum(share, 1.0)[:, None] * (other - end))
    return cut[0], cut[1]


def _box_edges() -> Array:
    """Return the edges of the unit box, shape (12, 2, 3)."""
    corners = [(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)]
    pairs = [(i, i | bit) for i in range(8) for bit in (1, 2, 4) if not i & bit]
    return np.array([(corners[i], corners[j]) for i, j in pairs])
