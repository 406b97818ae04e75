"""Plugins that work without being named in a file, and plugins that change the scene before anything is built of it.

The kinds are imported when a world is loaded, since they bring MuJoCo and the message types.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from simkit.diagnostics import Diagnostics
from simkit.plugins.classic.server_services import ClassicServices
from simkit.plugins.drives.robot_transforms import StaticTransforms
from simkit.plugins.gz.sensors import with_sensors_colours
from simkit.plugins.world.clock_publisher import ClockPublisher
from simkit.plugins.world.world_statistics import WorldStats
from simkit.scene import Scene, SceneWorld

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin


def plugins_of_every_world(world: SceneWorld) -> tuple[tuple[Plugin, ...], tuple[Plugin, ...]]:
    """Plugins that a world has by itself: those that run before the file's own, and those that run after them."""
    from simkit.plugins.actors import ActorMover
    from simkit.plugins.world.world_services import WorldServices

    actors = (ActorMover(),) if world.actors else ()
    return (ClockPublisher(), StaticTransforms(), *actors), (WorldStats(), WorldServices(), ClassicServices())


def apply_scene_plugins(scene: Scene) -> Scene:
    """The scene with what its plugins say of it: the colours of gz-sim's Sensors system."""

    return with_sensors_colours(scene)


def add_actor_models(
    world: SceneWorld, find_file: Callable[[str, Path | None], Path | None], diagnostics: Diagnostics
) -> SceneWorld:
    """The world with a model for every actor in it; what is wrong with an actor is reported."""
    if not world.actors:
        return world
    from simkit.plugins.actors.actor_model import with_actors

    return with_actors(world, find_file, diagnostics)
