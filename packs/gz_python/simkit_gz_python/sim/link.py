"""Handle of a link with the interface of gz-sim's Python class `Link`: poses, velocities and bounding boxes."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Pose
from simkit.extend import Vector
from simkit_gz_python.math import AxisAlignedBox, Inertiald, MassMatrix3d, Matrix3d, Pose3d, Vector3d
from simkit_gz_python.math.simkit_conversion import cross_product, gz_pose, gz_vector, three_numbers
from simkit_gz_python.math.vectors import VectorLike
from simkit_gz_python.sim.entity_handle import child_methods
from simkit_gz_python.sim.entity_view import EntityView
from simkit_gz_python.sim.model import PartOfModel

if TYPE_CHECKING:
    from simkit import Link as RuntimeLink
    from simkit import Simulation


_CORNERS: Final = tuple(product((-1.0, 1.0), repeat=3))


def link_box(sim: Simulation, scoped: str) -> AxisAlignedBox:
    """Return the bounding box of a link's collisions in the link frame; empty without collisions.

    Planes and height maps have no bounding box here.
    """
    import mujoco

    unbounded = int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD)
    model, bound, box = sim.mj_model, sim.engine.names.link(scoped), AxisAlignedBox()
    for geom in bound.geoms:
        if int(model.geom_type[geom]) not in unbounded:
            placed = bound.offset.inverse() @ Pose(model.geom_pos[geom], model.geom_quat[geom])
            box.merge(_box_around(placed, model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]))
    return box


def box_at_pose(box: AxisAlignedBox, pose: Pose) -> AxisAlignedBox:
    """Return the axis-aligned box that contains a box at a pose; the content of the box may be smaller."""
    low, high = np.array(list(box.min())), np.array(list(box.max()))
    return _box_around(pose, (low + high) / 2, (high - low) / 2) if (low <= high).all() else AxisAlignedBox()


def _box_around(pose: Pose, centre: Vector, half: Vector) -> AxisAlignedBox:
    corners = [pose @ Pose(centre + np.array(signs) * half) for signs in _CORNERS]
    points = np.array([corner.position for corner in corners])
    return AxisAlignedBox(Vector3d(*points.min(axis=0).tolist()), Vector3d(*points.max(axis=0).tolist()))


_VELOCITY, _ACCELERATION, _BOX = "velocity", "acceleration", "box"


class Link(PartOfModel):
    """Link of a model; vectors are in world axes.

    A system must enable velocities and accelerations. A disabled reading is None; an enabled reading is 0 before the
    next step.
    """

    KIND = "link"
    collisions, collision_by_name, collision_count = child_methods("collision")
    visuals, visual_by_name, visual_count = child_methods("visual")

    # ------------------------------------------------------------------ description

    def is_canonical(self, ecm: EntityView) -> bool:
        """Check whether this is the canonical link of its model, whose motion is the model's motion."""
        record = self._record(ecm)
        if record is None:
            return False
        model = ecm.record(record.parent)
        return bool(model is not None and model.scene.canonical_link == record.scene.scoped)

    def wind_mode(self, ecm: EntityView) -> bool:
        scene = self._scene(ecm)
        return bool(scene is not None and scene.enable_wind)

    # ------------------------------------------------------------------ pose and motion

    def world_pose(self, ecm: EntityView) -> Pose3d | None:
        """Return the pose of the link frame in the world; None only if the link does not exist."""
        link = self._handle(ecm)
        return gz_pose(link.pose) if link is not None else None

    def world_inertial_pose(self, ecm: EntityView) -> Pose3d | None:
        """Return the pose of the centre of mass in the world, with the axes of the moments of inertia."""
        inertial = self.world_inertial(ecm)
        return inertial.pose() if inertial is not None else None

    def world_inertial(self, ecm: EntityView) -> Inertiald | None:
        """Return mass, moments (in the link's axes) and the world pose of the centre of mass."""
        link = self._handle(ecm)
        if link is None:
            return None
        inertial = link.scene.inertial
        matrix = MassMatrix3d(inertial.mass, Vector3d(*inertial.inertia[:3]), Vector3d(*inertial.inertia[3:]))
        return Inertiald(matrix, gz_pose(link.pose) * Pose3d(*inertial.com, 0, 0, 0))

    def world_inertia_matrix(self, ecm: EntityView) -> Matrix3d | None:
        """Return the moments of inertia about the centre of mass [kg·m²], in world axes."""
        inertial = self.world_inertial(ecm)
        return inertial.moi() if inertial is not None else None

    def enable_velocity_checks(self, ecm: EntityView, enable: bool = True) -> None:
        self._enable(ecm, _VELOCITY, enable)

    def enable_acceleration_checks(self, ecm: EntityView, enable: bool = True) -> None:
        self._enable(ecm, _ACCELERATION, enable)

    def world_linear_velocity(self, ecm: EntityView, offset: VectorLike | None = None) -> Vector3d | None:
        """Return the velocity [m/s] of the link's origin, or of the point at `offset` [m] in the link frame."""

        def at_offset(link: RuntimeLink) -> Vector:
            if offset is None:
                return link.linear_velocity
            arm = link.pose.rotate(three_numbers(offset))
            return link.linear_velocity + np.cross(link.angular_velocity, arm)

        return self._motion(ecm, _VELOCITY, at_offset)

    def world_angular_velocity(self, ecm: EntityView) -> Vector3d | None:
        """Return the angular velocity [rad/s]."""
        return self._motion(ecm, _VELOCITY, lambda link: link.angular_velocity)

    def world_linear_acceleration(self, ecm: EntityView) -> Vector3d | None:
        """Return the acceleration [m/s²] of the link's origin; in free fall, the result is gravity."""
        return self._motion(ecm, _ACCELERATION, lambda link: link.linear_acceleration)

    def world_angular_acceleration(self, ecm: EntityView) -> Vector3d | None:
        """Return the angular acceleration [rad/s²]."""
        return self._motion(ecm, _ACCELERATION, lambda link: _angular_acceleration(ecm, link))

    def _motion(self, ecm: EntityView, what: str, read: Callable[[RuntimeLink], Vector]) -> Vector3d | None:
        """Return a velocity or acceleration; None while disabled, 0 before the first step after `enable`."""
        is_read, link = self._reading(ecm, what), self._handle(ecm)
        if is_read is None or link is None:
            return None
        return gz_vector(read(link)) if is_read else Vector3d()

    def world_kinetic_energy(self, ecm: EntityView) -> float | None:
        """Return the kinetic energy [J]; None while velocities are disabled."""
        is_read = self._reading(ecm, _VELOCITY)
        inertial = self.world_inertial(ecm)
        if is_read is None or inertial is None:
            return None
        linear = self.world_linear_velocity(ecm, self._handle(ecm).scene.inertial.com)
        angular = self.world_angular_velocity(ecm)
        assert linear is not None and angular is not None
        rotational = float(angular.dot(inertial.moi() * angular))
        return 0.5 * (inertial.mass_matrix().mass() * float(linear.squared_length()) + rotational)

    # ------------------------------------------------------------------ bounding box

    def enable_bounding_box_checks(self, ecm: EntityView, enable: bool = True) -> None:
        self._enable(ecm, _BOX, enable)

    def axis_aligned_box(self, ecm: EntityView) -> AxisAlignedBox | None:
        """Return the bounding box of the collisions in the link frame [m]; None while bounding boxes are disabled."""
        return None if self._reading(ecm, _BOX) is None else self.compute_axis_aligned_box(ecm)

    def world_axis_aligned_box(self, ecm: EntityView) -> AxisAlignedBox | None:
        """Return the box in world axes [m] that contains `axis_aligned_box`; None while bounding boxes are disabled."""
        box = self.axis_aligned_box(ecm)
        return box_at_pose(box, self._handle(ecm).pose) if box is not None else None

    def compute_axis_aligned_box(self, ecm: EntityView) -> AxisAlignedBox | None:
        """Return the bounding box of the collisions in the link frame [m], also while bounding boxes are disabled."""
        link = self._handle(ecm)
        return link_box(ecm.simulation, link.scoped) if link is not None else None

    # ------------------------------------------------------------------ commands

    def set_linear_velocity(self, ecm: EntityView, velocity: VectorLike) -> None:
        """Set the velocity [m/s], in the link's axes, of the link's whole free body at the start of the next step.

        As in gz-sim, the velocity is set to 0 at the start of every later step without a new command.
        """
        if self.valid(ecm):
            ecm.commands.linear[self._entity] = three_numbers(velocity)

    def set_angular_velocity(self, ecm: EntityView, velocity: VectorLike) -> None:
        """Set the angular velocity [rad/s], in the link's axes, by the same rules as `set_linear_velocity`."""
        if self.valid(ecm):
            ecm.commands.angular[self._entity] = three_numbers(velocity)

    def add_world_force(self, ecm: EntityView, force: VectorLike, position: VectorLike | None = None) -> None:
        """Add a force [N], in world axes, for the next step.

        Args:
            ecm: manager of the simulation.
            force: force [N], in world axes.
            position: point of application relative to the centre of mass [m], in link axes; zero by default.
        """
        link = self._handle(ecm)
        if link is None:
            return
        point, components = link.scene.inertial.com, three_numbers(force)
        if position is not None:
            point = [a + b for a, b in zip(point, three_numbers(position), strict=True)]
        torque = cross_product(link.pose.rotate(point).tolist(), components) if any(point) else (0.0, 0.0, 0.0)
        ecm.commands.add_wrench(self._entity, components, torque)

    def add_link_force(self, ecm: EntityView, force: VectorLike, position: VectorLike | None = None) -> None:
        """Add a force [N], in link axes, for the next step; `position` is the same as in `add_world_force`."""
        link = self._handle(ecm)
        if link is not None:
            self.add_world_force(ecm, link.pose.rotate(three_numbers(force)).tolist(), position)

    def add_world_wrench(
        self, ecm: EntityView, force: VectorLike, torque: VectorLike, offset: VectorLike | None = None
    ) -> None:
        """Add a force and a torque, in world axes, for the next step.

        Args:
            ecm: manager of the simulation.
            force: force [N], in world axes.
            torque: torque [N·m], in world axes.
            offset: point of application relative to the link's origin [m], in link axes; zero by default.
        """
        link = self._handle(ecm)
        if link is None:
            return
        components = three_numbers(force)
        ecm.commands.add_wrench(self._entity, components, three_numbers(torque))
        if offset is not None:
            arm = link.pose.rotate(three_numbers(offset)).tolist()
            ecm.commands.add_wrench(self._entity, (0.0, 0.0, 0.0), cross_product(arm, components))


def _angular_acceleration(ecm: EntityView, link: RuntimeLink) -> Vector:
    """Return the angular acceleration [rad/s²] in world axes, shape (3,)."""
    import mujoco

    sim, out = ecm.simulation, np.zeros(6)
    body = int(sim.engine.names.link(link.scoped).body)
    if body and not sim.engine.physics.sleep.is_asleep(body, sim.engine.physics.fresh()):
        kind = int(mujoco.mjtObj.mjOBJ_XBODY)
        mujoco.mj_objectAcceleration(sim.mj_model, sim.engine.physics.fresh_accelerations(), kind, body, out, 0)
    return out[:3]
