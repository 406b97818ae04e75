"""Services, actions, command inputs and parameters that a client offers to the simulation: the server's side.

The simulation never waits for a client. A hook only queues its requests here; the server sends them between two slices.
The answers of the client are calls into the simulation, between two steps, as from a script.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from simkit import msgs
from simkit.bridges.live.connection import MOST_OPEN, ClientConnection
from simkit.bridges.live.message_log import ClientSubscription, MessageLog
from simkit.bridges.live.protocol import TELL, JsonObject, LiveError
from simkit.errors import MessageError
from simkit.msgs.goal_status import GoalStatus
from simkit.msgs.message_types import Message

if TYPE_CHECKING:
    from simkit.bridges.live.topic_feed import TopicFeeds
    from simkit.runtime.communication.action_server import Action, GoalHandle
    from simkit.runtime.communication.endpoint_table import NamedClient
    from simkit.runtime.communication.parameter import Parameter
    from simkit.runtime.communication.publisher import Listener
    from simkit.runtime.communication.service_server import Service, ServiceCall
    from simkit.runtime.simulation import Simulation

Respond = Callable[[Message, str], None]
"""Function that receives the response of a service, or the text of an error."""


_FINAL = ("REJECTED", "SUCCEEDED", "ABORTED", "CANCELED")


class EndpointHost(Protocol):
    """Protocol of the server.

    Attributes:
        sim: simulation.
        feeds: topics that clients subscribe to.
        is_polling: True while `poll` processes data.
    """

    sim: Simulation
    feeds: TopicFeeds
    is_polling: bool

    def poll(self, wait: float = 0.0) -> bool:
        """Read the frames of clients, and send the data that is queued for them."""
        ...


class ClientEndpoint:
    """Endpoint that a client offers.

    Args:
        host: server.
        peer: connection of the client.
        number: number that the client chose for the endpoint.

    Attributes:
        node: node of the endpoint.
        opened: endpoint in the simulation.
    """

    opened: Any

    def __init__(self, host: EndpointHost, peer: ClientConnection, number: int) -> None:
        self._host, self.sim, self.peer, self._number = host, host.sim, peer, number
        self.node = peer.node_of(number)

    def send_due(self) -> None:
        """Send the client what the simulation has queued since the last call."""

    def close(self) -> None:
        """Close the endpoint in the simulation."""
        self.opened.close()

    def _refusal(self, waiting: int) -> str:
        """Return the reason for sending the client no further request; empty if one can be sent."""
        if self.peer.is_gone or self.peer.is_clogged:
            return f"the client {self.node!r} does not read its requests"
        return f"{MOST_OPEN} requests wait for the client {self.node!r}" if waiting >= MOST_OPEN else ""

    def _tell(self, tell: str, content: JsonObject, message: Message = None) -> None:
        words: JsonObject = {"tell": tell, "number": self._number, **content}
        if message is None:
            self.peer.send_json(TELL, words)
        else:
            self.peer.send_json(TELL, {**words, "type": msgs.type_name(message)}, msgs.serialize(message))
        self.peer.write()  # at once: the client may wait for nothing else


class ClientOfEndpoint:
    """Client that a program in another process has of a service or an action.

    Attributes:
        opened: client in the table of the simulation.
    """

    def __init__(self, opened: NamedClient) -> None:
        self.opened = opened

    def send_due(self) -> None:
        """Do nothing: requests and goals are sent apart."""

    def close(self) -> None:
        """Remove the client from the lists of nodes."""
        self.opened.close()


class ClientService(ClientEndpoint):
    """Service that a client answers; see `simkit.runtime.communication.service_server.RemoteServer`."""

    def __init__(self, host: EndpointHost, peer: ClientConnection, number: int, name: str, type_name: str) -> None:
        super().__init__(host, peer, number)
        self._queued: deque[ServiceCall] = deque()
        self._waiting: dict[int, Respond] = {}
        self._sent = 0
        offer = self.sim.communication.services.offer
        self.opened: Service = offer(name, type_name, lambda _: None, remote=self)

    @property
    def is_busy(self) -> bool:
        """True while the server processes data: no code may wait for more data."""
        return self._host.is_polling

    def send(self, call: ServiceCall) -> None:
        """Queue a call of the simulation."""
        self._queued.append(call)

    def wait(self, seconds: float) -> bool:
        """Exchange data with all clients for up to some wall time [s]."""
        self._host.poll(min(seconds, 0.05))
        return True

    def send_due(self) -> None:
        """Send the queued calls of the simulation."""
        while self._queued:
            self._forward_call(self._queued.popleft())

    def _forward_call(self, call: ServiceCall) -> None:
        finish = self.sim.communication.services.finish
        self.forward(call.request, lambda response, error: finish(call, response, error))

    def forward(self, request: Message, respond: Respond) -> None:
        """Send a request to the client.

        Args:
            request: request message.
            respond: function that receives the response, or the text of an error.
        """
        refusal = self._refusal(len(self._waiting))
        if refusal:
            respond(None, f"service {self.opened.name!r} gives no response: {refusal}")
            return
        self._sent += 1
        self._waiting[self._sent] = respond
        self._tell("request", {"call": self._sent}, request)

    def respond(self, number: int, response: Message, error: str) -> None:
        """Process the client's response to a request.

        Raises:
            MessageError: the response does not fit the type of the service; the caller receives the error too.
        """
        respond = self._waiting.pop(number, None)
        if respond is None:
            raise LiveError("SK-LIVE-008", f"no request {number} waits for a response of {self.opened.name!r}")
        try:
            checked = None if error else self.opened.response(response)
        except MessageError as problem:
            respond(None, f"client {self.node!r}: {problem}")
            raise
        respond(checked, error and f"client {self.node!r}: {error}")

    def close(self) -> None:
        """Close the service; callers that wait for a response receive an error."""
        self.opened.close()
        waiting, self._waiting = self._waiting, {}
        for respond in waiting.values():
            respond(None, f"service {self.opened.name!r} of {self.node!r} was closed before it answered")


class ClientAction(ClientEndpoint):
    """Action whose goals a client executes.

    Args:
        host: server.
        peer: connection of the client.
        number: number that the client chose for the endpoint.
        name: name of the action.
        type_name: action type.
        cancels: True if the client decides about cancel requests; else every goal continues.
    """

    def __init__(
        self, host: EndpointHost, peer: ClientConnection, number: int, name: str, type_name: str, cancels: bool
    ) -> None:
        super().__init__(host, peer, number)
        self._queued: deque[tuple[str, GoalHandle]] = deque()
        self._goals: dict[int, GoalHandle] = {}
        self._sent = 0
        act, queue = self.sim.communication.actions.act, self._queued.append
        on_cancel = (lambda goal: queue(("goal_cancel", goal))) if cancels else None
        self.opened: Action = act(
            name, type_name, lambda goal: queue(("goal_request", goal)), on_cancel, node=self.node
        )

    def send_due(self) -> None:
        """Send the new goals and the cancel requests."""
        while self._queued:
            tell, goal = self._queued.popleft()
            if goal.is_done or not self.opened.knows(goal):
                continue
            if tell == "goal_cancel":
                for number in [number for number, other in self._goals.items() if other is goal]:
                    self._tell(tell, {"goal": number})
                continue
            self._goals = {
                n: other for n, other in self._goals.items() if not other.is_done and self.opened.knows(other)
            }
            refusal = self._refusal(len(self._goals))
            if refusal:
                goal.reject(refusal)
                continue
            self._sent += 1
            self._goals[self._sent] = goal
            self._tell(tell, {"goal": self._sent}, goal.request)

    def update(self, number: int, change: str, message: Message, reason: str) -> None:
        """Apply a change that the client made to a goal.

        Args:
            number: number of the goal.
            change: `accept`, `continue`, `feedback`, or the name of a final status.
            message: feedback or result; None without one.
            reason: text about the end of the goal.

        Raises:
            ActionError: the goal has ended.
            MessageError: the message does not fit the type of the action.
        """
        goal = self._goals.get(number)
        if goal is None:
            raise LiveError("SK-LIVE-008", f"no goal {number} of {self.opened.name!r} is active")
        if change not in ("accept", "continue", "feedback", *_FINAL):
            raise LiveError("SK-LIVE-008", f"unknown change {change!r:.80} of a goal")
        if change == "REJECTED":
            goal.reject(reason)
        elif self.opened.knows(goal):
            goal.accept()
        if change == "feedback":
            goal.publish_feedback(message)
        elif change == "continue":
            goal.continue_goal()
        elif change in _FINAL and change != "REJECTED":
            goal.end(GoalStatus[change], message, reason)


class ClientInput(ClientEndpoint):
    """Command input whose messages a client receives.

    Args:
        host: server.
        peer: connection of the client.
        number: number that the client chose for the endpoint.
        topic: name of the topic.
        types: accepted types.
        depth: highest number of queued messages.
    """

    def __init__(
        self, host: EndpointHost, peer: ClientConnection, number: int, topic: str, types: list[str], depth: int
    ) -> None:
        super().__init__(host, peer, number)
        self._subscribed = ClientSubscription(peer, number, topic, depth)
        self._log = MessageLog(host.feeds.memory)
        self.opened: Listener = self.sim.communication.listen(topic, types, self._take, records=False)
        self._log.add(self._subscribed)

    def _take(self, message: Message) -> None:
        try:
            data = msgs.serialize(message)
        except MessageError:
            self._log.count_lost()
        else:
            self._log.append(self.sim.time_ns, msgs.type_name(message), data)

    def close(self) -> None:
        """Close the command input, and drop its queued messages."""
        self.opened.close()
        self.peer.drop_waiting(self._subscribed)
        self._subscribed.close()


class ClientParameter(ClientEndpoint):
    """Live parameter of a client; the client receives each new value."""

    def __init__(self, host: EndpointHost, peer: ClientConnection, number: int, parameter: Parameter[Any]) -> None:
        super().__init__(host, peer, number)
        communication = self.sim.communication
        communication.live_parameters.declare(communication.services, parameter)
        self.opened: Parameter[Any] = parameter
        self._sent = parameter.value

    def send_due(self) -> None:
        """Send the value if it has changed."""
        value = self.opened.value
        if value != self._sent and not self.peer.is_clogged:
            self._sent = value
            self._tell("parameter", {"value": value})

    def close(self) -> None:
        """Remove the parameter."""
        self.sim.communication.live_parameters.remove(self.opened)
