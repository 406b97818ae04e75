"""Check whether a robot would collide with itself or with its surroundings at other joint positions.

The check uses a copy of the state, so the simulation does not change. The rules are:

- Two links of the robot are checked if a joint of the motion moves one link relative to the other, even if the model
  disables self-collision. Two links with a common joint are not checked. Two links with two joints between them are not
  checked if their shapes overlap at most positions of these joints.
- A link and an object of the surroundings are checked if the engine's collision filters allow the pair.
- Existing contacts are allowed up to their present depth, such as a wheel on the floor or an object in a gripper.
- An object in a gripper moves with the links that touch the object.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit import Pose
from simkit.extend import Vector
from simkit.runtime.contact.collision_contacts import Ints, collision_table

if TYPE_CHECKING:
    from simkit import Joint, Model, Simulation

TOLERANCE: Final = 1e-3  # [m], allowed overlap with the surroundings, because contacts of the engine are soft
SELF_TOLERANCE: Final = 5e-3  # [m], allowed overlap of two links: collision shapes are larger than the real links
_SAMPLED_POSITIONS: Final = 3  # number of sampled positions of a joint, from the lower to the upper limit
_ONE_AXIS: Final = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))


@dataclass(frozen=True, slots=True)
class LinkCollision:
    """Collision of two links.

    Attributes:
        first: Name of a link of the robot or of a held object.
        second: Name of a link of the robot, or `model::link` of the surroundings.
        depth: Penetration depth [m].
    """

    first: str
    second: str
    depth: float

    def __str__(self) -> str:
        return f"{self.first} and {self.second} overlap by {self.depth * 1000:.3g} mm"


@dataclass(frozen=True, slots=True)
class _HeldObject:
    """Free body in contact with two or more moving links.

    Attributes:
        joint: Free joint of the body.
        qpos: Index of the body's position in `qpos`.
        carrier: Nearest body that carries all these links.
        pose: Pose of the free body in the frame of `carrier`; the check keeps it constant.
    """

    joint: int
    qpos: int
    carrier: int
    pose: Pose


class CollisionCheck:
    """Collision check of one robot for other positions of some of its joints."""

    def __init__(self, sim: Simulation, robot: Model, joints: Sequence[Joint], free_joints: Collection[str]) -> None:
        """Copy the present state and find the pairs of geoms to check.

        Args:
            sim: Simulation of the robot.
            robot: Robot that owns the joints.
            joints: Joints that move, each with one degree of freedom.
            free_joints: Plain names of joints whose links may touch each other and free bodies, such as grippers.
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
        self._set_positions(np.array([float(joint.position) for joint in self._joints]))
        self._find_pairs()
        self._initial_contacts = dict(self._contacts())

    # ------------------------------------------------------------------ queries

    @property
    def self_pairs(self) -> list[tuple[int, int]]:
        """Pairs of geoms of the robot that must not touch."""
        return list(zip(self._first.tolist(), self._second.tolist(), strict=True))

    @property
    def robot_geoms(self) -> Ints:
        """Geoms of the robot."""
        return np.nonzero(self._is_robot[:-1])[0]

    @property
    def held_geoms(self) -> dict[int, int]:
        """Geoms of the objects in a gripper, each with the body of the robot that carries it."""
        roots = self._model.body_rootid[self._model.geom_bodyid]
        carriers = {int(self._model.dof_bodyid[self._model.jnt_dofadr[h.joint]]): h.carrier for h in self._held}
        return {geom: carriers[root] for geom, root in enumerate(roots.tolist()) if root in carriers}

    def deepest_collision(self, positions: Vector) -> LinkCollision | None:
        """Return the collision with the largest depth at these joint positions; None without a collision.

        Args:
            positions: Position of each joint [rad or m], in the order of the joints.
        """
        self._set_positions(positions)
        collisions = [*self._self_collisions(), *self._outside_collisions()]
        return max(collisions, key=lambda collision: collision.depth, default=None)

    def _self_collisions(self) -> list[LinkCollision]:
        """Return the collisions between links of the robot."""
        model, data = self._model, self._data
        places = data.geom_xpos
        apart = places[self._first] - places[self._second]
        near = np.nonzero(np.einsum("ij,ij->i", apart, apart) < self._reach2)[0]
        collisions = []
        for k in near:
            first, second = int(self._first[k]), int(self._second[k])
            dist = mujoco.mj_geomDistance(model, data, first, second, 0.0, None)
            if dist < self._allowed[k]:
                collisions.append(LinkCollision(self._name(first), self._name(second), -dist))
        return collisions

    def _outside_collisions(self) -> list[LinkCollision]:
        """Return the collisions of the robot, or of an object in its gripper, with the surroundings."""
        collisions = []
        for (mine, other), dist in self._contacts():
            if dist < min(self._initial_contacts.get((mine, other), 0.0), 0.0) - TOLERANCE:
                collisions.append(LinkCollision(self._name(mine), self._name(other), -dist))
        return collisions

    # ------------------------------------------------------------------ the copy of the state

    def _set_positions(self, positions: Vector) -> None:
        data = self._data
        for binding, value in zip(self._bindings, positions, strict=True):
            data.qpos[binding.qpos[0]] = value
            for f in binding.followers:
                data.qpos[f.qpos] = self._model.qpos0[f.qpos] + f.offset + f.ratio * value
        mujoco.mj_kinematics(self._model, data)
        if self._held:
            for item in self._held:
                carrier = Pose(data.xpos[item.carrier], data.xquat[item.carrier])
                pose = carrier @ item.pose
                data.qpos[item.qpos : item.qpos + 3], data.qpos[item.qpos + 3 : item.qpos + 7] = (
                    pose.position,
                    pose.quaternion,
                )
            mujoco.mj_kinematics(self._model, data)
        mujoco.mj_flex(self._model, data)
        mujoco.mj_collision(self._model, data)

    def _contacts(self) -> list[tuple[tuple[int, int], float]]:
        """Return the contacts between moving geoms and the surroundings.

        Each item is ((moving geom, other geom), distance [m]); the distance is negative for an overlap.
        """
        data = self._data
        if not data.ncon:
            return []
        geoms, dist = np.array(data.contact.geom), np.array(data.contact.dist)
        depths: dict[tuple[int, int], float] = {}
        for (a, b), d in zip(geoms.tolist(), dist.tolist(), strict=True):
            if b >= 0 and self._moves[b] and not self._moves[a]:
                a, b = b, a
            if a < 0 or not self._moves[a] or self._moves[b] or self._is_robot[b]:
                continue
            if self._is_free[a] and self._is_loose[b]:
                continue
            depths[a, b] = min(d, depths.get((a, b), d))
        return list(depths.items())

    # ------------------------------------------------------------------ preparation

    def _find_parts(self, free_joints: Collection[str]) -> None:
        """Find the robot's geoms, the geoms that the joints of the motion move, and the geoms of the free joints."""
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
        table = collision_table(sim.engine.compiled)
        prefix = f"{self._robot.scoped}::"
        mine = np.array([name.startswith(prefix) for name in table.names] + [False])
        bodies = model.geom_bodyid
        # the arrays have one entry more than geoms, because index -1 means "no geom"
        self._is_robot = mine[table.of_geom]
        self._moves = np.append(self._is_robot[:-1] & (self._mover[bodies] > 0), False)
        self._is_free = np.append(is_free[bodies], False)

    def _find_loose(self) -> None:
        """Find the geoms of free bodies outside the robot."""
        model = self._model
        roots = model.body_rootid[model.geom_bodyid]
        starts = np.where(model.body_jntnum > 0, model.body_jntadr, 0)
        if model.njnt:
            floats = (model.body_jntnum > 0) & (model.jnt_type[starts] == int(mujoco.mjtJoint.mjJNT_FREE))
        else:
            floats = np.zeros(model.nbody, dtype=bool)
        self._is_loose = np.append(floats[roots] & ~self._is_robot[:-1], False)

    def _find_held(self, now: mujoco.MjData) -> list[_HeldObject]:
        """Find the objects in a gripper: free bodies in contact with two or more moving links."""
        model = self._model
        touched: dict[int, set[int]] = {}
        for a, b in np.array(now.contact.geom).tolist() if now.ncon else ():
            for mine, other in ((a, b), (b, a)):
                if mine < 0 or other < 0 or not self._is_robot[mine] or self._is_robot[other]:
                    continue
                root = int(model.body_rootid[model.geom_bodyid[other]])
                touched.setdefault(root, set()).add(int(model.geom_bodyid[mine]))
        objects = []
        for root, links in touched.items():
            start = int(model.body_jntadr[root])
            is_free = model.body_jntnum[root] and model.jnt_type[start] == mujoco.mjtJoint.mjJNT_FREE
            carrier = self._common_carrier(links)
            if len(links) < 2 or not is_free or not self._mover[carrier]:
                continue
            inside = Pose(now.xpos[carrier], now.xquat[carrier]).inverse() @ Pose(now.xpos[root], now.xquat[root])
            objects.append(_HeldObject(start, int(model.jnt_qposadr[start]), carrier, inside))
            of_it = np.append(model.body_rootid[model.geom_bodyid] == root, False)
            self._moves |= of_it
        return objects

    def _common_carrier(self, bodies: Collection[int]) -> int:
        """Return the nearest body in the kinematic tree that carries all these bodies, or is one of them."""
        chains = []
        for body in bodies:
            chain = [body]
            while chain[-1]:
                chain.append(int(self._model.body_parentid[chain[-1]]))
            chains.append(chain)
        return next(body for body in chains[0] if all(body in chain for chain in chains))

    def _find_pairs(self) -> None:
        """Find the pairs of the robot's geoms that move relative to each other, and the allowed depth of each pair."""
        model, data = self._model, self._data
        movers = self._mover[model.geom_bodyid]
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        mine = [int(g) for g in np.nonzero(self._is_robot[:-1] & collides)[0]]
        before = data.qpos.copy()
        pairs = [
            (a, b)
            for a, b in combinations(mine, 2)
            if movers[a] != movers[b]
            and not (self._is_free[a] and self._is_free[b])
            and not self._may_always_touch(a, b)
        ]
        data.qpos[...] = before
        mujoco.mj_kinematics(model, data)
        self._first, self._second = np.array(pairs, dtype=int).reshape(-1, 2).T
        self._reach2 = (model.geom_rbound[self._first] + model.geom_rbound[self._second]) ** 2
        now = [mujoco.mj_geomDistance(model, data, a, b, 0.0, None) for a, b in pairs]
        self._allowed = np.minimum(np.array(now, dtype=float), 0.0) - SELF_TOLERANCE

    def _may_always_touch(self, first: int, second: int) -> bool:
        """Check whether two geoms of the robot may always touch.

        This is the case if one joint connects their links, or if two joints connect them and the geoms overlap at most
        positions of these joints.
        """
        model = self._model
        a, b = (int(model.body_weldid[model.geom_bodyid[g]]) for g in (first, second))
        up_a, up_b = self._above(a), self._above(b)
        if a in (b, up_b) or b == up_a:
            return True
        if a == self._above(up_b):
            return self._mostly_overlap(first, second, (b, up_b))
        if b == self._above(up_a):
            return self._mostly_overlap(first, second, (a, up_a))
        return up_a == up_b and self._mostly_overlap(first, second, (a, b))

    def _mostly_overlap(self, first: int, second: int, bodies: tuple[int, int]) -> bool:
        """Check whether two geoms overlap at more than half of the sampled positions of the two joints between them."""
        model, data = self._model, self._data
        joints = [j for body in bodies for j in self._joints_of(body)]
        if len(joints) != 2 or any(model.jnt_type[j] not in _ONE_AXIS for j in joints):
            return False
        ends = [tuple(model.jnt_range[j]) if model.jnt_limited[j] else (-np.pi, np.pi) for j in joints]
        overlap_count = 0
        for places in product(*(np.linspace(low, high, _SAMPLED_POSITIONS) for low, high in ends)):
            data.qpos[model.jnt_qposadr[joints]] = places
            mujoco.mj_kinematics(model, data)
            overlap_count += mujoco.mj_geomDistance(model, data, first, second, 0.0, None) < -SELF_TOLERANCE
        return bool(2 * overlap_count > _SAMPLED_POSITIONS**2)

    def _joints_of(self, body: int) -> range:
        start = int(self._model.body_jntadr[body])
        return range(start, start + int(self._model.body_jntnum[body]))

    def _above(self, body: int) -> int:
        return int(self._model.body_weldid[self._model.body_parentid[body]])

    def _name(self, geom: int) -> str:
        link, scoped, _ = self._sim.engine.names.geom_owner(geom)
        name = link or scoped or f"geom {geom}"
        return str(name).removeprefix(f"{self._robot.scoped}::")
