"""Services of programs, and their clients, over the services of the simulation.

A service of a program is one of another process for the simulation: the response comes later. Scripts, plugins, tools
and other programs call it like any other service. A client of a program can call every service of the simulation.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

from simkit_nodes.graph_endpoints import Closable, GraphEndpoint, GraphTable, OutsideTable

if TYPE_CHECKING:
    from simkit.errors import ServiceError
    from simkit.msgs import Message
    from simkit_nodes.graph import Graph, GraphNode

OnResponse = Callable[[Any], None]
"""Function that receives the response of a service, a message of simkit; or a `ServiceError` instead of it."""


class OutsideCall(Protocol):
    """Call of a service; see `simkit.runtime.communication.service_server.ServiceCall`.

    Attributes:
        request: request, a message of simkit.
        response: response, a message of simkit; None before it and after an error.
        error: error instead of a response; None without one.
    """

    request: Message
    response: Message
    error: ServiceError | None

    @property
    def is_done(self) -> bool:
        """True after the response or an error."""


class OutsideServices(OutsideTable, Protocol):
    """Services of a simulation, in this process or in another one; see `ServiceTable`."""

    def find(self, name: str) -> Any:
        """Return the service that a new one of the name would clash with; None without one."""

    def offer(self, name: str, type_name: str, handler: Callable[[Message], Message], *, remote: Any) -> Any:
        """Open a service whose calls `remote` receives; return it."""

    def begin(self, name: str, request: Message, on_done: Callable[[Any], None]) -> Any:
        """Begin a call; its response arrives later."""

    def finish(self, call: Any, response: Message, error: str = "") -> None:
        """Give a call its response, or the text of an error."""


class GraphRequest:
    """Request that waits for a response of a program.

    Attributes:
        message: request, a message of simkit.
    """

    def __init__(self, services: GraphServices, call: OutsideCall) -> None:
        self._services, self._call = services, call
        self.message: Message = call.request

    def answer(self, response: Message) -> None:
        """Send the response; without effect if the caller has been reset or the service was closed."""
        if not self._call.is_done:
            self._services.finish(self._call, response)

    def fail(self, reason: str) -> None:
        """Send an error instead of a response; ROS 2 has no such errors."""
        if not self._call.is_done:
            self._services.finish(self._call, None, reason)


class GraphService(GraphEndpoint):
    """Service of a program; see `GraphNode.offer`."""

    def __init__(self, node: GraphNode, name: str, type_name: str, on_request: Callable[[], None] | None) -> None:
        super().__init__(node, name, type_name)
        self._on_request = on_request or node.graph.wake
        self._queue: deque[GraphRequest] = deque()

    @property
    def has_request(self) -> bool:
        """True if a request waits."""
        return bool(self._queue)

    def take(self) -> GraphRequest | None:
        """Return the oldest request that waits; None without one."""
        return self._queue.popleft() if self._queue else None

    def receive(self, request: GraphRequest) -> None:
        """Put a request into the queue, after the latency of the program."""
        self._delay.call(partial(self._put, request))

    def _put(self, request: GraphRequest) -> None:
        if self.is_open:
            self._queue.append(request)
            self._on_request()

    def close(self) -> None:
        """Close the service; callers that wait receive an error."""
        if self.is_open:
            self.is_open = False
            self.node.graph.service_table.remove(self)


class _Server:
    """Program that answers the calls of a service; see `service_server.RemoteServer`.

    Attributes:
        node: full name of the node.
        is_busy: True while a program runs, which the answer may need.
    """

    def __init__(self, services: GraphServices, service: GraphService) -> None:
        self._services, self._service = services, service
        self.node = service.node.name

    @property
    def is_busy(self) -> bool:
        return self._services.is_running

    def send(self, call: OutsideCall) -> None:
        self._service.receive(GraphRequest(self._services, call))

    def wait(self, seconds: float) -> bool:
        """Run the programs, without a step."""
        self._services.run_programs()
        return False


class GraphClient(GraphEndpoint):
    """Client of a program; see `GraphNode.client`.

    Attributes:
        calls: number of calls.
    """

    def __init__(self, node: GraphNode, name: str, type_name: str) -> None:
        super().__init__(node, name, type_name)
        self._services = node.graph.service_table
        self.calls = 0
        self._services.add_client(self)

    @property
    def is_ready(self) -> bool:
        """True if the client knows a service of its name and type."""
        return self.is_open and self._services.is_known(self)

    def call(self, request: Message, on_response: OnResponse) -> int:
        """Send a request and return its number, which counts from 1.

        A request before `is_ready` is lost, as in ROS.

        Args:
            request: message of simkit.
            on_response: function that receives the response; or the error of a service that raised or was closed.
        """
        self.calls += 1
        if self.is_ready:
            self._services.begin(self.name, request, partial(self._receive, on_response))
        return self.calls

    def _receive(self, on_response: OnResponse, call: OutsideCall) -> None:
        if self.is_open:
            answer = call.response if call.error is None else call.error
            self._delay.call(partial(self._deliver, on_response, answer))

    def _deliver(self, on_response: OnResponse, response: Message | ServiceError) -> None:
        if self.is_open:
            on_response(response)
            self.node.graph.wake()

    def close(self) -> None:
        """Close the client; responses that have not arrived are lost."""
        if self.is_open:
            self.is_open = False
            self._services.remove_client(self)
        if self in self.node.endpoints:
            self.node.endpoints.remove(self)


class GraphServices(GraphTable[GraphService, GraphClient, Closable]):
    """Services of all programs.

    Args:
        table: services of the simulation.
        graph: graph of the programs.
        run_programs: function that runs the programs without a step.

    Attributes:
        is_running: True while a call of a script runs the programs.
    """

    def __init__(self, table: OutsideServices, graph: Graph, run_programs: Callable[[], None]) -> None:
        super().__init__(table, graph)
        self._table, self._run_programs = table, run_programs
        self.is_running = False

    def run_programs(self) -> None:
        """Run the programs without a step."""
        self.is_running = True
        try:
            self._run_programs()
        finally:
            self.is_running = False

    def _open(self, name: str) -> None:
        """Open the oldest service of a name, unless there is one; ROS, too, allows several of the same name."""
        offers = self._servers.get(name)
        present = self._table.find(name)
        if not offers or (present is not None and not present.yields):
            return
        service = offers[0]
        server = _Server(self, service)
        self._opened[name] = self._table.offer(name, service.type_name, lambda _: None, remote=server)

    def exists(self, name: str) -> bool:
        """Check whether there is a service of a name."""
        return bool(self._table.types_of(name))

    def begin(self, name: str, request: Message, on_done: Callable[[OutsideCall], None]) -> None:
        """Begin a call; its response arrives in a later step."""
        self._table.begin(name, request, on_done)

    def finish(self, call: OutsideCall, response: Message, error: str = "") -> None:
        """Give a call its response, or the text of an error."""
        self._table.finish(call, response, error)
