"""Drake as one of the engines of `contact.py`: hydroelastic contact, and damping that lets no body rebound.

The approximation is "similar": with "lagged", the default, friction stops a box that lands at 3 m/s with mu 0.3. A
point contact has one point of a face, on which a box rocks; a hydroelastic contact has the whole surface.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from contact_engines import NOT_ASKED, DivergedError, UnsupportedCaseError, check_supported, quaternion
from contact_scene import Body, Case, Pair, Shape, Vector
from pydrake.common.eigen_geometry import Quaternion
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddContactMaterial,
    AddRigidHydroelasticProperties,
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    ProximityProperties,
    Sphere,
)
from pydrake.math import RigidTransform
from pydrake.multibody.plant import AddMultibodyPlant, CoulombFriction, MultibodyPlantConfig
from pydrake.multibody.tree import SpatialInertia, UnitInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

KINDS = {"box", "sphere", "cylinder", "capsule", "ellipsoid"}
MODULUS = 1e7  # hydroelastic modulus, Drake's default [Pa]
DISSIPATION = 100.0  # of Hunt and Crossley [s/m]: without it a body rebounds
CELL = 0.02  # longest edge of a curved shape's surface [m]


class Drake:
    """A case of free bodies in a `MultibodyPlant`."""

    def __init__(self, case: Case, folder: Path) -> None:
        check_supported(case, KINDS, "Drake")
        self.case = case
        self.steps = 0
        builder = DiagramBuilder()
        config = MultibodyPlantConfig(time_step=case.timestep, discrete_contact_approximation="similar")
        self.plant, _ = AddMultibodyPlant(config=config, builder=builder)
        self.plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -case.gravity])
        world = self.plant.world_body()
        if case.ground == "plane":
            self._touch(world, HalfSpace(), "ground")
        for block in case.blocks:
            pose = RigidTransform(Quaternion(quaternion(block.rpy)), block.position)
            self._touch(world, self._shape(block.shape), block.name, pose)
        self.bodies = [self._body(body) for body in case.bodies]
        self.plant.Finalize()
        self.simulator = Simulator(builder.Build())
        self.root = self.simulator.get_mutable_context()
        self.context = self.plant.GetMyMutableContextFromRoot(self.root)
        for body, made in zip(case.bodies, self.bodies, strict=True):
            pose = RigidTransform(Quaternion(quaternion(body.rpy)), body.position)
            self.plant.SetFreeBodyPose(self.context, made, pose)
        self.simulator.Initialize()

    def _body(self, body: Body) -> Any:
        unit = [value / body.mass for value in body.inertia]
        made = self.plant.AddRigidBody(body.name, SpatialInertia(body.mass, np.zeros(3), UnitInertia(*unit)))
        self._touch(made, self._shape(body.shape), body.name)
        return made

    def _shape(self, shape: Shape) -> Any:
        size = shape.size
        if shape.kind == "box":
            return Box(*(2 * half for half in size))
        if shape.kind == "sphere":
            return Sphere(size[0])
        if shape.kind == "ellipsoid":
            return Ellipsoid(*size)
        if shape.kind in {"cylinder", "capsule"}:
            return {"cylinder": Cylinder, "capsule": Capsule}[shape.kind](size[0], 2 * size[1])
        raise UnsupportedCaseError(shape.kind)

    def _touch(self, body: Any, shape: Any, name: str, pose: Any = None) -> None:
        """Add a collision shape; Drake combines two equal coefficients to the same one."""
        properties = ProximityProperties()
        mu = min(self.case.friction, self.case.ground_mu)
        AddContactMaterial(dissipation=DISSIPATION, friction=CoulombFriction(mu, mu), properties=properties)
        if isinstance(shape, HalfSpace):
            AddRigidHydroelasticProperties(properties)  # a compliant one has no surface with a compliant body
        else:
            AddCompliantHydroelasticProperties(CELL, MODULUS, properties)
        self.plant.RegisterCollisionGeometry(body, pose or RigidTransform(), shape, name, properties)

    def settle(self, count: int) -> None:
        self.advance(count)

    def start(self) -> None:
        for number, body in enumerate(self.case.bodies):
            if any(body.linear) or any(body.angular):
                self._set_velocity(number, body.linear, body.angular)
        self._start = self.context.get_discrete_state_vector().CopyToVector()

    def _set_velocity(self, number: int, linear: Vector, angular: Vector) -> None:
        velocities = self.plant.GetVelocities(self.context)
        first = self.bodies[number].floating_velocities_start_in_v()
        velocities[first : first + 6] = (*angular, *linear)
        self.plant.SetVelocities(self.context, velocities)

    def advance(self, count: int) -> None:
        self.steps += count
        try:
            self.simulator.AdvanceTo((self.steps + 0.25) * self.case.timestep)
        except RuntimeError as error:
            if "non-finite" not in str(error):
                raise
            raise DivergedError(self.case.name) from error

    def rewind(self) -> None:
        self.context.SetDiscreteState(self._start)

    def state(self) -> npt.NDArray[np.float64]:
        rows = []
        positions, velocities = self.plant.GetPositions(self.context), self.plant.GetVelocities(self.context)
        for body in self.bodies:
            q, v = body.floating_positions_start(), body.floating_velocities_start_in_v()
            turn, place = positions[q : q + 4], positions[q + 4 : q + 7]
            rows.append(np.concatenate((place, turn, velocities[v + 3 : v + 6], velocities[v : v + 3])))
        return np.array(rows)

    def pressed(self) -> set[Pair]:
        return set()

    def asleep(self) -> float:
        return NOT_ASKED

    def has_diverged(self) -> bool:
        return not np.isfinite(self.plant.GetPositions(self.context)).all()

    def close(self) -> None:
        """Nothing is held."""
