"""Servers of actions. A thread of each server calls the functions of the program."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit_nodes.ros1_modules.actionlib.action_types import action_types
from simkit_nodes.ros1_modules.actionlib.server_goal_handle import ServerGoalHandle
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node
from simkit_nodes.ros1_modules.rospy.rostime import Time

if TYPE_CHECKING:
    from simkit_nodes.graph_actions import GraphActionServer

__all__ = ["ActionServer", "nop_cb"]

_RESULT_TIMEOUT_NS = 5_000_000_000  # actionlib lists the status of a goal for 5 s after its end


def nop_cb(goal_handle: ServerGoalHandle) -> None:
    """Do nothing."""


class ActionServer:
    """Server of an action.

    Args:
        ns: name of the action.
        ActionSpec: class of the action, such as `FibonacciAction`.
        goal_cb: function of each goal's handle.
        cancel_cb: function of the handle of a goal whose client requests the cancellation.
        auto_start: True to open the action at once.

    Attributes:
        ns: name of the action.
        action_types: types of the action.
        started: True after `start`.
    """

    def __init__(
        self,
        ns: str,
        ActionSpec: object,
        goal_cb: Callable[[ServerGoalHandle], object],
        cancel_cb: Callable[[ServerGoalHandle], object] = nop_cb,
        auto_start: bool = True,
    ) -> None:
        self.ns, self.action_types = ns, action_types(ActionSpec)
        self.goal_callback, self.cancel_callback = goal_cb, cancel_cb
        self._node = ros_node()
        self._name = self._node.resolve_endpoint(ns)
        self._goals: dict[bytes, ServerGoalHandle] = {}
        self._server: GraphActionServer | None = None
        self.started = False
        if auto_start:
            self.start()

    def ActionResultType(self) -> Any:
        """Return a result with default values."""
        return self.action_types.message(self.action_types.result)

    def register_goal_callback(self, cb: Callable[[ServerGoalHandle], object]) -> None:
        """Set the function of each goal's handle."""
        self.goal_callback = cb

    def register_cancel_callback(self, cancel_cb: Callable[[ServerGoalHandle], object]) -> None:
        """Set the function of the handle of a goal whose client requests the cancellation."""
        self.cancel_callback = cancel_cb

    def start(self) -> None:
        """Open the action."""
        if not self.started:
            self.started = True
            self._node.at_init(self._open)

    def stop(self) -> None:
        """Close the action."""
        self.started = False
        if self._server is not None:
            self._server.close()
            self._server = None
            self._node.host.wake()

    def _open(self) -> None:
        self._server = self._node.graph_node.act(
            self._name, self.action_types.action, result_timeout_ns=_RESULT_TIMEOUT_NS
        )
        self._node.start_thread(self._run, f"action server {self._name}")

    def _run(self) -> None:
        """Call the functions of the program; the function of the thread."""
        node, server = self._node, self._server
        while server is not None and self.started and not node.is_shutdown:
            goal = server.take_goal()
            cancel = server.take_cancel() if goal is None else None
            if goal is not None:
                handle = ServerGoalHandle(self.action_types, goal, Time(0, node.host.now_ns()))
                self._goals[goal.id] = handle
                self.goal_callback(handle)
            elif cancel is not None:
                cancelled = self._goals.get(cancel.id)
                if cancelled is not None and cancelled.set_cancel_requested():
                    cancel.accept()
                    self.cancel_callback(cancelled)
                else:
                    cancel.reject()
            else:
                node.wait(None, lambda: not self.started or server.has_request)
