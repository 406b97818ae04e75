"""Handles of the services, actions, command inputs and parameters that a client offers: the client's side."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Generic, TypeVar

from simkit import msgs
from simkit.bridges.live.client_handles import LiveSubscription
from simkit.bridges.live.protocol import JsonObject, JsonValue, LiveClosed, LiveError
from simkit.bridges.live.server_link import ServerLink
from simkit.deferred_response import DeferredResponse
from simkit.errors import callback_name
from simkit.msgs.message_arguments import checked_message
from simkit.msgs.message_types import F, M, M_co, Message, R

if TYPE_CHECKING:
    from simkit.msgs.message_classes import ActionGoal

T = TypeVar("T", bound="bool | int | float | str | tuple[float, ...]")

CALLBACK_ERROR = "SK-TOPIC-002"
"""Code of the error for a callback that raised, as in the process of the simulation."""


def raised(callback: object, kind: str, name: str, error: Exception) -> LiveError:
    """Return the error for a callback of this client that raised; raise the error of an ended simulation itself."""
    if isinstance(error, LiveClosed):
        raise error
    reason = str(error) if isinstance(error, LiveError) else repr(error)
    return LiveError(CALLBACK_ERROR, f"callback {callback_name(callback)} of {kind} {name!r} raised: {reason}")


class LiveEndpoint:
    """Endpoint of a client, which the simulation calls.

    Attributes:
        number: number of the endpoint on the connection.
        name: absolute name.
        type_name: type, such as `std_srvs/srv/Trigger`.
    """

    def __init__(self, link: ServerLink, number: int, name: str, type_name: str) -> None:
        self._link, self.number, self.name, self.type_name = link, number, name, type_name

    def close(self) -> None:
        """Close the endpoint."""
        if self._link.endpoints.pop(self.number, None) is not None and not self._link.is_closed:
            self._link.request("close_endpoint", {"number": self.number})

    def take(self, words: JsonObject, data: bytes) -> None:
        """Process a notification of the simulation."""
        raise NotImplementedError


class LiveService(LiveEndpoint):
    """Service that this client answers while it receives."""

    def __init__(
        self, link: ServerLink, number: int, name: str, type_name: str, handler: Callable[[Message], object]
    ) -> None:
        super().__init__(link, number, name, type_name)
        self._handler = handler

    def take(self, words: JsonObject, data: bytes) -> None:
        """Queue a request."""
        self._link.requests.append(lambda: self._answer(int(words["call"]), data))

    def _answer(self, number: int, data: bytes) -> None:
        words: JsonObject = {"number": self.number, "call": number}
        try:
            answer = self._handler(msgs.deserialize(data, f"{self.type_name}_Request"))
            if isinstance(answer, DeferredResponse):
                answer.connect(functools.partial(self._respond, words))
                return
            self._respond(words, answer, "")
        except Exception as error:
            problem = raised(self._handler, "service", self.name, error)
            if not self._link.is_closed:
                self._link.post("respond", {**words, "error": str(problem)})
            raise problem from error

    def _respond(self, words: JsonObject, answer: object, error: str) -> None:
        """Send a response, or the text of an error; without effect after the end of the connection."""
        if self._link.is_closed:
            return
        if error:
            self._link.post("respond", {**words, "error": error})
            return
        types = (f"{self.type_name}_Response",)
        response = checked_message(answer, types, f"response of {self.name!r}", none_is_default=True)
        self._link.post("respond", {**words, "type": msgs.type_name(response)}, msgs.serialize(response))


class LiveServerGoal(Generic[M_co]):
    """Goal of an action of this client; the type parameter is the class of the goal message.

    Attributes:
        request: goal message.
        is_cancel_requested: True after a client has requested the cancellation.
        is_done: True after the end of the goal.
    """

    def __init__(self, link: ServerLink, action: LiveAction, number: int, request: M_co) -> None:
        self._link, self._action, self._number, self.request = link, action, number, request
        self.is_cancel_requested = self.is_done = False

    def publish_feedback(self: LiveServerGoal[ActionGoal[M, R, F]], feedback: F | Mapping[str, object]) -> None:
        """Send feedback, a message or a dict of its fields, and receive what has arrived for this client."""
        if not self.is_done:
            content, type_name = self._encoded(feedback, "Feedback")
            self._link.post("update_goal", {**self._words("feedback"), "type": type_name}, content)
            self._link.receive(0.0)

    def reject(self, reason: str = "") -> None:
        """Reject the goal, which the callback of the action has just received."""
        self._end("REJECTED", None, reason)

    def succeed(
        self: LiveServerGoal[ActionGoal[M, R, F]], result: R | Mapping[str, object] | None = None, reason: str = ""
    ) -> None:
        """End the goal as succeeded."""
        self._end("SUCCEEDED", result, reason)

    def abort(
        self: LiveServerGoal[ActionGoal[M, R, F]], result: R | Mapping[str, object] | None = None, reason: str = ""
    ) -> None:
        """End the goal as aborted."""
        self._end("ABORTED", result, reason)

    def canceled(
        self: LiveServerGoal[ActionGoal[M, R, F]], result: R | Mapping[str, object] | None = None, reason: str = ""
    ) -> None:
        """End the goal as cancelled."""
        self._end("CANCELED", result, reason)

    def accept(self) -> None:
        """Accept the goal; done after the callback of the action."""
        if not self.is_done:
            self._link.post("update_goal", self._words("accept"))

    def continue_goal(self) -> None:
        """Continue the goal, although its cancellation was requested."""
        if not self.is_done:
            self.is_cancel_requested = False
            self._link.post("update_goal", self._words("continue"))

    def _end(self, change: str, result: Message, reason: str) -> None:
        words = self._words(change, reason)
        if change == "REJECTED":
            self._link.request("update_goal", words)
        else:
            content, type_name = self._encoded(result, "Result")
            self._link.request("update_goal", {**words, "type": type_name}, content)
        self.is_done = True
        self._action.goals.pop(self._number, None)

    def _words(self, change: str, reason: str = "") -> JsonObject:
        return {"number": self._action.number, "goal": self._number, "change": change, "reason": reason}

    def _encoded(self, value: Message, part: str) -> tuple[bytes, str]:
        type_name, name = f"{self._action.type_name}_{part}", self._action.name
        return msgs.serialize(checked_message(value, (type_name,), repr(name), none_is_default=True)), type_name


class LiveAction(LiveEndpoint):
    """Action whose goals this client executes while it receives.

    Attributes:
        goals: active goals by number.
    """

    def __init__(
        self,
        link: ServerLink,
        number: int,
        name: str,
        type_name: str,
        on_goal: Callable[[LiveServerGoal], object],
        on_cancel: Callable[[LiveServerGoal], bool | None] | None,
    ) -> None:
        super().__init__(link, number, name, type_name)
        self._on_goal, self._on_cancel = on_goal, on_cancel
        self.goals: dict[int, LiveServerGoal] = {}

    def take(self, words: JsonObject, data: bytes) -> None:
        """Queue a goal or a cancel request."""
        number = int(words["goal"])
        if words["tell"] == "goal_request":
            self._link.callbacks.append(lambda: self._execute(number, data))
        else:
            self._link.callbacks.append(lambda: self._cancel(number))
            if number in self.goals:
                self.goals[number].is_cancel_requested = True

    def _execute(self, number: int, data: bytes) -> None:
        request = msgs.deserialize(data, f"{self.type_name}_Goal")
        goal = self.goals[number] = LiveServerGoal(self._link, self, number, request)
        try:
            result = self._on_goal(goal)
            if goal.is_done:
                return
            if result is None:
                goal.accept()
            else:
                goal.succeed(result)
        except Exception as error:
            problem = raised(self._on_goal, "action", self.name, error)
            if not (goal.is_done or self._link.is_closed):
                goal.abort(reason=str(problem))
            raise problem from error

    def _cancel(self, number: int) -> None:
        goal = self.goals.get(number)
        if goal is None or self._on_cancel is None:
            return
        goal.is_cancel_requested = True
        try:
            if self._on_cancel(goal) is False:
                goal.continue_goal()
        except Exception as error:
            raise raised(self._on_cancel, "action", self.name, error) from error


class LiveInput(LiveSubscription[M]):
    """Command input of this client; its callback is called while the client receives."""

    def close(self) -> None:
        """Close the command input."""
        if not self._closed:
            self._closed = True
            self._link.subscriptions.pop(self.number, None)
            if not self._link.is_closed:
                self._link.request("close_endpoint", {"number": self.number})


class LiveParameter(LiveEndpoint, Generic[T]):
    """Parameter of this client.

    Attributes:
        node: node of the parameter.
        value: newest value that this client has received.
    """

    def __init__(
        self,
        link: ServerLink,
        number: int,
        name: str,
        node: str,
        value: T,
        on_change: Callable[[T], object] | None,
    ) -> None:
        super().__init__(link, number, name, type(value).__name__)
        self.node, self._on_change = node, on_change
        self.value: T = self._converted(value)

    def take(self, words: JsonObject, data: bytes) -> None:
        """Store a new value and queue the callback."""
        self.value = self._converted(words["value"])
        if self._on_change is not None:
            self._link.callbacks.append(lambda value=self.value: self._change(value))  # type: ignore[misc]

    @staticmethod
    def _converted(value: JsonValue) -> JsonValue:
        return tuple(value) if isinstance(value, list) else value

    def _change(self, value: T) -> None:
        assert self._on_change is not None
        try:
            self._on_change(value)
        except Exception as error:
            raise raised(self._on_change, "parameter", self.name, error) from error
