"""Boxes around links, along the axes, as gz-sim makes them of the collisions."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit.gzpython.math.look import AxisAlignedBox
from simkit.gzpython.math.vectors import Vector3d
from simkit.pose import Pose

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_CORNERS: Final = tuple(product((-1.0, 1.0), repeat=3))


def box_of(sim: Simulation, scoped: str) -> AxisAlignedBox:
    """Around the collisions of a link, in its frame; empty where it has none. Planes and height maps do not count."""
    import mujoco

    endless = int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD)
    model, bound, box = sim.mj_model, sim.names.link(scoped), AxisAlignedBox()
    for geom in bound.geoms:
        if int(model.geom_type[geom]) not in endless:
            placed = bound.offset.inverse() @ Pose(model.geom_pos[geom], model.geom_quat[geom])
            box.merge(_turned(placed, model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]))
    return box


def moved(box: AxisAlignedBox, pose: Pose) -> AxisAlignedBox:
    """The box, along the outer axes, around a box at a pose: never smaller than what is in it."""
    low, high = np.array(list(box.min())), np.array(list(box.max()))
    return _turned(pose, (low + high) / 2, (high - low) / 2) if (low <= high).all() else AxisAlignedBox()


def _turned(pose: Pose, centre: Any, half: Any) -> AxisAlignedBox:
    corners: Sequence[Any] = [pose @ Pose(centre + np.array(signs) * half) for signs in _CORNERS]
    points = np.array([corner.position for corner in corners])
    return AxisAlignedBox(Vector3d(*points.min(axis=0).tolist()), Vector3d(*points.max(axis=0).tolist()))
