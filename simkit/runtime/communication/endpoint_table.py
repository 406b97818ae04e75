"""Services and actions of a simulation by name: which of them are there, and the requests and goals that they take."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, ClassVar, Generic, Protocol, TypeVar

from simkit import msgs
from simkit.diagnostics import name_hint
from simkit.errors import ActionError, MessageError, ServiceError
from simkit.msgs.message_types import definition_files
from simkit.runtime.communication.subscription import Message

if TYPE_CHECKING:
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine


class Endpoint(Protocol):
    """A service or an action; it is there as long as its owner is.

    Attributes:
        name: absolute.
        active: whether its owner is in the world.
    """

    name: str
    active: bool

    @property
    def type_name(self) -> str:
        """Its type, such as `std_srvs/srv/Trigger`."""

    @property
    def owner(self) -> object:
        """Whose it is: a plugin, a sensor or None."""


E = TypeVar("E", bound=Endpoint)


class EndpointTable(Generic[E]):
    """All services or all actions of a simulation.

    Args:
        bus: knows who opens what.
        engine: calls plugins.
    """

    kind: ClassVar[str]
    part: ClassVar[str]
    error: ClassVar[type[ServiceError | ActionError]]

    def __init__(self, bus: TopicBus, engine: Engine) -> None:
        self._bus, self._engine = bus, engine
        self._endpoints: dict[str, list[E]] = {}

    def names(self) -> dict[str, str]:
        """Name -> type, sorted."""
        found = ((name, self._find(name)) for name in sorted(self._endpoints))
        return {name: endpoint.type_name for name, endpoint in found if endpoint is not None}

    def endpoints_of(self, owner: object) -> dict[str, E]:
        """Those of one owner by name."""
        return {one.name: one for opened in self._endpoints.values() for one in opened if one.owner is owner}

    def set_active(self, owners: Sequence[object]) -> None:
        """Leaves only those of these owners (and those without one) in use."""
        living = {id(owner) for owner in owners}
        for endpoint in (one for opened in self._endpoints.values() for one in opened):
            endpoint.active = endpoint.owner is None or id(endpoint.owner) in living

    def forget(self, owners: Sequence[object]) -> None:
        """Takes everything of these owners away for good."""
        gone = {id(owner) for owner in owners}
        self._endpoints = {n: [e for e in opened if id(e.owner) not in gone] for n, opened in self._endpoints.items()}

    def _check_type(self, type_name: str) -> None:
        """Raises MessageError for an unknown type; what is in its files is read when something comes."""
        if type_name not in definition_files():
            msgs.full_name(f"{type_name}_{self.part}")

    def _find(self, name: str) -> E | None:
        return next((one for one in self._endpoints.get(name, ()) if one.active), None)

    def _get(self, name: str) -> E:
        """The one of that name that is in use; the error without one names the closest."""
        found = self._find(name)
        if found is None:
            raise self.error(f"no {self.kind} {name!r}; {name_hint(name, self.names())}")
        return found

    def _as_message(self, endpoint: E, value: Message) -> Message:
        """The request or goal of a message, a dict of its fields, or None for all zero. Raises MessageError."""
        wanted = f"{endpoint.type_name}_{self.part}"
        message = msgs.from_dict([wanted], value or {}) if value is None or isinstance(value, Mapping) else value
        if msgs.type_name(message) != wanted:
            raise MessageError(f"{endpoint.name!r} takes {wanted}, got {msgs.type_name(message)}")
        return message
