"""Actions for nodes with states: their start and their transitions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from simkit_launch.launch_modules.launch.action import Action
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from simkit_launch.launch_modules.launch_ros.actions.node import Node
from simkit_launch.launch_modules.launch_ros.events.lifecycle import TRANSITION_IDS, ChangeState, matches_node_name
from simkit_launch.launch_modules.launch_ros.utilities import make_namespace_absolute

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["LifecycleNode", "LifecycleTransition"]


class LifecycleNode(Node):
    """Start of a node with states.

    Args:
        name: name of the node.
        namespace: namespace of the node.
        autostart: True to configure and activate the node.
        kwargs: arguments of `Node`.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType | None = None,
        autostart: bool | SomeSubstitutionsType = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self._autostart = autostart

    @property
    def node_autostart(self) -> Any:
        """True to configure and activate the node."""
        return self._autostart

    def execute(self, context: LaunchContext) -> list[Any] | None:
        """Add the node to the plan."""
        super().execute(context)
        context.planner.lifecycle_nodes.append(self)
        autostart = self._autostart
        if not isinstance(autostart, bool):
            autostart = perform_substitutions(context, normalize_to_list_of_substitutions(autostart)).lower() == "true"
        if not autostart:
            return None
        ids = (TRANSITION_IDS["configure"], TRANSITION_IDS["activate"])
        return [LifecycleTransition(lifecycle_node_names=[self.node_name], transition_ids=ids)]


class LifecycleTransition(Action):
    """Transitions of nodes with states.

    Args:
        lifecycle_node_names: names of the nodes.
        transition_ids: transitions in their order, such as `Transition.TRANSITION_CONFIGURE`.
    """

    def __init__(
        self,
        *,
        lifecycle_node_names: Iterable[SomeSubstitutionsType],
        transition_ids: Iterable[int | SomeSubstitutionsType],
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._names = [normalize_to_list_of_substitutions(name) for name in lifecycle_node_names]
        self._ids: Sequence[Any] = list(transition_ids)
        if not self._names:
            raise RuntimeError("No lifecycle_node_names provided.")
        if not self._ids:
            raise RuntimeError("No transition_ids provided.")

    def execute(self, context: LaunchContext) -> None:
        """Add the transitions to the plan."""
        planner = context.planner
        for name in (perform_substitutions(context, name) for name in self._names):
            node = make_namespace_absolute(name) or name
            action = next(filter(matches_node_name(node), planner.lifecycle_nodes), None)
            moment = planner.moment
            for number in self._ids:
                if not isinstance(number, int):
                    number = int(perform_substitutions(context, normalize_to_list_of_substitutions(number)))
                event = ChangeState(lifecycle_node_matcher=matches_node_name(node), transition_id=number)
                with planner.at(moment):
                    moment = event.change(node, action, context, self.where)
