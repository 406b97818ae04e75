"""Reader of the joints of a compiled file."""

from __future__ import annotations

import math
from typing import Final

from simkit.loaders.mjcf.compiled_file import CompiledFile, ModelPlacement
from simkit.pose import Pose
from simkit.scene import Axis, Mimic, SceneJoint
from simkit.scene.geometry import vec3
from simkit.scene.mjcf_source import MjcfElements

_FREE, _BALL, _SLIDE, _HINGE = range(4)
_EQUAL_JOINTS: Final = 2
_TYPES: Final = {_BALL: "ball", _SLIDE: "prismatic"}


def read_joints(
    file: CompiledFile, body: int, placed: ModelPlacement, file_pose: Pose, elements: MjcfElements
) -> list[SceneJoint]:
    """Return the joints between a body and its parent.

    A body without joints gets a fixed joint. A free joint is not returned: `elements.free` receives its name.

    Args:
        file: the compiled file.
        body: id of the body.
        placed: the model that the body belongs to.
        file_pose: pose of the file's world in the world.
        elements: receives the names of the joints.
    """
    model = file.model
    child, parent = file.scoped_link(body, placed), file.scoped_link(int(model.body_parentid[body]), placed)
    if int(model.body_parentid[body]) == 0:
        parent = "world"
    numbers = list(range(model.body_jntadr[body], model.body_jntadr[body] + model.body_jntnum[body]))
    is_free = bool(numbers) and int(model.jnt_type[numbers[0]]) == _FREE
    pose, where = file_pose @ file.pose(body), file.where("body", file.name("BODY", body))
    if is_free and placed.base != "fixed":
        elements.free[child] = file.name("JOINT", numbers[0])
        return []
    if not numbers and parent == "world" and placed.base == "floating":
        elements.free[child] = f"{file.name('BODY', body)}_free"
        return []
    if is_free or not numbers:
        if int(model.body_mocapid[body]) >= 0:
            return []
        name = f"{file.link_name(body, placed)}_fixed"
        while file.spec.joint(name) is not None:
            name += "_"
        scoped = f"{placed.scoped}::{name}"
        elements.joints[scoped] = ""
        return [SceneJoint(name, scoped, "fixed", parent, child, pose, where=where)]
    return [_joint(file, j, placed, pose, parent, child, elements) for j in numbers]


def _joint(
    file: CompiledFile, j: int, placed: ModelPlacement, body: Pose, parent: str, child: str, elements: MjcfElements
) -> SceneJoint:
    model, full = file.model, file.name("JOINT", j)
    name = full.removeprefix(placed.strip)
    scoped = f"{placed.scoped}::{name}"
    elements.joints[scoped] = full
    kind = int(model.jnt_type[j])
    return SceneJoint(
        name=name,
        scoped=scoped,
        type=_TYPES.get(kind, "revolute" if model.jnt_limited[j] else "continuous"),
        parent_link=parent,
        child_link=child,
        pose_world=body @ Pose(model.jnt_pos[j]),
        axes=() if kind == _BALL else (_axis(file, j, body),),
        where=file.where("joint", full),
    )


def _axis(file: CompiledFile, j: int, body: Pose) -> Axis:
    model = file.model
    dof = int(model.jnt_dofadr[j])
    direction = vec3(model.jnt_axis[j])
    low, high = (float(v) for v in model.jnt_range[j]) if model.jnt_limited[j] else (-math.inf, math.inf)
    effort = float(abs(model.jnt_actfrcrange[j]).max()) if model.jnt_actfrclimited[j] else math.inf
    return Axis(
        xyz_world=vec3(body.rotate(direction)),
        xyz_joint=direction,
        lower=low,
        upper=high,
        effort=effort,
        damping=float(model.dof_damping[dof]),
        friction=float(model.dof_frictionloss[dof]),
        stiffness=float(model.jnt_stiffness[j]),
        spring_ref=float(model.qpos_spring[model.jnt_qposadr[j]]),
        mimic=_mimic(file, j),
    )


def _mimic(file: CompiledFile, j: int) -> Mimic | None:
    """Return the leader of a joint that follows another joint linearly through an equality constraint."""
    model = file.model
    for e in file.equalities_of.get(j, ()):
        data = model.eq_data[e]
        if int(model.eq_type[e]) != _EQUAL_JOINTS:
            continue
        leader = int(model.eq_obj2id[e])
        if leader < 0 or not model.eq_active0[e] or data[2:5].any():
            continue
        rest, start = (float(model.qpos0[model.jnt_qposadr[k]]) for k in (j, leader))
        ratio = float(data[1])
        return Mimic(file.name("JOINT", leader), 0, ratio, rest + float(data[0]) - ratio * start)
    return None
