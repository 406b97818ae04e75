"""Services within the process: requests and responses with the types of ROS 2.

    sim.call("/world/office/control", {"world_control": {"pause": True}})
    sim.offer("/robot/home", "std_srvs/srv/Trigger", lambda request: {"success": True})

A service of another process answers later: `Service.remote` sends the request, and `ServiceTable.finish` receives the
response. The simulation does not wait for it.
"""

from __future__ import annotations

import time
from contextlib import suppress
from typing import TYPE_CHECKING

from simkit.argument_checks import check_function, checked_number
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
from simkit.msgs.topic_names import absolute_name
from simkit.runtime.communication.endpoint_table import EndpointTable
from simkit.runtime.communication.script_callback import ScriptCallback
from simkit.runtime.communication.service_call import (
    NO_ANSWER,
    WAIT_IN_CALLBACK,
    CallEnd,
    RemoteServer,
    Service,
    ServiceCall,
    ServiceHandler,
)
from simkit.runtime.communication.subscription import Message
from simkit.runtime.engine.plugin_faults import call_plugin

if TYPE_CHECKING:
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine

CallStates = tuple[int, tuple[ServiceCall, ...]]
"""Number of calls that began, and the calls that wait for a response of another process."""


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
        self, name: str, type_name: str, handler: ServiceHandler, *, remote: RemoteServer | None = None
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
        name = absolute_name(name)
        check_function(handler, "handler")
        self._check_type(type_name)
        is_last = self._report_clash(name)
        service = Service(self, name, type_name, handler, self._bus.owner, remote)
        if service.owner is None and remote is None:
            service.handler = ScriptCallback(self._bus, handler, "service", name, service.response)
        with self._bus.passing("offer", service=service):
            endpoints = self._endpoints.setdefault(name, [])
            endpoints.insert(len(endpoints) if is_last else 0, service)
        return service

    def offer_by_default(self, name: str, type_name: str, handler: ServiceHandler) -> None:
        """Open a service that any other service of the same name replaces."""
        name = absolute_name(name)
        service = Service(self, name, type_name, handler, self._bus.owner)
        service.yields = True
        self._endpoints.setdefault(name, []).append(service)

    # ------------------------------------------------------------------ calls

    def call(
        self, name: str, request: Message = None, timeout: float = 10.0, on_done: CallEnd | None = None
    ) -> Message:
        """Call a service and return its response.

        Args:
            name: name of the service; a missing leading slash is added.
            request: message, dict of its fields, or None for a message with default fields.
            timeout: longest wait for a service of another process [s], wall time.
            on_done: function that receives the call before the step after the response has arrived. With it, the method
                returns at once, with the `ServiceCall`.

        Raises:
            ServiceError: no such service; the message suggests the closest name. Or: another process does not answer,
                or a callback would wait for it.
            MessageError: the request does not fit the type.
            PluginError: the service of a plugin raised.
            SubscriberError: the function of a script that answers raised.
        """
        self._engine.check_open()
        service, message = self._service_for(absolute_name(name), request)
        timeout = checked_number(timeout, "timeout", 0.0, unit="s", finite=False)
        if on_done is not None:
            check_function(on_done, "on_done")
            return self._begin(service, message, on_done)
        if service.remote is not None:
            return self._wait_for(service.remote, service, message, timeout)
        with self._bus.passing("call", service=service, request=message):
            return self._answer(service, message)

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
        for service in (first, *(s for s in self._endpoints[name] if s.active and s.yields and s is not first)):
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
        """Give a call the response of another process, or the text of an error.

        Raises:
            MessageError: the response does not fit the service's type.
        """
        response = None if error else call.service.response(response)
        problem = ServiceError(error, NO_ANSWER) if error else None
        if self._waiting.get(call.id) is not call:
            call.end(response, problem)  # a reset or restore has undone the call
            return
        with self._bus.passing("finish_call", call=call.id, response=response, error=error):
            call.end(response, problem)
            del self._waiting[call.id]
            self._bus.enqueue(lambda: self._notify(call))

    def waiting(self, number: int) -> ServiceCall:
        """Return a call that waits for the response of another process."""
        return self._waiting[number]

    def _wait_for(self, remote: RemoteServer, service: Service, request: Message, timeout: float) -> Message:
        where = f"service {service.name!r} is offered by another process, {remote.node!r}"
        if self._engine.is_stepping or self._answering or remote.is_busy:
            text = f"{where}, and a callback cannot wait for its response\n    help: pass on_done=FUNCTION"
            raise ServiceError(f"{text}, which receives the response between two steps", WAIT_IN_CALLBACK)
        call = self._begin(service, request, None)
        end = time.monotonic() + timeout
        while not call.is_done and (left := end - time.monotonic()) > 0:
            remote.wait(left)
        if not call.is_done:
            self._waiting.pop(call.id, None)
            raise ServiceError(f"{where}, which did not answer within {timeout:g} s", NO_ANSWER)
        if call.error is not None:
            raise call.error
        return call.response

    def _complete(self, call: ServiceCall) -> None:
        """Answer a call that waited for the next step."""
        try:
            if not call.service.active:
                raise ServiceError(f"the service {call.service.name!r} was removed")
            call.end(self._answer(call.service, call.request), None)
        except InputError as error:
            call.end(None, error if isinstance(error, ServiceError) else ServiceError(str(error), error.code))
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

    def _end_requests(self, endpoint: Service) -> None:
        node = "" if endpoint.remote is None else f" of {endpoint.remote.node!r}"
        for call in [c for c in self._waiting.values() if c.service is endpoint]:
            self.finish(call, None, f"service {endpoint.name!r}{node} was closed before it answered")

    # ------------------------------------------------------------------ state

    def get_state(self) -> CallStates:
        """Return the calls that wait for a response of another process."""
        return self._begun, tuple(self._waiting.values())

    def set_state(self, state: CallStates) -> None:
        """Restore a state from `get_state`; responses that have arrived since then are delivered in the next step."""
        self._begun, calls = state
        self._waiting = {call.id: call for call in calls if not call.is_done}
        for call in calls:
            if call.is_done:
                self._bus.enqueue(lambda call=call: self._notify(call))  # type: ignore[misc]  # a default argument
