"""Replacement of gz-sim's Python module: `gz.sim8`, `gz.sim`, `ignition.gazebo6`, … import this package.

A user's system reads and sets components of entities. The package reads the simulation, or stores commands that take
effect before the next step by the rules of gz-sim's physics system. Only `TestFixture` and `Server` step the
simulation.
"""

from __future__ import annotations

from typing import Final, NoReturn

from simkit_gz_python.math.missing_names import missing_name_error
from simkit_gz_python.sim import components
from simkit_gz_python.sim.components import ComponentState
from simkit_gz_python.sim.entity_component_manager import EntityComponentManager
from simkit_gz_python.sim.entity_table import K_NULL_ENTITY
from simkit_gz_python.sim.fixture import Server, ServerConfig, TestFixture
from simkit_gz_python.sim.joint import Joint
from simkit_gz_python.sim.link import Link
from simkit_gz_python.sim.model import Model
from simkit_gz_python.sim.sensors_lights_actors import Actor, Light, Sensor
from simkit_gz_python.sim.system_hub import EventManager, UpdateInfo
from simkit_gz_python.sim.world import World, world_entity, world_pose

K_COMPONENT_TYPE_ID_INVALID: Final = 0

__all__ = ["K_COMPONENT_TYPE_ID_INVALID", "K_NULL_ENTITY", "ComponentState", "EntityComponentManager", "EventManager"]
__all__ += ["Actor", "Joint", "Light", "Link", "Model", "Sensor", "World", "world_entity", "world_pose"]
__all__ += ["Server", "ServerConfig", "TestFixture", "UpdateInfo", "components"]


def __getattr__(name: str) -> NoReturn:
    raise missing_name_error("gz.sim", name, __all__)
