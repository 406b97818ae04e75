"""Joints between models that close no loop: to set such a joint, the models on one side of it are moved."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit.compiler import JointBinding
from simkit.pose import Pose, quat_conjugate, quat_rotate
from simkit.runtime.engine.physics_state import STALE, VELOCITY
from simkit.runtime.handles.joint_mechanics import body_velocity

if TYPE_CHECKING:
    from simkit.runtime.engine.engine_state import EngineState

_FREE: Final = int(mujoco.mjtJoint.mjJNT_FREE)


@dataclass(frozen=True, slots=True)
class LooseSide:
    """Side of a joint that nothing else connects to the other side or to the world.

    Attributes:
        roots: bodies with a free joint that carry everything on this side.
        has_twin: True if the joint's twin body is on this side, so that this side has to move against the twin.
    """

    roots: tuple[int, ...]
    has_twin: bool


def loose_side(engine: EngineState, binding: JointBinding) -> LooseSide | None:
    """Return the side of a joint that can be moved freely; None if the joint closes a loop."""
    moved, other = binding.scene.child_link, binding.scene.parent_link
    if binding.is_reversed:
        moved, other = other, moved
    links = _active_connections(engine, binding)
    start, end = _root(engine, moved), _root(engine, other)
    for first, last, has_twin in ((start, end, False), (end, start, True)):
        roots = _connected(first, links)
        if last in roots:
            return None
        if all(_is_free(engine.mj_model, root) for root in roots):
            return LooseSide(tuple(sorted(roots)), has_twin)
    return None


def align_poses(engine: EngineState, binding: JointBinding, side: LooseSide) -> None:
    """Move a side as a whole, so that the joint's twin and its link have the same pose; velocities stay the same."""
    model, data = engine.mj_model, engine.mj_data
    mujoco.mj_kinematics(model, data)
    body, twin = engine.names.link(binding.carried).body, binding.moved_body
    link, target = Pose(data.xpos[body], data.xquat[body]), Pose(data.xpos[twin], data.xquat[twin])
    shift = link @ target.inverse() if side.has_twin else target @ link.inverse()
    for root in side.roots:
        start = int(model.jnt_qposadr[model.body_jntadr[root]])
        pose = shift @ Pose(data.qpos[start : start + 3], data.qpos[start + 3 : start + 7])
        data.qpos[start : start + 3], data.qpos[start + 3 : start + 7] = pose.position, pose.quaternion
        engine.physics.changed_body(STALE, root)


def align_velocities(engine: EngineState, binding: JointBinding, side: LooseSide) -> None:
    """Add a rigid motion to a side, so that the joint's twin and its link have the same velocity."""
    model, data = engine.mj_model, engine.mj_data
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    body = engine.names.link(binding.carried).body
    change = body_velocity(engine, binding.moved_body) - body_velocity(engine, body)
    linear, angular = np.split(-change if side.has_twin else change, 2)
    for root in side.roots:
        joint = model.body_jntadr[root]
        start, dof = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
        arm = data.qpos[start : start + 3] - data.xpos[body]
        data.qvel[dof : dof + 3] += linear + np.cross(angular, arm)
        data.qvel[dof + 3 : dof + 6] += quat_rotate(quat_conjugate(data.qpos[start + 3 : start + 7]), angular)
        engine.physics.changed_body(VELOCITY, root)


def _active_connections(engine: EngineState, without: JointBinding) -> dict[int, set[int]]:
    """Return the roots that constraints connect to each root, except for one joint."""
    links: dict[int, set[int]] = {}
    for binding in engine.names.joints.values():
        numbers = [mujoco.mj_name2id(engine.mj_model, mujoco.mjtObj.mjOBJ_EQUALITY, n) for n in binding.equalities]
        if binding.is_loop and binding is not without and any(engine.mj_data.eq_active[n] for n in numbers):
            parent, child = _root(engine, binding.scene.parent_link), _root(engine, binding.scene.child_link)
            links.setdefault(parent, set()).add(child)
            links.setdefault(child, set()).add(parent)
    return links


def _connected(start: int, links: dict[int, set[int]]) -> set[int]:
    """Return the roots that constraints connect to a root; they do not connect through the world."""
    roots, stack = {start}, [start]
    while stack:
        root = stack.pop()
        new = links.get(root, set()) - roots if root else set()
        roots |= new
        stack += new
    return roots


def _root(engine: EngineState, link: str) -> int:
    """Return the root body of a link's tree; 0 for the world and for static links."""
    binding = engine.names.links.get(link)
    return 0 if binding is None else int(engine.mj_model.body_rootid[binding.body])


def _is_free(model: mujoco.MjModel, root: int) -> bool:
    return bool(root and model.body_jntnum[root] and model.jnt_type[model.body_jntadr[root]] == _FREE)
