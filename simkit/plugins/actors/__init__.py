"""Actors: people and animals that follow a script, or a plugin, and are seen by sensors and touched by nothing.

A `SceneActor` enters; a static model of links leaves, which `ActorMover` puts where the script says. Nothing here
pushes or is pushed.
"""

from __future__ import annotations

from simkit.plugins.actors.actor_model import with_actors
from simkit.plugins.actors.actor_mover import ActorMover

__all__ = ["ActorMover", "with_actors"]
