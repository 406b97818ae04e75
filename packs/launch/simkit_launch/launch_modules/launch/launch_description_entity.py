"""Base class of everything in a launch description."""

from __future__ import annotations

from asyncio import Future
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext

__all__ = ["LaunchDescriptionEntity"]


class LaunchDescriptionEntity:
    """Item of a launch description.

    Attributes:
        kind: "argument" for a declaration of an argument, "include" for an include; empty for any other item.
    """

    kind: ClassVar[str] = ""

    def describe(self) -> str:
        """Return a description of the item."""
        return type(self).__name__

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the items inside this one that do not depend on a condition."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the items inside this one that depend on a condition, with a description of it."""
        return []

    def visit(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity] | None:
        """Execute the item; return items to execute after it."""
        del context
        return None

    def get_asyncio_future(self) -> Future[Any] | None:
        """Return None: nothing continues in the background while a launch file is executed."""
        return None
