"""Base class of actions."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from simkit_launch.action_places import calling_place
from simkit_launch.launch_modules.launch.events import ExecutionComplete
from simkit_launch.launch_modules.launch.launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.condition import Condition
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext

__all__ = ["Action"]


class Action(LaunchDescriptionEntity):
    """Item that does something while the launch file is executed.

    Args:
        condition: condition without which the action is left out; None for always.

    Attributes:
        where: line of the launch file that made the action.
    """

    def __init__(self, *, condition: Condition | None = None) -> None:
        self._condition = condition
        self.where = calling_place()

    @property
    def condition(self) -> Condition | None:
        """Condition without which the action is left out; None for always."""
        return self._condition

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the items inside this one."""
        return []

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the items inside this one, if it has no condition."""
        return self.get_sub_entities() if self.condition is None else []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the items inside this one, if it has a condition."""
        items = self.get_sub_entities() if self.condition is not None else []
        return [("Conditionally included by " + self.describe(), items)] if items else []

    def visit(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity] | None:
        """Execute the action if its condition holds; return items to execute after it."""
        if self.condition is None or self.condition.evaluate(context):
            items = self.execute(context)
            self.complete(context)
            return items
        return None

    def complete(self, context: LaunchContext) -> None:
        """Emit the event that the action is complete."""
        event = ExecutionComplete(action=self)
        if context.would_handle_event(event):
            context.planner.handle(event, context, context.planner.moment)

    def execute(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity] | None:
        """Execute the action; return items to execute after it."""
        del context
        return None
