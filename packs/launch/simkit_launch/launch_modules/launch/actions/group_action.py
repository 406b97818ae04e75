"""Actions that contain others: groups, includes, loops, timers and functions."""

from __future__ import annotations

import asyncio
import math
import os
from collections.abc import Callable, Iterable, Mapping
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import yaml

from simkit_launch.launch_modules.launch.action import Action
from simkit_launch.launch_modules.launch.actions.declare_launch_argument import (
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
)
from simkit_launch.launch_modules.launch.actions.set_environment_variable import (
    PopEnvironment,
    PushEnvironment,
    ResetEnvironment,
)
from simkit_launch.launch_modules.launch.events import ExecutionComplete
from simkit_launch.launch_modules.launch.launch_description_entity import LaunchDescriptionEntity
from simkit_launch.launch_modules.launch.launch_description_source import (
    AnyLaunchDescriptionSource,
    LaunchDescriptionSource,
)
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from simkit_launch.launch_modules.launch.utilities.type_utils import (
    normalize_typed_substitution,
    perform_typed_substitution,
)

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_entities_type import SomeEntitiesType
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = [
    "ForEach",
    "ForLoop",
    "GroupAction",
    "IncludeLaunchDescription",
    "OpaqueCoroutine",
    "OpaqueFunction",
    "TimerAction",
]


class GroupAction(Action):
    """Group of actions.

    Args:
        actions: actions.
        scoped: True for launch configurations and variables of the environment that end with the group.
        forwarding: False to begin the group without launch configurations.
        launch_configurations: launch configurations that the group sets, by name.
    """

    def __init__(
        self,
        actions: Iterable[Any],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[Any, SomeSubstitutionsType] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        self._actions, self._scoped, self._forwarding = actions, scoped, forwarding
        self._configurations = dict(launch_configurations or {})
        self._items: list[Any] | None = None

    def get_sub_entities(self) -> list[Any]:
        """Return the actions, between those that begin and end the group."""
        if self._items is not None:
            return self._items
        actions = list(self._actions)
        assignments = [SetLaunchConfiguration(name, value) for name, value in self._configurations.items()]
        if not self._scoped:
            self._items = [*assignments, *actions]
            return self._items
        begin: list[Action] = [PushLaunchConfigurations(), PushEnvironment()]
        if self._forwarding:
            begin += assignments
        else:
            begin += [ResetEnvironment(), ResetLaunchConfigurations(self._configurations)]
        self._items = [*begin, *actions, PopEnvironment(), PopLaunchConfigurations()]
        return self._items

    def execute(self, context: LaunchContext) -> list[Any]:
        """Return the actions."""
        return self.get_sub_entities()


class IncludeLaunchDescription(Action):
    """Inclusion of another launch file.

    Args:
        launch_description_source: launch file.
        launch_arguments: pairs of a name and a value.
    """

    kind: ClassVar[str] = "include"

    def __init__(
        self,
        launch_description_source: LaunchDescriptionSource | SomeSubstitutionsType,
        *,
        launch_arguments: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if not isinstance(launch_description_source, LaunchDescriptionSource):
            launch_description_source = AnyLaunchDescriptionSource(launch_description_source)
        self._source = launch_description_source
        if isinstance(launch_arguments, Mapping):
            launch_arguments = launch_arguments.items()
        self._arguments = () if launch_arguments is None else tuple(launch_arguments)

    @property
    def launch_description_source(self) -> LaunchDescriptionSource:
        """Launch file."""
        return self._source

    @property
    def launch_arguments(self) -> tuple[tuple[SomeSubstitutionsType, SomeSubstitutionsType], ...]:
        """Pairs of a name and a value."""
        return self._arguments

    def describe(self) -> str:
        """Return a description of the action."""
        return f"IncludeLaunchDescription({self._source.location})"

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the launch description, if its path does not depend on arguments."""
        description = self._source.try_get_launch_description_without_context()
        return [] if description is None else [description]

    def execute(self, context: LaunchContext) -> Iterable[Any] | None:
        """Read the launch file; return its items, after those that set its arguments."""
        planner, source = context.planner, self._source
        if source.is_file:
            path = Path(perform_substitutions(context, source.substitutions))
            if not planner.has_launch_file(path, self.where):
                return None
        description = source.get_launch_description(context)
        location = os.path.abspath(source.location)  # noqa: PTH100 - a text
        folder = os.path.dirname(location) if source.is_file else source.location  # noqa: PTH120
        place = {"current_launch_file_path": location, "current_launch_file_directory": folder}
        before = {name: value for name, value in context.get_locals_as_dict().items() if name in place}
        context.extend_locals(place)
        given = {*context.launch_configurations, *(_performed(context, name) for name, _ in self._arguments)}
        actions = (each for each in description.entities if getattr(each, "kind", "") == "argument")
        planner.check_arguments((each.argument for each in actions if each.condition is None), given)
        assignments = [SetLaunchConfiguration(name, value) for name, value in self._arguments]
        inside = planner.inside(description, self.where, lambda: context.extend_locals(before))
        return chain(assignments, inside)


def _performed(context: LaunchContext, text: SomeSubstitutionsType) -> str:
    return perform_substitutions(context, normalize_to_list_of_substitutions(text))


class TimerAction(Action):
    """Actions that are executed after a time.

    Args:
        period: time [s].
        actions: actions.
        cancel_on_shutdown: accepted: whether the end of the launch cancels the timer.
    """

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[Any],
        cancel_on_shutdown: bool | SomeSubstitutionsType = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        del cancel_on_shutdown
        self._period = normalize_typed_substitution(float(period) if isinstance(period, (int, str)) else period, float)
        self._actions = actions
        self._is_cancelled = False
        self._locals: dict[str, Any] = {}

    @property
    def period(self) -> Any:
        """Time [s]."""
        return self._period

    @property
    def actions(self) -> Iterable[Any]:
        """Actions."""
        return self._actions

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the actions."""
        return [(f"{self._period} seconds pass without being canceled", self._actions)]

    def handle(self, context: LaunchContext) -> Iterable[Any] | None:
        """Return the actions at the end of the time."""
        if self._is_cancelled:
            return None
        context.extend_locals(self._locals)
        return self._actions

    def cancel(self) -> None:
        """Leave the actions out, if the time has not ended."""
        self._is_cancelled = True

    def execute(self, context: LaunchContext) -> None:
        """Begin to wait."""
        self._locals = context.get_locals_as_dict()
        period = perform_typed_substitution(context, self._period, float)
        if not math.isfinite(period):
            raise ValueError(f"the period of a TimerAction must be a finite number [s], got {period}")
        planner = context.planner
        moment = planner.moment.after(period)
        planner.call(lambda: self.handle(context), context, moment)
        planner.handle(ExecutionComplete(action=self), context, moment)

    def complete(self, context: LaunchContext) -> None:
        """Do nothing: the action is complete at the end of the time."""


class OpaqueFunction(Action):
    """Call of a function.

    Args:
        function: function of a launch context, which may return items to execute.
        args: more arguments of the function.
        kwargs: keyword arguments of the function.
    """

    def __init__(
        self,
        *,
        function: Callable[..., SomeEntitiesType | None],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        if not callable(function):
            raise TypeError(f"OpaqueFunction expected a callable for 'function', got '{type(function)}'")
        self._function, self._args, self._kwargs = function, list(args or ()), dict(kwargs or {})

    def execute(self, context: LaunchContext) -> list[Any] | None:
        """Call the function; return the items that it returns."""
        items = self._function(context, *self._args, **self._kwargs)
        if items is None:
            return None
        return [items] if isinstance(items, LaunchDescriptionEntity) else list(items)


class OpaqueCoroutine(Action):
    """Execution of a coroutine; it runs to its end before the next action.

    Args:
        coroutine: coroutine function.
        args: arguments.
        kwargs: keyword arguments.
        ignore_context: False to give the launch context as the first argument.
    """

    def __init__(
        self,
        *,
        coroutine: Callable[..., object],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        ignore_context: bool = False,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        if not asyncio.iscoroutinefunction(coroutine):
            raise TypeError(f"OpaqueCoroutine expected a coroutine function for 'coroutine', got '{type(coroutine)}'")
        self._coroutine, self._args, self._kwargs = coroutine, list(args or ()), dict(kwargs or {})
        self._ignore_context = ignore_context

    def execute(self, context: LaunchContext) -> None:
        """Run the coroutine."""
        first = [] if self._ignore_context else [context]
        context.planner.program_asyncio.run(self._coroutine(*first, *self._args, **self._kwargs))


class ForEach(Action):
    """Actions for each of several sets of values.

    Args:
        input_values: sets of values, such as `{name: a, id: 1};{name: b, id: 2}`.
        function: function of the values, which returns actions.
    """

    def __init__(
        self, input_values: SomeSubstitutionsType, *, function: Callable[..., SomeEntitiesType | None], **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self._input, self._function = normalize_to_list_of_substitutions(input_values), function

    @property
    def input_values(self) -> list[Any]:
        """Sets of values."""
        return self._input

    @property
    def function(self) -> Callable[..., SomeEntitiesType | None]:
        """Function of the values."""
        return self._function

    def execute(self, context: LaunchContext) -> list[Any]:
        """Call the function with each set of values; return the actions."""
        items: list[Any] = []
        for text in perform_substitutions(context, self._input).strip().removesuffix(";").split(";"):
            values = yaml.safe_load(text) or {}
            made = self._function(**values)
            if made is not None:
                items += [made] if isinstance(made, LaunchDescriptionEntity) else list(made)
        return items


class ForLoop(Action):
    """Actions for each number from 0 on.

    Args:
        length: count of numbers.
        function: function of the number, which returns actions.
        name: name of the index.
    """

    def __init__(
        self,
        length: int | SomeSubstitutionsType,
        *,
        function: Callable[[int], SomeEntitiesType | None],
        name: SomeSubstitutionsType | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._length, self._function = normalize_typed_substitution(length, int), function
        self._name = name

    def execute(self, context: LaunchContext) -> list[Any]:
        """Call the function with each number; return the actions."""
        items: list[Any] = []
        for number in range(perform_typed_substitution(context, self._length, int)):
            made = self._function(number)
            if made is not None:
                items += [made] if isinstance(made, LaunchDescriptionEntity) else list(made)
        return items
