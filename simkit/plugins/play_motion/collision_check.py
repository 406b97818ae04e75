"""Check whether a robot collides with itself or its surroundings at other positions of its joints.

It is asked of a copy of the state, so that nothing moves. Within the robot every two links count that a joint of the
motion moves against each other, also where the model is not to collide with itself, but for neighbours and for links
whose shapes are in each other nearly wherever the two joints between them are. With the surroundings what counts is
what the engine would let collide. What touches already may go on touching as deep as it does: a wheel its floor, a
gripper what it holds. What is held moves along with the links that hold it.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit.pose import Pose, Vector
from simkit.runtime.contact.collision_contacts import collision_table

if TYPE_CHECKING:
    from simkit.runtime import Joint, Model, Simulation

TOLERANCE: Final = 1e-3  # [m] that the surroundings may come into a link: rounding, and what the engine lets them
SELF_TOLERANCE: Final = (
    5e-3  # [m] that links may come into each other: their shapes are simple ones around the real parts
)
_SAMPLED_POSITIONS: Final = 3  # of a joint, from one limit to the other
_ONE_AXIS: Final = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))


@dataclass(frozen=True, slots=True)
class LinkCollision:
    """Two links that come into each other.

    Attributes:
        first: a link of the robot, or what it holds.
        second: a link of the robot, or `model::link` of the surroundings.
        depth: how far they come into each other [m].
    """

    first: str
    second: str
    depth: float

    def __str__(self) -> str:
        return f"{self.first} and {self.second} come {self.depth * 1000:.3g} mm into each other"


@dataclass(frozen=True, slots=True)
class _HeldObject:
    """A free body that two or more moving links touch: it stays where it is in the body that carries them all."""

    qpos: int
    carrier: int
    pose: Pose


class CollisionCheck:
    """Asks about one robot, for a set of joints."""

    def __init__(self, sim: Simulation, robot: Model, joints: Sequence[Joint], free_joints: Collection[str]) -> None:
        """Takes up the present state.

        Args:
            sim: the simulation.
            robot: whose joints they are.
            joints: those that are to move, each of one degree of freedom.
            free_joints: plain names of joints whose links may touch each other and whatever lies loose.
        """
        self._sim, self._robot, self._joints = sim, robot, list(joints)
        self._model, self._data = sim.mj_model, mujoco.MjData(sim.mj_model)
        now = sim.engine.physics.fresh()
        for field in ("qpos", "mocap_pos", "mocap_quat"):
            getattr(self._data, field)[...] = getattr(now, field)
        self._bindings = [sim.engine.names.joint(joint.scoped) for joint in self._joints]
        self._find_parts(free_joints)
        self._held = self._find_held(now)
        self._find_loose()
        self._place(np.array([float(joint.position) for joint in self._joints]))
        self._find_pairs()
        self._standing = dict(self._contacts())

    # ------------------------------------------------------------------ what is asked

    def meeting(self, positions: Vector) -> LinkCollision | None:
        """The two links that come deepest into each other with the joints there; None where none do.

        Args:
            positions: of the joints, in their order [rad or m].
        """
        self._place(positions)
        found = [*self._within(), *self._outside()]
        return max(found, key=lambda meeting: meeting.depth, default=None)

    def _within(self) -> list[LinkCollision]:
        """Links of the robot that meet each other."""
        model, data = self._model, self._data
        places = data.geom_xpos
        apart = places[self._first] - places[self._second]
        near = np.nonzero(np.einsum("ij,ij->i", apart, apart) < self._reach2)[0]
        found = []
        for k in near:
            first, second = int(self._first[k]), int(self._second[k])
            dist = mujoco.mj_geomDistance(model, data, first, second, 0.0, None)
            if dist < self._allowed[k]:
                found.append(LinkCollision(self._name(first), self._name(second), -dist))
        return found

    def _outside(self) -> list[LinkCollision]:
        """Links of the robot, or what it holds, that meet something else."""
        found = []
        for (mine, other), dist in self._contacts():
            if dist < min(self._standing.get((mine, other), 0.0), 0.0) - TOLERANCE:
                found.append(LinkCollision(self._name(mine), self._name(other), -dist))
        return found

    # ------------------------------------------------------------------ the copy of the state

    def _place(self, positions: Vector) -> None:
        data = self._data
        for binding, value in zip(self._bindings, positions, strict=True):
            data.qpos[binding.qpos[0]] = value
            for f in binding.followers:
                data.qpos[f.qpos] = self._model.qpos0[f.qpos] + f.offset + f.ratio * value
        mujoco.mj_kinematics(self._model, data)
        if self._held:
            for one in self._held:
                carrier = Pose(data.xpos[one.carrier], data.xquat[one.carrier])
                pose = carrier @ one.pose
                data.qpos[one.qpos : one.qpos + 3], data.qpos[one.qpos + 3 : one.qpos + 7] = (
                    pose.position,
                    pose.quaternion,
                )
            mujoco.mj_kinematics(self._model, data)
        mujoco.mj_flex(self._model, data)
        mujoco.mj_collision(self._model, data)

    def _contacts(self) -> list[tuple[tuple[int, int], float]]:
        """Contacts of what moves with what is not the robot: (geom that moves, other geom), distance [m]."""
        data = self._data
        if not data.ncon:
            return []
        geoms, dist = np.array(data.contact.geom), np.array(data.contact.dist)
        found: dict[tuple[int, int], float] = {}
        for (a, b), d in zip(geoms.tolist(), dist.tolist(), strict=True):
            if b >= 0 and self._moves[b] and not self._moves[a]:
                a, b = b, a
            if a < 0 or not self._moves[a] or self._moves[b] or self._is_robot[b]:
                continue
            if self._is_free[a] and self._is_loose[b]:
                continue
            found[a, b] = min(d, found.get((a, b), d))
        return list(found.items())

    # ------------------------------------------------------------------ what there is

    def _find_parts(self, free_joints: Collection[str]) -> None:
        """Find the robot's geoms, those of them that move, and those of joints that may touch things."""
        model, sim = self._model, self._sim
        moved = {int(model.jnt_bodyid[j]) for b in self._bindings for j in b.joint_ids}
        moved |= {int(model.dof_bodyid[f.dof]) for b in self._bindings for f in b.followers}
        free = {
            int(model.jnt_bodyid[j])
            for name, joint in self._robot.joints.items()
            if name in free_joints
            for j in sim.engine.names.joint(joint.scoped).joint_ids
        }
        self._mover = np.zeros(model.nbody, dtype=int)
        is_free = np.zeros(model.nbody, dtype=bool)
        for body in range(1, model.nbody):
            parent = model.body_parentid[body]
            self._mover[body] = body if body in moved else self._mover[parent]
            is_free[body] = body in free or is_free[parent]
        found = collision_table(sim.engine.compiled)
        prefix = f"{self._robot.scoped}::"
        mine = np.array([name.startswith(prefix) for name in found.names] + [False])
        bodies = model.geom_bodyid
        # the last one stands for what is no geom
        self._is_robot = mine[found.of_geom]
        self._moves = np.append(self._is_robot[:-1] & (self._mover[bodies] > 0), False)
        self._is_free = np.append(is_free[bodies], False)

    def _find_loose(self) -> None:
        """Find the geoms of free bodies, the robot apart."""
        model = self._model
        roots = model.body_rootid[model.geom_bodyid]
        starts = np.where(model.body_jntnum > 0, model.body_jntadr, 0)
        if model.njnt:
            floats = (model.body_jntnum > 0) & (model.jnt_type[starts] == int(mujoco.mjtJoint.mjJNT_FREE))
        else:
            floats = np.zeros(model.nbody, dtype=bool)
        self._is_loose = np.append(floats[roots] & ~self._is_robot[:-1], False)

    def _find_held(self, now: mujoco.MjData) -> list[_HeldObject]:
        """Find the objects that the moving links hold: free bodies that touch two or more of them."""
        model = self._model
        touched: dict[int, set[int]] = {}
        for a, b in np.array(now.contact.geom).tolist() if now.ncon else ():
            for mine, other in ((a, b), (b, a)):
                if mine < 0 or other < 0 or not self._is_robot[mine] or self._is_robot[other]:
                    continue
                root = int(model.body_rootid[model.geom_bodyid[other]])
                touched.setdefault(root, set()).add(int(model.geom_bodyid[mine]))
        held = []
        for root, links in touched.items():
            start = int(model.body_jntadr[root])
            is_free = model.body_jntnum[root] and model.jnt_type[start] == mujoco.mjtJoint.mjJNT_FREE
            carrier = self._common(links)
            if len(links) < 2 or not is_free or not self._mover[carrier]:
                continue
            inside = Pose(now.xpos[carrier], now.xquat[carrier]).inverse() @ Pose(now.xpos[root], now.xquat[root])
            held.append(_HeldObject(int(model.jnt_qposadr[start]), carrier, inside))
            of_it = np.append(model.body_rootid[model.geom_bodyid] == root, False)
            self._moves |= of_it
        return held

    def _common(self, bodies: Collection[int]) -> int:
        """The body that carries all of these."""
        chains = []
        for body in bodies:
            chain = [body]
            while chain[-1]:
                chain.append(int(self._model.body_parentid[chain[-1]]))
            chains.append(chain)
        return next(body for body in chains[0] if all(body in chain for chain in chains))

    def _find_pairs(self) -> None:
        """Pairs of the robot's geoms that move against each other, and how deep they are in each other now."""
        model, data = self._model, self._data
        movers = self._mover[model.geom_bodyid]
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        mine = [int(g) for g in np.nonzero(self._is_robot[:-1] & collides)[0]]
        before = data.qpos.copy()
        pairs = [
            (a, b)
            for a, b in combinations(mine, 2)
            if movers[a] != movers[b] and not (self._is_free[a] and self._is_free[b]) and not self._belong(a, b)
        ]
        data.qpos[...] = before
        mujoco.mj_kinematics(model, data)
        self._first, self._second = np.array(pairs, dtype=int).reshape(-1, 2).T
        self._reach2 = (model.geom_rbound[self._first] + model.geom_rbound[self._second]) ** 2
        now = [mujoco.mj_geomDistance(model, data, a, b, 0.0, None) for a, b in pairs]
        self._allowed = np.minimum(np.array(now, dtype=float), 0.0) - SELF_TOLERANCE

    def _belong(self, first: int, second: int) -> bool:
        """Check whether two geoms touch by design: their links share a joint, or two joints and nearly always touch."""
        model = self._model
        a, b = (int(model.body_weldid[model.geom_bodyid[g]]) for g in (first, second))
        up_a, up_b = self._above(a), self._above(b)
        if a in (b, up_b) or b == up_a:
            return True
        if a == self._above(up_b):
            return self._mostly_meet(first, second, (b, up_b))
        if b == self._above(up_a):
            return self._mostly_meet(first, second, (a, up_a))
        return up_a == up_b and self._mostly_meet(first, second, (a, b))

    def _mostly_meet(self, first: int, second: int, bodies: tuple[int, int]) -> bool:
        """Check whether two geoms come into each other at most of the places of the two joints that join them."""
        model, data = self._model, self._data
        joints = [j for body in bodies for j in self._joints_of(body)]
        if len(joints) != 2 or any(model.jnt_type[j] not in _ONE_AXIS for j in joints):
            return False
        ends = [tuple(model.jnt_range[j]) if model.jnt_limited[j] else (-np.pi, np.pi) for j in joints]
        meet = 0
        for places in product(*(np.linspace(low, high, _SAMPLED_POSITIONS) for low, high in ends)):
            data.qpos[model.jnt_qposadr[joints]] = places
            mujoco.mj_kinematics(model, data)
            meet += mujoco.mj_geomDistance(model, data, first, second, 0.0, None) < -SELF_TOLERANCE
        return bool(2 * meet > _SAMPLED_POSITIONS**2)

    def _joints_of(self, body: int) -> range:
        start = int(self._model.body_jntadr[body])
        return range(start, start + int(self._model.body_jntnum[body]))

    def _above(self, body: int) -> int:
        return int(self._model.body_weldid[self._model.body_parentid[body]])

    def _name(self, geom: int) -> str:
        link, scoped, _ = self._sim.engine.names.geom_owner(geom)
        name = link or scoped or f"geom {geom}"
        return str(name).removeprefix(f"{self._robot.scoped}::")
