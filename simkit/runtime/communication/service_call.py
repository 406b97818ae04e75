"""Services, calls whose response comes later, and the interface to processes that offer services."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Protocol

from simkit.errors import ServiceError
from simkit.in_process import InProcess
from simkit.msgs.message_arguments import checked_message
from simkit.runtime.communication.subscription import Message

NO_ANSWER: Final = "SK-SERVICE-010"
"""Code of the error for a service of another process that gives no answer."""
WAIT_IN_CALLBACK: Final = "SK-SERVICE-011"
"""Code of the error for a callback that would wait for another process."""

ServiceHandler = Callable[[Message], Message]

CallEnd = Callable[["ServiceCall"], object]
"""Function that receives a call that has ended."""


class RemoteServer(Protocol):
    """Other process that offers a service.

    Attributes:
        node: name of the process in error messages.
        is_busy: True while data of other processes is processed, so that no code may wait for more data.
    """

    node: str

    @property
    def is_busy(self) -> bool: ...

    def send(self, call: ServiceCall) -> None:
        """Queue a call. `ServiceTable.finish` gives its response."""

    def wait(self, seconds: float) -> None:
        """Exchange data with other processes for up to `seconds` of wall time; return when some data arrived."""


class ServiceCloser(Protocol):
    """Table of services."""

    def close(self, endpoint: Service) -> None:
        """Remove a service permanently."""


class Service(InProcess):
    """One service.

    Attributes:
        name: absolute name.
        type_name: service type, such as `std_srvs/srv/Trigger`.
        handler: function that receives a request and returns the response: a message, a dict of its fields, or None for
            a message whose fields are all zero.
        owner: plugin, sensor or None; the service exists as long as its owner.
        active: True if the owner is in the world.
        yields: True if another service of the same name may replace it.
        remote: other process that answers; None for a service of this process.
    """

    __slots__ = ("_table", "active", "handler", "name", "owner", "remote", "type_name", "yields")

    def __init__(
        self,
        table: ServiceCloser,
        name: str,
        type_name: str,
        handler: ServiceHandler,
        owner: object,
        remote: RemoteServer | None = None,
    ) -> None:
        self._table, self.remote = table, remote
        self.name, self.type_name, self.handler, self.owner = name, type_name, handler, owner
        self.active, self.yields = True, False

    def close(self) -> None:
        """Close the service permanently."""
        self._table.close(self)

    def response(self, value: Message) -> Message:
        """Return a response of the service's type: a message, or a message of a dict's fields, or of no fields.

        Raises:
            MessageError: the value does not fit the type.
        """
        types = (f"{self.type_name}_Response",)
        return checked_message(value, types, f"response of {self.name!r}", none_is_default=True)

    def __repr__(self) -> str:
        return f"<Service {self.name!r} {self.type_name}>"


class ServiceCall(InProcess):
    """Call of a service whose response comes later.

    Attributes:
        id: 1, 2, … in the order in which calls began.
        service: service.
        request: request message.
        response: response message; None before the end, and after an error.
        error: error of the service; None without one.
    """

    __slots__ = ("error", "id", "is_done", "on_done", "request", "response", "service")

    def __init__(self, number: int, service: Service, request: Message, on_done: CallEnd | None) -> None:
        self.id, self.service, self.request, self.on_done = number, service, request, on_done
        self.response: Message = None
        self.error: ServiceError | None = None
        self.is_done = False

    def end(self, response: Message, error: ServiceError | None) -> None:
        """Store the response or the error."""
        self.response, self.error, self.is_done = response, error, True

    def __repr__(self) -> str:
        state = "waits" if not self.is_done else "failed" if self.error is not None else "done"
        return f"<ServiceCall {self.id} of {self.service.name!r}: {state}>"
