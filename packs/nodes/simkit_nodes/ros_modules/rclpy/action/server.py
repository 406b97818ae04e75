"""Action servers."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from enum import Enum
from typing import TYPE_CHECKING, Any, Final

from simkit_nodes.host import current_host
from simkit_nodes.interfaces import ROS2, ProgramMessage, interface_module, type_name_of
from simkit_nodes.ros_modules.rclpy.executors import await_or_execute
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import Handle, RCLError
from simkit_nodes.ros_modules.rclpy.qos import (
    QoSProfile,
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from simkit_nodes.ros_modules.rclpy.waitable import Waitable

if TYPE_CHECKING:
    from simkit_nodes.graph_actions import GraphCancel, GraphGoal
    from simkit_nodes.ros_modules.rclpy.callback_groups import CallbackGroup

__all__ = [
    "ActionServer",
    "CancelResponse",
    "GoalEvent",
    "GoalInfo",
    "GoalResponse",
    "GoalStatus",
    "RCLError",
    "ServerGoalHandle",
    "default_cancel_callback",
    "default_goal_callback",
    "default_handle_accepted_callback",
]

_action_messages: Any = interface_module("action_msgs.msg", ROS2)
_UUID = ROS2.message_class("unique_identifier_msgs/msg/UUID")
GoalInfo: Any = _action_messages.GoalInfo
GoalStatus: Any = _action_messages.GoalStatus


class GoalResponse(Enum):
    """Decision about a new goal."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """Decision about a cancel request."""

    REJECT = 1
    ACCEPT = 2


class GoalEvent(Enum):
    """Event that changes the status of a goal."""

    EXECUTE = 1
    CANCEL_GOAL = 2
    SUCCEED = 3
    ABORT = 4
    CANCELED = 5


_NAMES: Final = ("UNKNOWN", "ACCEPTED", "EXECUTING", "CANCELING", "SUCCEEDED", "CANCELED", "ABORTED")
_ACTIVE: Final = (1, 2, 3)
_TRANSITIONS: Final = {
    GoalEvent.EXECUTE: ((1,), 2),
    GoalEvent.CANCEL_GOAL: ((1, 2), 3),
    GoalEvent.SUCCEED: ((2, 3), 4),
    GoalEvent.CANCELED: ((3,), 5),
    GoalEvent.ABORT: ((2, 3), 6),
}
"""Statuses before, and status after an event; the numbers of `action_msgs/msg/GoalStatus`."""


class ServerGoalHandle:
    """Goal of an action server.

    Args:
        action_server: action server.
        goal_info: message `GoalInfo` with the identifier and the time of the acceptance.
        goal_request: goal message.
        goal: goal of the graph.
    """

    def __init__(self, action_server: ActionServer, goal_info: Any, goal_request: Any, goal: GraphGoal) -> None:
        self._action_server, self._goal_info, self._goal_request = action_server, goal_info, goal_request
        self._goal = goal
        self._status = 1
        self._is_destroyed = False

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ServerGoalHandle) and bool(self.goal_id == other.goal_id)

    __hash__ = None  # type: ignore[assignment]  # as in rclpy

    @property
    def request(self) -> Any:
        """Goal message."""
        return self._goal_request

    @property
    def goal_id(self) -> Any:
        """Identifier of the goal, a message `UUID`."""
        return self._goal_info.goal_id

    @property
    def is_active(self) -> bool:
        """True while the goal has no final status."""
        current_host().poll()
        return not self._is_destroyed and self._status in _ACTIVE

    @property
    def is_cancel_requested(self) -> bool:
        """True after a cancel request was accepted, until the goal has a final status."""
        current_host().poll()
        return bool(self.status == GoalStatus.STATUS_CANCELING)

    @property
    def status(self) -> int:
        """Status, a number of `GoalStatus`."""
        return 0 if self._is_destroyed else self._status

    def _update_state(self, event: GoalEvent) -> None:
        """Change the status.

        Raises:
            RCLError: the event is not possible in the present status.
        """
        if self._is_destroyed:
            return
        before, after = _TRANSITIONS[event]
        if self._status not in before:
            state = _NAMES[self._status]
            raise RCLError(
                "Failed to update goal state: goal_handle attempted invalid transition from state "
                f"{state} with event {event.name}"
            )
        self._status = after

    def execute(self, execute_callback: Callable[[Any], object] | None = None) -> None:
        """Begin the execution with a callback, or with that of the action server."""
        if self._status != GoalStatus.STATUS_CANCELING:  # then the callback itself cancels the goal
            self._update_state(GoalEvent.EXECUTE)
        self._action_server.notify_execute(self, execute_callback)

    def publish_feedback(self, feedback: ProgramMessage) -> None:
        """Send feedback to the client.

        Raises:
            TypeError: the message is not feedback of this action.
        """
        if not isinstance(feedback, self._action_server.action_type.Feedback):
            raise TypeError
        if not self._is_destroyed:
            self._goal.publish_feedback(self._action_server._feedback_to_simkit(feedback))

    def succeed(self) -> None:
        """Give the goal the status SUCCEEDED; the client learns of it with the result."""
        self._update_state(GoalEvent.SUCCEED)

    def abort(self) -> None:
        """Give the goal the status ABORTED."""
        self._update_state(GoalEvent.ABORT)

    def canceled(self) -> None:
        """Give the goal the status CANCELED; its cancellation must have been requested."""
        self._update_state(GoalEvent.CANCELED)

    def destroy(self) -> None:
        """Forget the goal."""
        self._is_destroyed = True


def default_handle_accepted_callback(goal_handle: ServerGoalHandle) -> None:
    """Execute the goal."""
    goal_handle.execute()


def default_goal_callback(goal_request: Any) -> GoalResponse:
    """Accept every goal."""
    return GoalResponse.ACCEPT


def default_cancel_callback(cancel_request: Any) -> CancelResponse:
    """Reject every cancel request."""
    return CancelResponse.REJECT


class ActionServer(Waitable):
    """Action of a node.

    Args:
        node: node.
        action_type: class of the action.
        action_name: name of the action.
        execute_callback: function or coroutine function that receives a `ServerGoalHandle` and returns the result.
        callback_group: callback group; None for the default one of the node.
        goal_callback: function that receives a goal message and returns a `GoalResponse`.
        handle_accepted_callback: function that receives a `ServerGoalHandle` after its acceptance.
        cancel_callback: function that receives a `ServerGoalHandle` and returns a `CancelResponse`.
        goal_service_qos_profile: has no effect, like the other profiles.
        result_timeout: time for which a result is kept [s].
    """

    def __init__(
        self,
        node: Any,
        action_type: Any,
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle], object],
        *,
        callback_group: CallbackGroup | None = None,
        goal_callback: Callable[[Any], object] | None = default_goal_callback,
        handle_accepted_callback: Callable[[ServerGoalHandle], object] | None = default_handle_accepted_callback,
        cancel_callback: Callable[[Any], object] | None = default_cancel_callback,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_pub_qos_profile: QoSProfile | None = None,
        status_pub_qos_profile: QoSProfile = qos_profile_action_status_default,
        result_timeout: float = 900,
    ) -> None:
        super().__init__(node.default_callback_group if callback_group is None else callback_group)
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_goal_callback(goal_callback)
        self.register_cancel_callback(cancel_callback)
        self.register_execute_callback(execute_callback)
        self._node, self._action_type, self._handle = node, action_type, Handle()
        type_name = type_name_of(action_type)
        self._goal_to_program = ROS2.to_program(f"{type_name}_Goal")
        self._feedback_to_simkit = ROS2.to_simkit(f"{type_name}_Feedback")
        self._result_to_simkit = ROS2.to_simkit(f"{type_name}_Result")
        self._goal_handles: dict[bytes, ServerGoalHandle] = {}
        self._server = node._open_action_server(action_name, type_name, int(result_timeout * 1e9))
        node.add_waitable(self)
        self._logger = node.get_logger().get_child("action_server")

    @property
    def action_type(self) -> Any:
        """Class of the action."""
        return self._action_type

    # ------------------------------------------------------------------ for the executor

    def is_ready(self, wait_set: Any) -> bool:
        """Check whether a goal or a cancel request waits."""
        return bool(self._server.has_request)

    def take_data(self) -> tuple[GraphGoal | None, GraphCancel | None]:
        """Return the oldest goal and the oldest cancel request that wait."""
        return self._server.take_goal(), self._server.take_cancel()

    async def execute(self, taken_data: tuple[GraphGoal | None, GraphCancel | None]) -> None:
        """Decide about a goal and a cancel request."""
        goal, cancel = taken_data
        if goal is not None:
            await self._decide_about_goal(goal)
        if cancel is not None:
            await self._decide_about_cancel(cancel)

    async def _decide_about_goal(self, goal: GraphGoal) -> None:
        request = self._goal_to_program(goal.request)
        is_accepted = False
        if goal.id not in self._goal_handles:
            response = await await_or_execute(self._goal_callback, request)
            is_accepted = response is GoalResponse.ACCEPT
            if not isinstance(response, GoalResponse):
                self._logger.warning("Goal request callback did not return a GoalResponse type. Rejecting goal.")
        if not is_accepted:
            goal.reject()
            return
        info = GoalInfo(goal_id=_UUID(uuid=list(goal.id)))
        info.stamp = self._node.get_clock().now().to_msg()
        handle = self._goal_handles[goal.id] = ServerGoalHandle(self, info, request, goal)
        goal.accept()
        await await_or_execute(self._handle_accepted_callback, handle)

    async def _decide_about_cancel(self, cancel: GraphCancel) -> None:
        handle = self._goal_handles.get(cancel.id)
        if handle is None or not handle.is_active:
            cancel.reject()
            return
        response = await await_or_execute(self._cancel_callback, handle)
        try:
            if response is CancelResponse.ACCEPT:
                handle._update_state(GoalEvent.CANCEL_GOAL)
        except RCLError:  # the goal has ended during the callback
            response = CancelResponse.REJECT
        if response is CancelResponse.ACCEPT:
            cancel.accept()
        else:
            cancel.reject()

    async def _execute_goal(self, execute_callback: Callable[[Any], object], goal_handle: ServerGoalHandle) -> None:
        uuid = goal_handle.goal_id.uuid
        try:
            result = await await_or_execute(execute_callback, goal_handle)
        except Exception as error:  # noqa: BLE001 - a program may raise anything
            result = self._action_type.Result()
            self._logger.error(f"Error raised in execute callback: {error}")
            traceback.print_exc()
        if goal_handle.is_active:
            self._logger.warning(f"Goal state not set, assuming aborted. Goal ID: {uuid}")
            goal_handle.abort()
        response = self._action_type.Impl.GetResultService.Response(status=goal_handle.status)
        response.result = result  # raises with rclpy's text if the callback has returned something else
        self._goal_handles.pop(bytes(uuid), None)
        goal_handle._goal.end(goal_handle.status, self._result_to_simkit(response.result))

    # ------------------------------------------------------------------ for the program

    def notify_execute(self, goal_handle: ServerGoalHandle, execute_callback: Callable[[Any], object] | None) -> None:
        """Have the executor of the node call the callback."""
        callback = self._execute_callback if execute_callback is None else execute_callback
        self._node.executor.create_task(self._execute_goal, callback, goal_handle)

    def notify_goal_done(self) -> None:
        """Do nothing: the end of a goal is known."""

    def register_handle_accepted_callback(self, handle_accepted_callback: Callable[[Any], object] | None) -> None:
        """Replace the callback for accepted goals; None for the default, which executes them."""
        self._handle_accepted_callback = handle_accepted_callback or default_handle_accepted_callback

    def register_goal_callback(self, goal_callback: Callable[[Any], object] | None) -> None:
        """Replace the callback that decides about goals; None for the default, which accepts them."""
        self._goal_callback = goal_callback or default_goal_callback

    def register_cancel_callback(self, cancel_callback: Callable[[Any], object] | None) -> None:
        """Replace the callback that decides about cancel requests; None for the default, which rejects them."""
        self._cancel_callback = cancel_callback or default_cancel_callback

    def register_execute_callback(self, execute_callback: Callable[[Any], object]) -> None:
        """Replace the callback that executes goals.

        Raises:
            TypeError: it cannot be called.
        """
        if not callable(execute_callback):
            raise TypeError("Failed to register goal execution callback: not callable")
        self._execute_callback = execute_callback

    def destroy(self) -> None:
        """Destroy the action server; its goals are aborted."""
        for goal_handle in self._goal_handles.values():
            goal_handle.destroy()
        self._handle.destroy()
        self._server.close()
        self._node.remove_waitable(self)
