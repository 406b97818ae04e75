"""Actors: people and animals that follow a script, seen by sensors and touched by nothing."""

from __future__ import annotations

from simkit.plugins.actors.mover import ActorMover
from simkit.plugins.actors.stage import with_actors

__all__ = ["ActorMover", "with_actors"]
