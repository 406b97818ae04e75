"""Launch description: what a launch file returns."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from simkit_launch.launch_modules.launch.launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext

__all__ = ["LaunchDescription"]


class LaunchDescription(LaunchDescriptionEntity):
    """Sequence of items that are executed in order.

    Args:
        initial_entities: items.
        deprecated_reason: reason why nobody should use the launch file any longer.
    """

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self._entities: list[Any] = list(initial_entities) if initial_entities is not None else []
        self._deprecated_reason = deprecated_reason

    @property
    def entities(self) -> list[Any]:
        """Items."""
        return self._entities

    @property
    def deprecated(self) -> bool:
        """True if nobody should use the launch file any longer."""
        return self._deprecated_reason is not None

    @property
    def deprecated_reason(self) -> str | None:
        """Reason why nobody should use the launch file any longer."""
        return self._deprecated_reason

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        """Add an item."""
        self._entities.append(entity)

    def add_action(self, action: LaunchDescriptionEntity) -> None:
        """Add an action."""
        self.add_entity(action)

    def visit(self, context: LaunchContext) -> list[Any]:
        """Return the items, which are executed then."""
        return self._entities

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the items."""
        return self._entities

    def get_launch_arguments(self, conditional_inclusion: bool = False) -> list[Any]:
        """Return the declared arguments, also those of included files, each once."""
        return [
            each for each, _ in self.get_launch_arguments_with_include_launch_description_actions(conditional_inclusion)
        ]

    def get_launch_arguments_with_include_launch_description_actions(
        self, conditional_inclusion: bool = False
    ) -> list[tuple[Any, list[Any] | None]]:
        """Return the declared arguments, each with the actions that include the file which declares it."""
        found: dict[str, tuple[Any, list[Any] | None]] = {}

        def collect(items: Iterable[Any], includes: list[Any] | None, is_conditional: bool, depth: int) -> None:
            for item in items:
                if getattr(item, "kind", "") == "argument":
                    item.conditionally_included = is_conditional
                    found.setdefault(item.name, (item, includes))
                    continue
                if not hasattr(item, "describe_sub_entities") or depth > _MOST_LEVELS:
                    continue
                inside = [*(includes or ()), item] if getattr(item, "kind", "") == "include" else includes
                collect(item.describe_sub_entities(), inside, is_conditional, depth + 1)
                for _, sub_items in item.describe_conditional_sub_entities():
                    collect(sub_items, inside, True, depth + 1)

        collect(self.entities, None, conditional_inclusion, 0)
        return list(found.values())


_MOST_LEVELS = 100
