"""Objects that change with the state of a lifecycle node."""

from __future__ import annotations

import enum
from collections.abc import Callable
from functools import wraps
from typing import Any

__all__ = ["ManagedEntity", "SimpleManagedEntity", "TransitionCallbackReturn"]


class TransitionCallbackReturn(enum.Enum):
    """Result of the callback of a transition, with its number in `lifecycle_msgs/msg/Transition`."""

    SUCCESS = 97
    FAILURE = 98
    ERROR = 99

    def to_label(self) -> str:
        """Return the label of the transition that follows."""
        return f"transition_{self.name.lower()}"


class ManagedEntity:
    """Object that a lifecycle node informs about its transitions.

    Each function receives the state before, and returns a `TransitionCallbackReturn`.
    """

    def on_configure(self, state: Any) -> TransitionCallbackReturn:
        """Prepare the object."""
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: Any) -> TransitionCallbackReturn:
        """Undo `on_configure`."""
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: Any) -> TransitionCallbackReturn:
        """End the object."""
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: Any) -> TransitionCallbackReturn:
        """Start to work."""
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: Any) -> TransitionCallbackReturn:
        """Stop to work."""
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: Any) -> TransitionCallbackReturn:
        """Recover after an error in another function."""
        return TransitionCallbackReturn.SUCCESS


class SimpleManagedEntity(ManagedEntity):
    """Object that is enabled while the node is active."""

    def __init__(self) -> None:
        self._enabled = False

    def on_activate(self, state: Any) -> TransitionCallbackReturn:
        """Enable the object."""
        self._enabled = True
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: Any) -> TransitionCallbackReturn:
        """Disable the object."""
        self._enabled = False
        return TransitionCallbackReturn.SUCCESS

    @property
    def is_activated(self) -> bool:
        """True while the node is active."""
        return self._enabled

    @staticmethod
    def when_enabled(
        wrapped: Callable[..., object] | None = None, *, when_not_enabled: Callable[[], object] | None = None
    ) -> Any:
        """Decorate a method that does nothing while the object is disabled.

        Args:
            wrapped: method.
            when_not_enabled: function that is called instead.
        """

        def decorator(method: Callable[..., object]) -> Callable[..., None]:
            @wraps(method)
            def call(self: SimpleManagedEntity, *args: Any, **kwargs: Any) -> None:
                if self._enabled:
                    method(self, *args, **kwargs)
                elif when_not_enabled is not None:
                    when_not_enabled()

            return call

        return decorator if wrapped is None else decorator(wrapped)
