"""Rays on spheres, boxes, cylinders, capsules, ellipsoids and planes, many at once in NumPy.

Every shape here is convex, so a ray is inside the shape from one distance to another. Each function returns both
distances. If the ray misses, the first is larger than the second, or one of them is NaN. Vectors are in the shape's own
frame and are columns, shape (3, n), so that NumPy works on long rows. For a single shape, origin and size are one
column.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul
from simkit.pose import Vector
from simkit.sensors.rays.geom_types import BOX, CAPSULE, CYLINDER, ELLIPSOID, SPHERE, Ids

Interval = tuple[Vector, Vector]

_CHUNK = 32768  # pairs of ray and shape processed at a time, so that they stay in the processor's cache
_ROWS = 4096
_TESTS = 1 << 16  # pairs of ray and sphere that are tested together
_LARGE_BLOCK = 1500  # number of rays towards one shape from which the shape is processed alone
_TINY = 1e-300  # replacement for a zero divisor


def rotate_vectors(vectors: Vector, matrix: Vector, out: Vector | None = None) -> Vector:
    """Return `vectors @ matrix` (or a vector) on one core; with many rows at a time BLAS would use several threads."""
    if len(vectors) <= _ROWS:
        return np.matmul(vectors, matrix, out=out)
    if out is None:
        out = np.empty((len(vectors), *matrix.shape[1:]))
    for i in range(0, len(vectors), _ROWS):
        np.matmul(vectors[i : i + _ROWS], matrix, out=out[i : i + _ROWS])
    return out


def rotate_columns(matrix: Vector, columns: Vector, out: Vector | None = None) -> Vector:
    """Return `matrix @ columns` for vectors in contiguous rows, shape (3, n); the bits do not depend on n."""
    if columns.shape[1] > 1:
        return np.einsum("ij,jn->in", matrix, columns, out=out)
    # for a single column, einsum adds in another order
    rotated: Vector = matrix[:, :1] * columns[:1] + matrix[:, 1:2] * columns[1:2] + matrix[:, 2:] * columns[2:]
    if out is None:
        return rotated
    out[:] = rotated
    return out


def pairs_towards(directions: Vector, centres: Vector, radii: Vector) -> Iterator[tuple[Ids, Ids]]:
    """Yield pairs of a sphere and a ray that may hit it, some spheres at a time; no such pair is missing.

    Args:
        directions: unit vectors, shape (n, 3).
        centres: centres of the spheres from the origin of the rays [m], shape (m, 3).
        radii: radii of the spheres [m], shape (m,).

    Yields:
        Indices of spheres, ascending, and of rays.
    """
    far = np.sqrt(np.einsum("ij,ij->i", centres, centres))
    # the cosine between ray and centre is at least that of the sphere's edge; a margin of 1e-6 loses no ray
    share = radii / np.maximum(far, _TINY)
    least = np.sqrt(np.maximum(1.0 - share * share, 0.0)) * far - 1e-6 * far
    least[far <= radii * (1 + 1e-9) + 1e-9] = -np.inf
    some = max(1, _TESTS // max(1, len(directions)))
    for first in range(0, len(centres), some):
        part = slice(first, first + some)
        along = rotate_vectors(directions, centres[part].T).T
        spheres, rays = np.nonzero(along >= least[part, None])
        yield spheres + first, rays


def _quadratic(a: Vector, b: Vector, gap: Vector) -> Interval:
    """Return the roots of a·t² + 2·b·t + c; `gap` is the minimum of that polynomial, at t = -b/a."""
    middle = -b / a
    half = np.sqrt(-gap / a)
    return middle - half, middle + half


def _unit_ball(o: Vector, d: Vector, radii: Vector) -> Interval:
    o, d = o / radii, d / radii
    a = np.maximum(_dot(d, d), _TINY)
    b = _dot(o, d)
    nearest = o - (b / a) * d  # point nearest to the centre; c - b²/a would lose digits at large distances
    return _quadratic(a, b, _dot(nearest, nearest) - 1.0)


def _dot(a: Vector, b: Vector) -> Vector:
    x: Vector = a[0] * b[0]
    x += a[1] * b[1]
    x += a[2] * b[2]
    return x


def _sphere(o: Vector, d: Vector, size: Vector) -> Interval:
    return _unit_ball(o, d, size[:1])


def _box(o: Vector, d: Vector, size: Vector) -> Interval:
    inverse = 1.0 / np.where(d == 0.0, _TINY, d)
    half = np.abs(size * inverse)
    inverse *= -o
    return (inverse - half).max(axis=0), (inverse + half).min(axis=0)


def _infinite_cylinder(o: Vector, d: Vector, radius: Vector) -> Interval:
    """Return the distances at which rays enter and leave an infinite cylinder along z."""
    a = np.maximum(d[0] * d[0] + d[1] * d[1], _TINY)
    b = o[0] * d[0] + o[1] * d[1]
    distance = b / a
    x, y = o[0] - distance * d[0], o[1] - distance * d[1]
    return _quadratic(a, b, x * x + y * y - radius * radius)


def _slab(o: Vector, d: Vector, half: Vector) -> Interval:
    """Return the distances at which rays enter and leave the space between two planes perpendicular to z."""
    inverse = 1.0 / np.where(d[2] == 0.0, _TINY, d[2])
    wide, middle = np.abs(half * inverse), -o[2] * inverse
    return middle - wide, middle + wide


def _cylinder(o: Vector, d: Vector, size: Vector) -> Interval:
    (near, far), (low, high) = _infinite_cylinder(o, d, size[0]), _slab(o, d, size[1])
    # a miss of the infinite cylinder is NaN and stays NaN
    return np.maximum(near, low), np.minimum(far, high)


def _capsule(o: Vector, d: Vector, size: Vector) -> Interval:
    near, far = _cylinder(o, d, size)
    missed = ~(near <= far)
    near[missed], far[missed] = np.inf, -np.inf
    for side in (-1.0, 1.0):
        end = np.stack((o[0], o[1], o[2] + side * size[1]))
        low, high = _unit_ball(end, d, size[:1])
        near, far = np.fmin(near, low), np.fmax(far, high)
    return near, far


INTERVALS: dict[int, Callable[[Vector, Vector, Vector], Interval]] = {
    SPHERE: _sphere,
    ELLIPSOID: _unit_ball,
    BOX: _box,
    CYLINDER: _cylinder,
    CAPSULE: _capsule,
}
"""Function of each geom type that returns the distances at which rays enter and leave the shape."""


class FanDirections:
    """Directions in the sensor's frame, with a search for those that may hit a sphere.

    Args:
        directions: unit vectors, shape (n, 3).
        grid: ascending elevations and azimuths [rad], if the directions are all their pairs, layer by layer; else None.
    """

    def __init__(self, directions: Vector, grid: tuple[Vector, Vector] | None) -> None:
        self.directions = directions
        self.columns = np.ascontiguousarray(directions.T)
        self._grid = None
        if grid is not None and np.abs(grid[0]).max() <= np.pi / 2 + 1e-9:
            self._grid = grid

    def pairs(self, centres: Vector, radii: Vector, large: int = _LARGE_BLOCK) -> Iterator[tuple[Ids, Ids]]:
        """Yield spheres and the rays that may hit them, some thousands at a time.

        Args:
            centres: centres of the spheres in the sensor's frame [m], shape (m, 3).
            radii: radii of the spheres [m], shape (m,).
            large: number of rays from which a sphere comes alone.

        Yields:
            Indices of spheres and of rays, either as pairs, or one sphere and all rays towards it.
        """
        if self._grid is None:
            yield from pairs_towards(self.directions, centres, radii)
            return
        spheres, first_row, rows, first, columns = self._blocks(centres, radii)
        row_length = len(self._grid[1])
        is_large = rows * columns >= large
        for i in np.flatnonzero(is_large).tolist():
            block = np.arange(first_row[i], first_row[i] + rows[i])[:, None] * row_length
            yield spheres[i : i + 1], (block + np.arange(first[i], first[i] + columns[i])).ravel()
        small = np.flatnonzero(~is_large)
        if small.size:
            owners = np.repeat(small, rows[small])
            row = first_row[owners] + _count_within_runs(rows[small])
            yield from _expand_runs(spheres[owners], row * row_length + first[owners], columns[owners])

    def _blocks(self, centres: Vector, radii: Vector) -> tuple[Ids, Ids, Ids, Ids, Ids]:
        """Return blocks of the grid: sphere, first row, number of rows, first column, number of columns."""
        assert self._grid is not None
        distance = np.sqrt(np.einsum("ij,ij->i", centres, centres))
        within = distance <= radii * (1 + 1e-9) + 1e-9
        # wider by a margin, so that rounding loses no ray, not even that of NumPy's arcsin on some processors
        width = np.where(within, np.pi, np.arcsin(np.minimum(1.0, radii / np.maximum(distance, _TINY))) + 1e-6)
        elevations, azimuths = self._grid
        height = np.arcsin(np.clip(centres[:, 2] / np.maximum(distance, _TINY), -1.0, 1.0))
        first_row = np.searchsorted(elevations, height - width, "left")
        rows = np.searchsorted(elevations, height + width, "right") - first_row
        over_pole = np.abs(height) + width >= np.pi / 2
        side = np.where(over_pole, 0.0, np.sin(width) / np.maximum(np.cos(height), _TINY))
        half = np.where(over_pole, np.pi, np.arcsin(np.minimum(side, 1.0)) + 1e-6)
        middle = np.arctan2(centres[:, 1], centres[:, 0])
        low, high = float(azimuths[0]), float(azimuths[-1])
        # the first azimuth may have any value, and the azimuths may cover more than one turn
        turns = np.arange(np.floor((low - 2 * np.pi) / (2 * np.pi)), np.ceil((high + 2 * np.pi) / (2 * np.pi)) + 1)
        begin = (middle - half)[:, None] + turns * (2 * np.pi)
        end = begin + 2 * half[:, None]
        spheres, turn = np.nonzero((end >= low) & (begin <= high) & (rows > 0)[:, None])
        first = np.searchsorted(azimuths, begin[spheres, turn], "left")
        columns = np.searchsorted(azimuths, end[spheres, turn], "right") - first
        is_filled = columns > 0
        spheres = spheres[is_filled]
        return spheres, first_row[spheres], rows[spheres], first[is_filled], columns[is_filled]


def _count_within_runs(counts: Ids) -> Ids:
    """Return the numbers 0, 1, ... below each count, concatenated."""
    counted: Ids = np.arange(int(counts.sum())) - np.repeat(np.cumsum(counts) - counts, counts)
    return counted


def _expand_runs(spheres: Ids, starts: Ids, counts: Ids) -> Iterator[tuple[Ids, Ids]]:
    """Yield the rays of each run with the sphere that the run belongs to, some thousands at a time."""
    ends = np.cumsum(counts)
    done = 0
    while done < len(ends):
        before = ends[done - 1] if done else 0
        stop = max(done + 1, int(np.searchsorted(ends, before + _CHUNK, "right")))
        run_counts = counts[done:stop]
        rays = np.repeat(starts[done:stop], run_counts) + _count_within_runs(run_counts)
        yield np.repeat(spheres[done:stop], run_counts), rays
        done = stop


class Shapes(NamedTuple):
    """Shapes in a sensor's frame.

    Attributes:
        kinds: geom types, shape (m,).
        sizes: sizes as in MuJoCo [m], shape (m, 3).
        positions: positions [m], shape (m, 3).
        turns: rotation matrices, shape (m, 3, 3).
        radii: radii of the bounding spheres [m], shape (m,).
        geoms: geom ids, shape (m,).
    """

    kinds: Ids
    sizes: Vector
    positions: Vector
    turns: Vector
    radii: Vector
    geoms: npt.NDArray[np.int32]

    def only(self, which: Ids) -> Shapes:
        return Shapes._make(column[which] for column in self)


def in_frame(positions: Vector, turns: Vector, origin: Vector, rotation: Vector) -> tuple[Vector, Vector]:
    """Transform positions (m, 3) and rotation matrices (m, 3, 3) from the world into one frame, or into m frames.

    The sums are written out, so that the bits do not depend on the number of shapes.

    Args:
        positions: positions in the world [m].
        turns: rotation matrices in the world.
        origin: origin of the frame in the world [m], shape (3,) or (m, 3).
        rotation: rotation matrix of the frame in the world, shape (3, 3) or (m, 3, 3).
    """
    x, y, z = np.moveaxis(positions - origin, -1, 0)[..., None]
    first, second, third = np.moveaxis(rotation, -2, 0)
    in_frame_positions: Vector = x * first + y * second + z * third
    a, b, c = np.moveaxis(turns, -2, 0)[..., None, :]
    turned_by: Vector = first[..., None] * a + second[..., None] * b + third[..., None] * c
    return in_frame_positions, turned_by


def cast_on_shapes(
    fan: FanDirections,
    shapes: Shapes,
    reach: float,
    start: float,
    best: Vector,
    hits: npt.NDArray[np.int32],
    firsts: Ids | None = None,
) -> None:
    """Shorten `best` and set `hits` where a shape is hit first.

    Args:
        fan: directions of the rays.
        shapes: shapes in the frame of the rays.
        reach: distance beyond which shapes are ignored [m].
        start: distance at which the rays start [m].
        best: shortest distances so far [m], shape (n,).
        hits: geoms at those distances, shape (n,).
        firsts: index in `best` of the first ray that may hit a shape, shape (m,), for one fan at several positions.
    """
    if firsts is None:
        firsts = np.zeros(len(shapes.geoms), dtype=np.intp)
    distance = np.sqrt(np.einsum("ij,ij->i", shapes.positions, shapes.positions))
    near = (distance - shapes.radii <= reach) & (distance + shapes.radii >= start)
    for kind in sorted(set(shapes.kinds[near].tolist())):
        chosen = np.flatnonzero(near & (shapes.kinds == kind))
        selected, begin = shapes.only(chosen), firsts.take(chosen)
        origins, sizes = -np.einsum("gi,gij->jg", selected.positions, selected.turns), selected.sizes.T
        function = INTERVALS[kind]
        for owners, rays in fan.pairs(selected.positions, selected.radii):
            directions = fan.columns.take(rays, 1)
            rays = rays + begin.take(owners)
            if len(owners) == 1:
                directions = rotate_columns(selected.turns[owners[0]].T, directions)
            else:
                directions = np.einsum("in,nij->jn", directions, selected.turns.take(owners, 0))
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                enter, leave = function(origins.take(owners, 1), directions, sizes.take(owners, 1))
                ray_distances = np.where(enter >= start, enter, leave)
                is_hit = (enter <= leave) & (ray_distances >= start) & (ray_distances < best.take(rays))
            keep = np.flatnonzero(is_hit)
            rays, ray_distances = rays[keep], ray_distances[keep]
            if len(owners) == 1:
                best[rays], hits[rays] = ray_distances, selected.geoms[owners]
            else:
                np.minimum.at(best, rays, ray_distances)
                first = best[rays] == ray_distances
                hits[rays[first]] = selected.geoms.take(owners[keep[first]])


def cast_on_plane(
    origin: Vector, directions: Vector, position: Vector, turn: Vector, size: Vector, start: float
) -> Vector | None:
    """Return distances [m], shape (n,), to the front of a plane or rectangle, infinite for misses.

    Directions have the shape (3, n). The result is None if the origin is behind the plane.
    """
    normal = turn[:, 2]
    height = float(matmul(origin - position, normal))
    if height <= 0:
        return None
    descent = _dot(directions, normal)
    out = np.full(len(descent), np.inf)
    np.divide(-height, descent, out=out, where=descent < -1e-15)
    if start > 0:
        out[out < start] = np.inf
    for axis in (0, 1):
        if size[axis] > 0:
            side = turn[:, axis]
            offset = _dot(directions, side)
            with np.errstate(invalid="ignore"):
                offset *= out
                offset += float(matmul(origin - position, side))
                np.abs(offset, out=offset)
                # `offset` is NaN or infinite for a ray that misses the plane
                out[~(offset <= size[axis])] = np.inf
    return out
