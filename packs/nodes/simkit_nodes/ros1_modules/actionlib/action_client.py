"""Clients of actions. A thread of each client calls the functions of the program."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from simkit_nodes.interfaces import ROS1, ProgramMessage
from simkit_nodes.ros1_modules.actionlib.action_types import (
    CommState,
    TerminalState,
    action_types,
    get_name_of_constant,
)
from simkit_nodes.ros1_modules.actionlib.goal_id_generator import GoalIDGenerator
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node
from simkit_nodes.ros1_modules.rospy.rostime import Duration, nanoseconds

if TYPE_CHECKING:
    from simkit_nodes.graph_actions import GraphActionClient, GraphClientGoal

__all__ = ["ActionClient", "ClientGoalHandle", "CommState", "TerminalState", "get_name_of_constant"]

_GoalStatus = ROS1.message_class("actionlib_msgs/msg/GoalStatus")
_FINAL: Final = {4: _GoalStatus.SUCCEEDED, 5: _GoalStatus.PREEMPTED, 6: _GoalStatus.ABORTED}
"""Final states of ROS 1 by those of `action_msgs/msg/GoalStatus`."""

_FOREVER: Final = Duration()


def _ignore(code: int, is_cancelled: bool) -> None:
    """Do nothing with the response to a cancel request: actionlib's client follows the status."""


class ClientGoalHandle:
    """Goal that a client has sent.

    Attributes:
        goal_id: identifier and time of the goal.
    """

    def __init__(
        self,
        goal_id: Any,
        on_transition: Callable[[ClientGoalHandle], object] | None,
        on_feedback: Callable[[ClientGoalHandle, Any], object] | None,
    ) -> None:
        self.goal_id = goal_id
        self._on_transition, self._on_feedback = on_transition, on_feedback
        self._state, self._status = CommState.WAITING_FOR_GOAL_ACK, _GoalStatus.PENDING
        self._result: Any = None
        self._sent: GraphClientGoal | None = None

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ClientGoalHandle) and self.goal_id.id == other.goal_id.id

    def __hash__(self) -> int:
        return hash(self.goal_id.id)

    def send(self, sent: GraphClientGoal) -> None:
        """Store the goal of the communication graph."""
        self._sent = sent

    def cancel(self) -> None:
        """Request the cancellation of the goal."""
        if self._sent is not None and self._state != CommState.DONE:
            self._sent.cancel(_ignore)
            if self._state == CommState.ACTIVE:
                self._state, self._status = CommState.WAITING_FOR_CANCEL_ACK, _GoalStatus.PREEMPTING

    def get_comm_state(self) -> int:
        """Return the state, a number of `CommState`."""
        return self._state

    def get_goal_status(self) -> int:
        """Return the status, a number of `actionlib_msgs/GoalStatus`."""
        return int(self._status)

    def get_goal_status_text(self) -> str:
        """Return the text that the server gave for the status."""
        return "" if self._sent is None else self._sent.reason

    def get_result(self) -> Any:
        """Return the result; None before the end."""
        return self._result

    def get_terminal_state(self) -> int:
        """Return the final status; `LOST` before the end."""
        return int(self._status) if self._state == CommState.DONE else TerminalState.LOST

    # ------------------------------------------------------------------ changes, called by the client's thread

    def begin(self, is_accepted: bool) -> None:
        """Receive the decision of the server."""
        if is_accepted:
            self._status = _GoalStatus.ACTIVE
            self._move(CommState.ACTIVE)
        else:
            self.end(_GoalStatus.REJECTED, None)

    def receive_feedback(self, feedback: ProgramMessage) -> None:
        """Receive feedback."""
        if self._on_feedback is not None:
            self._on_feedback(self, feedback)

    def end(self, status: int, result: Any) -> None:
        """Receive the end."""
        self._status, self._result = status, result
        self._move(CommState.WAITING_FOR_RESULT)
        self._move(CommState.DONE)

    def _move(self, state: int) -> None:
        self._state = state
        if self._on_transition is not None:
            self._on_transition(self)


class ActionClient:
    """Client of an action.

    Args:
        ns: name of the action.
        ActionSpec: class of the action, such as `FibonacciAction`.

    Attributes:
        ns: name of the action.
        action_types: types of the action.
    """

    def __init__(self, ns: str, ActionSpec: Any) -> None:
        self.ns, self.action_types = ns, action_types(ActionSpec)
        self._node = ros_node()
        self._name = self._node.resolve_endpoint(ns)
        self._ids = GoalIDGenerator()
        self._events: deque[Callable[[], None]] = deque()
        self._goals: list[ClientGoalHandle] = []
        self._client: GraphActionClient | None = None
        self._is_stopped = False
        self._node.at_init(self._open)

    def _open(self) -> None:
        self._client = self._node.graph_node.action_client(self._name, self.action_types.action)
        self._node.start_thread(self._run, f"action client {self._name}")

    def _run(self) -> None:
        """Call the functions of the program; the function of the thread."""
        while not self._is_stopped and not self._node.is_shutdown:
            if self._events:
                self._events.popleft()()
            else:
                self._node.wait(None, lambda: self._is_stopped or bool(self._events))

    def stop(self) -> None:
        """Close the client."""
        self._is_stopped = True
        if self._client is not None:
            self._client.close()

    def wait_for_server(self, timeout: Any = _FOREVER) -> bool:
        """Wait until the action exists.

        Args:
            timeout: longest wait; zero for no limit.

        Returns:
            True if it exists.
        """
        limit = nanoseconds(timeout)
        self._node.wait(self._node.host.now_ns() + limit if limit > 0 else None, self._is_ready)
        return self._is_ready()

    wait_for_action_server_to_start = wait_for_server

    def _is_ready(self) -> bool:
        return self._client is not None and self._client.is_ready

    def send_goal(
        self,
        goal: ProgramMessage,
        transition_cb: Callable[[ClientGoalHandle], object] | None = None,
        feedback_cb: Callable[[ClientGoalHandle, Any], object] | None = None,
    ) -> ClientGoalHandle:
        """Send a goal.

        Args:
            goal: goal message.
            transition_cb: function of the handle, called at each change of its state.
            feedback_cb: function of the handle and each feedback message.
        """
        handle = ClientGoalHandle(self._ids.generate_ID(), transition_cb, feedback_cb)
        self._goals = [other for other in self._goals if other.get_comm_state() != CommState.DONE] + [handle]
        if self._client is None:
            return handle
        types = self.action_types

        def on_feedback(message: ProgramMessage) -> None:
            self._store(lambda: handle.receive_feedback(ROS1.to_program(types.feedback)(message)))

        def on_accept(is_accepted: bool, time_ns: int) -> None:
            self._store(lambda: handle.begin(is_accepted))

        def on_result(status: int, message: ProgramMessage) -> None:
            self._store(lambda: handle.end(_FINAL[status], ROS1.to_program(types.result)(message)))

        message = ROS1.to_simkit(types.goal)(goal)
        handle.send(self._client.send(message, self._client.new_goal_id(), on_feedback, on_accept, on_result))
        return handle

    def _store(self, event: Callable[[], None]) -> None:
        self._events.append(event)
        self._node.host.wake()

    def cancel_all_goals(self) -> None:
        """Request the cancellation of all goals of this client."""
        for handle in self._goals:
            handle.cancel()

    def cancel_goals_at_and_before_time(self, time: Any) -> None:
        """Request the cancellation of the goals of this client that were sent at a time or before it."""
        for handle in self._goals:
            if handle.goal_id.stamp <= time:
                handle.cancel()
