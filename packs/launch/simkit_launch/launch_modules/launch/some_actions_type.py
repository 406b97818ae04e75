"""Types of what stands for actions: one action or a sequence."""

from __future__ import annotations

import collections.abc
from collections.abc import Iterable
from typing import Final

from simkit_launch.launch_modules.launch.action import Action

__all__ = ["SomeActionsType", "SomeActionsType_types_tuple"]

SomeActionsType = Action | Iterable[Action]
SomeActionsType_types_tuple: Final[tuple[type, ...]] = (Action, collections.abc.Iterable)
