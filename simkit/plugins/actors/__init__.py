"""Actors: people and animals moved by a script or a plugin, visible to sensors and without contact.

`with_actors` converts each `SceneActor` to a static model of links, which `ActorMover` moves along the script. Actors
exert no forces and receive none.
"""

from __future__ import annotations

from simkit.plugins.actors.actor_model import with_actors
from simkit.plugins.actors.actor_mover import ActorMover

__all__ = ["ActorMover", "with_actors"]
