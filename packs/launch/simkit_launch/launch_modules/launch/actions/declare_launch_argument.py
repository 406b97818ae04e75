"""Actions for launch arguments and launch configurations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from simkit_launch.launch_modules.launch.action import Action
from simkit_launch.launch_modules.launch.actions.named_action import NamedAction, NamedValueAction
from simkit_launch.launch_modules.launch.substitution import Substitution, TextSubstitution
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from simkit_launch.launch_plan import DeclaredArgument

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = [
    "DeclareLaunchArgument",
    "PopLaunchConfigurations",
    "PushLaunchConfigurations",
    "ResetLaunchConfigurations",
    "SetLaunchConfiguration",
    "UnsetLaunchConfiguration",
]


class DeclareLaunchArgument(Action):
    """Declaration of an argument of a launch file.

    Args:
        name: name.
        default_value: value if it is not given; None for an argument that must be given.
        description: description.
        choices: allowed values; None for any.

    Attributes:
        conditionally_included: True if the declaration depends on a condition.
    """

    kind: ClassVar[str] = "argument"

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeSubstitutionsType | None = None,
        description: str | None = None,
        choices: Sequence[str] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._name = name
        self._default = None if default_value is None else normalize_to_list_of_substitutions(default_value)
        if choices is not None and not list(choices):
            raise RuntimeError("Provided choices arg is empty. Use None to ignore the choice list.")
        if choices is not None and isinstance(default_value, str) and default_value not in choices:
            raise RuntimeError(f'Provided default_value "{default_value}" is not in provided choices "{choices}".')
        self._choices = choices
        self._description = description or ""
        self.conditionally_included = False

    @property
    def name(self) -> str:
        """Name."""
        return self._name

    @property
    def default_value(self) -> list[Substitution] | None:
        """Value if it is not given; None for an argument that must be given."""
        return self._default

    @property
    def description(self) -> str:
        """Description."""
        return self._description or "no description given"

    @property
    def argument(self) -> DeclaredArgument:
        """Argument for the plan."""
        default = None if self._default is None else "".join(map(_text, self._default))
        return DeclaredArgument(self.name, default, self._description, tuple(map(str, self.choices or ())), self.where)

    @property
    def choices(self) -> Sequence[str] | None:
        """Allowed values; None for any."""
        return self._choices

    def execute(self, context: LaunchContext) -> None:
        """Set the launch configuration of the same name, if it is not set."""
        configurations = context.launch_configurations
        context.planner.declare(self.argument)
        if self.name not in configurations:
            if self.default_value is None:
                raise RuntimeError(f'Required launch argument "{self.name}" was not provided.')
            configurations[self.name] = perform_substitutions(context, self.default_value)
        if self.choices is not None and configurations[self.name] not in self.choices:
            raise RuntimeError(
                f'Argument "{self.name}" provided value "{configurations[self.name]}" is not valid. '
                f"Valid options are: {list(self.choices)}"
            )


def _text(substitution: Substitution) -> str:
    return substitution.text if isinstance(substitution, TextSubstitution) else substitution.describe()


class SetLaunchConfiguration(NamedValueAction):
    """Assignment of a launch configuration.

    Args:
        name: name.
        value: value.
    """

    def execute(self, context: LaunchContext) -> None:
        """Set the launch configuration."""
        value = perform_substitutions(context, self.value)
        context.launch_configurations[perform_substitutions(context, self.name)] = value


class UnsetLaunchConfiguration(NamedAction):
    """Removal of a launch configuration.

    Args:
        name: name.
    """

    def execute(self, context: LaunchContext) -> None:
        """Remove the launch configuration, if it is set."""
        context.launch_configurations.pop(perform_substitutions(context, self.name), None)


class ResetLaunchConfigurations(Action):
    """Removal of all launch configurations.

    Args:
        launch_configurations: those that are set then, by name.
    """

    def __init__(self, launch_configurations: Mapping[Any, SomeSubstitutionsType] | None = None, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._kept = dict(launch_configurations or {})

    def execute(self, context: LaunchContext) -> None:
        """Remove all launch configurations except the given ones."""
        kept = {
            perform_substitutions(context, normalize_to_list_of_substitutions(name)): perform_substitutions(
                context, normalize_to_list_of_substitutions(value)
            )
            for name, value in self._kept.items()
        }
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)


class PushLaunchConfigurations(Action):
    """Storage of the launch configurations, until `PopLaunchConfigurations`."""

    def execute(self, context: LaunchContext) -> None:
        """Store the launch configurations."""
        context.push_launch_configurations()


class PopLaunchConfigurations(Action):
    """Return to the launch configurations that were stored last."""

    def execute(self, context: LaunchContext) -> None:
        """Restore the launch configurations."""
        context.pop_launch_configurations()
