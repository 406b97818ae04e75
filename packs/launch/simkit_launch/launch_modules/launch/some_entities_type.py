"""Types of what stands for items of a launch description: one item or a sequence."""

from __future__ import annotations

import collections.abc
from collections.abc import Iterable
from typing import Final

from simkit_launch.launch_modules.launch.launch_description_entity import LaunchDescriptionEntity

__all__ = ["SomeEntitiesType", "SomeEntitiesType_types_tuple"]

SomeEntitiesType = LaunchDescriptionEntity | Iterable[LaunchDescriptionEntity]
SomeEntitiesType_types_tuple: Final[tuple[type, ...]] = (LaunchDescriptionEntity, collections.abc.Iterable)
