"""States of many simulations of one world, as arrays: joints, poses and velocities."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul
from simkit.pose import IDENTITY, Pose, hamilton_product, rpy_of_quaternions
from simkit.runtime.engine.velocity_servos import VelocityServoRows
from simkit.runtime.simulation import Simulation

Floats = npt.NDArray[np.float64]

ReadState = Callable[[int], tuple[mujoco.MjModel, mujoco.MjData]]
"""Function that returns model and data of one simulation; the data have its state, but no forward pass."""

_VELOCITIES: Final = int(mujoco.mjtStage.mjSTAGE_VEL)


class StateArrays:
    """States of n simulations of one world; the first axis of every array is the simulation.

    Args:
        sim: ordinary simulation that resets all others.
        batch: MuJoCo's batch of the simulations.
        read_state: function that returns model and data of one simulation; the data have its state, but no forward
            pass, and are valid until the next call.

    Attributes:
        sim: the same simulation.
        count: number of simulations.
        threads: number of threads.
        qpos, qvel, ctrl: positions, velocities and controls of MuJoCo's data.
        servos: velocity servos.
        has_moved: True after the first step.
    """

    def __init__(self, sim: Simulation, batch: Any, read_state: ReadState) -> None:
        self.sim, self._batch, self.state_of = sim, batch, read_state
        self.count: int = batch.nsim
        self.threads: int = batch.nthread
        self._fields: dict[str, Floats] = {}
        self.has_moved = False
        self.qpos, self.qvel, self.ctrl = self.field("qpos"), self.field("qvel"), self.field("ctrl")
        self.servos = VelocityServoRows(sim.engine.velocity_servos, self.count, self.qpos, self.qvel, self.ctrl)
        self._frames: dict[str, tuple[int, Pose | None]] = {}

    def field(self, name: str) -> Floats:
        """Return an array of MuJoCo's data, such as `xpos` with the shape (count, bodies, 3)."""
        if name not in self._fields:
            self._fields[name] = self._batch.bind(name)
            if self.has_moved:  # the array of a new field is zero until the next call of the engine
                self._batch.forward(None, _VELOCITIES)
        return self._fields[name]

    def time_ns_of(self, row: int) -> int:
        """Return the time of one simulation [ns]."""
        return self.sim.engine.clock.time_ns(round(float(self.field("time")[row]) / self.sim.timestep))

    # ------------------------------------------------------------------ poses and velocities

    def place(self, name: str) -> tuple[int, Pose | None]:
        """Return the body of a model or link, and its pose in the frame of the body; None for the body's own frame.

        Raises:
            KeyError: the world has no such model or link, or the model has no links.
        """
        if name not in self._frames:
            names, tables, in_link = self.sim.engine.names, self.sim.contents.handles.tables, IDENTITY
            if name not in tables["link"]:
                scene = tables["model"][name].scene
                name_of_link = scene.canonical_link
                in_link = tables["link"][name_of_link].scene.pose_world.inverse() @ scene.pose_world
            else:
                name_of_link = name
            link = names.link(name_of_link)
            offsets = [pose for pose in (link.offset, in_link) if pose != IDENTITY]
            offset = offsets[0] @ offsets[1] if len(offsets) == 2 else offsets[0] if offsets else None
            self._frames[name] = int(link.body), offset
        return self._frames[name]

    def position(self, name: str) -> Floats:
        """Return the positions of a model or link in the world [m], shape (count, 3)."""
        body, offset = self.place(name)
        positions = self.field("xpos")[:, body]
        if offset is None:
            return positions.copy()
        shift: Floats = matmul(np.asarray(self.field("xmat")[:, body]).reshape(-1, 3, 3), offset.position)
        return positions + shift

    def quaternion(self, name: str) -> Floats:
        """Return the orientations w, x, y, z of a model or link in the world, shape (count, 4)."""
        body, offset = self.place(name)
        quaternions = self.field("xquat")[:, body]
        return quaternions.copy() if offset is None else multiply_quaternions(quaternions, offset.quaternion)

    def yaw(self, name: str) -> Floats:
        """Return the yaw of a model or link [rad], shape (count,)."""
        return rpy_of_quaternions(self.quaternion(name))[:, 2]

    def linear_velocity(self, link: str) -> Floats:
        """Return the velocities of a link's origin in the world [m/s], shape (count, 3)."""
        body, _ = self.place(link)
        root = int(self.sim.mj_model.body_rootid[body])
        arm = self.field("xpos")[:, body] - self.field("subtree_com")[:, root]
        motion = self.field("cvel")[:, body]
        velocities: Floats = motion[:, 3:] + np.cross(motion[:, :3], arm)
        return velocities

    def velocity(self, name: str) -> Floats:
        """Return the velocities of the origin of a model or link in the world [m/s], shape (count, 3)."""
        tables = self.sim.contents.handles.tables
        if name in tables["link"]:
            return self.linear_velocity(name)
        link = tables["model"][name].scene.canonical_link
        arm = self.position(name) - self.position(link)
        velocities: Floats = self.linear_velocity(link) + np.cross(self.angular_velocity(link), arm)
        return velocities

    def angular_velocity(self, name: str) -> Floats:
        """Return the angular velocities of a model or link in the world [rad/s], shape (count, 3)."""
        return self.field("cvel")[:, self.place(name)[0], :3].copy()

    # ------------------------------------------------------------------ joints

    def joint_position(self, name: str) -> Floats:
        """Return the positions of a joint with one degree of freedom [rad or m], shape (count,)."""
        return self.qpos[:, self.sim.engine.names.joint(name).qpos[0]].copy()

    def joint_velocity(self, name: str) -> Floats:
        """Return the velocities of a joint with one degree of freedom [rad/s or m/s], shape (count,)."""
        return self.qvel[:, self.sim.engine.names.joint(name).dofs[0]].copy()


def multiply_quaternions(a: Floats, b: Floats) -> Floats:
    """Return the Hamilton products of quaternions w, x, y, z, along the last axis."""
    return np.stack(hamilton_product(np.moveaxis(np.asarray(a), -1, 0), np.moveaxis(np.asarray(b), -1, 0)), axis=-1)
