"""Triangles of a model's meshes, height fields, flexes and skins, with the normals that MuJoCo's renderer uses."""

from __future__ import annotations

import mujoco
import numpy as np

from simkit.sensors.cameras.rendering.software.shape_meshes import ShapeMesh, cylinder, face_normals
from simkit.sensors.cameras.rendering.software.vectors import Array, cross, dot, unit

_TUBE_SIDES = 24  # number of sides of the edges of a flex
_SHARP = 0.8
"""Cosine between the normals of a corner and its face below which the engine draws the corner with the face's normal
(`mjr_uploadMesh` in render_context.c); a mesh with texture coordinates keeps the normals of its corners."""


def mesh_of(model: mujoco.MjModel, number: int) -> ShapeMesh:
    """Return a mesh of the model; `number` is the index in MuJoCo's list of shapes, odd for a convex hull."""
    mesh = number // 2
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    corners = np.asarray(model.mesh_vert[first : first + count], np.float32)
    if number % 2:
        return _flat_mesh(corners, _hull_faces(model, mesh))
    rows = slice(int(model.mesh_faceadr[mesh]), int(model.mesh_faceadr[mesh]) + int(model.mesh_facenum[mesh]))
    faces = np.asarray(model.mesh_face[rows]).reshape(-1, 3)
    numbers = np.asarray(model.mesh_facenormal[rows]).reshape(-1, 3)
    normals = np.asarray(model.mesh_normal[int(model.mesh_normaladr[mesh]) :], np.float32)
    start = int(model.mesh_texcoordadr[mesh])
    if start >= 0:
        coordinates = np.asarray(model.mesh_texcoord[start:], np.float32)
        points = np.asarray(model.mesh_facetexcoord[rows]).reshape(-1, 3)
        keys = (faces.astype(np.int64) * (int(numbers.max(initial=0)) + 1) + numbers) * (
            int(points.max(initial=0)) + 1
        ) + points
        _, first_use, inverse = np.unique(keys.ravel(), return_index=True, return_inverse=True)
        return ShapeMesh.of(
            corners[faces.ravel()[first_use]],
            normals[numbers.ravel()[first_use]],
            inverse.reshape(-1, 3),
            coordinates=coordinates[points.ravel()[first_use]],
        )
    flat = face_normals(corners.astype(np.float64), faces)
    is_flat = dot(normals[numbers], flat[:, None, :]) < _SHARP
    # a smooth corner is shared by its faces, a sharp one belongs to one face
    many = int(numbers.max(initial=0)) + 1 + len(faces)
    which = np.where(is_flat, int(numbers.max(initial=0)) + 1 + np.arange(len(faces))[:, None], numbers)
    _, first_use, inverse = np.unique(
        (faces.astype(np.int64) * many + which).ravel(), return_index=True, return_inverse=True
    )
    flat_use = is_flat.ravel()[first_use]
    chosen = np.where(flat_use[:, None], flat[first_use // 3], normals[numbers.ravel()[first_use]])
    return ShapeMesh.of(corners[faces.ravel()[first_use]], chosen, inverse.reshape(-1, 3))


def _hull_faces(model: mujoco.MjModel, mesh: int) -> Array:
    """Return the faces of a mesh's convex hull; none if the model has none."""
    start = int(model.mesh_graphadr[mesh])
    if start < 0:
        return np.zeros((0, 3), np.int32)
    corners, faces = int(model.mesh_graph[start]), int(model.mesh_graph[start + 1])
    first = start + 2 + 3 * corners + 3 * faces
    return np.asarray(model.mesh_graph[first : first + 3 * faces]).reshape(-1, 3)


def _flat_mesh(corners: Array, faces: Array) -> ShapeMesh:
    """Return a mesh whose faces share no corner, so that each has its own normal."""
    normals = np.repeat(face_normals(corners.astype(np.float64), faces), 3, axis=0)
    return ShapeMesh.of(corners[faces.ravel()], normals, np.arange(3 * len(faces)).reshape(-1, 3))


def heights_of(model: mujoco.MjModel, field: int) -> ShapeMesh:
    """Return a height field with its sides and its bottom (`mjr_uploadHField` in render_context.c)."""
    rows, columns = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
    x, y, up, depth = np.asarray(model.hfield_size[field], np.float64)
    first = int(model.hfield_adr[field])
    heights = np.asarray(model.hfield_data[first : first + rows * columns], np.float64).reshape(rows, columns) * up
    left = np.linspace(-x, x, columns)
    ahead = np.linspace(-y, y, rows)
    top = np.stack((*np.broadcast_arrays(left[None, :], ahead[:, None]), heights), axis=-1)
    edge = [top[0], top[:, -1], top[-1, ::-1], top[::-1, 0]]
    parts = [_strips(top)]
    for line in edge:  # walls, counter-clockwise seen from above
        foot = line * (1.0, 1.0, 0.0) - (0.0, 0.0, depth)
        parts.append(_strips(np.stack((foot, line))))
    under = np.array(((-x, -y, -depth), (-x, y, -depth), (x, y, -depth), (x, -y, -depth)))
    parts.append(under[[0, 1, 2, 0, 2, 3]].reshape(-1, 3, 3))
    corners = np.concatenate(parts).reshape(-1, 3)
    return _flat_mesh(corners, np.arange(len(corners)).reshape(-1, 3))


def _strips(grid: Array) -> Array:
    """Return the triangles of a grid of points (rows, columns, 3), shape (n, 3, 3); the engine's diagonals."""
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    return np.concatenate(
        (np.stack((d, a, c), axis=2).reshape(-1, 3, 3), np.stack((a, b, c), axis=2).reshape(-1, 3, 3))
    )


def flex_of(scene: mujoco.MjvScene, flex: int, radius: float) -> ShapeMesh:
    """Return the faces of a flex in world coordinates, as MuJoCo composed them; a flex without faces has tubes."""
    used = int(scene.flexfaceused[flex])
    if not used:
        return _tubes(scene, flex, radius)
    first = 3 * int(scene.flexfaceadr[flex])
    rows = slice(first, first + 3 * used)
    corners = np.asarray(scene.flexface).reshape(-1, 3)[rows]
    normals = np.asarray(scene.flexnormal).reshape(-1, 3)[rows]
    coordinates = np.asarray(scene.flextexcoord).reshape(-1, 2)[rows] if len(np.ravel(scene.flextexcoord)) else None
    return ShapeMesh.of(corners, normals, np.arange(3 * used).reshape(-1, 3), coordinates=coordinates)


def _tubes(scene: mujoco.MjvScene, flex: int, radius: float) -> ShapeMesh:
    """Return the edges of a flex as tubes, which MuJoCo draws for cables."""
    first, count = int(scene.flexedgeadr[flex]), int(scene.flexedgenum[flex])
    pairs = np.asarray(scene.flexedge).reshape(-1, 2)[first : first + count]
    points = np.asarray(scene.flexvert, np.float64).reshape(-1, 3)[int(scene.flexvertadr[flex]) :]
    begin, end = points[pairs[:, 0]], points[pairs[:, 1]]
    along = unit(end - begin)
    across = np.where(np.abs(along[:, 2:]) < 0.9, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    right = unit(cross(along, across))
    up = cross(along, right)
    tube = cylinder(_TUBE_SIDES, 1, is_open=True)
    x, y, z = (tube.corners[:, k, None] for k in range(3))
    normals = x * right[:, None] + y * up[:, None]
    middle, half = (begin + end) / 2.0, (end - begin) / 2.0
    corners = middle[:, None] + radius * normals + z * half[:, None]
    faces = tube.faces + (np.arange(count) * len(tube.corners))[:, None, None]
    return ShapeMesh.of(corners.reshape(-1, 3), normals.reshape(-1, 3), faces.reshape(-1, 3))


def skin_of(model: mujoco.MjModel, scene: mujoco.MjvScene, skin: int) -> ShapeMesh:
    """Return the faces of a skin in world coordinates, as MuJoCo composed them."""
    first, count = int(scene.skinvertadr[skin]), int(scene.skinvertnum[skin])
    corners = np.asarray(scene.skinvert).reshape(-1, 3)[first : first + count]
    normals = np.asarray(scene.skinnormal).reshape(-1, 3)[first : first + count]
    start, faces = int(model.skin_faceadr[skin]), int(model.skin_facenum[skin])
    coordinates = None
    if model.skin_texcoordadr[skin] >= 0:
        begin = int(model.skin_texcoordadr[skin])
        coordinates = np.asarray(model.skin_texcoord[begin : begin + count])
    return ShapeMesh.of(
        corners, normals, np.asarray(model.skin_face[start : start + faces]).reshape(-1, 3), coordinates=coordinates
    )
