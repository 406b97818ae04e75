"""Geoms that rays can hit, grouped by the method that traces them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Final, TypeVar

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.name_map import NameMap
from simkit.pose import Vector
from simkit.sensors.rays.embree_rays import TriangleBody, TriangleScene, has_embree
from simkit.sensors.rays.geom_types import BOX, PLANE, SHAPES, SUPPORTED, TRIANGLES, Ids
from simkit.sensors.rays.mujoco_rays import ReducedModelCaster, WholeModelCaster
from simkit.sensors.rays.numpy_rays import Shapes, in_frame

Key = TypeVar("Key")

MAX_MOVING_BODIES: Final = 64
"""Number of moving bodies above which testing each of them for every ray is too slow."""
_MANY_BOXES = 24
"""Number of static boxes from which even few rays are faster on the boxes' triangles."""


class RayTargets:
    """Visible geoms, each with its carrier; a sensor does not hit its own carrier.

    Carrier 0 is the static scene. Each moving body is a carrier, and each static link that has a sensor.

    Args:
        model: compiled model.
        names: name map of the compiled model.
        seen: True for visible geoms, shape (ngeom,).
        use_embree: False traces triangles with the engine only.
    """

    def __init__(self, model: mujoco.MjModel, names: NameMap, seen: npt.NDArray[np.bool_], use_embree: bool) -> None:
        self.model, self.seen = model, seen
        self.geoms: Ids = np.flatnonzero(seen)
        self.types = model.geom_type[self.geoms].astype(np.intp)
        self._sort_carriers(names)
        has_triangles = bool(np.isin(self.types, TRIANGLES).any())
        is_known = bool(np.isin(self.types, SUPPORTED).all())
        self._use_embree = use_embree
        self.needs_engine = not is_known or (has_triangles and not self.has_embree)

    def _sort_carriers(self, names: NameMap) -> None:
        bodies = self.model.geom_bodyid[self.geoms]
        self.bodies = [0]
        self._carrier_by_body: dict[int, int] = {}
        self._carrier_by_link: dict[str, int] = {}
        self.carriers = np.zeros(len(self.geoms), dtype=np.intp)
        for i, (geom, body) in enumerate(zip(self.geoms.tolist(), bodies.tolist(), strict=True)):
            if body > 0:
                self.carriers[i] = self._carrier(self._carrier_by_body, body, body)
            else:
                link = names.geom_owner(geom)[0]
                if link and names.links[link].scene.sensors:
                    self.carriers[i] = self._carrier(self._carrier_by_link, link, 0)

    def _carrier(self, carrier_by_key: dict[Key, int], key: Key, body: int) -> int:
        if key not in carrier_by_key:
            carrier_by_key[key] = len(self.bodies)
            self.bodies.append(body)
        return carrier_by_key[key]

    def carrier_of(self, body: int, own_geoms: Sequence[int]) -> int:
        """Return the carrier of a moving body, or of a static link by its geoms.

        Returns:
            Number of the carrier; 0 if none of its geoms is visible; -1 if the geoms have no carrier of their own.
        """
        if body > 0:
            return self._carrier_by_body.get(body, 0)
        carriers = {int(c) for c in self.carriers[np.isin(self.geoms, list(own_geoms))]}
        if not carriers:
            return 0
        return carriers.pop() if len(carriers) == 1 and 0 not in carriers else -1

    @property
    def has_embree(self) -> bool:
        """True if Embree may be used and can be loaded."""
        return self._use_embree and has_embree()

    def shapes_in_frame(self, data: mujoco.MjData, which: Ids, origin: Vector, rotation: Vector) -> Shapes:
        """Return shapes by their indices in `geoms`, in one frame or in one frame each; see `in_frame`."""
        model, geoms = self.model, self.geoms.take(which)
        turns = data.geom_xmat.take(geoms, 0).reshape(-1, 3, 3)
        placed = in_frame(data.geom_xpos.take(geoms, 0), turns, origin, rotation)
        sizes, radii = model.geom_size.take(geoms, 0), model.geom_rbound.take(geoms)
        return Shapes(self.types.take(which), sizes, *placed, radii, geoms.astype(np.int32))

    # ------------------------------------------------------------------ casters, made when first used

    @cached_property
    def moving_shapes(self) -> int:
        """Number of carriers of shapes that move or have a sensor."""
        return len(set(self.carriers[np.isin(self.types, SHAPES)].tolist()))  # `np.unique` imports `numpy.ma`, 15 ms

    @cached_property
    def whole(self) -> WholeModelCaster:
        """Caster of all geoms with the engine."""
        return WholeModelCaster(self.model, self.seen)

    @cached_property
    def shapes_by_engine(self) -> ReducedModelCaster | None:
        """Caster of planes and shapes with the engine; None if there are none."""
        which = self._select(lambda t: t in (PLANE, *SHAPES))
        if self._boxes_are_triangles:
            which = np.setdiff1d(which, self._static_boxes)
        if not len(which):
            return None
        carriers = self.carriers[which]
        return ReducedModelCaster(self.model, self.geoms[which], self.types[which], carriers, self.bodies)

    @cached_property
    def planes(self) -> Ids:
        """Indices in `geoms` of the planes."""
        return self._select(lambda t: t == PLANE)

    @cached_property
    def shapes(self) -> Ids:
        """Indices in `geoms` of the shapes that are not traced as triangles."""
        boxes = self._static_boxes
        shapes = self._select(lambda t: t in SHAPES)
        return shapes[~np.isin(shapes, boxes)]

    @cached_property
    def _static_boxes(self) -> Ids:
        if not self.has_embree:
            return np.empty(0, dtype=np.intp)
        return np.flatnonzero((self.types == BOX) & (self.carriers == 0))

    @cached_property
    def _boxes_are_triangles(self) -> bool:
        """True if static boxes are traced as triangles even with few rays."""
        has_static_triangles = self.has_embree and bool((np.isin(self.types, TRIANGLES) & (self.carriers == 0)).any())
        return has_static_triangles or len(self._static_boxes) >= _MANY_BOXES

    @cached_property
    def triangles_for_engine(self) -> list[TriangleBody]:
        """Triangles that `shapes_by_engine` leaves out, one entry per carrier."""
        if self._boxes_are_triangles:
            return self.triangles_and_boxes
        return self._triangle_bodies(self._select(lambda t: t in TRIANGLES))

    @cached_property
    def triangles_and_boxes(self) -> list[TriangleBody]:
        """Meshes, heightmaps and static boxes, one entry per carrier."""
        which = np.append(self._select(lambda t: t in TRIANGLES), self._static_boxes)
        return self._triangle_bodies(np.sort(which))

    def _select(self, is_selected: Callable[[int], bool]) -> Ids:
        return np.array([i for i, t in enumerate(self.types.tolist()) if is_selected(t)], dtype=np.intp)

    def _triangle_bodies(self, which: Ids) -> list[TriangleBody]:
        carriers = self.carriers[which]
        scenes: dict[object, TriangleScene] = {}
        return [
            TriangleBody(self.model, c, self.bodies[c], self.geoms[which[carriers == c]], scenes)
            for c in sorted(set(carriers.tolist()))
        ]
