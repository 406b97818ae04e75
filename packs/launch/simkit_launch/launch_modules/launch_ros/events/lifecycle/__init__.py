"""Events of nodes with states."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar, Final

from simkit.extend import Where
from simkit_launch.launch_modules.launch.event import Event
from simkit_launch.planner import Moment

__all__ = ["ChangeState", "StateTransition", "matches_node_name"]

NO_NAMESPACE: Final = "<node_namespace_unspecified>"
"""Begin of the name of a node for which the launch file gives no namespace."""

TRANSITION_IDS: Final = {
    "create": 0,
    "configure": 1,
    "cleanup": 2,
    "activate": 3,
    "deactivate": 4,
    "unconfigured_shutdown": 5,
    "inactive_shutdown": 6,
    "active_shutdown": 7,
}
"""Numbers of transitions by name, as in `lifecycle_msgs/msg/Transition`."""

STATES: Final = {
    "configure": ("unconfigured", "configuring", "inactive"),
    "cleanup": ("inactive", "cleaningup", "unconfigured"),
    "activate": ("inactive", "activating", "active"),
    "deactivate": ("active", "deactivating", "inactive"),
    "shutdown": ("active", "shuttingdown", "finalized"),
}
"""States before, during and after a transition by its name."""


class ChangeState(Event):
    """Request for a transition.

    Args:
        lifecycle_node_matcher: function that decides whether the request is for a node.
        transition_id: transition, such as `Transition.TRANSITION_CONFIGURE`.
    """

    name: ClassVar[str] = "launch_ros.events.lifecycle.ChangeState"

    def __init__(self, *, lifecycle_node_matcher: Callable[[Any], bool], transition_id: int) -> None:
        self._matcher, self._id = lifecycle_node_matcher, transition_id

    @property
    def lifecycle_node_matcher(self) -> Callable[[Any], bool]:
        """Function that decides whether the request is for a node."""
        return self._matcher

    @property
    def transition_id(self) -> int:
        """Transition."""
        return self._id

    @property
    def transition(self) -> str:
        """Name of the transition, such as `configure`."""
        names = {number: name for name, number in TRANSITION_IDS.items()}
        return names.get(self._id, "").rpartition("_")[2]

    def take_effect(self, context: Any, where: Where) -> None:
        """Add the command for the transition of each node that the request is for, and handle its events."""
        for action in context.planner.lifecycle_nodes:
            if self.lifecycle_node_matcher(action):
                self.change(action.node_name, action, context, where)

    def change(self, node: str, action: Any, context: Any, where: Where) -> Moment:
        """Add the command for the transition of a node; return the moment of its end.

        Args:
            node: name of the node.
            action: action that starts the node; None if it is unknown.
            context: state of the execution.
            where: place in the launch file.
        """
        planner = context.planner
        words = ("ros2", "lifecycle", "set", node.replace(NO_NAMESPACE, ""), self.transition)
        ended: Moment = planner.ended(planner.add({"kind": "command", "arguments": words}, where))
        start, between, goal = STATES.get(self.transition, ("", "", ""))
        for first, second in ((start, between), (between, goal)):
            names = {"transition": self.transition, "start_state": first, "goal_state": second}
            planner.handle(StateTransition(action=action, **names), context, ended)
        return ended


class StateTransition(Event):
    """Event that the state of a node has changed.

    Args:
        action: action that starts the node.
        msg: message with the transition.
        transition, start_state, goal_state: names.
    """

    name: ClassVar[str] = "launch_ros.events.lifecycle.StateTransition"

    def __init__(
        self, *, action: Any, msg: Any = None, transition: str = "", start_state: str = "", goal_state: str = ""
    ) -> None:
        self._action, self._msg = action, msg
        self._transition, self._start_state, self._goal_state = transition, start_state, goal_state

    @property
    def action(self) -> Any:
        """Action that starts the node."""
        return self._action

    @property
    def msg(self) -> Any:
        """Message with the transition."""
        return self._msg

    @property
    def transition(self) -> str:
        """Name of the transition."""
        return self._transition

    @property
    def start_state(self) -> str:
        """State before."""
        return self._start_state

    @property
    def goal_state(self) -> str:
        """State after."""
        return self._goal_state


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Return a function that checks whether an action starts a node with a name."""
    name = node_name if node_name.startswith("/") else f"/{node_name}"
    return lambda action: str(action.node_name).replace(NO_NAMESPACE, "") == name
