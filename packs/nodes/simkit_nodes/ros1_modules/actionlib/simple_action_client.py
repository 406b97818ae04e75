"""Client of an action with one goal at a time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from simkit_nodes.interfaces import ROS1
from simkit_nodes.ros1_modules.actionlib.action_client import ActionClient, ClientGoalHandle
from simkit_nodes.ros1_modules.actionlib.action_types import CommState, SimpleGoalState
from simkit_nodes.ros1_modules.rospy.log import logdebug, logerr
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node
from simkit_nodes.ros1_modules.rospy.rostime import Duration, nanoseconds

__all__ = ["SimpleActionClient", "SimpleGoalState"]

_GoalStatus = ROS1.message_class("actionlib_msgs/msg/GoalStatus")
_FOREVER: Final = Duration()


class SimpleActionClient:
    """Client of an action that follows the last goal it has sent.

    Args:
        ns: name of the action.
        ActionSpec: class of the action, such as `FibonacciAction`.

    Attributes:
        action_client: client below.
        simple_state: state of the goal, a number of `SimpleGoalState`.
        gh: handle of the goal; None without a goal.
    """

    def __init__(self, ns: str, ActionSpec: object) -> None:
        self._node = ros_node()
        self.action_client = ActionClient(ns, ActionSpec)
        self.simple_state = SimpleGoalState.DONE
        self.gh: ClientGoalHandle | None = None
        self.done_cb: Callable[[int, Any], object] | None = None
        self.active_cb: Callable[[], object] | None = None
        self.feedback_cb: Callable[[Any], object] | None = None

    def wait_for_server(self, timeout: object = _FOREVER) -> bool:
        """Wait until the action exists; a timeout of zero is no limit. Return True if it exists."""
        return self.action_client.wait_for_server(timeout)

    def send_goal(
        self,
        goal: object,
        done_cb: Callable[[int, Any], object] | None = None,
        active_cb: Callable[[], object] | None = None,
        feedback_cb: Callable[[Any], object] | None = None,
    ) -> None:
        """Send a goal; the goal before is not followed any more.

        Args:
            goal: goal message.
            done_cb: function of the final status and the result.
            active_cb: function that is called when the server has accepted the goal.
            feedback_cb: function of each feedback message.
        """
        self.stop_tracking_goal()
        self.done_cb, self.active_cb, self.feedback_cb = done_cb, active_cb, feedback_cb
        self.simple_state = SimpleGoalState.PENDING
        self.gh = self.action_client.send_goal(goal, self._handle_transition, self._handle_feedback)

    def send_goal_and_wait(
        self, goal: object, execute_timeout: object = _FOREVER, preempt_timeout: object = _FOREVER
    ) -> int:
        """Send a goal, wait for its end, and return its state.

        Args:
            goal: goal message.
            execute_timeout: longest wait, after which the goal is cancelled; zero for no limit.
            preempt_timeout: longest wait for the end after that; zero for no limit.
        """
        self.send_goal(goal)
        if not self.wait_for_result(execute_timeout):
            logdebug("Canceling goal")
            self.cancel_goal()
            self.wait_for_result(preempt_timeout)
        return self.get_state()

    def wait_for_result(self, timeout: object = _FOREVER) -> bool:
        """Wait for the end of the goal; a timeout of zero is no limit. Return True if it has ended."""
        if self.gh is None:
            logerr("Called wait_for_result when no goal exists")
            return False
        limit = nanoseconds(timeout)
        until = self._node.host.now_ns() + limit if limit > 0 else None
        self._node.wait(until, lambda: self.simple_state == SimpleGoalState.DONE)
        return self.simple_state == SimpleGoalState.DONE

    def get_result(self) -> Any:
        """Return the result of the goal; None before its end."""
        if self.gh is None:
            logerr("Called get_result when no goal is running")
            return None
        return self.gh.get_result()

    def get_state(self) -> int:
        """Return the status of the goal, a number of `actionlib_msgs/GoalStatus`; `LOST` without a goal."""
        self._node.poll()
        if self.gh is None:
            return int(_GoalStatus.LOST)
        status = self.gh.get_goal_status()
        return int(_GoalStatus.ACTIVE) if status == _GoalStatus.PREEMPTING else status

    def get_goal_status_text(self) -> str:
        """Return the text that the server gave for the status."""
        if self.gh is None:
            logerr("Called get_goal_status_text when no goal is running")
            return "ERROR: Called get_goal_status_text when no goal is running"
        return self.gh.get_goal_status_text()

    def cancel_all_goals(self) -> None:
        """Request the cancellation of all goals of this client."""
        self.action_client.cancel_all_goals()

    def cancel_goals_at_and_before_time(self, time: object) -> None:
        """Request the cancellation of the goals of this client that were sent at a time or before it."""
        self.action_client.cancel_goals_at_and_before_time(time)

    def cancel_goal(self) -> None:
        """Request the cancellation of the goal."""
        if self.gh is not None:
            self.gh.cancel()

    def stop_tracking_goal(self) -> None:
        """Do not follow the goal any more; it goes on."""
        self.gh = None

    def _handle_transition(self, handle: ClientGoalHandle) -> None:
        if handle != self.gh:
            return
        state = handle.get_comm_state()
        if state == CommState.ACTIVE and self.simple_state == SimpleGoalState.PENDING:
            self.simple_state = SimpleGoalState.ACTIVE
            if self.active_cb is not None:
                self.active_cb()
        elif state == CommState.DONE and self.simple_state != SimpleGoalState.DONE:
            if self.done_cb is not None:
                self.done_cb(handle.get_goal_status(), handle.get_result())
            if handle == self.gh:  # the function may have sent another goal
                self.simple_state = SimpleGoalState.DONE
                self._node.host.wake()

    def _handle_feedback(self, handle: ClientGoalHandle, feedback: object) -> None:
        if handle == self.gh and self.feedback_cb is not None:
            self.feedback_cb(feedback)
