"""Base class of events."""

from __future__ import annotations

from typing import Any, ClassVar

from simkit.extend import Where

__all__ = ["Event"]


class Event:
    """Event that event handlers react to."""

    name: ClassVar[str] = "launch.Event"

    def take_effect(self, context: Any, where: Where) -> None:
        """Let the handlers of the event handle it at the present moment.

        Args:
            context: state of the execution.
            where: place of the action that emits the event.
        """
        del where
        context.planner.handle(self, context, context.planner.moment)
