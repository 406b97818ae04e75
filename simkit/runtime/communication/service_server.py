"""Services within the process: requests and responses with the types of ROS 2.

    sim.call("/world/office/control", {"world_control": {"pause": True}})
    sim.offer("/robot/home", "std_srvs/srv/Trigger", lambda request: {"success": True})

A service may answer later: its handler returns a `DeferredResponse`, to which the response is given in a later step.
A service of another process or program always answers later: `Service.remote` sends the request, and
`ServiceTable.finish` receives the response. The simulation does not wait for it.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final, Generic, Protocol

from simkit.argument_checks import check_function, checked_number
from simkit.deferred_response import DeferredResponse
from simkit.errors import (
    InputError,
    MessageError,
    PluginError,
    ServiceError,
    SimkitError,
    SubscriberError,
    callback_name,
    cause_text,
)
from simkit.in_process import InProcess
from simkit.msgs import Message
from simkit.msgs.message_arguments import checked_message, typed_message
from simkit.msgs.message_types import R, interface_type
from simkit.msgs.topic_names import absolute_name
from simkit.runtime.communication.endpoint_table import EndpointTable
from simkit.runtime.communication.script_callback import ScriptCallback
from simkit.runtime.engine.plugin_faults import call_plugin

if TYPE_CHECKING:
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine


NO_ANSWER: Final = "SK-SERVICE-010"
"""Code of the error for a service of another process that gives no answer."""
WAIT_IN_CALLBACK: Final = "SK-SERVICE-011"
"""Code of the error for a callback that would wait for another process."""
ANSWERS_LATER: Final = "SK-SERVICE-012"
"""Code of the error for a call that does not wait, of a service that answers in a later step."""

_USE_ON_DONE: Final = "pass on_done=FUNCTION, which receives the response between two steps"


ServiceHandler = Callable[[Message], "Message | DeferredResponse"]

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

    def wait(self, seconds: float) -> bool:
        """Exchange data with other processes for up to `seconds` of wall time; return when some data arrived.

        Returns:
            False if no response can arrive before the simulation has made a step.
        """


class Service(InProcess):
    """One service.

    Attributes:
        name: absolute name.
        type_name: service type, such as `std_srvs/srv/Trigger`.
        handler: function that receives a request and returns the response: a message, a dict of its fields, None for a
            message whose fields are all zero, or a `DeferredResponse`.
        owner: plugin, sensor or None; the service exists as long as its owner.
        active: True if the owner is in the world.
        yields: True if another service of the same name may replace it.
        is_listed: False for a service that lists of services omit.
        remote: other process that answers; None for a service of this process.
    """

    _internal_names = frozenset({"is_listed", "owner", "remote", "response", "wrap_handler", "yields"})

    __slots__ = ("_table", "active", "handler", "is_listed", "name", "owner", "remote", "type_name", "yields")

    def __init__(
        self,
        table: ServiceTable,
        name: str,
        type_name: str,
        handler: ServiceHandler,
        owner: object,
        remote: RemoteServer | None = None,
        *,
        yields: bool = False,
        is_listed: bool = True,
    ) -> None:
        self._table, self.remote, self.active, self.yields, self.is_listed = table, remote, True, yields, is_listed
        self.name, self.type_name, self.handler, self.owner = name, type_name, handler, owner

    def wrap_handler(self, wrap: Callable[[ServiceHandler], ServiceHandler]) -> None:
        """Replace the handler by a function of it."""
        self.handler = wrap(self.handler)

    def close(self) -> None:
        """Close the service permanently."""
        self._table.close(self)

    def response(self, value: Message) -> Message:
        """Return a response of the service's type: a message, or a message of a dict's fields, or of no fields.

        A `DeferredResponse` is returned as it is; its message is checked later.

        Raises:
            MessageError: the value does not fit the type.
        """
        if isinstance(value, DeferredResponse):
            return value
        types = (f"{self.type_name}_Response",)
        return checked_message(value, types, f"response of {self.name!r}", none_is_default=True)

    def __repr__(self) -> str:
        return f"<Service {self.name!r} {self.type_name}>"


class ServiceCall(InProcess, Generic[R]):
    """Call of a service whose response comes later; the type parameter is the class of the response.

    Attributes:
        id: 1, 2, … in the order in which calls began.
        service: service.
        request: request message.
        response: response message; None before the end, and after an error.
        error: error of the service; None without one.
    """

    _internal_names = frozenset({"end"})

    __slots__ = ("error", "id", "is_done", "on_done", "request", "response", "service")

    def __init__(self, number: int, service: Service, request: Message, on_done: CallEnd | None) -> None:
        self.id, self.service, self.request, self.on_done = number, service, request, on_done
        self.response: R | Any = None  # `Any` stands for None, so that a type checker asks for no check
        self.error: ServiceError | None = None
        self.is_done = False

    def end(self, response: Message, error: ServiceError | None) -> None:
        """Store the response or the error."""
        self.response, self.error, self.is_done = response, error, True

    def __repr__(self) -> str:
        state = "waits" if not self.is_done else "failed" if self.error is not None else "done"
        return f"<ServiceCall {self.id} of {self.service.name!r}: {state}>"


CallStates = tuple[int, tuple[ServiceCall, ...]]
"""Number of calls that began, and the calls that wait for their later response."""


class ServiceTable(EndpointTable[Service]):
    """All services of a simulation.

    Args:
        bus: topic bus, which records the owner of each new service.
        engine: engine that calls plugins.
    """

    article, kind, folder, part, error = "a", "service", "srv", "Request", ServiceError

    def __init__(self, bus: TopicBus, engine: Engine) -> None:
        super().__init__(bus, engine)
        self._begun = self._answering = 0
        self._waiting: dict[int, ServiceCall] = {}

    def offer(
        self, name: str, type_name: str | type, handler: ServiceHandler, *, remote: RemoteServer | None = None
    ) -> Service:
        """Open a service. A service that is opened within `bus.owned_by(owner)` belongs to that owner.

        Args:
            name: name of the service; a missing leading slash is added.
            type_name: service type, such as `std_srvs/srv/Trigger`.
            handler: function that receives a request and returns the response.
            remote: other process that answers instead of `handler`.

        Raises:
            ServiceError: a service of that name exists.
            MessageError: the type is unknown.
        """
        self._engine.check_open()
        name = self._bus.name_of(name)
        check_function(handler, "handler")
        type_name = interface_type(type_name, self.part)
        self._check_type(type_name)
        is_last = self._report_clash(name)
        service = Service(self, name, type_name, handler, self._bus.owner, remote)
        if service.owner is None and remote is None:
            service.wrap_handler(lambda call: ScriptCallback(self._bus, call, "service", name, service.response))
        with self._bus.passing("offer", service=service):
            endpoints = self._endpoints.setdefault(name, [])
            endpoints.insert(len(endpoints) if is_last else 0, service)
        return service

    def offer_by_default(self, name: str, type_name: str, handler: ServiceHandler, *, is_listed: bool = True) -> None:
        """Open a service that any other service of the same name replaces.

        Args:
            name: name of the service.
            type_name: service type.
            handler: function that receives a request and returns the response.
            is_listed: False for a service that lists of services omit.
        """
        name = self._bus.name_of(name)
        service = Service(self, name, type_name, handler, self._bus.owner, yields=True, is_listed=is_listed)
        self._endpoints.setdefault(name, []).append(service)

    # ------------------------------------------------------------------ calls

    def call(
        self,
        name: str,
        request: Message = None,
        timeout: float = 10.0,
        on_done: CallEnd | None = None,
        type_: str | type | None = None,
    ) -> Message:
        """Call a service and return its response.

        Args:
            name: name of the service; a missing leading slash is added.
            request: message, dict of its fields, or None for a message with default fields.
            timeout: longest wait for a service of another process [s], wall time.
            on_done: function that receives the call before the step after the response has arrived. With it, the method
                returns at once, with the `ServiceCall`.
            type_: type of the service, or class of the request; None for the type that the service has.

        Raises:
            ServiceError: no such service; the message suggests the closest name. Or: another process does not answer,
                or a callback would wait for it.
            MessageError: the request does not fit the type.
            PluginError: the service of a plugin raised.
            SubscriberError: the function of a script that answers raised.
        """
        self._engine.check_open()
        name = absolute_name(name)
        service, message = self._service_for(name, typed_message(request, type_, self.part, repr(name)))
        timeout = checked_number(timeout, "timeout", 0.0, unit="s", finite=False)
        if on_done is not None:
            check_function(on_done, "on_done")
            return self._begin(service, message, on_done)
        if service.remote is not None:
            return self._wait_for(service.remote, service, message, timeout)
        call = self._request(service, message)
        if not call.is_done:
            del self._waiting[call.id]
            text = f"service {service.name!r} answers in a later step, and this call does not wait"
            raise ServiceError(ANSWERS_LATER, text, help=_USE_ON_DONE, shows_code=False)
        if call.error is not None:
            raise call.error
        return call.response

    def request(self, name: str, request: Message) -> ServiceCall:
        """Call a service at once, also while the world is paused. The returned call is not done if it answers later.

        Raises:
            ServiceError, MessageError, PluginError, SubscriberError: as for `call`.
        """
        service, message = self._service_for(absolute_name(name), request)
        if service.remote is None:
            return self._request(service, message)
        call = self._begin(service, message, None)
        if not (self._engine.is_stepping or self._answering or service.remote.is_busy):
            service.remote.wait(0.0)
        return call

    def _request(self, service: Service, request: Message) -> ServiceCall:
        with self._bus.passing("call", service=service, request=request):
            answer = self._answer(service, request)
            if not isinstance(answer, DeferredResponse):
                call = ServiceCall(0, service, request, None)
                call.end(answer, None)
                return call
            self._begun += 1
            call = ServiceCall(self._begun, service, request, None)
            self._defer(call, answer)
        return call

    def _defer(self, call: ServiceCall, deferred: DeferredResponse) -> None:
        """Let a call wait for a deferred response."""

        def finish(response: Message, error: str) -> None:
            if not call.is_done:
                self.finish(call, response, error)

        self._waiting[call.id] = call
        deferred.connect(finish)

    def begin(self, name: str, request: Message, on_done: CallEnd | None = None) -> ServiceCall:
        """Begin a call without waiting for the response.

        Args:
            name: name of the service.
            request: request message.
            on_done: function that receives the call, before the step after the response has arrived.
        """
        service, message = self._service_for(absolute_name(name), request)
        return self._begin(service, message, on_done)

    def _service_for(self, name: str, request: Message) -> tuple[Service, Message]:
        """Return the service of a name and the request message.

        Gazebo Classic and `simulation_interfaces` have services of the same names. A request that fits only the other
        type goes to the other service.
        """
        first = self.get(name)
        for service in (first, *(s for s in self._endpoints[first.name] if s.active and s.yields and s is not first)):
            with suppress(MessageError):
                return service, self.checked(service, request)
        return first, self.checked(first, request)

    def _begin(self, service: Service, request: Message, on_done: CallEnd | None) -> ServiceCall:
        if self._bus.journal is not None:
            on_done = self._bus.journal.outside(on_done)
        with self._bus.passing("begin_call", service=service.name, request=request, on_done=on_done):
            self._begun += 1
            call = ServiceCall(self._begun, service, request, on_done)
            if service.remote is None:
                self._bus.enqueue(lambda: self._complete(call))
            else:
                self._waiting[call.id] = call
                service.remote.send(call)
        return call

    def finish(self, call: ServiceCall, response: Message, error: str = "") -> None:
        """Give a call its later response, or the text of an error.

        Raises:
            MessageError: the response does not fit the service's type.
        """
        response = None if error else call.service.response(response)
        problem = ServiceError(NO_ANSWER, error, shows_code=False) if error else None
        if self._waiting.get(call.id) is not call:
            call.end(response, problem)  # a reset or restore has undone the call
            return
        with self._bus.passing("finish_call", call=call.id, response=response, error=error):
            call.end(response, problem)
            del self._waiting[call.id]
            self._bus.enqueue(lambda: self._notify(call))

    def waiting(self, number: int) -> ServiceCall:
        """Return a call that waits for its later response."""
        return self._waiting[number]

    def _wait_for(self, remote: RemoteServer, service: Service, request: Message, timeout: float) -> Message:
        where = f"service {service.name!r} is offered by another process, {remote.node!r}"
        if self._engine.is_stepping or self._answering or remote.is_busy:
            text = f"{where}, and a callback cannot wait for its response"
            raise ServiceError(WAIT_IN_CALLBACK, text, help=_USE_ON_DONE, shows_code=False)
        call = self._begin(service, request, None)
        end = time.monotonic() + timeout
        can_answer = True
        while can_answer and not call.is_done and (left := end - time.monotonic()) > 0:
            can_answer = remote.wait(left)
        if not call.is_done:
            self._waiting.pop(call.id, None)
            if not can_answer:
                text = f"service {service.name!r} of node {remote.node!r} needs simulated time for its response"
                raise ServiceError(ANSWERS_LATER, text, help=_USE_ON_DONE, shows_code=False)
            raise ServiceError(NO_ANSWER, f"{where}, which did not answer within {timeout:g} s", shows_code=False)
        if call.error is not None:
            raise call.error
        return call.response

    def _complete(self, call: ServiceCall) -> None:
        """Answer a call that waited for the next step."""
        try:
            if not call.service.active:
                raise ServiceError(f"the service {call.service.name!r} was removed")
            answer = self._answer(call.service, call.request)
            if isinstance(answer, DeferredResponse):
                self._defer(call, answer)
                return
            call.end(answer, None)
        except ServiceError as error:
            call.end(None, error)
        except InputError as error:
            call.end(None, ServiceError(error.code, str(error), shows_code=False))
        self._notify(call)

    def _notify(self, call: ServiceCall) -> None:
        """Pass a call that has ended to the caller."""
        if call.on_done is None:
            return
        try:
            call.on_done(call)
        except Exception as error:
            if isinstance(error, SimkitError) and not isinstance(error, InputError):
                raise
            name, now = callback_name(call.on_done), self._engine.time
            raise SubscriberError(call.service.name, name, now, cause_text(error), "service") from error

    def _answer(self, service: Service, request: Message) -> Message:
        owner, hook = service.owner, f"service {service.name}"
        self._answering += 1
        try:
            return service.response(call_plugin(owner, hook, service.handler, request))
        except SimkitError:
            raise
        except Exception as error:
            name, where = getattr(owner, "name", "") or service.name, str(getattr(owner, "where", ""))
            if hasattr(owner, "on_error"):
                self._engine.faults.meet(owner, hook, error)
                raise ServiceError(f"service {service.name!r} raised, and plugin {name!r} is disabled") from error
            raise PluginError(name, hook, self._engine.time, where, cause_text(error)) from error
        finally:
            self._answering -= 1

    def abandon(self, owner: object, reason: str) -> None:
        """End the calls that wait for a disabled plugin."""
        for call in [c for c in self._waiting.values() if c.service.remote is None and c.service.owner is owner]:
            self.finish(call, None, reason)

    def abandon_gone(self) -> None:
        """End the calls that wait for a plugin that was removed from the world."""
        for call in [c for c in self._waiting.values() if not c.service.active]:
            self.finish(call, None, f"the service {call.service.name!r} was removed")

    def _end_requests(self, endpoint: Service) -> None:
        node = "" if endpoint.remote is None else f" of {endpoint.remote.node!r}"
        for call in [c for c in self._waiting.values() if c.service is endpoint]:
            self.finish(call, None, f"service {endpoint.name!r}{node} was closed before it answered")

    # ------------------------------------------------------------------ state

    def get_state(self) -> CallStates:
        """Return the calls that wait for their later response."""
        return self._begun, tuple(self._waiting.values())

    def set_state(self, state: CallStates) -> None:
        """Restore a state from `get_state`; responses that have arrived since then are delivered in the next step.

        A plugin is restored, too, and gives its responses again.
        """
        self._begun, calls = state
        for call in calls:
            if call.service.remote is None and call.service.owner is not None:
                call.response, call.error, call.is_done = None, None, False
        self._waiting = {call.id: call for call in calls if not call.is_done}
        for call in calls:
            if call.is_done:
                self._bus.enqueue(lambda call=call: self._notify(call))  # type: ignore[misc]  # a default argument
