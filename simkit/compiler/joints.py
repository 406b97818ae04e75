"""Joints of the file as MuJoCo's joints, in the tree or closing loops."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import mujoco
import numpy as np

from simkit.compiler.bodies import add_split_body
from simkit.compiler.couplings import LOOP_DAMPING, Couplings
from simkit.compiler.engine_options import SOFT_SOLIMP, contact_time_constant
from simkit.compiler.kinematic_tree import WORLD, TreeEdge
from simkit.compiler.name_map import Follower, JointBinding, ModelRecord
from simkit.diagnostics import Diagnostics
from simkit.linear_algebra import matmul, norm
from simkit.number_text import counted
from simkit.pose import IDENTITY, Pose, Vector
from simkit.scene import Axis, SceneJoint, SceneLink

_UNIT: Final = 1e-6
_RIGID: Final = 1e8


def is_valid_axis(joint: SceneJoint, axis: Axis, diagnostics: Diagnostics) -> bool:
    """Check whether an axis can be simulated. Report errors, and values whose effect may surprise the user."""
    numbers = (axis.damping, axis.friction, axis.stiffness, axis.spring_ref)
    limits = (axis.lower, axis.upper, axis.effort, axis.velocity)
    if not all(map(math.isfinite, (*axis.xyz_world, *numbers))) or any(map(math.isnan, limits)):
        message = f"joint {joint.scoped}: a number of its axis, limits or dynamics is NaN or infinite"
        diagnostics.error("SK-JOINT-003", message, joint.where)
        return False
    if abs(math.hypot(*axis.xyz_world) - 1.0) > _UNIT:
        message = f"joint {joint.scoped}: its axis {axis.xyz_world} has a length of {math.hypot(*axis.xyz_world):g}"
        diagnostics.error("SK-JOINT-002", message, joint.where, "write a unit vector, for example 0 0 1")
        return False
    _report_odd_values(joint, axis, diagnostics)
    return True


def _report_odd_values(joint: SceneJoint, axis: Axis, diagnostics: Diagnostics) -> None:
    if axis.lower > axis.upper:
        message = (
            f"joint {joint.scoped}: its lower limit {axis.lower:g} is above its upper limit {axis.upper:g}; "
            "both limits are ignored"
        )
        diagnostics.warning("SK-JOINT-006", message, joint.where)
    if axis.limit_stiffness is not None and axis.limit_stiffness < _RIGID and math.isfinite(axis.upper - axis.lower):
        message = f"joint {joint.scoped}: its limits are rigid; limit stiffness {axis.limit_stiffness:g} is ignored"
        diagnostics.note("SK-JOINT-014", message, joint.where)
    if axis.velocity == 0.0:
        message = f"joint {joint.scoped} has a velocity limit of 0: it never moves"
        diagnostics.warning("SK-JOINT-008", message, joint.where, "remove <velocity> for a joint without a limit")
    if axis.damping < 0.0 or axis.friction < 0.0 or axis.stiffness < 0.0:
        message = (
            f"joint {joint.scoped}: damping {axis.damping:g}, friction {axis.friction:g}, spring stiffness "
            f"{axis.stiffness:g}: negative values are replaced by 0"
        )
        diagnostics.warning("SK-JOINT-009", message, joint.where)


UNBOUNDED: Final = 1e10
_LOCKED: Final = 1e-6
_HINGE, _SLIDE, _BALL = mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_BALL
_KINDS: Final = {
    "fixed": (),
    "revolute": (_HINGE,),
    "continuous": (_HINGE,),
    "prismatic": (_SLIDE,),
    "universal": (_HINGE, _HINGE),
    "revolute2": (_HINGE, _HINGE),
    "screw": (_HINGE,),
    "ball": (_BALL,),
    "planar": (_SLIDE, _SLIDE, _HINGE),
}


@dataclass(frozen=True, slots=True)
class _JointMotion:
    """MuJoCo joint to add: its axis in the moved body's frame, and the file's axis with its dynamics."""

    name: str
    kind: mujoco.mjtJoint
    direction: Vector
    axis: Axis | None


class JointWriter:
    """Writer of the joints of one top-level model, which it adds to the record.

    Attributes:
        links: links that joints may refer to, by scoped name.
        carriers: heaviest link of each rigid group, by the scoped names of the group's links.
    """

    def __init__(self, spec: mujoco.MjSpec, record: ModelRecord, timestep: float, diagnostics: Diagnostics) -> None:
        self.spec, self.record, self.timestep, self.diagnostics = spec, record, timestep, diagnostics
        self.couplings = Couplings(spec, record, timestep, diagnostics)
        self.links: Mapping[str, SceneLink] = {}
        self.carriers: Mapping[str, str] = {}

    # ------------------------------------------------------------------ in the tree

    def add_tree_joint(self, body: mujoco.MjsBody, link: SceneLink, edge: TreeEdge) -> None:
        """Add to a link's body the joint that connects the link to its parent in the tree."""
        joint = edge.joint
        names, followers = self._add_motions(body, joint, link.pose_world, edge.is_reversed)
        self._bind(
            replace(
                self._binding(joint),
                joint_names=names,
                followers=followers,
                is_reversed=edge.is_reversed,
                carried=link.scoped,
                pose_moved=link.pose_world.inverse() @ joint.pose_world,
            )
        )

    def bind_floating(self, joint: SceneJoint) -> None:
        """Record a floating joint, which constrains nothing.

        Its position is the pose of its child link relative to its parent link.
        """
        child, parent = (self.record.links.get(n) for n in (joint.child_link, joint.parent_link))
        is_reversed = not (child and child.free_joint) and bool(parent and parent.free_joint)
        free = parent if is_reversed else child
        if free is not None and free.free_joint:
            binding = replace(self._binding(joint), joint_names=(free.free_joint,), free=free.scoped)
            self._bind(replace(binding, is_reversed=is_reversed))
            return
        message = f"floating joint {joint.scoped} can be read but not set: another joint constrains {joint.child_link}"
        self.diagnostics.warning("SK-JOINT-005", message, joint.where)
        self._bind(self._binding(joint))

    def bind_static(self, joint: SceneJoint, is_expected: bool = True) -> None:
        """Record a joint between links that never move: it has a name and no degree of freedom."""
        if not is_expected and joint.type != "fixed":
            message = (
                f"joint {joint.scoped} ({joint.type}) joins {joint.parent_link} and {joint.child_link}, "
                "which are both static: it never moves"
            )
            self.diagnostics.warning("SK-JOINT-004", message, joint.where)
        self._bind(self._binding(joint))

    def _add_motions(
        self, body: mujoco.MjsBody, joint: SceneJoint, at: Pose, is_reversed: bool
    ) -> tuple[tuple[str, ...], tuple[Follower, ...]]:
        """Add the motions of a joint to a body at the world pose `at`.

        If the joint is reversed, the body is the parent link of the file. The same motions are then added in opposite
        order and direction.

        Returns:
            Names of the MuJoCo joints in the order of the file's axes, and the hidden followers.
        """
        motions = self._motions(joint, at, is_reversed)
        frame = at.inverse() @ joint.pose_world
        followers: tuple[Follower, ...] = ()
        for motion in reversed(motions) if is_reversed else motions:
            made = self._joint(body, motion.name, motion.kind, frame, motion.direction)
            if motion.axis is not None:
                write_dynamics(made, motion.axis)
        if joint.type == "screw" and motions:
            followers = (self._thread(body, joint, frame, motions[0].direction),)
        return tuple(m.name for m in motions), followers

    def _motions(self, joint: SceneJoint, at: Pose, is_reversed: bool) -> list[_JointMotion]:
        if joint.type not in _KINDS:
            message = f"joint {joint.scoped}: unknown type {joint.type} is simulated as fixed"
            self.diagnostics.warning("SK-PHYS-013", message, joint.where)
            return []
        kinds = _KINDS[joint.type]
        axes: list[Axis | None] = list(joint.axes)
        sign = -1.0 if is_reversed else 1.0
        if joint.type == "ball":
            directions = [np.array((0.0, 0.0, 1.0))]
            axes = [*axes, None]
        elif joint.type == "planar" and len(axes) < 3:
            directions = _plane_axes(joint, at)
            axes = [*axes, None, None, None] if len(axes) != 1 else [*axes, *axes, *axes]
        elif len(axes) < len(kinds):
            message = f"joint {joint.scoped} ({joint.type}) needs {counted(len(kinds), 'axis', 'axes')}"
            self.diagnostics.error("SK-PHYS-019", message, joint.where)
            return []
        else:
            directions = [at.inverse().rotate(a.xyz_world) for a in joint.axes]
        if not all(is_valid_axis(joint, a, self.diagnostics) for a in joint.axes):
            return []
        names = [joint.scoped if i == 0 else f"{joint.scoped}#{i}" for i in range(len(kinds))]
        return [
            _JointMotion(name, kind, sign * direction, axis)
            for name, kind, direction, axis in zip(names, kinds, directions, axes, strict=False)
        ]

    def _joint(
        self, body: mujoco.MjsBody, name: str, kind: mujoco.mjtJoint, frame: Pose, axis: Vector
    ) -> mujoco.MjsJoint:
        joint = body.add_joint(name=name, type=kind, pos=frame.position, axis=axis)
        constant = contact_time_constant(self.timestep)
        joint.solref_limit = (constant, 1.0)
        joint.solimp_limit = SOFT_SOLIMP
        joint.solref_friction = (constant, 1.0)
        joint.solimp_friction = SOFT_SOLIMP
        return joint

    def _thread(self, body: mujoco.MjsBody, joint: SceneJoint, frame: Pose, direction: Vector) -> Follower:
        """Add the sliding motion of a screw, coupled to its rotation."""
        slide, ratio = f"{joint.scoped}#slide", joint.thread_pitch / (2.0 * math.pi)
        self._joint(body, slide, _SLIDE, frame, direction)
        self.couplings.couple(f"{joint.scoped}#thread", slide, joint.scoped, 0.0, ratio)
        message = f"screw joint {joint.scoped} is a stiff constraint between turning and sliding"
        self.diagnostics.note("SK-PHYS-009", message, joint.where)
        return Follower(slide, ratio)

    # ------------------------------------------------------------------ loops

    def add_loop_joint(self, joint: SceneJoint, reason: str = "closes a loop") -> None:
        """Add a joint that closes a loop, or another joint outside the tree for a `reason`.

        The joint moves a twin of its child link, and a weld fixes the twin to the link. The joint therefore has a
        coordinate, limits, dynamics and drives like any other joint. The twin receives a fraction of the link's mass.
        """
        is_reversed = self._body_name(joint.child_link) == WORLD
        moved, under = (joint.parent_link, joint.child_link) if is_reversed else (joint.child_link, joint.parent_link)
        carrier = self.carriers.get(moved, moved)
        at, twin = self._body_pose(carrier), f"{joint.scoped}#twin"
        has_motion = bool(_KINDS.get(joint.type))
        pose = self._body_pose(under).inverse() @ at
        body = add_split_body(self.spec, twin, self._body_name(carrier), self._body_name(under), pose, has_motion)
        if self._body_name(under) == WORLD:
            self.record.root_bodies.append(twin)
        names, followers = self._add_motions(body, joint, at, is_reversed)
        weld, thread = f"{joint.scoped}#loop", f"{joint.scoped}#thread"
        anchor = at.inverse() @ joint.pose_world
        self.couplings.weld(weld, twin, self._body_name(carrier), anchor.position, damping=LOOP_DAMPING)
        message = f"joint {joint.scoped} {reason}: it is held by a constraint"
        self.diagnostics.note("SK-PHYS-020", message, joint.where)
        self._bind(
            replace(
                self._binding(joint),
                joint_names=names,
                followers=followers,
                is_loop=True,
                is_reversed=is_reversed,
                equalities=(weld, thread) if followers else (weld,),
                twin=twin,
                carried=carrier,
                pose_moved=anchor,
            )
        )

    def add_gearbox(self, joint: SceneJoint) -> None:
        """Add a gearbox as a constraint between two joints."""
        names = self.couplings.gear(joint)
        self._bind(replace(self._binding(joint), equalities=names))

    def add_weld(self, name: str, parent: str, child: str, active: bool) -> None:
        """Add a weld between two links at their poses in the file, without a joint."""
        anchor = self._body_pose(parent).inverse() @ self.links[child].pose_world
        self.couplings.weld(name, self._body_name(child), self._body_name(parent), anchor.position, active)

    # ------------------------------------------------------------------ bindings

    def _body_pose(self, link: str) -> Pose:
        """Return the world pose in the file of the body that represents a link."""
        binding = self.record.links.get(link)
        return self.links[link].pose_world @ binding.offset.inverse() if binding else IDENTITY

    def _body_name(self, link: str) -> str:
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

    def _bind(self, binding: JointBinding) -> None:
        self.record.joints[binding.scoped] = binding


def write_dynamics(made: mujoco.MjsJoint, axis: Axis) -> None:
    """Write damping, friction, spring and limits of an axis to a MuJoCo joint; every field is set."""
    made.damping[0] = max(0.0, axis.damping)
    made.frictionloss = max(0.0, axis.friction)
    if made.type == _BALL:
        return
    has_spring = axis.stiffness > 0.0
    made.stiffness[0], made.springref = (axis.stiffness, axis.spring_ref) if has_spring else (0.0, 0.0)
    lower, upper = max(axis.lower, -UNBOUNDED), min(axis.upper, UNBOUNDED)
    made.limited, made.range = mujoco.mjtLimited.mjLIMITED_FALSE, (0.0, 0.0)
    if lower <= upper and (lower > -UNBOUNDED or upper < UNBOUNDED):
        if upper - lower < 2 * _LOCKED:
            middle = (lower + upper) / 2
            lower, upper = middle - _LOCKED, middle + _LOCKED
        made.limited, made.range = mujoco.mjtLimited.mjLIMITED_TRUE, (lower, upper)


def _plane_axes(joint: SceneJoint, at: Pose) -> list[Vector]:
    """Return the x axis, the y axis and the normal of a planar joint, for which the file has only the normal.

    x and y are as near to the axes of the joint frame as possible.
    """
    back = at.inverse()
    normal = np.asarray(joint.axes[0].xyz_world if joint.axes else joint.pose_world.rotate((0.0, 0.0, 1.0)))
    x = joint.pose_world.rotate((1.0, 0.0, 0.0))
    if abs(float(matmul(x, normal))) > 0.9:
        x = joint.pose_world.rotate((0.0, 1.0, 0.0))
    x = x - float(matmul(x, normal)) * normal
    x = x / norm(x)
    return [back.rotate(x), back.rotate(np.cross(normal, x)), back.rotate(normal)]
