"""Check whether free bodies are so far from everything that no contact can arise for some steps.

A flying body may land at any time, so its steps follow the contact law, which takes as long as the engine's own step of
one body. High above a terrain or a building nothing can be hit. There, the engine steps alone, with the same bits.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.float_sum import float_sum
from simkit.linear_algebra import matmul, norm
from simkit.runtime.contact import travel_bounds

_GROWTH: Final = 2.0
"""Factor by which speeds may grow within the steps."""

_LEAST_SPEED: Final = 5.0
"""Speed [m/s] that any body may reach within the steps."""

_MOST_TREES: Final = 4
"""Largest number of moving models; with more, the check takes as long as it saves."""

_FIELDS: Final = (
    *("geom_pos", "geom_quat", "geom_rbound", "body_pos", "body_quat", "body_ipos", "body_mass", "jnt_pos"),
)
"""Fields of a model that a run may write to and that decide whether the space is open, beside the masks of geoms."""

_PLANE: Final = int(mujoco.mjtGeom.mjGEOM_PLANE)
_FREE: Final = int(mujoco.mjtJoint.mjJNT_FREE)
_HINGE: Final = int(mujoco.mjtJoint.mjJNT_HINGE)


class _Ball(NamedTuple):
    """Ball about the origin of a model's first link that the model never leaves.

    Attributes:
        place: address of the position of the origin.
        motion: address of the velocity of the origin.
        radius: radius [m].
        levers: bounds on the speed of the centre of mass relative to the origin per unit of each joint velocity after
            that of the origin [m], shape (n,).
    """

    place: int
    motion: int
    radius: float
    levers: npt.NDArray[np.float64]


class OpenSpace:
    """Surroundings of the free models of one compiled model.

    Args:
        model: MuJoCo's model.
        duration: time of the steps [s].

    Attributes:
        is_known: False if the check does not apply: with joints to the world, slide joints, mocap bodies, ropes and
            springs between models, or more than four models.
    """

    def __init__(self, model: mujoco.MjModel, duration: float) -> None:
        self._duration, self._model = duration, model
        solid = np.flatnonzero(travel_bounds.can_collide(model))
        tree = model.body_treeid[model.geom_bodyid[solid]]
        trees = sorted(set(tree[tree >= 0].tolist()))  # `np.unique` would import `numpy.ma`, 8 ms
        self._balls = [_ball_of(model, number, solid[tree == number]) for number in trees]
        self.is_known = 0 < len(self._balls) <= _MOST_TREES and None not in self._balls
        self.is_known = self.is_known and not (model.nmocap or model.nflex or model.ntendon or model.neq)
        if self.is_known:
            self._fields = [getattr(model, name).copy() for name in _FIELDS]
            self._find_static(model, solid[tree < 0])

    def is_current(self) -> bool:
        """Check whether the sizes, places and masses in the model are still those of this object."""
        model = self._model
        return not self.is_known or all(
            np.array_equal(getattr(model, name), known) for name, known in zip(_FIELDS, self._fields, strict=True)
        )

    def _find_static(self, model: mujoco.MjModel, geoms: npt.NDArray[np.intp]) -> None:
        """Find the planes, and the box around all other geoms that never move."""
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        is_plane = model.geom_type[geoms] == _PLANE
        self._planes: list[tuple[float, float, float, float]] = []
        for geom in geoms[is_plane]:
            normal = data.geom_xmat[geom].reshape(3, 3)[:, 2]
            self._planes.append((*normal.tolist(), float(matmul(normal, data.geom_xpos[geom]))))
        others = geoms[~is_plane]
        radii, places = model.geom_rbound[others, None], data.geom_xpos[others]
        self._low = (places - radii).min(axis=0, initial=np.inf).tolist()
        self._high = (places + radii).max(axis=0, initial=-np.inf).tolist()

    def is_open(self, data: mujoco.MjData) -> bool:
        """Check, from positions and velocities alone, whether no contact can arise within the steps."""
        if not self.is_known:
            return False
        positions, velocities, spheres = data.qpos, data.qvel, []
        for ball in self._balls:
            assert ball is not None
            place, motion, radius, levers = ball
            # the centre of mass keeps its velocity; the origin of a spinning model may stop for a moment
            spin = float(matmul(levers, np.abs(velocities[motion + 3 : motion + 3 + len(levers)])))
            speed = math.hypot(*velocities[motion : motion + 3].tolist()) + 2.0 * spin
            reach = radius + _GROWTH * (speed + _LEAST_SPEED) * self._duration
            x, y, z = positions[place : place + 3].tolist()
            if not self._is_outside(x, y, z, reach):
                return False
            spheres.append((x, y, z, reach))
        return all(
            math.dist(sphere[:3], other[:3]) > sphere[3] + other[3]
            for k, sphere in enumerate(spheres)
            for other in spheres[:k]
        )

    def is_pushed(self, data: mujoco.MjData) -> bool:
        """Check whether forces may change a speed within the steps by more than `is_open` assumes.

        Args:
            data: MuJoCo's data with accelerations up to date.
        """
        most, accelerations = _GROWTH * _LEAST_SPEED / self._duration, data.qacc
        motions = (accelerations[ball.motion : ball.motion + 3] for ball in self._balls if ball is not None)
        return any(math.hypot(*acceleration.tolist()) > most for acceleration in motions)

    def _is_outside(self, x: float, y: float, z: float, reach: float) -> bool:
        """Check whether a sphere touches neither a plane nor the box around the static geoms; False for NaN."""
        if not all(a * x + b * y + c * z - offset > reach for a, b, c, offset in self._planes):
            return False
        low, high = self._low, self._high
        return (
            not low[0] - reach <= x <= high[0] + reach
            or not low[1] - reach <= y <= high[1] + reach
            or not low[2] - reach <= z <= high[2] + reach
        ) and math.isfinite(x + y + z + reach)


def _ball_of(model: mujoco.MjModel, tree: int, geoms: npt.NDArray[np.intp]) -> _Ball | None:
    """Return the ball that the geoms of a kinematic tree never leave; None if its size has no bound."""
    bodies = np.flatnonzero(model.body_treeid == tree)
    root = int(bodies[0])
    joint = int(model.body_jntadr[root])
    if model.body_jntnum[root] != 1 or model.jnt_type[joint] != _FREE:
        return None
    reach = {root: 0.0}
    for body in bodies[1:].tolist():  # parents come first
        joints = range(int(model.body_jntadr[body]), int(model.body_jntadr[body] + model.body_jntnum[body]))
        if any(model.jnt_type[k] != _HINGE for k in joints):
            return None
        anchors = 2.0 * float_sum(norm(model.jnt_pos[k]) for k in joints)
        reach[body] = reach[int(model.body_parentid[body])] + norm(model.body_pos[body]) + anchors
    offsets = np.linalg.norm(model.geom_pos[geoms], axis=1) + model.geom_rbound[geoms]
    radius = max(
        reach[body] + size for body, size in zip(model.geom_bodyid[geoms].tolist(), offsets.tolist(), strict=True)
    )
    return _Ball(
        int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint]), radius, _levers_of_centre(model, root, reach)
    )


def _levers_of_centre(model: mujoco.MjModel, root: int, reach: dict[int, float]) -> npt.NDArray[np.float64]:
    """Return the levers of `_Ball`; those of a wheel that turns about its centre of mass are 0.

    Args:
        model: MuJoCo's model.
        root: first body of a kinematic tree.
        reach: largest distance of each body of the tree from the first [m].
    """
    dof, mass = int(model.body_dofadr[root]), float(model.body_subtreemass[root])
    levers = np.zeros(sum(int(model.body_dofnum[body]) for body in reach) - 3)
    offsets = np.linalg.norm(model.body_ipos, axis=1)
    for body, distance in reach.items():
        share, above = float(model.body_mass[body]) / mass, body
        while above != root:
            first, count = int(model.body_jntadr[above]), int(model.body_jntnum[above])
            for joint in range(first, first + count):
                lever = distance - reach[above] + offsets[body] + norm(model.jnt_pos[joint])
                if above == body and count == 1:
                    arm = model.body_ipos[body] - model.jnt_pos[joint]
                    lever = norm(np.cross(arm, model.jnt_axis[joint]))
                levers[int(model.jnt_dofadr[joint]) - dof - 3] += share * lever
            above = int(model.body_parentid[above])
        levers[:3] += share * (distance + offsets[body])
    return levers
