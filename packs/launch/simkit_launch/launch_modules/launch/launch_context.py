"""State of the execution of a launch file."""

from __future__ import annotations

import os
from asyncio import AbstractEventLoop
from collections import deque
from collections.abc import Callable, Iterable, Mapping, MutableMapping
from typing import TYPE_CHECKING, Any

from simkit_launch.planner import current_planner

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.event import Event
    from simkit_launch.launch_modules.launch.event_handler import BaseEventHandler
    from simkit_launch.launch_modules.launch.substitution import Substitution
    from simkit_launch.planner import LaunchPlanner

__all__ = ["LaunchContext"]


class _Locals:
    """Local variables of a context as attributes."""

    def __init__(self, values: dict[str, Any]) -> None:
        self.__dict__.update(values)

    def __getattr__(self, name: str) -> Any:
        known = ", ".join(self.__dict__)
        raise AttributeError(f"context.locals does not contain attribute '{name}', it contains: [{known}]")

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"can't set attribute '{name}', locals are read-only")


class _Configurations(dict[str, Any]):
    """Launch configurations; the names that somebody reads are noted."""

    def __init__(self, values: Mapping[str, Any], used_names: set[str]) -> None:
        super().__init__(values)
        self._used_names = used_names

    def __getitem__(self, name: str) -> Any:
        self._used_names.add(name)
        return super().__getitem__(name)

    def get(self, name: str, default: Any = None) -> Any:
        """Return the value of a launch configuration, or another value without it."""
        self._used_names.add(name)
        return super().get(name, default)


class LaunchContext:
    """State of the execution: launch configurations, environment, local variables and event handlers.

    Args:
        argv: command line, for the actions.
        noninteractive: True without a terminal.

    Attributes:
        planner: what records the processes.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False) -> None:
        self._argv, self._noninteractive = list(argv or ()), noninteractive
        self.planner: LaunchPlanner = current_planner()
        self._event_handlers: deque[BaseEventHandler] = deque()
        self._globals: dict[str, Any] = {}
        self._locals: dict[str, Any] = {}
        self._locals_stack: list[dict[str, Any]] = []
        self._configurations = _Configurations({}, self.planner.used_names)
        self._configurations_stack: list[_Configurations] = []
        self._environment_stack: list[dict[str, str]] = []
        self._environment_at_begin = dict(os.environ)
        self._is_shutdown = False

    @property
    def argv(self) -> list[str]:
        """Command line."""
        return self._argv

    @property
    def noninteractive(self) -> bool:
        """True without a terminal."""
        return self._noninteractive

    @property
    def is_shutdown(self) -> bool:
        """True after the launch has ended."""
        return self._is_shutdown

    @property
    def asyncio_loop(self) -> AbstractEventLoop | None:
        """None: nothing runs in the background while a launch file is executed."""
        return None

    def add_completion_future(self, completion_future: object) -> None:
        """Do nothing: nothing runs in the background while a launch file is executed."""

    # ------------------------------------------------------------------ local variables

    def push_locals(self) -> None:
        """Store the local variables."""
        self._locals_stack.append(dict(self._locals))

    def pop_locals(self) -> None:
        """Restore the local variables that were stored last."""
        if not self._locals_stack:
            raise RuntimeError("locals stack unexpectedly empty")
        self._locals = self._locals_stack.pop()

    def extend_globals(self, extensions: dict[str, Any]) -> None:
        """Add local variables that stay for ever."""
        self._globals.update(extensions)

    def extend_locals(self, extensions: dict[str, Any]) -> None:
        """Add local variables, until the stored ones are restored."""
        self._locals.update(extensions)

    def get_locals_as_dict(self) -> dict[str, Any]:
        """Return the local variables."""
        return {**self._globals, **self._locals}

    @property
    def locals(self) -> Any:
        """Local variables as attributes."""
        return _Locals(self.get_locals_as_dict())

    # ------------------------------------------------------------------ launch configurations and environment

    @property
    def launch_configurations(self) -> dict[str, Any]:
        """Launch configurations by name."""
        return self._configurations

    def push_launch_configurations(self) -> None:
        """Store the launch configurations."""
        self._configurations_stack.append(_Configurations(self._configurations, self.planner.used_names))

    def pop_launch_configurations(self) -> None:
        """Restore the launch configurations that were stored last."""
        if not self._configurations_stack:
            raise RuntimeError("launch_configurations stack unexpectedly empty")
        self._configurations = self._configurations_stack.pop()

    @property
    def environment(self) -> MutableMapping[str, str]:
        """Variables of the environment."""
        return os.environ

    def push_environment(self) -> None:
        """Store the variables of the environment."""
        self._environment_stack.append(dict(os.environ))

    def pop_environment(self) -> None:
        """Restore the variables of the environment that were stored last."""
        if not self._environment_stack:
            raise RuntimeError("environment stack unexpectedly empty")
        _set_environment(self._environment_stack.pop())

    def reset_environment(self) -> None:
        """Restore the variables of the environment that the context began with."""
        _set_environment(self._environment_at_begin)

    # ------------------------------------------------------------------ events

    def would_handle_event(self, event: Event) -> bool:
        """Return whether an event handler handles an event."""
        return any(handler.matches(event) for handler in self._event_handlers)

    def register_event_handler(self, event_handler: BaseEventHandler, append: bool = False) -> None:
        """Add an event handler: before the others, or after them."""
        (self._event_handlers.append if append else self._event_handlers.appendleft)(event_handler)

    def unregister_event_handler(self, event_handler: BaseEventHandler) -> None:
        """Remove an event handler.

        Raises:
            ValueError: it is not registered.
        """
        self._event_handlers.remove(event_handler)

    def event_handlers(self) -> tuple[BaseEventHandler, ...]:
        """Return the event handlers in the order in which they handle an event."""
        return tuple(self._event_handlers)

    def emit_event_sync(self, event: Event) -> None:
        """Emit an event; it is handled after the present action."""
        event.take_effect(self, self.planner.place)

    async def emit_event(self, event: Event) -> None:
        """Emit an event; it is handled after the present action."""
        event.take_effect(self, self.planner.place)

    def perform_substitution(self, substitution: Substitution) -> str:
        """Return the text of a substitution."""
        return substitution.perform(self)

    # names that extensions of launch use
    _push_locals, _pop_locals = push_locals, pop_locals
    _push_environment, _pop_environment, _reset_environment = push_environment, pop_environment, reset_environment
    _push_launch_configurations: Callable[[LaunchContext], None] = push_launch_configurations
    _pop_launch_configurations: Callable[[LaunchContext], None] = pop_launch_configurations


def _set_environment(variables: dict[str, str]) -> None:
    for name in [name for name in os.environ if name not in variables]:
        del os.environ[name]
    os.environ.update(variables)
