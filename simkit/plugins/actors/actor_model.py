"""Models of actors: bodies without contact that cameras and lidars see."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, Protocol

import numpy as np

from simkit.diagnostics import Diagnostics, did_you_mean
from simkit.plugins.actors import person
from simkit.plugins.actors.script import Floats, Script, Track
from simkit.pose import Pose
from simkit.scene import (
    Material,
    SceneActor,
    SceneLink,
    SceneModel,
    SceneVisual,
    SceneWorld,
)

FindFile = Callable[[str, Path | None], Path | None]

_ROOT: Final = "link"
_LEADERS: Final = frozenset(("gz-sim-follow-actor-system", "gz::sim::systems::FollowActor"))
_AT_THE_HIPS: Final = (0.5, 1.5)
"""[m] over the ground: where a script's way lies if it is that of the hips, as with Gazebo's own skins."""


class Rig(Protocol):
    """How the parts of an actor lie about its origin."""

    def lie(self, track: Track, rests: bool) -> tuple[Floats, Floats]:
        """Positions (rows, n, 3) [m] and quaternions (rows, n, 4) of the parts in the actor's frame, along a track.

        Args:
            track: where it is, and how fast.
            rests: whether it stands, at the end of its way or before its beginning.
        """
        ...


@dataclass(frozen=True, slots=True)
class WalkingPerson:
    """The person of our own making, who walks where the way goes on and stands where it does not."""

    scale: float
    drop: float

    def lie(self, track: Track, rests: bool) -> tuple[Floats, Floats]:
        speed = np.zeros_like(track.speed) if rests else track.speed
        places, turns = person.figure_poses(person.walking_angles(track.distance / self.scale, speed))
        return places * self.scale - (0.0, 0.0, self.drop), turns


class AnimatedActor:
    """One actor at work.

    Args:
        name: its name.
        script: its ways.
        rig: how its parts lie; None where it has none that move against its origin.
        is_led: whether a plugin of its own takes it where it goes.

    Attributes:
        moves: whether anything of it ever moves by its script.
    """

    def __init__(self, name: str, script: Script, rig: Rig | None, is_led: bool = False) -> None:
        self.name, self.script, self.rig, self.is_led = name, script, rig, is_led
        self.moves = script.moves or (rig is not None and script.length > 0.0)
        self._going = [link_poses_in_world(track, rig, False) for track in script.tracks]
        self._resting = [table[[0, -1]] for table in (link_poses_in_world(t, rig, True) for t in script.tracks)]

    def __deepcopy__(self, memo: dict[int, object]) -> AnimatedActor:
        return self

    def poses(self, time: float) -> Floats:
        """Where its links are in the world: the origin, then the parts; position and quaternion, shape (n, 7)."""
        number, inside, rests = self.script.at(time)
        if rests:
            return np.asarray(self._resting[number][0 if inside <= 0.0 else 1])
        row, part = self.script.tracks[number].row(inside)
        table = self._going[number]
        poses: Floats = table[row] * (1.0 - part)
        poses += table[row + 1] * part
        return poses


def link_poses_in_world(track: Track, rig: Rig | None, rests: bool) -> Floats:
    """Poses of all links in the world, shape (rows, n, 7)."""
    origin = track.poses[:, None, :]
    if rig is None:
        return origin
    places, turns = rig.lie(track, rests)
    turn = origin[..., 3:]
    w, v = turn[..., :1], turn[..., 1:]
    across = np.cross(v, places)
    placed = origin[..., :3] + places + 2.0 * (w * across + np.cross(v, across))
    wp, vp = turns[..., :1], turns[..., 1:]
    real = w * wp - np.sum(v * vp, axis=-1, keepdims=True)
    turned = np.concatenate([real, w * vp + wp * v + np.cross(v, vp)], axis=-1)
    flips = np.cumprod(np.where(np.sum(turned[1:] * turned[:-1], axis=-1, keepdims=True) < 0.0, -1.0, 1.0), axis=0)
    turned[1:] *= flips
    return np.concatenate([origin, np.concatenate([placed, turned], axis=-1)], axis=1)


def with_actors(world: SceneWorld, find_file: FindFile, diagnostics: Diagnostics) -> SceneWorld:
    """The world with a model for every actor in it; what is wrong with an actor is reported."""
    if not world.actors:
        return world
    taken = {model.name for model in world.models}
    models = []
    for actor in world.actors:
        _check(actor, diagnostics)
        if actor.name in taken:
            text = f"the world has an actor and a model named {actor.name!r}; the actor is left out"
            diagnostics.warning("SK-ACTOR-002", text, actor.where, "give the actor another name")
            continue
        models.append(actor_model(actor, find_file, diagnostics))
    return replace(world, models=(*world.models, *models))


def actor_model(actor: SceneActor, find_file: FindFile, diagnostics: Diagnostics) -> SceneModel:
    """An actor's model as it stands at the start; `moved_by` is its `AnimatedActor`."""
    from simkit.plugins.actors.skin import skinned_actor_model

    if is_led_by_plugin(actor):  # its script does not move it, as in gz
        actor = replace(actor, trajectories=())
    worn = skinned_actor_model(actor, find_file, diagnostics)
    return worn if worn is not None else _person(actor, Script(actor))


def is_led_by_plugin(actor: SceneActor) -> bool:
    """Whether a plugin of its own takes the actor where it goes."""
    from simkit.plugins.plugin_names import aliases

    return any(alias in _LEADERS for plugin in actor.plugins for alias in aliases(plugin))


def _check(actor: SceneActor, diagnostics: Diagnostics) -> None:
    known = [a.name for a in actor.animations]
    for way in actor.trajectories:
        if known and way.type and way.type not in known:
            text = f"actor {actor.name!r}: its trajectory {way.id} asks for the animation {way.type!r}"
            hint = did_you_mean(way.type, known) or f"animations: {', '.join(known)}"
            diagnostics.warning("SK-ACTOR-003", f"{text}, which it does not have", actor.where, hint)
    if not actor.auto_start:
        text = f"actor {actor.name!r} waits for its start (<auto_start> is false)"
        hint = f"call the service /{actor.name}/play (std_srvs/srv/SetBool)"
        diagnostics.note("SK-ACTOR-004", text, actor.where, hint)


def _person(actor: SceneActor, script: Script) -> SceneModel:
    looks = person.appearance_of(actor.name, actor.person)
    scale = looks.height / person.HEIGHT
    pose = script.pose(0.0)
    drop = 1.0 if _AT_THE_HIPS[0] <= pose.position[2] <= _AT_THE_HIPS[1] else 0.0
    rig = WalkingPerson(scale, drop) if script.moves or is_led_by_plugin(actor) else None
    cast, model = AnimatedActor(actor.name, script, rig, is_led_by_plugin(actor)), actor.name
    if rig is None:
        lies = person.resting_poses(_is_sitting(actor))
        pieces = [(p, lies[p.part] @ p.pose) for p in person.FIGURE]
        links = [_link(model, _ROOT, pose, pieces, looks, scale, drop)]
    else:
        links = [SceneLink(_ROOT, f"{model}::{_ROOT}", pose)]
        lies_at = cast.poses(0.0)
        for i, part in enumerate(person.PARTS, 1):
            pieces = [(p, p.pose) for p in person.FIGURE if p.part == part]
            links.append(_link(model, part, Pose(lies_at[i, :3], lies_at[i, 3:]), pieces, looks, scale, 0.0))
    return scripted_model(actor, pose, links, cast)


def _is_sitting(actor: SceneActor) -> bool:
    """Whether its first animation is one of sitting, by name."""
    types = [way.type for way in actor.trajectories[:1]] or [a.name for a in actor.animations[:1]]
    return any("sit" in name.lower() for name in types)


def scripted_model(actor: SceneActor, pose: Pose, links: Sequence[SceneLink], cast: AnimatedActor) -> SceneModel:
    """A model that only its script moves."""
    return SceneModel(
        name=actor.name,
        scoped=actor.name,
        pose_world=pose,
        static=True,
        declared_static=True,
        canonical_link=links[0].scoped,
        links=tuple(links),
        plugins=actor.plugins,
        where=actor.where,
        moved_by=cast,
    )


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
        own = f"{piece.part}_{piece.name}" if name == _ROOT else piece.name
        material = coloured_material(looks.colours[piece.look])
        visuals.append(SceneVisual(own, f"{scoped}::{own}", place, shape, material))
    return SceneLink(name, scoped, pose, visuals=tuple(visuals))


def _scaled(pose: Pose, scale: float, drop: float) -> Pose:
    x, y, z = (float(v) * scale for v in pose.position)
    return Pose((x, y, z - drop), pose.quaternion)


def coloured_material(colour: tuple[float, float, float]) -> Material:
    whole = (*colour, 1.0)
    return Material(ambient=whole, diffuse=whole, specular=(0.05, 0.05, 0.05, 1.0))
