"""Actions of programs, and their clients, over the actions of the simulation.

An action of a program is one of another process for the simulation: it accepts a goal later than it receives it.
Scripts, plugins, tools and other programs send goals to it like to any other action. A client of a program can use
every action of the simulation.
"""

from __future__ import annotations

import hashlib
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Final, Protocol
from weakref import WeakKeyDictionary

from simkit.msgs.goal_status import GoalStatus
from simkit_nodes.graph_endpoints import GraphEndpoint, GraphTable, OutsideTable

if TYPE_CHECKING:
    from simkit.msgs import Message
    from simkit_nodes.graph import Graph, GraphNode

CANCEL_ACCEPTED: Final = 0
CANCEL_REJECTED: Final = 1
CANCEL_UNKNOWN_GOAL: Final = 2
CANCEL_GOAL_ENDED: Final = 3
"""Return codes of `action_msgs/srv/CancelGoal`."""

OnCancelled = Callable[[int, bool], None]
"""Function that receives the return code of a cancel request, and whether the goal is being cancelled."""


class OutsideAction(Protocol):
    """Action of a simulation.

    Attributes:
        name: absolute name.
    """

    name: str

    def knows(self, goal: object) -> bool:
        """Check whether no reset or restore has undone a goal."""

    def close(self) -> None:
        """Close the action."""


class OutsideGoal(Protocol):
    """Goal of an action; see `simkit.runtime.communication.action_server.GoalHandle`.

    Attributes:
        id: number of the goal.
        request: goal message.
        status: present status.
        result: result message; None before the end.
        reason: text about the end of the goal.
    """

    id: int
    request: Message
    status: GoalStatus
    result: Message
    reason: str

    @property
    def action(self) -> OutsideAction:
        """Action of the goal."""

    @property
    def is_done(self) -> bool:
        """True after the end of the goal."""

    def cancel(self) -> None:
        """Request the cancellation."""

    def accept(self) -> None:
        """Accept the goal."""

    def reject(self, reason: str = "") -> None:
        """Reject the goal."""

    def continue_goal(self) -> None:
        """Continue a goal whose cancellation was requested."""

    def publish_feedback(self, feedback: Message) -> None:
        """Send feedback."""

    def end(self, status: GoalStatus, result: Message = None, reason: str = "") -> None:
        """End the goal with a final status."""


class OutsideActions(OutsideTable, Protocol):
    """Actions of a simulation, in this process or in another one; see `ActionTable`."""

    def act(
        self,
        name: str,
        type_name: str,
        on_goal: Callable[[Any], None],
        on_cancel: Callable[[Any], None],
        *,
        node: str,
    ) -> Any:
        """Open an action whose goals a program accepts later; return it."""

    def send(
        self,
        name: str,
        goal: Message,
        on_feedback: Callable[[Message], None],
        on_done: Callable[[Any], None],
        *,
        on_accept: Callable[[Any], None],
    ) -> Any:
        """Send a goal and return its handle."""


class GraphGoal:
    """Goal that a program executes.

    Attributes:
        request: goal message of simkit.
        id: 16 bytes, from the client; for a client outside the programs a function of seed, action and number.
    """

    def __init__(self, handle: OutsideGoal, goal_id: bytes) -> None:
        self._handle, self.id = handle, goal_id
        self.request: Message = handle.request

    @property
    def _is_known(self) -> bool:
        """True if the goal has not ended, and no reset or restore has undone it."""
        return not self._handle.is_done and self._handle.action.knows(self._handle)

    def accept(self) -> None:
        """Accept the goal."""
        if self._is_known:
            self._handle.accept()

    def reject(self, reason: str = "the program rejected the goal") -> None:
        """Reject the goal."""
        if self._is_known:
            self._handle.reject(reason)

    def publish_feedback(self, feedback: Message) -> None:
        """Send feedback, a message of simkit."""
        self._handle.publish_feedback(feedback)

    def end(self, status: int, result: Message, reason: str = "") -> None:
        """End the goal with a final status of `action_msgs/msg/GoalStatus` and a result."""
        if self._is_known:
            self._handle.end(GoalStatus(status), result, reason)


class GraphCancel:
    """Cancel request that waits for a decision of a program.

    Attributes:
        id: 16 bytes of the goal.
    """

    def __init__(self, server: GraphActionServer, handle: OutsideGoal, goal_id: bytes) -> None:
        self._server, self.handle, self.id = server, handle, goal_id
        self.waiting: list[OnCancelled] = []

    def accept(self) -> None:
        """Accept the request; the program then ends the goal."""
        self._decide(is_cancelled=True)

    def reject(self) -> None:
        """Reject the request; the goal continues."""
        self.handle.continue_goal()
        self._decide(is_cancelled=False)

    def _decide(self, *, is_cancelled: bool) -> None:
        self._server.undecided.remove(self)
        for respond in self.waiting:
            respond(CANCEL_ACCEPTED, is_cancelled)  # rclpy sends this code in both cases
        self.waiting.clear()


class GraphActionServer(GraphEndpoint):
    """Action of a program; see `GraphNode.act`.

    Attributes:
        result_timeout_ns: time for which the result of a goal is kept [ns].
        undecided: cancel requests that the program has not answered.
    """

    def __init__(
        self, node: GraphNode, name: str, type_name: str, result_timeout_ns: int, on_request: Callable[[], None] | None
    ) -> None:
        super().__init__(node, name, type_name)
        self.result_timeout_ns = result_timeout_ns
        self._on_request = on_request or node.graph.wake
        self._goals: deque[GraphGoal] = deque()
        self._cancels: deque[GraphCancel] = deque()
        self.undecided: list[GraphCancel] = []

    @property
    def has_request(self) -> bool:
        """True if a goal or a cancel request waits."""
        return bool(self._goals or self._cancels)

    def take_goal(self) -> GraphGoal | None:
        """Return the oldest goal that waits; None without one."""
        return self._goals.popleft() if self._goals else None

    def take_cancel(self) -> GraphCancel | None:
        """Return the oldest cancel request that waits; None without one."""
        return self._cancels.popleft() if self._cancels else None

    def receive_goal(self, handle: OutsideGoal) -> None:
        """Put a goal into the queue, after the latency of the program."""
        goal = GraphGoal(handle, self.node.graph.action_table.id_of(handle))
        self._delay.call(partial(self._put, self._goals, goal))

    def receive_cancel(self, handle: OutsideGoal) -> None:
        """Put a cancel request into the queue, after the latency of the program."""
        cancel = GraphCancel(self, handle, self.node.graph.action_table.id_of(handle))
        self.undecided.append(cancel)
        self._delay.call(partial(self._put, self._cancels, cancel))

    def _put(self, queue: deque[Any], item: object) -> None:
        if self.is_open:
            queue.append(item)
            self._on_request()

    def close(self) -> None:
        """Close the action; its goals are aborted."""
        if self.is_open:
            self.is_open = False
            self.node.graph.action_table.remove(self)


class GraphClientGoal:
    """Goal that a program has sent; see `GraphActionClient.send`.

    Attributes:
        id: 16 bytes.
        ended_ns: time of the end of the goal [ns]; None before.
    """

    def __init__(
        self,
        client: GraphActionClient,
        goal_id: bytes,
        on_feedback: Callable[[Message], None],
        on_accept: Callable[[bool, int], None],
        on_result: Callable[[int, Message], None],
    ) -> None:
        self._client, self.id = client, goal_id
        self._on_feedback, self._on_accept, self._on_result = on_feedback, on_accept, on_result
        self._is_accepted = False
        self.ended_ns: int | None = None
        self.handle: OutsideGoal | None = None

    @property
    def status(self) -> int:
        """Present status, a number of `action_msgs/msg/GoalStatus`."""
        status = GoalStatus.UNKNOWN if self.handle is None else self.handle.status
        return int(GoalStatus.UNKNOWN if status is GoalStatus.REJECTED else status)

    @property
    def reason(self) -> str:
        """Reason that the action gave for the end of the goal; empty without one."""
        return "" if self.handle is None else self.handle.reason

    @property
    def is_result_kept(self) -> bool:
        """False if the result is older than the time for which the program with the action keeps it."""
        server = None if self.handle is None else self._client.actions.server_of(self.handle.action)
        if server is None or self.ended_ns is None:
            return True
        return self._client.node.graph.now_ns() < self.ended_ns + server.result_timeout_ns

    def begin(self, _: object = None) -> None:
        """Receive the acceptance of the goal from the core."""
        if not self._is_accepted:
            self._is_accepted = True
            self._client.receive(partial(self._on_accept, True, self._client.node.graph.now_ns()))

    def receive_feedback(self, feedback: Message) -> None:
        """Receive feedback from the core; a plugin may send it while it still decides."""
        self.begin()
        self._client.receive(partial(self._on_feedback, feedback))

    def end(self, handle: OutsideGoal) -> None:
        """Receive the end of the goal from the core."""
        now = self._client.node.graph.now_ns()
        if handle.status is GoalStatus.REJECTED:
            self._client.receive(partial(self._on_accept, False, now))
            return
        self.begin()
        self.ended_ns = now
        self._client.receive(partial(self._on_result, int(handle.status), handle.result))

    def cancel(self, on_response: OnCancelled) -> None:
        """Request the cancellation of the goal; the response arrives in a later step."""
        respond = partial(self._respond, on_response)
        if self.handle is None:
            respond(CANCEL_UNKNOWN_GOAL, False)
        elif self.handle.is_done:
            respond(CANCEL_GOAL_ENDED, False)
        else:
            self.handle.cancel()
            self._client.actions.enqueue(partial(self._follow_cancel, self.handle, respond))

    def _follow_cancel(self, handle: OutsideGoal, respond: OnCancelled) -> None:
        """Respond to a cancel request that the action has received now, or let its program respond later."""
        server = self._client.actions.server_of(handle.action)
        for cancel in server.undecided if server is not None else ():
            if cancel.handle is handle:
                cancel.waiting.append(respond)
                return
        if handle.status in (GoalStatus.CANCELING, GoalStatus.CANCELED):
            respond(CANCEL_ACCEPTED, True)
        else:
            respond(CANCEL_GOAL_ENDED if handle.is_done else CANCEL_REJECTED, False)

    def _respond(self, on_response: OnCancelled, code: int, is_cancelled: bool) -> None:
        self._client.receive(partial(on_response, code, is_cancelled))


class GraphActionClient(GraphEndpoint):
    """Client of a program for an action; see `GraphNode.action_client`.

    Attributes:
        actions: actions of all programs.
    """

    def __init__(self, node: GraphNode, name: str, type_name: str) -> None:
        super().__init__(node, name, type_name)
        self.actions = node.graph.action_table
        self.actions.add_client(self)

    @property
    def is_ready(self) -> bool:
        """True if the client knows an action of its name and type."""
        return self.is_open and self.actions.is_known(self)

    def new_goal_id(self) -> bytes:
        """Return 16 bytes for a new goal; the same ones in every run with the same seed."""
        return self.actions.new_goal_id()

    def send(
        self,
        goal: Message,
        goal_id: bytes,
        on_feedback: Callable[[Message], None],
        on_accept: Callable[[bool, int], None],
        on_result: Callable[[int, Message], None],
    ) -> GraphClientGoal:
        """Send a goal; before `is_ready` it is lost, as in ROS.

        Args:
            goal: goal message of simkit.
            goal_id: 16 bytes that distinguish the goal from all others.
            on_feedback: function that receives each feedback message.
            on_accept: function that receives whether the goal is accepted, and the time of that [ns].
            on_result: function that receives the final status and the result.
        """
        sent = GraphClientGoal(self, goal_id, on_feedback, on_accept, on_result)
        if self.is_ready:
            sent.handle = self.actions.send(self.name, goal, sent)
        return sent

    def receive(self, function: Callable[[], None]) -> None:
        """Call a function of the program's client, after the latency of the program."""
        self._delay.call(partial(self._deliver, function))

    def _deliver(self, function: Callable[[], None]) -> None:
        if self.is_open:
            function()
            self.node.graph.wake()

    def close(self) -> None:
        """Close the client; its goals continue."""
        if self.is_open:
            self.is_open = False
            self.actions.remove_client(self)
        if self in self.node.endpoints:
            self.node.endpoints.remove(self)


class GraphActions(GraphTable[GraphActionServer, GraphActionClient, OutsideAction]):
    """Actions of all programs.

    Args:
        table: actions of the simulation.
        enqueue: function that calls a function after the requests to the simulation that wait.
        graph: graph of the programs.

    Attributes:
        enqueue: see above.
    """

    def __init__(self, table: OutsideActions, enqueue: Callable[[Callable[[], None]], None], graph: Graph) -> None:
        super().__init__(table, graph)
        self._table, self.enqueue, self._count = table, enqueue, 0
        self._ids: WeakKeyDictionary[OutsideGoal, bytes] = WeakKeyDictionary()

    def clear(self) -> None:
        """Begin anew with the identifiers of goals, because all programs begin anew."""
        self._count = 0

    def _open(self, name: str) -> None:
        """Open the oldest action of a name, unless there is one."""
        servers = self._servers.get(name)
        if servers and self._table.find(name) is None:
            server = servers[0]
            self._opened[name] = self._table.act(
                name, server.type_name, server.receive_goal, server.receive_cancel, node=server.node.name
            )

    def server_of(self, action: OutsideAction) -> GraphActionServer | None:
        """Return the program's action behind an action of the simulation; None for any other action."""
        if self._opened.get(action.name) is not action:
            return None
        return self._servers[action.name][0]

    def send(self, name: str, goal: Message, sent: GraphClientGoal) -> OutsideGoal:
        """Send a goal; the action receives it in the next step."""
        handle: OutsideGoal = self._table.send(name, goal, sent.receive_feedback, sent.end, on_accept=sent.begin)
        self._ids[handle] = sent.id
        return handle

    def id_of(self, handle: OutsideGoal) -> bytes:
        """Return the 16 bytes of a goal."""
        if handle not in self._ids:
            self._ids[handle] = self._hash(f"{handle.action.name} {handle.id}")
        return self._ids[handle]

    def new_goal_id(self) -> bytes:
        """Return 16 bytes for a goal of a program."""
        self._count += 1
        return self._hash(f"goal {self._count}")

    def _hash(self, name: str) -> bytes:
        """Return 16 bytes that are a function of a name and the seed of the run."""
        return hashlib.sha256(f"{self._graph.seed_of(name)}:{name}".encode()).digest()[:16]
