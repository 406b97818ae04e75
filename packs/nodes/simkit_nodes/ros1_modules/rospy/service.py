"""Services of rospy: servers, whose threads call a function of the program, and proxies, which call a service."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from simkit.errors import ServiceError
from simkit_nodes.interfaces import ROS1, type_name_of
from simkit_nodes.interfaces.ros1_message import Message, SerializationError
from simkit_nodes.ros1_modules.rospy.exceptions import (
    ROSException,
    ROSInterruptException,
    ROSSerializationException,
)
from simkit_nodes.ros1_modules.rospy.log import logerr
from simkit_nodes.ros1_modules.rospy.msg import args_kwds_to_message
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node
from simkit_nodes.ros1_modules.rospy.rostime import limit_ns

if TYPE_CHECKING:
    from simkit_nodes.graph_services import GraphClient, GraphRequest, GraphService

__all__ = ["Service", "ServiceException", "ServiceProxy", "wait_for_service"]

_LATE_NS: Final = 5_000_000_000
"""Time for which a process of its own waits for the discovery of a service that exists: its thread may be late [ns]."""


class ServiceException(Exception):
    """A service cannot be called, or its server could not answer."""


class Service:
    """Server of a service.

    A thread waits for requests. A request that comes while all threads are busy gets a further thread, as each
    connection has one in rospy.

    Args:
        name: name of the service.
        service_class: class of the service.
        handler: function from a request to a response, to its fields in order, or to a dictionary of its fields.
        buff_size: accepted as in rospy.
        error_handler: function of an exception of the handler, its type, its value and its traceback.

    Attributes:
        resolved_name: global name of the service.
    """

    def __init__(
        self,
        name: str,
        service_class: type[Any],
        handler: Callable[[Any], object],
        buff_size: int = 65536,
        error_handler: Callable[..., object] | None = None,
    ) -> None:
        if not name or not isinstance(name, str):
            raise ValueError("service name is not a non-empty string")
        self._node = ros_node()
        self.resolved_name, self.service_class, self.handler = self._node.resolve_endpoint(name), service_class, handler
        self.request_class, self.response_class = service_class._request_class, service_class._response_class
        self._error_handler = error_handler
        self._is_closed = False
        self._idle = 0
        self._server: GraphService | None = None
        self._node.at_init(self._open)

    def _open(self) -> None:
        if not self._is_closed:
            self._server = self._node.graph_node.offer(self.resolved_name, type_name_of(self.service_class))
            self._start_thread()

    def _start_thread(self) -> None:
        self._idle += 1
        self._node.start_thread(self._serve, f"service {self.resolved_name}")

    def _serve(self) -> None:
        """Answer requests; the function of the threads."""
        node, server = self._node, self._server
        while server is not None and not node.is_shutdown and not self._is_closed:
            request = server.take()
            if request is None:
                node.wait(None, lambda: self._is_closed or server.has_request)
                continue
            self._idle -= 1
            if not self._idle:
                self._start_thread()
            self._answer(request)
            self._idle += 1

    def _answer(self, request: GraphRequest) -> None:
        try:
            message = ROS1.to_program(f"{type_name_of(self.service_class)}_Request")(request.message)
            response = _response(self.handler(message), self.response_class)
            request.answer(ROS1.to_simkit(f"{type_name_of(self.service_class)}_Response")(response))
        except Exception as error:  # noqa: BLE001 - as in rospy, the client gets the text and the server goes on
            if self._error_handler is not None:
                self._error_handler(error, type(error), error, error.__traceback__)
            else:
                logerr("Error processing request: %s\n%s", error, traceback.format_exc())
            request.fail(f"error processing request: {error}")

    def spin(self) -> None:
        """Wait until the node is shut down."""
        self._node.wait(None, lambda: self._is_closed)

    def shutdown(self, reason: str = "") -> None:
        """Stop the service."""
        self._is_closed = True
        if self._server is not None:
            self._server.close()
            self._server = None
        self._node.host.wake()


def _response(value: Any, response_class: type[Any]) -> Any:
    """Return the response that the value of a handler means.

    Raises:
        ServiceException: the value is no response, and its fields cannot be made of it.
    """
    if isinstance(value, Message) and value._type == response_class._type:
        return value
    if value is None:
        raise ServiceException("service handler returned None")
    try:
        if isinstance(value, dict):
            return response_class(**value)
        return response_class(*value) if type(value) in (list, tuple) else response_class(value)
    except (TypeError, AttributeError) as error:
        what = "wrong number of values" if type(value) in (list, tuple) else "invalid value"
        raise ServiceException(f"handler returned {what}: {error}") from None


class ServiceProxy:
    """Client of a service; a call waits for the response.

    Args:
        name: name of the service.
        service_class: class of the service.
        persistent: accepted as in rospy.
        headers: accepted as in rospy.

    Attributes:
        resolved_name: global name of the service.
    """

    def __init__(
        self, name: str, service_class: type[Any], persistent: bool = False, headers: dict[str, str] | None = None
    ) -> None:
        self._node = ros_node()
        self.resolved_name, self.service_class = self._node.resolve_endpoint(name), service_class
        self.request_class, self.response_class = service_class._request_class, service_class._response_class
        self.persistent = persistent
        self._client: GraphClient | None = None

    def wait_for_service(self, timeout: object = None) -> None:
        """Wait until the service exists; see the function `wait_for_service`."""
        wait_for_service(self.resolved_name, timeout)

    def __call__(self, *args: object, **kwds: object) -> Any:
        """Call the service; see `call`."""
        return self.call(*args, **kwds)

    def call(self, *args: object, **kwds: object) -> Any:
        """Call the service with a request, or with a new one of the arguments, and return the response.

        Raises:
            ServiceException: there is no such service, or its server could not answer.
            ROSSerializationException: a field of the request has a value that its type does not have.
            ROSInterruptException: the node was shut down.
        """
        node = self._node
        request = args_kwds_to_message(self.request_class, args, kwds)
        kind = type_name_of(self.service_class)
        try:
            message = ROS1.to_simkit(f"{kind}_Request")(request)
        except SerializationError as error:
            raise ROSSerializationException(str(error)) from None
        if self._client is None:
            self._client = node.graph_node.client(self.resolved_name, kind)
            # a new client knows the services only after the discovery; rospy asks the master at once
            found_ns = node.host.now_ns() + node.host.graph.discovery_ns(node.graph_node) + 1
            node.wait(found_ns, self._is_ready)
            if node.host.simulation is None and node.host.graph.has_service(self.resolved_name):
                node.wait(found_ns + _LATE_NS, self._is_ready)
        if not self._is_ready():
            raise ServiceException(f"service [{self.resolved_name}] unavailable")
        answers: list[Any] = []
        self._client.call(message, answers.append)
        while not answers and not node.is_shutdown:
            node.wait(None, lambda: bool(answers))
        if not answers:
            raise ROSInterruptException("node shutdown interrupted service call")
        if isinstance(answers[0], ServiceError):
            raise ServiceException(f"service [{self.resolved_name}] responded with an error: {answers[0].message}")
        return ROS1.to_program(f"{kind}_Response")(answers[0])

    def _is_ready(self) -> bool:
        return self._client is not None and self._client.is_ready

    def close(self) -> None:
        """Close the connection."""
        if self._client is not None:
            self._client.close()
            self._client = None


def wait_for_service(service: str, timeout: object = None) -> None:
    """Wait until a service exists.

    Args:
        service: name of the service.
        timeout: longest wait [s], or a `Duration`; None for no limit.

    Raises:
        ROSException: the service does not exist in time.
        ROSInterruptException: the node was shut down.
        ValueError: the timeout is zero.
    """
    if timeout is not None and not timeout:
        raise ValueError("timeout must be non-zero")
    node = ros_node()
    name = node.resolve_endpoint(service)

    def exists() -> bool:
        return node.host.graph.has_service(name)

    node.wait(limit_ns(timeout), exists)
    if exists():
        return
    if node.is_shutdown:
        raise ROSInterruptException("rospy shutdown")
    raise ROSException(f"timeout exceeded while waiting for service {name}")
