"""Actions within the process: goals that take time, with feedback, a result, and a way to call them off.

    goal = sim.send_goal("/arm_controller/follow_joint_trajectory", {"trajectory": …})
    sim.run(3.0)
    goal.status, goal.result

A goal, and the wish to cancel one, reach the plugin between two steps, in the order in which they were sent.
"""

from __future__ import annotations

import enum
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from simkit import msgs
from simkit.errors import ActionError, InputError, MessageError, PluginError, SimkitError, SubscriberError
from simkit.runtime.communication.endpoint_table import EndpointTable
from simkit.runtime.communication.subscription import Callback, Message, callback_name
from simkit.runtime.communication.topic_bus import absolute_name

if TYPE_CHECKING:
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine


EndCallback = Callable[["GoalHandle"], None]
"""Called with a goal that has ended."""
GoalCallback = Callable[["GoalHandle"], None]
CancelCallback = Callable[["GoalHandle"], bool | None]


class GoalStatus(enum.IntEnum):
    """How far a goal is; the numbers are those of `action_msgs/msg/GoalStatus`, REJECTED is ours.

    UNKNOWN is a goal that has not reached its plugin yet, or that a restore went back before.
    """

    REJECTED = -1
    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6


_FINAL_STATES = frozenset({GoalStatus.REJECTED, GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED})


class GoalHandle:
    """A goal, as the one who sent it sees it and as the plugin that works on it does.

    Attributes:
        id: 1, 2, … in the order in which goals were sent.
        request: the goal message.
        status: see `GoalStatus`.
        result: the result message, once there is one.
        feedback: the newest feedback message.
        reason: why it was rejected, or anything else that was said with its end.
        sent_ns: simulated time at which it was sent [ns].
    """

    def __init__(self, action: Action, number: int, request: Message, sent_ns: int) -> None:
        self._action, self.id, self.request, self.sent_ns = action, number, request, sent_ns
        self.status = GoalStatus.UNKNOWN
        self.result: Message = None
        self.feedback: Message = None
        self.reason = ""
        self._on_feedback: Callback | None = None
        self._on_done: EndCallback | None = None

    # ------------------------------------------------------------------ for the one who sent it

    @property
    def is_done(self) -> bool:
        """Whether it was rejected, succeeded, was cancelled or aborted."""
        return self.status in _FINAL_STATES

    @property
    def is_active(self) -> bool:
        """Whether the plugin is at work on it."""
        return self.status in (GoalStatus.ACCEPTED, GoalStatus.EXECUTING, GoalStatus.CANCELING)

    def cancel(self) -> None:
        """Asks for it to be called off; the plugin hears of it before the next step, and may go on."""
        bus = self._action.bus
        with bus.passing("cancel", goal=self.id):
            bus.enqueue(lambda: self._action.ask_to_cancel(self))

    # ------------------------------------------------------------------ for the plugin

    def reject(self, reason: str = "") -> None:
        """Does not take the goal; only while it is being offered."""
        if self.status in (GoalStatus.EXECUTING, GoalStatus.CANCELING):
            raise ActionError(f"goal {self.id} of {self._action.name!r} was taken already; abort it")
        self._end(GoalStatus.REJECTED, None, reason)

    def publish_feedback(self, feedback: Message) -> None:
        """Tells how far it is, by a message or a dict of its fields; nobody, once it has ended."""
        if self.is_done:
            return
        self.feedback = self._as_message(feedback, "Feedback")
        self._notify(self._on_feedback, self.feedback, "feedback")

    def succeed(self, result: Message = None, reason: str = "") -> None:
        """Ends it well."""
        self._end(GoalStatus.SUCCEEDED, result, reason)

    def abort(self, result: Message = None, reason: str = "") -> None:
        """Ends it short of its aim."""
        self._end(GoalStatus.ABORTED, result, reason)

    def canceled(self, result: Message = None, reason: str = "") -> None:
        """Ends it because that was asked for."""
        self._end(GoalStatus.CANCELED, result, reason)

    def _end(self, status: GoalStatus, result: Message, reason: str) -> None:
        if self.is_done:
            raise ActionError(f"goal {self.id} of {self._action.name!r} has ended already ({self.status.name})")
        self.result = None if status is GoalStatus.REJECTED else self._as_message(result, "Result")
        self.status, self.reason = status, reason
        self._notify(self._on_done, self, "get_result")

    def _notify(self, callback: Callback | None, what: Message, part: str) -> None:
        """Calls the one who sent it back; what they raise is not the plugin's fault."""
        if callback is None:
            return
        try:
            callback(what)
        except Exception as error:
            if isinstance(error, SimkitError) and not isinstance(error, InputError):
                raise
            topic, now = f"{self._action.name}/_action/{part}", self._action.engine.time
            raise SubscriberError(topic, callback_name(callback), now, repr(error)) from error

    def _as_message(self, value: Message, part: str) -> Message:
        wanted = f"{self._action.type_name}_{part}"
        if value is None or isinstance(value, Mapping):
            return msgs.make(wanted, **(value or {}))
        if msgs.type_name(value) != wanted:
            raise MessageError(f"{self._action.name!r} gives {wanted}, got {msgs.type_name(value)}")
        return value

    def __deepcopy__(self, memo: dict[int, object]) -> GoalHandle:
        return self


class Action:
    """One action, as the plugin behind it opened it.

    Attributes:
        name: absolute.
        type_name: such as `control_msgs/action/FollowJointTrajectory`.
        owner: whose it is; it is there as long as its owner is.
    """

    def __init__(
        self,
        bus: TopicBus,
        engine: Engine,
        name: str,
        type_name: str,
        on_goal: GoalCallback,
        on_cancel: CancelCallback | None,
    ) -> None:
        self.bus, self.engine, self.name, self.type_name, self.owner = bus, engine, name, type_name, bus.owner
        self.active = True
        self._on_goal, self._on_cancel = on_goal, on_cancel

    def offer(self, goal: GoalHandle) -> None:
        """Hands a goal to the plugin, which works on it unless it rejects it at once."""
        if goal.is_done:
            return  # its plugin raised before it got the goal
        if not self.active:
            goal._end(GoalStatus.REJECTED, None, "the action is gone")
            return
        goal.status = GoalStatus.ACCEPTED
        self._guarded(self._on_goal, goal)
        if goal.status is GoalStatus.ACCEPTED:
            goal.status = GoalStatus.EXECUTING

    def ask_to_cancel(self, goal: GoalHandle) -> None:
        """Hands the wish to cancel to the plugin; one that has no way to do so, or gives False, goes on."""
        if not goal.is_active or goal.status is GoalStatus.CANCELING or self._on_cancel is None:
            return
        before, goal.status = goal.status, GoalStatus.CANCELING
        if self._guarded(self._on_cancel, goal) is False and goal.status is GoalStatus.CANCELING:
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
            raise PluginError(name, hook, self.engine.time, where, repr(error)) from error

    def __deepcopy__(self, memo: dict[int, object]) -> Action:
        return self


GoalStates = tuple[int, tuple[tuple[GoalHandle, tuple[GoalStatus, Message, Message, str]], ...]]
"""How many goals were sent, and status, result, feedback and reason of each."""


class ActionTable(EndpointTable[Action]):
    """All actions of a simulation, and the goals that were sent.

    Args:
        bus: goals reach the plugins among its commands.
        engine: calls plugins.
    """

    kind, part, error = "action", "Goal", ActionError

    def __init__(self, bus: TopicBus, engine: Engine) -> None:
        super().__init__(bus, engine)
        self._goals: list[GoalHandle] = []
        self._sent = 0

    def act(self, name: str, type_name: str, on_goal: GoalCallback, on_cancel: CancelCallback | None = None) -> Action:
        """Opens an action; whatever opens it within `bus.owned_by(owner)` belongs to that owner.

        Raises:
            ActionError: there is one of that name.
            MessageError: an unknown type.
        """
        name = absolute_name(name)
        self._check_type(type_name)
        if self._find(name) is not None:
            raise ActionError(f"there is an action {name!r} already")
        with self._bus.passing("act", action=name):
            action = Action(self._bus, self._engine, name, type_name, on_goal, on_cancel)
            self._endpoints.setdefault(name, []).append(action)
        return action

    def send(
        self, name: str, goal: Message = None, on_feedback: Callback | None = None, on_done: EndCallback | None = None
    ) -> GoalHandle:
        """Sends a goal; the plugin has it before the next step.

        Args:
            name: absolute, or taken as such.
            goal: a message, a dict of its fields, or None for all zero.
            on_feedback: called with each feedback message.
            on_done: called with the handle once it has ended.

        Raises:
            ActionError: there is no such action; names the closest.
            MessageError: the goal does not fit.
        """
        action = self._get(absolute_name(name))
        request = self._as_message(action, goal)
        journal = self._bus.journal
        if journal is not None:
            on_feedback, on_done = journal.outside(on_feedback), journal.outside(on_done)
        with self._bus.passing("send_goal", action=action.name, goal=request, on_feedback=on_feedback, on_done=on_done):
            self._sent += 1
            handle = GoalHandle(action, self._sent, request, self._engine.time_ns)
            handle._on_feedback, handle._on_done = on_feedback, on_done
            self._goals = [g for g in self._goals if not g.is_done]
            self._goals.append(handle)
            self._bus.enqueue(lambda: action.offer(handle))
        return handle

    def abandon(self, owner: object, reason: str) -> None:
        """Ends every goal of a plugin that is left out."""
        for goal in [g for g in self._goals if g._action.owner is owner and not g.is_done]:
            goal.abort(reason=reason)

    def abandon_gone(self) -> None:
        """Ends every goal whose plugin has left the world."""
        for goal in [g for g in self._goals if not g._action.active and g.is_active]:
            goal.abort(reason="the action is gone")

    def get_state(self) -> GoalStates:
        """How far each goal is."""
        goals = [(g, (g.status, g.result, g.feedback, g.reason)) for g in self._goals]
        return self._sent, tuple(goals)

    def set_state(self, state: GoalStates) -> None:
        """Back to a state from `get_state`; goals sent since are unknown again."""
        for goal in self._goals:
            goal.status, goal.result, goal.feedback, goal.reason = GoalStatus.UNKNOWN, None, None, ""
        self._sent = state[0]
        self._goals = [goal for goal, _ in state[1]]
        for goal, values in state[1]:
            goal.status, goal.result, goal.feedback, goal.reason = values
