"""Read the motion of many links and write the forces on them in one go, step by step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from simkit.pose import Vector
from simkit.runtime.engine.physics_step import CONTROL

if TYPE_CHECKING:
    import mujoco

    from simkit.runtime import Simulation

Three = tuple[float, float, float]
_YZX, _ZXY = [1, 2, 0], [2, 0, 1]


def moving_data(sim: Simulation) -> mujoco.MjData:
    """The engine's data with places and velocities computed; the step that follows goes on from there."""
    physics = sim.engine.physics
    return physics.data if physics.fresh_velocities() else physics.fresh()


def cross(a: Vector, b: Vector) -> Vector:
    """Cross products of rows, shape (n, 3); for a few of them several times faster than NumPy's."""
    found: Vector = a[:, _YZX] * b[:, _ZXY] - a[:, _ZXY] * b[:, _YZX]
    return found


class PushedLinks:
    """Links of the engine's present model, by scoped name; those that never move are left out. A handle.

    Attributes:
        names: of the links that move.
        bodies: their ids, shape (n,).
        ids: the same as plain numbers.
    """

    def __init__(self, sim: Simulation, names: Sequence[str]) -> None:
        self._sim, self._model = sim, sim.mj_model
        links = sim.engine.names.links
        # whoever sets the pose of a movable static model moves it, no force does
        moving = [name for name in names if name in links and links[name].body > 0 and links[name].mocap < 0]
        self.names = tuple(moving)
        self.bodies = np.array([links[name].body for name in moving], dtype=np.intp)
        self.ids: list[int] = self.bodies.tolist()
        self._roots = self._model.body_rootid[self.bodies]

    def __len__(self) -> int:
        return len(self.names)

    def __deepcopy__(self, memo: dict[int, object]) -> PushedLinks:
        return self

    @property
    def is_current(self) -> bool:
        """Whether the engine's model is still the one that these ids are of."""
        return self._model is self._sim.mj_model

    def axes(self, data: mujoco.MjData) -> Vector:
        """Rotation matrices link to world, shape (n, 3, 3)."""
        matrices: Vector = data.xmat[self.bodies].reshape(-1, 3, 3)
        return matrices

    def velocities(self, data: mujoco.MjData) -> Vector:
        """Of the link origins [m/s], world frame, shape (n, 3)."""
        motion = data.cvel[self.bodies]  # about the centre of mass of the whole tree
        found: Vector = motion[:, 3:] + cross(motion[:, :3], data.xpos[self.bodies] - data.subtree_com[self._roots])
        return found

    def velocities_few(self, data: mujoco.MjData, places: list[list[float]]) -> list[Three]:
        """The same in plain numbers, of links whose origins in the world are known."""
        found = []
        middles = data.subtree_com[self._roots].tolist()
        for motion, (x, y, z), (a, b, c) in zip(data.cvel[self.bodies].tolist(), places, middles, strict=True):
            p, q, r, u, v, w = motion
            x, y, z = x - a, y - b, z - c
            found.append((u + (q * z - r * y), v + (r * x - p * z), w + (p * y - q * x)))
        return found

    def push(self, data: mujoco.MjData, forces: Vector, torques: Vector | None = None) -> None:
        """For the next step only, besides what else pushes.

        Args:
            data: as `moving_data` gives it.
            forces: at the centres of mass [N], world frame, shape (n, 3).
            torques: [N·m], world frame, shape (n, 3).
        """
        wrenches = np.zeros((len(self.bodies), 6))
        wrenches[:, :3] = forces
        if torques is not None:
            wrenches[:, 3:] = torques
        felt = wrenches.any(axis=1)
        if not felt.any():
            return
        bodies = self.bodies
        if not felt.all():
            bodies, wrenches = bodies[felt], wrenches[felt]
        data.xfrc_applied[bodies] += wrenches
        self._tell(bodies.tolist())

    def push_some(self, data: mujoco.MjData, wrenches: Mapping[int, Sequence[float]]) -> None:
        """`push` of a few: by their place among the links, force [N] and torque [N·m] in the world frame."""
        applied, told = data.xfrc_applied, []
        for place, wrench in wrenches.items():
            if any(wrench):
                body = self.ids[place]
                applied[body] += wrench
                told.append(body)
        if told:
            self._tell(told)

    def _tell(self, bodies: list[int]) -> None:
        """Says which were pushed."""
        physics = self._sim.engine.physics
        physics.one_shot = True
        if physics.sleep.watches:
            for body in bodies:
                physics.changed_body(CONTROL, body)
        else:
            physics.changed(CONTROL)
