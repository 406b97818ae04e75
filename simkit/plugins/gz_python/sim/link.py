"""Links as gz-sim's Python shows them: poses and velocities of the link frame's origin in world axes, and
bounding boxes.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.plugins.gz_python.math import AxisAlignedBox, Inertiald, MassMatrix3d, Matrix3d, Pose3d, Vector3d
from simkit.plugins.gz_python.math.simkit_conversion import cross_product, gz_pose, gz_vector, three_numbers
from simkit.plugins.gz_python.math.vectors import VectorLike
from simkit.plugins.gz_python.sim.entity_handle import child_methods
from simkit.plugins.gz_python.sim.entity_view import EntityView
from simkit.plugins.gz_python.sim.model import PartOfModel
from simkit.pose import Pose, Vector

if TYPE_CHECKING:
    from simkit.runtime import Link as RuntimeLink
    from simkit.runtime import Simulation


_CORNERS: Final = tuple(product((-1.0, 1.0), repeat=3))


def link_box(sim: Simulation, scoped: str) -> AxisAlignedBox:
    """Around the collisions of a link, in its frame; empty where it has none. Planes and height maps do not count."""
    import mujoco

    endless = int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD)
    model, bound, box = sim.mj_model, sim.engine.names.link(scoped), AxisAlignedBox()
    for geom in bound.geoms:
        if int(model.geom_type[geom]) not in endless:
            placed = bound.offset.inverse() @ Pose(model.geom_pos[geom], model.geom_quat[geom])
            box.merge(_box_around(placed, model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]))
    return box


def box_at_pose(box: AxisAlignedBox, pose: Pose) -> AxisAlignedBox:
    """The box, along the outer axes, around a box at a pose: never smaller than what is in it."""
    low, high = np.array(list(box.min())), np.array(list(box.max()))
    return _box_around(pose, (low + high) / 2, (high - low) / 2) if (low <= high).all() else AxisAlignedBox()


def _box_around(pose: Pose, centre: Vector, half: Vector) -> AxisAlignedBox:
    corners = [pose @ Pose(centre + np.array(signs) * half) for signs in _CORNERS]
    points = np.array([corner.position for corner in corners])
    return AxisAlignedBox(Vector3d(*points.min(axis=0).tolist()), Vector3d(*points.max(axis=0).tolist()))


_VELOCITY, _ACCELERATION, _BOX = "velocity", "acceleration", "box"


class Link(PartOfModel):
    """A link. Velocities and accelerations are None until they are enabled, and 0 until a step has passed since."""

    KIND = "link"
    collisions, collision_by_name, collision_count = child_methods("collision")
    visuals, visual_by_name, visual_count = child_methods("visual")

    # ------------------------------------------------------------------ what it is

    def is_canonical(self, ecm: EntityView) -> bool:
        """Check whether its motion is that of the model it is in."""
        record = self._record(ecm)
        if record is None:
            return False
        model = ecm.record(record.parent)
        return bool(model is not None and model.scene.canonical_link == record.scene.scoped)

    def wind_mode(self, ecm: EntityView) -> bool:
        scene = self._scene(ecm)
        return bool(scene is not None and scene.enable_wind)

    # ------------------------------------------------------------------ where it is and how it moves

    def world_pose(self, ecm: EntityView) -> Pose3d | None:
        """Return the pose of the link frame; None only where there is no such link."""
        link = self._handle(ecm)
        return gz_pose(link.pose) if link is not None else None

    def world_inertial_pose(self, ecm: EntityView) -> Pose3d | None:
        """Return the pose of the centre of mass, with the axes of its inertia."""
        inertial = self.world_inertial(ecm)
        return inertial.pose() if inertial is not None else None

    def world_inertial(self, ecm: EntityView) -> Inertiald | None:
        """Mass and moments at the centre of mass in the world; the moments are in the link's axes."""
        link = self._handle(ecm)
        if link is None:
            return None
        own = link.scene.inertial
        matrix = MassMatrix3d(own.mass, Vector3d(*own.inertia[:3]), Vector3d(*own.inertia[3:]))
        return Inertiald(matrix, gz_pose(link.pose) * Pose3d(*own.com, 0, 0, 0))

    def world_inertia_matrix(self, ecm: EntityView) -> Matrix3d | None:
        """The moments about the centre of mass, in world axes."""
        inertial = self.world_inertial(ecm)
        return inertial.moi() if inertial is not None else None

    def enable_velocity_checks(self, ecm: EntityView, enable: bool = True) -> None:
        self._enable(ecm, _VELOCITY, enable)

    def enable_acceleration_checks(self, ecm: EntityView, enable: bool = True) -> None:
        self._enable(ecm, _ACCELERATION, enable)

    def world_linear_velocity(self, ecm: EntityView, offset: VectorLike | None = None) -> Vector3d | None:
        """[m/s] of the origin, or of the point at `offset` [m] in the link frame."""

        def at_offset(link: RuntimeLink) -> Vector:
            if offset is None:
                return link.linear_velocity
            arm = link.pose.rotate(three_numbers(offset))
            return link.linear_velocity + np.cross(link.angular_velocity, arm)

        return self._motion(ecm, _VELOCITY, at_offset)

    def world_angular_velocity(self, ecm: EntityView) -> Vector3d | None:
        """[rad/s]"""
        return self._motion(ecm, _VELOCITY, lambda link: link.angular_velocity)

    def world_linear_acceleration(self, ecm: EntityView) -> Vector3d | None:
        """[m/s²] of the origin; that of a body that falls freely is gravity."""
        return self._motion(ecm, _ACCELERATION, lambda link: link.linear_acceleration)

    def world_angular_acceleration(self, ecm: EntityView) -> Vector3d | None:
        """[rad/s²]"""
        return self._motion(ecm, _ACCELERATION, lambda link: _angular_acceleration(ecm, link))

    def _motion(self, ecm: EntityView, what: str, read: Callable[[RuntimeLink], Vector]) -> Vector3d | None:
        """A vector of the link's motion; None while its readings are off, 0 until a step has passed since."""
        is_read, link = self._reading(ecm, what), self._handle(ecm)
        if is_read is None or link is None:
            return None
        return gz_vector(read(link)) if is_read else Vector3d()

    def world_kinetic_energy(self, ecm: EntityView) -> float | None:
        """[J]; None until velocities are enabled."""
        is_read = self._reading(ecm, _VELOCITY)
        inertial = self.world_inertial(ecm)
        if is_read is None or inertial is None:
            return None
        linear = self.world_linear_velocity(ecm, self._handle(ecm).scene.inertial.com)
        angular = self.world_angular_velocity(ecm)
        assert linear is not None and angular is not None
        turning = float(angular.dot(inertial.moi() * angular))
        return 0.5 * (inertial.mass_matrix().mass() * float(linear.squared_length()) + turning)

    # ------------------------------------------------------------------ the box around it

    def enable_bounding_box_checks(self, ecm: EntityView, enable: bool = True) -> None:
        self._enable(ecm, _BOX, enable)

    def axis_aligned_box(self, ecm: EntityView) -> AxisAlignedBox | None:
        """Around its collisions, along the link's axes; None until it is enabled, empty without collisions."""
        return None if self._reading(ecm, _BOX) is None else self.compute_axis_aligned_box(ecm)

    def world_axis_aligned_box(self, ecm: EntityView) -> AxisAlignedBox | None:
        """Along the world's axes, around the box along the link's; None until it is enabled."""
        box = self.axis_aligned_box(ecm)
        return box_at_pose(box, self._handle(ecm).pose) if box is not None else None

    def compute_axis_aligned_box(self, ecm: EntityView) -> AxisAlignedBox | None:
        """Around its collisions, along the link's axes, whether enabled or not."""
        link = self._handle(ecm)
        return link_box(ecm.simulation, link.scoped) if link is not None else None

    # ------------------------------------------------------------------ commands

    def set_linear_velocity(self, ecm: EntityView, velocity: VectorLike) -> None:
        """Velocity [m/s] in the link's axes, which what it moves freely with has at the start of the next step.

        As in gz-sim it is then 0 at the start of every step after that, unless it is set again.
        """
        if self.valid(ecm):
            ecm.commands.linear[self._entity] = three_numbers(velocity)

    def set_angular_velocity(self, ecm: EntityView, velocity: VectorLike) -> None:
        """The same of the turning [rad/s], in the link's axes."""
        if self.valid(ecm):
            ecm.commands.angular[self._entity] = three_numbers(velocity)

    def add_world_force(self, ecm: EntityView, force: VectorLike, position: VectorLike | None = None) -> None:
        """Force [N] in world axes for the next step, at the centre of mass or at an offset [m] from it in link axes."""
        link = self._handle(ecm)
        if link is None:
            return
        own, pushed = link.scene.inertial.com, three_numbers(force)
        if position is not None:
            own = [a + b for a, b in zip(own, three_numbers(position), strict=True)]
        about = cross_product(link.pose.rotate(own).tolist(), pushed) if any(own) else (0.0, 0.0, 0.0)
        ecm.commands.add_wrench(self._entity, pushed, about)

    def add_link_force(self, ecm: EntityView, force: VectorLike, position: VectorLike | None = None) -> None:
        """The same with the force in the link's axes."""
        link = self._handle(ecm)
        if link is not None:
            self.add_world_force(ecm, link.pose.rotate(three_numbers(force)).tolist(), position)

    def add_world_wrench(
        self, ecm: EntityView, force: VectorLike, torque: VectorLike, offset: VectorLike | None = None
    ) -> None:
        """Force [N] and torque [N·m] in world axes for the next step, at the link's origin or at an offset from it."""
        link = self._handle(ecm)
        if link is None:
            return
        pushed = three_numbers(force)
        ecm.commands.add_wrench(self._entity, pushed, three_numbers(torque))
        if offset is not None:
            arm = link.pose.rotate(three_numbers(offset)).tolist()
            ecm.commands.add_wrench(self._entity, (0.0, 0.0, 0.0), cross_product(arm, pushed))


def _angular_acceleration(ecm: EntityView, link: RuntimeLink) -> Vector:
    """[rad/s²] in world axes, shape (3,)."""
    import mujoco

    sim, out = ecm.simulation, np.zeros(6)
    body = int(sim.engine.names.link(link.scoped).body)
    if body and not sim.engine.physics.sleep.is_asleep(body, sim.engine.physics.fresh()):
        kind = int(mujoco.mjtObj.mjOBJ_XBODY)
        mujoco.mj_objectAcceleration(sim.mj_model, sim.engine.physics.fresh_accelerations(), kind, body, out, 0)
    return out[:3]
