"""Numbers of MuJoCo's geom types, grouped by the method that traces rays on them."""

from __future__ import annotations

import mujoco
import numpy as np
import numpy.typing as npt

Ids = npt.NDArray[np.intp]

PLANE, HFIELD, SPHERE, CAPSULE, ELLIPSOID, CYLINDER, BOX, MESH = (int(mujoco.mjtGeom(number)) for number in range(8))
SHAPES = (SPHERE, CAPSULE, ELLIPSOID, CYLINDER, BOX)
TRIANGLES = (HFIELD, MESH)
SUPPORTED = (PLANE, *TRIANGLES, *SHAPES)
