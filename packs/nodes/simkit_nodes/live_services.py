"""Services and actions of a simulation in another process, as the graph of a program uses them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from simkit import msgs
from simkit.bridges.simulation_link import SimulationLink
from simkit.errors import ServiceError
from simkit.msgs.goal_status import GoalStatus
from simkit.msgs.message_builder import builder_of

if TYPE_CHECKING:
    from simkit.live import LiveError
    from simkit.msgs import Message

_FINAL = {GoalStatus.SUCCEEDED: "SUCCEEDED", GoalStatus.ABORTED: "ABORTED", GoalStatus.CANCELED: "CANCELED"}

Report = Callable[[str], None]
Refused = Callable[[str, str, "LiveError"], None]
"""Function that receives the name and the node of a service or action that the simulation has refused, and why."""
JsonRow = dict[str, Any]


class LiveCall:
    """Call of a service, by a program or for one; see `OutsideCall`.

    Attributes:
        number: number of the call, from the simulation; 0 for a call by a program.
    """

    def __init__(self, request: Message, number: int = 0) -> None:
        self.request, self.number = request, number
        self.response: Message = None
        self.error: ServiceError | None = None
        self.is_done = False


class LiveEndpoint:
    """Service or action of a program.

    Args:
        link: connection to the simulation.
        number: number of the endpoint on the connection.
        name: absolute name.
        type_name: ROS 2 type.

    Attributes:
        is_open: False after `close`.
        yields: False: another service of the name does not take its place.
    """

    yields = False

    def __init__(self, link: SimulationLink, number: int, name: str, type_name: str) -> None:
        self.link, self.number, self.name, self.type_name = link, number, name, type_name
        self.is_open = True

    def close(self) -> None:
        """Close the endpoint."""
        self.is_open = False
        if self.link.endpoints.pop(self.number, None) is not None:
            self.link.ask("close_endpoint", {"number": self.number})


class LiveClient:
    """Client that a program has of a service or an action of the simulation, for lists of nodes.

    Args:
        link: connection to the simulation.
        kind: `service` or `action`.
        name: absolute name of the service or action.
        type_name: type of the service or action.
        node: full name of the node that has the client.
    """

    def __init__(self, link: SimulationLink, kind: str, name: str, type_name: str, node: str) -> None:
        self._link, self._number = link, link.next_number()
        link.ask("open_client", {"number": self._number, "kind": kind, "name": name, "type": type_name, "node": node})

    def close(self) -> None:
        """Remove the client from the lists of nodes."""
        self._link.ask("close_endpoint", {"number": self._number})


class LiveServices:
    """Services of a simulation in another process.

    Args:
        link: connection to the simulation.
        report: function that reports a problem to the user.
        refused: function that receives the services that the simulation has refused.

    Attributes:
        types: types of the services by name, as in the answer to the request `graph`.
    """

    def __init__(self, link: SimulationLink, report: Report, refused: Refused) -> None:
        self._link, self._report, self._refused = link, report, refused
        self.types: dict[str, str] = {}
        self._opened: dict[str, LiveEndpoint] = {}
        self._services: dict[LiveCall, LiveEndpoint] = {}

    def names(self) -> dict[str, str]:
        """Return the types of all services by name, sorted."""
        return dict(sorted(self.types.items()))

    def types_of(self, name: str) -> list[str]:
        """Return the type of a service; empty if there is none of the name."""
        return [self.types[name]] if name in self.types else []

    def find(self, name: str) -> LiveEndpoint | None:
        """Return the service of this process with a name; None without one. The simulation refuses any other clash."""
        service = self._opened.get(name)
        return service if service is not None and service.is_open else None

    def open_client(self, name: str, type_name: str, *, node: str) -> LiveClient:
        """Note a client of a program, for lists of nodes."""
        return LiveClient(self._link, "service", name, type_name, node)

    def offer(self, name: str, type_name: str, handler: Callable[[Message], Message], *, remote: Any) -> LiveEndpoint:
        """Open a service whose calls `remote` receives."""
        service = self._opened[name] = LiveEndpoint(self._link, self._link.next_number(), name, type_name)

        def take(words: JsonRow, data: bytes) -> None:
            call = LiveCall(msgs.deserialize(data, f"{type_name}_Request"), int(words["call"]))
            self._services[call] = service
            remote.send(call)

        open_endpoint(service, "offer", {"node": remote.node}, take, self._refused)
        return service

    def finish(self, call: LiveCall, response: Message, error: str = "") -> None:
        """Give a call its response, or the text of an error."""
        service = self._services.pop(call, None)
        if service is None or call.is_done:
            return
        call.is_done = True
        words: JsonRow = {"number": service.number, "call": call.number}
        if error:
            self._link.ask("respond", {**words, "error": error})
        else:
            words["type"] = f"{service.type_name}_Response"
            failed = partial(_report_error, self._report)
            self._link.ask("respond", words, msgs.serialize(response), failed=failed)

    def begin(self, name: str, request: Message, on_done: Callable[[LiveCall], None]) -> LiveCall:
        """Begin a call; its response arrives later."""
        call, type_name = LiveCall(request), msgs.type_name(request)
        response_type = type_name.removesuffix("_Request") + "_Response"

        def take(_: object, data: bytes) -> None:
            call.response, call.is_done = msgs.deserialize(data, response_type), True
            on_done(call)

        def fail(error: LiveError) -> None:
            call.error, call.is_done = ServiceError(error.code, str(error), shows_code=False), True
            on_done(call)

        self._link.ask("call", {"name": name, "type": type_name}, msgs.serialize(request), take, fail)
        return call


class LiveAction(LiveEndpoint):
    """Action of a program, or of the simulation; see `OutsideAction`."""

    def knows(self, goal: object) -> bool:
        """Return True: the simulation ignores changes of goals that a reset has undone."""
        return True


class LiveServerGoal:
    """Goal of an action of a program; see `OutsideGoal`.

    Args:
        action: action.
        number: number of the goal.
        request: goal message.
    """

    def __init__(self, action: LiveAction, number: int, request: Message) -> None:
        self.action, self.id, self.request = action, number, request
        self.status, self.result, self.reason = GoalStatus.UNKNOWN, None, ""

    @property
    def is_done(self) -> bool:
        """True after the end of the goal."""
        return self.status.is_final

    def accept(self) -> None:
        """Accept the goal."""
        self.status = GoalStatus.EXECUTING
        self._update("accept")

    def reject(self, reason: str = "") -> None:
        """Reject the goal."""
        self.status = GoalStatus.REJECTED
        self._update("REJECTED", reason=reason)

    def continue_goal(self) -> None:
        """Continue the goal, although its cancellation was requested."""
        if self.status is GoalStatus.CANCELING:
            self.status = GoalStatus.EXECUTING
            self._update("continue")

    def publish_feedback(self, feedback: Message) -> None:
        """Send feedback."""
        if not self.is_done:
            self._update("feedback", feedback)

    def end(self, status: GoalStatus, result: Message = None, reason: str = "") -> None:
        """End the goal with a final status."""
        self.status, self.result = status, result
        if result is None:
            result = builder_of(f"{self.action.type_name}_Result").default()
        self._update(_FINAL[status], result, reason)

    def cancel(self) -> None:
        """Note that a client requests the cancellation."""
        self.status = GoalStatus.CANCELING

    def _update(self, change: str, message: Message = None, reason: str = "") -> None:
        words: JsonRow = {"number": self.action.number, "goal": self.id, "change": change, "reason": reason}
        data = b""
        if message is not None:
            words["type"], data = msgs.type_name(message), msgs.serialize(message)
        self.action.link.ask("update_goal", words, data)


class LiveClientGoal:
    """Goal that a program has sent to an action of the simulation; see `OutsideGoal`.

    Args:
        actions: actions of the simulation.
        action: action.
        request: goal message.
        on_feedback: function that receives each feedback message.
        on_done: function that receives this goal after its end.
        on_accept: function that receives this goal when it is accepted.
    """

    def __init__(
        self,
        actions: LiveActions,
        action: LiveAction,
        request: Message,
        on_feedback: Callable[[Message], None],
        on_done: Callable[[Any], None],
        on_accept: Callable[[Any], None],
    ) -> None:
        self._actions, self.action, self.id, self.request = actions, action, action.number, request
        self._on_feedback, self._on_done, self._on_accept = on_feedback, on_done, on_accept
        self.status, self.reason = GoalStatus.UNKNOWN, ""
        self.result: Message = None

    @property
    def is_done(self) -> bool:
        """True after the end of the goal."""
        return self.status.is_final

    def cancel(self) -> None:
        """Request the cancellation."""
        self._actions.link.ask("cancel", {"number": self.id})

    def take(self, update: JsonRow, data: bytes) -> None:
        """Receive feedback, a status or a result."""
        message = msgs.deserialize(data, str(update["type"])) if "type" in update else None
        if "status" not in update:
            self._on_feedback(message)
            return
        self.status, self.reason = GoalStatus(int(update["status"])), str(update.get("reason", ""))
        if self.is_done:
            self._end(message)
        else:
            self._on_accept(self)  # a second call has no effect
        self._actions.call_waiting()

    def _end(self, result: Message) -> None:
        if result is None:
            result = builder_of(f"{self.action.type_name}_Result").default()
        self.result = result
        self._actions.link.goals.pop(self.id, None)
        self._on_done(self)

    def refuse(self, error: LiveError) -> None:
        """Receive that the simulation could not accept the goal."""
        self.status, self.reason = GoalStatus.REJECTED, str(error)
        self._end(None)


class LiveActions:
    """Actions of a simulation in another process.

    Args:
        link: connection to the simulation.
        refused: function that receives the actions that the simulation has refused.
        call_later: function that calls a function after a duration [s].

    Attributes:
        types: types of the actions by name, as in the answer to the request `graph`.
    """

    def __init__(
        self, link: SimulationLink, refused: Refused, call_later: Callable[[float, Callable[[], None]], None]
    ) -> None:
        self.link, self._refused, self._call_later = link, refused, call_later
        self.types: dict[str, str] = {}
        self._opened: dict[str, LiveAction] = {}
        self._waiting: list[Callable[[], None]] = []

    def names(self) -> dict[str, str]:
        """Return the types of all actions by name, sorted."""
        return dict(sorted(self.types.items()))

    def types_of(self, name: str) -> list[str]:
        """Return the type of an action; empty if there is none of the name."""
        return [self.types[name]] if name in self.types else []

    def find(self, name: str) -> LiveAction | None:
        """Return the action of this process with a name; None without one. The simulation refuses any other clash."""
        action = self._opened.get(name)
        return action if action is not None and action.is_open else None

    def open_client(self, name: str, type_name: str, *, node: str) -> LiveClient:
        """Note a client of a program, for lists of nodes."""
        return LiveClient(self.link, "action", name, type_name, node)

    def act(
        self,
        name: str,
        type_name: str,
        on_goal: Callable[[Any], None],
        on_cancel: Callable[[Any], None],
        *,
        node: str,
    ) -> LiveAction:
        """Open an action whose goals a program accepts later."""
        action = self._opened[name] = LiveAction(self.link, self.link.next_number(), name, type_name)
        goals: dict[int, LiveServerGoal] = {}

        def take(words: JsonRow, data: bytes) -> None:
            number = int(words["goal"])
            for ended in [key for key, goal in goals.items() if goal.is_done]:
                del goals[ended]
            if words["tell"] == "goal_request":
                goals[number] = LiveServerGoal(action, number, msgs.deserialize(data, f"{type_name}_Goal"))
                on_goal(goals[number])
            elif number in goals:
                goals[number].cancel()
                on_cancel(goals[number])

        open_endpoint(action, "act", {"node": node, "cancels": True}, take, self._refused)
        return action

    def send(
        self,
        name: str,
        goal: Message,
        on_feedback: Callable[[Message], None],
        on_done: Callable[[Any], None],
        *,
        on_accept: Callable[[Any], None],
    ) -> LiveClientGoal:
        """Send a goal and return its handle."""
        type_name = msgs.type_name(goal)
        action = LiveAction(self.link, self.link.next_number(), name, type_name.removesuffix("_Goal"))
        sent = LiveClientGoal(self, action, goal, on_feedback, on_done, on_accept)
        self.link.goals[sent.id] = sent.take
        args = {"name": name, "number": sent.id, "type": type_name}
        self.link.ask("goal", args, msgs.serialize(goal), failed=sent.refuse)
        return sent

    # ------------------------------------------------------------------ after a request

    def enqueue(self, function: Callable[[], None]) -> None:
        """Call a function after the next change of a goal, at the latest after a second.

        A cancel request reaches an action in the next step; its effect is the next status of the goal.
        """
        self._waiting.append(function)
        self._call_later(1.0, partial(self._call, function))

    def call_waiting(self) -> None:
        """Call the functions that wait for a change of a goal."""
        for function in tuple(self._waiting):
            self._call(function)

    def _call(self, function: Callable[[], None]) -> None:
        if function in self._waiting:
            self._waiting.remove(function)
            function()


def open_endpoint(
    endpoint: LiveEndpoint, question: str, args: JsonRow, take: Callable[[JsonRow, bytes], None], refused: Refused
) -> None:
    """Open a service or an action in the simulation.

    Args:
        endpoint: service or action.
        question: name of the request.
        args: `node`, and further arguments of the request.
        take: function that receives what the simulation sends to the endpoint.
        refused: function that is called if the simulation refuses the endpoint.
    """
    words = {"number": endpoint.number, "name": endpoint.name, "type": endpoint.type_name, **args}
    endpoint.link.endpoints[endpoint.number] = take

    def fail(error: LiveError) -> None:
        endpoint.link.endpoints.pop(endpoint.number, None)
        refused(endpoint.name, str(args["node"]), error)

    endpoint.link.ask(question, words, failed=fail)


def _report_error(report: Report, error: LiveError) -> None:
    report(str(error))
