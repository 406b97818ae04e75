"""Actions for events, for messages, and for the end of the launch."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from simkit_launch.launch_modules.launch.action import Action
from simkit_launch.launch_modules.launch.events import Shutdown as ShutdownEvent
from simkit_launch.launch_modules.launch.launch_description_entity import LaunchDescriptionEntity
from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.event import Event
    from simkit_launch.launch_modules.launch.event_handler import BaseEventHandler
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = [
    "EmitEvent",
    "Log",
    "LogDebug",
    "LogError",
    "LogInfo",
    "LogWarning",
    "RegisterEventHandler",
    "Shutdown",
    "UnregisterEventHandler",
]


class EmitEvent(Action):
    """Emission of an event.

    Args:
        event: event.
    """

    def __init__(self, *, event: Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._event = event

    @property
    def event(self) -> Event:
        """Event."""
        return self._event

    def execute(self, context: LaunchContext) -> None:
        """Emit the event."""
        self.event.take_effect(context, self.where)


class Shutdown(EmitEvent):
    """End of the launch.

    Args:
        reason: reason, for messages.
    """

    def __init__(self, *, reason: str = "reason not given", **kwargs: Any) -> None:
        super().__init__(event=ShutdownEvent(reason=reason), **kwargs)


class RegisterEventHandler(Action):
    """Registration of an event handler.

    Args:
        event_handler: event handler.
    """

    def __init__(self, event_handler: BaseEventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._handler = event_handler

    @property
    def event_handler(self) -> BaseEventHandler:
        """Event handler."""
        return self._handler

    def execute(self, context: LaunchContext) -> None:
        """Register the event handler."""
        context.register_event_handler(self._handler)

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the items that are executed at an event."""
        text, items = self._handler.describe()
        return [(text, items)] if items else []


class UnregisterEventHandler(Action):
    """Removal of an event handler.

    Args:
        event_handler: event handler.
    """

    def __init__(self, event_handler: BaseEventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._handler = event_handler

    @property
    def event_handler(self) -> BaseEventHandler:
        """Event handler."""
        return self._handler

    def execute(self, context: LaunchContext) -> None:
        """Remove the event handler."""
        context.unregister_event_handler(self._handler)


class Log(Action):
    """Message in the log of the launch.

    Args:
        msg: text.
        level: such as `INFO`.
    """

    def __init__(self, *, msg: SomeSubstitutionsType, level: SomeSubstitutionsType = "INFO", **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._msg, self._level = normalize_to_list_of_substitutions(msg), normalize_to_list_of_substitutions(level)

    @property
    def msg(self) -> list[Substitution]:
        """Text."""
        return self._msg

    @property
    def level(self) -> list[Substitution]:
        """Level, such as `INFO`."""
        return self._level

    def execute(self, context: LaunchContext) -> None:
        """Add the message to the log."""
        level, text = perform_substitutions(context, self.level).upper(), perform_substitutions(context, self.msg)
        if level != "DEBUG":
            context.planner.log(f"[{level}] [launch.user]: {text}")


class LogInfo(Log):
    """Message of the level `INFO`.

    Args:
        msg: text.
    """

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="INFO", **kwargs)


class LogWarning(Log):
    """Message of the level `WARNING`.

    Args:
        msg: text.
    """

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="WARNING", **kwargs)


class LogError(Log):
    """Message of the level `ERROR`.

    Args:
        msg: text.
    """

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="ERROR", **kwargs)


class LogDebug(Log):
    """Message of the level `DEBUG`, which is not shown.

    Args:
        msg: text.
    """

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="DEBUG", **kwargs)
