"""Goals that a server of an action has received."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from simkit_nodes.interfaces import ROS1
from simkit_nodes.ros1_modules.rospy.log import logerr
from simkit_nodes.ros1_modules.rospy.rostime import Time

if TYPE_CHECKING:
    from simkit_nodes.graph_actions import GraphGoal
    from simkit_nodes.ros1_modules.actionlib.action_types import ActionTypes

__all__ = ["ServerGoalHandle"]

_GoalStatus = ROS1.message_class("actionlib_msgs/msg/GoalStatus")
_FINAL: Final = {_GoalStatus.SUCCEEDED: 4, _GoalStatus.PREEMPTED: 5, _GoalStatus.RECALLED: 5, _GoalStatus.ABORTED: 6}
"""Final states of `action_msgs/msg/GoalStatus` by those of ROS 1."""

_CANCELLED: Final = {
    _GoalStatus.PENDING: _GoalStatus.RECALLED,
    _GoalStatus.RECALLING: _GoalStatus.RECALLED,
    _GoalStatus.ACTIVE: _GoalStatus.PREEMPTED,
    _GoalStatus.PREEMPTING: _GoalStatus.PREEMPTED,
}
_RUNNING: Final = (_GoalStatus.ACTIVE, _GoalStatus.PREEMPTING)


class ServerGoalHandle:
    """Goal of an action server.

    Args:
        types: types of the action; None for a handle without a goal.
        received: goal of the communication graph; None for a handle without a goal.
        now: time of the goal.
    """

    def __init__(
        self, types: ActionTypes | None = None, received: GraphGoal | None = None, now: Time | None = None
    ) -> None:
        self._types, self._received = types, received
        self._status: Any = _GoalStatus()
        self._goal: Any = None
        if types is not None and received is not None:
            self._goal = ROS1.to_program(types.goal)(received.request)
            self._status.goal_id.id, self._status.goal_id.stamp = received.id.hex(), now

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ServerGoalHandle) or self._goal is None or other._goal is None:
            return False
        return bool(self._status.goal_id.id == other._status.goal_id.id)

    def __hash__(self) -> int:
        return hash(self._status.goal_id.id)

    def get_default_result(self) -> Any:
        """Return a result with default values."""
        return None if self._types is None else self._types.message(self._types.result)

    @property
    def goal(self) -> Any:
        """Message such as `FibonacciActionGoal`, with the goal and its identifier; None for a handle without a goal."""
        if self._types is None:
            return None
        message = self._types.message(self._types.action_goal)
        message.goal_id, message.goal = self._status.goal_id, self._goal
        return message

    def get_goal(self) -> Any:
        """Return the goal message; None for a handle without a goal."""
        return self._goal

    def get_goal_id(self) -> Any:
        """Return the identifier and the time of the goal."""
        return self._status.goal_id

    def get_goal_status(self) -> Any:
        """Return the status, an `actionlib_msgs.msg.GoalStatus`."""
        return self._status

    def set_accepted(self, text: str = "") -> None:
        """Accept the goal."""
        if self._received is None or self._status.status not in (_GoalStatus.PENDING, _GoalStatus.RECALLING):
            self._refuse("active", "pending or recalling")
            return
        is_pending = self._status.status == _GoalStatus.PENDING
        self._status.status, self._status.text = _GoalStatus.ACTIVE if is_pending else _GoalStatus.PREEMPTING, text
        self._received.accept()

    def set_canceled(self, result: object = None, text: str = "") -> None:
        """End the goal as cancelled."""
        if self._status.status not in _CANCELLED:
            self._refuse("canceled", "pending, recalling, active or preempting")
            return
        self._end(_CANCELLED[self._status.status], result, text)

    def set_rejected(self, result: object = None, text: str = "") -> None:
        """Reject the goal."""
        if self._received is None or self._status.status not in (_GoalStatus.PENDING, _GoalStatus.RECALLING):
            self._refuse("rejected", "pending or recalling")
            return
        self._status.status, self._status.text = _GoalStatus.REJECTED, text
        self._received.reject(text)

    def set_aborted(self, result: object = None, text: str = "") -> None:
        """End the goal as aborted."""
        if self._status.status not in _RUNNING:
            self._refuse("aborted", "active or preempting")
            return
        self._end(_GoalStatus.ABORTED, result, text)

    def set_succeeded(self, result: object = None, text: str = "") -> None:
        """End the goal as succeeded."""
        if self._status.status not in _RUNNING:
            self._refuse("succeeded", "active or preempting")
            return
        self._end(_GoalStatus.SUCCEEDED, result, text)

    def _end(self, status: int, result: object, text: str) -> None:
        if self._received is None or self._types is None:
            self._refuse("ended", "received")
            return
        self._status.status, self._status.text = status, text
        message = ROS1.to_simkit(self._types.result)(result or self.get_default_result())
        self._received.end(_FINAL[status], message, text)

    @staticmethod
    def _refuse(what: str, states: str) -> None:
        logerr("To transition to a %s state, the goal must be in a %s state", what, states)

    def publish_feedback(self, feedback: object) -> None:
        """Send feedback."""
        if self._received is None or self._types is None:
            logerr("Attempt to publish feedback on an uninitialized ServerGoalHandle")
            return
        self._received.publish_feedback(ROS1.to_simkit(self._types.feedback)(feedback))

    def set_cancel_requested(self) -> bool:
        """Store that the client has requested the cancellation; return False if the goal has ended."""
        waiting = {_GoalStatus.PENDING: _GoalStatus.RECALLING, _GoalStatus.ACTIVE: _GoalStatus.PREEMPTING}
        if self._status.status not in waiting:
            return False
        self._status.status = waiting[self._status.status]
        return True
