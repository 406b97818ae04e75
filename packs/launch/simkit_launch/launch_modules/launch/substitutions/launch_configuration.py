"""Substitutions for launch configurations, variables of the environment and local variables."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.substitutions.substitution_failure import SubstitutionFailure
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["EnvironmentVariable", "LaunchConfiguration", "LocalSubstitution"]


class LaunchConfiguration(Substitution):
    """Value of a launch configuration, such as of an argument.

    Args:
        variable_name: name.
        default: value without such a launch configuration; None for an error.
    """

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any | Iterable[Any] | None = None) -> None:
        self._variable_name = normalize_to_list_of_substitutions(variable_name)
        self._default: list[Substitution] | None = None
        if default is not None:
            items = list(default) if isinstance(default, Iterable) and not isinstance(default, str) else [default]
            texts = [item if isinstance(item, (str, Substitution)) else str(item) for item in items]
            self._default = normalize_to_list_of_substitutions(texts)

    @property
    def variable_name(self) -> list[Substitution]:
        """Name."""
        return self._variable_name

    def describe(self) -> str:
        """Return a description of the substitution."""
        return f"LaunchConfig({' + '.join(sub.describe() for sub in self.variable_name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value."""
        name = perform_substitutions(context, self.variable_name)
        context.planner.used_names.add(name)
        if name in context.launch_configurations:
            value: str = context.launch_configurations[name]
            return value
        if self._default is None:
            raise SubstitutionFailure(f"launch configuration '{name}' does not exist")
        return perform_substitutions(context, self._default)


class EnvironmentVariable(Substitution):
    """Value of a variable of the environment.

    Args:
        name: name.
        default_value: value without such a variable; None for an error.
    """

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._default = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    @property
    def name(self) -> list[Substitution]:
        """Name."""
        return self._name

    @property
    def default_value(self) -> list[Substitution] | None:
        """Value without such a variable."""
        return self._default

    def describe(self) -> str:
        """Return a description of the substitution."""
        return f"EnvVar({' + '.join(sub.describe() for sub in self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value."""
        name = perform_substitutions(context, self.name)
        context.planner.note_variable(name, context.planner.place)
        value = os.environ.get(name)
        if value is not None:
            return value
        if self._default is None:
            raise SubstitutionFailure(f"environment variable '{name}' does not exist")
        return perform_substitutions(context, self._default)


class LocalSubstitution(Substitution):
    """Value of a local variable of the context, such as `event.returncode`.

    Args:
        expression: name, with attributes.
        description: description.
    """

    def __init__(self, expression: str, description: str | None = None) -> None:
        self._expression, self._description = expression, description

    @property
    def expression(self) -> str:
        """Name, with attributes."""
        return self._expression

    @property
    def description(self) -> str | None:
        """Description."""
        return self._description

    def describe(self) -> str:
        """Return a description of the substitution."""
        return f"LocalVar('{self.description or self.expression}')"

    def perform(self, context: LaunchContext) -> str:
        """Return the value."""
        return str(eval(f"__local.{self.expression}", {}, {"__local": context.locals}))
