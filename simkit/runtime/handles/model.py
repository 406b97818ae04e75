"""Handle of a model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit.argument_checks import check_kind, checked_vector
from simkit.compiler import LinkBinding
from simkit.pose import IDENTITY, Pose, VectorLike, checked_pose, quat_conjugate, quat_rotate
from simkit.runtime.engine.physics_state import STALE, VELOCITY
from simkit.runtime.handles.handle import Handle, look_up
from simkit.runtime.handles.joint import Joint
from simkit.runtime.handles.joint_mechanics import update_loop_joints
from simkit.runtime.handles.link import Link
from simkit.runtime.handles.notebook_tables import model_html

if TYPE_CHECKING:
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.scene import SceneModel


class Model(Handle):
    """Model with its links, joints and nested models by name. Names of deeper elements are joined with `::`.

    Attributes:
        static: True for a static model in the file.
    """

    _internal_names = Handle._internal_names | {"below", "everything", "get_state", "replace_scene", "set_state"}

    def __init__(self, handles: EntityHandles, scene: SceneModel) -> None:
        super().__init__(handles, scene.name, scene.scoped)
        self.scene, self.static = scene, scene.static
        self.links: dict[str, Link] = {s.name: Link(handles, s) for s in scene.links}
        self.joints: dict[str, Joint] = {s.name: Joint(handles, s) for s in scene.joints}
        self.models: dict[str, Model] = {s.name: Model(handles, s) for s in scene.models}
        self._rest = scene.pose_world
        # the model frame in its canonical link's frame is constant
        self._canonical = next((li for li in scene.all_links() if li.scoped == scene.canonical_link), None)
        self._in_canonical = self._canonical.pose_world.inverse() @ scene.pose_world if self._canonical else None
        self._is_canonical = self._in_canonical == IDENTITY

    def _repr_html_(self) -> str:
        return model_html(self)

    def everything(self) -> list[Handle]:
        """Return this handle and all handles below it."""
        below = [h for m in self.models.values() for h in m.everything()]
        return [self, *self.links.values(), *self.joints.values(), *below]

    def replace_scene(self, scene: SceneModel) -> None:
        """Make this handle and all handles below it refer to a changed description with the same entities."""
        self.scene = scene
        for link in scene.links:
            self.links[link.name].scene = link
        for joint in scene.joints:
            self.joints[joint.name].scene = joint
        for model in scene.models:
            self.models[model.name].replace_scene(model)

    def link(self, name: str) -> Link:
        """Return a link by its name below the model, such as `"arm::hand"`; a KeyError suggests the closest name."""
        link: Link = look_up(self.below("links"), name, "link")
        return link

    def joint(self, name: str) -> Joint:
        """Return a joint by its name below the model, such as `"arm::wrist"`; a KeyError suggests the closest name."""
        joint: Joint = look_up(self.below("joints"), name, "joint")
        return joint

    def model(self, name: str) -> Model:
        """Return a nested model by its name below the model; a KeyError suggests the closest name."""
        model: Model = look_up(self.below("models"), name, "model")
        return model

    def below(self, attribute: str) -> dict[str, Any]:
        """Return the links, joints or models of this model and of its nested models, by name below this model."""
        table: dict[str, Any] = dict(getattr(self, attribute))
        for name, nested in self.models.items():
            table.update({f"{name}::{key}": value for key, value in nested.below(attribute).items()})
        return table

    # ------------------------------------------------------------------ pose and velocity

    @property
    def pose(self) -> Pose:
        """Pose of the model frame in the world."""
        self.check_present()
        if self._canonical is None or self._in_canonical is None:
            return self._rest
        pose = self._handles.link(self._canonical.scoped).pose
        return pose if self._is_canonical else pose @ self._in_canonical

    def set_pose(self, pose: Pose) -> None:
        """Move the whole model; joint positions and velocities stay the same. A static model may be moved too."""
        self.check_present()
        pose = checked_pose(pose)
        if self.static:
            self._handles.make_movable(self.scoped.split("::")[0])
        shift = pose @ self.pose.inverse()
        names = self._engine.names
        for link in self.scene.all_links():
            binding = names.link(link.scoped)
            self._shift_link(binding, shift)
            self._physics.changed_body(STALE, binding.body)
        for model in self.scene.all_models():
            handle = self._handles.model(model.scoped)
            handle._rest = shift @ handle._rest
        update_loop_joints(self._engine)
        self._physics.changed(STALE)

    def _shift_link(self, binding: LinkBinding, shift: Pose) -> None:
        model, data = self._physics.model, self._physics.data
        mocap, start, body = binding.mocap, binding.root_joint_qpos, binding.body
        if mocap >= 0:
            moved = shift @ Pose(data.mocap_pos[mocap], data.mocap_quat[mocap])
            data.mocap_pos[mocap], data.mocap_quat[mocap] = moved.position, moved.quaternion
        elif start >= 0:
            moved = shift @ Pose(data.qpos[start : start + 3], data.qpos[start + 3 : start + 7])
            data.qpos[start : start + 3], data.qpos[start + 3 : start + 7] = moved.position, moved.quaternion
        elif body and model.body_parentid[body] == 0:
            # fixed or hinged to the world: the pose of the body itself changes
            positions, quaternions = self._engine.touch("body_pos"), self._engine.touch("body_quat")
            moved = shift @ Pose(positions[body], quaternions[body])
            positions[body], quaternions[body] = moved.position, moved.quaternion

    def set_velocity(self, linear: VectorLike, angular: VectorLike = (0.0, 0.0, 0.0)) -> None:
        """Set the twist of every free part of the model about the model's origin, world frame [m/s, rad/s]."""
        self.check_present()
        linear = checked_vector(linear, "linear")
        angular = checked_vector(angular, "angular")
        data, names, origin = self._physics.data, self._engine.names, self.pose.position
        for link in self.scene.all_links():
            binding = names.link(link.scoped)
            start = int(binding.root_joint_qpos)
            if start < 0:
                continue
            dof = int(binding.root_joint_dof)
            arm = data.qpos[start : start + 3] - origin
            data.qvel[dof : dof + 3] = linear + np.cross(angular, arm)
            data.qvel[dof + 3 : dof + 6] = quat_rotate(quat_conjugate(data.qpos[start + 3 : start + 7]), angular)
            self._physics.changed_body(VELOCITY, binding.body)
        update_loop_joints(self._engine)

    def set_joint_positions(self, positions: Mapping[str, float | Sequence[float]]) -> None:
        """Set the present positions of several joints; an error in one of them changes none."""
        self.check_present()
        check_kind(positions, Mapping, "positions", "a dict from names of joints to positions")
        targets = [(self.joint(name), value) for name, value in positions.items()]
        for joint, value in targets:
            joint.check_position(value)
        for joint, value in targets:
            joint.set_position(value)

    def get_state(self) -> Pose:
        """Return the pose of a model without links, for a snapshot."""
        return self._rest

    def set_state(self, state: Pose) -> None:
        """Restore a pose from `get_state`."""
        self._rest = state
