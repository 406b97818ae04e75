"""Actors: people and animals that follow a script, seen by sensors and touched by nothing."""

from __future__ import annotations

from simkit.plugins.actors.actor_model import with_actors
from simkit.plugins.actors.actor_mover import ActorMover

__all__ = ["ActorMover", "with_actors"]
