"""Occupancy map of a world, made of its static collisions, as the files of ROS 2's `map_server`."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.shape_geometry import textured_triangles
from simkit.elementary_functions import arctan2
from simkit.errors import InputError
from simkit.linear_algebra import matmul
from simkit.loaders.meshes.mesh_part import Floats, Ints
from simkit.pose import Pose
from simkit.scene import Capsule, Cylinder, Ellipsoid, Geometry, Sphere

FREE: Final = 0
OCCUPIED: Final = 100
UNKNOWN: Final = -1
_PIXELS: Final = {FREE: 254, OCCUPIED: 0, UNKNOWN: 205}  # those of map_server's `map_saver`
_FREE_LIMIT: Final = 0.196  # grey 205 is 0.19608 occupied: unknown for map_server
_MARGIN: Final = 0.5  # [m] around the collisions
_MOST_CELLS: Final = 100_000_000
_PLANE: Final = int(mujoco.mjtGeom.mjGEOM_PLANE)
_FIELD: Final = int(mujoco.mjtGeom.mjGEOM_HFIELD)
_OVERLAP: Final = 1e-6  # [m]; a wall that only touches the border of a cell does not occupy the cell
_ROWS: Final = 64  # of cells that are sampled at a time
_FINE: Final = 4  # samples along each side of a cell on height fields

_CUBE: Final[Floats] = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
_CUBE_EDGES: Final[Ints] = np.array([(a, a | bit) for a in range(8) for bit in (1, 2, 4) if not a & bit], np.int32)


@dataclass(frozen=True, eq=False)
class OccupancyMap:
    """Grid of occupied, free and unknown cells.

    Attributes:
        cells: 100 occupied, 0 free, -1 unknown, shape (rows, columns); row 0 has the lowest y, column 0 the lowest x.
        resolution: side of a cell [m].
        origin: pose in the world of the corner of row 0 and column 0 [m, rad].
    """

    cells: npt.NDArray[np.int8]
    resolution: float
    origin: Pose

    def reachable_from(self, place: tuple[float, float]) -> OccupancyMap | None:
        """Return the map in which free cells are unknown that no way along free cells connects with a place.

        Args:
            place: x and y in the world [m].

        Returns:
            The map; None if the place is not in a free cell.
        """
        from scipy.ndimage import label

        x, y, _ = self.origin.inverse().transform((*place, 0.0))
        row, column = math.floor(y / self.resolution), math.floor(x / self.resolution)
        rows, columns = len(self.cells), len(self.cells.T)
        areas, _ = label(self.cells == FREE)
        if not (0 <= row < rows and 0 <= column < columns and areas[row, column]):
            return None
        is_cut_off = (self.cells == FREE) & (areas != areas[row, column])
        return replace(self, cells=np.where(is_cut_off, np.int8(UNKNOWN), self.cells))

    def image(self) -> bytes:
        """Return the map as a PGM image: occupied black, free white, unknown grey; the highest y is at the top."""
        pixels = np.full(self.cells.shape, _PIXELS[UNKNOWN], np.uint8)
        for value in (FREE, OCCUPIED):
            pixels[self.cells == value] = _PIXELS[value]
        rows, columns = self.cells.shape[0], self.cells.shape[1]
        return b"P5\n%d %d\n255\n" % (columns, rows) + pixels[::-1].tobytes()

    def description(self, image: str) -> str:
        """Return the YAML file of `map_server` for an image file."""
        x, y, _ = self.origin.position.tolist()
        yaw = self.origin.rpy[2]
        return (
            f"image: {image}\nmode: trinary\nresolution: {self.resolution:.9g}\n"
            f"origin: [{x:.9g}, {y:.9g}, {yaw:.9g}]\n"
            f"negate: 0\noccupied_thresh: 0.65\nfree_thresh: {_FREE_LIMIT}\n"
        )


def make_map(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    height: float,
    resolution: float,
    contained: Sequence[tuple[float, float]] = (),
) -> OccupancyMap:
    """Return the map of the static collisions at a height.

    A cell is occupied if a collision overlaps it at this height. Links that can move leave no mark.

    Args:
        model: compiled world.
        data: state with the poses of the geoms.
        height: z of the slice in the world [m].
        resolution: side of a cell [m].
        contained: x and y of places that the map contains, too [m].

    Raises:
        InputError: no collision crosses the height, or the map has too many cells.
    """
    if not math.isfinite(height):
        raise map_error(f"--height {height}: expected a finite number [m]")
    static = model.body_weldid[model.geom_bodyid] == 0
    geoms = np.flatnonzero(static & ((model.geom_contype | model.geom_conaffinity) != 0)).tolist()
    by_kind: dict[int, list[int]] = {_PLANE: [], _FIELD: []}
    convex: list[int] = []
    for geom in geoms:
        by_kind.get(int(model.geom_type[geom]), convex).append(geom)
    height_fields = (_HeightField(model, data, geom, height) for geom in by_kind[_FIELD])
    fields = [field for field in height_fields if len(field.outline)]
    slices = (_slice(model, data, geom, height) for geom in convex)
    polygons = [polygon for polygon in slices if polygon is not None]
    outlines = polygons + [field.outline for field in fields]
    if not outlines:
        raise map_error(f"no collision of a static link crosses the height {height:g} m")
    grid = _Grid(np.concatenate([*outlines, np.reshape(contained, (-1, 2))]), resolution)
    for polygon in polygons:
        grid.fill(polygon)
    for field in fields:
        grid.fill_where(field.outline, field.is_inside)
        grid.mark(field.surface_points())  # a thin sheet may lie between two samples
    for geom in by_kind[_PLANE]:
        grid.fill_below(data.geom_xmat[geom].reshape(3, 3)[:, 2], data.geom_xpos[geom], height)
    return OccupancyMap(grid.cells, resolution, Pose((*grid.origin, 0.0)))


def map_error(message: str, help: str = "simkit map WORLD --height Z chooses another height") -> InputError:
    """Return the error of a map that cannot be made."""
    return InputError("SK-CLI-054", message, help=help)


class _Grid:
    """Cells around points.

    Args:
        points: x and y that the map contains [m], shape (n, 2).
        resolution: side of a cell [m].
    """

    def __init__(self, points: Floats, resolution: float) -> None:
        low = np.floor((points.min(axis=0) - _MARGIN) / resolution) * resolution
        columns, rows = np.ceil((points.max(axis=0) + _MARGIN - low) / resolution).tolist()
        if not rows * columns <= _MOST_CELLS:
            size = f"{columns * resolution:.5g} × {rows * resolution:.5g} m"
            raise map_error(
                f"the map of {size} has {rows * columns:.3g} cells; at most {_MOST_CELLS:.0e} are possible",
                "simkit map WORLD --resolution R makes larger cells",
            )
        self._side = resolution
        self.origin = float(low[0]), float(low[1])
        self.cells = np.full((int(rows), int(columns)), FREE, np.int8)

    def fill(self, polygon: Floats) -> None:
        """Mark the cells that a convex polygon overlaps: no edge of either separates the two."""
        (top, left), centres = self._centres(polygon, 1)
        edges = np.roll(polygon, -1, axis=0) - polygon
        normals = np.column_stack((edges[:, 1], -edges[:, 0]))
        lengths = np.linalg.norm(normals, axis=1)
        normals = np.vstack((normals[lengths > 0] / lengths[lengths > 0, None], np.eye(2)))
        overlaps = np.ones(centres.shape[:2], bool)
        for normal in normals:
            along = matmul(polygon, normal)
            reach = np.abs(normal).sum() * self._side / 2 - _OVERLAP
            at = matmul(centres, normal)
            overlaps &= (at + reach > along.min()) & (at - reach < along.max())
        rows, columns = len(overlaps), len(overlaps.T)
        self.cells[top : top + rows, left : left + columns][overlaps] = OCCUPIED

    def mark(self, points: Floats) -> None:
        """Mark the cells of points [m], shape (n, 2)."""
        columns, rows = np.floor((points - self.origin) / self._side).astype(int).T
        self.cells[rows, columns] = OCCUPIED

    def fill_where(self, outline: Floats, is_inside: Callable[[Floats], npt.NDArray[np.bool_]]) -> None:
        """Mark the cells around an outline [m], shape (n, 2), in which a sample is inside.

        Args:
            outline: x and y of points that contain the shape [m], shape (n, 2).
            is_inside: function of points [m], shape (m, 2).
        """
        (top, left), samples = self._centres(outline, _FINE)
        for begin in range(0, len(samples), _FINE * _ROWS):  # in blocks, because a map may have 10⁸ cells
            block = samples[begin : begin + _FINE * _ROWS]
            inside = is_inside(block.reshape(-1, 2)).reshape(block.shape[:2])
            rows, columns = len(inside) // _FINE, len(inside.T) // _FINE
            is_occupied = inside.reshape(rows, _FINE, columns, _FINE).any(axis=(1, 3))
            first = top + begin // _FINE
            self.cells[first : first + rows, left : left + columns][is_occupied] = OCCUPIED

    def fill_below(self, normal: Floats, point: Floats, height: float) -> None:
        """Mark the cells that reach below a plane, which has a point and a normal, at the height of the slice [m]."""
        rows, columns = len(self.cells), len(self.cells.T)
        x, y = (self.origin[axis] + self._side * (np.arange(n) + 0.5) for axis, n in ((0, columns), (1, rows)))
        reach = np.abs(normal[:2]).sum() * self._side / 2 - _OVERLAP
        along = (x - point[0]) * normal[0] + (height - point[2]) * normal[2]
        self.cells[(y - point[1])[:, None] * normal[1] + along < reach] = OCCUPIED

    def _centres(self, outline: Floats, fine: int) -> tuple[tuple[int, int], Floats]:
        """Return the first row and column around an outline, and the centres of the parts of the cells from there."""
        low, high = outline.min(axis=0), outline.max(axis=0)
        first = np.maximum(np.floor((low - self.origin) / self._side).astype(int), 0)
        last = np.minimum(np.ceil((high - self.origin) / self._side).astype(int), self.cells.shape[::-1])
        x, y = (
            self.origin[axis] + self._side * (first[axis] + (np.arange((last - first)[axis] * fine) + 0.5) / fine)
            for axis in (0, 1)
        )
        return (int(first[1]), int(first[0])), np.stack(np.meshgrid(x, y), axis=-1)


def _slice(model: mujoco.MjModel, data: mujoco.MjData, geom: int, height: float) -> Floats | None:
    """Return the corners [m] of the slice of a convex geom in order around it, shape (n, 2); None without a slice."""
    if abs(data.geom_xpos[geom, 2] - height) > model.geom_rbound[geom]:
        return None
    vertices, edges = _edges(model, geom)
    points = matmul(vertices, data.geom_xmat[geom].reshape(3, 3).T) + data.geom_xpos[geom]
    crossings = _crossings(points, edges, height)
    if len(crossings) < 3:
        return None
    around = crossings - crossings.mean(axis=0)
    return crossings[np.argsort(arctan2(around[:, 1], around[:, 0]), kind="stable")]


def _crossings(points: Floats, edges: Ints, height: float) -> Floats:
    """Return the places [m] at which edges cross a height, shape (n, 2)."""
    begin, end = points[edges[:, 0]], points[edges[:, 1]]
    crosses = (begin[:, 2] > height) != (end[:, 2] > height)
    begin, end = begin[crosses], end[crosses]
    part = (height - begin[:, 2]) / (end[:, 2] - begin[:, 2])
    crossing_points: Floats = (begin + part[:, None] * (end - begin))[:, :2]
    return crossing_points


def _edges(model: mujoco.MjModel, geom: int) -> tuple[Floats, Ints]:
    """Return vertices in the geom's frame [m], shape (n, 3), and edges of a convex geom, shape (m, 2)."""
    kinds, size = mujoco.mjtGeom, model.geom_size[geom].tolist()
    kind = int(model.geom_type[geom])
    if kind == kinds.mjGEOM_BOX:
        return _CUBE * size, _CUBE_EDGES
    if kind in (int(kinds.mjGEOM_MESH), int(kinds.mjGEOM_SDF)):  # an SDF is within the hull of its mesh
        return _hull_edges(model, int(model.geom_dataid[geom]))
    shapes: dict[int, Geometry] = {
        int(kinds.mjGEOM_SPHERE): Sphere(size[0]),
        int(kinds.mjGEOM_CAPSULE): Capsule(size[0], 2 * size[1]),
        int(kinds.mjGEOM_CYLINDER): Cylinder(size[0], 2 * size[1]),
        int(kinds.mjGEOM_ELLIPSOID): Ellipsoid((size[0], size[1], size[2])),
    }
    part = textured_triangles(shapes[kind])
    assert part is not None
    return part.vertices, _edges_of(part.faces)


def _hull_edges(model: mujoco.MjModel, mesh: int) -> tuple[Floats, Ints]:
    """Return the convex hull of a mesh, with which MuJoCo finds contacts."""
    from scipy.spatial import ConvexHull, QhullError

    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    vertices = model.mesh_vert[first : first + count].astype(np.float64)
    try:
        return vertices, _edges_of(ConvexHull(vertices).simplices)
    except QhullError:  # flat
        start, number = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
        return vertices, _edges_of(model.mesh_face[start : start + number])


def _edges_of(faces: npt.NDArray[np.integer]) -> Ints:
    pairs = np.sort(np.concatenate((faces[:, :2], faces[:, 1:], faces[:, ::2])), axis=1)
    return np.unique(pairs, axis=0).astype(np.int32)


class _HeightField:
    """Slice of a height field, which is solid from its surface down to its base.

    Attributes:
        outline: corners [m] of the rectangle around the slice, shape (2, 2); empty if the slice is.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, geom: int, height: float) -> None:
        field = int(model.geom_dataid[geom])
        rows, columns, first = (int(a[field]) for a in (model.hfield_nrow, model.hfield_ncol, model.hfield_adr))
        self._half_x, self._half_y, scale, self._base = model.hfield_size[field].tolist()
        heights = model.hfield_data[first : first + rows * columns].reshape(rows, columns)
        self._heights = heights.astype(np.float64) * scale
        self._turn, self._at = data.geom_xmat[geom].reshape(3, 3).copy(), data.geom_xpos[geom].copy()
        self._height = height
        half_z = (self._heights.max() + self._base) / 2
        box = _CUBE * (self._half_x, self._half_y, half_z) + (0.0, 0.0, half_z - self._base)
        crossings = _crossings(matmul(box, self._turn.T) + self._at, _CUBE_EDGES, height)
        self.outline = np.array([crossings.min(axis=0), crossings.max(axis=0)]) if len(crossings) else crossings

    def surface_points(self) -> Floats:
        """Return places at which the surface crosses the height, shape (n, 2)."""
        rows, columns = self._heights.shape
        x = np.linspace(-self._half_x, self._half_x, columns)
        y = np.linspace(-self._half_y, self._half_y, rows)
        points = np.stack((*np.meshgrid(x, y), self._heights), axis=-1).reshape(-1, 3)
        number = np.arange(rows * columns).reshape(rows, columns)
        edges = [
            np.column_stack((a.ravel(), b.ravel()))
            for a, b in ((number[:, :-1], number[:, 1:]), (number[:-1], number[1:]), (number[:-1, :-1], number[1:, 1:]))
        ]
        return _crossings(matmul(points, self._turn.T) + self._at, np.concatenate(edges).astype(np.int32), self._height)

    def is_inside(self, places: Floats) -> npt.NDArray[np.bool_]:
        """Check which places at the height are inside; x and y [m], shape (n, 2)."""
        points = np.column_stack((places, np.full(len(places), self._height)))
        x, y, z = matmul(points - self._at, self._turn).T
        rows, columns = self._heights.shape
        u = (x / self._half_x + 1) / 2 * (columns - 1)
        v = (y / self._half_y + 1) / 2 * (rows - 1)
        inside = (u >= 0) & (u <= columns - 1) & (v >= 0) & (v <= rows - 1) & (z >= -self._base)
        left = np.clip(np.floor(u), 0, max(columns - 2, 0)).astype(int)
        low = np.clip(np.floor(v), 0, max(rows - 2, 0)).astype(int)
        a, b = u - left, v - low
        right, high = np.minimum(left + 1, columns - 1), np.minimum(low + 1, rows - 1)
        near, far = self._heights[low, left], self._heights[high, right]
        # each cell is split from its first to its last corner, as MuJoCo does
        across = np.where(a > b, self._heights[low, right], self._heights[high, left])
        larger, smaller = np.maximum(a, b), np.minimum(a, b)
        surface = near + larger * (across - near) + smaller * (far - across)
        is_below_surface: npt.NDArray[np.bool_] = inside & (z <= surface)
        return is_below_surface
