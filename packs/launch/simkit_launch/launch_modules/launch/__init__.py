"""Launch files, as the ROS 2 package `launch`."""

from __future__ import annotations

from simkit_launch.launch_modules.launch.action import Action
from simkit_launch.launch_modules.launch.condition import Condition
from simkit_launch.launch_modules.launch.event import Event
from simkit_launch.launch_modules.launch.event_handler import EventHandler
from simkit_launch.launch_modules.launch.launch_context import LaunchContext
from simkit_launch.launch_modules.launch.launch_description import LaunchDescription
from simkit_launch.launch_modules.launch.launch_description_entity import LaunchDescriptionEntity
from simkit_launch.launch_modules.launch.launch_description_source import LaunchDescriptionSource
from simkit_launch.launch_modules.launch.launch_introspector import LaunchIntrospector
from simkit_launch.launch_modules.launch.launch_service import LaunchService
from simkit_launch.launch_modules.launch.some_actions_type import SomeActionsType, SomeActionsType_types_tuple
from simkit_launch.launch_modules.launch.some_entities_type import SomeEntitiesType, SomeEntitiesType_types_tuple
from simkit_launch.launch_modules.launch.some_substitutions_type import (
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
)
from simkit_launch.launch_modules.launch.substitution import Substitution

__all__ = [
    "Action",
    "Condition",
    "Event",
    "EventHandler",
    "LaunchContext",
    "LaunchDescription",
    "LaunchDescriptionEntity",
    "LaunchDescriptionSource",
    "LaunchIntrospector",
    "LaunchService",
    "SomeActionsType",
    "SomeActionsType_types_tuple",
    "SomeEntitiesType",
    "SomeEntitiesType_types_tuple",
    "SomeSubstitutionsType",
    "SomeSubstitutionsType_types_tuple",
    "Substitution",
]
