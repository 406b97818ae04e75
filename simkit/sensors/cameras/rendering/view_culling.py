"""Find shapes outside a view, which MuJoCo would send through the whole of OpenGL."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.pose import Vector
from simkit.sensors.cameras.rendering.view import View

_LEAST: Final = 8
"""With fewer shapes it is not worth looking."""

_SLACK: Final = 1e-3
"""Added to the radius of a shape, in parts of it: corners are rounded to single precision."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """Balls around the shapes at the beginning of a scene's list.

    Attributes:
        centres: in the world [m], shape (n, 3).
        radii: [m], shape (n,); infinite where a shape has no end.
    """

    centres: Vector
    radii: Vector

    def outside(self, position: Vector, rotation: Vector, view: View) -> list[int]:
        """Places in the list of shapes that are wholly outside a view.

        Args:
            position: of the view in the world [m], shape (3,).
            rotation: of the view (x forward, y left, z up), shape (3, 3).
        """
        normals, distances = _planes(view)
        # in few calls: after a picture was drawn, a processor knows nothing of Python's ways any more
        turned = normals @ rotation.T
        beyond = self.centres @ turned.T - (distances + turned @ position)
        found: list[int] = np.flatnonzero((beyond > self.radii[:, None]).any(axis=1)).tolist()
        return found


@functools.lru_cache(maxsize=64)
def _planes(view: View) -> tuple[Vector, Vector]:
    """Six planes around what is in view: unit normals outwards (6, 3) in its frame, distances from its eye (6,) [m]."""
    # `left` and `right` of a view are to the right of its axis, which is the frame's -y
    edges = ((-view.right, -1, 0), (view.left, 1, 0), (-view.top, 0, 1), (view.bottom, 0, -1))
    normals = np.array(((-1, 0, 0), (1, 0, 0), *edges), dtype=np.float64)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return normals, np.array((0, view.far, 0, 0, 0, 0), dtype=np.float64)


def bounds_of(
    model: mujoco.MjModel, data: mujoco.MjData, scene: mujoco.MjvScene, groups: npt.NDArray[np.uint8]
) -> Bounds | None:
    """Balls around the shapes of a scene that was made of a state; None where it is not worth it.

    Args:
        groups: which groups of geoms are drawn, shape (6,).
    """
    if model.nflex or model.nskin or scene.ngeom < _LEAST:
        return None
    ids = np.flatnonzero(groups[np.clip(model.geom_group, 0, 5)])
    geoms, geom = scene.geoms, int(mujoco.mjtObj.mjOBJ_GEOM)
    last = len(ids) - 1
    if last < 0 or scene.ngeom <= last:
        return None  # something is invisible for another reason, and the places are not known
    if any(geoms[i].objid != ids[i] or geoms[i].objtype != geom for i in (0, last)):
        return None
    radii = model.geom_rbound[ids]
    return Bounds(data.geom_xpos[ids], np.where(radii > 0.0, radii * (1.0 + _SLACK), np.inf))
