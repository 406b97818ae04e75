"""gz-sim's Python over a simulation of simkit: `gz.sim8`, `gz.sim`, `ignition.gazebo6`, … are this package."""

from __future__ import annotations

from typing import Any, Final

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

LEFT_OUT: Final = {
    "Gui": "simkit has no user interface",
    "InstallationDirectories": "simkit installs nothing outside its package",
    "Joy": "publish sensor_msgs/msg/Joy",
    "Primitives": "sim.spawn of an SDF text",
}


def __getattr__(name: str) -> Any:
    if name in LEFT_OUT:
        raise ImportError(f"simkit's gz.sim has no {name}: {LEFT_OUT[name]}", name="gz.sim")
    raise AttributeError(f"module 'gz.sim' has no attribute {name!r}")
