"""Numbers of MuJoCo's geom types, sorted by how rays are traced on them."""

from __future__ import annotations

import mujoco
import numpy as np
import numpy.typing as npt

Ids = npt.NDArray[np.intp]

_TYPE = mujoco.mjtGeom
PLANE, HFIELD, SPHERE, CAPSULE, ELLIPSOID, CYLINDER, BOX, MESH = (
    int(t)
    for t in (
        _TYPE.mjGEOM_PLANE,
        _TYPE.mjGEOM_HFIELD,
        _TYPE.mjGEOM_SPHERE,
        _TYPE.mjGEOM_CAPSULE,
        _TYPE.mjGEOM_ELLIPSOID,
        _TYPE.mjGEOM_CYLINDER,
        _TYPE.mjGEOM_BOX,
        _TYPE.mjGEOM_MESH,
    )
)
SHAPES = (SPHERE, CAPSULE, ELLIPSOID, CYLINDER, BOX)
TRIANGLES = (HFIELD, MESH)
SUPPORTED = (PLANE, *TRIANGLES, *SHAPES)
