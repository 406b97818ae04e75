"""Kinematic and collision model of a group of joints, built from the compiled world for one request.

The joints of the group move; all other joints of the robot keep their positions. The model is one of Pinocchio, and its
collision shapes are those of MuJoCo's geoms.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit import Pose
from simkit.extend import Vector
from simkit.linear_algebra import matmul, norm
from simkit_motion.plugins.move_group.collision_shapes import shape_of_geom
from simkit_motion.plugins.move_group.state_copy import copied_state, link_pose_at, quaternion_of, se3
from simkit_motion.plugins.play_motion.collision_check import SELF_TOLERANCE, CollisionCheck

if TYPE_CHECKING:
    from coal import CollisionGeometry
    from pinocchio import SE3

    from simkit import Joint, Model, Simulation
    from simkit.compiler.name_map import JointBinding

SELF_MARGIN: Final = 2e-3  # [m] between two links of the robot: shapes of wrists are 9 mm apart at the joint limits
_CONTACT: Final = 1e-3  # [m], distance by which the margin of a pair stays below its distance at the start


@dataclass(frozen=True, eq=False)
class Obstacle:
    """Shape that the group must not touch.

    Attributes:
        name: Name in messages.
        shape: Shape of the package `coal`.
        pose: Pose in the world, or in the frame of `link`.
        link: Scoped name of the link that carries the shape; empty for a shape that does not move.
        touches: Names of links and objects that may touch the shape.
    """

    name: str
    shape: CollisionGeometry
    pose: Pose
    link: str = ""
    touches: frozenset[str] = frozenset()


class GroupModel:
    """Model of a group of joints at one state of the robot and its surroundings.

    Attributes:
        joints: Joints of the group.
        lower: Lower limit of each joint [rad or m]; -inf without a limit.
        upper: Upper limit of each joint [rad or m].
        levers: Largest distance that any point of the moving links travels while a joint moves by one unit
            [m/rad or 1]. A motion dq moves no point further than `levers @ abs(dq)`.
        start: Position of each joint in the start state [rad or m].
    """

    def __init__(
        self, sim: Simulation, robot: Model, joints: Sequence[Joint], state: Mapping[str, float], free: Collection[str]
    ) -> None:
        """Copy the state of the simulation and build the kinematic model.

        Args:
            sim: Simulation of the robot.
            robot: Robot that owns the joints.
            joints: Joints of the group, each with one degree of freedom.
            state: Positions of joints that differ from the present ones [rad or m], by plain name.
            free: Plain names of joints whose links may touch each other, such as fingers.
        """
        import pinocchio

        self._pin = pinocchio
        self._sim, self._robot, self.joints = sim, robot, list(joints)
        self._check = CollisionCheck(sim, robot, joints, free)
        self._mj = sim.mj_model
        self._data = copied_state(sim, robot, state, self._check.held_geoms)
        bindings = [sim.engine.names.joint(joint.scoped) for joint in joints]
        self.start = np.array([self._data.qpos[b.qpos[0]] for b in bindings])
        ranges = [self._mj.jnt_range[b.joint_ids[0]] for b in bindings]
        limited = [bool(self._mj.jnt_limited[b.joint_ids[0]]) for b in bindings]
        self.lower = np.array([r[0] if known else -np.inf for r, known in zip(ranges, limited, strict=True)])
        self.upper = np.array([r[1] if known else np.inf for r, known in zip(ranges, limited, strict=True)])
        self._build_joints(bindings)
        self._geometry = pinocchio.GeometryModel()
        self._pairs: list[tuple[str, str]] = []
        self.levers = np.zeros(len(joints))

    # ------------------------------------------------------------------ kinematics

    def _build_joints(self, bindings: Sequence[JointBinding]) -> None:
        """Add a joint to the kinematic model for each axis that the group moves, also for joints that mimic one."""
        pin, mj = self._pin, self._mj
        rules = {b.joint_ids[0]: (k, 1.0, 0.0) for k, b in enumerate(bindings)}
        for k, binding in enumerate(bindings):
            for f in binding.followers:
                joint = int(mj.dof_jntid[f.dof])
                rules.setdefault(joint, (k, f.ratio, mj.qpos0[f.qpos] + f.offset))
        self._model, self._mover = pin.Model(), np.zeros(mj.nbody, dtype=int)
        self._frames = [pin.SE3.Identity()]  # frame of each joint of the model in the world, in the start state
        self._mj_joints: list[int] = []
        rows, offsets = [], []
        for body in range(1, mj.nbody):
            self._mover[body] = self._mover[mj.body_parentid[body]]
            first = int(mj.body_jntadr[body])
            for joint in range(first, first + int(mj.body_jntnum[body])):
                if joint not in rules:
                    continue
                k, ratio, offset = rules[joint]
                self._mover[body] = self._add_joint(int(self._mover[body]), joint)
                row = np.zeros(len(bindings))
                row[k] = ratio
                rows.append(row)
                offsets.append(offset)
        self._ratios, self._offsets = np.array(rows).reshape(-1, len(bindings)), np.array(offsets)
        self._pin_data = self._model.createData()

    def _add_joint(self, parent: int, joint: int) -> int:
        """Add a joint of MuJoCo to the kinematic model and return its number there."""
        pin, axis = self._pin, np.array(self._data.xaxis[joint])
        q = float(self._data.qpos[self._mj.jnt_qposadr[joint]])
        frame = pin.SE3(np.eye(3), np.array(self._data.xanchor[joint]))
        if self._mj.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE:
            kind, motion = pin.JointModelRevoluteUnaligned(axis), pin.SE3(pin.exp3(axis * q), np.zeros(3))
        else:
            kind, motion = pin.JointModelPrismaticUnaligned(axis), pin.SE3(np.eye(3), axis * q)
        placement = self._frames[parent].actInv(frame * motion.inverse())
        self._frames.append(frame)
        self._mj_joints.append(joint)
        return int(self._model.addJoint(parent, kind, placement, f"joint_{joint}"))

    def tip(self, link: str) -> tuple[int, SE3]:
        """Return the joint of the model that moves a link, and the pose of the link in the frame of this joint."""
        binding = self._sim.engine.names.link(link)
        return self._place(binding.body, self._body_pose(binding.body) @ binding.offset)

    def _body_pose(self, body: int) -> Pose:
        return Pose(self._data.xpos[body], self._data.xquat[body])

    def _place(self, body: int, pose: Pose) -> tuple[int, SE3]:
        mover = int(self._mover[body])
        return mover, self._frames[mover].actInv(se3(pose))

    def pose_and_jacobian(self, tip: tuple[int, SE3], q: Vector) -> tuple[SE3, Vector]:
        """Return the pose of a tip in the world, and its Jacobian in its own axes, shape (6, joints).

        The rows of the Jacobian are the linear and then the angular velocity for each joint velocity.
        """
        pin, model, data = self._pin, self._model, self._pin_data
        positions = matmul(self._ratios, q) + self._offsets
        pin.computeJointJacobians(model, data, positions)
        joint, offset = tip
        if joint == 0:
            return offset, np.zeros((6, len(q)))
        jacobian = pin.getJointJacobian(model, data, joint, pin.ReferenceFrame.LOCAL)
        return data.oMi[joint] * offset, matmul(offset.inverse().action, jacobian, self._ratios)

    # ------------------------------------------------------------------ collisions

    def add_collisions(
        self, margin: float, world: bool, obstacles: Sequence[Obstacle], allowed: Collection[frozenset[str]] = ()
    ) -> None:
        """Build the collision model.

        Args:
            margin: Distance to keep between two shapes [m]; a pair that is nearer at the start keeps its distance.
            world: True if the collisions of the other models are obstacles.
            obstacles: Further obstacles.
            allowed: Pairs of names of links, models or objects that may touch; a single name may touch everything.
        """
        self._margin = margin
        names = self._geom_names()
        placed = {geom: self._add_geom(geom, names[geom], shape) for geom, shape in self._geoms()}
        carried = self._check.held_geoms
        mine = [*placed]
        moving = [(i, names[g]) for g, i in placed.items() if self._mover_of(g, carried)]
        shape_names = {i: names[g] for g, i in placed.items()}
        pairs = [(placed[a], placed[b]) for a, b in self._check.self_pairs if a in placed and b in placed]
        for a in (g for g in mine if g in carried):  # an object in the gripper and the links that do not hold it
            touched = self._touched_by(a)
            pairs += [
                (placed[a], placed[b])
                for b in mine
                if b not in carried and self._mover_of(b, carried) != self._mover_of(a, carried) and b not in touched
            ]
        self._set_levers([i for i, _ in moving])
        if world:
            for geom, shape in self._surroundings(mine):
                index = self._add_geom(geom, names[geom], shape)
                shape_names[index] = names[geom]
                pairs += [(i, index) for i, _ in moving]
        for obstacle in obstacles:
            if not obstacle.link and not self._is_in_reach(obstacle):
                continue
            pairs += self._add_obstacle(obstacle, shape_names, moving)
        short = {i: _own_names(name) for i, name in shape_names.items()}
        if allowed:
            pairs = [(a, b) for a, b in pairs if not _is_allowed(short[a], short[b], allowed)]
        for a, b in pairs:
            self._geometry.addCollisionPair(self._pin.CollisionPair(a, b))
        self._pairs = [(shape_names[a], shape_names[b]) for a, b in pairs]
        self._geometry_data = self._geometry.createData()
        of_robot = set(placed.values())
        self._set_margins([SELF_MARGIN if a in of_robot and b in of_robot else margin for a, b in pairs])
        # a tree of bounding boxes takes a quarter of the time of a check of all pairs, for TIAGo at a table
        make = self._pin.BroadPhaseManager_DynamicAABBTreeCollisionManager
        self._tree = make(self._model, self._geometry, self._geometry_data)

    def _geoms(self) -> list[tuple[int, CollisionGeometry]]:
        """Return the geoms of the robot and of held objects that can collide, with their shapes."""
        collides = (self._mj.geom_contype | self._mj.geom_conaffinity) != 0
        return self._with_shapes(int(g) for g in (*self._check.robot_geoms, *self._check.held_geoms) if collides[g])

    def _with_shapes(self, geoms: Iterable[int]) -> list[tuple[int, CollisionGeometry]]:
        """Return geoms with their shapes, without those of a kind that has no shape."""
        shapes = ((geom, shape_of_geom(self._mj, geom)) for geom in geoms)
        return [(geom, shape) for geom, shape in shapes if shape is not None]

    def _mover_of(self, geom: int, held: Mapping[int, int]) -> int:
        return int(self._mover[held.get(geom, self._mj.geom_bodyid[geom])])

    def _touched_by(self, geom: int) -> set[int]:
        """Return the geoms that touch a held object in the present state."""
        data, root = self._sim.engine.physics.fresh(), self._mj.body_rootid[self._mj.geom_bodyid[geom]]
        touched = set()
        for a, b in np.array(data.contact.geom).tolist() if data.ncon else ():
            for carried, other in ((a, b), (b, a)):
                if carried >= 0 and other >= 0 and self._mj.body_rootid[self._mj.geom_bodyid[carried]] == root:
                    touched.add(int(other))
        return touched

    def _add_geom(self, geom: int, name: str, shape: CollisionGeometry) -> int:
        pose = Pose(self._data.geom_xpos[geom], quaternion_of(self._data.geom_xmat[geom]))
        carried = self._check.held_geoms
        joint, placement = self._place(carried.get(geom, int(self._mj.geom_bodyid[geom])), pose)
        return self._add_shape(name, joint, placement, shape)

    def _add_shape(self, name: str, joint: int, placement: SE3, shape: CollisionGeometry) -> int:
        number = len(self._geometry.geometryObjects)
        shape.computeLocalAABB()
        item = self._pin.GeometryObject(f"{number} {name}", joint, placement, shape)
        return int(self._geometry.addGeometryObject(item))

    def _add_obstacle(
        self, obstacle: Obstacle, names: dict[int, str], moving: Sequence[tuple[int, str]]
    ) -> list[tuple[int, int]]:
        """Add an obstacle, and return its pairs with the moving links or, if it is attached, with everything else."""
        joint, placement = 0, se3(obstacle.pose)
        if obstacle.link:
            body = self._sim.engine.names.link(obstacle.link).body
            joint, placement = self._place(body, link_pose_at(self._sim, self._data, obstacle.link) @ obstacle.pose)
        others = [i for i in names if self._geometry.geometryObjects[i].parentJoint != joint] if joint else None
        index = self._add_shape(obstacle.name, joint, placement, obstacle.shape)
        pairs = [(index, i) for i in (others if others is not None else [i for i, _ in moving])]
        free_pairs = [(i, k) for i, k in pairs if not obstacle.touches.intersection(_own_names(names[k]))]
        names[index] = obstacle.name
        return free_pairs

    def _surroundings(self, mine: Collection[int]) -> list[tuple[int, CollisionGeometry]]:
        """Return the geoms of other models that the group can reach, with their shapes."""
        mj, of_robot = self._mj, set(mine) | set(self._check.robot_geoms.tolist())
        collides = (mj.geom_contype | mj.geom_conaffinity) != 0
        reach = float(self._reach)
        centre = self._frames[1].translation if len(self._frames) > 1 else np.zeros(3)
        away = np.linalg.norm(self._data.geom_xpos - centre, axis=1) - mj.geom_rbound
        near = (away < reach) | (mj.geom_rbound <= 0)
        return self._with_shapes(int(g) for g in np.nonzero(collides & near)[0] if int(g) not in of_robot)

    def _is_in_reach(self, obstacle: Obstacle) -> bool:
        obstacle.shape.computeLocalAABB()
        if not np.isfinite(obstacle.shape.aabb_radius):
            return True
        centre = self._frames[1].translation if len(self._frames) > 1 else np.zeros(3)
        away = norm(se3(obstacle.pose).act(obstacle.shape.aabb_center) - centre)
        return away < self._reach + float(obstacle.shape.aabb_radius)

    def _set_levers(self, moving: Sequence[int]) -> None:
        """Compute the levers and the reach of the group: upper bounds for all positions of the joints."""
        model, count = self._model, len(self._mj_joints) + 1
        parents = [int(p) for p in model.parents]
        strokes = [0.0] * count
        for number, joint in enumerate(self._mj_joints, start=1):
            if self._mj.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE:
                strokes[number] = float(np.abs(self._mj.jnt_range[joint]).max()) if self._mj.jnt_limited[joint] else 1e3
        reach = [0.0] * count  # from the origin of each joint to the farthest point of the shapes that it carries
        for i in moving:
            item = self._geometry.geometryObjects[i]
            box = item.geometry
            length = norm(item.placement.act(box.aabb_center)) + box.aabb_radius
            reach[item.parentJoint] = max(reach[item.parentJoint], float(length))
        for number in range(count - 1, 0, -1):
            step = norm(model.jointPlacements[number].translation) + strokes[number]
            parent = parents[number]
            if parent:
                reach[parent] = max(reach[parent], reach[number] + step)
        levers = np.array(
            [
                1.0 if self._mj.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE else reach[number]
                for number, joint in enumerate(self._mj_joints, start=1)
            ]
        )
        self.levers = matmul(np.abs(self._ratios).T, levers)
        roots = [number for number in range(1, count) if not parents[number]]
        origin = self._frames[1].translation if count > 1 else np.zeros(3)
        away = [norm(self._frames[r].translation - origin) + strokes[r] + reach[r] for r in roots]
        self._reach = max(away, default=0.0) + self._margin

    def _set_margins(self, margins: Sequence[float]) -> None:
        """Set the margin of each pair, smaller for pairs that are nearer in the start state."""
        pin, requests = self._pin, self._geometry_data.collisionRequests
        for request, margin in zip(requests, margins, strict=True):
            request.security_margin = margin
        self._collide(self.start)
        near = [k for k, result in enumerate(self._geometry_data.collisionResults) if result.isCollision()]
        for k in near:
            distance = float(pin.computeDistance(self._geometry, self._geometry_data, k).min_distance)
            if distance > -SELF_TOLERANCE:
                requests[k].security_margin = min(margins[k], distance - _CONTACT)

    def _collide(self, q: Vector) -> None:
        """Check all pairs at these joint positions."""
        pin, positions = self._pin, self._own(q)
        pin.computeCollisions(self._model, self._pin_data, self._geometry, self._geometry_data, positions, False)

    def _own(self, q: Vector) -> Vector:
        positions: Vector = matmul(self._ratios, q) + self._offsets
        return positions

    def is_free(self, q: Vector) -> bool:
        """Check whether nothing collides at these joint positions [rad or m]."""
        return not self._pin.computeCollisions(self._model, self._pin_data, self._tree, self._own(q), True)

    def collisions(self, q: Vector) -> list[tuple[str, str]]:
        """Return the names of the colliding pairs at these joint positions [rad or m]."""
        self._collide(q)
        results = zip(self._pairs, self._geometry_data.collisionResults, strict=True)
        return list(dict.fromkeys(pair for pair, result in results if result.isCollision()))

    @property
    def pair_count(self) -> int:
        """Number of pairs of shapes that are checked."""
        return len(self._pairs)

    def _geom_names(self) -> list[str]:
        names, prefix = [], f"{self._robot.scoped}::"
        for geom in range(self._mj.ngeom):
            link, scoped, _ = self._sim.engine.names.geom_owner(geom)
            names.append(str(link or scoped or f"geom {geom}").removeprefix(prefix))
        return names


def _is_allowed(first: Sequence[str], second: Sequence[str], allowed: Collection[frozenset[str]]) -> bool:
    """Check whether two shapes with these names may touch."""
    singles = any(frozenset((name,)) in allowed for name in (*first, *second))
    return singles or any(frozenset((a, b)) in allowed for a in first for b in second)


def _own_names(name: str) -> tuple[str, ...]:
    """Return the names that select a shape: the link, and for `model::link` also the model."""
    return (name, name.split("::")[0]) if "::" in name else (name,)
