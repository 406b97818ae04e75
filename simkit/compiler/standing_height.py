"""Height at which a model stands on the highest surface below it, in the first state of a compiled world."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.geom_groups import COLLISION_RAY, SEEN_AS_COLLISIONS
from simkit.elementary_functions import arctan2
from simkit.linear_algebra import matmul, norm

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]

HEADROOM: Final = 1.8
"""Least free height [m] of a room. A surface with a higher free space below it is a roof, lamp or bridge."""

_CELLS: Final = 16  # columns of the footprint along x and y
_RIM: Final = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
_MOST_HITS: Final = 64  # surfaces of one column
_BELOW_SURFACE: Final = 1e-6  # [m] start of the next ray below a surface
_CORNERS: Final = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
_ROUNDS: Final = 20  # corrections for contacts between the columns
_RESOLVED: Final = 1e-6  # [m] depth of a contact that is not corrected
_OWN, _GROUND, _OTHER = 0, 1, 2
_UNBOUNDED: Final = (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD)


@dataclass(frozen=True, slots=True)
class Stand:
    """Result of the search for a standing height.

    Attributes:
        lift: vertical distance [m] from the present pose to the pose on the surface.
        surface: geom or flex that carries the model; -1 if it is not known.
    """

    lift: float
    surface: int


class StandingHeight:
    """Search for standing heights in one compiled world.

    Args:
        model: compiled world; its groups, sizes of planes and colours are changed.
        data: first state.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model, self._data = model, data
        self._collides = (model.geom_contype | model.geom_conaffinity) != 0
        is_ghost = ~self._collides & (model.geom_group != COLLISION_RAY)
        self._is_surface = np.isin(model.geom_group, SEEN_AS_COLLISIONS) & ~is_ghost
        planes = model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE
        model.geom_size[planes, :2] = 0.0  # contacts see infinite planes, but rays see their drawn size
        model.geom_rgba[:, 3], model.geom_matid[:] = 1.0, -1  # rays do not see transparent geoms
        self._bounded_top, self._planes = 0.0, list[tuple[Floats, Floats]]()
        self._flexes = [f for f in range(model.nflex) if model.flex_contype[f] | model.flex_conaffinity[f]]

    def find(self, model_geoms: Bools, ignored: Bools) -> Stand | None:
        """Return the height of a model; None if the model has no collisions or nothing is below it.

        Args:
            model_geoms: geoms of the model.
            ignored: geoms of other models that carry nothing.
        """
        model, data = self._model, self._data
        colliding = model_geoms & self._collides
        mujoco.mj_fwdPosition(model, data)
        if not colliding.any():
            return None
        model.geom_group[:] = _OTHER
        model.geom_group[self._is_surface & ~model_geoms & ~ignored] = _GROUND
        model.geom_group[colliding] = _OWN
        points = np.concatenate([self._low_points(int(g)) for g in np.flatnonzero(colliding)])
        top = float(points[:, 2].max())
        points = np.concatenate([self._lowest_of_cells(points), *self._grid(points)])
        headroom = max(HEADROOM, top - float(points[:, 2].min()))
        self._bounded_top, self._planes = self._tops()
        best: Stand | None = None
        for x, y, z in points:
            floor = self._floor(float(x), float(y), headroom)
            if floor is not None and (best is None or floor[0] - z > best.lift):
                best = Stand(floor[0] - float(z), floor[1])
        return best

    def raise_from_contacts(self, model_geoms: Bools, ignored: Bools, addresses: list[int]) -> tuple[float, int]:
        """Raise a model until no contact below it penetrates; return the height [m] and the last geom that lifted it.

        Rays see only the columns of a grid. An edge between two columns shows as a contact.

        Args:
            model_geoms: geoms of the model.
            ignored: geoms of other models that carry nothing.
            addresses: indices of the heights of its free links in the positions.
        """
        model, data = self._model, self._data
        lifted, surface = 0.0, -1
        for _ in range(_ROUNDS):
            mujoco.mj_fwdPosition(model, data)
            step = 0.0
            for i in range(data.ncon):
                first, second = (int(g) for g in data.contact.geom[i])
                sides = [g >= 0 and bool(model_geoms[g]) for g in (first, second)]
                other = second if sides[0] else first
                up = abs(float(data.contact.frame[i][2]))
                if sides[0] == sides[1] or up < 0.3 or (other >= 0 and ignored[other]):
                    continue
                needed = -float(data.contact.dist[i]) / up
                if needed > max(step, _RESOLVED):
                    step, surface = needed, other
            if step == 0.0:
                break
            data.qpos[addresses] += step
            lifted += step
        return lifted, surface

    # ------------------------------------------------------------------ the model

    def _low_points(self, geom: int) -> Floats:
        """Return points of a geom's surface in the world, with its lowest point and its corners."""
        model, data = self._model, self._data
        centre, matrix = data.geom_xpos[geom], data.geom_xmat[geom].reshape(3, 3)
        a, b, c = (float(s) for s in model.geom_size[geom])
        down = -matrix[2]  # the direction downwards in the geom's frame
        kind = int(model.geom_type[geom])
        if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
            local = down[None] * a
        elif kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
            size = np.array((a, b, c))
            local = (size**2 * down / norm(size * down))[None]
        elif kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
            local = np.array(((0.0, 0.0, b), (0.0, 0.0, -b))) + down * a
        elif kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
            angles = np.append(_RIM, arctan2(down[1], down[0]))
            rim = np.column_stack((a * np.cos(angles), a * np.sin(angles), np.full(len(angles), b)))
            local = np.concatenate((rim, rim * (1.0, 1.0, -1.0)))
        elif kind in (mujoco.mjtGeom.mjGEOM_MESH, mujoco.mjtGeom.mjGEOM_SDF) and model.geom_dataid[geom] >= 0:
            mesh = int(model.geom_dataid[geom])
            start = int(model.mesh_vertadr[mesh])
            local = model.mesh_vert[start : start + int(model.mesh_vertnum[mesh])].astype(float)
        elif kind == mujoco.mjtGeom.mjGEOM_BOX:
            local = _CORNERS * (a, b, c)
        else:
            local = np.zeros((1, 3))
        points: Floats = centre + matmul(local, matrix.T)
        return points

    @staticmethod
    def _lowest_of_cells(points: Floats) -> Floats:
        """Return the lowest point of each cell of the footprint."""
        low = points[:, :2].min(axis=0)
        size = np.maximum(points[:, :2].max(axis=0) - low, 1e-9)
        cells = np.minimum((points[:, :2] - low) / size * _CELLS, _CELLS - 1).astype(int)
        keys = cells[:, 0] * _CELLS + cells[:, 1]
        order = np.lexsort((points[:, 2], keys))
        first = np.append(True, np.diff(keys[order]) > 0)
        lowest: Floats = points[order][first]
        return lowest

    def _grid(self, points: Floats) -> Iterator[Floats]:
        """Return the underside of the model on a grid; points of the underside can be far from all corners."""
        low, high = points.min(axis=0), points.max(axis=0)
        start = float(low[2]) - max(1.0, norm(high - low))
        for x in np.linspace(low[0], high[0], _CELLS + 1):
            for y in np.linspace(low[1], high[1], _CELLS + 1):
                distance, _ = self._ray(float(x), float(y), start, 1.0, _OWN)
                if distance >= 0.0:
                    yield np.array([[x, y, start + distance]])

    # ------------------------------------------------------------------ the surfaces

    def _floor(self, x: float, y: float, headroom: float) -> tuple[float, int] | None:
        """Return the height and geom of the highest surface of a column that is no roof; None for an empty column."""
        inside: set[int] = set()
        floor: tuple[float, int] | None = None
        above = np.inf
        for z, geom in self._surfaces(x, y):
            if floor is None or (not inside and above - z >= headroom):
                floor = z, geom
            if geom >= 0 and int(self._model.geom_type[geom]) in _UNBOUNDED:
                break  # solid down to any depth
            inside ^= {geom}
            above = z
        return floor

    def _surfaces(self, x: float, y: float) -> Iterator[tuple[float, int]]:
        """Return heights and geoms of the surfaces of a column from top to bottom."""
        z = self._top(x, y)
        for _ in range(_MOST_HITS):
            distance, geom = self._ray(x, y, z, -1.0, _GROUND)
            if distance < 0.0:
                return
            z -= distance
            yield z, geom
            z -= _BELOW_SURFACE

    def _tops(self) -> tuple[float, list[tuple[Floats, Floats]]]:
        """Return a height [m] above all bounded surfaces, and the centre and normal of each plane."""
        model, data = self._model, self._data
        ground = model.geom_group == _GROUND
        planes = ground & (model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE)
        bounded = ground & ~planes
        top = float((data.geom_xpos[bounded, 2] + model.geom_rbound[bounded]).max(initial=-1e9))
        if self._flexes:
            top = max(top, float(data.flexvert_xpos[:, 2].max()))
        frames = [(data.geom_xpos[g], data.geom_xmat[g].reshape(3, 3)[:, 2]) for g in np.flatnonzero(planes)]
        return top, [(centre, normal) for centre, normal in frames if abs(normal[2]) > 1e-6]

    def _top(self, x: float, y: float) -> float:
        """Return a height [m] above all surfaces of a column."""
        at_planes = (
            float(c[2] - ((x - c[0]) * normal[0] + (y - c[1]) * normal[1]) / normal[2]) for c, normal in self._planes
        )
        return max(self._bounded_top, *at_planes) + 1.0 if self._planes else self._bounded_top + 1.0

    def _ray(self, x: float, y: float, z: float, direction: float, group: int) -> tuple[float, int]:
        """Return the distance to the nearest geom of a group, or flex, and its id; -1 and -1 for none.

        The id of a flex is -2 - index.
        """
        model, data = self._model, self._data
        start, ray = np.array((x, y, z)), np.array((0.0, 0.0, direction))
        groups, geom = np.zeros(6, np.uint8), np.array((-1,), np.int32)
        groups[group] = 1
        nearest = float(mujoco.mj_ray(model, data, start, ray, groups, 1, -1, geom))
        hit = int(geom[0])
        for flex in self._flexes if group == _GROUND else ():
            distance = float(mujoco.mj_rayFlex(model, data, 0, False, False, True, False, flex, start, ray))
            if distance >= 0.0 and (nearest < 0.0 or distance < nearest):
                nearest, hit = distance, -2 - flex
        return nearest, hit
