"""Base classes of the actions that change a variable or a configuration with a name."""

from __future__ import annotations

from typing import Any

from simkit_launch.launch_modules.launch.action import Action
from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType
from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions


class NamedAction(Action):
    """Change of something with a name.

    Args:
        name: name.
        kwargs: arguments of `Action`.
    """

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """Name."""
        return self._name


class NamedValueAction(NamedAction):
    """Assignment of a value to something with a name.

    Args:
        name: name.
        value: value.
        kwargs: arguments of `Action`.
    """

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        self._value = normalize_to_list_of_substitutions(value)

    @property
    def value(self) -> list[Substitution]:
        """Value."""
        return self._value
