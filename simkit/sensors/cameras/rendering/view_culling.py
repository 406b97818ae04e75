"""Search for shapes outside a view, because MuJoCo passes every shape to OpenGL."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul
from simkit.pose import Vector
from simkit.sensors.cameras.rendering.view import View

_LEAST: Final = 8
"""Smallest number of shapes for which the search saves time."""

_SLACK: Final = 1e-3
"""Relative margin of a shape's radius, because its corners are rounded to single precision."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """Bounding spheres of the shapes at the beginning of a scene's list.

    Attributes:
        centres: centres in the world [m], shape (n, 3).
        radii: radii [m], shape (n,); infinite for infinite shapes.
    """

    centres: Vector
    radii: Vector

    def outside(self, position: Vector, rotation: Vector, view: View) -> list[int]:
        """Return the indices of shapes that are completely outside a view.

        Args:
            position: position of the view in the world [m], shape (3,).
            rotation: rotation matrix of the view (x forward, y left, z up), shape (3, 3).
            view: frustum of the view.
        """
        normals, distances = _planes(view)
        # few NumPy calls, because each is slow after drawing: the processor's cache no longer contains Python's code
        rotated = matmul(normals, rotation.T)
        beyond = matmul(self.centres, rotated.T) - (distances + matmul(rotated, position))
        outside_indices: list[int] = np.flatnonzero((beyond > self.radii[:, None]).any(axis=1)).tolist()
        return outside_indices


@functools.lru_cache(maxsize=64)
def _planes(view: View) -> tuple[Vector, Vector]:
    """Return the six planes of a frustum: outward unit normals (6, 3), and distances from its eye (6,) [m]."""
    # `left` and `right` of a view increase to the right of its axis, which is the frame's -y
    edges = ((-view.right, -1, 0), (view.left, 1, 0), (-view.top, 0, 1), (view.bottom, 0, -1))
    normals = np.array(((-1, 0, 0), (1, 0, 0), *edges), dtype=np.float64)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return normals, np.array((0, view.far, 0, 0, 0, 0), dtype=np.float64)


def bounds_of(
    model: mujoco.MjModel, data: mujoco.MjData, scene: mujoco.MjvScene, groups: npt.NDArray[np.uint8]
) -> Bounds | None:
    """Return bounding spheres of the shapes of a composed scene; None if culling would not save time.

    Args:
        model: compiled model.
        data: data of the state.
        scene: scene composed from the state.
        groups: 1 for each group of geoms that is drawn, shape (6,).
    """
    if model.nflex or model.nskin or scene.ngeom < _LEAST:
        return None
    ids = np.flatnonzero(groups[np.clip(model.geom_group, 0, 5)])
    geoms, geom = scene.geoms, int(mujoco.mjtObj.mjOBJ_GEOM)
    last = len(ids) - 1
    if last < 0 or scene.ngeom <= last:
        return None  # other geoms are invisible too, so the indices in the list are unknown
    if any(geoms[i].objid != ids[i] or geoms[i].objtype != geom for i in (0, last)):
        return None
    radii = model.geom_rbound[ids]
    return Bounds(data.geom_xpos[ids], np.where(radii > 0.0, radii * (1.0 + _SLACK), np.inf))
