"""Access to many links at once: read their velocities and apply forces to them with array operations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from simkit.extend import SharedByCopies, Vector
from simkit.runtime.engine.physics_step import CONTROL

if TYPE_CHECKING:
    import mujoco

    from simkit import Simulation

Three = tuple[float, float, float]
_YZX, _ZXY = [1, 2, 0], [2, 0, 1]


def moving_data(sim: Simulation) -> mujoco.MjData:
    """Return the engine's data with computed poses and velocities; the next step does not compute them again."""
    physics = sim.engine.physics
    return physics.data if physics.fresh_velocities() else physics.fresh()


def cross(a: Vector, b: Vector) -> Vector:
    """Return the cross product of each pair of rows, shape (n, 3).

    For few rows this is several times faster than NumPy's function.
    """
    product: Vector = a[:, _YZX] * b[:, _ZXY] - a[:, _ZXY] * b[:, _YZX]
    return product


class PushedLinks(SharedByCopies):
    """The movable links among some links of the current compiled model. A deep copy returns the same object.

    Args:
        sim: Simulation of the links.
        names: Scoped names of links; links of static models are left out.

    Attributes:
        names: Scoped names of the movable links.
        bodies: MuJoCo body index of each movable link, shape (n,).
        ids: The same indices as Python integers.
    """

    def __init__(self, sim: Simulation, names: Sequence[str]) -> None:
        self._sim, self._model = sim, sim.mj_model
        links = sim.engine.names.links
        # a static model with a settable pose (a mocap body) does not react to forces
        moving = [name for name in names if name in links and links[name].body > 0 and links[name].mocap < 0]
        self.names = tuple(moving)
        self.bodies = np.array([links[name].body for name in moving], dtype=np.intp)
        self.ids: list[int] = self.bodies.tolist()
        self._roots = self._model.body_rootid[self.bodies]

    def __len__(self) -> int:
        return len(self.names)

    @property
    def is_current(self) -> bool:
        """True while the engine uses the compiled model for which the indices were found."""
        return self._model is self._sim.mj_model

    def axes(self, data: mujoco.MjData) -> Vector:
        """Return the rotation matrices from link frame to world frame, shape (n, 3, 3)."""
        matrices: Vector = data.xmat[self.bodies].reshape(-1, 3, 3)
        return matrices

    def velocities(self, data: mujoco.MjData) -> Vector:
        """Return the velocities of the link origins [m/s] in the world frame, shape (n, 3)."""
        motion = data.cvel[self.bodies]  # cvel refers to the centre of mass of the whole tree
        velocities: Vector = motion[:, 3:] + cross(
            motion[:, :3], data.xpos[self.bodies] - data.subtree_com[self._roots]
        )
        return velocities

    def velocities_few(self, data: mujoco.MjData, places: list[list[float]]) -> list[Three]:
        """Return the velocities of the link origins [m/s] in the world frame, as Python floats.

        Args:
            data: Engine data from `moving_data`.
            places: World positions of the link origins [m].
        """
        velocities = []
        middles = data.subtree_com[self._roots].tolist()
        for motion, (x, y, z), (a, b, c) in zip(data.cvel[self.bodies].tolist(), places, middles, strict=True):
            p, q, r, u, v, w = motion
            x, y, z = x - a, y - b, z - c
            velocities.append((u + (q * z - r * y), v + (r * x - p * z), w + (p * y - q * x)))
        return velocities

    def push(self, data: mujoco.MjData, forces: Vector, torques: Vector | None = None) -> None:
        """Add forces and torques for the next step only.

        Args:
            data: Engine data from `moving_data`.
            forces: Force at each link's centre of mass [N], world frame, shape (n, 3).
            torques: Torque on each link [N·m], world frame, shape (n, 3).
        """
        wrenches = np.zeros((len(self.bodies), 6))
        wrenches[:, :3] = forces
        if torques is not None:
            wrenches[:, 3:] = torques
        is_pushed = wrenches.any(axis=1)
        if not is_pushed.any():
            return
        bodies = self.bodies
        if not is_pushed.all():
            bodies, wrenches = bodies[is_pushed], wrenches[is_pushed]
        data.xfrc_applied[bodies] += wrenches
        self._notify_engine(bodies.tolist())

    def push_some(self, data: mujoco.MjData, wrenches: Mapping[int, Sequence[float]]) -> None:
        """Add wrenches to a few links for the next step only.

        Args:
            data: Engine data from `moving_data`.
            wrenches: Force at the centre of mass [N] and torque [N·m] in the world frame, by index in `names`.
        """
        applied, pushed_bodies = data.xfrc_applied, []
        for place, wrench in wrenches.items():
            if any(wrench):
                body = self.ids[place]
                applied[body] += wrench
                pushed_bodies.append(body)
        if pushed_bodies:
            self._notify_engine(pushed_bodies)

    def _notify_engine(self, bodies: list[int]) -> None:
        """Tell the engine which bodies have new forces, so that sleeping bodies wake up."""
        physics = self._sim.engine.physics
        physics.push_once()
        if physics.sleep.watches:
            for body in bodies:
                physics.changed_body(CONTROL, body)
        else:
            physics.changed(CONTROL)
