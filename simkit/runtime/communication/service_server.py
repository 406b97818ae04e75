"""Services within the process: a request goes in, a response comes back, with the types that ROS 2 gives them.

    sim.call("/world/office/control", {"world_control": {"pause": True}})
    sim.offer("/robot/home", "std_srvs/srv/Trigger", lambda request: {"success": True})

A bridge has only to carry them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from simkit import msgs
from simkit.errors import PluginError, ServiceError, SimkitError
from simkit.runtime.communication.endpoint_table import EndpointTable
from simkit.runtime.communication.subscription import Message
from simkit.runtime.communication.topic_bus import absolute_name
from simkit.runtime.engine.plugin_faults import call_plugin

if TYPE_CHECKING:
    pass

ServiceHandler = Callable[[Message], Message]


class Service:
    """One service.

    Attributes:
        name: absolute.
        type_name: such as `std_srvs/srv/Trigger`.
        handler: given the request, gives the response: a message, a dict of its fields, or None for all zero.
        owner: whose it is: a plugin, a sensor or None; it is there as long as its owner is.
        active: whether its owner is in the world.
        yields: whether another one of its name may take its place.
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
        bus: knows who opens what.
        engine: calls plugins.
    """

    kind, part, error = "service", "Request", ServiceError

    def offer(self, name: str, type_name: str, handler: ServiceHandler) -> Service:
        """Opens a service; whatever opens it within `bus.owned_by(owner)` belongs to that owner.

        Raises:
            ServiceError: there is one of that name.
            MessageError: an unknown type.
        """
        name = absolute_name(name)
        self._check_type(type_name)
        standing = self._find(name)
        if standing is not None and not standing.yields:
            raise ServiceError(f"there is a service {name!r} already, {_describe_owner(standing)}")
        with self._bus.passing("offer", service=name):
            service = Service(name, type_name, handler, self._bus.owner)
            self._endpoints.setdefault(name, []).insert(0, service)
        return service

    def offer_by_default(self, name: str, type_name: str, handler: ServiceHandler) -> None:
        """Opens a service that is there as long as nobody else offers one of its name."""
        name = absolute_name(name)
        service = Service(name, type_name, handler, self._bus.owner)
        service.yields = True
        self._endpoints.setdefault(name, []).append(service)

    def close(self, service: Service) -> None:
        """Takes a service away for good."""
        offered = self._endpoints.get(service.name, [])
        if service in offered:
            offered.remove(service)

    def call(self, name: str, request: Message = None) -> Message:
        """The response of a service, which is at work when this returns.

        Args:
            name: absolute, or taken as such.
            request: a message, a dict of its fields, or None for all zero.

        Raises:
            ServiceError: there is no such service; names the closest.
            MessageError: the request does not fit.
            PluginError: the service of a plugin raised.
        """
        service = self._get(absolute_name(name))
        asked = self._as_message(service, request)
        with self._bus.passing("call", service=service, request=asked):
            return self._answer(service, asked)

    def _answer(self, service: Service, request: Message) -> Message:
        owner, hook = service.owner, f"service {service.name}"
        try:
            found = call_plugin(owner, hook, service.handler, request)
            if found is None or isinstance(found, Mapping):
                return msgs.make(f"{service.type_name}_Response", **(found or {}))
            return found
        except SimkitError:
            raise
        except Exception as error:
            if owner is None:
                raise
            name, where = getattr(owner, "name", "") or service.name, str(getattr(owner, "where", ""))
            if hasattr(owner, "on_error"):
                self._engine.faults.meet(owner, hook, error)
                raise ServiceError(f"service {service.name!r} raised, and plugin {name!r} is left out") from error
            raise PluginError(name, hook, self._engine.time, where, repr(error)) from error


def _describe_owner(service: Service) -> str:
    owner = service.owner
    if owner is None:
        return f"of type {service.type_name}"
    return f"of plugin {getattr(owner, 'name', '')!r} ({getattr(owner, 'where', '')})"
