"""Events of a launch."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from simkit.extend import Where
from simkit_launch.launch_modules.launch.event import Event

__all__ = ["ExecutionComplete", "IncludeLaunchDescription", "Shutdown", "TimerEvent", "matches_action"]


class ExecutionComplete(Event):
    """Event that an action is complete.

    Args:
        action: action.
    """

    name: ClassVar[str] = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Any) -> None:
        self._action = action

    @property
    def action(self) -> Any:
        """Action."""
        return self._action


class IncludeLaunchDescription(Event):
    """Event that a launch description is included.

    Args:
        launch_description: launch description.
    """

    name: ClassVar[str] = "launch.events.IncludeLaunchDescription"

    def __init__(self, launch_description: Any) -> None:
        self._description = launch_description

    @property
    def launch_description(self) -> Any:
        """Launch description."""
        return self._description


class Shutdown(Event):
    """Event that the launch ends.

    Args:
        reason: reason, for messages.
        due_to_sigint: True after Ctrl-C.
    """

    name: ClassVar[str] = "launch.events.Shutdown"

    def __init__(self, *, reason: str = "reason not given", due_to_sigint: bool = False) -> None:
        self._reason, self._due_to_sigint = reason, due_to_sigint

    @property
    def reason(self) -> str:
        """Reason, for messages."""
        return self._reason

    @property
    def due_to_sigint(self) -> bool:
        """True after Ctrl-C."""
        return self._due_to_sigint

    def take_effect(self, context: Any, where: Where) -> None:
        """Let the run end at the present moment."""
        context.planner.shut_down(where)


class TimerEvent(Event):
    """Event that the time of a timer has ended.

    Args:
        timer_action: timer.
    """

    name: ClassVar[str] = "launch.events.TimerEvent"

    def __init__(self, *, timer_action: Any) -> None:
        self._action = timer_action

    @property
    def timer_action(self) -> Any:
        """Timer."""
        return self._action


def matches_action(target_action: Any) -> Callable[[Any], bool]:
    """Return a function that checks whether an action is the given one."""
    return lambda action: action is target_action
