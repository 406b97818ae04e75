"""Models of actors: links without collisions, which cameras and lidars see."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from simkit import Pose
from simkit.extend import Diagnostics, SceneLink, SceneModel, SceneVisual, SceneWorld, did_you_mean
from simkit.plugins.adapters import FileFinder
from simkit.scene import Material, SceneActor
from simkit_actors.plugins import person
from simkit_actors.plugins.animated_actor import (
    AT_THE_HIPS,
    ROOT_LINK,
    AnimatedActor,
    is_led_by_plugin,
    scripted_model,
)
from simkit_actors.plugins.script import Floats, Script, Track
from simkit_actors.plugins.skin import skinned_actor_model


@dataclass(frozen=True, slots=True)
class WalkingPerson:
    """Built-in person, who walks while the trajectory moves and stands while the trajectory pauses."""

    scale: float
    drop: float

    def link_poses(self, track: Track, rests: bool) -> tuple[Floats, Floats]:
        speed = np.zeros_like(track.speed) if rests else track.speed
        places, turns = person.figure_poses(person.walking_angles(track.distance / self.scale, speed))
        return places * self.scale - (0.0, 0.0, self.drop), turns


def with_actors(world: SceneWorld, find_file: FileFinder, diagnostics: Diagnostics) -> SceneWorld:
    """Return the world with one more model for each actor; problems with an actor are reported."""
    model_names = {model.name for model in world.models}
    models = []
    for actor in world.actors:
        _check(actor, diagnostics)
        if actor.name in model_names:
            text = f"the world has an actor and a model named {actor.name!r}; the actor is ignored"
            diagnostics.warning("SK-ACTOR-002", text, actor.where, "give the actor another name")
            continue
        models.append(actor_model(actor, find_file, diagnostics))
    return replace(world, models=(*world.models, *models))


def actor_model(actor: SceneActor, find_file: FileFinder, diagnostics: Diagnostics) -> SceneModel:
    """Return an actor's model at its start pose; the model's `moved_by` is an `AnimatedActor`."""
    if is_led_by_plugin(actor):  # as in gz, the script does not move an actor that a plugin moves
        actor = replace(actor, trajectories=())
    if actor.visuals:
        return _rigid(actor, Script(actor))
    skinned = skinned_actor_model(actor, find_file, diagnostics)
    return skinned if skinned is not None else _person(actor, Script(actor))


def _check(actor: SceneActor, diagnostics: Diagnostics) -> None:
    known = [a.name for a in actor.animations]
    for way in actor.trajectories:
        if known and way.type and way.type not in known:
            text = f"actor {actor.name!r} has no animation {way.type!r}, which its trajectory {way.id} names"
            hint = did_you_mean(way.type, known) or f"animations: {', '.join(known)}"
            diagnostics.warning("SK-ACTOR-003", text, actor.where, hint)
    if not actor.auto_start:
        text = f"actor {actor.name!r} waits for its start (<auto_start> is false)"
        hint = f"call the service /{actor.name}/play (std_srvs/srv/SetBool)"
        diagnostics.note("SK-ACTOR-004", text, actor.where, hint)


def _rigid(actor: SceneActor, script: Script) -> SceneModel:
    """Return the model of an actor whose file gives links with visuals instead of a skin."""
    pose, scoped = script.pose(0.0), f"{actor.name}::{ROOT_LINK}"
    visuals = tuple(replace(visual, scoped=f"{scoped}::{visual.name}") for visual in actor.visuals)
    link = SceneLink(ROOT_LINK, scoped, pose, visuals=visuals, where=actor.where)
    return scripted_model(actor, pose, [link], AnimatedActor(actor.name, script, None, is_led_by_plugin(actor)))


def _person(actor: SceneActor, script: Script) -> SceneModel:
    looks = person.appearance_of(actor.name, actor.person)
    scale = looks.height / person.HEIGHT
    pose = script.pose(0.0)
    drop = 1.0 if AT_THE_HIPS[0] <= pose.position[2] <= AT_THE_HIPS[1] else 0.0
    rig = WalkingPerson(scale, drop) if script.moves or is_led_by_plugin(actor) else None
    cast, model = AnimatedActor(actor.name, script, rig, is_led_by_plugin(actor)), actor.name
    if rig is None:
        lies = person.resting_poses(_is_sitting(actor))
        pieces = [(p, lies[p.part] @ p.pose) for p in person.FIGURE]
        links = [_link(model, ROOT_LINK, pose, pieces, looks, scale, drop)]
    else:
        links = [SceneLink(ROOT_LINK, f"{model}::{ROOT_LINK}", pose)]
        lies_at = cast.poses(0.0)
        for i, part in enumerate(person.PARTS, 1):
            pieces = [(p, p.pose) for p in person.FIGURE if p.part == part]
            links.append(_link(model, part, Pose(lies_at[i, :3], lies_at[i, 3:]), pieces, looks, scale, 0.0))
    return scripted_model(actor, pose, links, cast)


def _is_sitting(actor: SceneActor) -> bool:
    """Check whether the actor sits: the name of its first animation contains "sit"."""
    types = [way.type for way in actor.trajectories[:1]] or [a.name for a in actor.animations[:1]]
    return any("sit" in name.lower() for name in types)


def _link(
    model: str,
    name: str,
    pose: Pose,
    pieces: Sequence[tuple[person.Piece, Pose]],
    looks: person.Appearance,
    scale: float,
    drop: float,
) -> SceneLink:
    scoped = f"{model}::{name}"
    visuals = []
    for piece, lies in pieces:
        shape, place = person.scale_shape(piece.geometry, scale), _scaled(lies, scale, drop)
        visual_name = f"{piece.part}_{piece.name}" if name == ROOT_LINK else piece.name
        material = coloured_material(looks.colours[piece.look])
        visuals.append(SceneVisual(visual_name, f"{scoped}::{visual_name}", place, shape, material))
    return SceneLink(name, scoped, pose, visuals=tuple(visuals))


def _scaled(pose: Pose, scale: float, drop: float) -> Pose:
    x, y, z = (float(v) * scale for v in pose.position)
    return Pose((x, y, z - drop), pose.quaternion)


def coloured_material(colour: tuple[float, float, float]) -> Material:
    """Return an opaque, slightly glossy material of one colour."""
    rgba = (*colour, 1.0)
    return Material(ambient=rgba, diffuse=rgba, specular=(0.05, 0.05, 0.05, 1.0))
