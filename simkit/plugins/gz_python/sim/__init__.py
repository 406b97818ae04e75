"""Replacement of gz-sim's Python module: `gz.sim8`, `gz.sim`, `ignition.gazebo6`, … import this package.

A user's system reads and sets components of entities. The package reads the simulation, or stores commands that take
effect before the next step by the rules of gz-sim's physics system. It never steps the simulation: `TestFixture` and
`Server`, which step it, are in `simkit.testing.gz_fixture`.
"""

from __future__ import annotations

from typing import Final, NoReturn

from simkit.plugins.gz_python.math.missing_names import missing_name_error
from simkit.plugins.gz_python.sim import components
from simkit.plugins.gz_python.sim.components import ComponentState
from simkit.plugins.gz_python.sim.entity_component_manager import EntityComponentManager
from simkit.plugins.gz_python.sim.entity_table import K_NULL_ENTITY
from simkit.plugins.gz_python.sim.joint import Joint
from simkit.plugins.gz_python.sim.link import Link
from simkit.plugins.gz_python.sim.model import Model
from simkit.plugins.gz_python.sim.sensors_lights_actors import Actor, Light, Sensor
from simkit.plugins.gz_python.sim.system_hub import EventManager, UpdateInfo
from simkit.plugins.gz_python.sim.world import World, world_entity, world_pose

K_COMPONENT_TYPE_ID_INVALID: Final = 0

__all__ = ["K_COMPONENT_TYPE_ID_INVALID", "K_NULL_ENTITY", "ComponentState", "EntityComponentManager", "EventManager"]
__all__ += ["Actor", "Joint", "Light", "Link", "Model", "Sensor", "World", "world_entity", "world_pose"]
__all__ += ["UpdateInfo", "components"]


_IN_FIXTURE: Final = ("Server", "ServerConfig", "TestFixture")
"""Names of `gz.sim` that are defined in `simkit.testing.gz_fixture`."""


def __getattr__(name: str) -> NoReturn:
    raise missing_name_error("gz.sim", name, (*__all__, *_IN_FIXTURE))
