"""Actions within the process: goals that take time, with feedback, a result and cancellation.

    goal = sim.send_goal("/arm_controller/follow_joint_trajectory", {"trajectory": …})
    sim.run(3.0)
    goal.status, goal.result

The plugin receives goals and cancel requests between two steps, in the order in which they were sent.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Generic

from simkit.argument_checks import check_function
from simkit.errors import ActionError, InputError, PluginError, SimkitError, SubscriberError, callback_name, cause_text
from simkit.in_process import InProcess
from simkit.msgs import Message
from simkit.msgs.goal_status import GoalStatus
from simkit.msgs.message_arguments import checked_message, typed_message
from simkit.msgs.message_types import F, M, M_co, R, interface_type
from simkit.msgs.topic_names import absolute_name
from simkit.runtime.communication.endpoint_table import EndpointTable
from simkit.runtime.communication.script_callback import ScriptCallback
from simkit.runtime.communication.subscription import Callback

if TYPE_CHECKING:
    from simkit.msgs.message_classes import ActionGoal
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine


EndCallback = Callable[["GoalHandle"], object]
"""Function that receives a goal that has ended."""
GoalCallback = Callable[["GoalHandle"], None]
CancelCallback = Callable[["GoalHandle"], bool | None]


GoalState = tuple[GoalStatus, Message, Message, str]
"""Status, result, feedback and reason of a goal."""


class GoalHandle(InProcess, Generic[M_co]):
    """Goal, as seen by the client that sent it and by the plugin that executes it.

    The type parameter is the class of the goal message, from which type checkers know those of result and feedback.

    Attributes:
        action: action that executes the goal.
        id: 1, 2, … in the order in which goals were sent.
        request: goal message.
        status: present status; see `GoalStatus`.
        reason: text of the plugin about the end of the goal, such as the reason for a rejection.
        sent_ns: simulated time at which the goal was sent [ns].
    """

    _internal_names = frozenset({"begin", "end", "get_state", "set_state"})

    def __init__(
        self,
        action: Action,
        number: int,
        request: M_co,
        sent_ns: int,
        on_feedback: Callback | None = None,
        on_done: EndCallback | None = None,
        on_accept: EndCallback | None = None,
    ) -> None:
        self.action, self.id, self.request, self.sent_ns = action, number, request, sent_ns
        self._on_feedback, self._on_done, self._on_accept = on_feedback, on_done, on_accept
        self.status = GoalStatus.UNKNOWN
        self._result: Message = None
        self._feedback: Message = None
        self.reason = ""

    # ------------------------------------------------------------------ for the client

    @property
    def result(self: GoalHandle[ActionGoal[M, R, F]]) -> R | Any:  # `Any` stands for None, as in `Subscription.latest`
        """Result message; None before the end."""
        return self._result

    @property
    def feedback(self: GoalHandle[ActionGoal[M, R, F]]) -> F | Any:  # as `result`
        """Newest feedback message; None before the first."""
        return self._feedback

    @property
    def is_done(self) -> bool:
        """True if the goal was rejected, succeeded, was cancelled or aborted."""
        return self.status.is_final

    @property
    def is_active(self) -> bool:
        """True while the plugin executes the goal."""
        return self.status in (GoalStatus.ACCEPTED, GoalStatus.EXECUTING, GoalStatus.CANCELING)

    def cancel(self) -> None:
        """Request the cancellation of the goal.

        The plugin receives the request before the next step and may continue.
        """
        bus = self.action.bus
        with bus.passing("cancel", goal=self.id):
            bus.enqueue(lambda: self.action.ask_to_cancel(self))

    # ------------------------------------------------------------------ for the plugin or script with the action

    def accept(self) -> None:
        """Accept a goal of an action that decides later; a goal of any other action is accepted by its callback."""
        if self.status is GoalStatus.UNKNOWN:
            with self.action.bus.passing("accept_goal", goal=self.id):
                self.begin()

    def begin(self) -> None:
        """Begin the execution of an accepted goal."""
        self.status = GoalStatus.EXECUTING
        self._notify(self._on_accept, self, "send_goal")

    def continue_goal(self) -> None:
        """Continue a goal whose cancellation was requested."""
        if self.status is GoalStatus.CANCELING:
            with self.action.bus.passing("continue_goal", goal=self.id):
                self.status = GoalStatus.EXECUTING

    def reject(self, reason: str = "") -> None:
        """Reject the goal. Only the goal callback can do this; ActionError after the goal was accepted."""
        if self.status in (GoalStatus.EXECUTING, GoalStatus.CANCELING):
            raise ActionError(f"goal {self.id} of {self.action.name!r} was accepted already; abort it")
        self.end(GoalStatus.REJECTED, None, reason)

    def publish_feedback(self: GoalHandle[ActionGoal[M, R, F]], feedback: F | Mapping[str, object]) -> None:
        """Send feedback to the client. After the end of the goal, feedback is ignored.

        Args:
            feedback: feedback message, or a dict of its fields.
        """
        if self.is_done or not self.action.knows(self):
            return
        message = self._as_message(feedback, "Feedback")
        with self.action.bus.passing("send_feedback", goal=self.id, feedback=message):
            self._feedback = message
            self._notify(self._on_feedback, message, "feedback")

    def succeed(
        self: GoalHandle[ActionGoal[M, R, F]], result: R | Mapping[str, object] | None = None, reason: str = ""
    ) -> None:
        """End the goal as succeeded. The result is a message, a dict of its fields, or None for default fields."""
        self.end(GoalStatus.SUCCEEDED, result, reason)

    def abort(
        self: GoalHandle[ActionGoal[M, R, F]], result: R | Mapping[str, object] | None = None, reason: str = ""
    ) -> None:
        """End the goal as aborted; the arguments are those of `succeed`."""
        self.end(GoalStatus.ABORTED, result, reason)

    def canceled(
        self: GoalHandle[ActionGoal[M, R, F]], result: R | Mapping[str, object] | None = None, reason: str = ""
    ) -> None:
        """End the goal as cancelled; the arguments are those of `succeed`."""
        self.end(GoalStatus.CANCELED, result, reason)

    def end(self, status: GoalStatus, result: Message = None, reason: str = "") -> None:
        """End the goal with a final status.

        Raises:
            ActionError: the goal has ended, or a reset or restore has undone it.
        """
        if not self.is_done and not self.action.knows(self):
            raise ActionError(f"goal {self.id} of {self.action.name!r} was undone by a reset or a restore")
        if self.is_done:
            raise ActionError(f"goal {self.id} of {self.action.name!r} has ended already ({self.status.name})")
        message = None if status is GoalStatus.REJECTED else self._as_message(result, "Result")
        with self.action.bus.passing("end_goal", goal=self.id, status=status, result=message, reason=reason):
            self._result, self.status, self.reason = message, status, reason
            self._notify(self._on_done, self, "get_result")

    def get_state(self) -> GoalState:
        """Return the state of the goal."""
        return self.status, self._result, self._feedback, self.reason

    def set_state(self, state: GoalState) -> None:
        """Restore a state from `get_state`."""
        self.status, self._result, self._feedback, self.reason = state

    def _notify(self, callback: Callback | None, argument: Message, part: str) -> None:
        """Call a callback of the client. An exception of the callback does not count as an error of the plugin."""
        if callback is None:
            return
        try:
            callback(argument)
        except Exception as error:
            if isinstance(error, SimkitError) and not isinstance(error, InputError):
                raise
            topic, now = f"{self.action.name}/_action/{part}", self.action.engine.time
            raise SubscriberError(topic, callback_name(callback), now, cause_text(error)) from error

    def _as_message(self, value: Message, part: str) -> Message:
        return checked_message(
            value, (f"{self.action.type_name}_{part}",), repr(self.action.name), none_is_default=True
        )

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.id} of {self.action.name!r}: {self.status.name}>"


class Action(InProcess):
    """Action of a plugin.

    Attributes:
        name: absolute name.
        type_name: action type, such as `control_msgs/action/FollowJointTrajectory`.
        owner: plugin of the action; the action exists as long as its owner.
        on_goal: function that receives each new goal.
        on_cancel: function that receives a goal whose cancellation is requested; None if every goal continues.
        node: other process that executes the goals, and accepts or rejects them later; empty for this process.
        is_immediate: True if a goal reaches the callback at once while no step is made, so also in a paused world.
    """

    _internal_names = frozenset({"ask_to_cancel", "deliver_at_once", "knows", "offer"})

    def __init__(
        self,
        table: ActionTable,
        name: str,
        type_name: str,
        on_goal: GoalCallback,
        on_cancel: CancelCallback | None,
        node: str = "",
    ) -> None:
        self._table, self.bus, self.engine = table, table.bus, table.engine
        self.name, self.type_name, self.owner = name, type_name, self.bus.owner
        self.active, self.is_immediate = True, False
        self.on_goal, self.on_cancel, self.node = on_goal, on_cancel, node
        if self.owner is None and not node:
            self.on_goal = ScriptCallback(self.bus, _succeeding(on_goal), "action", name)
            self.on_cancel = on_cancel and ScriptCallback(self.bus, on_cancel, "action", name, lambda accepts: accepts)

    def deliver_at_once(self) -> None:
        """Pass goals to the callback at once while no step is made, so also in a paused world."""
        self.is_immediate = True

    def close(self) -> None:
        """Close the action permanently. Its goals are aborted."""
        self._table.close(self)

    def knows(self, goal: GoalHandle) -> bool:
        """Check whether a goal belongs to the present state: no reset or restore has undone it.

        A plugin's own state is restored together with its goals, so its goals always belong to the present state.
        """
        return self.owner is not None or self._table.knows(goal)

    def offer(self, goal: GoalHandle) -> None:
        """Pass a goal to the plugin. The plugin executes the goal, unless its goal callback rejects the goal."""
        if goal.is_done:
            return  # the plugin raised before it received the goal
        if not self.active:
            goal.end(GoalStatus.REJECTED, None, "the action was removed")
            return
        if self.node:
            self.on_goal(goal)
            return
        goal.status = GoalStatus.ACCEPTED
        self._guarded(self.on_goal, goal)
        if goal.status is GoalStatus.ACCEPTED:
            goal.begin()

    def ask_to_cancel(self, goal: GoalHandle) -> None:
        """Pass a cancel request to the plugin.

        The goal continues if the plugin has no cancel callback or returns False.
        """
        if not goal.is_active or goal.status is GoalStatus.CANCELING or self.on_cancel is None:
            return
        before, goal.status = goal.status, GoalStatus.CANCELING
        if self._guarded(self.on_cancel, goal) is False and goal.status is GoalStatus.CANCELING:
            goal.status = before

    def _guarded(self, call: Callable[[GoalHandle], bool | None], goal: GoalHandle) -> bool | None:
        owner, hook = self.owner, f"action {self.name}"
        if hasattr(owner, "on_error"):
            return self.engine.faults.guard(owner, hook, call)(goal)
        try:
            return call(goal)
        except SimkitError:
            raise
        except Exception as error:
            name, where = getattr(owner, "name", "") or self.name, str(getattr(owner, "where", ""))
            raise PluginError(name, hook, self.engine.time, where, cause_text(error)) from error

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name!r} {self.type_name}>"


def _succeeding(on_goal: Callable[[GoalHandle], Message]) -> GoalCallback:
    """Return a goal callback that ends the goal as succeeded if `on_goal` returns a result."""

    @functools.wraps(on_goal)
    def execute(goal: GoalHandle) -> None:
        result = on_goal(goal)
        if result is not None and not goal.is_done:
            goal.succeed(result)

    return execute


GoalStates = tuple[int, tuple[tuple[GoalHandle, GoalState], ...]]
"""Number of sent goals, and the state of each goal."""


class ActionTable(EndpointTable[Action]):
    """All actions of a simulation, and the goals that were sent.

    Args:
        bus: topic bus, whose command queue passes goals to the plugins.
        engine: engine that calls plugins.
    """

    article, kind, folder, part, error = "an", "action", "action", "Goal", ActionError

    def __init__(self, bus: TopicBus, engine: Engine) -> None:
        super().__init__(bus, engine)
        self.bus, self.engine = bus, engine
        self._goals: list[GoalHandle] = []
        self._sent = 0

    def act(
        self,
        name: str,
        type_name: str | type,
        on_goal: GoalCallback,
        on_cancel: CancelCallback | None = None,
        *,
        node: str = "",
    ) -> Action:
        """Open an action. An action that is opened within `bus.owned_by(owner)` belongs to that owner.

        Args:
            name: name of the action; a missing leading slash is added.
            type_name: action type, such as `control_msgs/action/FollowJointTrajectory`.
            on_goal: function that receives each new goal between two steps.
            on_cancel: function that receives a goal that a client cancels; it returns False to continue the goal.
            node: other process that executes the goals; empty for this process.

        Raises:
            ActionError: an action of that name exists.
            MessageError: the type is unknown.
        """
        self._engine.check_open()
        name = self._bus.name_of(name)
        check_function(on_goal, "on_goal")
        if on_cancel is not None:
            check_function(on_cancel, "on_cancel")
        type_name = interface_type(type_name, self.part)
        self._check_type(type_name)
        self._report_clash(name)
        action = Action(self, name, type_name, on_goal, on_cancel, node)
        with self._bus.passing("act", action=action):
            self._endpoints.setdefault(name, []).append(action)
        return action

    def send(
        self,
        name: str,
        goal: Message = None,
        on_feedback: Callback | None = None,
        on_done: EndCallback | None = None,
        *,
        on_accept: EndCallback | None = None,
        type_: str | type | None = None,
    ) -> GoalHandle:
        """Send a goal; the plugin receives it before the next step.

        Args:
            name: name of the action; a missing leading slash is added.
            goal: message, dict of its fields, or None for a message with default fields.
            on_feedback: function that receives each feedback message.
            on_done: function that receives the handle after the end of the goal.
            on_accept: function that receives the handle when the execution begins; its inputs to the simulation are not
                recorded in a journal.
            type_: type of the action, or class of the goal; None for the type that the action has.

        Raises:
            ActionError: no such action; the message suggests the closest name.
            MessageError: the goal does not fit the type.
        """
        self._engine.check_open()
        action = self.get(absolute_name(name))
        request = self.checked(action, typed_message(goal, type_, self.part, repr(action.name)))
        journal = self._bus.journal
        if journal is not None:
            on_feedback, on_done = journal.outside(on_feedback), journal.outside(on_done)
        with self._bus.passing("send_goal", action=action.name, goal=request, on_feedback=on_feedback, on_done=on_done):
            self._sent += 1
            handle = GoalHandle(action, self._sent, request, self._engine.time_ns, on_feedback, on_done, on_accept)
            self._goals = [g for g in self._goals if not g.is_done]
            self._goals.append(handle)
            if action.is_immediate and not self._engine.is_stepping:
                action.offer(handle)
            else:
                self._bus.enqueue(lambda: action.offer(handle))
        return handle

    def abandon(self, owner: object, reason: str) -> None:
        """Abort every goal of a disabled plugin."""
        for goal in [g for g in self._goals if g.action.owner is owner and not g.is_done]:
            goal.abort(reason=reason)

    def hand_over(self, old: object, new: object, reason: str) -> None:
        """Continue the goals of a plugin with the actions of the same names of another plugin, or abort them."""
        actions = self.endpoints_of(new)
        for goal in [g for g in self._goals if g.action.owner is old and not g.is_done]:
            if goal.action.name in actions:
                goal.action = actions[goal.action.name]
            else:
                goal.abort(reason=reason)

    def abandon_gone(self) -> None:
        """Abort every goal of a plugin that was removed from the world."""
        for goal in [g for g in self._goals if not g.action.active and g.is_active]:
            goal.abort(reason="the action was removed")

    def knows(self, goal: GoalHandle) -> bool:
        """Check whether a goal was sent in the present state of the simulation."""
        return any(open_goal is goal for open_goal in self._goals)

    def goal(self, number: int) -> GoalHandle:
        """Return a goal that has not ended, by its number."""
        return next(goal for goal in self._goals if goal.id == number)

    def _end_requests(self, endpoint: Action) -> None:
        for goal in [g for g in self._goals if g.action is endpoint and not g.is_done]:
            goal.abort(reason=f"the action{f' of {endpoint.node!r}' if endpoint.node else ''} was closed")

    def get_state(self) -> GoalStates:
        """Return the status of each goal."""
        return self._sent, tuple((goal, goal.get_state()) for goal in self._goals)

    def set_state(self, state: GoalStates) -> None:
        """Restore a state from `get_state`; goals sent after it become UNKNOWN."""
        for goal in self._goals:
            goal.set_state((GoalStatus.UNKNOWN, None, None, ""))
        self._sent = state[0]
        self._goals = [goal for goal, _ in state[1]]
        for goal, values in state[1]:
            goal.set_state(values)
