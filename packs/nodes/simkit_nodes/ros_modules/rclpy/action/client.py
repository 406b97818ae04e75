"""Action clients."""

from __future__ import annotations

import inspect
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from simkit_nodes.host import current_host
from simkit_nodes.interfaces import ROS2, ProgramMessage, interface_module, type_name_of
from simkit_nodes.ros_modules.rclpy.client import wait_for_result, wait_until
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import Handle
from simkit_nodes.ros_modules.rclpy.qos import (
    QoSProfile,
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from simkit_nodes.ros_modules.rclpy.task import Future
from simkit_nodes.ros_modules.rclpy.waitable import Waitable

if TYPE_CHECKING:
    from simkit_nodes.graph_actions import GraphClientGoal
    from simkit_nodes.ros_modules.rclpy.callback_groups import CallbackGroup

__all__ = ["UUID", "ActionClient", "CancelGoal", "ClientGoalHandle", "Future", "GoalStatus"]

_action_messages: Any = interface_module("action_msgs.msg", ROS2)
_times: Any = interface_module("builtin_interfaces.msg", ROS2)
UUID = ROS2.message_class("unique_identifier_msgs/msg/UUID")
GoalStatus: Any = _action_messages.GoalStatus
_action_services: Any = interface_module("action_msgs.srv", ROS2)
CancelGoal: Any = _action_services.CancelGoal


class SentGoal:
    """Goal, and what waits for its result.

    Attributes:
        goal: goal of the graph.
        futures: futures that wait for the result.
        response: status and result; None before.
    """

    goal: GraphClientGoal

    def __init__(self) -> None:
        self.futures: list[Future] = []
        self.response: Any = None


class ClientGoalHandle:
    """Goal that an action client has sent.

    Args:
        action_client: action client.
        goal_id: message `UUID`.
        goal_response: response of the action: whether it accepts the goal, and when.
        sent: goal as it was sent.
    """

    def __init__(self, action_client: ActionClient, goal_id: Any, goal_response: Any, sent: SentGoal) -> None:
        self._action_client, self._goal_id, self._goal_response = action_client, goal_id, goal_response
        self._sent = sent

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ClientGoalHandle) and bool(self._goal_id == other._goal_id)

    __hash__ = None  # type: ignore[assignment]  # as in rclpy

    def __repr__(self) -> str:
        return f"ClientGoalHandle <id={self.goal_id.uuid}, accepted={self.accepted}, status={self.status}>"

    @property
    def goal_id(self) -> Any:
        """Identifier of the goal, a message `UUID`."""
        return self._goal_id

    @property
    def stamp(self) -> Any:
        """Time of the acceptance, a message `Time`."""
        return self._goal_response.stamp

    @property
    def accepted(self) -> bool:
        """True if the action has accepted the goal."""
        return bool(self._goal_response.accepted)

    @property
    def status(self) -> int:
        """Status, a number of `GoalStatus`."""
        current_host().poll()
        return self._sent.goal.status

    def cancel_goal(self) -> Any:
        """Request the cancellation and wait for the response, while another thread spins."""
        return self._action_client._wait_for(self.cancel_goal_async(), "cancel_goal()")

    def cancel_goal_async(self) -> Future:
        """Request the cancellation and return a future for the response of `CancelGoal`."""
        return self._action_client._cancel_goal_async(self)

    def get_result(self) -> Any:
        """Wait for the end of the goal, while another thread spins, and return status and result."""
        return self._action_client._wait_for(self.get_result_async(), "get_result()")

    def get_result_async(self) -> Future:
        """Return a future for status and result."""
        return self._action_client._get_result_async(self)


class ActionClient(Waitable):
    """Client of an action.

    Args:
        node: node.
        action_type: class of the action.
        action_name: name of the action.
        callback_group: callback group; None for the default one of the node.
        goal_service_qos_profile: has no effect, like the other profiles.
    """

    def __init__(
        self,
        node: Any,
        action_type: Any,
        action_name: str,
        *,
        callback_group: CallbackGroup | None = None,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_sub_qos_profile: QoSProfile | None = None,
        status_sub_qos_profile: QoSProfile = qos_profile_action_status_default,
    ) -> None:
        super().__init__(node.default_callback_group if callback_group is None else callback_group)
        self._node, self._action_type, self._action_name = node, action_type, action_name
        self._handle = Handle()
        type_name = type_name_of(action_type)
        self._goal_to_simkit = ROS2.to_simkit(f"{type_name}_Goal")
        self._feedback_to_program = ROS2.to_program(f"{type_name}_Feedback")
        self._result_to_program = ROS2.to_program(f"{type_name}_Result")
        self._arrivals: deque[Callable[[], object]] = deque()
        self._client = node._open_action_client(action_name, type_name)
        node.add_waitable(self)

    # ------------------------------------------------------------------ for the executor

    def is_ready(self, wait_set: Any) -> bool:
        """Check whether a response, feedback or a result has arrived."""
        return bool(self._arrivals)

    def take_data(self) -> Callable[[], object] | None:
        """Return the oldest arrival."""
        return self._arrivals.popleft() if self._arrivals else None

    async def execute(self, taken_data: Callable[[], object] | None) -> None:
        """Pass on an arrival: acceptance, feedback and result come in this order."""
        result = None if taken_data is None else taken_data()
        if inspect.isawaitable(result):  # a callback for feedback may be a coroutine function
            await result

    def _arrive(self, function: Callable[[], object]) -> None:
        self._arrivals.append(function)
        self._node._wake_executor()

    def _finish(self, future: Future, result: Any) -> None:
        future._set_executor(self._node.executor)
        future.set_result(result)

    # ------------------------------------------------------------------ goals

    def send_goal(self, goal: ProgramMessage, **kwargs: Any) -> Any:
        """Send a goal and wait for status and result, while another thread spins; see `send_goal_async`."""
        goal_handle = self._wait_for(self.send_goal_async(goal, **kwargs), "send_goal()")
        return self._wait_for(self._get_result_async(goal_handle), "send_goal()")

    def send_goal_async(
        self, goal: ProgramMessage, feedback_callback: Callable[[Any], object] | None = None, goal_uuid: Any = None
    ) -> Future:
        """Send a goal and return a future for a `ClientGoalHandle`.

        Args:
            goal: goal message.
            feedback_callback: function or coroutine function that receives each feedback message.
            goal_uuid: message `UUID`; None for a new one.

        Raises:
            TypeError: the message is not a goal of this action.
        """
        if not isinstance(goal, self._action_type.Goal):
            raise TypeError
        uuid = UUID(uuid=list(self._client.new_goal_id())) if goal_uuid is None else goal_uuid
        future, sent = Future(), SentGoal()

        def on_feedback(message: ProgramMessage) -> None:
            if feedback_callback is not None:
                self._arrive(partial(self._call_back, feedback_callback, uuid, message))

        sent.goal = self._client.send(
            self._goal_to_simkit(goal),
            bytes(uuid.uuid),
            on_feedback,
            lambda accepted, time_ns: self._arrive(partial(self._accept, future, uuid, sent, accepted, time_ns)),
            lambda status, result: self._arrive(partial(self._end, sent, status, result)),
        )
        return future

    def _accept(self, future: Future, uuid: Any, sent: SentGoal, accepted: bool, time_ns: int) -> None:
        response = self._action_type.Impl.SendGoalService.Response(accepted=accepted)
        response.stamp = _times.Time(sec=time_ns // 10**9, nanosec=time_ns % 10**9)
        self._finish(future, ClientGoalHandle(self, uuid, response, sent))

    def _call_back(self, feedback_callback: Callable[[Any], object], uuid: Any, message: ProgramMessage) -> Any:
        feedback = self._action_type.Impl.FeedbackMessage(goal_id=uuid)
        feedback.feedback = self._feedback_to_program(message)
        return feedback_callback(feedback)

    def _end(self, sent: SentGoal, status: int, result: Any) -> None:
        sent.response = self._action_type.Impl.GetResultService.Response(status=status)
        sent.response.result = self._result_to_program(result)
        futures, sent.futures = sent.futures, []
        for future in futures:
            self._finish(future, sent.response)

    def _get_result_async(self, goal_handle: ClientGoalHandle) -> Future:
        _check_handle(goal_handle)
        future, sent = Future(), goal_handle._sent
        if goal_handle.accepted and sent.response is None:
            sent.futures.append(future)
        else:
            is_known = goal_handle.accepted and sent.goal.is_result_kept
            response = sent.response if is_known else self._action_type.Impl.GetResultService.Response()
            self._arrive(partial(self._finish, future, response))  # without a result, the status is UNKNOWN
        return future

    def _cancel_goal_async(self, goal_handle: ClientGoalHandle) -> Future:
        _check_handle(goal_handle)
        future = Future()
        goal_handle._sent.goal.cancel(
            lambda code, is_cancelled: self._arrive(partial(self._cancel, future, goal_handle, code, is_cancelled))
        )
        return future

    def _cancel(self, future: Future, goal_handle: ClientGoalHandle, code: int, is_cancelled: bool) -> None:
        response = CancelGoal.Response(return_code=code)
        if is_cancelled:
            info = _action_messages.GoalInfo(goal_id=goal_handle.goal_id, stamp=goal_handle.stamp)
            response.goals_canceling = [info]
        self._finish(future, response)

    def _wait_for(self, future: Future, what: str) -> Any:
        name = f"{what} of action {self._client.name!r}"
        wait_for_result(future, lambda: bool(self._arrivals), name, None)
        return future.result()

    # ------------------------------------------------------------------ action

    def server_is_ready(self) -> bool:
        """Check whether the action exists and is discovered."""
        current_host().poll()
        return bool(self._client.is_ready)

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Wait until the action exists, for up to `timeout_sec` or without limit; return False after that time."""
        return wait_until(lambda: self._client.is_ready, self._node.context, timeout_sec)

    def destroy(self) -> None:
        """Destroy the client; its goals continue."""
        self._handle.destroy()
        self._client.close()
        self._node.remove_waitable(self)


def _check_handle(goal_handle: object) -> None:
    if not isinstance(goal_handle, ClientGoalHandle):
        raise TypeError(f"Expected type ClientGoalHandle but received {type(goal_handle)}")
