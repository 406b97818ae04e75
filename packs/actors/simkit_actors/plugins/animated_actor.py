"""Poses of an actor's links over time, and the model that represents the actor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Protocol

import numpy as np

from simkit import Pose
from simkit.extend import SceneLink, SceneModel, SharedByCopies
from simkit.plugins.plugin_names import aliases
from simkit.scene import SceneActor
from simkit_actors.plugins.script import Floats, Script, Track

ROOT_LINK: Final = "link"
_LEADERS: Final = frozenset(("gz-sim-follow-actor-system", "gz::sim::systems::FollowActor"))
AT_THE_HIPS: Final = (0.5, 1.5)
"""Range of heights above the ground [m] in which a trajectory is that of the hips, as with Gazebo's own skins."""


class Rig(Protocol):
    """Skeleton of an actor: computes the poses of its links relative to the actor's origin."""

    def link_poses(self, track: Track, rests: bool) -> tuple[Floats, Floats]:
        """Return the poses of the n links in the actor's frame, one row for each time of a track.

        Args:
            track: trajectory of the actor, with its poses and speed.
            rests: whether the actor stands before the start or after the end of its script.

        Returns:
            Positions [m], shape (rows, n, 3), and quaternions, shape (rows, n, 4).
        """
        ...


class AnimatedActor(SharedByCopies):
    """Actor with its script and the poses of its links over time.

    Args:
        name: name of the actor.
        script: trajectories of the actor.
        rig: skeleton of the actor; None if the actor is rigid.
        is_led: whether a plugin moves the actor.

    Attributes:
        moves: whether the script moves the actor or one of its links at any time.
    """

    def __init__(self, name: str, script: Script, rig: Rig | None, is_led: bool = False) -> None:
        self.name, self.script, self.rig, self.is_led = name, script, rig, is_led
        self.moves = script.moves or (rig is not None and script.length > 0.0)
        self._going = [link_poses_in_world(track, rig, False) for track in script.tracks]
        self._resting = [table[[0, -1]] for table in (link_poses_in_world(t, rig, True) for t in script.tracks)]

    def poses(self, time: float) -> Floats:
        """Return the world poses of the links at a time [s] since the start of the script.

        The shape is (n, 7): position [m] and quaternion of the actor's origin, then of each other link.
        """
        number, inside, rests = self.script.at(time)
        if rests:
            return np.asarray(self._resting[number][0 if inside <= 0.0 else 1])
        row, part = self.script.tracks[number].row(inside)
        table = self._going[number]
        poses: Floats = table[row] * (1.0 - part)
        poses += table[row + 1] * part
        return poses


def link_poses_in_world(track: Track, rig: Rig | None, rests: bool) -> Floats:
    """Return the world poses of all links for each row of a track: position [m] and quaternion, shape (rows, n, 7)."""
    origin = track.poses[:, None, :]
    if rig is None:
        return origin
    places, turns = rig.link_poses(track, rests)
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


def is_led_by_plugin(actor: SceneActor) -> bool:
    """Check whether the actor has a plugin that moves it."""
    return any(alias in _LEADERS for plugin in actor.plugins for alias in aliases(plugin))


def scripted_model(actor: SceneActor, pose: Pose, links: Sequence[SceneLink], cast: AnimatedActor) -> SceneModel:
    """Return the static model of an actor; only the actor's script or plugin sets the poses of its links."""
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
