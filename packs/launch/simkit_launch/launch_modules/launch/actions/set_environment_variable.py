"""Actions for variables of the environment."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from simkit_launch.launch_modules.launch.action import Action
from simkit_launch.launch_modules.launch.actions.named_action import NamedAction, NamedValueAction
from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from simkit_launch.launch_modules.launch.utilities.type_utils import (
    normalize_typed_substitution,
    perform_typed_substitution,
)

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = [
    "AppendEnvironmentVariable",
    "PopEnvironment",
    "PushEnvironment",
    "ResetEnvironment",
    "SetEnvironmentVariable",
    "UnsetEnvironmentVariable",
]


class SetEnvironmentVariable(NamedValueAction):
    """Assignment of a variable of the environment.

    Args:
        name: name.
        value: value.
    """

    def execute(self, context: LaunchContext) -> None:
        """Set the variable."""
        os.environ[perform_substitutions(context, self.name)] = perform_substitutions(context, self.value)


class UnsetEnvironmentVariable(NamedAction):
    """Removal of a variable of the environment.

    Args:
        name: name.
    """

    def execute(self, context: LaunchContext) -> None:
        """Remove the variable, if it is set."""
        os.environ.pop(perform_substitutions(context, self.name), None)


class AppendEnvironmentVariable(NamedValueAction):
    """Extension of a variable of the environment.

    Args:
        name: name.
        value: value that is added.
        prepend: True to add it before the present value.
        separator: text between both values.
    """

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        prepend: bool | SomeSubstitutionsType = False,
        separator: SomeSubstitutionsType = os.pathsep,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, value, **kwargs)
        self._prepend = normalize_typed_substitution(prepend, bool)
        self._separator = normalize_to_list_of_substitutions(separator)

    @property
    def prepend(self) -> Any:
        """True to add it before the present value."""
        return self._prepend

    @property
    def separator(self) -> list[Substitution]:
        """Text between both values."""
        return self._separator

    def execute(self, context: LaunchContext) -> None:
        """Extend the variable; set it if it is not set."""
        name, value = perform_substitutions(context, self.name), perform_substitutions(context, self.value)
        before = os.environ.get(name)
        if before is not None:
            is_first = perform_typed_substitution(context, self.prepend, bool)
            separator = perform_substitutions(context, self.separator)
            value = separator.join((value, before) if is_first else (before, value))
        os.environ[name] = value


class PushEnvironment(Action):
    """Storage of the variables of the environment, until `PopEnvironment`."""

    def execute(self, context: LaunchContext) -> None:
        """Store the variables."""
        context.push_environment()


class PopEnvironment(Action):
    """Return to the variables of the environment that were stored last."""

    def execute(self, context: LaunchContext) -> None:
        """Restore the variables."""
        context.pop_environment()


class ResetEnvironment(Action):
    """Return to the variables of the environment at the begin of the launch."""

    def execute(self, context: LaunchContext) -> None:
        """Restore the variables."""
        context.reset_environment()
