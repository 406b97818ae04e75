"""Poses of entities in the frames in which overrides set them, and copies of models."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final, TypeVar

from simkit.pose import IDENTITY, Pose
from simkit.scene.geometry import Box, Capsule, Cone, Cylinder, Ellipsoid, Geometry, Sphere, vec3
from simkit.scene.model import (
    SceneCollision,
    SceneJoint,
    SceneLight,
    SceneLink,
    SceneModel,
    SceneSensor,
    SceneVisual,
)
from simkit.scene.model_transform import move_model, move_part, transform_model
from simkit.scene.world import SceneActor, SceneWorld

T = TypeVar("T")
H = TypeVar("H", SceneWorld, SceneModel)

_UNKNOWN_REACH: Final = 0.5
"""Distance [m] that is assumed from a model's frame to its edge if it has no shape of known size."""

_GAP: Final = 1.25
"""Distance of two copies in units of their width."""


def pose_of(entity: object, holders: Sequence[object]) -> Pose | None:
    """Return the pose that an override of `pose` sets; None if the entity has none.

    The pose of a model is in the frame of its outer model or of the world, that of a link in its model, that of a
    collision, visual, sensor or light in its link, and that of a joint in its child link.

    Args:
        entity: the entity.
        holders: the entities that hold it, from the world down.
    """
    match entity:
        case SceneCollision() | SceneVisual() | SceneSensor():
            return entity.pose_link
        case SceneModel() | SceneLink() | SceneLight() | SceneActor() | SceneJoint():
            return _base(entity, holders).inverse() @ entity.pose_world
    return None


def _base(entity: object, holders: Sequence[object]) -> Pose:
    """Return the world pose of the frame in which the pose of an entity is given."""
    if isinstance(entity, SceneJoint):
        inner = (owner for owner in reversed(holders) if isinstance(owner, (SceneModel, SceneWorld)))
        models = (m for owner in inner for m in ((owner,) if isinstance(owner, SceneModel) else owner.models))
        links = (link for model in models for link in model.all_links())
        return next((link.pose_world for link in links if link.scoped == entity.child_link), IDENTITY)
    owner = holders[-1] if holders else None
    return owner.pose_world if isinstance(owner, (SceneModel, SceneLink)) else IDENTITY


def set_pose(entity: T, pose: Pose, holders: Sequence[object]) -> T:
    """Return a collision, visual, sensor, light, joint or actor at another pose."""
    match entity:
        case SceneCollision() | SceneVisual():
            return replace(entity, pose_link=pose)
        case SceneSensor():
            world = entity.pose_world @ entity.pose_link.inverse() @ pose
            return replace(entity, pose_link=pose, pose_world=world)
        case SceneActor():
            return replace(entity, pose_world=pose)
        case SceneJoint() | SceneLight():
            world = _base(entity, holders) @ pose
            return move_part(entity, world @ entity.pose_world.inverse())
    raise TypeError(f"{type(entity).__name__} has no pose of its own")


def move_held_model(holder: H, model: SceneModel, pose: Pose) -> H:
    """Return a world or a model in which a model that it holds has another pose in its frame.

    The joints of the holder whose child link belongs to the moved model move too.
    """
    base = holder.pose_world if isinstance(holder, SceneModel) else IDENTITY
    shift = base @ pose @ model.pose_world.inverse()
    links = {link.scoped for link in model.all_links()}
    return replace(
        holder,
        models=tuple(move_model(item, shift) if item is model else item for item in holder.models),
        joints=tuple(move_part(item, shift) if item.child_link in links else item for item in holder.joints),
    )


def move_link(model: SceneModel, link: SceneLink, pose: Pose) -> SceneModel:
    """Return a model in which a link has another pose in the model frame.

    The joints to which the link is the child move too. In a model from URDF or MJCF, whose files give the pose of a
    link relative to its parent, all links that the link carries move with it.
    """
    shift = model.pose_world @ pose @ link.pose_world.inverse()
    moved = {link.scoped}
    is_tree = model.urdf is not None or model.mjcf is not None
    while is_tree:
        more = {joint.child_link for joint in model.joints if joint.parent_link in moved} - moved
        if not more:
            break
        moved |= more
    return replace(
        model,
        links=tuple(move_part(item, shift) if item.scoped in moved else item for item in model.links),
        joints=tuple(move_part(item, shift) if item.child_link in moved else item for item in model.joints),
        frames=tuple(move_part(item, shift) if item.attached_to in moved else item for item in model.frames),
    )


def copies(model: SceneModel, count: int) -> tuple[SceneModel, ...]:
    """Return copies of a top-level model, named `NAME_0`, `NAME_1`, …, in a square grid.

    The first copy has the pose of the model; the others follow along x, then along y, of the world.
    """
    columns, step = math.ceil(math.sqrt(count)), 2.0 * _GAP * _reach(model)
    return tuple(
        transform_model(model, f"{model.name}_{i}", Pose((i % columns * step, i // columns * step, 0.0)))
        for i in range(count)
    )


def _reach(model: SceneModel) -> float:
    """Return the largest horizontal distance [m] of the model's shapes of known size from the model frame."""
    most = 0.0
    for link in model.all_links():
        shapes: list[SceneCollision | SceneVisual] = [*link.collisions, *link.visuals]
        for shape in shapes:
            radius = _radius(shape.geometry)
            if radius:
                x, y, _ = (link.pose_world @ shape.pose_link).position - model.pose_world.position
                most = max(most, math.hypot(x, y) + radius)
    return most or _UNKNOWN_REACH


def _radius(shape: Geometry) -> float:
    """Return the radius [m] of a sphere about a shape; 0 if the size of the shape is unknown or unlimited."""
    match shape:
        case Box():
            return math.hypot(*shape.size) / 2.0
        case Sphere():
            return shape.radius
        case Cylinder() | Cone():
            return math.hypot(shape.radius, shape.length / 2.0)
        case Capsule():
            return shape.radius + shape.length / 2.0
        case Ellipsoid():
            return max(vec3(shape.radii))
    return 0.0
