"""Contexts: the time between `rclpy.init` and `rclpy.shutdown`."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from types import MethodType
from weakref import WeakMethod

from simkit_nodes.host import current_host, current_program
from simkit_nodes.names import (
    RosArguments,
    RosArgumentsError,
    UnknownArgumentsError,
    parse_ros_arguments,
)
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import (
    Handle,
    RCLError,
    UnknownROSArgsError,
)

__all__ = ["Context"]


class Context:
    """Time between init and shutdown.

    Attributes:
        arguments: arguments after `--ros-args`, and what the simulation changes for the program.
        is_ended_from_outside: True if Ctrl-C or the end of the simulation, in another process, has ended the context.
    """

    def __init__(self) -> None:
        self.arguments = RosArguments()
        self._callbacks: list[Callable[[], Callable[[], object] | None]] = []
        self._is_initialized = self._is_shut_down = self._is_run_over = self.is_ended_from_outside = False
        self._domain_id = 0
        self._handle = Handle()

    @property
    def handle(self) -> Handle | None:
        """State of the context; None before `init`."""
        return self._handle if self._is_initialized else None

    def destroy(self) -> None:
        """Release the context."""
        if self._is_initialized:
            self._handle.destroy()

    def init(
        self, args: Sequence[str] | None = None, *, initialize_logging: bool = True, domain_id: int | None = None
    ) -> None:
        """Begin.

        Args:
            args: command line; None for `sys.argv`.
            initialize_logging: has no effect.
            domain_id: number of the ROS domain; programs of a simulation talk to each other in all domains.

        Raises:
            RuntimeError: the context has begun before.
            UnknownROSArgsError, RCLError: an argument after `--ros-args` is wrong.
        """
        if domain_id is not None and domain_id < 0:
            raise RuntimeError(f"Domain id ({domain_id}) should not be lower than zero.")
        if self._is_initialized:
            raise RuntimeError("Context.init() must only be called once")
        self.arguments = parse_arguments(sys.argv if args is None else args)
        self.arguments.rules = [*current_program().options.rules(), *self.arguments.rules]
        self._domain_id = domain_id or 0
        self._is_initialized = True
        current_program().on_end.append(self._end_with_run)

    def ok(self) -> bool:
        """Check whether the context has begun, and neither it nor the run has ended."""
        current_host().poll()
        return self.is_valid and not self._is_run_over

    @property
    def is_valid(self) -> bool:
        """True between init and shutdown."""
        return self._is_initialized and not self._is_shut_down

    def shutdown(self) -> None:
        """End the context.

        Raises:
            RuntimeError: the context has not begun.
            RCLError: the context has ended before.
        """
        if not self._is_initialized:
            raise RuntimeError("Context must be initialized before it can be shutdown")
        if self._is_shut_down:
            raise RCLError(
                "failed to shutdown: rcl_shutdown already called on the given context, at ./src/rcl/init.c:333"
            )
        self._end()

    def try_shutdown(self) -> None:
        """End the context, unless it has ended before."""
        if self.is_valid:
            self._end()

    def _end(self) -> None:
        self._is_shut_down = True
        callbacks, self._callbacks = self._callbacks, []
        for find_callback in callbacks:
            callback = find_callback()
            if callback is not None:
                callback()
        current_host().wake()

    def _end_with_run(self) -> None:
        """End the context as SIGINT does: the functions of `on_shutdown` are not called, and executors raise.

        In lock-step, the context stays valid, so that a `finally` block can stop the robot and call `shutdown`.
        """
        if current_host().graph.has_simulated_time:
            self._is_run_over = True
        elif self.is_valid:
            self._is_shut_down = self.is_ended_from_outside = True
            current_host().wake()

    def on_shutdown(self, callback: Callable[[], object]) -> None:
        """Call a function at the shutdown; at once if the context has ended."""
        if not callable(callback):
            raise TypeError("callback should be a callable, got {}", type(callback))
        if self._is_shut_down:
            callback()
        elif isinstance(callback, MethodType):
            self._callbacks.append(WeakMethod(callback))
        else:
            self._callbacks.append(lambda: callback)

    def get_domain_id(self) -> int:
        """Return the number of the ROS domain.

        Raises:
            RuntimeError: the context has not begun.
        """
        if not self._is_initialized:
            raise RuntimeError("Context must be initialized before it can have a domain id")
        return self._domain_id

    def __enter__(self) -> Context:
        if not self._is_initialized:
            self.init()
        return self

    def __exit__(self, *_: object) -> None:
        self.try_shutdown()


def parse_arguments(args: Sequence[str]) -> RosArguments:
    """Read the arguments after `--ros-args`, with rclpy's exceptions.

    Raises:
        UnknownROSArgsError, RCLError: an argument is wrong.
    """
    try:
        return parse_ros_arguments(args)
    except UnknownArgumentsError as error:
        raise UnknownROSArgsError(str(error)) from None
    except RosArgumentsError as error:
        raise RCLError(f"failed to initialize rcl: {error}") from None
