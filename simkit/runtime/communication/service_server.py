"""Services within the process: requests and responses with the types of ROS 2.

    sim.call("/world/office/control", {"world_control": {"pause": True}})
    sim.offer("/robot/home", "std_srvs/srv/Trigger", lambda request: {"success": True})

A bridge to ROS 2 only has to forward requests and responses.
"""

from __future__ import annotations

from collections.abc import Callable

from simkit.argument_checks import check_function, check_text
from simkit.errors import PluginError, ServiceError, SimkitError
from simkit.msgs.topic_names import absolute_name
from simkit.runtime.communication.endpoint_table import EndpointTable, as_message
from simkit.runtime.communication.subscription import Message
from simkit.runtime.engine.plugin_faults import call_plugin

ServiceHandler = Callable[[Message], Message]


class Service:
    """One service.

    Attributes:
        name: absolute name.
        type_name: service type, such as `std_srvs/srv/Trigger`.
        handler: function that receives a request and returns the response: a message, a dict of its fields, or None for
            a message whose fields are all zero.
        owner: plugin, sensor or None; the service exists as long as its owner.
        active: True if the owner is in the world.
        yields: True if another service of the same name may replace it.
    """

    __slots__ = ("active", "handler", "name", "owner", "type_name", "yields")

    def __init__(self, name: str, type_name: str, handler: ServiceHandler, owner: object) -> None:
        self.name, self.type_name, self.handler, self.owner = name, type_name, handler, owner
        self.active, self.yields = True, False

    def __deepcopy__(self, memo: dict[int, object]) -> Service:
        return self


class ServiceTable(EndpointTable[Service]):
    """All services of a simulation.

    Args:
        bus: topic bus, which records the owner of each new service.
        engine: engine that calls plugins.
    """

    kind, part, error = "service", "Request", ServiceError

    def offer(self, name: str, type_name: str, handler: ServiceHandler) -> Service:
        """Open a service. A service that is opened within `bus.owned_by(owner)` belongs to that owner.

        Raises:
            ServiceError: a service of that name exists.
            MessageError: the type is unknown.
        """
        self._engine.check_open()
        name = absolute_name(name)
        check_text(type_name, "type_name")
        check_function(handler, "handler")
        self._check_type(type_name)
        existing = self._find(name)
        if existing is not None and not existing.yields:
            raise ServiceError(f"a service {name!r} exists already, {_describe_owner(existing)}")
        with self._bus.passing("offer", service=name):
            service = Service(name, type_name, handler, self._bus.owner)
            self._endpoints.setdefault(name, []).insert(0, service)
        return service

    def offer_by_default(self, name: str, type_name: str, handler: ServiceHandler) -> None:
        """Open a service that any other service of the same name replaces."""
        name = absolute_name(name)
        service = Service(name, type_name, handler, self._bus.owner)
        service.yields = True
        self._endpoints.setdefault(name, []).append(service)

    def close(self, service: Service) -> None:
        """Remove a service permanently."""
        offered = self._endpoints.get(service.name, [])
        if service in offered:
            offered.remove(service)

    def call(self, name: str, request: Message = None) -> Message:
        """Call a service and return its response.

        Args:
            name: name of the service; a missing leading slash is added.
            request: message, dict of its fields, or None for a message whose fields are all zero.

        Raises:
            ServiceError: no such service; the message suggests the closest name.
            MessageError: the request or the response does not fit the type.
            PluginError: the service of a plugin raised.
        """
        self._engine.check_open()
        service = self._get(absolute_name(name))
        message = as_message(service, request, self.part)
        with self._bus.passing("call", service=service, request=message):
            return self._answer(service, message)

    def _answer(self, service: Service, request: Message) -> Message:
        owner, hook = service.owner, f"service {service.name}"
        try:
            response = call_plugin(owner, hook, service.handler, request)
            return as_message(service, response, "Response")
        except SimkitError:
            raise
        except Exception as error:
            if owner is None:
                raise
            name, where = getattr(owner, "name", "") or service.name, str(getattr(owner, "where", ""))
            if hasattr(owner, "on_error"):
                self._engine.faults.meet(owner, hook, error)
                raise ServiceError(f"service {service.name!r} raised, and plugin {name!r} is disabled") from error
            raise PluginError(name, hook, self._engine.time, where, repr(error)) from error


def _describe_owner(service: Service) -> str:
    owner = service.owner
    if owner is None:
        return f"of type {service.type_name}"
    return f"of plugin {getattr(owner, 'name', '')!r} ({getattr(owner, 'where', '')})"
