"""Poses, velocities, joints and contacts of all environments of a batch, as arrays."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.elementary_functions import arctan2
from simkit.linear_algebra import matmul, norm
from simkit.pose import Pose
from simkit.runtime import Simulation
from simkit.sensors.inertial.inertial_kinematics import hamilton_product
from simkit.testing.conditions.contact_query import ContactQuery

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
ReadState = Callable[[int], tuple[mujoco.MjModel, mujoco.MjData]]
"""Function that returns model and data of one environment; the data have its state, but no forward pass."""

_GROUND: Final = (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD))


class ArrayView:
    """State of all environments; the first axis of every array is the environment.

    Functions for arrays (`simkit.gym.Batched`) receive this object.

    Args:
        sim: simulation of the environment that resets all others.
        batch: MuJoCo's batch.
        read_state: function that returns model and data of one environment.

    Attributes:
        count: number of environments.
        memory: numbers that `on_reset` stored in `env.memory`, as arrays by name; functions may write to them.
        action: last actions within their bounds, shape (count, n).
        observation: last observations.
        time: simulated time since the reset [s], shape (count,).
        sim_time: time of the simulations [s], shape (count,).
        varies_model: the environments have models of their own, which differ in drawn or written values.
    """

    def __init__(self, sim: Simulation, batch: Any, read_state: ReadState) -> None:
        self._sim, self._read_state = sim, read_state
        self.count: int = batch.nsim
        self.qpos, self.qvel, self.ctrl = batch.bind("qpos"), batch.bind("qvel"), batch.bind("ctrl")
        self._xpos, self._xquat, self._xmat = batch.bind("xpos"), batch.bind("xquat"), batch.bind("xmat")
        self._cvel, self._centre = batch.bind("cvel"), batch.bind("subtree_com")
        self._geom_xpos, self._geom_xmat = batch.bind("geom_xpos"), batch.bind("geom_xmat")
        self.varies_model = False
        self.memory: dict[str, Any] = {}
        self.action: Floats = np.zeros((self.count, 0))
        self.observation: Any = None
        self.time: Floats = np.zeros(self.count)
        self.sim_time: Floats = np.zeros(self.count)
        self._places: dict[str, tuple[int, Pose | None]] = {}
        self._contacts: dict[str, _TouchSearch] = {}

    # ------------------------------------------------------------------ poses and velocities

    def place(self, name: str) -> tuple[int, Pose | None]:
        """Return the body of a model or link, and its pose in the frame of the body; None for the body's own frame.

        Raises:
            KeyError: the world has no such model or link.
        """
        if name not in self._places:
            tables = self._sim.contents.handles.tables
            handle = tables["link"].get(name)
            offset = None
            if handle is None:
                model = tables["model"][name]
                handle = tables["link"][model._canonical.scoped]
                offset = None if model._is_canonical else model._in_canonical
            inner = handle._offset
            if inner is not None:
                offset = inner if offset is None else inner @ offset
            self._places[name] = handle._body, offset
        return self._places[name]

    def position(self, name: str) -> Floats:
        """Return the positions of a model or link in the world [m], shape (count, 3)."""
        body, offset = self.place(name)
        found: Floats = self._xpos[:, body]
        if offset is None:
            return found.copy()
        shift: Floats = matmul(np.asarray(self._xmat[:, body]).reshape(-1, 3, 3), offset.position)
        return found + shift

    def quaternion(self, name: str) -> Floats:
        """Return the orientations w, x, y, z of a model or link in the world, shape (count, 4)."""
        body, offset = self.place(name)
        found: Floats = self._xquat[:, body]
        return found.copy() if offset is None else multiply(found, offset.quaternion)

    def yaw(self, name: str) -> Floats:
        """Return the yaw of a model or link [rad], shape (count,)."""
        w, x, y, z = self.quaternion(name).T
        found: Floats = arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        return found

    def linear_velocity(self, link: str) -> Floats:
        """Return the velocities of a link's origin in the world [m/s], shape (count, 3)."""
        body = self._body_of_link(link)
        root = int(self._sim.mj_model.body_rootid[body])
        arm = self._xpos[:, body] - self._centre[:, root]
        found: Floats = self._cvel[:, body, 3:] + np.cross(self._cvel[:, body, :3], arm)
        return found

    def velocity(self, name: str) -> Floats:
        """Return the velocities of the origin of a model or link in the world [m/s], shape (count, 3)."""
        tables = self._sim.contents.handles.tables
        if name in tables["link"]:
            return self.linear_velocity(name)
        link = tables["model"][name]._canonical.scoped
        arm = self.position(name) - self.position(link)
        found: Floats = self.linear_velocity(link) + np.cross(self.angular_velocity(link), arm)
        return found

    def angular_velocity(self, link: str) -> Floats:
        """Return the angular velocities of a link in the world [rad/s], shape (count, 3)."""
        found: Floats = self._cvel[:, self._body_of_link(link), :3].copy()
        return found

    def _body_of_link(self, link: str) -> int:
        return int(self._sim.contents.handles.tables["link"][link]._body)

    def joint_position(self, name: str) -> Floats:
        """Return the positions of a joint with one degree of freedom [rad or m], shape (count,)."""
        found: Floats = self.qpos[:, self._sim.contents.handles.tables["joint"][name]._one_qpos].copy()
        return found

    def joint_velocity(self, name: str) -> Floats:
        """Return the velocities of a joint with one degree of freedom [rad/s or m/s], shape (count,)."""
        found: Floats = self.qvel[:, self._sim.contents.handles.tables["joint"][name]._one_dof].copy()
        return found

    # ------------------------------------------------------------------ contacts

    def contact(self, name: str) -> Bools:
        """Return in which environments a model or link touches something other than the ground, shape (count,).

        Bounds of the geoms exclude most environments; the engine detects the contacts of the others.
        """
        if name not in self._contacts:
            self._contacts[name] = _TouchSearch(self._sim, name)
        search = self._contacts[name]
        found = np.zeros(self.count, np.bool_)
        # the bounds are those of one model
        rows = np.arange(self.count)
        if not self.varies_model:
            rows = np.flatnonzero(search.may_touch(self._geom_xpos, self._geom_xmat))
        for row in rows.tolist():
            model, data = self._read_state(row)
            mujoco.mj_fwdPosition(model, data)
            found[row] = bool(search.query.among(data))
        return found


class _TouchSearch:
    """Search for environments in which an entity may touch another, by bounds of geoms.

    Args:
        sim: simulation of the environment that resets all others.
        name: scoped name of a model or link.
    """

    def __init__(self, sim: Simulation, name: str) -> None:
        model = sim.mj_model
        self.query = ContactQuery(sim, name)
        mine, others = (np.array(part[:-1], dtype=np.bool_) for part in self.query.masks())
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        is_ground = np.isin(model.geom_type, _GROUND) & (model.body_weldid[model.geom_bodyid] == 0)
        gravity = model.opt.gravity.copy()
        up = -gravity / norm(gravity) if gravity.any() else np.array((0.0, 0.0, 1.0))
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        # the front of a plane that is steeper than a ramp is a wall
        steep = matmul(data.geom_xmat[:, 2::3], up) < math.cos(math.radians(45.0))
        is_wall = (model.geom_type == _GROUND[0]) & steep
        self._mine = np.flatnonzero(mine & collides)
        self._others = np.flatnonzero(others & collides & ~(is_ground & ~is_wall))
        self._radii = model.geom_rbound[self._mine] + model.geom_margin[self._mine]
        is_plane = model.geom_type[self._others] == _GROUND[0]
        self._middles = model.geom_aabb[self._others, :3]
        self._halves = np.where(is_plane[:, None], (np.inf, np.inf, 0.0), model.geom_aabb[self._others, 3:])

    def may_touch(self, positions: Floats, rotations: Floats) -> Bools:
        """Check in which environments the spheres around the entity's geoms reach into the boxes around the others."""
        if not (len(self._mine) and len(self._others)):
            return np.zeros(len(positions), np.bool_)
        centres = positions[:, self._mine]
        turns = rotations[:, self._others].reshape(len(positions), -1, 3, 3)
        offsets = centres[:, :, None] - positions[:, None, self._others]  # environment, own geom, other geom, axis
        local = np.einsum("nmoi,noij->nmoj", offsets, turns) - self._middles
        outside = np.maximum(np.abs(local) - self._halves, 0.0)
        square = np.einsum("nmoj,nmoj->nmo", outside, outside)
        reach = (self._radii * (1.0 + 1e-9) + 1e-9) ** 2
        found: Bools = ~(square > reach[None, :, None]).all(axis=(1, 2))
        return found


def multiply(a: Any, b: Any) -> Floats:
    """Return the Hamilton products of quaternions w, x, y, z, along the last axis."""
    return np.stack(hamilton_product(np.moveaxis(np.asarray(a), -1, 0), np.moveaxis(np.asarray(b), -1, 0)), axis=-1)
