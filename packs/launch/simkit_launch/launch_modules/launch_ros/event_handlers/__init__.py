"""Handlers of the events of nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit_launch.launch_modules.launch.event_handler import EventHandler
from simkit_launch.launch_modules.launch_ros.events.lifecycle import StateTransition

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.event import Event
    from simkit_launch.launch_modules.launch.some_entities_type import SomeEntitiesType

__all__ = ["OnStateTransition"]


class OnStateTransition(EventHandler):
    """Handler of the transitions of a node.

    Args:
        entities: items to execute.
        target_lifecycle_node: action that starts the node; None for every node.
        transition: name of the transition; None for all.
        start_state: state before; None for all.
        goal_state: state after; None for all.
        matcher: function that decides whether an event is handled, instead of the other arguments.
    """

    def __init__(
        self,
        *,
        entities: SomeEntitiesType | None,
        target_lifecycle_node: Any = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        matcher: Callable[[Event], bool] | None = None,
        **kwargs: Any,
    ) -> None:
        def matches(event: Event) -> bool:
            return (
                isinstance(event, StateTransition)
                and (target_lifecycle_node is None or event.action is target_lifecycle_node)
                and transition in (None, event.transition)
                and start_state in (None, event.start_state)
                and goal_state in (None, event.goal_state)
            )

        super().__init__(matcher=matcher or matches, entities=entities, **kwargs)
