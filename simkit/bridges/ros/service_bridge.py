"""Services of a simulation in ROS."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from simkit.bridges.live.protocol import LiveError
from simkit.bridges.ros.ros_names import parameter_node
from simkit.bridges.ros.ros_session import RosSession, ServiceEnd
from simkit.bridges.ros.ros_types import RosType
from simkit.bridges.simulation_link import SimulationLink


class ServiceBridge:
    """Service of the simulation that ROS can call. A request is answered when the simulation has answered it.

    Args:
        link: connection to the simulation.
        session: session of ROS; its thread must be stopped while a service is opened or closed.
        service: name in the simulation.
        name: name in ROS. A parameter service belongs to the node of its name, any other service to the main node.
        ros_type: type of the service.
        report: callback for a note to the user.
    """

    def __init__(
        self,
        link: SimulationLink,
        session: RosSession,
        service: str,
        name: str,
        ros_type: RosType,
        report: Callable[[str], None],
    ) -> None:
        self._link, self._session, self.service, self.ros_type = link, session, service, ros_type
        self._report = report
        node = parameter_node(name)
        self._end = session.offer(name, ros_type, session.node_of(node) if node else None)
        self._is_closed = False

    @property
    def type_name(self) -> str:
        """Type of the service."""
        return self.ros_type.name

    @property
    def ends(self) -> list[ServiceEnd]:
        """Service servers of rclpy."""
        return [self._end]

    def take(self) -> None:
        """Pass the requests that have arrived to the simulation."""
        while (found := self._end.take()) is not None:
            data, header = found
            args = {"name": self.service, "type": f"{self.ros_type.name}_Request"}
            self._link.ask("call", args, data, self._responder(header), self._refuser(header))

    def _responder(self, header: Any) -> Callable[[Any, bytes], None]:
        return lambda _, data: None if self._is_closed else self._end.respond(header, data)

    def _refuser(self, header: Any) -> Callable[[LiveError], None]:
        """Return a function that answers a failed request with a response of zeros; ROS has no errors of services."""

        def refuse(error: LiveError) -> None:
            self._report(f"{self.service} failed: {error}")
            args = {"type": f"{self.ros_type.name}_Response"}
            self._link.ask("default_message", args, then=self._responder(header))

        return refuse

    def close(self) -> None:
        """Close the service in ROS."""
        self._is_closed = True
        self._session.close_service(self._end)
