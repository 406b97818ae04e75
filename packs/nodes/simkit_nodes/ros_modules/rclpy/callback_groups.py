"""Callback groups: which callbacks may run at the same time."""

from __future__ import annotations

import threading
from typing import Any
from weakref import ref

__all__ = ["CallbackGroup", "MutuallyExclusiveCallbackGroup", "ReentrantCallbackGroup"]


class CallbackGroup:
    """Base of the callback groups.

    Attributes:
        entities: weak references to the subscriptions, timers and so on of the group.
    """

    def __init__(self) -> None:
        self.entities: set[Any] = set()

    def add_entity(self, entity: object) -> None:
        """Add a subscription, timer, client, service, guard condition or waitable."""
        self.entities.add(ref(entity))

    def has_entity(self, entity: object) -> bool:
        """Check whether the group contains a subscription, timer and so on."""
        return ref(entity) in self.entities

    def can_execute(self, entity: object) -> bool:
        """Check whether a callback may begin."""
        raise NotImplementedError

    def beginning_execution(self, entity: object) -> bool:
        """Begin a callback; return False if it may not begin."""
        raise NotImplementedError

    def ending_execution(self, entity: object) -> None:
        """End a callback."""
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """Group whose callbacks may all run at the same time."""

    def can_execute(self, entity: object) -> bool:
        """Return True."""
        return True

    def beginning_execution(self, entity: object) -> bool:
        """Return True."""
        return True

    def ending_execution(self, entity: object) -> None:
        """Do nothing."""


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """Group of which one callback runs at a time."""

    def __init__(self) -> None:
        super().__init__()
        self._active_entity: Any = None
        self._lock = threading.Lock()

    def can_execute(self, entity: object) -> bool:
        """Check whether no callback of the group runs."""
        return self._active_entity is None

    def beginning_execution(self, entity: object) -> bool:
        """Begin a callback; return False if another one runs."""
        with self._lock:
            if self._active_entity is not None:
                return False
            self._active_entity = entity
            return True

    def ending_execution(self, entity: object) -> None:
        """End a callback."""
        self._active_entity = None
