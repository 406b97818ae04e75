"""Rays on triangles with Embree, which finds the triangle in float32; the distance is then computed in float64.

Embree's time hardly grows with the number of triangles. Its scenes use the robust intersector, so that no ray passes
between two triangles that share an edge.
"""

from __future__ import annotations

import functools
import importlib
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul
from simkit.pose import Vector
from simkit.sensors.rays.geom_types import BOX, HFIELD, MESH, Ids
from simkit.sensors.rays.numpy_rays import rotate_columns
from simkit.sensors.rays.ray_culling import RayBundle, reaches_between_cones

Faces = npt.NDArray[np.int32]

_FLAT = 1e-2
"""Cosine between ray and normal below which rounding decides where a ray meets the plane of a triangle."""
_MANY = 1000
"""Rays towards one body from which rotating them alone is faster than with a matrix for each ray."""
_MOST_PAIRS = 1 << 18  # pairs of a body and a ray that are computed together
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

    Attributes:
        planes: unit normal of each triangle, and its product with the triangle's points [m], shape (1 + m, 4). The
            first row is NaN, for rays without a triangle.
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
        self.planes = np.full((1 + len(faces), 4), np.nan)
        self.planes[1:, :3], self.planes[1:, 3] = normals, offset
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
        distances, rows = self.trace(origin.T, directions.T, start, limit)
        hits = np.flatnonzero(rows)
        return hits, distances.take(hits), (rows.take(hits) - 1).astype(np.int32)

    def trace(
        self, origin: Vector, directions: Vector, start: float, limit: npt.NDArray[np.float32] | float
    ) -> tuple[Vector, Ids]:
        """Find the first triangle on each ray, with vectors as columns.

        Args:
            origin: common origin of the rays [m], shape (3,), or the origin of each, shape (3, n).
            directions: unit vectors, shape (3, n).
            start: distance from the origin at which the rays start [m].
            limit: distance beyond which hits may be omitted [m], shape (n,), or one for all rays.

        Returns:
            Distances from the origin [m], NaN for no hit, and rows of `planes`, 0 for no hit; each of the shape (n,).
        """
        local_origin = origin - (self.centre if origin.ndim == 1 else self.centre[:, None])
        rays, starts = single_precision(local_origin, directions, start)
        rows = np.add(self.first(starts, rays, reach_of(limit, start)), 1, dtype=np.intp)
        distances, flat = distances_to_planes(self.planes.take(rows, 0).T, local_origin, directions)
        if len(flat):
            own_origin = local_origin if origin.ndim == 1 else local_origin[:, flat].T
            self.clamp_grazing(distances, flat, own_origin, directions[:, flat].T, rows[flat] - 1)
        np.maximum(distances, start, out=distances)
        return distances, rows

    def first(
        self,
        starts: npt.NDArray[np.float32],
        rays: npt.NDArray[np.float32],
        reach: npt.NDArray[np.float32] | float,
    ) -> npt.NDArray[np.int32]:
        """Return the first triangle on each ray, -1 for none, with Embree.

        Args:
            starts: points around `centre` at which the rays start [m], shape (3, n).
            rays: directions, shape (3, n).
            reach: lengths of the rays [m], shape (n,), or one for all.
        """
        triangles: npt.NDArray[np.int32] = self._scene.run(starts.T, rays.T, dists=reach)
        return triangles

    def normals_of(self, triangles: npt.NDArray[np.int32]) -> Vector:
        """Return the unit normals of triangles, shape (k, 3)."""
        normals: Vector = self.planes.take(triangles + 1, 0)[:, :3]
        return normals

    def clamp_grazing(
        self, distances: Vector, flat: Ids, origin: Vector, directions: Vector, triangles: npt.NDArray[np.integer[Any]]
    ) -> None:
        """Clamp the distances of rays almost parallel to their triangles to the distances of the triangles' corners.

        Args:
            distances: distances of all rays [m], shape (n,).
            flat: numbers of these rays, shape (k,).
            origin: their common origin [m], shape (3,), or their origins, shape (k, 3).
            directions: their directions, shape (k, 3).
            triangles: their triangles, shape (k,).
        """
        corners = self.vertices[self.faces[triangles]] - (origin if origin.ndim == 1 else origin[:, None])
        along = np.einsum("ijk,ik->ij", corners, directions)
        low, high = along.min(axis=1), along.max(axis=1)
        found = distances[flat]
        distances[flat] = np.clip(np.where(np.isfinite(found), found, low), low, high)


def single_precision(
    origin: Vector, directions: Vector, start: float
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """Return directions of rays and the points at which they start in float32, shapes (3, n).

    Args:
        origin: common origin of the rays, shape (3,), or the origin of each, shape (3, n) [m].
        directions: unit vectors, shape (3, n).
        start: distance from the origin at which the rays start [m].
    """
    rays, origins = directions.astype(np.float32), origin.astype(np.float32)
    if origins.ndim == 1:
        origins = origins[:, None]
    if start > 0:
        starts = rays * np.float32(start)
        starts += origins
        return rays, starts
    return rays, np.broadcast_to(origins, rays.shape)


def reach_of(limit: npt.NDArray[np.float32] | float, start: float) -> npt.NDArray[np.float32] | float:
    """Return the lengths of rays that start at a distance [m] and end beyond the limits of their hits [m].

    They are slightly longer, because rounding to float32 may move a surface just beyond the limit.
    """
    if isinstance(limit, float):
        return float((np.float32(limit) - np.float32(start)) * np.float32(1.000001) + np.float32(1e-5))
    reach = (limit - np.float32(start)) * np.float32(1.000001)
    reach += np.float32(1e-5)
    return reach


def distances_to_planes(planes: Vector, origin: Vector, directions: Vector) -> tuple[Vector, Ids]:
    """Return the distances of planes along rays [m], and the numbers of the rays almost parallel to their planes.

    Args:
        planes: normals and offsets, shape (4, n).
        origin: common origin of the rays [m], shape (3,), or the origin of each, shape (3, n).
        directions: unit vectors, shape (3, n).
    """
    slope, distances = _dot(planes, directions), _dot(planes, origin)
    np.subtract(planes[3], distances, out=distances)
    with np.errstate(divide="ignore", invalid="ignore"):
        distances /= slope
    return distances, np.flatnonzero(np.abs(slope, out=slope) < _FLAT)


def _dot(first: Vector, second: Vector) -> Vector:
    """Return the products of columns; the components are added in the order of einsum for rows of three."""
    product: Vector = first[0] * second[0]
    product += first[2] * second[2]
    product += first[1] * second[1]
    return product


class TriangleBody:
    """Triangles of one carrier, in the frame of its body.

    Attributes:
        centre, radius: bounding sphere in the body's frame [m].
        geoms: geoms that the triangles belong to.
        geom_of: geom of each triangle, shape (1 + m,); the first entry is -1, for rays without a triangle.
        scene: the triangles.

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
        self.geom_of = np.repeat(np.append(-1, geoms), [1, *(len(faces) for _, faces in parts)]).astype(np.int32)
        key = tuple(_geometry_key(model, int(geom)) for geom in geoms)
        if key not in scenes:
            starts = np.cumsum([0] + [len(vertices) for vertices, _ in parts[:-1]])
            vertices = np.concatenate([vertices for vertices, _ in parts])
            faces = np.concatenate([faces + start for (_, faces), start in zip(parts, starts, strict=True)])
            scenes[key] = TriangleScene(vertices, faces)
        self.scene = scenes[key]
        self.centre, self.radius = self.scene.centre, self.scene.radius

    def cast(
        self, origin: Vector, directions: Vector, start: float, limit: npt.NDArray[np.float32] | float
    ) -> tuple[Vector, npt.NDArray[np.int32]]:
        """Cast rays given in the body's frame.

        Args:
            origin: common origin of the rays [m], shape (3,), or the origin of each, shape (3, n).
            directions: unit vectors, shape (3, n).
            start: distance from the origin at which the rays start [m].
            limit: distance beyond which hits may be omitted [m], shape (n,), or one for all rays.

        Returns:
            Distances [m], NaN for no hit, and geoms, -1 for no hit; each of the shape (n,).
        """
        distances, rows = self.scene.trace(origin, directions, start, limit)
        return distances, self.geom_of.take(rows)

    def hit_normals(
        self, origins: Vector, directions: Vector, start: float, limit: npt.NDArray[np.float32]
    ) -> tuple[Ids, Vector]:
        """Return the rays that hit and the normals of their triangles; all in the body's frame, one origin per ray."""
        hits, _, triangles = self.scene.nearest(origins, directions, start, limit)
        return hits, self.scene.normals_of(triangles)


class MovingBodies:
    """Bodies with triangles, except static bodies without a sensor, which are cast together.

    Embree traces each body with the rays that may hit it. Everything else is computed for all these rays at once.
    """

    def __init__(self, bodies: list[TriangleBody]) -> None:
        self._bodies = bodies
        self._ids = np.array([body.body for body in bodies], dtype=np.intp)
        self._centres = np.array([body.centre for body in bodies]).reshape(-1, 3)
        self._radii = np.array([body.radius for body in bodies])
        scenes = {id(body.scene): body.scene for body in bodies}
        rows = np.cumsum([0, *(len(scene.planes) for scene in scenes.values())]).tolist()
        self._planes = np.concatenate([scene.planes for scene in scenes.values()]) if scenes else np.empty((0, 4))
        first_rows = dict(zip(scenes, rows, strict=False))
        # row of each body's first plane, and of its first entry in `_geom_of`
        self._first_planes = np.array([first_rows[id(body.scene)] for body in bodies], dtype=np.intp)
        self._first_geoms = np.cumsum([0, *(len(body.geom_of) for body in bodies)])[:-1]
        self._geom_of = np.concatenate([body.geom_of for body in bodies]) if bodies else np.empty(0, np.int32)

    def __len__(self) -> int:
        return len(self._bodies)

    def numbers_of(self, bodies: MovingBodies) -> Ids:
        """Return the numbers here of the bodies of a part of these bodies."""
        number = {id(body): i for i, body in enumerate(self._bodies)}
        return np.array([number[id(body)] for body in bodies._bodies], dtype=np.intp)

    def cast(self, data: mujoco.MjData, rays: RayBundle, best: Vector, hits: npt.NDArray[np.int32]) -> None:
        """Shorten distances and set hits where a body is hit first.

        Args:
            data: physics data with up-to-date poses.
            rays: rays to cast.
            best: shortest distances so far [m], shape (n,).
            hits: geoms at those distances, shape (n,).
        """
        if self._bodies:
            self.cast_fans(data, [(rays, np.arange(len(self._bodies)))], rays.columns, best, hits)

    def cast_fans(
        self,
        data: mujoco.MjData,
        fans: Sequence[tuple[RayBundle, Ids]],
        columns: Vector,
        best: Vector,
        hits: npt.NDArray[np.int32],
    ) -> None:
        """Shorten distances of the rays of k fans, and set hits; Embree traces a body with the rays of all fans.

        Args:
            data: physics data with up-to-date poses.
            fans: rays of each fan, all of one number, and the bodies that they can hit, ascending.
            columns: rays of all fans, one fan after the other, shape (3, k · n).
            best: shortest distances so far [m], shape (k · n,).
            hits: geoms at those distances, shape (k · n,).
        """
        turns = data.xmat.take(self._ids, 0).reshape(-1, 3, 3)
        positions = data.xpos.take(self._ids, 0)
        places, length, start = positions + np.einsum("bij,bj->bi", turns, self._centres), len(best) // len(fans), 0.0
        limits = np.repeat([rays.reach for rays, _ in fans], length) if len(fans) > 1 else fans[0][0].reach
        origins = np.array([rays.origin for rays, _ in fans])
        parts: list[tuple[Ids, Ids, Ids]] = []
        for number, (rays, bodies) in enumerate(fans):
            centres, radii, start = places.take(bodies, 0) - rays.origin, self._radii.take(bodies), rays.start
            near = _reached(centres, radii, rays)
            for spheres, which in rays.pairs(centres.take(near, 0), radii.take(near)):
                if which.size:
                    owners = np.broadcast_to(bodies.take(near.take(spheres)), which.shape)
                    parts.append((owners, which + number * length, np.full(len(which), number)))
                if sum(len(part[0]) for part in parts) > _MOST_PAIRS:
                    self._cast_pairs(parts, (positions, turns, origins), columns, start, limits, best, hits)
                    parts.clear()
        if parts:
            self._cast_pairs(parts, (positions, turns, origins), columns, start, limits, best, hits)

    def _cast_pairs(
        self,
        parts: Sequence[tuple[Ids, Ids, Ids]],
        frames: tuple[Vector, Vector, Vector],
        columns: Vector,
        start: float,
        limits: Vector | float,
        best: Vector,
        hits: npt.NDArray[np.int32],
    ) -> None:
        """Cast rays on the body of each of them.

        Args:
            parts: bodies, numbers of the rays, and their fans; each of the shape (m,) and not empty.
            frames: positions of all bodies [m] and their rotation matrices, and the origins of all fans [m].
            columns: all rays, shape (3, n).
            start: distance from the origin at which the rays start [m].
            limits: longest distances of the rays [m], shape (n,), or one for all.
            best: shortest distances so far [m], shape (n,).
            hits: geoms at those distances, shape (n,).
        """
        owners, which, fans = (np.concatenate(column) for column in zip(*parts, strict=True))
        if fans[0] != fans[-1]:
            order = np.argsort(owners, kind="stable")
            owners, which, fans = owners.take(order), which.take(order), fans.take(order)
        positions, turns, fan_origins = frames
        ends = np.append(np.flatnonzero((owners[1:] != owners[:-1]) | (fans[1:] != fans[:-1])) + 1, len(owners))
        firsts = np.append(0, ends[:-1])
        bodies = owners.take(firsts)
        offsets = fan_origins.take(fans.take(firsts), 0) - positions.take(bodies, 0)
        own_origins = np.einsum("bj,bji->bi", offsets, turns.take(bodies, 0)) - self._centres.take(bodies, 0)
        origins = np.repeat(own_origins.T, ends - firsts, axis=1)
        changes = [0, *(np.flatnonzero(owners[1:] != owners[:-1]) + 1).tolist(), len(owners)]
        pieces = [(int(owners[first]), slice(first, last)) for first, last in pairwise(changes)]
        directions, local = columns.take(which, 1), np.empty((3, len(which)))
        if len(which) < _MANY * len(pieces):
            np.einsum("in,nij->jn", directions, turns.take(owners, 0), out=local)
        else:
            for i, piece in pieces:
                rotate_columns(turns[i].T, directions[:, piece], local[:, piece])
        single, starts = single_precision(origins, local, start)
        limit = limits if isinstance(limits, float) else limits.take(which)
        reach: Any = reach_of(np.minimum(best.take(which), limit, dtype=np.float32), start)
        rows = np.empty(len(which), np.intp)
        for i, piece in pieces:
            rows[piece] = self._bodies[i].scene.first(starts[:, piece], single[:, piece], reach[piece])
        rows += 1
        planes = self._planes.take(rows + self._first_planes.take(owners), 0).T
        distances, flat = distances_to_planes(planes, origins, local)
        for i in sorted(set(owners[flat].tolist())):
            own = flat[owners[flat] == i]
            self._bodies[i].scene.clamp_grazing(distances, own, origins[:, own].T, local[:, own].T, rows[own] - 1)
        np.maximum(distances, start, out=distances)
        nearer = np.flatnonzero(distances < best.take(which))[::-1]  # of equal distances, the first body counts
        which, distances, owners = which.take(nearer), distances.take(nearer), owners.take(nearer)
        np.minimum.at(best, which, distances)
        geoms = self._geom_of.take(rows.take(nearer) + self._first_geoms.take(owners))
        is_first = best.take(which) == distances
        hits[which[is_first]] = geoms[is_first]


def _reached(centres: Vector, radii: Vector, rays: RayBundle) -> Ids:
    """Return the spheres that rays may hit, for their centres from the origin of the rays [m] and radii [m]."""
    if not len(centres):
        return np.empty(0, np.intp)
    squares = np.einsum("ij,ij->i", centres, centres)
    height = matmul(centres, rays.axis)
    side = np.sqrt(np.maximum(squares - height * height, 0.0))
    is_reached = reaches_between_cones(height, side, radii, rays.lowest, rays.highest)
    is_reached &= np.sqrt(squares) - radii <= rays.reach
    return np.flatnonzero(is_reached)


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
