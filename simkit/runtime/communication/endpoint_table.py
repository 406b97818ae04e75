"""Tables of the services and actions of a simulation by name, with checks of their requests and goals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Protocol, TypeVar, cast

from simkit import msgs
from simkit.argument_checks import check_text
from simkit.diagnostics import NOWHERE, name_hint
from simkit.errors import ActionError, ServiceError
from simkit.in_process import InProcess
from simkit.msgs import Message
from simkit.msgs.message_arguments import checked_message
from simkit.msgs.message_types import interface_parts
from simkit.packs import is_shipped

if TYPE_CHECKING:
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine


class Endpoint(Protocol):
    """Service or action, which exists as long as its owner.

    Attributes:
        name: absolute name.
        active: True if the owner is in the world.
    """

    name: str
    active: bool

    @property
    def type_name(self) -> str:
        """Type, such as `std_srvs/srv/Trigger`."""

    @property
    def owner(self) -> object:
        """Owner: a plugin, a sensor or None."""


E = TypeVar("E", bound=Endpoint)


class NamedClient(InProcess):
    """Client that a program has of a service or an action; lists of nodes show it.

    Attributes:
        name: absolute name of the service or action.
        type_name: type of the service or action.
        node: full name of the node that has the client.
    """

    def __init__(self, clients: list[NamedClient], name: str, type_name: str, node: str) -> None:
        self._clients = clients
        self.name, self.type_name, self.node = name, type_name, node
        clients.append(self)

    def close(self) -> None:
        """Remove the client from the lists of nodes."""
        if self in self._clients:
            self._clients.remove(self)


class EndpointTable(Generic[E]):
    """All services or all actions of a simulation.

    Args:
        bus: topic bus, which records the owner of each new endpoint.
        engine: engine that calls plugins.

    Attributes:
        clients: clients that programs have, in the order in which they were opened.
    """

    article: ClassVar[str]
    kind: ClassVar[str]
    folder: ClassVar[str]
    part: ClassVar[str]
    error: ClassVar[type[ServiceError | ActionError]]

    def __init__(self, bus: TopicBus, engine: Engine) -> None:
        self._bus, self._engine = bus, engine
        self._endpoints: dict[str, list[E]] = {}
        self.clients: list[NamedClient] = []

    def open_client(self, name: str, type_name: str, *, node: str) -> NamedClient:
        """Note that a node of a program has a client; it has no effect on requests and goals."""
        return NamedClient(self.clients, name, type_name, node)

    def names(self) -> dict[str, str]:
        """Return the types by name, sorted, without unlisted services."""
        endpoints = ((name, self.find(name)) for name in sorted(self._endpoints))
        return {
            name: endpoint.type_name
            for name, endpoint in endpoints
            if endpoint is not None and getattr(endpoint, "is_listed", True)
        }

    def endpoints_of(self, owner: object) -> dict[str, E]:
        """Return the endpoints of an owner by name."""
        return {e.name: e for endpoints in self._endpoints.values() for e in endpoints if e.owner is owner}

    def close(self, endpoint: E) -> None:
        """Remove an endpoint permanently."""
        if endpoint in self._endpoints.get(endpoint.name, ()):
            with self._bus.passing("close", endpoint=endpoint):
                endpoint.active = False
                self._endpoints[endpoint.name].remove(endpoint)
                if not self._endpoints[endpoint.name]:
                    del self._endpoints[endpoint.name]
                self._end_requests(endpoint)

    def _end_requests(self, endpoint: E) -> None:
        """End the requests that a closed endpoint has not answered."""

    def set_active(self, owners: Sequence[object]) -> None:
        """Enable the endpoints of these owners and all endpoints without an owner; disable the others."""
        living = {id(owner) for owner in owners}
        for endpoint in (e for endpoints in self._endpoints.values() for e in endpoints):
            endpoint.active = endpoint.owner is None or id(endpoint.owner) in living

    def forget(self, owners: Sequence[object]) -> None:
        """Remove all endpoints of these owners permanently."""
        removed = {id(owner) for owner in owners}
        self._endpoints = {
            n: [e for e in endpoints if id(e.owner) not in removed] for n, endpoints in self._endpoints.items()
        }

    def _check_type(self, type_name: str) -> None:
        """Raise MessageError for an unknown type.

        The definition of a known type is read later, with the first message of the type.
        """
        check_text(type_name, "the type")
        if interface_parts(type_name) is None or f"/{self.folder}/" not in type_name:
            msgs.full_name(f"{type_name}_{self.part}")

    def _report_clash(self, name: str) -> bool:
        """Report that another endpoint has this name already; return false if there is none.

        For a plugin of simkit this is a warning, because the file names the endpoint and Gazebo continues, too. The new
        endpoint is then reached when the other one is removed. For a user's plugin this is an error of the file while
        the world is loaded, unless its policy is to be disabled.

        Raises:
            ServiceError, ActionError: a script, or a user's plugin during a run, opens an endpoint whose name is used.
        """
        existing, owner = self.find(name), cast("Any", self._bus.owner)
        if existing is None or getattr(existing, "yields", False):
            return False
        other = existing.owner
        whose = f", of type {existing.type_name}"
        if getattr(existing, "remote", None) is not None:
            whose = f", of another process, {existing.remote.node!r}"  # type: ignore[attr-defined]
        elif other is not None:
            whose = f", of plugin {getattr(other, 'name', '')!r} ({getattr(other, 'where', '')})"
        problem = f"{self.article} {self.kind} {name!r} exists already{whose}"
        params = getattr(owner, "params", None)
        title, where = getattr(owner, "name", ""), getattr(owner, "where", NOWHERE)
        hint = "give the plugins different names or namespaces, or a <remapping>"
        if params is not None and is_shipped(type(owner)):
            params.diagnostics.warning("SK-SERVICE-004", f"plugin {title!r} cannot be reached: {problem}", where, hint)
            return True
        if params is None:
            raise self.error(self.error.code, problem)
        text = f"plugin {title!r}: {problem}"
        if self._bus.refuses_clashes or owner.sim.engine.faults.policy(owner) == "disable":
            raise self.error(self.error.code, f"{text} ({where})", help=hint)
        params.diagnostics.error(self.error.code, text, where, hint)
        return True

    def find(self, name: str) -> E | None:
        """Return the active endpoint of that name; None without one."""
        return next((endpoint for endpoint in self._endpoints.get(name, ()) if endpoint.active), None)

    def count(self, name: str) -> int:
        """Return the number of active endpoints of a name, without those that another one replaces."""
        return sum(each.active and not getattr(each, "yields", False) for each in self._endpoints.get(name, ()))

    def types_of(self, name: str) -> list[str]:
        """Return the types of the active endpoints of a name; Gazebo Classic's names can have two."""
        return [endpoint.type_name for endpoint in self._endpoints.get(name, ()) if endpoint.active]

    def get(self, name: str) -> E:
        """Return the active endpoint of that name. If none exists, raise an error that suggests the closest name."""
        endpoint = self.find(name) or self.find(self._bus.remapping.new_name(name))  # plugins use their own names
        if endpoint is None:
            raise self.error(f"no {self.kind} {name!r}; {name_hint(name, self.names())}")
        return endpoint

    def checked(self, endpoint: E, value: Message) -> Message:
        """Convert a value to a request or goal: a message, a dict of its fields, or None for default fields.

        Raises:
            MessageError: the value does not fit the type.
        """
        return checked_message(value, (f"{endpoint.type_name}_{self.part}",), repr(endpoint.name), none_is_default=True)
