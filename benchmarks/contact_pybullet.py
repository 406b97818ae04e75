"""PyBullet as one of the engines of `contact.py`: its defaults, without sleep, damping and rolling friction."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pybullet
from contact_engines import NOT_ASKED, UnsupportedCaseError
from contact_scene import GROUND, LATERAL, Body, Case, Pair, Shape
from contact_sdf import CELLS, SLAB, mesh, slab

DRIVE_LIMIT = 1e4  # greatest torque of a wheel's velocity motor [N·m]


class PyBullet:
    """A case in PyBullet (`pybullet.DIRECT`)."""

    def __init__(self, case: Case, folder: Path) -> None:
        self.case = case
        self.client = pybullet.connect(pybullet.DIRECT)
        try:
            self._build(case)
        except BaseException:
            self.close()
            raise

    def _build(self, case: Case) -> None:
        pybullet.setGravity(0, 0, -case.gravity, physicsClientId=self.client)
        options = {"fixedTimeStep": case.timestep, "restitutionVelocityThreshold": 0.01}
        pybullet.setPhysicsEngineParameter(**options, physicsClientId=self.client)
        self.names: dict[tuple[int, int], str] = {}
        self.bodies: list[tuple[int, int]] = []  # number of the multibody and of the link, -1 for its base
        if case.ground != "none":
            self.names[self._create(0, self._ground(case)), -1] = GROUND
        if case.vehicle:
            self._build_vehicle(case)
        if case.hinges:
            self._build_mechanism(case)
        for body in (*case.blocks, *case.bodies):
            if body not in case.hinged:
                turn = pybullet.getQuaternionFromEuler(body.rpy)
                made = self._create(
                    0 if body in case.blocks else body.mass, self._shape(body.shape), body.position, turn
                )
                self.names[made, -1] = body.name
        keys = {name: key for key, name in self.names.items()}
        self.bodies = [keys[body.name] for body in case.moving]
        self._set_surfaces(case)

    def _create(self, mass: float, shape: int, position: Any = (0, 0, 0), turn: Any = (0, 0, 0, 1), **more: Any) -> int:
        made = pybullet.createMultiBody(mass, shape, -1, position, turn, physicsClientId=self.client, **more)
        return int(made)

    def _ground(self, case: Case) -> int:
        if case.ground == "mesh":
            vertices, faces = slab()
            options = {"indices": faces.ravel().tolist(), "flags": pybullet.GEOM_FORCE_CONCAVE_TRIMESH}
            shape = pybullet.createCollisionShape(
                pybullet.GEOM_MESH, vertices=vertices.tolist(), physicsClientId=self.client, **options
            )
        elif case.ground == "heightmap":
            side = CELLS + 1
            scale = [2 * SLAB[0] / CELLS, 2 * SLAB[0] / CELLS, 1]
            shape = pybullet.createCollisionShape(
                pybullet.GEOM_HEIGHTFIELD,
                meshScale=scale,
                heightfieldData=[0.0] * side**2,
                numHeightfieldRows=side,
                numHeightfieldColumns=side,
                physicsClientId=self.client,
            )
        else:
            shape = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=self.client)
        return int(shape)

    def _shape(self, shape: Shape, place: Any = (0, 0, 0)) -> int:
        size = shape.size
        options: dict[str, Any]
        if shape.kind == "box":
            kind, options = pybullet.GEOM_BOX, {"halfExtents": size}
        elif shape.kind == "sphere":
            kind, options = pybullet.GEOM_SPHERE, {"radius": size[0]}
        elif shape.kind == "cylinder":
            kind, options = pybullet.GEOM_CYLINDER, {"radius": size[0], "height": 2 * size[1]}
        elif shape.kind == "capsule":
            kind, options = pybullet.GEOM_CAPSULE, {"radius": size[0], "height": 2 * size[1]}
        elif shape.kind.startswith("mesh"):
            kind, options = pybullet.GEOM_MESH, {"vertices": mesh(shape)[0].tolist()}
        else:
            raise UnsupportedCaseError(shape.kind)
        made = pybullet.createCollisionShape(kind, collisionFramePosition=place, physicsClientId=self.client, **options)
        return int(made)

    def _build_vehicle(self, case: Case) -> None:
        vehicle = case.vehicle
        assert vehicle is not None
        count = len(vehicle.wheels)
        chassis = self._create(
            vehicle.chassis.mass,
            self._shape(vehicle.chassis.shape),
            vehicle.chassis.position,
            linkMasses=[vehicle.wheel_mass] * count,
            linkCollisionShapeIndices=[self._shape(vehicle.wheel) for _ in range(count)],
            linkVisualShapeIndices=[-1] * count,
            linkPositions=[(x, y, 0.0) for x, y in vehicle.wheels.values()],
            linkOrientations=[pybullet.getQuaternionFromEuler(LATERAL)] * count,
            linkInertialFramePositions=[(0, 0, 0)] * count,
            linkInertialFrameOrientations=[(0, 0, 0, 1)] * count,
            linkParentIndices=[0] * count,
            linkJointTypes=[pybullet.JOINT_REVOLUTE] * count,
            linkJointAxis=[(0, 0, -1)] * count,
        )
        self.names[chassis, -1] = "chassis"
        self.names |= {(chassis, number): name for number, name in enumerate(vehicle.wheels)}
        self._drive(0.0)

    def _build_mechanism(self, case: Case) -> None:
        """One multibody whose base is fixed; each link's frame is at its hinge, and turned as the world's."""
        number = {hinge.child: i for i, hinge in enumerate(case.hinges)}
        anchors = {"": np.zeros(3)} | {hinge.child: np.array(hinge.anchor) for hinge in case.hinges}
        arms = [np.array(body.position) - anchors[body.name] for body in case.hinged]
        count = len(case.hinges)
        made = self._create(
            0,
            -1,
            linkMasses=[body.mass for body in case.hinged],
            linkCollisionShapeIndices=[
                self._shape(body.shape, place=arm.tolist()) for body, arm in zip(case.hinged, arms, strict=True)
            ],
            linkVisualShapeIndices=[-1] * count,
            linkPositions=[(anchors[h.child] - anchors[h.parent]).tolist() for h in case.hinges],
            linkOrientations=[(0, 0, 0, 1)] * count,
            linkInertialFramePositions=[arm.tolist() for arm in arms],
            linkInertialFrameOrientations=[(0, 0, 0, 1)] * count,
            linkParentIndices=[number[h.parent] + 1 if h.parent else 0 for h in case.hinges],
            linkJointTypes=[pybullet.JOINT_REVOLUTE] * count,
            linkJointAxis=[h.axis for h in case.hinges],
        )
        self.names |= {(made, i): hinge.child for i, hinge in enumerate(case.hinges)}
        for i, body in enumerate(case.hinged):
            if not body.touches:  # a link without a shape has no inertia
                pybullet.setCollisionFilterGroupMask(made, i, 0, 0, physicsClientId=self.client)
            pybullet.setJointMotorControl2(made, i, pybullet.VELOCITY_CONTROL, force=0.0, physicsClientId=self.client)

    def _drive(self, yaw_rate: float) -> None:
        vehicle = self.case.vehicle
        assert vehicle is not None
        chassis = next(body for (body, _), name in self.names.items() if name == "chassis")
        rate = yaw_rate * vehicle.track / 2 / vehicle.radius
        for number in range(len(vehicle.wheels)):
            pybullet.setJointMotorControl2(
                chassis,
                number,
                pybullet.VELOCITY_CONTROL,
                targetVelocity=-rate if number % 2 == 0 else rate,
                force=DRIVE_LIMIT,
                physicsClientId=self.client,
            )

    def _set_surfaces(self, case: Case) -> None:
        """Bullet multiplies the coefficients of two surfaces: roots of what a pair shall have are set."""
        mu = case.friction
        inertias = {body.name: body.inertia for body in case.moving}
        if case.vehicle:
            wheel = Body("wheel", case.vehicle.wheel, case.vehicle.wheel_mass, (0.0, 0.0, 0.0))
            inertias |= dict.fromkeys(case.vehicle.wheels, wheel.inertia)
        for (body, link), name in self.names.items():
            options: dict[str, Any] = {
                "lateralFriction": min(mu, case.ground_mu) / math.sqrt(mu) if name == GROUND else math.sqrt(mu),
                "restitution": math.sqrt(case.restitution or 0.0),
                "rollingFriction": 0.0,
                "spinningFriction": 0.0,
                "linearDamping": 0.0,
                "angularDamping": 0.0,
                "jointDamping": 0.0,
                "activationState": pybullet.ACTIVATION_STATE_DISABLE_SLEEPING,
            }
            if case.restitution is not None:
                # else Bullet takes the gap that is left before the hit, over the step, off the speed of the rebound
                options["contactProcessingThreshold"] = 0.0
            if name in inertias:
                options["localInertiaDiagonal"] = inertias[name]
            pybullet.changeDynamics(body, link, physicsClientId=self.client, **options)

    def settle(self, count: int) -> None:
        for _ in range(count):
            pybullet.stepSimulation(physicsClientId=self.client)

    def start(self) -> None:
        for (number, _), body in zip(self.bodies, self.case.moving, strict=True):
            if any(body.linear) or any(body.angular):
                pybullet.resetBaseVelocity(number, body.linear, body.angular, physicsClientId=self.client)
        keys = {name: key for key, name in self.names.items()}
        for hinge in self.case.hinges:
            number, link = keys[hinge.child]
            pybullet.resetJointState(number, link, 0.0, hinge.rate, physicsClientId=self.client)
        if self.case.vehicle:
            self._drive(self.case.vehicle.yaw_rate)
        self._start = pybullet.saveState(physicsClientId=self.client)

    def advance(self, count: int) -> None:
        push = self.case.push
        for _ in range(count):
            if push:
                number, _ = self.bodies[0]
                centre, _ = pybullet.getBasePositionAndOrientation(number, physicsClientId=self.client)
                frame = pybullet.WORLD_FRAME
                pybullet.applyExternalForce(number, -1, push, centre, frame, physicsClientId=self.client)
            pybullet.stepSimulation(physicsClientId=self.client)

    def rewind(self) -> None:
        pybullet.restoreState(self._start, physicsClientId=self.client)

    def state(self) -> npt.NDArray[np.float64]:
        rows = []
        for body, link in self.bodies:
            if link < 0:
                position, (x, y, z, w) = pybullet.getBasePositionAndOrientation(body, physicsClientId=self.client)
                linear, angular = pybullet.getBaseVelocity(body, physicsClientId=self.client)
            else:
                found = pybullet.getLinkState(body, link, 1, 1, physicsClientId=self.client)
                (position, (x, y, z, w)), (linear, angular) = found[:2], found[6:8]
            rows.append((*position, w, x, y, z, *linear, *angular))
        return np.array(rows)

    def pressed(self) -> set[Pair]:
        names = self.names
        points = pybullet.getContactPoints(physicsClientId=self.client)
        return {frozenset((names[p[1], p[3]], names[p[2], p[4]])) for p in points if p[9] > 0.0}

    def asleep(self) -> float:
        return NOT_ASKED

    def has_diverged(self) -> bool:
        return False  # Bullet goes on with what it has

    def close(self) -> None:
        pybullet.disconnect(physicsClientId=self.client)
