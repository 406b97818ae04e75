"""Services of the simulation in ROS, and services of ROS nodes in the simulation."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from simkit.bridges.live.protocol import JsonObject, LiveError
from simkit.bridges.simulation_link import SimulationLink
from simkit_ros.ros_names import parameter_node
from simkit_ros.ros_session import ClientEnd, RequestHeader, RosSession, ServiceEnd
from simkit_ros.ros_types import RosType, TypeUnavailable


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
        while (request := self._end.take()) is not None:
            data, header = request
            args = {"name": self.service, "type": f"{self.ros_type.name}_Request"}
            self._link.ask("call", args, data, self._responder(header), self._refuser(header))

    def _responder(self, header: RequestHeader) -> Callable[[object, bytes], None]:
        return lambda _, data: None if self._is_closed else self._end.respond(header, data)

    def _refuser(self, header: RequestHeader) -> Callable[[LiveError], None]:
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


class RemoteService:
    """Service of a ROS node that the bridge offers in the simulation. ROS has a client of it only after the first call.

    Args:
        link: connection to the simulation.
        session: session of ROS; its thread must be stopped while the client is opened or closed.
        service: name in the simulation.
        name: name in ROS.
        type_name: type of the service.
        report: callback for a note to the user.
    """

    def __init__(
        self,
        link: SimulationLink,
        session: RosSession,
        service: str,
        name: str,
        type_name: str,
        report: Callable[[str], None],
    ) -> None:
        self._link, self._session, self.service, self._name, self.type_name = link, session, service, name, type_name
        self._report = report
        self._pending: deque[tuple[int, bytes]] = deque()
        self._calls: dict[int, int] = {}  # numbers of the simulation's calls by those of the requests in ROS
        self.end: ClientEnd | None = None
        self._number = link.next_number()
        self._is_refused = False
        link.endpoints[self._number] = self._request
        link.ask("offer", {"number": self._number, "name": service, "type": type_name}, failed=self._refuse)

    def _refuse(self, error: LiveError) -> None:
        """Leave the service out, because the simulation has one of that name or does not know its type."""
        self._is_refused = True
        self._link.endpoints.pop(self._number, None)
        self._report(f"{self._name} of ROS is left out: {error}")

    def _request(self, words: JsonObject, data: bytes) -> None:
        self._pending.append((int(words["call"]), data))

    @property
    def needs_client(self) -> bool:
        """True if a request waits, and ROS has no client yet."""
        return self.end is None and bool(self._pending)

    def open(self) -> None:
        """Open the client in ROS."""
        try:
            self.end = self._session.call(self._name, self._session.types.find(self.type_name))
        except TypeUnavailable as reason:
            while self._pending:
                self._fail(self._pending.popleft()[0], str(reason))

    def send(self) -> None:
        """Send the requests that wait, once ROS has connected the client to the service."""
        while self._pending and self.end is not None and self.end.is_ready():
            number, data = self._pending.popleft()
            try:
                self._calls[self.end.send(data)] = number
            except Exception as error:  # noqa: BLE001 - rclpy raises many errors for data that it cannot decode
                self._fail(number, repr(error))

    def take(self) -> None:
        """Pass the responses that have arrived to the simulation."""
        while self.end is not None and (response := self.end.take()) is not None:
            sequence, data = response
            if sequence in self._calls:
                words = {"number": self._number, "call": self._calls.pop(sequence)}
                self._link.post("respond", {**words, "type": f"{self.type_name}_Response"}, data)

    def _fail(self, call: int, reason: str) -> None:
        self._link.post("respond", {"number": self._number, "call": call, "error": reason})

    def close(self) -> None:
        """Close the service in the simulation, whose callers receive an error, and the client in ROS."""
        if not self._is_refused:
            self._link.endpoints.pop(self._number, None)
            self._link.ask("close_endpoint", {"number": self._number})
        if self.end is not None:
            self._session.node.destroy_client(self.end.client)
