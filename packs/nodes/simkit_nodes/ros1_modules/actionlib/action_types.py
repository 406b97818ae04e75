"""Types of an action of ROS 1, and its states."""

from __future__ import annotations

from typing import Any, NamedTuple

from simkit.errors import ArgumentTypeError
from simkit_nodes.interfaces import ROS1, type_name_of
from simkit_nodes.ros1_modules.actionlib.exceptions import ActionException

__all__ = ["CommState", "SimpleGoalState", "TerminalState", "get_name_of_constant"]


def get_name_of_constant(C: Any, n: int) -> str:
    """Return the name of a constant of a class by its number."""
    names = (name for name, value in vars(C).items() if isinstance(value, int) and value == n)
    return next(names, f"NO_SUCH_STATE_{n}")


class CommState:
    """States of a goal, as its client knows them."""

    WAITING_FOR_GOAL_ACK = 0
    PENDING = 1
    ACTIVE = 2
    WAITING_FOR_RESULT = 3
    WAITING_FOR_CANCEL_ACK = 4
    RECALLING = 5
    PREEMPTING = 6
    DONE = 7
    LOST = 8

    to_string = classmethod(get_name_of_constant)


class SimpleGoalState:
    """States of a goal of a `SimpleActionClient`."""

    PENDING = 0
    ACTIVE = 1
    DONE = 2

    to_string = classmethod(get_name_of_constant)


class TerminalState:
    """Final states of a goal; the numbers are those of `actionlib_msgs/GoalStatus`."""

    PREEMPTED = 2
    SUCCEEDED = 3
    ABORTED = 4
    REJECTED = 5
    RECALLED = 8
    LOST = 9

    to_string = classmethod(get_name_of_constant)


class ActionTypes(NamedTuple):
    """Names of the types of an action.

    Attributes:
        action: action, such as `actionlib_tutorials/action/Fibonacci`.
        goal: type of its goals.
        result: type of its results.
        feedback: type of its feedback.
        action_goal: type of the message of ROS 1 with a goal, its identifier and its time.
    """

    action: str
    goal: str
    result: str
    feedback: str
    action_goal: str

    def message(self, kind: str) -> Any:
        """Return a new message of a type."""
        return ROS1.message_class(kind)()


def action_types(action_class: Any) -> ActionTypes:
    """Return the types of a class such as `FibonacciAction`.

    Raises:
        ActionException: the class is not that of an action.
    """
    try:
        package, _, name = type_name_of(action_class).split("/")
    except ArgumentTypeError:
        name = ""
    if not name.endswith("Action"):
        raise ActionException(f"Type is not an action spec: {action_class}")
    action = f"{package}/action/{name.removesuffix('Action')}"
    return ActionTypes(action, f"{action}_Goal", f"{action}_Result", f"{action}_Feedback", f"{package}/msg/{name}Goal")
