"""Joints of the file as MuJoCo's joints and equality constraints."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Final

import mujoco
import numpy as np

from simkit.compiler.names import Follower, JointBinding, ModelRecord
from simkit.compiler.options import CONTACT_SOLIMP, contact_time_constant
from simkit.compiler.tree import WORLD, Edge
from simkit.diagnostics import Diagnostics
from simkit.pose import IDENTITY, Pose
from simkit.scene import Axis, SceneJoint, SceneLink

STIFF_SOLIMP: Final = (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""Impedance of equality constraints that stand for a mechanism: as hard as the solver takes."""

_UNBOUNDED: Final = 1e10
_LOCKED: Final = 1e-6


class JointWriter:
    """Writes the joints of one top-level model and notes where each of them lives."""

    def __init__(self, spec: mujoco.MjSpec, record: ModelRecord, timestep: float, diagnostics: Diagnostics) -> None:
        self.spec, self.record, self.timestep, self.diagnostics = spec, record, timestep, diagnostics
        self.links: dict[str, SceneLink] = {}

    # ------------------------------------------------------------------ tree joints

    def hang(self, body: Any, link: SceneLink, edge: Edge) -> None:
        """Adds the joint by which `link` hangs in the tree to its body."""
        joint = edge.joint
        frame = link.pose_world.inverse() @ joint.pose_world
        axes = [self._axis_of(link, a, edge.is_reversed) for a in joint.axes]
        kind = mujoco.mjtJoint
        names: list[str] = []
        followers: tuple[Follower, ...] = ()
        hinges = {"revolute": 1, "continuous": 1, "universal": 2, "revolute2": 2}.get(joint.type, 0)
        if hinges:
            names = self._scalars(body, joint, frame, axes, [kind.mjJNT_HINGE] * hinges)
        elif joint.type == "prismatic":
            names = self._scalars(body, joint, frame, axes, [kind.mjJNT_SLIDE])
        elif joint.type == "ball":
            names = [self._joint(body, joint.scoped, kind.mjJNT_BALL, frame, (0, 0, 1)).name]
            self._loss(body, joint)
        elif joint.type == "screw":
            names, followers = self._screw(body, joint, frame, axes)
        elif joint.type == "planar":
            names = self._planar(body, joint, frame, axes)
        elif joint.type == "floating":
            names = self._floating(body, joint, frame, edge)
        elif joint.type != "fixed":
            self.diagnostics.warning(
                "SK-PHYS-013", f"joint {joint.scoped}: type {joint.type} is taken as fixed", joint.where
            )
        self._note(
            replace(self._binding(joint), joint_names=tuple(names), followers=followers, is_reversed=edge.is_reversed)
        )

    def _axis_of(self, link: SceneLink, axis: Axis, is_reversed: bool) -> tuple[float, float, float]:
        x, y, z = link.pose_world.inverse().rotate(axis.xyz_world)
        sign = -1.0 if is_reversed else 1.0
        return sign * float(x), sign * float(y), sign * float(z)

    def _scalars(self, body: Any, joint: SceneJoint, frame: Pose, axes: list[Any], kinds: list[Any]) -> list[str]:
        names: list[str] = []
        for i, kind in enumerate(kinds):
            if i >= len(axes):
                self.diagnostics.error(
                    "SK-PHYS-019", f"joint {joint.scoped} ({joint.type}) needs {len(kinds)} axes", joint.where
                )
                return names
            name = joint.scoped if i == 0 else f"{joint.scoped}#{i}"
            made = self._joint(body, name, kind, frame, axes[i])
            self._dynamics(made, joint.axes[i])
            names.append(name)
        return names

    def _joint(self, body: Any, name: str, kind: Any, frame: Pose, axis: Any) -> Any:
        joint = body.add_joint(name=name, type=kind, pos=frame.position, axis=axis)
        constant = contact_time_constant(self.timestep)
        joint.solref_limit = (constant, 1.0)
        joint.solimp_limit = CONTACT_SOLIMP
        joint.solref_friction = (constant, 1.0)
        joint.solimp_friction = CONTACT_SOLIMP
        return joint

    def _dynamics(self, made: Any, axis: Axis) -> None:
        made.damping[0] = max(0.0, axis.damping)
        made.frictionloss = max(0.0, axis.friction)
        if axis.stiffness > 0.0:
            made.stiffness[0] = axis.stiffness
            made.springref = axis.spring_ref
        lower, upper = max(axis.lower, -_UNBOUNDED), min(axis.upper, _UNBOUNDED)
        if lower > -_UNBOUNDED or upper < _UNBOUNDED:
            if upper - lower < 2 * _LOCKED:
                middle = (lower + upper) / 2
                lower, upper = middle - _LOCKED, middle + _LOCKED
            made.limited = mujoco.mjtLimited.mjLIMITED_TRUE
            made.range = (lower, upper)

    def _loss(self, body: Any, joint: SceneJoint) -> None:
        """Damping and friction of a ball joint, where the file gives it an axis with dynamics."""
        if joint.axes:
            body.joints[-1].damping[0] = max(0.0, joint.axes[0].damping)
            body.joints[-1].frictionloss = max(0.0, joint.axes[0].friction)

    def _screw(
        self, body: Any, joint: SceneJoint, frame: Pose, axes: list[Any]
    ) -> tuple[list[str], tuple[Follower, ...]]:
        names = self._scalars(body, joint, frame, axes, [mujoco.mjtJoint.mjJNT_HINGE])
        if not names:
            return [], ()
        slide = f"{joint.scoped}#slide"
        self._joint(body, slide, mujoco.mjtJoint.mjJNT_SLIDE, frame, axes[0])
        ratio = joint.thread_pitch / (2.0 * math.pi)
        self._couple(f"{joint.scoped}#thread", slide, joint.scoped, 0.0, ratio)
        self.diagnostics.note(
            "SK-PHYS-009",
            f"screw joint {joint.scoped} is a stiff constraint between turning and sliding",
            joint.where,
        )
        return names, (Follower(slide, ratio),)

    def _planar(self, body: Any, joint: SceneJoint, frame: Pose, axes: list[Any]) -> list[str]:
        normal = np.asarray(axes[0] if axes else (0.0, 0.0, 1.0))
        x = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
        x /= np.linalg.norm(x)
        y = np.cross(normal, x)
        kinds = (mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE)
        names = [joint.scoped, f"{joint.scoped}#1", f"{joint.scoped}#2"]
        for name, kind, axis in zip(names, kinds, (x, y, normal), strict=True):
            made = self._joint(body, name, kind, frame, axis)
            if joint.axes:
                made.damping[0] = max(0.0, joint.axes[0].damping)
        return names

    def _floating(self, body: Any, joint: SceneJoint, frame: Pose, edge: Edge) -> list[str]:
        if edge.parent == WORLD:
            body.add_freejoint(name=joint.scoped)
            return [joint.scoped]
        names = [joint.scoped, f"{joint.scoped}#1", f"{joint.scoped}#2", f"{joint.scoped}#3"]
        for name, axis in zip(names, np.eye(3), strict=False):
            self._joint(body, name, mujoco.mjtJoint.mjJNT_SLIDE, frame, axis)
        self._joint(body, names[3], mujoco.mjtJoint.mjJNT_BALL, frame, (0, 0, 1))
        return names

    # ------------------------------------------------------------------ constraints

    def close(self, joint: SceneJoint) -> None:
        """Adds the equality constraints of a joint that closes a loop."""
        kinds = mujoco.mjtEq
        points: list[Any] = [joint.pose_world.position]
        kind = kinds.mjEQ_CONNECT
        if joint.type == "fixed":
            kind = kinds.mjEQ_WELD
        elif joint.type in ("revolute", "continuous") and joint.axes:
            points.append(joint.pose_world.position + 0.1 * np.asarray(joint.axes[0].xyz_world))
        elif joint.type not in ("ball", "universal"):
            self.diagnostics.warning(
                "SK-PHYS-013", f"joint {joint.scoped}: a {joint.type} joint that closes a loop is left out", joint.where
            )
            self._note(replace(self._binding(joint), is_loop=True))
            return
        names = []
        for i, point in enumerate(points):
            name = f"{joint.scoped}#loop{i}"
            self.tie(name, kind, joint.parent_link, joint.child_link, point)
            names.append(name)
        self.diagnostics.note(
            "SK-PHYS-020",
            f"joint {joint.scoped} closes a loop: it is held by a constraint, its position cannot be read",
            joint.where,
        )
        self._note(replace(self._binding(joint), is_loop=True, equalities=tuple(names)))

    def tie(
        self, name: str, kind: mujoco.mjtEq, parent: str, child: str, point_world: Any, active: bool = True
    ) -> None:
        """A connect or weld equality between two links as they stand in the file."""
        equality = self.spec.add_equality(name=name)
        equality.type = kind
        equality.objtype = mujoco.mjtObj.mjOBJ_BODY
        equality.name1, equality.name2 = self._body(child), self._body(parent)
        data = np.zeros(len(equality.data))
        if kind == mujoco.mjtEq.mjEQ_CONNECT:
            data[:3] = self._pose_of(child).inverse().transform(point_world)
        else:
            # A relative pose of zeros lets MuJoCo take the one of the file.
            data[:3] = self._pose_of(parent).inverse().transform(point_world)
            data[10] = 1.0
        equality.data = data
        equality.active = active
        self._stiff(equality)
        self.record.equalities.append(name)

    def gear(self, joint: SceneJoint) -> None:
        """A gearbox: theta_2 = −ratio · theta_1, both measured from the reference link (SDF's definition)."""
        first = self._turning(joint, joint.parent_link, 0)
        second = self._turning(joint, joint.child_link, 1)
        names: tuple[str, ...] = ()
        if first is None or second is None:
            self.diagnostics.warning(
                "SK-PHYS-021",
                f"gearbox {joint.scoped} is left out: its links need a revolute joint to the reference link "
                f"{joint.gearbox_reference or '(none)'} along its axes",
                joint.where,
            )
        else:
            name = f"{joint.scoped}#gear"
            self._couple(name, second[0], first[0], 0.0, -joint.gearbox_ratio * first[1] * second[1])
            self.diagnostics.note(
                "SK-PHYS-009", f"gearbox {joint.scoped} is a stiff constraint between two joints", joint.where
            )
            names = (name,)
        self._note(replace(self._binding(joint), equalities=names))

    def _turning(self, joint: SceneJoint, link: str, axis: int) -> tuple[str, float] | None:
        """The hinge between the reference link and `link`, and the sign of its angle along the gearbox' axis."""
        for other in self.record.joints.values():
            ends = {other.scene.parent_link, other.scene.child_link}
            if (
                other.type in ("revolute", "continuous")
                and ends == {joint.gearbox_reference, link}
                and other.joint_names
            ):
                along = joint.axes[axis].xyz_world if axis < len(joint.axes) else other.scene.axes[0].xyz_world
                sign = 1.0 if float(np.dot(along, other.scene.axes[0].xyz_world)) >= 0.0 else -1.0
                return other.joint_names[0], sign if other.scene.child_link == link else -sign
        return None

    def mimics(self, joints: list[SceneJoint]) -> None:
        """Couples every axis with a `<mimic>` to its leader."""
        for joint in joints:
            for i, axis in enumerate(joint.axes):
                if axis.mimic is None:
                    continue
                follower = self.record.joints.get(joint.scoped)
                leader = self.record.joints.get(axis.mimic.joint) or self.record.joints.get(
                    joint.scoped.removesuffix(joint.name) + axis.mimic.joint
                )
                if (
                    follower is None
                    or leader is None
                    or i >= len(follower.joint_names)
                    or axis.mimic.axis >= len(leader.joint_names)
                ):
                    self.diagnostics.warning(
                        "SK-PHYS-022",
                        f"joint {joint.scoped} mimics {axis.mimic.joint}, which has no such axis; left out",
                        joint.where,
                    )
                    continue
                m = axis.mimic
                self._couple(
                    f"{joint.scoped}#mimic{i}",
                    follower.joint_names[i],
                    leader.joint_names[m.axis],
                    m.offset - m.multiplier * m.reference,
                    m.multiplier,
                )

    def _couple(self, name: str, follower: str, leader: str, offset: float, ratio: float) -> None:
        equality = self.spec.add_equality(name=name)
        equality.type = mujoco.mjtEq.mjEQ_JOINT
        equality.objtype = mujoco.mjtObj.mjOBJ_JOINT
        equality.name1, equality.name2 = follower, leader
        data = np.zeros(len(equality.data))
        data[:2] = offset, ratio
        equality.data = data
        self._stiff(equality)
        self.record.equalities.append(name)

    def _stiff(self, equality: Any) -> None:
        equality.solref = (max(2.0 * self.timestep, 0.002), 1.0)
        equality.solimp = STIFF_SOLIMP

    # ------------------------------------------------------------------ bindings

    def unmoving(self, joint: SceneJoint) -> None:
        """Notes a joint of a static model: it is there by name and has no degree of freedom."""
        self._note(self._binding(joint))

    def _pose_of(self, link: str) -> Pose:
        """World pose of the body that carries a link."""
        return self.links[link].pose_world if self._body(link) != WORLD else IDENTITY

    def _body(self, link: str) -> str:
        binding = self.record.links.get(link)
        return binding.body_name if binding else WORLD

    def _binding(self, joint: SceneJoint) -> JointBinding:
        child, parent = self.links.get(joint.child_link), self.links.get(joint.parent_link)
        return JointBinding(
            scoped=joint.scoped,
            type=joint.type,
            scene=joint,
            model=self.record.scene.scoped,
            pose_child=child.pose_world.inverse() @ joint.pose_world if child else joint.pose_world,
            pose_parent=parent.pose_world.inverse() @ joint.pose_world if parent else joint.pose_world,
        )

    def _note(self, binding: JointBinding) -> None:
        self.record.joints[binding.scoped] = binding
