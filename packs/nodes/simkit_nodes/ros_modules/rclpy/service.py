"""Services of a node."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit_nodes.graph_services import GraphRequest
from simkit_nodes.interfaces import ROS2, ProgramMessage
from simkit_nodes.ros_modules.rclpy.executors import await_or_execute
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import Handle
from simkit_nodes.ros_modules.rclpy.waitable import ExecutorEntity

if TYPE_CHECKING:
    from simkit_nodes.graph_services import GraphService
    from simkit_nodes.ros_modules.rclpy.callback_groups import CallbackGroup
    from simkit_nodes.ros_modules.rclpy.qos import QoSProfile

__all__ = ["Service"]


class Service(ExecutorEntity):
    """Service of a node; `Node.create_service` creates it.

    Args:
        service_impl: service of the graph.
        srv_type: class of the service.
        srv_name: name as the program has written it.
        callback: function or coroutine function that receives a request and an empty response, and returns the
            response.
        callback_group: callback group.
        qos_profile: QoS, which has no effect.
    """

    def __init__(
        self,
        service_impl: GraphService,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], object],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
    ) -> None:
        self._service, self._handle = service_impl, Handle()
        self.srv_type, self.srv_name, self.callback = srv_type, srv_name, callback
        self.callback_group, self.qos_profile = callback_group, qos_profile
        self._to_program = ROS2.to_program(f"{service_impl.type_name}_Request")
        self._to_simkit = ROS2.to_simkit(f"{service_impl.type_name}_Response")

    @property
    def handle(self) -> Handle:
        """State of the service."""
        return self._handle

    @property
    def service_name(self) -> str:
        """Absolute name."""
        return self._service.name

    def send_response(self, response: ProgramMessage, header: Any) -> None:
        """Send a response to a request.

        Raises:
            TypeError: the response is not one of the service, or the header not that of a request.
        """
        if not isinstance(response, self.srv_type.Response) or not isinstance(header, GraphRequest):
            raise TypeError
        with self._handle:
            header.answer(self._to_simkit(response))

    def configure_introspection(self, clock: Any, service_event_qos_profile: Any, introspection_state: Any) -> None:
        """Do nothing: simkit publishes no events of services."""

    def destroy(self) -> None:
        """Destroy the service."""
        self._handle.destroy()
        self._service.close()

    def _is_ready(self) -> bool:
        return bool(self._handle) and self._service.has_request

    def _take(self) -> Any:
        return self._service.take()

    async def _execute(self, data: Any) -> None:
        response = await await_or_execute(self.callback, self._to_program(data.message), self.srv_type.Response())
        self.send_response(response, data)
