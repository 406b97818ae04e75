"""Changes of poses, sizes and lights in a world's specification, which is then compiled again without its files."""

from __future__ import annotations

from collections.abc import Callable

import mujoco

from simkit.compiler import shape_geometry
from simkit.compiler.kinematic_tree import WORLD
from simkit.compiler.lights import report_light, write_light
from simkit.compiler.name_map import ModelRecord
from simkit.diagnostics import Diagnostics
from simkit.pose import IDENTITY, Vector
from simkit.scene import Mesh, SceneCollision, SceneLink, SceneModel, SceneVisual, SceneWorld
from simkit.scene.differences import EntityChange

SpecEdit = Callable[[mujoco.MjSpec], None]
"""Function that writes one change to a specification."""

_MESH = mujoco.mjtGeom.mjGEOM_MESH


def plan_light(world: SceneWorld, change: EntityChange) -> list[SpecEdit] | None:
    """Return functions that write a light of the world; None if the world must be built anew.

    A light on a link is written with its model, and another type of light draws the surfaces differently.
    """
    old, new = change.old, change.new
    if change.owner is not None or world.mjcf is not None or "type" in change.fields:
        return None
    problems = Diagnostics()
    for light in (old, new):
        report_light(light, world, problems)
    if list(problems):
        return None  # a new load reports the problems
    return [lambda spec: write_light(spec.light(new.scoped), new, new.pose_world, world.surroundings.shadows)]


def plan_shape(
    spec: mujoco.MjSpec, record: ModelRecord, link: SceneLink, old: SceneCollision | SceneVisual, *, moves: bool = False
) -> list[SpecEdit] | None:
    """Return functions that write the pose and size of a shape of a link; None if the world must be built anew.

    Args:
        spec: specification of the world.
        record: record of the model.
        link: link with the changed shape.
        old: the shape before the change.
        moves: True if the link itself has another pose.
    """
    is_visual = isinstance(old, SceneVisual)
    shapes = link.visuals if is_visual else link.collisions
    new = next(shape for shape in shapes if shape.scoped == old.scoped)
    names = [n for n, o in record.geoms.items() if o.scoped == new.scoped and o.is_visual == is_visual]
    binding = record.links[link.scoped]
    offset = link.pose_world if binding.body_name == WORLD else IDENTITY
    if not names or record.attached or (moves and binding.body_name != WORLD):
        return [] if not names else None
    kinds = {int(spec.geom(name).type) for name in names}
    if isinstance(new.geometry, Mesh):
        if kinds != {int(_MESH)} or old.geometry != new.geometry:
            return None  # another scale needs another mesh; a round wheel collides as a cylinder
        pose = offset @ new.pose_link
        return [lambda spec: _write_poses(spec, names, pose.position, pose.quaternion)]
    primitive = shape_geometry.primitive_of(new.geometry, is_visual)
    if primitive is None or type(old.geometry) is not type(new.geometry) or len(names) != 1:
        return None
    if kinds != {int(primitive.type)} or not all(size > 0.0 for size in shape_geometry.shape_sizes(new.geometry)):
        return None
    pose = offset @ (new.pose_link @ primitive.pose)

    def write(spec: mujoco.MjSpec) -> None:
        _write_poses(spec, names, pose.position, pose.quaternion)
        if old.geometry != new.geometry:
            spec.geom(names[0]).size = primitive.size

    return [write]


def _write_poses(spec: mujoco.MjSpec, names: list[str], position: Vector, quaternion: Vector) -> None:
    for name in names:
        geom = spec.geom(name)
        geom.pos, geom.quat = position, quaternion


def plan_moved_link(spec: mujoco.MjSpec, record: ModelRecord, old: SceneLink, new: SceneLink) -> list[SpecEdit] | None:
    """Return functions that write another pose of a static link; None if the world must be built anew."""
    binding = record.links.get(new.scoped)
    if binding is None or not binding.static or binding.body_name != WORLD or record.world_sites or record.attached:
        return None
    if new.sensors or new.lights or new.plugins:
        return None
    edits: list[SpecEdit] = []
    shapes: list[SceneCollision | SceneVisual] = [*old.collisions, *old.visuals]
    for shape in shapes:
        shape_edits = plan_shape(spec, record, new, shape, moves=True)
        if shape_edits is None:
            return None
        edits += shape_edits
    return edits


def is_plain_obstacle(model: SceneModel) -> bool:
    """Check whether a model is static and has shapes only, so that nothing else depends on its pose."""
    models = model.all_models()
    return model.static and not any(m.plugins or m.joints or m.frames or m.mjcf for m in models)
