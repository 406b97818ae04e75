"""Poses of a model's links at given joint positions, computed from the scene alone."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final

from simkit.pose import IDENTITY, Pose
from simkit.scene.geometry import Vec3
from simkit.scene.model import MOST_LEADERS, Axis, SceneJoint, SceneModel

AXIS_MOTIONS: Final[Mapping[str, str]] = {
    "revolute": "r", "continuous": "r", "prismatic": "t", "universal": "rr", "revolute2": "rr", "planar": "ttr",
    "fixed": "", "screw": "s",
}  # fmt: skip
"""Motion along each axis by joint type: rotation (r), translation (t) or both (s). Other types stay at zero."""


def joint_positions(model: SceneModel, values: Mapping[str, float]) -> dict[str, float]:
    """Return the position of each joint's first axis, with the positions of joints that mimic others.

    Args:
        model: model.
        values: positions [rad or m] by the scoped names of joints; 0 for joints that are not named.
    """
    axes = {joint.scoped: joint.axes[0] for joint in model.all_joints() if joint.axes}
    return {name: _position(name, axes, values, MOST_LEADERS) for name in axes}


def _position(name: str, axes: Mapping[str, Axis], values: Mapping[str, float], left: int) -> float:
    mimic = axes[name].mimic if name in axes else None
    if mimic is None or left == 0:
        return values.get(name, 0.0)
    return mimic.multiplier * (_position(mimic.joint, axes, values, left - 1) - mimic.reference) + mimic.offset


def link_poses(model: SceneModel, positions: Mapping[str, Sequence[float]]) -> dict[str, Pose]:
    """Return the pose of each link in the world frame by its scoped name.

    A joint moves its child link, and all links below it, from their poses at load time. A link that several joints
    hold follows the first one.

    Args:
        model: model; its root links stay at their poses.
        positions: positions [rad or m] of a joint's axes by its scoped name; zero for joints that are not named.
    """
    above: dict[str, SceneJoint] = {}
    for joint in model.all_joints():
        above.setdefault(joint.child_link, joint)
    moved: dict[str, Pose] = {}
    poses = {}
    for link in model.all_links():
        chain, name = [], link.scoped
        while name in above and name not in moved:
            chain.append(above[name])
            name = above[name].parent_link
            if len(chain) > len(above):  # a ring of joints
                break
        displacement = moved.get(name, IDENTITY)
        for joint in reversed(chain):
            displacement = displacement @ _motion(joint, positions.get(joint.scoped, ()))
            moved[joint.child_link] = displacement
        poses[link.scoped] = displacement @ link.pose_world
    return poses


def _motion(joint: SceneJoint, positions: Sequence[float]) -> Pose:
    """Return the displacement of a joint's child link in the world frame, while the parent link is at its load pose."""
    motion = IDENTITY
    for kind, axis, position in zip(AXIS_MOTIONS.get(joint.type, ""), joint.axes, positions, strict=False):
        travel = {"t": position, "r": 0.0, "s": position / math.tau * joint.thread_pitch}[kind]
        if travel:
            motion = motion @ Pose(_scaled(axis.xyz_world, travel))
        if kind != "t":
            turn = _rotation(joint.pose_world, axis.xyz_world, position)
            motion = motion @ turn
    return motion


def _rotation(centre: Pose, axis: Vec3, angle: float) -> Pose:
    """Return the rotation about an axis through a point."""
    sine = math.sin(angle / 2)
    x, y, z = _scaled(axis, sine)
    point = Pose(centre.position)
    return point @ Pose((0.0, 0.0, 0.0), (math.cos(angle / 2), x, y, z)) @ point.inverse()


def _scaled(vector: Vec3, factor: float) -> Vec3:
    x, y, z = vector
    return (x * factor, y * factor, z * factor)
