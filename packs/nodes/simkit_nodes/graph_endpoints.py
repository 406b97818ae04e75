"""Common parts of the services and actions of programs: discovery, latency, and the tables of servers and clients."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

if TYPE_CHECKING:
    from simkit_nodes.graph import Graph, GraphNode


class Closable(Protocol):
    """Anything that a node has opened."""

    def close(self) -> None:
        """Close it."""


class Delay:
    """Delay of messages to a program by its latency; the order of the messages remains.

    Args:
        node: node of the program.
        name: name of the service or action.
    """

    def __init__(self, node: GraphNode, name: str) -> None:
        self.node, self.topic = node, name
        self._count = self._last_due = 0

    def call(self, function: Callable[[], None]) -> None:
        """Call a function after the latency, or at once without latency."""
        graph = self.node.graph
        self._count += 1
        now = graph.now_ns()
        due = max(self._last_due, now + graph.latency_ns(self, self._count))
        if due > now:
            self._last_due = due
            graph.call_at(due, function)
        else:
            function()


class GraphEndpoint(ABC):
    """Server or client of a program.

    Attributes:
        node: node that has opened it.
        name: absolute name of the service or action.
        type_name: type of the service or action.
        is_open: False after `close`.
        is_discovered: True after the discovery.
    """

    def __init__(self, node: GraphNode, name: str, type_name: str) -> None:
        self.node, self.name, self.type_name = node, name, type_name
        self._delay = Delay(node, name)
        self.is_open, self.is_discovered = True, False

    def discover(self) -> None:
        """Become known to other programs, or know the endpoints of other programs."""
        self.is_discovered = True
        self.node.graph.wake()

    @abstractmethod
    def close(self) -> None:
        """Close the endpoint."""


class OutsideTable(Protocol):
    """Services or actions of a simulation."""

    def names(self) -> dict[str, str]:
        """Return the types of all of them by name."""

    def types_of(self, name: str) -> list[str]:
        """Return the type of one; empty if there is none of the name."""

    def find(self, name: str) -> object:
        """Return the one that a new one of the name would clash with; None without one."""

    def open_client(self, name: str, type_name: str, *, node: str) -> Closable:
        """Note a client of a program, for lists of nodes."""


ServerT = TypeVar("ServerT", bound=GraphEndpoint)
ClientT = TypeVar("ClientT", bound=GraphEndpoint)
OpenedT = TypeVar("OpenedT", bound=Closable)


class GraphTable(ABC, Generic[ServerT, ClientT, OpenedT]):
    """Servers and clients of all programs for one kind of endpoint: services or actions.

    Args:
        outside: services or actions of the simulation.
        graph: graph of the programs.

    Attributes:
        clients: clients of the programs.
    """

    def __init__(self, outside: OutsideTable, graph: Graph) -> None:
        self._outside, self._graph = outside, graph
        self.clients: list[ClientT] = []
        self._servers: dict[str, list[ServerT]] = {}
        self._opened: dict[str, OpenedT] = {}
        self._noted: dict[ClientT, Closable] = {}

    @abstractmethod
    def _open(self, name: str) -> None:
        """Open the oldest server of a name in the simulation, unless the simulation has one."""

    def add(self, server: ServerT) -> None:
        """Open a server; other programs know it after the discovery."""
        self._servers.setdefault(server.name, []).append(server)
        self._open(server.name)
        self._graph.after_discovery(server.node, server.discover)

    def remove(self, server: ServerT) -> None:
        """Close a server; another one of the same name takes its place."""
        if server in server.node.endpoints:
            server.node.endpoints.remove(server)
        servers = self._servers.get(server.name, [])
        if server not in servers:
            return
        is_first = servers[0] is server
        servers.remove(server)
        if is_first and server.name in self._opened:
            self._opened.pop(server.name).close()
            self._open(server.name)

    def add_client(self, client: ClientT) -> None:
        """Add a client; it knows the servers of other programs after the discovery."""
        self.clients.append(client)
        self._noted[client] = self._outside.open_client(client.name, client.type_name, node=client.node.name)
        self._graph.after_discovery(client.node, client.discover)

    def remove_client(self, client: ClientT) -> None:
        """Remove a client."""
        self.clients.remove(client)
        self._noted.pop(client).close()

    def is_known(self, client: ClientT) -> bool:
        """Check whether a client knows a server of its name and type: that of its own program at once, as in ROS."""
        if client.type_name not in self._outside.types_of(client.name):
            return False
        opened = self._opened.get(client.name)
        is_of_program = opened is not None and opened is self._outside.find(client.name)
        server = self._servers[client.name][0] if is_of_program else None
        if server is not None and server.node.program is client.node.program:
            return True
        return client.is_discovered and (server is None or server.is_discovered)

    def names(self) -> dict[str, str]:
        """Return the types of all services or actions by name, sorted, also those of the simulation."""
        return self._outside.names()

    def of_node(self, name: str) -> list[tuple[str, str]]:
        """Return name and type of the servers of a node, sorted."""
        servers = [server for servers in self._servers.values() for server in servers]
        return sorted((server.name, server.type_name) for server in servers if server.node.name == name)

    def clients_of_node(self, name: str) -> list[tuple[str, str]]:
        """Return name and type of the services or actions of which a node has clients, sorted."""
        return sorted((client.name, client.type_name) for client in self.clients if client.node.name == name)
