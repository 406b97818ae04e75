"""Placement of models without a given height, so that they stand on what is below them at the start."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import replace
from typing import Final

import mujoco
import numpy as np

from simkit.compiler.spec_builder import Compiled, SpecBuilder
from simkit.compiler.standing_height import Bools, Stand, StandingHeight
from simkit.diagnostics import Diagnostics
from simkit.errors import LoadError
from simkit.pose import Pose
from simkit.scene import SceneModel, SceneWorld
from simkit.scene.model_transform import move_model

TOLERANCE: Final = 1e-3
"""Gap or depth [m] up to which a model keeps the height of its file."""


def stand_models(world: SceneWorld, names: Sequence[str], diagnostics: Diagnostics) -> SceneWorld:
    """Return the world with the named models at the heights at which they stand on what is below them.

    A model that is fixed to the world, static, or a ground itself keeps its height. So does a model without anything
    below it. The heights follow from a compiled copy of the world without visuals, before anything is built from it.
    A world that cannot be compiled stays as it is; its own compilation reports the reason.

    Args:
        world: world with the models at the heights of their files.
        names: models to place, in this order; each stands on those before it.
        diagnostics: receives a note for each model that is moved.
    """
    wanted = [n for n in names if (model := world.model(n)) is not None and not model.static and not model.has_ground]
    if not wanted:
        return world
    problems = Diagnostics()
    try:
        compiled = SpecBuilder(replace(world, models=tuple(map(_without_visuals, world.models))), problems).compile()
    except LoadError:
        return world
    if problems.has_errors:
        return world
    search = StandingHeight(compiled.model, compiled.data)
    for number, name in enumerate(wanted):
        geoms = _geoms_of(compiled, name)
        ignored = np.logical_or.reduce([np.zeros_like(geoms), *(_geoms_of(compiled, n) for n in wanted[number + 1 :])])
        heights = _free_heights(compiled.model, geoms)
        stand = search.find(geoms, ignored)
        if stand is None:
            continue
        if heights is None:
            _report_fixed(world, name, stand, diagnostics)
            continue
        compiled.data.qpos[heights] += stand.lift
        more, surface = search.raise_from_contacts(geoms, ignored, heights)
        lift = stand.lift + more
        if abs(lift) <= TOLERANCE:
            compiled.data.qpos[heights] -= lift
            continue
        carrier = _surface_name(compiled, surface if surface != -1 else stand.surface)
        world = _with_model_moved(world, name, lift, carrier, diagnostics)
    return world


def standing_lift(model: mujoco.MjModel, data: mujoco.MjData, model_geoms: Bools) -> float | None:
    """Return the vertical distance [m] from the present pose of a model to the pose on what is below it.

    Args:
        model: compiled world with the model; it is copied.
        data: present state; it is copied.
        model_geoms: geoms of the model.

    Returns:
        None if nothing is below the model, or if it has no collisions.
    """
    model, data = copy(model), copy(data)
    search, ignored = StandingHeight(model, data), np.zeros_like(model_geoms)
    stand = search.find(model_geoms, ignored)
    if stand is None:
        return None
    heights = _free_heights(model, model_geoms)
    if heights is None:
        return stand.lift
    data.qpos[heights] += stand.lift
    return stand.lift + search.raise_from_contacts(model_geoms, ignored, heights)[0]


def _without_visuals(model: SceneModel) -> SceneModel:
    """Return a model without the parts that do not matter for contacts; a model in MuJoCo's own format is unchanged."""
    if model.mjcf is not None:
        return model
    links = tuple(replace(link, visuals=(), lights=()) for link in model.links)
    return replace(model, links=links, models=tuple(map(_without_visuals, model.models)))


def _geoms_of(compiled: Compiled, name: str) -> Bools:
    """Return the geoms of a top-level model as flags."""
    is_of_model = np.zeros(compiled.model.ngeom, dtype=bool)
    for link in compiled.names.links.values():
        if link.model == name:
            is_of_model[[*link.geoms, *link.ray_geoms]] = True
    return is_of_model


def _free_heights(model: mujoco.MjModel, model_geoms: Bools) -> list[int] | None:
    """Return the indices of the heights of a model's free links in the positions; None if a link is fixed."""
    heights = []
    for root in sorted({int(r) for r in model.body_rootid[model.geom_bodyid[model_geoms]]}):
        joint = int(model.body_jntadr[root])
        if root == 0 or joint < 0 or int(model.jnt_type[joint]) != mujoco.mjtJoint.mjJNT_FREE:
            return None
        heights.append(int(model.jnt_qposadr[joint]) + 2)
    return heights


def _surface_name(compiled: Compiled, surface: int) -> str:
    """Return the name of the model that a geom or flex belongs to."""
    link = compiled.names.geom_owner(surface)[0] if surface >= 0 else ""
    return compiled.names.link(link).model if link else "the world"


def _with_model_moved(world: SceneWorld, name: str, lift: float, carrier: str, diagnostics: Diagnostics) -> SceneWorld:
    model = world.model(name)
    assert model is not None
    before = float(model.pose_world.position[2])
    moved = move_model(model, Pose((0.0, 0.0, lift)))
    diagnostics.note(
        "SK-SPAWN-003",
        f"{name} starts at z = {before + lift:.4g} m instead of {before:.4g} m: its lowest collision touches {carrier}",
        model.where,
        "give a height with --spawn MODEL:x,y,z,yaw",
    )
    return replace(world, models=tuple(moved if m.name == name else m for m in world.models))


def _report_fixed(world: SceneWorld, name: str, stand: Stand, diagnostics: Diagnostics) -> None:
    """Report a model that is fixed to the world below the ground."""
    model = world.model(name)
    if model is not None and stand.lift > TOLERANCE:
        diagnostics.note(
            "SK-SPAWN-004",
            f"{name} is fixed to the world and reaches {stand.lift:.4g} m below the surface under it; it is not moved",
            model.where,
            "move its base up in the file, or choose another world with --world",
        )
