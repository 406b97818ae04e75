"""Server of an action with one goal at a time."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from typing import Any

from simkit_nodes.interfaces import ROS1
from simkit_nodes.ros1_modules.actionlib.action_server import ActionServer
from simkit_nodes.ros1_modules.actionlib.server_goal_handle import ServerGoalHandle
from simkit_nodes.ros1_modules.rospy.log import logerr, logwarn
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node

__all__ = ["SimpleActionServer"]

_GoalStatus = ROS1.message_class("actionlib_msgs/msg/GoalStatus")
_REPLACED = "This goal was canceled because another goal was received by the simple action server"


class SimpleActionServer:
    """Server of an action that executes its newest goal; a new goal asks the present one to end.

    Args:
        name: name of the action.
        ActionSpec: class of the action, such as `FibonacciAction`.
        execute_cb: function of each goal message, called in a thread of its own; None for a program that accepts goals.
        auto_start: True to open the action at once.

    Attributes:
        action_server: server below.
        current_goal: handle of the goal that is executed.
        next_goal: handle of the newest goal.
        new_goal: True if the newest goal is not accepted yet.
        preempt_request: True if the present goal shall end.
    """

    def __init__(
        self, name: str, ActionSpec: object, execute_cb: Callable[[Any], object] | None = None, auto_start: bool = True
    ) -> None:
        self._node = ros_node()
        self.new_goal = self.preempt_request = self.new_goal_preempt_request = False
        self.execute_callback = execute_cb
        self.goal_callback: Callable[[], object] | None = None
        self.preempt_callback: Callable[[], object] | None = None
        self.current_goal, self.next_goal = ServerGoalHandle(), ServerGoalHandle()
        if execute_cb is not None:
            self._node.at_init(lambda: self._node.start_thread(self._execute, f"action {name}"))
        goal, preempt = self.internal_goal_callback, self.internal_preempt_callback
        self.action_server = ActionServer(name, ActionSpec, goal, preempt, auto_start)

    def start(self) -> None:
        """Open the action."""
        self.action_server.start()

    # ------------------------------------------------------------------ goals

    def accept_new_goal(self) -> Any:
        """Accept the newest goal and return its message; None without one."""
        if not self.new_goal or self.next_goal.get_goal() is None:
            logerr("Attempting to accept the next goal when a new goal is not available")
            return None
        if self.is_active() and self.current_goal != self.next_goal:
            self.current_goal.set_canceled(None, _REPLACED)
        self.current_goal, self.new_goal = self.next_goal, False
        self.preempt_request, self.new_goal_preempt_request = self.new_goal_preempt_request, False
        self.current_goal.set_accepted("This goal has been accepted by the simple action server")
        return self.current_goal.get_goal()

    def is_new_goal_available(self) -> bool:
        """Check whether a goal waits for `accept_new_goal`."""
        self._node.poll()
        return self.new_goal

    def is_preempt_requested(self) -> bool:
        """Check whether the present goal shall end."""
        self._node.poll()
        return self.preempt_request

    def is_active(self) -> bool:
        """Check whether a goal is executed."""
        if self.current_goal.get_goal() is None:
            return False
        return self.current_goal.get_goal_status().status in (_GoalStatus.ACTIVE, _GoalStatus.PREEMPTING)

    def set_succeeded(self, result: object = None, text: str = "") -> None:
        """End the goal as succeeded."""
        self.current_goal.set_succeeded(result or self.get_default_result(), text)

    def set_aborted(self, result: object = None, text: str = "") -> None:
        """End the goal as aborted."""
        self.current_goal.set_aborted(result or self.get_default_result(), text)

    def set_preempted(self, result: object = None, text: str = "") -> None:
        """End the goal as cancelled."""
        self.current_goal.set_canceled(result or self.get_default_result(), text)

    def publish_feedback(self, feedback: object) -> None:
        """Send feedback of the present goal."""
        self._node.poll()
        self.current_goal.publish_feedback(feedback)

    def get_default_result(self) -> Any:
        """Return a result with default values."""
        return self.action_server.ActionResultType()

    # ------------------------------------------------------------------ functions of the program

    def register_goal_callback(self, cb: Callable[[], object]) -> None:
        """Set a function that is called when a goal has arrived."""
        if self.execute_callback is not None:
            logwarn(
                "Cannot call SimpleActionServer.register_goal_callback() because an executeCallback exists. "
                "Not going to register it."
            )
        else:
            self.goal_callback = cb

    def register_preempt_callback(self, cb: Callable[[], object]) -> None:
        """Set a function that is called when the present goal shall end."""
        self.preempt_callback = cb

    def internal_goal_callback(self, goal: ServerGoalHandle) -> None:
        """Receive a goal."""
        if self.new_goal and self.next_goal != self.current_goal:
            self.next_goal.set_canceled(None, _REPLACED)
        self.next_goal, self.new_goal, self.new_goal_preempt_request = goal, True, False
        if self.is_active():
            self.preempt_request = True
            if self.preempt_callback is not None:
                self.preempt_callback()
        if self.goal_callback is not None:
            self.goal_callback()
        self._node.host.wake()

    def internal_preempt_callback(self, preempt: ServerGoalHandle) -> None:
        """Receive a cancel request."""
        if preempt == self.current_goal:
            self.preempt_request = True
            if self.preempt_callback is not None:
                self.preempt_callback()
        elif preempt == self.next_goal:
            self.new_goal_preempt_request = True
        self._node.host.wake()

    def _execute(self) -> None:
        """Call the function of the program with each goal; the function of the thread."""
        while not self._node.is_shutdown:
            if not self.new_goal:
                self._node.wait(None, lambda: self.new_goal)
                continue
            goal = self.accept_new_goal()
            try:
                if self.execute_callback is not None:
                    self.execute_callback(goal)
            except Exception as error:  # noqa: BLE001 - as in actionlib, the goal is aborted and the server goes on
                logerr("Exception in your execute callback: %s\n%s", error, traceback.format_exc())
                self.set_aborted(None, f"Exception in execute callback: {error}")
            if self.is_active() and not self._node.is_shutdown:
                logwarn(
                    "Your executeCallback did not set the goal to a terminal status.  This is a bug in your "
                    "ActionServer implementation. Fix your code!  For now, the ActionServer will set this goal to "
                    "aborted"
                )
                self.set_aborted(None, "No terminal state was set.")
