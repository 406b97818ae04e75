"""Handle of a link."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from simkit.argument_checks import check_kind, checked_number, checked_vector
from simkit.errors import InputError
from simkit.pose import IDENTITY, Pose, Vector, VectorLike, checked_pose, quat_conjugate, quat_rotate
from simkit.runtime.engine.physics_state import CONTROL, STALE, VELOCITY
from simkit.runtime.handles.collision import Collision
from simkit.runtime.handles.handle import Handle
from simkit.runtime.handles.joint_mechanics import update_loop_joints
from simkit.runtime.handles.visual import Visual
from simkit.scene.geometry import six
from simkit.scene.override_fields import with_mass

if TYPE_CHECKING:
    from simkit.compiler.name_map import NameMap
    from simkit.extend import Sensor
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.scene import SceneLink

_BODY = int(mujoco.mjtObj.mjOBJ_XBODY)


class Link(Handle):
    """Link of a model. Poses and velocities are those of the link frame's origin, in the world frame."""

    _internal_names = Handle._internal_names | {"bind", "root_state", "spatial_velocity"}

    def __init__(self, handles: EntityHandles, scene: SceneLink) -> None:
        super().__init__(handles, scene.name, scene.scoped)
        self.scene = scene
        self._visuals: dict[str, Visual] | None = None
        self._collisions: dict[str, Collision] | None = None

    def bind(self, names: NameMap) -> None:
        """Look up the link in a compiled model."""
        binding = names.link(self.scoped)
        self._binding, self._body = binding, int(binding.body)
        self._offset: Pose | None = None if binding.offset == IDENTITY else binding.offset

    # ------------------------------------------------------------------ readings

    @property
    def pose(self) -> Pose:
        """Pose of the link frame in the world."""
        self.check_present()
        data = self._physics.fresh()
        pose = Pose(data.xpos[self._body], data.xquat[self._body])
        return pose @ self._offset if self._offset is not None else pose

    def root_state(self) -> tuple[float, ...] | None:
        """Return the pose of a free link as x, y, z, qw, qx, qy, qz, without a forward pass; None for other links."""
        start = self._binding.root_joint_qpos
        return tuple(self._physics.data.qpos[start : start + 7].tolist()) if start >= 0 else None

    def spatial_velocity(self) -> Vector:
        """Return angular and linear velocity of the link origin in the world, shape (6,)."""
        self.check_present()
        data = self._physics.fresh()
        out = np.zeros(6)
        if self._body:
            mujoco.mj_objectVelocity(self._physics.model, data, _BODY, self._body, out, 0)
        return out

    @property
    def linear_velocity(self) -> Vector:
        """Velocity of the link origin [m/s], world frame, shape (3,)."""
        return self.spatial_velocity()[3:]

    @property
    def angular_velocity(self) -> Vector:
        """Angular velocity [rad/s], world frame, shape (3,)."""
        return self.spatial_velocity()[:3]

    @property
    def linear_acceleration(self) -> Vector:
        """Acceleration of the link origin [m/s²], world frame, without gravity (0 at rest), shape (3,)."""
        self.check_present()
        out = np.zeros(6)
        physics = self._physics
        # the engine does not update the numbers of a sleeping body
        if not self._body or physics.sleep.is_asleep(self._body, physics.fresh()):
            return out[3:]
        data = physics.fresh_accelerations()
        mujoco.mj_objectAcceleration(self._physics.model, data, _BODY, self._body, out, 0)
        acceleration: Vector = out[3:] + self._physics.model.opt.gravity
        return acceleration

    @property
    def mass(self) -> float:
        """Mass [kg]; settable. The inertia changes in proportion."""
        self.check_present()
        return float(self._engine.numbers.inertial(self.scene).mass)

    @mass.setter
    def mass(self, mass: float) -> None:
        self.check_present()
        mass = checked_number(mass, "mass", 0.0)
        old = self._engine.numbers.inertial(self.scene)
        self._engine.numbers.set_inertial(self.scene, with_mass(old, mass))
        self._engine.numbers.keep("link", self.scoped, "mass", mass)

    @property
    def inertia(self) -> tuple[float, ...]:
        """Inertia ixx, iyy, izz, ixy, ixz, iyz [kg·m²] about the centre of mass, in link axes; settable."""
        self.check_present()
        return self._engine.numbers.inertial(self.scene).inertia

    @inertia.setter
    def inertia(self, inertia: Sequence[float]) -> None:
        self.check_present()
        moments = six(checked_vector(inertia, "inertia", 6).tolist())
        old = self._engine.numbers.inertial(self.scene)
        self._engine.numbers.set_inertial(self.scene, replace(old, inertia=moments))
        self._engine.numbers.keep("link", self.scoped, "inertia", moments)

    # ------------------------------------------------------------------ commands

    @property
    def is_free(self) -> bool:
        """True if the link moves freely, together with the links that joints connect to it."""
        self.check_present()
        return int(self._binding.root_joint_qpos) >= 0

    def set_pose(self, pose: Pose) -> None:
        """Move a free link together with all links that joints connect to it; velocities stay the same.

        Raises:
            InputError: joints or the world hold the link; move its model, or set its joints.
        """
        self.check_present()
        pose = checked_pose(pose)
        if not self.is_free:
            raise self._held(f"move the model {self.scoped.rpartition('::')[0]!r}")
        data, start = self._physics.data, int(self._binding.root_joint_qpos)
        old = Pose(data.qpos[start : start + 3], data.qpos[start + 3 : start + 7])
        moved = pose @ self.pose.inverse() @ old
        data.qpos[start : start + 3], data.qpos[start + 3 : start + 7] = moved.position, moved.quaternion
        update_loop_joints(self._engine)
        self._physics.changed_body(STALE, self._body)

    def set_velocity(self, linear: VectorLike, angular: VectorLike = (0.0, 0.0, 0.0)) -> None:
        """Set the twist of a free link about its origin, world frame [m/s, rad/s].

        Raises:
            InputError: joints or the world hold the link.
        """
        self.check_present()
        linear = checked_vector(linear, "linear")
        angular = checked_vector(angular, "angular")
        if not self.is_free:
            raise self._held("set the velocity of its joints")
        data, binding = self._physics.data, self._binding
        start, dof = int(binding.root_joint_qpos), int(binding.root_joint_dof)
        arm = data.qpos[start : start + 3] - self.pose.position
        data.qvel[dof : dof + 3] = linear + np.cross(angular, arm)
        data.qvel[dof + 3 : dof + 6] = quat_rotate(quat_conjugate(data.qpos[start + 3 : start + 7]), angular)
        update_loop_joints(self._engine)
        self._physics.changed_body(VELOCITY, self._body)

    def _held(self, instead: str) -> InputError:
        message = f"link {self.scoped!r} is held by joints or the world; {instead}"
        return InputError("SK-SERVICE-003", message)

    def apply_wrench(self, force: VectorLike, torque: VectorLike = (0.0, 0.0, 0.0)) -> None:
        """Add a force [N] and torque [N·m], world frame, at the centre of mass, for the next step."""
        self.check_present()
        force, torque = checked_vector(force, "force"), checked_vector(torque, "torque")
        if not self._body:
            return
        physics = self._physics
        row = physics.data.xfrc_applied[self._body]
        row[:3] += force
        row[3:] += torque
        physics.push_once()
        physics.changed_body(CONTROL, self._body)

    @property
    def collisions_enabled(self) -> bool:
        """True if the link's collisions make contacts; settable."""
        self.check_present()
        model = self._physics.model
        return any(model.geom_contype[g] or model.geom_conaffinity[g] for g in self._binding.geoms)

    @collisions_enabled.setter
    def collisions_enabled(self, enabled: bool) -> None:
        self.check_present()
        check_kind(enabled, (bool, np.bool_, int), "collisions_enabled", "True or False")
        for field in ("geom_contype", "geom_conaffinity"):
            values = self._engine.touch(field)
            original = self._engine.original(field)
            for g in self._binding.geoms:
                values[g] = original[g] if enabled else 0
        self._physics.changed(STALE)

    # ------------------------------------------------------------------ sensors, collisions and visuals

    @property
    def collisions(self) -> dict[str, Collision]:
        """Collisions of the link by name."""
        if self._collisions is None:  # made on first use, as the visuals
            self._collisions = {c.name: Collision(self._handles, c.name, c.scoped, self) for c in self.scene.collisions}
        return dict(self._collisions)

    @property
    def sensors(self) -> dict[str, Sensor[Any]]:
        """Sensors of the link by name."""
        simulated = self._handles.tables["sensor"]
        return {s.name: simulated[s.scoped] for s in self.scene.sensors if s.scoped in simulated}

    @property
    def visuals(self) -> dict[str, Visual]:
        """Visuals of the link by name."""
        if self._visuals is None:  # made on first use, because a large world has thousands
            self._visuals = {v.name: Visual(self._handles, v, self) for v in self.scene.visuals}
        return dict(self._visuals)
