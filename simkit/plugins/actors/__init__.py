"""Actors: people and animals that a script or a plugin moves. Sensors see them, but they have no contacts.

`with_actors` converts each `SceneActor` to a static model, and `ActorMover` moves the links of this model along the
script. Actors exert no forces and receive none.
"""

from __future__ import annotations

from simkit.plugins.actors.actor_model import with_actors
from simkit.plugins.actors.actor_mover import ActorMover

__all__ = ["ActorMover", "with_actors"]
