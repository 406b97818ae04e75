"""Initial positions of joints that cannot start at 0, the position of the file."""

from __future__ import annotations

import math
from collections.abc import Container, Iterable
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.name_map import JointBinding, NameMap
from simkit.diagnostics import Diagnostics
from simkit.elementary_functions import arctan2
from simkit.linear_algebra import dot, norm
from simkit.scene import Axis

_PARALLEL: Final = 0.99
"""Least cosine between the axes of two joints of a leg that fold against each other."""

_DOWNWARD: Final = 0.7
"""Least cosine between the vertical and the direction from a joint to the foot below it."""

_FREE, _HINGE = mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_HINGE
_Floats = npt.NDArray[np.float64]


def place_joints(model: mujoco.MjModel, data: mujoco.MjData, joints: Iterable[JointBinding]) -> dict[str, float]:
    """Set the initial positions of joints that cannot start at 0.

    A joint whose limits exclude 0 starts at its nearest limit. At 0, the limit would throw the robot: it corrects 0.9
    rad within some steps. If the joint is the knee of a leg of a free robot, the parallel joint above it turns back, so
    that the foot stays below this joint and the robot does not fall over. Followers with an offset start where their
    constraints have no error. Joints of a model with a closed loop or a gearbox start at 0, because another start would
    open the loop.

    Returns:
        Initial positions [rad or m] by the scoped name of the joint, for the joints that do not start at 0.
    """
    joints, starts = list(joints), dict[str, float]()
    closed = {joint.model for joint in joints if joint.is_loop or joint.type == "gearbox"}
    single = [j for j in joints if j.type in ("revolute", "continuous", "prismatic") and len(j.qpos) == 1]
    movable = [j for j in single if j.model not in closed and j.scene.axes[0].mimic is None]
    for joint in movable:
        limit = _nearest_limit(joint.scene.axes[0])
        if limit and data.qpos[joint.qpos[0]] == 0.0:
            starts[joint.scoped] = limit
    _fold_legs(model, movable, starts)
    for joint in joints:
        start = starts.get(joint.scoped, 0.0)
        if start:
            data.qpos[joint.qpos[0]] = start
        for follower in joint.followers:
            first = follower.offset + (follower.ratio * start if follower.axis == 0 else 0.0)
            if first and follower.qpos >= 0:
                data.qpos[follower.qpos] = first
    return starts


def report_starts(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    names: NameMap,
    diagnostics: Diagnostics,
    models: Container[str] | None = None,
) -> None:
    """Report the joints whose limits exclude 0, and the joints that do not start at 0 because of them.

    Call this after the plugins are loaded: a joint to which a plugin gave another position, such as an `initial_value`
    of ros2_control, is not reported.

    Args:
        model: compiled model.
        data: first state.
        names: names of the compiled model.
        diagnostics: receives the warnings.
        models: top-level models whose joints are reported; None for all models.
    """
    joints = names.joints.values()
    starts = place_joints(model, mujoco.MjData(model), joints)
    for joint in joints:
        if models is not None and joint.model not in models:
            continue
        if len(joint.qpos) == 1 and data.qpos[joint.qpos[0]] != starts.get(joint.scoped, 0.0):
            continue
        limits = [(axis, limit) for axis in joint.scene.axes if joint.qpos and (limit := _nearest_limit(axis))]
        for axis, limit in limits:
            start = f"it starts at {limit:g}" if joint.scoped in starts else "the first steps push it inside"
            text = f"joint {joint.scoped}: its limits [{axis.lower:g}, {axis.upper:g}] exclude 0, its position in the "
            hint = "limits are relative to the pose in the file"
            diagnostics.warning("SK-JOINT-007", f"{text}file: {start}", joint.scene.where, hint)
        if not limits and joint.scoped in starts:
            text = f"joint {joint.scoped} starts at {starts[joint.scoped]:.3g}, so that the foot is below it: the knee"
            hint = "give initial positions, for example in <ros2_control>"
            diagnostics.note("SK-JOINT-018", f"{text} starts at its limit", joint.scene.where, hint)


def _nearest_limit(axis: Axis) -> float:
    """Return the limit that is closest to 0 if the limits exclude 0; else 0."""
    if axis.lower > axis.upper:
        return 0.0
    return axis.lower if axis.lower > 0.0 else min(axis.upper, 0.0)


def _fold_legs(model: mujoco.MjModel, joints: Iterable[JointBinding], starts: dict[str, float]) -> None:
    """Add the starts of joints above a knee that starts at its limit; they keep the foot below the joint."""
    by_id = {joint.joint_ids[0]: joint for joint in joints}
    knees = [(i, j) for i, j in by_id.items() if j.scoped in starts and model.jnt_type[i] == _HINGE]
    if not knees:
        return
    zero, folded = mujoco.MjData(model), mujoco.MjData(model)
    for _, joint in knees:
        folded.qpos[joint.qpos[0]] = starts[joint.scoped]
    for data in (zero, folded):
        mujoco.mj_kinematics(model, data)
    for knee, _ in knees:
        body = int(model.jnt_bodyid[knee])
        root = int(model.body_jntadr[model.body_rootid[body]])
        hip = _parallel_joint_above(model, zero, knee)
        upper = by_id.get(hip)
        if root < 0 or model.jnt_type[root] != _FREE or upper is None or upper.scoped in starts:
            continue
        foot, axis, anchor = _farthest_geom(model, zero, knee), zero.xaxis[hip], zero.xanchor[hip]
        if foot < 0:
            continue
        before, after = (_across(data.geom_xpos[foot] - anchor, axis) for data in (zero, folded))
        if before[2] > -_DOWNWARD * max(norm(before), 1e-9):
            continue
        turn = float(arctan2(dot(np.cross(before, after), axis), dot(before, after)))
        limits = upper.scene.axes[0]
        if turn and limits.lower <= -turn <= limits.upper:
            starts[upper.scoped] = -turn


def _parallel_joint_above(model: mujoco.MjModel, data: mujoco.MjData, knee: int) -> int:
    """Return the nearest hinge above a joint in the tree whose axis is parallel; -1 if there is none."""
    body = int(model.body_parentid[model.jnt_bodyid[knee]])
    while body > 0:
        for joint in range(int(model.body_jntadr[body]), int(model.body_jntadr[body] + model.body_jntnum[body])):
            if model.jnt_type[joint] == _HINGE and abs(dot(data.xaxis[joint], data.xaxis[knee])) > _PARALLEL:
                return joint
        body = int(model.body_parentid[body])
    return -1


def _farthest_geom(model: mujoco.MjModel, data: mujoco.MjData, joint: int) -> int:
    """Return the colliding geom below a joint in the tree that is farthest from its axis: the foot; -1 without any."""
    below = {int(model.jnt_bodyid[joint])}
    for body in range(min(below) + 1, model.nbody):
        if int(model.body_parentid[body]) in below:
            below.add(body)
    farthest, largest = -1, 0.0
    for geom in range(model.ngeom):
        if int(model.geom_bodyid[geom]) in below and (model.geom_contype[geom] or model.geom_conaffinity[geom]):
            distance = norm(_across(data.geom_xpos[geom] - data.xanchor[joint], data.xaxis[joint]))
            if distance > largest and math.isfinite(distance):
                farthest, largest = geom, distance
    return farthest


def _across(offset: _Floats, axis: _Floats) -> _Floats:
    """Return the part of an offset that is perpendicular to an axis."""
    return np.asarray(offset - dot(offset, axis) * axis)
