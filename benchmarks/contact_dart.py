"""DART as one of the engines of `contact.py`: its default solver, Bullet's collision detector."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import dartpy
import numpy as np
import numpy.typing as npt
from contact_engines import NOT_ASKED, UnsupportedCaseError, check_supported, quaternion
from contact_scene import GROUND, Body, Case, Pair, Shape

KINDS = {"box", "sphere", "cylinder", "capsule"}
SLAB = (20.0, 20.0, 0.5)  # half lengths of the ground, because the detectors differ in planes [m]


class DART:
    """A case of free bodies in a `World`."""

    def __init__(self, case: Case, folder: Path) -> None:
        check_supported(case, KINDS, "DART")
        self.case = case
        self.world = dartpy.simulation.World()
        self.world.setTimeStep(case.timestep)
        self.world.setGravity([0.0, 0.0, -case.gravity])
        self.world.setCollisionDetector(dartpy.simulation.CollisionDetectorType.BULLET)
        if case.ground == "plane":
            shape = Shape("box", SLAB)
            self._add(Body(GROUND, shape, 1.0, (0.0, 0.0, -SLAB[2]), mu=case.ground_mu), is_static=True)
        for block in case.blocks:
            self._add(block, is_static=True)
        self.bodies = [self._add(body) for body in case.bodies]

    def _add(self, body: Body, *, is_static: bool = False) -> Any:
        skeleton = dartpy.dynamics.Skeleton(body.name)
        joint, node = skeleton.createFreeJointAndBodyNodePair()
        pose = np.eye(4)
        pose[:3, :3] = _matrix(quaternion(body.rpy))
        pose[:3, 3] = body.position
        inertia = np.diag(body.inertia)
        node.setInertia(dartpy.dynamics.Inertia(body.mass, np.zeros(3), inertia))
        shape = node.createShapeNode(self._shape(body.shape))
        shape.createCollisionAspect()
        shape.createDynamicsAspect()
        shape.getDynamicsAspect().setFrictionCoeff(body.mu)
        shape.getDynamicsAspect().setRestitutionCoeff(0.0)
        joint.setTransform(dartpy.math.Isometry3(pose))
        if is_static:
            skeleton.setMobile(False)
        self.world.addSkeleton(skeleton)
        return joint, node, skeleton

    def _shape(self, shape: Shape) -> Any:
        size, dynamics = shape.size, dartpy.dynamics
        if shape.kind == "box":
            return dynamics.BoxShape([2 * half for half in size])
        if shape.kind == "sphere":
            return dynamics.SphereShape(size[0])
        if shape.kind in {"cylinder", "capsule"}:
            return {"cylinder": dynamics.CylinderShape, "capsule": dynamics.CapsuleShape}[shape.kind](
                size[0], 2 * size[1]
            )
        raise UnsupportedCaseError(shape.kind)

    def settle(self, count: int) -> None:
        self.advance(count)

    def start(self) -> None:
        for (joint, _, _), body in zip(self.bodies, self.case.bodies, strict=True):
            if any(body.linear) or any(body.angular):
                joint.setLinearVelocity(body.linear)
                joint.setAngularVelocity(body.angular)
        self._start = [(s.getPositions().copy(), s.getVelocities().copy()) for _, _, s in self.bodies]

    def advance(self, count: int) -> None:
        for _ in range(count):
            self.world.step()

    def rewind(self) -> None:
        for (_, _, skeleton), (positions, velocities) in zip(self.bodies, self._start, strict=True):
            skeleton.setPositions(positions)
            skeleton.setVelocities(velocities)

    def state(self) -> npt.NDArray[np.float64]:
        rows = []
        for _, node, _ in self.bodies:
            pose = node.getTransform().matrix()
            turn = _quaternion(pose[:3, :3])
            rows.append((*pose[:3, 3], *turn, *node.getLinearVelocity(), *node.getAngularVelocity()))
        return np.array(rows)

    def pressed(self) -> set[Pair]:
        return set()

    def asleep(self) -> float:
        return NOT_ASKED

    def has_diverged(self) -> bool:
        return not all(np.isfinite(skeleton.getPositions()).all() for _, _, skeleton in self.bodies)

    def close(self) -> None:
        """Nothing is held."""


def _matrix(turn: Sequence[float]) -> npt.NDArray[np.float64]:
    from simkit.pose import quat_to_matrix

    return np.asarray(quat_to_matrix(turn))


def _quaternion(matrix: npt.NDArray[np.float64]) -> tuple[float, ...]:
    from scipy.spatial.transform import Rotation

    x, y, z, w = Rotation.from_matrix(matrix).as_quat()
    return w, x, y, z
