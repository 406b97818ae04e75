"""Handlers of the events of a launch."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from simkit_launch.launch_modules.launch.action import Action
from simkit_launch.launch_modules.launch.event import Event
from simkit_launch.launch_modules.launch.event_handler import BaseEventHandler, EventHandler
from simkit_launch.launch_modules.launch.events import ExecutionComplete, IncludeLaunchDescription, Shutdown
from simkit_launch.launch_modules.launch.events.process import ProcessExited, ProcessIO, ProcessStarted
from simkit_launch.launch_modules.launch.launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_entities_type import SomeEntitiesType

__all__ = [
    "OnActionEventBase",
    "OnExecutionComplete",
    "OnIncludeLaunchDescription",
    "OnProcessExit",
    "OnProcessIO",
    "OnProcessStart",
    "OnShutdown",
    "event_named",
]


def event_named(name: str) -> Callable[[Event], bool]:
    """Return a function that checks whether an event has a name."""
    return lambda event: event.name == name


class OnActionEventBase(BaseEventHandler):
    """Handler of the events of an action.

    Args:
        action_matcher: action, or function that decides whether the event of an action is handled; None for all.
        on_event: items to execute, or function of the event and the context.
        target_event_cls: class of the events.
        target_action_cls: class of the actions.
    """

    def __init__(
        self,
        *,
        action_matcher: Any,
        on_event: Any,
        target_event_cls: type[Event],
        target_action_cls: type[Any],
        **kwargs: Any,
    ) -> None:
        if not (action_matcher is None or isinstance(action_matcher, target_action_cls) or callable(action_matcher)):
            raise TypeError(f"action_matcher must be an '{target_action_cls.__name__}' instance or a callable")

        def matches(event: Event) -> bool:
            if not isinstance(event, target_event_cls):
                return False
            if isinstance(action_matcher, target_action_cls):
                return getattr(event, "action", None) is action_matcher
            return action_matcher is None or bool(action_matcher(getattr(event, "action", None)))

        super().__init__(matcher=matches, **kwargs)
        self._function: Callable[[Any, Any], Any] | None = None
        self._actions: list[LaunchDescriptionEntity] = []
        if callable(on_event) and not isinstance(on_event, LaunchDescriptionEntity):
            self._function = on_event
        elif isinstance(on_event, Iterable):
            self._actions = list(on_event)
            for each in self._actions:
                if not isinstance(each, LaunchDescriptionEntity):
                    raise TypeError(
                        "expected all items in 'on_event' iterable to be of type 'LaunchDescriptionEntity' "
                        f"but got '{type(each)}'"
                    )
        elif on_event is not None:
            self._actions = [on_event]

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Handle an event; return items to execute."""
        super().handle(event, context)
        if self._function is None:
            return self._actions
        result: SomeEntitiesType | None = self._function(event, context)
        return result

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description, and the items that are executed at an event."""
        return type(self).__name__, list(self._actions)


class OnProcessExit(OnActionEventBase):
    """Handler of the end of a process.

    Args:
        target_action: action that starts the process; None for every process.
        on_exit: items to execute, or function of the event and the context.
    """

    def __init__(self, *, target_action: Any = None, on_exit: Any, **kwargs: Any) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_exit,
            target_event_cls=ProcessExited,
            target_action_cls=Action,
            **kwargs,
        )


class OnProcessStart(OnActionEventBase):
    """Handler of the start of a process.

    Args:
        target_action: action that starts the process; None for every process.
        on_start: items to execute, or function of the event and the context.
    """

    def __init__(self, *, target_action: Any = None, on_start: Any, **kwargs: Any) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_start,
            target_event_cls=ProcessStarted,
            target_action_cls=Action,
            **kwargs,
        )


class OnProcessIO(OnActionEventBase):
    """Handler of the output of a process.

    Args:
        target_action: action that starts the process; None for every process.
        on_stdin, on_stdout, on_stderr: functions of the event.
    """

    def __init__(
        self,
        *,
        target_action: Any = None,
        on_stdin: Callable[[Any], Any] | None = None,
        on_stdout: Callable[[Any], Any] | None = None,
        on_stderr: Callable[[Any], Any] | None = None,
        **kwargs: Any,
    ) -> None:
        function = on_stdout or on_stderr or on_stdin

        def handle(event: Any, context: Any) -> Any:
            items = None if function is None else function(event)
            if items:
                text = f"the output of {event.process_name!r} is not known before the run"
                text += "; what waits for it starts with the process"
                context.planner.warn_left_out(text, event.action.where)
            return items

        super().__init__(
            action_matcher=target_action,
            on_event=handle,
            target_event_cls=ProcessIO,
            target_action_cls=Action,
            **kwargs,
        )


class OnExecutionComplete(OnActionEventBase):
    """Handler of the completion of an action.

    Args:
        target_action: action; None for every action.
        on_completion: items to execute, or function of the event and the context.
    """

    def __init__(self, *, target_action: Any = None, on_completion: Any, **kwargs: Any) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_completion,
            target_event_cls=ExecutionComplete,
            target_action_cls=Action,
            **kwargs,
        )


class OnShutdown(BaseEventHandler):
    """Handler of the end of the launch.

    Args:
        on_shutdown: items to execute, or function of the event and the context.
    """

    def __init__(self, *, on_shutdown: Any, **kwargs: Any) -> None:
        super().__init__(matcher=lambda event: isinstance(event, Shutdown), **kwargs)
        self._on_shutdown = on_shutdown

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Handle an event; return items to execute."""
        super().handle(event, context)
        if callable(self._on_shutdown) and not isinstance(self._on_shutdown, LaunchDescriptionEntity):
            result: SomeEntitiesType | None = self._on_shutdown(event, context)
            return result
        items: SomeEntitiesType | None = self._on_shutdown
        return items


class OnIncludeLaunchDescription(EventHandler):
    """Handler of the inclusion of a launch description."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(matcher=lambda event: isinstance(event, IncludeLaunchDescription), **kwargs)
