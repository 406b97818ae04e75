"""rclpy for programs that simkit runs: the functions that most programs begin and end with."""

from __future__ import annotations

from collections.abc import Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any

from simkit_nodes.host import current_program
from simkit_nodes.ros_modules.rclpy.context import Context
from simkit_nodes.ros_modules.rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from simkit_nodes.ros_modules.rclpy.impl.logging_severity import LoggingSeverity
from simkit_nodes.ros_modules.rclpy.impl.rcutils_logger import log_state
from simkit_nodes.ros_modules.rclpy.parameter import Parameter
from simkit_nodes.ros_modules.rclpy.signals import (
    SignalHandlerOptions,
    install_signal_handlers,
    uninstall_signal_handlers,
)
from simkit_nodes.ros_modules.rclpy.task import Future
from simkit_nodes.ros_modules.rclpy.utilities import (
    get_default_context,
    get_rmw_implementation_identifier,
    ok,
    try_shutdown,
)
from simkit_nodes.ros_modules.rclpy.utilities import shutdown as _shutdown

if TYPE_CHECKING:
    from simkit_nodes.ros_modules.rclpy.executors import Executor
    from simkit_nodes.ros_modules.rclpy.node import Node

__all__ = [
    "Context",
    "Future",
    "Parameter",
    "SignalHandlerOptions",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "get_rmw_implementation_identifier",
    "init",
    "install_signal_handlers",
    "ok",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
    "uninstall_signal_handlers",
]

_KEY = "rclpy.global_executor"


class InitContextManager:
    """Result of `init`: a `with` block ends the context."""

    def __init__(self, context: Context) -> None:
        self.context = context

    def __enter__(self) -> InitContextManager:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.context is get_default_context():
            try_shutdown()
        else:
            self.context.try_shutdown()


def init(
    *,
    args: Sequence[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> InitContextManager:
    """Begin the communication of the program.

    Args:
        args: command line; None for `sys.argv`.
        context: context that begins; None for the default one.
        domain_id: number of the ROS domain, which has no effect.
        signal_handler_options: has no effect.

    Returns:
        Object for a `with` block, which ends the context.
    """
    context = get_default_context() if context is None else context
    context.init(args, domain_id=domain_id)
    state = log_state()
    state.is_stdout_enabled = context.arguments.is_stdout_enabled
    state.levels.update({name: LoggingSeverity[level.upper()] for name, level in context.arguments.levels.items()})
    return InitContextManager(context)


def get_global_executor() -> Executor:
    """Return the executor of `spin` and `spin_once`."""
    data = current_program().data
    executor: Executor | None = data.get(_KEY)
    if executor is None:
        created = executor = data[_KEY] = SingleThreadedExecutor()

        def reset() -> None:
            created.shutdown()
            data.pop(_KEY, None)

        get_default_context().on_shutdown(reset)
    return executor


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """End the communication of the program.

    Args:
        context: context that ends; None for the default one.
        uninstall_handlers: has no effect.
    """
    _shutdown(context=context)


def create_node(node_name: str, **kwargs: Any) -> Node:
    """Create a node; the arguments are those of `rclpy.node.Node`."""
    from simkit_nodes.ros_modules.rclpy.node import Node

    return Node(node_name, **kwargs)


def spin_once(node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None) -> None:
    """Wait for a callback of a node and call it.

    Args:
        node: node.
        executor: executor; None for the global one.
        timeout_sec: longest wait [s]; None for no limit, 0 for no wait.
    """
    executor = get_global_executor() if executor is None else executor
    try:
        executor.add_node(node)
        executor.spin_once(timeout_sec=timeout_sec)
    finally:
        executor.remove_node(node)


def spin(node: Node, executor: Executor | None = None) -> None:
    """Call callbacks of a node until the context ends.

    Args:
        node: node.
        executor: executor; None for the global one.

    Raises:
        ExternalShutdownException: the simulation has ended.
    """
    executor = get_global_executor() if executor is None else executor
    is_added = executor.add_node(node)
    try:
        while executor.context.is_valid:
            executor.spin_once()
        if executor.context.is_ended_from_outside:
            raise ExternalShutdownException
    finally:
        if is_added:
            executor.remove_node(node)


def spin_until_future_complete(
    node: Node, future: Future, executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Call callbacks of a node until a future is done.

    Args:
        node: node.
        future: future.
        executor: executor; None for the global one.
        timeout_sec: longest wait [s]; None for no limit.
    """
    executor = get_global_executor() if executor is None else executor
    is_added = False
    try:
        is_added = executor.add_node(node)
        executor.spin_until_future_complete(future, timeout_sec)
    finally:
        if is_added:
            executor.remove_node(node)
