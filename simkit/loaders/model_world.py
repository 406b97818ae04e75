"""World around a bare model: level ground and a sun, empty space, or a world of the user's choice."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from simkit.diagnostics import Diagnostics
from simkit.loaders.resources.bundled_models import builtin_model
from simkit.pose import IDENTITY
from simkit.run_spec import EMPTY_SPACE, GROUND
from simkit.scene import Scene, SceneModel, SceneWorld
from simkit.scene.model_transform import transform_model

SceneReader = Callable[[str, Diagnostics], Scene]


def add_model_world(scene: Scene, model_world: str, read: SceneReader, diagnostics: Diagnostics) -> Scene:
    """Return a scene whose bare model is in a world; a scene that has a world or no model stays as it is.

    The model stands on what is below it (`Scene.standing`). A model that brings a ground of its own gets no other one.

    Args:
        scene: loaded scene.
        model_world: "ground", "none", or the source of a world.
        read: function that reads a source; it records problems in the diagnostics.
        diagnostics: receives every problem.
    """
    model = scene.model
    if model is None:
        if scene.worlds and model_world not in (GROUND, EMPTY_SPACE):
            text = f"--world {model_world:.80} is ignored: {scene.file or 'the source'} is a world, not a model"
            hint = "to add a model to the world, use --spawn MODEL:x,y,yaw"
            diagnostics.warning("SK-SPAWN-006", text, scene.worlds[0].where, hint)
        return scene
    if model_world == EMPTY_SPACE or (model_world == GROUND and model.has_ground):
        return scene
    if model_world == GROUND:
        world = _with_ground(scene.world, model, read)
        text = f"the file has no world: {model.name} starts on level ground, under a sun"
        diagnostics.note("SK-SPAWN-005", text, model.where, "--world none: empty space; --world NAME: another world")
    else:
        chosen = read(model_world, diagnostics).world
        if model.name in {*(m.name for m in chosen.models), *(a.name for a in chosen.actors)}:
            text = f"--world {model_world:.80}: the world already has a model or actor named {model.name!r}"
            diagnostics.error("SK-SPAWN-002", text, model.where, "rename one of the two")
            return scene
        world = replace(chosen, models=(*chosen.models, model))
    return replace(scene, worlds=(world,), model=None, around=None, standing=(model.name,))


def _with_ground(world: SceneWorld, robot: SceneModel, read: SceneReader) -> SceneWorld:
    """Return a world with Gazebo's ground plane, and with its sun if nothing else lights the robot.

    An MJCF file puts the lights of its scene on bodies too. A light on a link of another format is a headlamp.
    """
    ground, sun = (read(builtin_model(f"model://{name}") or "", Diagnostics()) for name in ("ground_plane", "sun"))
    assert ground.model is not None and sun.light is not None
    plane = ground.model
    if world.model(plane.name) is not None:
        plane = transform_model(plane, f"{plane.name}_1", IDENTITY)
    is_lit = bool(world.lights) or (robot.mjcf is not None and any(link.lights for link in robot.all_links()))
    return replace(world, models=(plane, *world.models), lights=world.lights if is_lit else (sun.light,))
