"""Services within the process: a request goes in, a response comes back, with the types that ROS 2 gives them.

    sim.call("/world/office/control", {"world_control": {"pause": True}})
    sim.offer("/robot/home", "std_srvs/srv/Trigger", lambda request: {"success": True})

A bridge has only to carry them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from simkit import msgs
from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError, PluginError, ServiceError, SimkitError
from simkit.msgs.message_types import definition_files
from simkit.runtime.communication.subscription import Message
from simkit.runtime.communication.topic_bus import absolute_name
from simkit.runtime.engine.plugin_faults import call_plugin

if TYPE_CHECKING:
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine

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


class ServiceTable:
    """All services of a simulation.

    Args:
        bus: knows who opens what.
        engine: calls plugins.
    """

    def __init__(self, bus: TopicBus, engine: Engine) -> None:
        self._bus, self._engine = bus, engine
        self._services: dict[str, list[Service]] = {}

    def offer(self, name: str, type_name: str, handler: ServiceHandler) -> Service:
        """Opens a service; whatever opens it within `bus.owned_by(owner)` belongs to that owner.

        Raises:
            ServiceError: there is one of that name.
            MessageError: an unknown type.
        """
        name = absolute_name(name)
        if type_name not in definition_files():  # what is in there is read when somebody calls
            msgs.full_name(f"{type_name}_Request")
        standing = self._find(name)
        if standing is not None and not standing.yields:
            raise ServiceError(f"there is a service {name!r} already, {_describe_owner(standing)}")
        if self._bus.journal is not None:
            with self._bus.journal.passing("offer", {"service": name}):
                pass
        service = Service(name, type_name, handler, self._bus.owner)
        self._services.setdefault(name, []).insert(0, service)
        return service

    def offer_by_default(self, name: str, type_name: str, handler: ServiceHandler) -> None:
        """Opens a service that is there as long as nobody else offers one of its name."""
        name = absolute_name(name)
        service = Service(name, type_name, handler, self._bus.owner)
        service.yields = True
        self._services.setdefault(name, []).append(service)

    def close(self, service: Service) -> None:
        """Takes a service away for good."""
        offered = self._services.get(service.name, [])
        if service in offered:
            offered.remove(service)

    def names(self) -> dict[str, str]:
        """Service -> type, sorted."""
        found = ((name, self._find(name)) for name in sorted(self._services))
        return {name: service.type_name for name, service in found if service is not None}

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
        name = absolute_name(name)
        service = self._find(name)
        if service is None:
            there = self.names()
            hint = did_you_mean(name, there) or "there is " + (", ".join(there) or "none")
            raise ServiceError(f"no service {name!r}; {hint}")
        asked = (
            msgs.from_dict([f"{service.type_name}_Request"], request or {}) if _is_dict_or_none(request) else request
        )
        if msgs.type_name(asked) != f"{service.type_name}_Request":
            raise MessageError(f"{name!r} takes {service.type_name}_Request, got {msgs.type_name(asked)}")
        journal = self._bus.journal
        if journal is None:
            return self._answer(service, asked)
        with journal.passing("call", {"service": service, "request": asked}):
            return self._answer(service, asked)

    def set_active(self, owners: Sequence[object]) -> None:
        """Leaves only the services of these owners (and those without one) in use."""
        living = {id(owner) for owner in owners}
        for service in (s for offered in self._services.values() for s in offered):
            service.active = service.owner is None or id(service.owner) in living

    def forget(self, owners: Sequence[object]) -> None:
        """Takes every service of these owners away for good."""
        gone = {id(owner) for owner in owners}
        for service in [s for offered in self._services.values() for s in offered if id(s.owner) in gone]:
            self.close(service)

    def _answer(self, service: Service, request: Message) -> Message:
        owner, hook = service.owner, f"service {service.name}"
        try:
            found = call_plugin(owner, hook, service.handler, request)
            return found if not _is_dict_or_none(found) else msgs.make(f"{service.type_name}_Response", **(found or {}))
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

    def _find(self, name: str) -> Service | None:
        return next((s for s in self._services.get(name, ()) if s.active), None)


def _is_dict_or_none(value: object) -> bool:
    return value is None or isinstance(value, Mapping)


def _describe_owner(service: Service) -> str:
    owner = service.owner
    if owner is None:
        return f"of type {service.type_name}"
    return f"of plugin {getattr(owner, 'name', '')!r} ({getattr(owner, 'where', '')})"
