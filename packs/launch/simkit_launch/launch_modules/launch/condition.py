"""Condition of an action."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext

__all__ = ["Condition"]


class Condition:
    """Condition that decides whether an action is executed.

    Args:
        predicate: function of a launch context.
    """

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate

    def describe(self) -> str:
        """Return a description of the condition."""
        return f"{type(self).__name__}({self._predicate})"

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether the condition holds."""
        return self._predicate(context) if self._predicate is not None else True
