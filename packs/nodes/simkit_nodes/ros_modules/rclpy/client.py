"""Clients of services."""

from __future__ import annotations

from collections import deque
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from simkit.errors import ServiceError
from simkit_nodes.host import current_host
from simkit_nodes.interfaces import ROS2, ProgramMessage
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import Handle
from simkit_nodes.ros_modules.rclpy.logging import get_logger
from simkit_nodes.ros_modules.rclpy.task import Future
from simkit_nodes.ros_modules.rclpy.waitable import ExecutorEntity

if TYPE_CHECKING:
    from collections.abc import Callable

    from simkit.msgs import Message
    from simkit_nodes.graph_services import GraphClient
    from simkit_nodes.ros_modules.rclpy.callback_groups import CallbackGroup
    from simkit_nodes.ros_modules.rclpy.context import Context
    from simkit_nodes.ros_modules.rclpy.executors import Executor
    from simkit_nodes.ros_modules.rclpy.qos import QoSProfile

__all__ = ["Client"]

DEADLOCK_NS: Final = 5_000_000_000
"""Time [ns] after which a call is reported whose response has arrived, but which no executor takes."""

_LOOK_NS: Final = 100_000_000  # [ns] between two looks for a service that a script or a plugin may open


def wait_until(is_ready: Callable[[], bool], context: Context, timeout_sec: float | None) -> bool:
    """Wait for a service or an action; return False after `timeout_sec`, or after the shutdown of the context.

    rclpy looks every 0.25 s; here the wait ends at once.
    """
    host = current_host()
    end_ns = None if timeout_sec is None else host.now_ns() + int(timeout_sec * 1e9)
    while context.ok() and not is_ready():
        now = host.now_ns()
        if end_ns is not None and now >= end_ns:
            break
        look_ns = now + _LOOK_NS
        host.wait(look_ns if end_ns is None else min(look_ns, end_ns), is_ready)
    return is_ready()


def wait_for_result(future: Future, tells_deadlock: Callable[[], bool], what: str, timeout_sec: float | None) -> None:
    """Wait until a future is done, without spinning; another thread must spin.

    Args:
        future: future.
        tells_deadlock: function that returns True if the result has arrived and waits for an executor.
        what: name of the call, for the report of a deadlock.
        timeout_sec: longest wait [s]; None for no limit.
    """
    host = current_host()
    now = host.now_ns()
    end_ns = None if timeout_sec is None else now + int(timeout_sec * 1e9)
    report_ns: int | None = now + DEADLOCK_NS
    while not future.done():
        now = host.now_ns()
        if end_ns is not None and now >= end_ns:
            return
        if report_ns is not None and now >= report_ns:
            report_ns = None
            if tells_deadlock():
                _report_deadlock(what)
        times = [time for time in (end_ns, report_ns) if time is not None]
        host.wait(min(times) if times else None, future.done)


def _report_deadlock(what: str) -> None:
    get_logger("rclpy").error(
        f"{what} waits for {DEADLOCK_NS * 1e-9:g} s for a response that has arrived: no executor can take it. "
        "A blocking call in a callback is a deadlock, unless a MultiThreadedExecutor spins and the client is in "
        "another callback group; use `await client.call_async(...)` or a done callback."
    )


class Client(ExecutorEntity):
    """Client of a service; `Node.create_client` creates it.

    Args:
        context: context of the node.
        client_impl: client of the graph.
        srv_type: class of the service.
        srv_name: name as the program has written it.
        qos_profile: QoS, which has no effect.
        callback_group: callback group.
    """

    def __init__(
        self,
        context: Context,
        client_impl: GraphClient,
        srv_type: Any,
        srv_name: str,
        qos_profile: QoSProfile,
        callback_group: CallbackGroup,
    ) -> None:
        self.context, self._client, self._handle = context, client_impl, Handle()
        self.srv_type, self.srv_name, self.qos_profile = srv_type, srv_name, qos_profile
        self.callback_group = callback_group
        self._pending_requests: dict[int, Future] = {}
        self._responses: deque[tuple[int, Message | ServiceError]] = deque()
        self._wake: Callable[[], None] = lambda: None
        self._executor: Callable[[], Executor | None] = lambda: None
        self._to_simkit = ROS2.to_simkit(f"{client_impl.type_name}_Request")
        self._to_program = ROS2.to_program(f"{client_impl.type_name}_Response")

    @property
    def handle(self) -> Handle:
        """State of the client."""
        return self._handle

    @property
    def service_name(self) -> str:
        """Absolute name of the service."""
        return self._client.name

    def call(self, request: ProgramMessage, timeout_sec: float | None = None) -> Any:
        """Send a request and wait for the response, while another thread spins.

        Args:
            request: request of the service's class.
            timeout_sec: longest wait [s]; None for no limit.

        Returns:
            The response; None after the time.

        Raises:
            TypeError: the request has another class.
        """
        future = self.call_async(request)
        wait_for_result(future, lambda: bool(self._responses), f"call() of {self.service_name!r}", timeout_sec)
        if not future.done():
            self.remove_pending_request(future)
        return future.result()

    def call_async(self, request: ProgramMessage) -> Future:
        """Send a request and return a future for the response.

        Raises:
            TypeError: the request has another class.
        """
        if not isinstance(request, self.srv_type.Request):
            raise TypeError
        future = Future()
        with self._handle:
            number = self._client.call(self._to_simkit(request), partial(self._receive, self._client.calls + 1))
        self._pending_requests[number] = future
        future.add_done_callback(self.remove_pending_request)
        return future

    def _receive(self, number: int, response: Message | ServiceError) -> None:
        self._responses.append((number, response))
        self._wake()

    def get_pending_request(self, sequence_number: int) -> Future:
        """Return the future of a request; KeyError if none waits."""
        return self._pending_requests[sequence_number]

    def remove_pending_request(self, future: Future) -> None:
        """Forget a request: its response will be dropped."""
        for number, pending in tuple(self._pending_requests.items()):
            if pending is future:
                del self._pending_requests[number]

    def service_is_ready(self) -> bool:
        """Check whether the service exists and is discovered."""
        current_host().poll()
        with self._handle:
            return self._client.is_ready

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Wait until the service exists, for up to `timeout_sec` or without limit; return False after that time."""
        with self._handle:
            return wait_until(lambda: self._client.is_ready, self.context, timeout_sec)

    def configure_introspection(self, clock: Any, service_event_qos_profile: Any, introspection_state: Any) -> None:
        """Do nothing: simkit publishes no events of services."""

    def destroy(self) -> None:
        """Destroy the client."""
        self._handle.destroy()
        self._client.close()

    def _is_ready(self) -> bool:
        return bool(self._handle) and bool(self._responses)

    def _take(self) -> Any:
        return self._responses.popleft() if self._responses else None

    async def _execute(self, data: Any) -> None:
        number, response = data
        if isinstance(response, ServiceError):  # in ROS 2, no response comes
            get_logger("rclpy").warning(f"no response of service {self.service_name!r}: {response}")
            return
        future = self._pending_requests.get(number)
        if future is not None:
            future._set_executor(self._executor())
            future.set_result(self._to_program(response))
