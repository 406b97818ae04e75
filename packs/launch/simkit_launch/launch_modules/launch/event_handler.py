"""Base classes of event handlers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from simkit_launch.launch_modules.launch.launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.event import Event
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_entities_type import SomeEntitiesType

__all__ = ["BaseEventHandler", "EventHandler"]


class BaseEventHandler:
    """Handler of the events that a matcher accepts.

    Args:
        matcher: function that decides whether an event is handled.
        handle_once: True for a handler that is removed after its first event.
    """

    def __init__(self, *, matcher: Callable[[Event], bool], handle_once: bool = False) -> None:
        self._matcher, self._handle_once = matcher, handle_once

    @property
    def handle_once(self) -> bool:
        """True for a handler that is removed after its first event."""
        return self._handle_once

    @property
    def handler_description(self) -> str:
        """Description of what happens."""
        return ""

    @property
    def matcher_description(self) -> str:
        """Description of the events."""
        return ""

    def matches(self, event: Event) -> bool:
        """Return whether the handler handles an event."""
        return self._matcher(event)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description, and the items that are executed at an event."""
        return type(self).__name__, []

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Handle an event; return items to execute."""
        context.extend_locals({"event": event})
        if self.handle_once:
            context.unregister_event_handler(self)
        return None


class EventHandler(BaseEventHandler):
    """Handler that executes given items at each event that a matcher accepts.

    Args:
        matcher: function that decides whether an event is handled.
        entities: items to execute.
        handle_once: True for a handler that is removed after its first event.
    """

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        entities: SomeEntitiesType | None = None,
        handle_once: bool = False,
    ) -> None:
        super().__init__(matcher=matcher, handle_once=handle_once)
        self._entities = entities

    @property
    def entities(self) -> SomeEntitiesType | None:
        """Items to execute."""
        return self._entities

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description, and the items that are executed at an event."""
        text, items = super().describe()
        return text, [*items, *_listed(self._entities)]

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Handle an event; return items to execute."""
        super().handle(event, context)
        return self.entities


def _listed(entities: SomeEntitiesType | None) -> Iterable[LaunchDescriptionEntity]:
    if entities is None:
        return []
    return [entities] if isinstance(entities, LaunchDescriptionEntity) else list(entities)
