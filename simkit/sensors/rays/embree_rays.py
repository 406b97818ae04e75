"""Rays on triangles with Embree, which finds the triangle in float32; the distance is then computed in float64.

Embree's time hardly grows with the number of triangles. Its scenes use the robust intersector, so that no ray passes
between two triangles that share an edge.
"""

from __future__ import annotations

import functools
import importlib
import math
from collections.abc import Iterator

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul
from simkit.pose import Vector
from simkit.sensors.rays.geom_types import BOX, HFIELD, MESH, Ids
from simkit.sensors.rays.numpy_rays import rotate_vectors
from simkit.sensors.rays.ray_culling import RayBundle, reaches_between_cones

Faces = npt.NDArray[np.int32]

_FLAT = 1e-2
"""Cosine between ray and normal below which rounding decides where a ray meets the plane of a triangle."""
_CUBE = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float64)
_CUBE_FACES = np.array(
    [
        (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
        (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
    ],
    dtype=np.int32,
)  # fmt: skip


@functools.cache
def has_embree() -> bool:
    """Check whether `embreex`, the binding of Intel's ray tracer, is installed and can be loaded."""
    try:
        importlib.import_module("embreex.rtcore_scene")
        importlib.import_module("embreex.mesh_construction")
    except (ImportError, OSError):
        return False
    return True


class TriangleScene:
    """Triangles in one frame, prepared for tracing.

    Args:
        vertices: positions [m], shape (n, 3).
        faces: vertex indices, shape (m, 3).
    """

    def __init__(self, vertices: Vector, faces: Faces) -> None:
        # an optional dependency, because not every machine has a wheel
        from embreex.mesh_construction import TriangleMesh  # type: ignore[import-untyped]
        from embreex.rtcore_scene import EmbreeScene  # type: ignore[import-untyped]

        low, high = vertices.min(axis=0), vertices.max(axis=0)
        self.centre: Vector = (low + high) / 2  # float32 is most precise around zero
        self.vertices = vertices - self.centre
        self.radius = float(np.sqrt(np.einsum("ij,ij->i", self.vertices, self.vertices).max()))
        self.faces = faces
        a, b, c = (self.vertices[faces[:, i]] for i in range(3))
        normals = np.cross(b - a, c - a)
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        np.divide(normals, length, out=normals, where=length > 0)
        offset = np.einsum("ij,ij->i", normals, a)
        self._planes = np.ascontiguousarray(np.column_stack((normals, offset)))
        self._scene = EmbreeScene(robust=True)
        TriangleMesh(self._scene, self.vertices.astype(np.float32), np.ascontiguousarray(faces, dtype=np.int32))

    def nearest(
        self, origin: Vector, directions: Vector, start: float, limit: npt.NDArray[np.float32]
    ) -> tuple[Ids, Vector, npt.NDArray[np.int32]]:
        """Find the first triangle on each ray.

        Args:
            origin: common origin of the rays [m], shape (3,), or the origin of each, shape (n, 3).
            directions: unit vectors, shape (n, 3).
            start: distance from the origin at which the rays start [m].
            limit: distance beyond which hits may be omitted [m], shape (n,).

        Returns:
            Indices of the rays that hit, their distances from the origin [m], and the triangles.
        """
        local_origin = origin - self.centre
        rays = directions.astype(np.float32)
        if start > 0:
            starts = rays * np.float32(start)
            starts += local_origin.astype(np.float32)
        else:
            starts = np.broadcast_to(local_origin.astype(np.float32), rays.shape)
        # a slightly larger limit, because rounding to float32 may move a surface just beyond the limit
        reach = (limit - np.float32(start)) * np.float32(1.000001)
        reach += np.float32(1e-5)
        first_triangles = self._scene.run(starts, rays, dists=reach)
        hits = np.flatnonzero(first_triangles >= 0)
        triangles = first_triangles[hits]
        planes = self._planes.take(triangles, 0)
        hit_directions = directions.take(hits, 0)
        normals = planes[:, :3]
        slope = np.einsum("ij,ij->i", normals, hit_directions)
        if local_origin.ndim == 1:
            height = planes[:, 3] - np.einsum("ij,j->i", normals, local_origin)
        else:
            local_origin = local_origin.take(hits, 0)
            height = planes[:, 3] - np.einsum("ij,ij->i", normals, local_origin)
        with np.errstate(divide="ignore", invalid="ignore"):
            distances = height / slope
        flat = np.flatnonzero(np.abs(slope) < _FLAT)
        if len(flat):
            at = local_origin if local_origin.ndim == 1 else local_origin[flat, None]
            distances[flat] = self._clamp_grazing(distances[flat], at, hit_directions[flat], triangles[flat])
        np.maximum(distances, start, out=distances)
        return hits, distances, triangles

    def normals_of(self, triangles: npt.NDArray[np.int32]) -> Vector:
        """Return the unit normals of triangles, shape (k, 3)."""
        normals: Vector = self._planes.take(triangles, 0)[:, :3]
        return normals

    def _clamp_grazing(
        self, distances: Vector, origin: Vector, directions: Vector, triangles: npt.NDArray[np.int32]
    ) -> Vector:
        """Clamp the distance of each ray almost parallel to its triangle to the distances of the triangle's corners."""
        corners = self.vertices[self.faces[triangles]] - origin
        along = np.einsum("ijk,ik->ij", corners, directions)
        low, high = along.min(axis=1), along.max(axis=1)
        clamped: Vector = np.clip(np.where(np.isfinite(distances), distances, low), low, high)
        return clamped


class TriangleBody:
    """Triangles of one carrier, in the frame of its body.

    Attributes:
        centre, radius: bounding sphere in the body's frame [m].
        geoms: geoms that the triangles belong to.

    Args:
        model: compiled model.
        carrier: number of the carrier; see `RayTargets`.
        body: MuJoCo body; 0 for static geoms.
        geoms: meshes, heightmaps and boxes.
        scenes: triangle scenes by geometry, shared with other carriers that have the same triangles at the same pose.
    """

    def __init__(
        self, model: mujoco.MjModel, carrier: int, body: int, geoms: Ids, scenes: dict[object, TriangleScene]
    ) -> None:
        self.carrier, self.body, self.geoms = carrier, body, geoms
        parts = [triangles_of(model, int(geom)) for geom in geoms]
        self._geom_of = np.repeat(geoms, [len(faces) for _, faces in parts]).astype(np.int32)
        key = tuple(_geometry_key(model, int(geom)) for geom in geoms)
        if key not in scenes:
            starts = np.cumsum([0] + [len(vertices) for vertices, _ in parts[:-1]])
            vertices = np.concatenate([vertices for vertices, _ in parts])
            faces = np.concatenate([faces + start for (_, faces), start in zip(parts, starts, strict=True)])
            scenes[key] = TriangleScene(vertices, faces)
        self._scene = scenes[key]
        self.centre, self.radius = self._scene.centre, self._scene.radius

    def cast(
        self, data: mujoco.MjData, origin: Vector, directions: Vector, start: float, limit: npt.NDArray[np.float32]
    ) -> tuple[Ids, Vector, npt.NDArray[np.int32]]:
        """Cast rays given in the world frame.

        Args:
            data: physics data with up-to-date poses.
            origin: origin of the rays [m], shape (3,).
            directions: unit vectors, shape (n, 3).
            start: distance from the origin at which the rays start [m].
            limit: distance beyond which hits may be omitted [m], shape (n,).

        Returns:
            Indices of the rays that hit, their distances [m], and the geoms.
        """
        if self.body > 0:
            turn = data.xmat[self.body].reshape(3, 3)
            origin, directions = matmul(origin - data.xpos[self.body], turn), rotate_vectors(directions, turn)
        return self.cast_local(origin, directions, start, limit)

    def cast_local(
        self, origin: Vector, directions: Vector, start: float, limit: npt.NDArray[np.float32]
    ) -> tuple[Ids, Vector, npt.NDArray[np.int32]]:
        """Cast rays given in the body's frame, each from its own origin, shape (n, 3), or all from one."""
        hits, distances, triangles = self._scene.nearest(origin, directions, start, limit)
        return hits, distances, self._geom_of.take(triangles)

    def hit_normals(
        self, origins: Vector, directions: Vector, start: float, limit: npt.NDArray[np.float32]
    ) -> tuple[Ids, Vector]:
        """Return the rays that hit and the normals of their triangles; all in the body's frame, one origin per ray."""
        hits, _, triangles = self._scene.nearest(origins, directions, start, limit)
        return hits, self._scene.normals_of(triangles)


class MovingBodies:
    """Bodies with triangles, except static bodies without a sensor."""

    def __init__(self, bodies: list[TriangleBody]) -> None:
        self._bodies = bodies
        self._ids = np.array([body.body for body in bodies], dtype=np.intp)
        self._centres = np.array([body.centre for body in bodies]).reshape(-1, 3)
        self._radii = np.array([body.radius for body in bodies])

    def __len__(self) -> int:
        return len(self._bodies)

    def reached(self, data: mujoco.MjData, rays: RayBundle) -> Iterator[tuple[TriangleBody, Ids]]:
        """Yield each body that rays may hit, with the indices of those rays."""
        if not self._bodies:
            return
        turns = data.xmat.take(self._ids, 0).reshape(-1, 3, 3)
        centres = data.xpos.take(self._ids, 0) + np.einsum("bij,bj->bi", turns, self._centres) - rays.origin
        squares = np.einsum("ij,ij->i", centres, centres)
        height = matmul(centres, rays.axis)
        side = np.sqrt(np.maximum(squares - height * height, 0.0))
        is_reached = reaches_between_cones(height, side, self._radii, rays.lowest, rays.highest)
        distance = np.sqrt(squares)
        is_reached &= distance - self._radii <= rays.reach
        for i in np.flatnonzero(is_reached).tolist():
            far, radius = float(distance[i]), float(self._radii[i])
            if far <= radius * (1 + 1e-9):
                yield self._bodies[i], np.arange(len(rays.directions))
                continue
            # the cosine between ray and centre is at least that of the sphere's edge; a margin of 1e-6 loses no ray
            least = math.sqrt(max(0.0, 1.0 - (radius / far) ** 2)) * far - 1e-6 * far
            near_rays = np.flatnonzero(rotate_vectors(rays.directions, centres[i]) >= least)
            if near_rays.size:
                yield self._bodies[i], near_rays


def _geometry_key(model: mujoco.MjModel, geom: int) -> tuple[object, ...]:
    """Return the properties of a geom that determine its triangles."""
    kind, data = int(model.geom_type[geom]), int(model.geom_dataid[geom])
    size = model.geom_size[geom].tobytes() if kind == BOX else b""
    return kind, data, size, model.geom_pos[geom].tobytes(), model.geom_quat[geom].tobytes()


def triangles_of(model: mujoco.MjModel, geom: int) -> tuple[Vector, Faces]:
    """Return the vertices [m], shape (n, 3), and faces, shape (m, 3), of a geom in its body's frame."""
    kind = int(model.geom_type[geom])
    if kind == MESH:
        vertices, faces = mesh_triangles(model, int(model.geom_dataid[geom]))
    elif kind == BOX:
        vertices, faces = _CUBE * model.geom_size[geom], _CUBE_FACES
    else:
        assert kind == HFIELD
        vertices, faces = _heightmap_triangles(model, int(model.geom_dataid[geom]))
    turn = np.empty(9)
    mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
    return matmul(vertices, turn.reshape(3, 3).T) + model.geom_pos[geom], np.asarray(faces, dtype=np.int32)


def mesh_triangles(model: mujoco.MjModel, mesh: int) -> tuple[Vector, Faces]:
    """Return the vertices [m], shape (n, 3), and faces, shape (m, 3), of a mesh of the compiled model."""
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    start, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    return model.mesh_vert[first : first + count].astype(np.float64), np.asarray(model.mesh_face[start : start + faces])


def heightmap_grid(model: mujoco.MjModel, field: int) -> Vector:
    """Return the points of a heightmap's surface [m], shape (rows, columns, 3)."""
    rows, columns, first = (int(a[field]) for a in (model.hfield_nrow, model.hfield_ncol, model.hfield_adr))
    half_x, half_y, height, _ = model.hfield_size[field].tolist()
    z = model.hfield_data[first : first + rows * columns].astype(np.float64).reshape(rows, columns) * height
    x, y = np.meshgrid(np.linspace(-half_x, half_x, columns), np.linspace(-half_y, half_y, rows))
    return np.stack((x, y, z), axis=-1)


def _heightmap_triangles(model: mujoco.MjModel, field: int) -> tuple[Vector, Faces]:
    """Return the surface, with each cell split from its first to its last corner, the skirt around it and the base."""
    points = heightmap_grid(model, field)
    (rows, columns, _), surface = points.shape, points.reshape(-1, 3)
    half_x, half_y, _, depth = model.hfield_size[field].tolist()
    cell = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    right, above, across = cell + 1, cell + columns, cell + columns + 1
    tops = np.concatenate((np.column_stack((cell, right, across)), np.column_stack((cell, across, above))))
    # skirt around the edge, from the surface down to zero
    grid = np.arange(rows * columns).reshape(rows, columns)
    rim = np.concatenate((grid[0, :-1], grid[:-1, -1], grid[-1, :0:-1], grid[:0:-1, 0]))
    foot = surface[rim] * (1.0, 1.0, 0.0)
    low = np.arange(len(rim)) + rows * columns
    after, low_after = np.roll(rim, -1), np.roll(low, -1)
    skirt = np.concatenate((np.column_stack((rim, low, low_after)), np.column_stack((rim, low_after, after))))
    base = _CUBE * (half_x, half_y, depth / 2) - (0, 0, depth / 2)
    vertices = np.concatenate((surface, foot, base))
    return vertices, np.concatenate((tops, skirt, _CUBE_FACES + len(surface) + len(foot))).astype(np.int32)
