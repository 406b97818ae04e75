"""gz-sim's Python over a simulation of simkit: `gz.sim8`, `gz.sim`, `ignition.gazebo6`, … are this package."""

from __future__ import annotations

from typing import Any, Final

from simkit.gzpython.absent import absent
from simkit.gzpython.sim import components
from simkit.gzpython.sim.components import ComponentState
from simkit.gzpython.sim.ecm import EntityComponentManager
from simkit.gzpython.sim.fixture import Server, ServerConfig, TestFixture
from simkit.gzpython.sim.info import K_NULL_ENTITY, EventManager, UpdateInfo
from simkit.gzpython.sim.joint import Joint
from simkit.gzpython.sim.link import Link
from simkit.gzpython.sim.model import Model
from simkit.gzpython.sim.things import Actor, Light, Sensor
from simkit.gzpython.sim.world import World, world_entity, world_pose

K_COMPONENT_TYPE_ID_INVALID: Final = 0

__all__ = [
    "K_COMPONENT_TYPE_ID_INVALID",
    "K_NULL_ENTITY",
    "Actor",
    "ComponentState",
    "EntityComponentManager",
    "EventManager",
    "Joint",
    "Light",
    "Link",
    "Model",
    "Sensor",
    "Server",
    "ServerConfig",
    "TestFixture",
    "UpdateInfo",
    "World",
    "components",
    "world_entity",
    "world_pose",
]

_INSTEAD: Final = {
    "Gui": "simkit has no user interface",
    "HelperFixture": "use TestFixture, its later name",
    "get_install_prefix": "there is no Gazebo whose folder it could be",
}


def __getattr__(name: str) -> Any:
    raise absent("gz.sim", name, __all__, _INSTEAD)
