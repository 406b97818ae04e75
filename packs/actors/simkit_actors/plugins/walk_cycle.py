"""Poses of an actor's links over one cycle of its walk, for an actor that a plugin moves."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from simkit.extend import SharedByCopies
from simkit_actors.plugins import person
from simkit_actors.plugins.actor_model import WalkingPerson
from simkit_actors.plugins.animated_actor import AnimatedActor, link_poses_in_world
from simkit_actors.plugins.script import Floats, Stride
from simkit_actors.plugins.skin import SkinRig

_ROWS: Final = 256
"""Number of rows of a cycle; the error of a linear interpolation between two rows is below 1 mm."""


class Gait(SharedByCopies):
    """Table of the poses of a walking actor over one cycle; immutable.

    Args:
        cast: walking actor.
        animation: name of the animation, for a skin with several animations.
        speed: walking speed [m/s].
        seconds: duration of a skin's animation for one metre [s/m].
    """

    def __init__(self, cast: AnimatedActor, animation: str, speed: float, seconds: float) -> None:
        self._cycle = _cycle(cast, animation, seconds)
        self._going = _table(cast, animation, self._cycle, speed, seconds)
        # an actor with a skin stops in the middle of a step, as in gz; a built-in person puts the feet together
        self._standing = None if isinstance(cast.rig, SkinRig) else _table(cast, animation, 0.0, 0.0, seconds)[0]

    def poses(self, place: tuple[float, float, float], yaw: float, distance: float, is_walking: bool) -> Floats:
        """Return the world poses of the links.

        The shape is (n, 7): position [m] and quaternion of the actor's origin, then of each other link.

        Args:
            place: position of the actor's origin in the world [m].
            yaw: heading of the actor [rad].
            distance: distance walked [m].
            is_walking: true if the actor walks, false if it stands.
        """
        if self._standing is not None and not is_walking:
            local_poses: Floats = self._standing
        else:
            row = math.fmod(distance, self._cycle) / self._cycle * (_ROWS - 1) if self._cycle > 0.0 else 0.0
            before = min(int(row), _ROWS - 2)
            local_poses = self._going[before] * (before + 1 - row) + self._going[before + 1] * (row - before)
        world_poses: Floats = np.empty_like(local_poses)
        cos, sin = math.cos(yaw), math.sin(yaw)
        world_poses[:, 0] = place[0] + cos * local_poses[:, 0] - sin * local_poses[:, 1]
        world_poses[:, 1] = place[1] + sin * local_poses[:, 0] + cos * local_poses[:, 1]
        world_poses[:, 2] = place[2] + local_poses[:, 2]
        cos, sin = math.cos(yaw / 2), math.sin(yaw / 2)
        world_poses[:, 3:] = cos * local_poses[:, 3:] + sin * local_poses[:, (6, 5, 4, 3)] * (-1.0, -1.0, 1.0, 1.0)
        return world_poses


def _cycle(cast: AnimatedActor, animation: str, seconds: float) -> float:
    """Return the distance [m] after which the poses of the links repeat; 0 if the links do not move."""
    rig = cast.rig
    if isinstance(rig, WalkingPerson):
        return person.STRIDE * rig.scale
    if not isinstance(rig, SkinRig) or seconds <= 0.0:
        return 0.0
    clip = rig.clips.get(animation) or next(iter(rig.clips.values()))
    return clip.length / seconds


def _table(cast: AnimatedActor, animation: str, cycle: float, speed: float, seconds: float) -> Floats:
    distances = np.linspace(0.0, cycle, _ROWS if cycle > 0.0 else 2)
    return link_poses_in_world(Stride(animation, distances, speed, seconds), cast.rig, False)
