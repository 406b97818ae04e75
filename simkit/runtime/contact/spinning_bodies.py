"""Free bodies that spin so fast that their contact points need the correction of `ContactPointMotion`."""

from __future__ import annotations

import math
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import dot, norm, squared_length

MIN_ACCELERATION: Final = 0.05
"""Least acceleration of the surface of a body by its spin [m/s²] for the correction; a contact slips by 0.1 mm/s.

It is the size of the body times the angular velocity times its part across the axis of symmetry: a cylinder that rolls
straight ahead has no term.
"""

MAX_BODIES: Final = 8
"""Largest number of free bodies that turn at all: more of them make a heap, where some spin in nearly all steps.

Balls do not count. A body that sleeps has no velocity. The data of a reader do not contain the sleep itself.
"""

_FREE: Final = int(mujoco.mjtJoint.mjJNT_FREE)
_SPHERE: Final = int(mujoco.mjtGeom.mjGEOM_SPHERE)
_ROUND: Final = (int(mujoco.mjtGeom.mjGEOM_CYLINDER), int(mujoco.mjtGeom.mjGEOM_CAPSULE))
_CENTRED: Final = 1e-6  # largest distance of a centre from a point or an axis, as a fraction of the size of the shape


class SpinningBodies:
    """Search for free bodies of one compiled model that spin.

    Args:
        model: MuJoCo's model.

    Attributes:
        joints: free joints that are the only joint of their kinematic tree, by tree.
        can_spin: True if a body has a surface that its spin accelerates. A ball has none.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._tree_count = int(model.ntree)
        joints = np.flatnonzero(model.jnt_type == _FREE)
        trees = model.body_treeid[model.jnt_bodyid[joints]]
        alone = model.tree_dofnum[trees] == 6
        self.joints: dict[int, int] = dict(zip(trees[alone].tolist(), joints[alone].tolist(), strict=True))
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        trees_of_geoms = model.body_treeid[model.geom_bodyid]
        bodies: list[tuple[int, int, float, list[float]]] = []
        for tree, joint in self.joints.items():
            reach, axis = _reach_and_axis(model, np.flatnonzero((trees_of_geoms == tree) & collides).tolist())
            if reach > 0.0:
                bodies.append((tree, int(model.jnt_dofadr[joint]) + 3, MIN_ACCELERATION / reach, axis))
        self._plain, self.can_spin = bodies, bool(bodies)
        self._trees = np.array([tree for tree, _, _, _ in bodies], np.intp)
        self._spins = np.array([start + axis for _, start, _, _ in bodies for axis in range(3)], np.intp)
        self._limits = np.array([limit for _, _, limit, _ in bodies])
        self._axes = np.array([axis for _, _, _, axis in bodies]).T
        self._least = min((limit for _, _, limit, _ in bodies), default=math.inf)

    def find(self, data: mujoco.MjData) -> npt.NDArray[np.bool_] | None:
        """Return a mask of the trees that spin fast, with False for static bodies at its end; None if there are none.

        More than `MAX_BODIES` bodies that turn make a heap, in which none counts. Most worlds have few free bodies, and
        none that spins. Plain numbers then take half the time of arrays.
        """
        if len(self._plain) <= MAX_BODIES:
            velocities, fast = data.qvel.tolist(), []
            for tree, start, limit, (a, b, c) in self._plain:
                x, y, z = velocities[start : start + 3]
                square, along = x * x + y * y + z * z, x * a + y * b + z * c
                if square * (square - along * along) > limit * limit:
                    fast.append(tree)
        else:
            spins = data.qvel.take(self._spins)
            if squared_length(spins, self._least) <= self._least:
                return None
            (x, y, z), (a, b, c) = spins.reshape(-1, 3).T, self._axes
            square, along = x * x + y * y + z * z, x * a + y * b + z * c
            if np.count_nonzero(square) > MAX_BODIES:
                return None
            fast = self._trees[square * (square - along * along) > self._limits * self._limits].tolist()
        if not fast:
            return None
        is_spinning = np.zeros(self._tree_count + 1, bool)
        is_spinning[fast] = True
        return is_spinning


def _reach_and_axis(model: mujoco.MjModel, geoms: list[int]) -> tuple[float, list[float]]:
    """Return the largest distance of a surface from the centre of mass, and the axis of symmetry of a body.

    A sphere about the centre of mass has no term and does not count. Of other spheres, the centre counts.

    Args:
        model: MuJoCo's model.
        geoms: numbers of the geoms of the body.

    Returns:
        Distance [m]; 0 if no geom counts. Axis in the frame of the body; zero without symmetry.
    """
    reach, axes, matrix = 0.0, [], np.empty(9)
    for geom in geoms:
        kind, size = int(model.geom_type[geom]), float(model.geom_rbound[geom])
        offset = model.geom_pos[geom] - model.body_ipos[model.geom_bodyid[geom]]
        distance = norm(offset)
        is_centred, axis = distance <= _CENTRED * size, np.zeros(3)
        if kind == _SPHERE:
            if is_centred:
                continue
            axis = offset / distance
        elif kind in _ROUND:
            mujoco.mju_quat2Mat(matrix, model.geom_quat[geom])
            if is_centred or norm(np.cross(matrix[2::3], offset)) <= _CENTRED * size:
                axis = matrix[2::3].copy()
        reach = max(reach, distance + (0.0 if kind == _SPHERE else size))
        axes.append(axis)
    first = axes[0] if axes else np.zeros(3)
    is_round = all(abs(dot(first, axis)) >= 1.0 - _CENTRED for axis in axes)
    turning_axis: list[float] = (first if is_round else np.zeros(3)).tolist()
    return reach, turning_axis
